//! Ways along a wall that lead on past the ends of rows: where these recede floor goes on, as wide as the way and wider, up to the
//! wall at its end.

use super::barriers;
use super::ragged;
use crate::ends::{around, both, holds, overlap, sorted, wider};
use crate::labels::beside::Beside;
use crate::labels::corridors::Strip;
use crate::labels::junctions::shut::{self, sign};
use crate::labels::rows::Row;
use crate::labels::view::turned::Turned;
use std::ops::Range;

/// The wall at its end is looked for so far, metres, and the ends of rows so far beside it.
const LOOK: f64 = 60.0;
const RECESS: f64 = 4.0;
/// Up to so far before that nothing bars it, metres.
const BEFORE: f64 = 0.5;
/// The floor is free but for this share.
const CLUTTER: f64 = 0.05;
/// Something stands in it over no more than this share of its length.
const STANDING: f64 = 0.1;
/// A wall stands so near to its side, metres, over so much of what it leads on; at the other side rows end over so much.
const SIDE: f64 = 0.25;
const WALLED: f64 = 0.8;
const ENDED: f64 = 0.15;

/// What a way leads on along a wall.
pub struct On {
    /// Which way, and from where to where it then leads along.
    pub way: usize,
    pub along: [f64; 2],
    /// What is free of it there, up to where the first row ends.
    pub floor: Strip,
}

/// What some ways lead on along walls; of all it is known where they lie.
pub fn find(views: &[Turned], strips: &[Strip], placed: &[Beside], rows: &[Row]) -> Vec<On> {
    let ends = (0..strips.len()).flat_map(|n| [0, 1].map(|side| (n, side)));
    let found = ends.filter_map(|(n, side)| beyond(&views[strips[n].direction], strips, placed, n, side));
    found.filter(|on| !rows.iter().any(|row| reaches_into(views, row, &on.floor, strips[on.way].across))).collect()
}

/// True when a row stands on what a way between two places across would lead on over.
fn reaches_into(views: &[Turned], row: &Row, floor: &Strip, across: [f64; 2]) -> bool {
    let (its, view) = (&views[row.direction], &views[floor.direction]);
    let corners = its.rectangle(row.along, row.across);
    let [u, v] = [0, 1].map(|axis| around(corners.iter().map(|&corner| view.place(corner)[axis])));
    overlap(u, floor.along) > SIDE && overlap(v, across) > SIDE
}

fn beyond(view: &Turned, strips: &[Strip], placed: &[Beside], n: usize, side: usize) -> Option<On> {
    let strip = &strips[n];
    let end = strip.along[side];
    let wall = shut::closed(view, strip, side, LOOK)?;
    let along = sorted([end, wall]);
    if (wall - end) * sign(side) < strip.width() {
        return None;
    }
    let columns = view.columns(along);
    let before = view.columns(sorted([end, wall - sign(side) * BEFORE]));
    let [low, high] = shut::inner(strip);
    let is_free = view.mean_blocked(columns.clone(), low, high) <= CLUTTER
        && view.share_touched(before.clone(), low, high) <= STANDING
        && !barriers::among(view, strip.across, before.clone()).any()
        && barriers::stops(view, strip.across, before).is_empty();
    let on = Strip { along, ..strip.clone() };
    let is_known = |m: &usize| *m != n && ragged::is_beside(&strips[*m], &on);
    if !is_free || placed[strip.direction].touching(along, strip.across).iter().any(is_known) {
        return None;
    }
    let walled = strip.across.map(|at| view.share_touched(columns.clone(), at - SIDE, at + SIDE) >= WALLED);
    let open = match walled {
        [true, false] => 1,
        [false, true] => 0,
        _ => return None,
    };
    let (edge, outwards) = (strip.across[open], sign(open));
    let recess = recess(view, columns, edge, outwards)?;
    let across = sorted([strip.across[1 - open], edge + outwards * (recess - view.cell)]);
    Some(On {
        way: n,
        along: both(strip.along, along),
        floor: Strip { along, across: both(across, strip.across), ..on },
    })
}

/// How far from a side the first rows end, over a share of some columns.
fn recess(view: &Turned, columns: Range<usize>, edge: f64, outwards: f64) -> Option<f64> {
    let mut ended = vec![false; columns.len()];
    let places = (0..(RECESS / view.cell) as usize).map(|cells| [cells, cells + 1].map(|n| n as f64 * view.cell));
    let mut places = places.filter(|[_, far]| *far > SIDE);
    let found = places.find(|&[near, far]| {
        let [low, high] = sorted([near.max(SIDE), far].map(|metres| edge + outwards * metres));
        let stands = view.some_occupied(columns.clone(), low, high);
        ended.iter_mut().zip(stands).for_each(|(ended, share)| *ended |= share > 0.0);
        ended.iter().filter(|ended| **ended).count() as f64 >= ENDED * columns.len() as f64
    });
    found.map(|[_, far]| far)
}

/// True when a way of another direction ends on the floor, and not where that begins; of all it is known where they lie.
pub fn is_led_to(views: &[Turned], On { floor, .. }: &On, strips: &[Strip], placed: &[Beside]) -> bool {
    let view = &views[floor.direction];
    let corners = view.rectangle(floor.along, wider(floor.across, SIDE));
    views.iter().filter(|its| its.direction != floor.direction).any(|its| {
        let [along, across] = [0, 1].map(|axis| around(corners.iter().map(|&corner| its.place(corner)[axis])));
        placed[its.direction].touching(along, across).into_iter().any(|n| {
            strips[n].along.into_iter().any(|end| {
                let [u, v] = view.place(its.to_map([end, strips[n].middle()]));
                holds(wider(floor.along, -SIDE), u) && holds(wider(floor.across, SIDE), v)
            })
        })
    })
}
