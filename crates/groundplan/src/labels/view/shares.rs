//! What a strip's columns are asked: how many of their samples something is true of, and where that is so much.

use super::sums::{Rows, What};
use super::turned::Turned;
use crate::bits::Bits;
use std::ops::Range;

/// Nothing gets through where more than this share is not free, or more than this is barred by a wall, be it thin.
pub const IMPASSABLE: f64 = 0.7;
pub const BARRED: f64 = 0.7;

/// Of how many samples of each column something is true.
pub struct Shares<'a> {
    rows: Rows<'a>,
    /// Samples of a column, and of a cell.
    count: u32,
    each: u32,
}

impl Shares<'_> {
    /// True when there is a sample in each column.
    pub fn has_samples(&self) -> bool {
        self.count > 0
    }

    /// Shares of so many cells, however many a column has here.
    pub fn of_cells(self, cells: u32) -> Self {
        Self { count: cells * self.each, ..self }
    }

    /// Of so many samples of a column.
    pub fn at(&self, column: usize) -> u32 {
        self.rows.at(column)
    }

    /// The first of some columns with so many.
    pub fn first(&self, columns: Range<usize>, least: u32) -> Option<usize> {
        self.rows.first(columns, least)
    }

    /// The last of some columns with so many.
    pub fn last(&self, columns: Range<usize>, least: u32) -> Option<usize> {
        self.rows.last(columns, least)
    }

    /// The stretches of so many columns at least in none of which so many samples are, and none of which is a rival's.
    pub fn open(&self, within: Range<usize>, least: usize, closed: u32, rivals: &[Range<usize>]) -> Vec<Range<usize>> {
        let count = within.end;
        let mut stretches = Vec::new();
        let mut from = within.start;
        while from + least <= count {
            // From its far end, so that most columns are never asked.
            let of_rival = |rival: &Range<usize>| (rival.start.max(from)..rival.end.min(from + least)).last();
            let last = self.last(from..from + least, closed);
            if let Some(last) = last.max(rivals.iter().filter_map(of_rival).max()) {
                from = last + 1;
                continue;
            }
            let ahead = |rival: &Range<usize>| (rival.start.max(from + least)..rival.end.min(count)).next();
            let next = self.first(from + least..count, closed);
            let to = next.into_iter().chain(rivals.iter().filter_map(ahead)).min().unwrap_or(count);
            stretches.push(from..to);
            from = to + 1;
        }
        stretches
    }

    /// The same of a range of columns.
    pub fn over(&self, columns: Range<usize>) -> Vec<u32> {
        self.rows.over(columns)
    }

    /// Which of a range of columns have so many; the first of them is the first bit.
    pub fn reached(&self, columns: Range<usize>, least: u32) -> Bits {
        self.rows.reached(columns, least)
    }

    /// What share so many samples are. Where there is no sample the share is all.
    pub fn share(&self, samples: u32) -> f64 {
        if self.count == 0 { 1.0 } else { f64::from(samples) / f64::from(self.count) }
    }

    /// The least number of samples whose share is as much as is asked for.
    pub fn least(&self, is_enough: impl Fn(f64) -> bool) -> u32 {
        let (mut low, mut high) = (0, self.count + 1);
        while low < high {
            let middle = low.midpoint(high);
            if is_enough(self.share(middle)) { high = middle } else { low = middle + 1 }
        }
        low
    }
}

impl Turned {
    /// Share of a column that is not free between two places across, 0 to 1; all of it where there is no cell between.
    pub fn blocked(&self, column: usize, low: f64, high: f64) -> f64 {
        self.share(What::Blocked, column, low, high)
    }

    /// Share of the way across a column that is barred: something stands in it, or in the columns beside it.
    fn barred(&self, column: usize, low: f64, high: f64) -> f64 {
        self.share(What::Barred, column, low, high)
    }

    /// True when nothing gets through a column between two places across.
    pub fn is_closed(&self, column: usize, low: f64, high: f64) -> bool {
        is_closed(self.blocked(column, low, high), self.barred(column, low, high))
    }

    /// True when something stands across a column, be it thin.
    pub fn is_barred(&self, column: usize, low: f64, high: f64) -> bool {
        self.barred(column, low, high) > BARRED
    }

    /// Share of a column that is occupied.
    pub fn occupied(&self, column: usize, low: f64, high: f64) -> f64 {
        self.share(What::Occupied, column, low, high)
    }

    fn share(&self, what: What, column: usize, low: f64, high: f64) -> f64 {
        let of = self.shares_in(what, low, high);
        of.share(of.at(column))
    }

    /// How many of a cell's samples, or cells, are asked.
    fn counts(&self, what: What) -> u32 {
        if matches!(what, What::Barred) { 1 } else { self.samples.pow(2) }
    }

    /// [`Turned::blocked`] of all columns.
    pub fn all_blocked(&self, low: f64, high: f64) -> Vec<f64> {
        self.shares(What::Blocked, 0..self.size[0], low, high)
    }

    /// [`Turned::blocked`] of a range of columns.
    pub fn some_blocked(&self, columns: Range<usize>, low: f64, high: f64) -> Vec<f64> {
        self.shares(What::Blocked, columns, low, high)
    }

    /// The mean of [`Turned::blocked`] over a range of columns; 1 where there are none, as beyond the map nothing is known
    /// to be free.
    pub fn mean_blocked(&self, columns: Range<usize>, low: f64, high: f64) -> f64 {
        let shares = self.some_blocked(columns, low, high);
        if shares.is_empty() { 1.0 } else { shares.iter().sum::<f64>() / shares.len() as f64 }
    }

    /// Share of a range of columns in which something stands between two places across.
    pub fn share_touched(&self, columns: Range<usize>, low: f64, high: f64) -> f64 {
        let shares = self.some_occupied(columns, low, high);
        shares.iter().filter(|share| **share > 0.0).count() as f64 / shares.len().max(1) as f64
    }

    /// [`Turned::occupied`] of a range of columns.
    pub fn some_occupied(&self, columns: Range<usize>, low: f64, high: f64) -> Vec<f64> {
        self.shares(What::Occupied, columns, low, high)
    }

    /// True when something stands in a range of columns between two places across.
    pub fn stands_in(&self, columns: Range<usize>, [low, high]: [f64; 2]) -> bool {
        self.some_occupied(columns, low, high).iter().any(|share| *share > 0.0)
    }

    /// [`Turned::is_closed`] of a range of columns, the first of which is the first bit.
    pub fn some_closed(&self, columns: Range<usize>, low: f64, high: f64) -> Bits {
        let mut closed = self.blocked_where(columns.clone(), low, high, |blocked| blocked > IMPASSABLE);
        closed |= &self.barred_where(columns, low, high, |barred| barred > BARRED);
        closed
    }

    /// In which of a range of columns, the first of which is the first bit, [`Turned::blocked`] is as much as is asked
    /// for, which all that is more is too.
    pub fn blocked_where(&self, columns: Range<usize>, low: f64, high: f64, is: impl Fn(f64) -> bool) -> Bits {
        let of = self.blocked_in(low, high);
        of.reached(columns, of.least(is))
    }

    /// The same of [`Turned::barred`].
    pub fn barred_where(&self, columns: Range<usize>, low: f64, high: f64, is: impl Fn(f64) -> bool) -> Bits {
        let of = self.barred_in(low, high);
        of.reached(columns, of.least(is))
    }

    /// How much of every column is not free between two places across, as it is counted.
    pub fn blocked_in(&self, low: f64, high: f64) -> Shares<'_> {
        self.shares_in(What::Blocked, low, high)
    }

    /// The same of what is occupied.
    pub fn occupied_in(&self, low: f64, high: f64) -> Shares<'_> {
        self.shares_in(What::Occupied, low, high)
    }

    /// The same of what is barred.
    pub fn barred_in(&self, low: f64, high: f64) -> Shares<'_> {
        self.shares_in(What::Barred, low, high)
    }

    /// Cells of a column between two places across.
    pub fn cells_in(&self, low: f64, high: f64) -> u32 {
        let (from, to) = self.cells(low, high);
        (to - from) as u32
    }

    fn shares_in(&self, what: What, low: f64, high: f64) -> Shares<'_> {
        let (from, to) = self.cells(low, high);
        self.shares_of(what, from..to)
    }

    /// How much of every column something is true of in some rows of cells, as it is counted.
    pub fn shares_of(&self, what: What, rows: Range<usize>) -> Shares<'_> {
        let each = self.counts(what);
        Shares { rows: self.cells.rows(what, rows.start, rows.end), count: rows.len() as u32 * each, each }
    }

    fn shares(&self, what: What, columns: Range<usize>, low: f64, high: f64) -> Vec<f64> {
        let of = self.shares_in(what, low, high);
        of.over(columns).into_iter().map(|samples| of.share(samples)).collect()
    }
}

fn is_closed(blocked: f64, barred: f64) -> bool {
    blocked > IMPASSABLE || barred > BARRED
}
