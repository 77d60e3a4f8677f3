//! The free space in blocks of pixels: what is wider than a crack shows in them as well, and there are far fewer.

use super::clearance::Rows;
use std::ops::Range;

/// Blocks of so many pixels along a side, with a border of blocks that hold none.
pub struct Blocks {
    side: usize,
    pub width: usize,
    /// The pixels' columns and rows.
    columns: Range<usize>,
    rows: Range<usize>,
    /// The greatest squared clearance in each, in pixels.
    pub clearance: Vec<u32>,
}

impl Blocks {
    /// From the clearances of pixels in some columns and rows, so many along the side of a block.
    pub fn new(side: usize, pixels: &Rows, [columns, rows]: [Range<usize>; 2]) -> Self {
        let width = columns.len().div_ceil(side) + 2;
        let mut clearance = Vec::with_capacity(width * (rows.len().div_ceil(side) + 2));
        clearance.resize(width, 0);
        let mut most = vec![0; columns.len()];
        for y in rows.clone().step_by(side) {
            let mut own = (y..(y + side).min(rows.end)).map(|y| &pixels.row(y)[columns.clone()]);
            own.next().into_iter().for_each(|row| most.copy_from_slice(row));
            for row in own {
                most.iter_mut().zip(row).for_each(|(most, own)| *most = greater(*most, *own));
            }
            clearance.push(0);
            let greatest = |pixels: &[u32]| pixels.iter().fold(0, |most, own| most.max(*own));
            match side {
                2 => {
                    let pairs = most.chunks_exact(2);
                    let last = pairs.remainder();
                    clearance.extend(pairs.map(|pixels| greater(pixels[0], pixels[1])));
                    clearance.extend(last);
                }
                _ => clearance.extend(most.chunks(side).map(greatest)),
            }
            clearance.push(0);
        }
        clearance.resize(clearance.len() + width, 0);
        Self { side, width, columns, rows, clearance }
    }

    /// The pixel of a block that has the greatest clearance, the first of several.
    pub fn widest(&self, block: usize, pixels: &Rows) -> [usize; 2] {
        let part = |all: &Range<usize>, n: usize| {
            let from = all.start + n * self.side;
            from..(from + self.side).min(all.end)
        };
        let columns = part(&self.columns, block % self.width - 1);
        let all = part(&self.rows, block / self.width - 1).flat_map(|y| columns.clone().map(move |x| [x, y]));
        let best = |best: [usize; 2], [x, y]: [usize; 2]| {
            if pixels.row(y)[x] > pixels.row(best[1])[best[0]] { [x, y] } else { best }
        };
        all.reduce(best).unwrap_or([self.columns.start, self.rows.start])
    }

    /// The blocks with so much clearance at least, from the widest to the tightest (a counting sort).
    pub fn by_clearance(&self, least: u32) -> Vec<u32> {
        let top = self.clearance.iter().copied().max().unwrap_or(0) as usize;
        let mut starts = vec![0usize; top + 2];
        let wide = || self.clearance.iter().enumerate().filter(|(_, squared)| **squared >= least);
        wide().for_each(|(_, &squared)| starts[top - squared as usize + 1] += 1);
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut order = vec![0; starts[top + 1]];
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

/// Of two squared clearances, which are less than 2^31, the greater: with a sign they are compared in fewer steps.
fn greater(one: u32, two: u32) -> u32 {
    (one as i32).max(two as i32) as u32
}
