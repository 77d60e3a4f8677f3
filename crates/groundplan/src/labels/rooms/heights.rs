//! How far it is to what is not free within columns, in the rows that are looked at: one of a few, as a door is wider.

use super::raster::Raster;
use std::ops::Range;

/// So much lies between the rows that are looked at, about, metres.
const APART: f64 = 0.1;
/// And so many rows at most.
const MOST: f64 = 64.0;

/// Some columns and rows of a raster; what is on their border or beyond counts as not free.
#[derive(Clone, Debug)]
pub struct Window {
    pub columns: Range<usize>,
    pub rows: Range<usize>,
    /// Of so many rows the one in the middle is looked at.
    pub step: usize,
}

impl Window {
    pub fn new(raster: &Raster, [columns, rows]: [Range<usize>; 2]) -> Self {
        let step = raster.pixels(APART).round().clamp(1.0, MOST) as usize;
        // The same rows in all windows of a raster.
        Self { columns, rows: rows.start / step * step..rows.end, step }
    }

    pub fn whole(raster: &Raster) -> Self {
        Self::new(raster, [0..raster.width, 0..raster.height])
    }

    /// How many rows are looked at.
    pub fn count(&self) -> usize {
        (self.rows.len() + self.step - 1 - self.step / 2) / self.step
    }

    /// The row that one of those that are looked at is.
    pub fn row(&self, n: usize) -> usize {
        self.rows.start + n * self.step + self.step / 2
    }

    /// Which of those that are looked at a row is, if it is one.
    pub fn looked_at(&self, row: usize) -> Option<usize> {
        let n = (row - self.rows.start) / self.step;
        (self.row(n) == row).then_some(n)
    }

    /// All rows between the last before some of those and the first after them.
    pub fn between(&self, looked_at: &Range<usize>) -> Range<usize> {
        let from = looked_at.start.checked_sub(1).map_or(self.rows.start, |before| self.row(before) + 1);
        from..if looked_at.end < self.count() { self.row(looked_at.end) } else { self.rows.end }
    }

    /// How far it is in a row from how far it is in the one before that is looked at, or that is beyond all.
    pub fn step_up(&self, raster: &Raster, n: usize, row: &mut [u16]) {
        let (from, to) = (self.between(&(n..n + 1)).start, self.row(n));
        self.walk(raster, from..=to, to - from, row);
    }

    /// And from how far it is in the one that follows.
    pub fn step_down(&self, raster: &Raster, n: usize, row: &mut [u16]) {
        let (from, to) = (self.row(n), self.between(&(n..n + 1)).end - 1);
        self.walk(raster, (from..=to).rev(), to - from, row);
    }

    /// Over rows to the last of them, so many after the first. In 16 bits, of which many are looked at together, and where
    /// nothing is nearer than these hold, it is as far as they do.
    fn walk(&self, raster: &Raster, rows: impl Iterator<Item = usize>, after: usize, row: &mut [u16]) {
        for height in row.iter_mut() {
            *height = height.saturating_add(after as u16 + 1);
        }
        for (left, y) in (0..=after as u16).rev().zip(rows) {
            if y == self.rows.start || y + 1 == self.rows.end {
                row.fill(left);
                continue;
            }
            let from = y * raster.width + self.columns.start;
            for run in raster.free.runs(from..from + row.len(), false) {
                row[run.start - from..run.end - from].fill(left);
            }
        }
        row[0] = 0;
        row[self.columns.len() - 1] = 0;
    }

    /// The rows that are looked at in bands of so many.
    pub fn in_bands(&self, band: usize) -> Vec<Range<usize>> {
        (0..self.count()).step_by(band).map(|n| n..(n + band).min(self.count())).collect()
    }

    /// How far it is in the row that follows each band.
    pub fn above(&self, raster: &Raster, bands: &[Range<usize>]) -> Vec<Vec<u16>> {
        let mut row = vec![0; self.columns.len()];
        let mut above = vec![row.clone(); bands.len()];
        for (n, band) in bands.iter().enumerate().skip(1).rev() {
            band.clone().rev().for_each(|n| self.step_down(raster, n, &mut row));
            above[n - 1].clone_from(&row);
        }
        above
    }

    /// How far it is in the row before each band; `row` says so of the row before all of them, and then of the last one.
    pub fn below(&self, raster: &Raster, bands: &[Range<usize>], row: &mut [u16]) -> Vec<Vec<u16>> {
        let before = |band: &Range<usize>| {
            let before = row.to_vec();
            band.clone().for_each(|n| self.step_up(raster, n, row));
            before
        };
        bands.iter().map(before).collect()
    }
}
