//! Ways that seem to lead on through a hall whose rows run askew to them: from one of its aisles to the next between racks that
//! reach into the way from both sides, with nothing along it.

use crate::ends::{holds, sorted, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::Strip;
use crate::labels::corridors::pieces::BESIDE;
use crate::labels::view::turned::Turned;

/// Aisles that a way crosses at an angle of such a sine run neither along it nor square to it.
const ASKEW: [f64; 2] = [0.2, 0.97];
/// Somewhere between two of them so much of its width is taken.
const TAKEN: f64 = 0.02;
/// Along no more than this share of it the ground ends at either of its sides.
const EDGED: f64 = 0.25;
/// Ground that ends does so for this share of what lies on the side.
const ENDS: f64 = 0.8;
/// Of a way that is cut there the pieces are others from so much of the longest one's length on.
const LEAST: f64 = 0.5;

/// The strips, each cut where it leads between two neighbouring ones of one direction through what stands askew to it.
pub fn cut(views: &[Turned], strips: Vec<Strip>) -> Vec<Strip> {
    let are_askew = |one: &Turned, two: &Turned| holds(ASKEW, one.sine(two));
    if !views.iter().any(|one| views.iter().any(|two| are_askew(one, two))) {
        return strips;
    }
    let placed = placed(views, strips.iter().map(Strip::place));
    let pieces = |strip: &Strip| {
        let own = &views[strip.direction];
        let askew = views.iter().filter(|its| are_askew(own, its));
        let mut through: Vec<[f64; 2]> = askew.flat_map(|its| through(own, its, strip, &strips, &placed)).collect();
        through.sort_by(|a, b| a[0].total_cmp(&b[0]));
        left(strip, &through)
    };
    strips.iter().flat_map(pieces).collect()
}

/// From where to where, along, a strip leads from one of another direction's to the next through what stands there.
fn through(own: &Turned, its: &Turned, strip: &Strip, strips: &[Strip], placed: &[Beside]) -> Vec<[f64; 2]> {
    let ends = strip.along.map(|u| its.place(own.to_map([u, strip.middle()])));
    let [u, v] = [0, 1].map(|axis| sorted(ends.map(|end| end[axis])));
    let mut crossed: Vec<[f64; 2]> = Vec::new();
    for n in placed[its.direction].touching(u, v) {
        let [there, here] = own.crossing(its, strip.middle(), strips[n].middle());
        if holds(strips[n].along, there) && holds(strip.along, here) {
            crossed.push(wider([here; 2], strips[n].width() / 2.0 / own.sine(its)));
        }
    }
    crossed.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let between = crossed.windows(2).map(|pair| [pair[0][1], pair[1][0]]);
    between.filter(|along| along[0] < along[1] && is_through_rows(own, strip, *along)).collect()
}

/// True when what stands between two places reaches into a strip there, and does not stand along it.
fn is_through_rows(view: &Turned, strip: &Strip, along: [f64; 2]) -> bool {
    let columns = view.columns(along);
    let [low, high] = strip.across;
    if view.some_blocked(columns.clone(), low, high).into_iter().all(|blocked| blocked < TAKEN) {
        return false;
    }
    let share = |low: f64, high: f64| view.some_blocked(columns.clone(), low, high);
    let (near, far) = BESIDE;
    let sides = [
        [share(low + near, low + far), share(low - far, low - near)],
        [share(high - far, high - near), share(high + near, high + far)],
    ];
    let is_edged = |n: usize| sides.iter().any(|[within, beyond]| within[n] < 1.0 - ENDS && beyond[n] > ENDS);
    ((0..columns.len()).filter(|n| is_edged(*n)).count() as f64) < EDGED * columns.len() as f64
}

/// What is left of a strip without some stretches of it, each up to where the next begins.
fn left(strip: &Strip, without: &[[f64; 2]]) -> Vec<Strip> {
    if without.is_empty() {
        return vec![strip.clone()];
    }
    let from = [strip.along[0]].into_iter().chain(without.iter().map(|stretch| stretch[1]));
    let to = without.iter().map(|stretch| stretch[0]).chain([strip.along[1]]);
    let pieces: Vec<Strip> = from
        .zip(to)
        .map(|(from, to)| {
            let stops = [strip.stops[0] || from > strip.along[0], strip.stops[1] || to < strip.along[1]];
            Strip { along: [from, to], stops, ..strip.clone() }
        })
        .collect();
    let longest = pieces.iter().map(Strip::length).fold(0.0, f64::max);
    pieces.into_iter().filter(|piece| piece.length() >= LEAST * longest).collect()
}
