//! The free space as a raster with a border of its own, and whole-number passes over it.

use crate::grid::{Grid, State};

/// The part of the map that holds free space, with one pixel of not-free around it, so that no pass asks for borders.
/// Places on it are in pixels; the centre of pixel (x, y) is (x, y), and rows run upwards.
pub struct Raster {
    pub width: usize,
    pub height: usize,
    /// Column and row of the map that pixel (0, 0) stands for; -1 where the free space begins at the map's border.
    corner: [f64; 2],
    /// Metres.
    pub resolution: f64,
    /// Seen free.
    pub seen: Vec<bool>,
    /// Seen free, or something small that stands in free space.
    pub free: Vec<bool>,
    /// Part of something that stands by itself in free space and is too thick for a wall: a rack, goods, a machine.
    pub solid: Vec<bool>,
    /// What stands by itself in free space and is small.
    pub islands: Vec<Island>,
}

/// Something small in free space, pixels.
#[derive(Clone, Copy, Debug)]
pub struct Island {
    pub middle: [f64; 2],
    pub length: f64,
    pub thickness: f64,
}

/// What stands by itself in free space and is no longer than this, metres, is a chair's or a table's leg, no wall.
const LEG: f64 = 0.8;
/// The same for what is not slim: bins, pillars; a wall is less thick than this share of its length.
const BLOB: f64 = 1.5;
const SLIM: f64 = 0.4;
/// What stands by itself, is so thick (from, to), metres, and fills its rectangle by this share, is no wall: no door has a jamb
/// there.
const SOLID: (f64, f64) = (0.7, 4.0);
const FILLED: f64 = 0.97;

impl Raster {
    /// Nothing when there is no free space.
    pub fn new(grid: &Grid) -> Option<Self> {
        let (w, h) = (grid.frame.width, grid.frame.height);
        let free = |pixel: &u8| grid.table.states[usize::from(*pixel)] == State::Free;
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        for y in 0..h {
            let row = grid.row(y);
            if let (Some(first), Some(last)) = (row.iter().position(free), row.iter().rposition(free)) {
                low = [low[0].min(first), low[1].min(y)];
                high = [high[0].max(last), y];
            }
        }
        if low[1] > high[1] || w == 0 {
            return None;
        }
        let (width, height) = (high[0] - low[0] + 3, high[1] - low[1] + 3);
        let mut seen = vec![false; width * height];
        for y in low[1]..=high[1] {
            let start = (y - low[1] + 1) * width + 1;
            for (to, from) in seen[start..].iter_mut().zip(&grid.row(y)[low[0]..=high[0]]) {
                *to = free(from);
            }
        }
        let corner = low.map(|n| n as f64 - 1.0);
        let mut made = Self {
            width,
            height,
            corner,
            resolution: grid.frame.resolution,
            free: seen.clone(),
            solid: vec![false; seen.len()],
            islands: Vec::new(),
            seen,
        };
        made.sort_islands();
        Some(made)
    }

    /// Metres in pixels.
    pub fn pixels(&self, metres: f64) -> f64 {
        metres / self.resolution
    }

    /// A place on the raster as a point of the grid, in the grid's pixels.
    pub fn to_grid(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x + self.corner[0] + 0.5, y + self.corner[1] + 0.5]
    }

    /// The inverse of [`Raster::to_grid`].
    pub fn of_grid(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x - self.corner[0] - 0.5, y - self.corner[1] - 0.5]
    }

    /// The pixel that holds a place, nothing outside.
    pub fn at(&self, [x, y]: [f64; 2]) -> Option<usize> {
        let (x, y) = ((x + 0.5).floor(), (y + 0.5).floor());
        let inside = x >= 0.0 && y >= 0.0 && (x as usize) < self.width && (y as usize) < self.height;
        inside.then(|| y as usize * self.width + x as usize)
    }

    /// The centre of a pixel.
    pub fn place(&self, pixel: usize) -> [f64; 2] {
        [(pixel % self.width) as f64, (pixel / self.width) as f64]
    }

    /// The four pixels that share a side with a pixel that is not on the raster's border.
    pub fn sides(&self, pixel: usize) -> [usize; 4] {
        [pixel - self.width, pixel - 1, pixel + 1, pixel + self.width]
    }

    /// The eight pixels around a pixel that is not on the raster's border.
    pub fn around(&self, pixel: usize) -> [usize; 8] {
        let (below, above) = (pixel - self.width, pixel + self.width);
        [below - 1, below, below + 1, pixel - 1, pixel + 1, above - 1, above, above + 1]
    }

    fn on_border(&self, pixel: usize) -> bool {
        let (x, y) = (pixel % self.width, pixel / self.width);
        x == 0 || y == 0 || x + 1 == self.width || y + 1 == self.height
    }

    /// Pieces of pixels that are joined side by side: a number for each pixel (0 for none), and each piece's pixels.
    pub fn pieces(&self, is_in: impl Fn(usize) -> bool, joined: impl Fn(usize, usize) -> bool) -> Pieces {
        let mut numbers = vec![0u32; self.free.len()];
        let mut lists = Vec::new();
        for start in 0..numbers.len() {
            if numbers[start] != 0 || self.on_border(start) || !is_in(start) {
                continue;
            }
            let number = lists.len() as u32 + 1;
            numbers[start] = number;
            let mut list = vec![start];
            let mut next = 0;
            while let Some(&pixel) = list.get(next) {
                next += 1;
                for beside in self.sides(pixel) {
                    if numbers[beside] == 0 && !self.on_border(beside) && is_in(beside) && joined(pixel, beside) {
                        numbers[beside] = number;
                        list.push(beside);
                    }
                }
            }
            lists.push(list);
        }
        Pieces { numbers, lists }
    }

    /// Looks at what stands by itself in free space: fills what is too small or too stout for a wall (furniture, bins,
    /// pillars), and marks what is solid.
    fn sort_islands(&mut self) {
        let mut reached = self.seen.clone();
        for start in 0..reached.len() {
            if reached[start] {
                continue;
            }
            reached[start] = true;
            let mut island = vec![start];
            let mut next = 0;
            let mut alone = true;
            while let Some(&pixel) = island.get(next) {
                next += 1;
                if self.on_border(pixel) {
                    alone = false;
                    self.spread_on_border(pixel, &mut reached, &mut island);
                    continue;
                }
                for beside in self.around(pixel) {
                    if !reached[beside] {
                        reached[beside] = true;
                        island.push(beside);
                    }
                }
            }
            if !alone {
                continue;
            }
            let (middle, [length, thickness]) = self.extent(&island);
            if length <= self.pixels(BLOB) {
                self.islands.push(Island { middle, length, thickness });
            }
            let longest = length.min(self.pixels(BLOB));
            let marks = if length <= self.pixels(LEG) || (length <= longest && thickness >= SLIM * length) {
                &mut self.free
            } else if (self.pixels(SOLID.0)..=self.pixels(SOLID.1)).contains(&thickness)
                && island.len() as f64 >= FILLED * length * thickness
            {
                &mut self.solid
            } else {
                continue;
            };
            for pixel in island {
                marks[pixel] = true;
            }
        }
    }

    fn spread_on_border(&self, pixel: usize, reached: &mut [bool], island: &mut Vec<usize>) {
        let (x, y) = (pixel % self.width, pixel / self.width);
        for row in y.saturating_sub(1)..=(y + 1).min(self.height - 1) {
            for column in x.saturating_sub(1)..=(x + 1).min(self.width - 1) {
                let beside = row * self.width + column;
                if !reached[beside] {
                    reached[beside] = true;
                    island.push(beside);
                }
            }
        }
    }

    /// Middle of an island, and length and thickness of the rectangle with its second moments, pixels.
    fn extent(&self, island: &[usize]) -> ([f64; 2], [f64; 2]) {
        let count = island.len() as f64;
        let places = || island.iter().map(|&pixel| self.place(pixel));
        let mean = [0, 1].map(|axis| places().map(|p| p[axis]).sum::<f64>() / count);
        let moment = |a: usize, b: usize| places().map(|p| (p[a] - mean[a]) * (p[b] - mean[b])).sum::<f64>() / count;
        let (xx, xy, yy) = (moment(0, 0), moment(0, 1), moment(1, 1));
        let (middle, half) = (f64::midpoint(xx, yy), ((0.5 * (xx - yy)).powi(2) + xy * xy).sqrt());
        (mean, [middle + half, middle - half].map(|m| (12.0 * m.max(0.0) + 1.0).sqrt()))
    }

    /// Squared distance of each pixel to the nearest that is not free, in pixels (Meijster, Roerdink and Hesselink 2000).
    pub fn clearance(&self) -> Vec<u32> {
        let (w, h) = (self.width, self.height);
        let mut columns = vec![0i64; w * h];
        for p in w..w * h {
            if self.free[p] {
                columns[p] = columns[p - w] + 1;
            }
        }
        for p in (0..w * (h - 1)).rev() {
            columns[p] = columns[p].min(columns[p + w] + 1);
        }
        let mut squared = vec![0u32; w * h];
        let (mut seats, mut starts) = (Vec::with_capacity(w), Vec::with_capacity(w));
        for (row, to) in columns.chunks(w).zip(squared.chunks_mut(w)) {
            let height = |x: i64| row[x as usize] * row[x as usize];
            let distance = |x: i64, seat: i64| (x - seat) * (x - seat) + height(seat);
            seats.clear();
            starts.clear();
            seats.push(0);
            starts.push(0);
            for x in 1..w as i64 {
                while let (Some(&seat), Some(&start)) = (seats.last(), starts.last()) {
                    if distance(start, seat) <= distance(start, x) {
                        let meet = (x * x - seat * seat + height(x) - height(seat)).div_euclid(2 * (x - seat)) + 1;
                        if meet < w as i64 {
                            seats.push(x);
                            starts.push(meet.max(0));
                        }
                        break;
                    }
                    seats.pop();
                    starts.pop();
                }
                if seats.is_empty() {
                    seats.push(x);
                    starts.push(0);
                }
            }
            for x in (0..w as i64).rev() {
                let place = seats.len() - 1;
                to[x as usize] = distance(x, seats[place]) as u32;
                if starts[place] == x && place > 0 {
                    seats.pop();
                    starts.pop();
                }
            }
        }
        squared
    }
}

/// Pieces of pixels.
pub struct Pieces {
    /// The number of each pixel's piece, from 1; 0 for none.
    pub numbers: Vec<u32>,
    /// Each piece's pixels.
    pub lists: Vec<Vec<usize>>,
}

/// Sets that only ever join (union-find).
pub struct Sets(Vec<u32>);

impl Sets {
    /// So many sets of one.
    pub fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// One more, and its name.
    pub fn add(&mut self) -> u32 {
        self.0.push(self.0.len() as u32);
        self.0.len() as u32 - 1
    }

    /// The name of the set that holds a member.
    pub fn of(&mut self, mut member: u32) -> u32 {
        while self.0[member as usize] != member {
            let above = self.0[self.0[member as usize] as usize];
            self.0[member as usize] = above;
            member = above;
        }
        member
    }

    /// Joins the set named `other` to the one named `to`.
    pub fn join(&mut self, to: u32, other: u32) {
        self.0[other as usize] = to;
    }
}
