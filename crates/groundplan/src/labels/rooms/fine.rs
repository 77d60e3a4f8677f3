//! Regions on the map's own pixels: what the raster says, and along the walls what is too small for it.

use super::raster::Raster;
use crate::grid::{Grid, State};

/// Maps with more pixels than this keep the raster's outlines.
const MOST_PIXELS: usize = 1 << 26;

/// The regions' numbers, 0 for none, pixel by pixel of the map or, where that is too large, of the raster; like the
/// raster with a border that is of no region.
pub struct Fine {
    pub width: usize,
    pub height: usize,
    pub numbers: Vec<u32>,
    /// How many free pixels of the map are of each region, by its number.
    pub areas: Vec<usize>,
    /// Column and row of the grid at the lower left corner of pixel (0, 0), and pixels of the grid along a side.
    corner: [f64; 2],
    side: f64,
}

impl Fine {
    pub fn new(grid: &Grid, raster: &Raster, numbers: Vec<u32>, count: usize) -> Self {
        let side = if raster.free.len() * raster.side.pow(2) <= MOST_PIXELS { raster.side } else { 1 };
        let corner = raster.to_grid([-0.5, -0.5]);
        let (width, height) = (raster.width * side, raster.height * side);
        let mut areas = vec![0; count + 1];
        for (pixel, &number) in numbers.iter().enumerate().filter(|(_, number)| **number != 0) {
            areas[number as usize] += raster.seen_in(grid, pixel);
        }
        let mut made = Self { width, height, numbers: Vec::new(), areas, corner, side: (raster.side / side) as f64 };
        if side == 1 {
            made.numbers = numbers;
            return made;
        }
        made.numbers.reserve_exact(width * height);
        for row in numbers.chunks(raster.width) {
            let from = made.numbers.len();
            for &number in row {
                made.numbers.extend(std::iter::repeat_n(number, side));
            }
            for _ in 1..side {
                made.numbers.extend_from_within(from..from + width);
            }
        }
        made.spread(grid, raster, &numbers);
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
        if inside { self.numbers[y as usize * self.width + x as usize] } else { 0 }
    }

    /// Free pixels of the map that no free pixel of the raster holds are of the region that is the nearest to walk to.
    fn spread(&mut self, grid: &Grid, raster: &Raster, numbers: &[u32]) {
        let (side, width) = (raster.side, self.width);
        let free = grid.table.states.map(|s| s == State::Free);
        // The raster may begin a pixel of its own before the map does.
        let [left, low] = self.corner.map(|c| c as i64);
        let rows: Vec<Option<&[u8]>> = (0..self.height as i64)
            .map(|y| usize::try_from(y + low).ok().filter(|&y| y < grid.frame.height).map(|y| grid.row(y)))
            .collect();
        let is_free = |x: usize, y: usize| {
            let value = rows[y].and_then(|row| usize::try_from(x as i64 + left).ok().and_then(|x| row.get(x)));
            x > 0 && x + 1 < width && y > 0 && y + 1 < rows.len() && value.is_some_and(|&v| free[usize::from(v)])
        };
        let all = &mut self.numbers;
        let mut reached: Vec<(usize, usize, u32)> = Vec::new();
        let mut reach = |reached: &mut Vec<(usize, usize, u32)>, x: usize, y: usize, number: u32| {
            if all[y * width + x] == 0 && is_free(x, y) && !raster.seen[y / side * raster.width + x / side] {
                all[y * width + x] = number;
                reached.push((x, y, number));
            }
        };
        for (pixel, &number) in numbers.iter().enumerate().filter(|(_, number)| **number != 0) {
            let (x, y) = (pixel % raster.width * side, pixel / raster.width * side);
            let [below, before, after, above] = raster.sides(pixel).map(|beside| numbers[beside] == 0);
            for n in 0..side {
                // No region is on the raster's border.
                for (open, x, y) in
                    [(below, x + n, y - 1), (before, x - 1, y + n), (after, x + side, y + n), (above, x + n, y + side)]
                {
                    if open {
                        reach(&mut reached, x, y, number);
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
    }
}
