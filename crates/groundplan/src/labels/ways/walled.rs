//! Where a wall ends a row and the ways beside it.

use super::across::{crossing, leading_across};
use crate::bits::Bits;
use crate::ends::{holds, sorted};
use crate::labels::beside::Beside;
use crate::labels::corridors::Strip;
use crate::labels::rows::Row;
use crate::labels::rows::sections::WIDTH;
use crate::labels::view::turned::Turned;
use std::ops::Range;

/// A wall runs along a side where over this share of it so much of what lies so far beyond it, metres, is not free.
const WALL: f64 = 0.9;
const TAKEN: f64 = 0.2;
const BEYOND: f64 = 0.6;

/// Along which of a strip's sides a wall runs from end to end.
pub fn sides(view: &Turned, strip: &Strip) -> [bool; 2] {
    let columns = view.columns(strip.along);
    [0, 1].map(|n| {
        let side = strip.across[n];
        let ends = sorted([side, side + [-BEYOND, BEYOND][n]]);
        let taken = view.some_blocked(columns.clone(), ends[0], ends[1]);
        taken.iter().filter(|share| **share >= TAKEN).count() as f64 >= WALL * taken.len() as f64
    })
}

/// Along which one, if along one alone.
pub fn side(view: &Turned, strip: &Strip) -> Option<usize> {
    match sides(view, strip) {
        [true, false] => Some(0),
        [false, true] => Some(1),
        _ => None,
    }
}

/// In which of a range of columns, the first of which is the first bit, a wall ends a row and both ways beside it; or one
/// of them, where the other leads on through a gate in that wall for longer than it is wide.
pub fn ends(view: &Turned, strips: &[Strip], row: &Row, between: [usize; 2], columns: Range<usize>) -> Bits {
    let [below, above] = between.map(|n| &strips[n]);
    let [low, high] = [below.across[0], above.across[1]];
    let mut walled = view.some_closed(columns.clone(), low, high);
    for (other, low, high) in [(above, low, row.across[1]), (below, row.across[0], high)] {
        let [from, to] = [other.along[0] + other.width(), other.along[1] - other.width()];
        let bit = |u: f64| view.column(u).clamp(columns.start, columns.end) - columns.start;
        if from < to {
            let mut leads_on = Bits::new(columns.len());
            leads_on.fill(bit(from)..bit(to));
            walled |= &(&view.some_closed(columns.clone(), low, high) & &leads_on);
        }
    }
    walled
}

/// A row with what lies beyond its ends up to the walls there, if that may be a way and no other is there.
pub fn up_to_walls(views: &[Turned], strips: &[Strip], placed: &[Beside], widest: f64, row: &Row) -> Row {
    let mut reaching = row.clone();
    let (Some(between), Some(other)) = (row.between, crossing(views, row.direction)) else { return reaching };
    let view = &views[row.direction];
    let middle = f64::midpoint(row.across[0], row.across[1]);
    let near = leading_across([view, other], placed, row, widest);
    let is_crossed = |u: f64| {
        near.iter().map(|&n| &strips[n]).any(|strip| {
            let [s, at] = view.crossing(other, middle, strip.middle());
            holds(strip.along, s) && (at - u).abs() < strip.width()
        })
    };
    let most = (WIDTH.1 / view.cell) as usize;
    for (side, end) in row.along.into_iter().enumerate() {
        if is_crossed(end) {
            continue;
        }
        let column = view.column(end);
        let beyond =
            if side == 0 { column.saturating_sub(most)..column } else { column..(column + most).min(view.size[0]) };
        let count = beyond.len();
        let closed = ends(view, strips, row, between, beyond);
        let free = (0..count).find(|&n| closed.get(if side == 0 { count - 1 - n } else { n }));
        if let Some(free) = free {
            let by = free as f64 * view.cell;
            reaching.along[side] += if side == 0 { -by } else { by };
        }
    }
    reaching
}
