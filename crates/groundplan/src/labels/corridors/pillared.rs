//! Ways in which pillars stand in a line: between that and a wall there is floor too, too little for a way beside the way.

use crate::ends::{overlap, sorted, wider};
use crate::labels::beside::placed;
use crate::labels::corridors::Strip;
use crate::labels::rows::SAME;
use crate::labels::view::runs::{length, runs};
use crate::labels::view::turned::Turned;
use crate::parameters::Parameters;
use std::ops::{Range, RangeInclusive};

/// So many pillars at least, so long along the way, metres, over no more than this share of it: racks' legs are shorter.
const PILLARS: usize = 3;
const LENGTH: RangeInclusive<f64> = 0.35..=1.0;
const SHARE: f64 = 0.25;
/// Behind them one walks over so much floor at least, metres, of which no more than this share is not free.
const BEHIND: f64 = 0.8;
const CLEAR: f64 = 0.02;
/// A wall is where so much of what lies along the way is not free.
const WALL: f64 = 0.8;

/// The strips, each up to the wall behind the pillars at its side that is no farther from these than it is wide, without those
/// that lead along there. It becomes no wider than the widest, nor where another one goes on farther there.
pub fn widened(views: &[Turned], strips: &[Strip], parameters: &Parameters) -> Vec<Strip> {
    let placed = placed(views, strips.iter().map(Strip::place));
    let (mut wide, mut stays) = (strips.to_vec(), vec![true; strips.len()]);
    for (n, strip) in strips.iter().enumerate().filter(|(_, strip)| !strip.bays) {
        for side in [0, 1] {
            let most = strip.width().min(parameters.labels_max_width - wide[n].width());
            let Some(wall) = behind_pillars(&views[strip.direction], strip, side, most) else { continue };
            let behind = sorted([strip.across[side], wall]);
            let mut others = placed[strip.direction].touching(strip.along, behind);
            others.retain(|&m| m != n && overlap(strips[m].across, behind) > SAME);
            let is_behind = |m: &usize| {
                overlap(strips[*m].across, behind) >= strips[*m].width() - SAME
                    && overlap(strips[*m].along, strip.along) >= strips[*m].length() - strip.width()
            };
            if others.iter().all(is_behind) {
                wide[n].across[side] = wall;
                for m in others {
                    stays[m] = false;
                }
            }
        }
    }
    wide.into_iter().zip(stays).filter_map(|(strip, stays)| stays.then_some(strip)).collect()
}

/// Where the wall stands behind the pillars at a side of a strip, across, no farther from it than the most.
fn behind_pillars(view: &Turned, strip: &Strip, side: usize, most: f64) -> Option<f64> {
    let out = if side == 0 { -1.0 } else { 1.0 };
    let at = |off: f64| strip.across[side] + out * off;
    let between = |from: f64, to: f64| sorted([at(from), at(to)]);
    let columns = view.columns(strip.along);
    let steps = (most / view.cell) as usize;
    let is_wall = |step: &usize| {
        let [low, high] = between(*step as f64 * view.cell, (step + 1) as f64 * view.cell);
        view.mean_blocked(columns.clone(), low, high) >= WALL
    };
    let wall = (0..steps).find(is_wall)? as f64 * view.cell;
    if wall < BEHIND + view.cell {
        return None;
    }
    let [low, high] = between(wall - BEHIND, wall - view.cell);
    if view.mean_blocked(columns.clone(), low, high) > CLEAR {
        return None;
    }
    let [low, high] = between(-view.cell, wall - BEHIND);
    are_pillars(view, columns, low, high).then(|| at(wall))
}

/// True when pillars stand in a line in a strip, and nothing else: on both their sides one walks past them.
pub fn stand_in(view: &Turned, strip: &Strip) -> bool {
    let (columns, [low, high]) = (view.columns(strip.along), wider(strip.across, -view.cell));
    let is_clear = |low: f64, high: f64| view.mean_blocked(columns.clone(), low, high) <= CLEAR;
    high - low > 2.0 * BEHIND
        && is_clear(low, low + BEHIND)
        && is_clear(high - BEHIND, high)
        && are_pillars(view, columns, low + BEHIND, high - BEHIND)
}

/// True when what stands in a lane is several things, all as long as pillars, and few.
fn are_pillars(view: &Turned, columns: Range<usize>, low: f64, high: f64) -> bool {
    let stands: Vec<bool> = view.some_blocked(columns, low, high).into_iter().map(|share| share > 0.0).collect();
    let pillars = runs(&stands, true);
    let is_pillar = |&(from, to): &(usize, usize)| LENGTH.contains(&((to - from) as f64 * view.cell));
    pillars.len() >= PILLARS && pillars.iter().all(is_pillar) && length(pillars) as f64 <= SHARE * stands.len() as f64
}
