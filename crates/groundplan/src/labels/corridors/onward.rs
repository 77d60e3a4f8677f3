//! What goes on beyond a known way's end: there its sides are no lines, but a way whose sides are none lies over it and
//! leads on.

use super::barriers;
use super::stretches::beyond;
use crate::ends::overlap;
use crate::labels::corridors::Strip;
use crate::labels::rows::SAME;
use crate::labels::view::turned::Turned;

/// The two share so much of the narrower one's width.
const SHARED: f64 = 0.7;
/// Beyond the known way's end the floor is free over its own width but for this share.
const CLUTTER: f64 = 0.05;

/// What a way adds to known ones over which it lies, each as wide as that one and longer than wide; no other known one is
/// beside it there.
pub fn of(view: &Turned, way: &Strip, known: &[&Strip]) -> Vec<Strip> {
    let mut found = Vec::new();
    for own in known.iter().filter(|own| !own.is_ragged) {
        if overlap(own.across, way.across) < SHARED * own.width().min(way.width()) {
            continue;
        }
        for along in [[way.along[0], own.along[0]], [own.along[1], way.along[1]]] {
            let on = Strip { along, across: own.across, is_ragged: false, ..way.clone() };
            let is_beside = |other: &&Strip| overlap(along, other.along) > view.cell / 2.0;
            if on.length() >= own.width() && !known.iter().any(is_beside) && leads_on(view, &on) {
                found.push(on);
            }
        }
    }
    found
}

/// True where floor goes on over all the width, near its sides as in its middle, and no wall or door parts it.
fn leads_on(view: &Turned, on: &Strip) -> bool {
    let [low, high] = on.across;
    let columns = view.columns(on.along);
    let near = SAME.min((high - low) / 4.0);
    let parts = [[low, high], [low + near, low + 2.0 * near], [high - 2.0 * near, high - near]];
    parts.into_iter().all(|[low, high]| view.mean_blocked(columns.clone(), low, high) <= CLUTTER)
        && !barriers::among(view, on.across, columns.clone()).any()
        && !barriers::doors(view, beyond(on.across), columns.clone()).any()
        && barriers::stops(view, on.across, columns).is_empty()
}
