//! The free space in blocks of pixels: what is wider than a crack shows in them as well, and there are far fewer.

/// Blocks of so many pixels along a side, with a border of blocks that hold none.
pub struct Blocks {
    side: usize,
    pub width: usize,
    /// The greatest squared clearance in each, in pixels.
    pub clearance: Vec<u32>,
}

impl Blocks {
    /// From the clearances of pixels, so many in a row.
    pub fn new(side: usize, pixels: &[u32], width: usize) -> Self {
        let own = width.div_ceil(side) + 2;
        let mut clearance = Vec::with_capacity(own * ((pixels.len() / width).div_ceil(side) + 2));
        clearance.resize(own, 0);
        let mut most = vec![0; width];
        for rows in pixels.chunks(side * width) {
            most.fill(0);
            for row in rows.chunks(width) {
                most.iter_mut().zip(row).for_each(|(most, own)| *most = (*most).max(*own));
            }
            clearance.push(0);
            clearance.extend(most.chunks(side).map(|pixels| pixels.iter().fold(0, |most, own| most.max(*own))));
            clearance.push(0);
        }
        clearance.resize(clearance.len() + own, 0);
        Self { side, width: own, clearance }
    }

    /// The pixel of a block that has the greatest clearance, the first of several.
    pub fn widest(&self, block: usize, clearance: &[u32], width: usize) -> usize {
        let [x, y] = [block % self.width - 1, block / self.width - 1].map(|n| n * self.side);
        let columns = x..(x + self.side).min(width);
        let rows = y..(y + self.side).min(clearance.len() / width);
        let pixels = rows.flat_map(|y| columns.clone().map(move |x| y * width + x));
        pixels.max_by_key(|&pixel| (clearance[pixel], usize::MAX - pixel)).unwrap_or(0)
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
    pub fn around(&self, block: usize) -> [usize; 8] {
        let (below, above) = (block - self.width, block + self.width);
        [below - 1, below, below + 1, block - 1, block + 1, above - 1, above, above + 1]
    }
}
