//! The free space as a raster with a border of its own, and whole-number passes over it.

use crate::bands::map_bands;
use crate::grid::{Grid, State};

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

/// The raster's pixels are as large as this, metres, or smaller, and hold so many of the map's along a side at most.
const SIDE: f64 = 0.05;
const MOST_PIXELS: f64 = 8.0;
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
    pub fn new(grid: &Grid, threads: usize) -> Option<Self> {
        let resolution = grid.frame.resolution;
        let side = (SIDE / resolution + 1e-9).floor().clamp(1.0, MOST_PIXELS) as usize;
        let (w, h) = (grid.frame.width / side, grid.frame.height / side);
        if w == 0 || h == 0 {
            return None;
        }
        let is_free = grid.table.states.map(|s| s == State::Free);
        let free: Vec<bool> = map_bands(h, threads, |band| {
            let mut free = vec![true; band.len() * w];
            for (row, y) in free.chunks_mut(w).zip(band) {
                for line in y * side..(y + 1) * side {
                    clear_taken(grid, &is_free, line, side, row);
                }
            }
            free
        })
        .concat();
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        for (y, row) in free.chunks(w).enumerate() {
            if let (Some(first), Some(last)) = (row.iter().position(|f| *f), row.iter().rposition(|f| *f)) {
                low = [low[0].min(first), low[1].min(y)];
                high = [high[0].max(last), y];
            }
        }
        if low[1] > high[1] {
            return None;
        }
        let (width, height) = (high[0] - low[0] + 3, high[1] - low[1] + 3);
        let mut seen = vec![false; width * height];
        for (to, from) in seen[width..].chunks_mut(width).zip(free[low[1] * w..].chunks(w)).take(height - 2) {
            to[1..width - 1].copy_from_slice(&from[low[0]..=high[0]]);
        }
        let corner = low.map(|n| side as f64 * (n as f64 - 1.0));
        let mut made = Self {
            width,
            height,
            corner,
            side,
            resolution: side as f64 * resolution,
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
        let inside = x >= 0.0 && y >= 0.0 && (x as usize) < self.width && (y as usize) < self.height;
        inside.then(|| y as usize * self.width + x as usize)
    }

    /// The centre of a pixel.
    pub fn place(&self, pixel: usize) -> [f64; 2] {
        [(pixel % self.width) as f64, (pixel / self.width) as f64]
    }

    /// How many of the map's pixels in a pixel are free.
    pub fn seen_in(&self, grid: &Grid, pixel: usize) -> usize {
        let side = self.side;
        if self.seen[pixel] {
            return side * side;
        }
        let free = |value: &&u8| grid.table.states[usize::from(**value)] == State::Free;
        let [x, y] = [0, 1].map(|axis| (self.corner[axis] + self.place(pixel)[axis] * side as f64) as usize);
        (y..y + side).map(|y| grid.row(y)[x..x + side].iter().filter(free).count()).sum()
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

    /// Pieces of pixels of one kind that are joined side by side, for all kinds but 0.
    pub fn pieces(&self, kind: impl Fn(usize) -> u32) -> Pieces {
        let width = self.width;
        let mut numbers = vec![0u32; self.free.len()];
        let mut sets = Sets::new(1);
        // Nothing on the raster's border is of a piece.
        for y in 1..self.height - 1 {
            let mut before = 0;
            for pixel in y * width + 1..(y + 1) * width - 1 {
                let own = kind(pixel);
                if own != 0 {
                    let (left, below) = (numbers[pixel - 1], numbers[pixel - width]);
                    let below = if below != 0 && kind(pixel - width) == own { below } else { 0 };
                    let left = if before == own { left } else { 0 };
                    numbers[pixel] = match (left, below) {
                        (0, 0) => sets.add(),
                        (0, one) | (one, 0) => one,
                        (a, b) if a == b => a,
                        (a, b) => {
                            let (a, b) = (sets.of(a), sets.of(b));
                            sets.join(a.min(b), a.max(b));
                            a.min(b)
                        }
                    };
                }
                before = own;
            }
        }
        // In the order of their first pixels.
        let mut names = vec![0u32; sets.0.len()];
        let mut count = 0;
        for n in 1..names.len() as u32 {
            let root = sets.of(n);
            if root == n {
                count += 1;
                names[n as usize] = count;
            } else {
                names[n as usize] = names[root as usize];
            }
        }
        for number in &mut numbers {
            *number = names[*number as usize];
        }
        Pieces { numbers, count: count as usize }
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
    pub fn clearance(&self, threads: usize) -> Vec<u32> {
        let w = self.width;
        // Within each column first.
        let mut columns = vec![0u32; w * self.height];
        for y in 1..self.height {
            let (below, row) = columns[(y - 1) * w..(y + 1) * w].split_at_mut(w);
            for ((to, below), &free) in row.iter_mut().zip(below).zip(&self.free[y * w..]) {
                *to = (*below + 1) * u32::from(free);
            }
        }
        for y in (1..self.height).rev() {
            let (row, above) = columns[(y - 1) * w..(y + 1) * w].split_at_mut(w);
            row.iter_mut().zip(above).for_each(|(to, above)| *to = (*to).min(*above + 1));
        }
        map_bands(self.height, threads, |band| {
            let mut squared = vec![0u32; band.len() * w];
            let mut seats = Vec::new();
            for (row, to) in columns[band.start * w..].chunks(w).zip(squared.chunks_mut(w)) {
                // Within a run of free pixels only the run and its two ends count.
                let mut next = 1;
                while let Some(from) = (next..w).find(|&x| row[x] != 0) {
                    let end = (from..w).find(|&x| row[x] == 0).unwrap_or(w - 1);
                    envelope(&row[from - 1..=end], &mut to[from - 1..=end], &mut seats);
                    next = end + 1;
                }
            }
            squared
        })
        .concat()
    }
}

/// The lower envelope of the parabolas over some heights.
fn envelope(heights: &[u32], squared: &mut [u32], seats: &mut Vec<(i64, i64)>) {
    let height = |x: i64| i64::from(heights[x as usize]).pow(2);
    let distance = |x: i64, seat: i64| (x - seat) * (x - seat) + height(seat);
    seats.clear();
    seats.push((0, 0));
    let count = heights.len() as i64;
    for x in 1..count {
        while let Some(&(seat, start)) = seats.last() {
            if distance(start, seat) <= distance(start, x) {
                // Exact: the numbers are whole and small.
                let over = x * x - seat * seat + height(x) - height(seat);
                let meet = if over < 0 { 0 } else { (over as f64 / (2 * (x - seat)) as f64) as i64 + 1 };
                if meet < count {
                    seats.push((x, meet));
                }
                break;
            }
            seats.pop();
        }
        if seats.is_empty() {
            seats.push((x, 0));
        }
    }
    let mut end = count;
    while let Some((seat, start)) = seats.pop() {
        for x in start..end {
            squared[x as usize] = distance(x, seat) as u32;
        }
        end = end.min(start);
    }
}

/// Takes out of a row of the raster what is not free in one of the map's rows.
fn clear_taken(grid: &Grid, free: &[bool; 256], y: usize, side: usize, row: &mut [bool]) {
    if side == 1 {
        row.iter_mut().zip(grid.row(y)).for_each(|(to, &value)| *to = free[usize::from(value)]);
        return;
    }
    for (to, from) in row.iter_mut().zip(grid.row(y).chunks(side)) {
        *to &= from.iter().all(|&value| free[usize::from(value)]);
    }
}

/// Pieces of pixels.
pub struct Pieces {
    /// The number of each pixel's piece, from 1; 0 for none.
    pub numbers: Vec<u32>,
    /// How many.
    pub count: usize,
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
