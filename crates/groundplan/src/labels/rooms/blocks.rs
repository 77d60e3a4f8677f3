//! The free space in blocks of pixels: what is wider than a crack shows in them as well, and there are far fewer.

use super::clearance::Rows;
use super::heights::Window;
use super::raster::Raster;
use std::ops::Range;

/// So wide is a block, about, metres: what a narrow parts is larger.
const WIDE: f64 = 0.14;
/// And so many pixels at most.
const MOST: f64 = 64.0;

/// Blocks of a few pixels along and across, with a border of blocks that hold none.
pub struct Blocks<'a> {
    /// Pixels along a row.
    wide: usize,
    pub width: usize,
    /// The pixels' columns, and the first of the rows that are looked at.
    columns: Range<usize>,
    first: usize,
    /// The greatest squared clearance in each, in pixels.
    pub clearance: &'a [u32],
}

impl<'a> Blocks<'a> {
    /// From the clearances of pixels in some columns and rows, of which each that is looked at is a row of blocks. They
    /// take the room of others.
    pub fn new(
        raster: &Raster,
        pixels: &Rows,
        Window { columns, rows, step }: &Window,
        clearance: &'a mut Vec<u32>,
    ) -> Self {
        let wide = raster.pixels(WIDE).round().clamp(1.0, MOST) as usize;
        let from = &pixels.window;
        let within = columns.start - from.columns.start..columns.end - from.columns.start;
        let first = (rows.start - from.rows.start) / step;
        let height = (rows.end - from.rows.start).div_ceil(*step).min(from.count()) - first;
        let width = columns.len().div_ceil(wide) + 2;
        clearance.clear();
        clearance.reserve_exact(width * (height + 2));
        clearance.resize(width, 0);
        for n in first..first + height {
            clearance.push(0);
            let row = &pixels.row(n)[within.clone()];
            let greatest = |pixels: &[u32]| pixels.iter().fold(0, |most, own| most.max(*own));
            match wide {
                3 => {
                    let threes = row.chunks_exact(3);
                    let rest = threes.remainder();
                    clearance.extend(threes.map(|three| three[0].max(three[1]).max(three[2])));
                    clearance.extend((!rest.is_empty()).then(|| greatest(rest)));
                }
                _ => clearance.extend(row.chunks(wide).map(greatest)),
            }
            clearance.push(0);
        }
        clearance.resize(clearance.len() + width, 0);
        Self { wide, width, columns: columns.clone(), first, clearance }
    }

    /// The pixel of a block that has the greatest clearance, the first of several.
    pub fn widest(&self, block: usize, pixels: &Rows) -> [usize; 2] {
        let n = self.first + block / self.width - 1;
        let from = self.columns.start + (block % self.width - 1) * self.wide;
        let within = &pixels.row(n)[from - pixels.window.columns.start..];
        let place = within[..self.wide.min(within.len())].iter().position(|&own| own == self.clearance[block]);
        [from + place.unwrap_or(0), pixels.window.row(n)]
    }

    /// The blocks with so much clearance at least, from the widest to the tightest (a counting sort). They take the room of
    /// others.
    pub fn by_clearance<'o>(&self, least: u32, order: &'o mut Vec<u32>) -> &'o [u32] {
        let top = self.clearance.iter().copied().max().unwrap_or(0) as usize;
        let mut starts = vec![0usize; top + 2];
        let wide = || self.clearance.iter().enumerate().filter(|(_, squared)| **squared >= least);
        wide().for_each(|(_, &squared)| starts[top - squared as usize + 1] += 1);
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        order.resize(starts[top + 1], 0);
        for (block, &squared) in wide() {
            let start = &mut starts[top - squared as usize];
            order[*start] = block as u32;
            *start += 1;
        }
        order
    }

    /// The eight blocks around one that is not on the border.
    pub fn beside(&self, block: usize) -> [usize; 8] {
        let (below, above) = (block - self.width, block + self.width);
        [below - 1, below, below + 1, block - 1, block + 1, above - 1, above, above + 1]
    }

    /// What blocks have, of the eight around one that is not on the border in the same order; read three by three, which
    /// is faster than one by one.
    pub fn around(&self, block: usize, all: &[u32]) -> [u32; 8] {
        let three = |middle: usize| <[u32; 3]>::try_from(&all[middle - 1..middle + 2]).unwrap_or_default();
        let [below, own, above] = [block - self.width, block, block + self.width].map(three);
        [below[0], below[1], below[2], own[0], own[2], above[0], above[1], above[2]]
    }
}
