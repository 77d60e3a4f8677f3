//! The free space as a raster with a border of its own.

use super::super::recall::{Key, Recall};
use super::super::view::patches::Area;
use super::islands::{self, Islands};
use crate::bands::map_bands;
use crate::bits::{Bits, WORD, Wanted, lowest};
use crate::grid::{Grid, State, whole};
use std::ops::Range;
use std::sync::Arc;

/// The part of the map that holds free space, with one pixel of not-free around it, so that no pass asks for borders.
/// Places on it are in pixels; the centre of pixel (x, y) is (x, y), and rows run upwards.
pub struct Raster {
    pub width: usize,
    pub height: usize,
    /// Column and row of the map at the lower left corner of pixel (0, 0); before the map's where it begins free.
    corner: [f64; 2],
    /// Pixels of the map along the side of one of the raster's.
    pub side: usize,
    /// Metres.
    pub resolution: f64,
    /// Seen free, or something small that stands in free space.
    pub free: Bits,
    /// What stands by itself in free space.
    pub islands: Islands,
}

/// The raster's pixels are as large as this, metres, or smaller, and hold so many of the map's along a side at most.
const SIDE: f64 = 0.05;
const MOST_PIXELS: f64 = 8.0;
/// There are fewer of them than this: more would have no numbers.
const MOST: usize = 1 << 31;

impl Raster {
    /// Nothing when there is no free space.
    pub fn new(grid: &Grid, threads: usize, recall: &Recall) -> Option<Self> {
        let resolution = grid.frame.resolution;
        let mut side = (SIDE / resolution + 1e-9).floor().clamp(1.0, MOST_PIXELS) as usize;
        while (grid.frame.width / side).saturating_mul(grid.frame.height / side) >= MOST {
            side += 1;
        }
        let (w, h) = (grid.frame.width / side, grid.frame.height / side);
        if w == 0 || h == 0 {
            return None;
        }
        let patches = recall.patches(grid, threads);
        let key = |band: &Range<usize>| {
            let seen = Area::NONE.with([0, band.start * side]).with([w * side - 1, band.end * side - 1]);
            patches.map_or(Key::default(), |patches| patches.over(seen)).with(band.start as u64)
        };
        let parts = map_bands([w * side * side, h], threads, |band| {
            recall.free.or_find(|| key(&band), || Arc::new(Part::new(grid, side, w, band.clone())))
        });
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        for part in parts.iter().filter(|part| part.rows[0] <= part.rows[1]) {
            low = [low[0].min(part.columns[0]), low[1].min(part.rows[0])];
            high = [high[0].max(part.columns[1]), part.rows[1]];
        }
        if low[1] > high[1] {
            return None;
        }
        let (width, height) = (high[0] - low[0] + 3, high[1] - low[1] + 3);
        let mut free = Bits::new(width * height);
        for part in parts {
            for y in part.rows[0]..=part.rows[1] {
                let from = (y - part.first) * w + low[0];
                let to = (y - low[1] + 1) * width + 1;
                for n in (0..width - 2).step_by(WORD) {
                    free.add(to + n, part.free.word(from + n) & lowest(width - 2 - n));
                }
            }
        }
        let corner = low.map(|n| side as f64 * (n as f64 - 1.0));
        let resolution = side as f64 * resolution;
        let mut made = Self { width, height, corner, side, resolution, free, islands: Islands::default() };
        made.islands = islands::find(&made);
        for run in made.islands.filled.runs() {
            made.free.fill(run.pixels());
        }
        Some(made)
    }

    /// How many pixels it has.
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Metres in pixels.
    pub fn pixels(&self, metres: f64) -> f64 {
        metres / self.resolution
    }

    /// A place on the raster as a point of the grid, in the grid's pixels.
    pub fn to_grid(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let side = self.side as f64;
        [(x + 0.5) * side + self.corner[0], (y + 0.5) * side + self.corner[1]]
    }

    /// The inverse of [`Raster::to_grid`].
    pub fn of_grid(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let side = self.side as f64;
        [(x - self.corner[0]) / side - 0.5, (y - self.corner[1]) / side - 0.5]
    }

    /// The pixel that holds a place, nothing outside.
    pub fn at(&self, [x, y]: [f64; 2]) -> Option<usize> {
        let (x, y) = (x + 0.5, y + 0.5);
        let (column, row) = (whole(x), whole(y));
        let inside = x >= 0.0 && y >= 0.0 && column < self.width && row < self.height;
        inside.then(|| row * self.width + column)
    }

    /// The centre of a pixel.
    pub fn place(&self, pixel: usize) -> [f64; 2] {
        [(pixel % self.width) as f64, (pixel / self.width) as f64]
    }

    /// Seen free, all of it.
    pub fn is_seen(&self, pixel: usize) -> bool {
        self.free.get(pixel) && !self.islands.filled.contains(pixel)
    }

    /// How many of the map's pixels in a pixel are free.
    pub fn seen_in(&self, grid: &Grid, pixel: usize) -> usize {
        let side = self.side;
        let free = |value: &&u8| grid.table.states[usize::from(**value)] == State::Free;
        let [x, y] = [0, 1].map(|axis| (self.corner[axis] + self.place(pixel)[axis] * side as f64) as usize);
        (y..y + side).map(|y| grid.row(y)[x..x + side].iter().filter(free).count()).sum()
    }

    /// The four pixels that share a side with a pixel that is not on the raster's border.
    pub fn sides(&self, pixel: usize) -> [usize; 4] {
        [pixel - self.width, pixel - 1, pixel + 1, pixel + self.width]
    }
}

/// Rows of the free space before it is known where that begins and ends.
#[derive(Debug)]
pub struct Part {
    first: usize,
    free: Bits,
    /// The first and the last row and column that hold some of it; the first row is beyond the last where none does.
    rows: [usize; 2],
    columns: [usize; 2],
}

impl Part {
    fn new(grid: &Grid, side: usize, width: usize, band: Range<usize>) -> Self {
        let free = Wanted::new(grid.table.states.map(|s| s == State::Free));
        let mut part =
            Self { first: band.start, free: Bits::new(band.len() * width), rows: [usize::MAX, 0], columns: [width, 0] };
        let mut row = vec![true; width];
        for y in band {
            let start = (y - part.first) * width;
            if side == 1 {
                for (n, pixels) in grid.row(y).chunks(WORD).enumerate() {
                    part.free.add(start + n * WORD, free.word(pixels));
                }
            } else {
                row.fill(true);
                (y * side..(y + 1) * side).for_each(|line| clear_taken(grid, &free, line, side, &mut row));
                for (n, flags) in row.chunks(WORD).enumerate() {
                    let word = flags.iter().rev().fold(0, |word, &flag| word << 1 | u64::from(flag));
                    part.free.add(start + n * WORD, word);
                }
            }
            let mut runs = part.free.runs(start..start + width, true);
            if let Some(run) = runs.next() {
                let end = runs.last().unwrap_or(run.clone()).end;
                part.rows = [part.rows[0].min(y), y];
                part.columns = [part.columns[0].min(run.start - start), part.columns[1].max(end - start - 1)];
            }
        }
        part
    }
}

/// Takes out of a row of the raster what is not free in one of the map's rows.
fn clear_taken(grid: &Grid, free: &Wanted, y: usize, side: usize, row: &mut [bool]) {
    for (to, from) in row.iter_mut().zip(grid.row(y).chunks(side)) {
        *to &= from.iter().all(|&value| free.holds(value));
    }
}
