//! The free space that keeps a clearance, a bit for each pixel; by rows and by columns, so that both can be searched 64
//! pixels at a time.

use crate::bits;
use crate::sets::Sets;
use std::f64::consts::FRAC_1_SQRT_2;

/// Pixels as bits, row by row; within one blank pixel on all sides, so that every pixel has eight neighbours.
#[derive(Clone, Debug)]
pub struct Bits {
    pub width: usize,
    pub height: usize,
    pub stride: usize,
    pub words: Vec<u64>,
}

impl Bits {
    /// Blank.
    pub fn new(width: usize, height: usize) -> Self {
        let stride = width.div_ceil(64);
        Self { width, height, stride, words: vec![0; stride * height] }
    }

    pub fn has(&self, x: usize, y: usize) -> bool {
        self.words[y * self.stride + x / 64] >> (x % 64) & 1 == 1
    }

    pub fn row(&self, y: usize) -> &[u64] {
        &self.words[y * self.stride..(y + 1) * self.stride]
    }

    pub fn row_mut(&mut self, y: usize) -> &mut [u64] {
        &mut self.words[y * self.stride..(y + 1) * self.stride]
    }

    /// Sets the pixels `from..to` of a row.
    pub fn fill(&mut self, y: usize, from: usize, to: usize) {
        let row = self.row_mut(y);
        let mut x = from;
        while x < to {
            let end = (x / 64 * 64 + 64).min(to);
            let mask = (u64::MAX >> (64 - (end - x))) << (x % 64);
            row[x / 64] |= mask;
            x = end;
        }
    }

    /// Columns for rows.
    fn transposed(&self) -> Self {
        let mut made = Self::new(self.height, self.width);
        let mut block = [0u64; 64];
        for high in 0..made.stride {
            for word in 0..self.stride {
                for (n, entry) in block.iter_mut().enumerate() {
                    let y = high * 64 + n;
                    *entry = if y < self.height { self.words[y * self.stride + word] } else { 0 };
                }
                transpose(&mut block);
                for (n, &entry) in block.iter().enumerate().take(self.width.saturating_sub(word * 64)) {
                    made.words[(word * 64 + n) * made.stride + high] = entry;
                }
            }
        }
        made
    }

    /// Every pixel whose centre is less than `radius` pixels from a set one's square.
    pub fn dilated(&self, radius: f64) -> Self {
        let mut made = Self::new(self.width, self.height);
        // How far to both sides a pixel reaches in the rows that are so far away.
        let span = |dy: usize| {
            let up = (dy as f64 - 0.5).max(0.0);
            (up < radius).then(|| ((radius * radius - up * up).sqrt() + 0.5).ceil() as usize - 1)
        };
        let spans: Vec<usize> = (0..).map_while(span).collect();
        if spans.is_empty() {
            return self.clone();
        }
        let reach = spans.len() - 1;
        let mut row = vec![0u64; self.stride];
        for y in 0..self.height {
            if self.row(y).iter().all(|&word| word == 0) {
                continue;
            }
            row.copy_from_slice(self.row(y));
            let mut grown = 0;
            for dy in (0..=reach).rev() {
                for _ in grown..spans[dy] {
                    grow(&mut row);
                }
                grown = spans[dy];
                for to in [y.checked_sub(dy), Some(y + dy).filter(|&to| dy > 0 && to < self.height)] {
                    let Some(to) = to else { continue };
                    made.row_mut(to).iter_mut().zip(&row).for_each(|(a, b)| *a |= b);
                }
            }
        }
        made
    }
}

impl Bits {
    /// The set pixels and their eight neighbours.
    fn grown(&self) -> Self {
        let mut made = Self::new(self.width, self.height);
        let mut row = vec![0u64; self.stride];
        for y in 0..self.height {
            row.copy_from_slice(self.row(y));
            grow(&mut row);
            for to in y.saturating_sub(1)..(y + 2).min(self.height) {
                made.row_mut(to).iter_mut().zip(&row).for_each(|(a, b)| *a |= b);
            }
        }
        made
    }
}

/// Sets the neighbours of the set bits of a row.
fn grow(row: &mut [u64]) {
    let mut before = 0u64;
    for n in 0..row.len() {
        let (word, after) = (row[n], row.get(n + 1).copied().unwrap_or(0));
        row[n] = word | word << 1 | word >> 1 | before >> 63 | after << 63;
        before = word;
    }
}

/// A block of 64 x 64 bits, rows for columns: halves are exchanged, then halves of halves.
fn transpose(block: &mut [u64; 64]) {
    let (mut half, mut mask) = (32, 0xffff_ffffu64);
    while half > 0 {
        let mut k = 0;
        while k < 64 {
            let moved = (block[k] >> half ^ block[k + half]) & mask;
            block[k] ^= moved << half;
            block[k + half] ^= moved;
            k = (k + half + 1) & !half;
        }
        half >>= 1;
        mask ^= mask << half;
    }
}

/// Pixels to go over, from centre to centre.
#[derive(Clone, Debug)]
pub struct Layer {
    pub rows: Bits,
    /// The same, columns for rows.
    pub columns: Bits,
    /// Pieces that hang together: runs (from, to, piece) of each row, and where the rows begin.
    runs: Vec<(u32, u32, u32)>,
    row_runs: Vec<u32>,
}

/// A little more than rounding may move a place, pixels.
const ROUNDED: f64 = 1e-4;

/// Where a robot's middle may be.
#[derive(Clone, Debug)]
pub struct Space {
    /// Pixels from whose centres to the next one's one may go.
    pub tight: Layer,
    /// Pixels in which one may be anywhere, and those of `tight` where a passage leaves no such.
    pub roomy: Layer,
    /// Pixels in which one may be anywhere.
    pub safe: Bits,
    occupied: Bits,
    radius: f64,
}

/// A pixel of the space, counted with the blank border.
pub type Pixel = [usize; 2];

impl Space {
    /// Free pixels that keep a clearance, in pixels, from the squares of the occupied ones.
    pub fn new(free: Bits, occupied: Bits, clearance: f64) -> Self {
        // Half way between two centres one is nearer to what both keep the clearance from: a step is at most a diagonal
        // long, and with both ends this far away no point of it is too near.
        let radius = if clearance > 0.0 { (clearance * clearance + 0.5).sqrt() } else { 0.0 };
        let less = |mut free: Bits, radius: f64| {
            if radius > 0.0 {
                let taken = occupied.dilated(radius);
                free.words.iter_mut().zip(&taken.words).for_each(|(free, taken)| *free &= !taken);
            }
            free
        };
        // Anywhere in a pixel is at most half a diagonal from its centre.
        let safe = less(free.clone(), if clearance > 0.0 { clearance + FRAC_1_SQRT_2 + ROUNDED } else { 0.0 });
        let tight = less(free, radius);
        // Along a wall there is room within a pixel of what is tight; where there is none, it is a passage.
        let mut narrow = tight.clone();
        narrow.words.iter_mut().zip(&safe.grown().words).for_each(|(narrow, near)| *narrow &= !near);
        let mut roomy = narrow.grown().grown();
        for ((roomy, tight), safe) in roomy.words.iter_mut().zip(&tight.words).zip(&safe.words) {
            *roomy = *roomy & tight | safe;
        }
        Self { tight: Layer::new(tight), roomy: Layer::new(roomy), safe, occupied, radius }
    }

    /// The pixel of a place where one may be: its own keeps the clearance, and so does the place itself.
    pub fn pixel(&self, place: [f64; 2]) -> Option<Pixel> {
        let rows = &self.tight.rows;
        let [x, y] = place.map(f64::floor);
        if !(x >= 0.0 && y >= 0.0 && x < rows.width as f64 && y < rows.height as f64) {
            return None;
        }
        let (x, y) = (x as usize, y as usize);
        let reach = self.radius.ceil() as usize + 1;
        let near = |n: usize, size: usize| n.saturating_sub(reach)..(n + reach + 1).min(size);
        let beyond = |n: usize, at: f64| (n as f64 - at).max(at - n as f64 - 1.0).max(0.0);
        let taken = |(x, y): (usize, usize)| {
            // By what places are rounded to, a pixel's middle may lie nearer.
            self.occupied.has(x, y) && libm::hypot(beyond(x, place[0]), beyond(y, place[1])) < self.radius - ROUNDED
        };
        let columns = near(x, rows.width);
        let is_open = rows.has(x, y) && !near(y, rows.height).any(|y| columns.clone().any(|x| taken((x, y))));
        is_open.then_some([x, y])
    }

    /// A pixel of the roomy layer, a step from another at most.
    pub fn roomy_beside(&self, [x, y]: Pixel) -> Option<Pixel> {
        let steps = [(1, 1), (1, 0), (1, 2), (0, 1), (2, 1), (0, 0), (0, 2), (2, 0), (2, 2)];
        let open =
            |&[bx, by]: &Pixel| self.roomy.rows.has(bx, by) && self.tight.rows.has(x, by) && self.tight.rows.has(bx, y);
        steps.map(|(dx, dy)| [x + dx - 1, y + dy - 1]).into_iter().find(open)
    }
}

impl Layer {
    fn new(rows: Bits) -> Self {
        let columns = rows.transposed();
        let mut made = Self { rows, columns, runs: Vec::new(), row_runs: vec![0] };
        made.find_pieces();
        made
    }

    fn find_pieces(&mut self) {
        let mut sets = Sets::new(0);
        let mut below = 0..0;
        for y in 0..self.rows.height {
            let start = self.runs.len();
            let row = bits::runs(self.rows.row(y), 0..self.rows.stride * 64, true);
            self.runs.extend(row.map(|run| (run.start as u32, run.end as u32, sets.add())));
            let mut other = below.start;
            for n in start..self.runs.len() {
                let (from, to, _) = self.runs[n];
                while other < below.end && self.runs[other].1 <= from {
                    other += 1;
                }
                let mut touching = other;
                while touching < below.end && self.runs[touching].0 < to {
                    sets.join_first(n as u32, touching as u32);
                    touching += 1;
                }
            }
            below = start..self.runs.len();
            self.row_runs.push(self.runs.len() as u32);
        }
        for n in 0..self.runs.len() {
            self.runs[n].2 = sets.of(n as u32);
        }
    }

    /// The piece that a pixel of the space is in.
    pub fn piece(&self, [x, y]: Pixel) -> Option<u32> {
        let runs = &self.runs[self.row_runs[y] as usize..self.row_runs[y + 1] as usize];
        let run = runs.get(runs.partition_point(|run| run.1 as usize <= x))?;
        (run.0 as usize <= x).then_some(run.2)
    }

    /// The pixel of the space nearest to a place, within `reach` pixels; places as in [`super::Ways`].
    pub fn nearest(&self, place: [f64; 2], reach: f64) -> Option<Pixel> {
        let mut best: Option<(f64, Pixel)> = None;
        let centre = place[1].floor() as i64;
        for dy in 0..=reach.ceil() as i64 + 1 {
            let rows = [Some(centre - dy), (dy > 0).then_some(centre + dy)];
            for y in rows.into_iter().flatten().filter(|&y| y >= 0 && y < self.rows.height as i64) {
                let up = (y as f64 + 0.5 - place[1]).abs();
                if up > best.map_or(reach, |held| held.0) {
                    continue;
                }
                for run in &self.runs[self.row_runs[y as usize] as usize..self.row_runs[y as usize + 1] as usize] {
                    let x = place[0].floor().clamp(f64::from(run.0), f64::from(run.1 - 1));
                    let apart = libm::hypot(x + 0.5 - place[0], up);
                    if apart <= reach && best.is_none_or(|held| apart < held.0) {
                        best = Some((apart, [x as usize, y as usize]));
                    }
                }
            }
            if best.is_some_and(|held| (dy as f64) > held.0 + 1.0) {
                break;
            }
        }
        best.map(|held| held.1)
    }
}
