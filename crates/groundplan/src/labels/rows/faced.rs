//! Ways between two racks that face each other: such a way is as long as both, be it seen there or not.

use crate::ends::{around, holds, overlap, shared, wider};
use crate::labels::beside::placed;
use crate::labels::corridors::Strip;
use crate::labels::corridors::barriers;
use crate::labels::rows::{Row, SAME};
use crate::labels::view::turned::Turned;
use std::cmp::Ordering;

/// So much of what was not seen may be taken.
const CLUTTER: f64 = 0.05;
/// What was not seen between two pieces of a way is no longer than this share of the longer one.
const APART: f64 = 0.3;

/// The strips, each from where to where racks stand on both its sides, where nothing stands between these and no other
/// strip is.
pub fn whole(views: &[Turned], strips: &[Strip], racks: &[Row]) -> Vec<Strip> {
    let standing = placed(views, racks.iter().map(Row::place));
    let known = placed(views, strips.iter().map(Strip::place));
    let as_long = |(n, strip): (usize, &Strip)| {
        let view = &views[strip.direction];
        let near = standing[strip.direction].touching(strip.along, wider(strip.across, SAME));
        let is_free = |[from, to]: [f64; 2]| {
            let columns = view.columns([from, to]);
            let taken = view.some_occupied(columns.clone(), strip.across[0], strip.across[1]);
            let others = known[strip.direction].touching([from, to], strip.across);
            // What is too short for a way by itself and in line with it is of it where little between them was not seen.
            let is_piece = |m: usize| {
                let other = &strips[m];
                let apart = (other.along[0] - strip.along[1]).max(strip.along[0] - other.along[1]);
                strip.is_in_line(other, SAME) && other.is_short() && apart <= APART * strip.length()
            };
            let is_other = |m: usize| {
                overlap(strips[m].along, [from, to]) > view.cell
                    && overlap(strips[m].across, strip.across) > 0.0
                    && !is_piece(m)
            };
            taken.iter().sum::<f64>() <= CLUTTER * taken.len() as f64
                && !others.into_iter().any(|m| m != n && is_other(m))
                && !barriers::among(view, strip.across, columns).any()
        };
        let mut whole = strip.clone();
        for end in 0..2 {
            // The racks that stand along both its sides where it ends.
            let facing = |side: usize| {
                let is_beside = |rack: &&Row| {
                    (rack.across[1 - side] - strip.across[side]).abs() <= SAME && holds(rack.along, strip.along[end])
                };
                near.iter().map(|&n| &racks[n]).find(is_beside)
            };
            let (Some(one), Some(two)) = (facing(0), facing(1)) else { continue };
            let on = match (shared(one.along, two.along), end) {
                ([low, _], 0) => [low, strip.along[0]],
                ([_, high], _) => [strip.along[1], high],
            };
            if on[1] - on[0] > SAME && is_free(on) {
                let pieces = known[strip.direction].touching(on, strip.across).into_iter();
                let pieces = pieces.filter(|&m| m != n && strip.is_in_line(&strips[m], SAME));
                whole.along[end] = around(pieces.flat_map(|m| strips[m].along).chain(on))[end];
                whole.stops[end] = true;
            }
        }
        whole
    };
    let all: Vec<Strip> = strips.iter().enumerate().map(as_long).collect();
    // Of pieces that are as long as one another then one is left.
    let is_part = |n: usize| {
        let is_longer = |m: usize| match all[m].length().total_cmp(&all[n].length()) {
            Ordering::Equal => m < n,
            order => order.is_gt(),
        };
        let is_whole = |m: usize| m != n && all[m] != strips[m] && is_longer(m) && all[m].is_in_line(&all[n], SAME);
        let near = known[strips[n].direction].touching([f64::NEG_INFINITY, f64::INFINITY], strips[n].across);
        strips[n].is_short()
            && near.into_iter().any(|m| is_whole(m) && is_within(strips[n].along, wider(all[m].along, SAME)))
    };
    (0..all.len()).filter(|&n| !is_part(n)).map(|n| all[n].clone()).collect()
}

fn is_within(one: [f64; 2], other: [f64; 2]) -> bool {
    other[0] <= one[0] && one[1] <= other[1]
}
