//! Regions on the map's own pixels: what the raster says, and along the walls what is too small for it.

use super::raster::Raster;
use super::runs::{Run, Runs};
use crate::grid::{Grid, State};

/// Maps with more pixels than this keep the raster's outlines.
const MOST_PIXELS: usize = 1 << 26;

/// The regions' numbers, 0 for none, pixel by pixel of the map or, where that is too large, of the raster; like the
/// raster with a border that is of no region.
pub struct Fine {
    pub width: usize,
    pub height: usize,
    pub numbers: Runs,
    /// How many free pixels of the map are of each region, by its number.
    pub areas: Vec<usize>,
    /// Column and row of the grid at the lower left corner of pixel (0, 0), and pixels of the grid along a side.
    corner: [f64; 2],
    side: f64,
}

impl Fine {
    pub fn new(grid: &Grid, raster: &Raster, numbers: Runs, count: usize) -> Self {
        let side = if raster.len() * raster.side.pow(2) <= MOST_PIXELS { raster.side } else { 1 };
        let corner = raster.to_grid([-0.5, -0.5]);
        let (width, height) = (raster.width * side, raster.height * side);
        let mut areas = vec![0; count + 1];
        let filled = &raster.islands.filled;
        for run in &numbers.all {
            areas[run.number as usize] += (run.len() - filled.within(run)) * raster.side.pow(2);
        }
        for pixel in filled.runs().iter().flat_map(Run::pixels) {
            areas[numbers.at(pixel) as usize] += raster.seen_in(grid, pixel);
        }
        let mut made = Self { width, height, numbers, areas, corner, side: (raster.side / side) as f64 };
        if side > 1 {
            made.numbers = made.spread(grid, raster);
        }
        made
    }

    /// A place on it, the centre of pixel (x, y) being (x, y), as a point of the grid.
    pub fn to_grid(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x + 0.5) * self.side + self.corner[0], (y + 0.5) * self.side + self.corner[1]]
    }

    /// The number at a point of the grid.
    pub fn at(&self, [x, y]: [f64; 2]) -> u32 {
        let (x, y) = (((x - self.corner[0]) / self.side).floor(), ((y - self.corner[1]) / self.side).floor());
        let inside = x >= 0.0 && y >= 0.0 && (x as usize) < self.width && (y as usize) < self.height;
        if inside { self.numbers.at(y as usize * self.width + x as usize) } else { 0 }
    }

    /// Free pixels of the map that no free pixel of the raster holds are of the region that is the nearest to walk to.
    fn spread(&mut self, grid: &Grid, raster: &Raster) -> Runs {
        let (side, width) = (raster.side, self.width);
        let free = grid.table.states.map(|s| s == State::Free);
        let mut all = vec![0u32; width * self.height];
        for run in &self.numbers.all {
            let pixels = run.pixels();
            let from = pixels.start / raster.width * side * width + pixels.start % raster.width * side;
            for row in 0..side {
                all[from + row * width..][..run.len() * side].fill(run.number);
            }
        }
        // The raster may begin a pixel of its own before the map does.
        let [left, low] = self.corner.map(|c| c as i64);
        let rows: Vec<Option<&[u8]>> = (0..self.height as i64)
            .map(|y| usize::try_from(y + low).ok().filter(|&y| y < grid.frame.height).map(|y| grid.row(y)))
            .collect();
        let is_free = |x: usize, y: usize| {
            let value = rows[y].and_then(|row| usize::try_from(x as i64 + left).ok().and_then(|x| row.get(x)));
            x > 0 && x + 1 < width && y > 0 && y + 1 < rows.len() && value.is_some_and(|&v| free[usize::from(v)])
        };
        let mut reached: Vec<(usize, usize, u32)> = Vec::new();
        let mut reach = |reached: &mut Vec<(usize, usize, u32)>, x: usize, y: usize, number: u32| {
            if all[y * width + x] == 0 && is_free(x, y) && !raster.is_seen(y / side * raster.width + x / side) {
                all[y * width + x] = number;
                reached.push((x, y, number));
            }
        };
        for run in &self.numbers.all {
            for pixel in run.pixels() {
                let (x, y) = (pixel % raster.width * side, pixel / raster.width * side);
                let [below, before, after, above] = raster.sides(pixel).map(|beside| self.numbers.at(beside) == 0);
                if !(below || before || after || above) {
                    continue;
                }
                for n in 0..side {
                    // No region is on the raster's border.
                    for (open, x, y) in [
                        (below, x + n, y - 1),
                        (before, x - 1, y + n),
                        (after, x + side, y + n),
                        (above, x + n, y + side),
                    ] {
                        if open {
                            reach(&mut reached, x, y, run.number);
                        }
                    }
                }
            }
        }
        let mut next = 0;
        while let Some(&(x, y, number)) = reached.get(next) {
            next += 1;
            self.areas[number as usize] += 1;
            for (x, y) in [(x, y - 1), (x - 1, y), (x + 1, y), (x, y + 1)] {
                reach(&mut reached, x, y, number);
            }
        }
        let mut runs = Vec::new();
        let mut from = 0;
        for same in all.chunk_by(|a, b| a == b) {
            if same[0] != 0 {
                runs.push(Run::new(&(from..from + same.len()), same[0]));
            }
            from += same.len();
        }
        Runs::new(width, all.len(), runs)
    }
}
