//! What a strip's columns are asked: how many of their samples something is true of, and where that is so much.

use super::sums::Rows;
use crate::bits::Bits;
use std::ops::Range;

/// Of how many samples of each column something is true.
pub struct Shares<'a> {
    pub(super) rows: Rows<'a>,
    /// Samples of a column.
    pub(super) count: u32,
}

impl Shares<'_> {
    /// True when there is a sample in each column.
    pub fn has_samples(&self) -> bool {
        self.count > 0
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
