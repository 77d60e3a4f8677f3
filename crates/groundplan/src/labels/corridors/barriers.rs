//! Walls across a strip that leave no more than a door: a corridor ends there, and a room behind is no part of it.

use crate::bits::Bits;
use crate::labels::rooms::{Run, touching};
use crate::labels::view::shares::Shares;
use crate::labels::view::turned::Turned;
use crate::sets::Sets;
use std::ops::Range;

/// Such a wall bars more than this share of the strip.
const BARRED: f64 = 0.55;
/// And is no thicker than this, metres: what is thicker stands in the way, and one passes by.
const THICK: f64 = 0.8;
/// A wall between two docks, which parts a strip along them, bars more than this share of it, is so long and no thicker
/// than this, metres.
const DOCK: f64 = 0.4;
const LONG: f64 = 1.5;
const THIN: f64 = 0.5;
/// And leaves free no more than a door, metres.
const DOOR: f64 = 2.5;
/// A wall with a door in it bars more than this share of what lies beside the strip, on both sides.
const BESIDE: f64 = 0.7;
/// What is barred within so much of the strip's sides is the sides, metres.
const MARGIN: f64 = 0.1;

/// A speck is no more than so many rows of cells high and so many columns long, of which two are beside it.
const SPECK: (usize, usize) = (2, 4);
/// What gets along a strip is so much of it wide.
const GETS_THROUGH: f64 = 0.35;

/// How much of a strip's columns is barred between its sides.
struct Within<'a> {
    barred: Shares<'a>,
    /// Of each column.
    counts: Vec<u32>,
    width: f64,
}

impl<'a> Within<'a> {
    fn new(view: &'a Turned, [low, high]: [f64; 2], range: Range<usize>) -> Self {
        let (low, high) = (low + MARGIN, high - MARGIN);
        let barred = view.barred_in(low, high);
        Self { counts: barred.over(range), barred, width: high - low }
    }

    /// The columns in which a wall no thicker than that bars more than this share, and leaves no more than a door.
    fn walls(&self, view: &Turned, share: f64, thickest: f64) -> Bits {
        let least = self.barred.least(|barred| barred > share && (1.0 - barred) * self.width <= DOOR);
        thin(view, thickest, &Bits::of(&self.counts, |count| *count >= least), self.counts.len())
    }
}

/// The columns of a strip in which such a wall stands; the first of them is the first bit.
pub fn across(view: &Turned, across: [f64; 2], range: Range<usize>) -> Bits {
    Within::new(view, across, range).walls(view, BARRED, THICK)
}

/// The columns in which such a wall stands on both sides of a strip, which leads through a door in it.
pub fn doors(view: &Turned, sides: [[f64; 2]; 2], range: Range<usize>) -> Bits {
    let [one, two] = beside(view, sides, &range);
    thin(view, THICK, &(&one & &two), range.len())
}

/// [`across`] of columns in which such a wall goes on beyond a side of the strip: goods do not.
pub fn beyond_a_side(view: &Turned, strip: [f64; 2], sides: [[f64; 2]; 2], range: Range<usize>) -> Bits {
    let [mut one, two] = beside(view, sides, &range);
    one |= &two;
    &across(view, strip, range) & &one
}

/// At which columns a wall stands beside a strip, on each side.
fn beside(view: &Turned, sides: [[f64; 2]; 2], range: &Range<usize>) -> [Bits; 2] {
    sides.map(|[low, high]| view.barred_where(range.clone(), low, high, |barred| barred > BESIDE))
}

/// Columns of what is so thick, metres.
fn columns(view: &Turned, thick: f64) -> usize {
    (thick / view.cell).ceil() as usize
}

/// So many columns without runs of them that are thicker than so much, metres.
fn thin(view: &Turned, thickest: f64, thick: &Bits, count: usize) -> Bits {
    let longest = columns(view, thickest);
    let mut thin = Bits::new(count);
    thick.runs(0..count, true).filter(|run| run.len() <= longest).for_each(|run| thin.fill(run));
    thin
}

/// [`across`] of some columns, and walls between docks, as they are among all.
pub fn among(view: &Turned, across: [f64; 2], range: Range<usize>) -> Bits {
    // What is thicker beyond the range is no wall within it.
    let more = columns(view, THICK) + 1;
    let wider = range.start.saturating_sub(more)..(range.end + more).min(view.size[0]);
    let first = range.start - wider.start;
    let within = Within::new(view, across, wider);
    let mut walls = within.walls(view, BARRED, THICK);
    walls |= &within.walls(view, DOCK.max(LONG / within.width.max(view.cell)), THIN);
    walls.part(first..first + range.len())
}

/// Rows of columns without pieces that are no larger than a speck.
fn without_specks(barred: &[Bits], count: usize) -> Vec<Bits> {
    // As pixels, no two rows of which meet at their ends.
    let width = count + 2;
    let on_row = |(row, n): (&Bits, usize)| -> Vec<Run> {
        let place = n * width;
        row.runs(0..count, true).map(|run| Run::new(&(place + run.start..place + run.end), 0)).collect()
    };
    let runs: Vec<Run> = barred.iter().zip(0..).flat_map(on_row).collect();
    let mut sets = Sets::new(runs.len());
    touching(&runs, width, 1, |own, below| sets.join_first(own as u32, below as u32));
    let (pieces, found) = sets.numbered();
    let row_of = |run: &Run| run.pixels().start / width;
    let columns_of = |run: &Run| run.pixels().start % width..run.pixels().end - row_of(run) * width;
    // Of each piece its first row and column and its last ones.
    let mut boxes = vec![[usize::MAX, 0, usize::MAX, 0]; found + 1];
    for (run, &piece) in runs.iter().zip(&pieces) {
        let (row, columns) = (row_of(run), columns_of(run));
        let [low, high, from, to] = &mut boxes[piece as usize];
        (*low, *high) = ((*low).min(row), (*high).max(row));
        (*from, *to) = ((*from).min(columns.start), (*to).max(columns.end));
    }
    let mut left = vec![Bits::new(count); barred.len()];
    for (run, &piece) in runs.iter().zip(&pieces) {
        let [low, high, from, to] = boxes[piece as usize];
        if high - low + 1 > SPECK.0 || to - from > SPECK.1 {
            left[row_of(run)].fill(columns_of(run));
        }
    }
    left
}

/// Where a square of a share of the strip's width, which never turns back, gets no further along it: a wall askew to
/// the strip bars no column for itself. Beyond each such column it begins anew.
pub fn stops(view: &Turned, across: [f64; 2], range: Range<usize>) -> Vec<usize> {
    let count = ((across[1] - across[0]) / view.cell).round().max(1.0) as usize;
    let side = ((GETS_THROUGH * count as f64) as usize).max(1);
    // On the borders of cells: from between them a cell might be none, and none is barred.
    let first = ((across[0] - view.start[1]) / view.cell).round() * view.cell + view.start[1];
    let place = |n: usize| first + n as f64 * view.cell;
    let mut found = Vec::new();
    // Mostly nothing stands there.
    let barred = view.barred_in(place(0), place(count));
    if barred.first(range.clone(), barred.least(|barred| barred > 0.0)).is_none() {
        return found;
    }
    // Or past it there is room all along.
    let is_clear = |low: usize| {
        let ends = [place(low), place(low + side)];
        // Beyond the map nothing gets through.
        let on_map = view.cells_in(ends[0], ends[1]) as usize == side;
        on_map && view.barred_in(ends[0], ends[1]).first(range.clone(), 1).is_none()
    };
    if (0..=count.saturating_sub(side)).step_by(side.div_ceil(2)).any(is_clear) {
        return found;
    }
    // For how many columns each place across has been free, and what is reached there.
    let mut free_for = vec![side; count];
    let mut reached = vec![true; count];
    let row = |n: usize| view.barred_where(range.clone(), place(n), place(n) + view.cell, |barred| barred > 0.0);
    let barred = without_specks(&(0..count).map(row).collect::<Vec<_>>(), range.len());
    let mut some = Bits::new(range.len());
    for barred in &barred {
        some |= barred;
    }
    // So far behind all that stands there it is as if nothing did.
    for near in some.joined(0..range.len(), side - 1) {
        for c in near.start..(near.end + side).min(range.len()) {
            for (columns, barred) in free_for.iter_mut().zip(&barred) {
                *columns = if barred.get(c) { 0 } else { *columns + 1 };
            }
            let (mut from, mut gets_on) = (0, false);
            for alike in free_for.chunk_by(|one, next| (*one >= side) == (*next >= side)) {
                let own = &mut reached[from..from + alike.len()];
                let is_reached = alike[0] >= side && alike.len() >= side && own.contains(&true);
                own.fill(is_reached);
                gets_on |= is_reached;
                from += alike.len();
            }
            if !gets_on {
                found.push(range.start + c);
                free_for.fill(side);
                reached.fill(true);
            }
        }
    }
    found
}
