//! Looking along straight lines over the map, from sample to sample, over what is all alike in one leap.

use crate::grid::{Grid, State, whole};
use crate::tiles::{SIDE, Tiles};
use std::ops::Range;

/// Of a sample: not free, and occupied as well.
pub const BLOCKED: u8 = 1;
pub const OCCUPIED: u8 = 16 + BLOCKED;

/// A tile's state is told in so many bits, all of which are set where it has several.
const BITS_OF_STATES: u32 = 2;
const STATES: u8 = (1 << BITS_OF_STATES) - 1;
/// Fixed-point bits of a place.
const BITS: u32 = 32;
/// Lanes that are looked along side by side, at most.
pub const LANES: usize = 3;
/// More than what floats round, pixels or samples.
const SLACK: f32 = 0.01;

/// The map, and where it is all alike.
pub struct Look<'a> {
    pixels: &'a [u8],
    /// Where the first pixel of the lowest row lies among them, and how far from there that of the next row.
    lowest: usize,
    next: isize,
    size: [usize; 2],
    samples: [u8; 256],
    across: usize,
    /// Of each tile its state, or that it has several, and above these bits how far around it all is alike.
    tiles: Vec<u8>,
    /// Corners of all that was seen of the map.
    seen: Vec<[f64; 2]>,
}

impl<'a> Look<'a> {
    pub fn new(grid: &Grid<'a>, tiles: &Tiles) -> Self {
        let (pixels, lowest, next) = grid.lying();
        Self {
            pixels,
            lowest,
            next,
            size: [grid.frame.width, grid.frame.height],
            samples: grid.table.states.map(|state| match state {
                State::Free => 0,
                State::Occupied => OCCUPIED,
                State::Unknown => BLOCKED,
            }),
            across: tiles.width,
            tiles: tiles
                .reaches()
                .into_iter()
                .zip(&tiles.states)
                .map(|(reach, states)| coded(reach, *states))
                .collect(),
            seen: tiles.seen(),
        }
    }

    /// What a sample is that lies on a pixel of the map.
    #[inline]
    fn sample(&self, [x, y]: [usize; 2]) -> u8 {
        let place = self.lowest.wrapping_add_signed(self.next.wrapping_mul(y as isize)).wrapping_add(x);
        self.samples[usize::from(self.pixels[place])]
    }

    /// How many tiles follow each that are like it, for what is looked along with one step again and again.
    pub fn ahead(&self, step: [f64; 2]) -> Ahead {
        let (across, way) = (self.across.max(1), way_of(fixed(step)));
        Ahead { way, tiles: self.tiles_ahead(across, way) }
    }

    /// How many tiles follow each one way; so many lie across to a row.
    fn tiles_ahead(&self, across: usize, way: usize) -> Vec<u8> {
        let mut ahead = vec![0; self.tiles.len()];
        let more =
            |[own, next]: [u8; 2], follow: u8| if (own ^ next) & STATES == 0 { follow.saturating_add(1) } else { 0 };
        if way % 2 == 0 {
            for (tiles, ahead) in self.tiles.chunks(across).zip(ahead.chunks_mut(across)) {
                let pairs = (1..tiles.len()).map(|n| [n - 1, n]);
                let mut visit = |own: usize, next: usize| ahead[own] = more([tiles[own], tiles[next]], ahead[next]);
                if way == 0 {
                    pairs.rev().for_each(|[left, right]| visit(left, right));
                } else {
                    pairs.for_each(|[left, right]| visit(right, left));
                }
            }
            return ahead;
        }
        let visit = |upper: usize| {
            let (below, above) = ahead.split_at_mut(upper);
            let rows = below[upper - across..].iter_mut().zip(&mut above[..across]);
            let tiles = self.tiles[upper - across..].iter().zip(&self.tiles[upper..]);
            if way == 1 {
                rows.zip(tiles).for_each(|((low, high), (own, next))| *low = more([*own, *next], *high));
            } else {
                rows.zip(tiles).for_each(|((low, high), (own, next))| *high = more([*own, *next], *low));
            }
        };
        let uppers = (0..self.tiles.len()).step_by(across).skip(1);
        if way == 1 {
            uppers.rev().for_each(visit);
        } else {
            uppers.for_each(visit);
        }
        ahead
    }

    /// Points, in pixels of the grid, that have all between them that was seen of the map; none where nothing was.
    pub fn seen(&self) -> &[[f64; 2]] {
        &self.seen
    }

    /// What lies at each sample, the first at `start`, each a `step` on, in pixels of the grid; outside the map nothing
    /// was seen.
    pub fn along(&self, start: [f64; 2], step: [f64; 2], samples: &mut [u8]) {
        self.cells(&[start], step, &Ahead::default(), 0, samples);
    }

    /// The sums of what lies in cells, which have as many samples along as there are lanes of them, [`LANES`] at most;
    /// each lane begins at a place of its own. Those from the `first` cell on.
    pub fn cells(&self, lanes: &[[f64; 2]], step: [f64; 2], ahead: &Ahead, first: usize, cells: &mut [u8]) {
        match *lanes {
            [one] => self.cells_of([one], step, ahead, first, cells),
            [one, two] => self.cells_of([one, two], step, ahead, first, cells),
            [one, two, three] => self.cells_of([one, two, three], step, ahead, first, cells),
            _ => debug_assert!(lanes.is_empty(), "{} lanes, {LANES} at most", lanes.len()),
        }
    }

    fn cells_of<const PER: usize>(
        &self,
        lanes: [[f64; 2]; PER],
        step: [f64; 2],
        ahead: &Ahead,
        first: usize,
        cells: &mut [u8],
    ) {
        let step = fixed(step);
        let starts = lanes.map(|start| after(fixed(start), step, first * PER));
        // The cells of which a sample is on the map, and those of which all are.
        let count = cells.len() * PER;
        let mut some = count..0;
        let mut all = 0..count;
        for start in starts {
            let own = self.on_map(start, step, count);
            all = all.start.max(own.start)..all.end.min(own.end);
            if !own.is_empty() {
                some = some.start.min(own.start)..some.end.max(own.end);
            }
        }
        let some = (some.start / PER).min(cells.len())..some.end.div_ceil(PER).max(some.start / PER).min(cells.len());
        let all = all.start.div_ceil(PER).clamp(some.start, some.end)..(all.end / PER).min(some.end);
        let whole = (PER * PER) as u8;
        cells[..some.start].fill(whole * BLOCKED);
        cells[some.end..].fill(whole * BLOCKED);
        let alike = Alike::new(&starts, step);
        let mut n = some.start;
        while n < some.end {
            let is_inside = all.contains(&n);
            if is_inside {
                let place = after(starts[0], step, n * PER);
                let [x, y] = place.map(|p| (p >> BITS) as usize);
                let tile = y / SIDE * self.across + x / SIDE;
                let leap = alike.samples(place, self.tiles[tile] >> BITS_OF_STATES, ahead.of(tile)) / PER;
                if leap > 0 {
                    let end = all.end.min(n + leap);
                    cells[n..end].fill(whole * self.sample([x, y]));
                    n = end;
                    continue;
                }
            }
            let end = if is_inside { all.end.min(n + SIDE.div_ceil(PER)) } else { n + 1 };
            let places = starts.map(|start| after(start, step, n * PER));
            if is_inside {
                self.add_up::<PER, true>(places, step, &mut cells[n..end]);
            } else {
                self.add_up::<PER, false>(places, step, &mut cells[n..end]);
            }
            n = end;
        }
    }

    /// Sums up in each cell what lies at so many samples of each lane, which may be known to lie on the map: by itself, so
    /// that all that it goes by is at hand.
    #[inline(never)]
    fn add_up<const PER: usize, const INSIDE: bool>(&self, places: [[i64; 2]; PER], step: [i64; 2], cells: &mut [u8]) {
        for (lane, mut place) in places.into_iter().enumerate() {
            for cell in &mut *cells {
                let mut sum = if lane == 0 { 0 } else { *cell };
                for _ in 0..PER {
                    let [x, y] = place.map(|p| (p >> BITS) as usize);
                    let is_on_map = INSIDE || x < self.size[0] && y < self.size[1];
                    sum += if is_on_map { self.sample([x, y]) } else { BLOCKED };
                    place = [place[0] + step[0], place[1] + step[1]];
                }
                *cell = sum;
            }
        }
    }

    /// In which cells something stands on a lane that has so many samples in each: these get its bit. From the first of
    /// some cells on.
    pub fn mark(
        &self,
        lane: [f64; 2],
        step: [f64; 2],
        ahead: &Ahead,
        [per, first]: [usize; 2],
        bit: u32,
        cells: &mut [u32],
    ) {
        let step = fixed(step);
        let start = after(fixed(lane), step, first * per);
        let on_map = self.on_map(start, step, cells.len() * per);
        let alike = Alike::new(&[start], step);
        let mut n = on_map.start;
        while n < on_map.end {
            let mut place = after(start, step, n);
            let [x, y] = place.map(|p| (p >> BITS) as usize);
            let tile = y / SIDE * self.across + x / SIDE;
            let leap = alike.samples(place, self.tiles[tile] >> BITS_OF_STATES, ahead.of(tile));
            if leap > 0 {
                let end = on_map.end.min(n + leap);
                if self.stands([x, y]) {
                    cells[n / per..end.div_ceil(per)].iter_mut().for_each(|cell| *cell |= bit);
                }
                n = end;
                continue;
            }
            // To the end of the cell.
            let end = on_map.end.min((n / per + 1) * per);
            for _ in n..end {
                if self.stands(place.map(|p| (p >> BITS) as usize)) {
                    cells[n / per] |= bit;
                    break;
                }
                place = [place[0] + step[0], place[1] + step[1]];
            }
            n = end;
        }
    }

    /// True where something stands on a pixel of the map.
    fn stands(&self, pixel: [usize; 2]) -> bool {
        self.sample(pixel) == OCCUPIED
    }

    /// Of so many samples those that lie on the map.
    fn on_map(&self, start: [i64; 2], step: [i64; 2], count: usize) -> Range<usize> {
        let (mut from, mut to) = (0, count as i64);
        for axis in [0, 1] {
            let (first, last) = within(start[axis], step[axis], (self.size[axis] as i64) << BITS);
            (from, to) = (from.max(first), to.min(last));
        }
        let from = from.min(count as i64) as usize;
        from..(to.max(0) as usize).max(from)
    }
}

/// In a row of cells of so many samples, each of several pixels of which some are not asked: what lies between rays is
/// floor, where they went through a cell and through those before and behind it.
pub fn between_rays(row: &mut [u8], samples: u8) {
    let through: Vec<bool> = row.iter().map(|cell| *cell < samples).collect();
    let inner = row.iter_mut().skip(1).zip(through.windows(3));
    inner.filter(|(_, near)| !near.contains(&false)).for_each(|(cell, _)| *cell = 0);
}

/// A place, or a step, in fixed point.
fn fixed(p: [f64; 2]) -> [i64; 2] {
    p.map(|v| (v * (1i64 << BITS) as f64).round() as i64)
}

/// Where a lane's sample lies.
fn after(start: [i64; 2], step: [i64; 2], samples: usize) -> [i64; 2] {
    [0, 1].map(|axis| start[axis] + samples as i64 * step[axis])
}

/// A tile in a byte, of which it is known so far at most how far around it all is alike.
fn coded(reach: u8, states: u8) -> u8 {
    let state = if states.is_power_of_two() { states.trailing_zeros() as u8 } else { STATES };
    reach.min(u8::MAX >> BITS_OF_STATES) << BITS_OF_STATES | state
}

/// How many tiles are known to follow each one way that are like it.
#[derive(Default)]
pub struct Ahead {
    way: usize,
    tiles: Vec<u8>,
}

impl Ahead {
    /// Which way, and how many.
    fn of(&self, tile: usize) -> (usize, u8) {
        (self.way, self.tiles.get(tile).copied().unwrap_or(0))
    }
}

/// The axis that steps run along rather than the other: to the right, upwards, to the left, downwards.
fn way_of(step: [i64; 2]) -> usize {
    let axis = usize::from(step[1].abs() > step[0].abs());
    axis + if step[axis] < 0 { 2 } else { 0 }
}

/// How far lanes side by side go on over what is all alike.
struct Alike {
    step: [i64; 2],
    /// Pixels, times this, are samples.
    pace: [f32; 2],
    /// How far the lanes lie beside the first one, pixels: towards the lower end of each axis, and towards the upper.
    beside: [[f32; 2]; 2],
}

impl Alike {
    fn new(starts: &[[i64; 2]], step: [i64; 2]) -> Self {
        let pixels = |fixed: i64| fixed as f32 / (1i64 << BITS) as f32;
        let beside = [0, 1].map(|axis| {
            let off = || starts.iter().map(|start| start[axis] - starts[0][axis]);
            [-off().min().unwrap_or(0), off().max().unwrap_or(0)].map(pixels)
        });
        Self { step, pace: step.map(|s| 1.0 / pixels(s).abs()), beside }
    }

    /// Samples from a place of the first lane on, over tiles that are alike so far around the one that it is in, and so
    /// many that way ahead.
    fn samples(&self, place: [i64; 2], reach: u8, (way, ahead): (usize, u8)) -> usize {
        if reach == 0 {
            return 0;
        }
        // What is alike ahead goes on from the own tile, and where nothing else around is alike it is the farther.
        let beyond = ((usize::from(reach) - 1) * SIDE) as f32;
        let around = if reach > 1 || ahead == 0 { self.within(place, [[beyond; 2]; 2]) } else { 0 };
        if ahead < reach {
            return around;
        }
        let mut beyond = [[0.0; 2]; 2];
        beyond[way % 2][usize::from(way < 2)] = (usize::from(ahead) * SIDE) as f32;
        around.max(self.within(place, beyond))
    }

    /// Samples from a place of the first lane on within its tile and so far beyond, along either axis to both sides.
    fn within(&self, place: [i64; 2], beyond: [[f32; 2]; 2]) -> usize {
        let mut least = f32::MAX;
        for axis in [0, 1] {
            let in_tile = (place[axis] & (((SIDE as i64) << BITS) - 1)) as f32 / (1i64 << BITS) as f32;
            let [low, high] = self.beside[axis];
            let [before, after] = beyond[axis];
            let (below, above) = (in_tile + before - low, SIDE as f32 - in_tile + after - high);
            // A little less, for what floats round.
            if below.min(above) < SLACK {
                return 0;
            }
            if self.step[axis] != 0 {
                least = least.min((if self.step[axis] > 0 { above } else { below }) * self.pace[axis]);
            }
        }
        whole(f64::from(least - SLACK)) + 1
    }
}

/// The n for which 0 <= start + n step < size: from, to.
fn within(start: i64, step: i64, size: i64) -> (i64, i64) {
    // Rounded up.
    let divide = |a: i64, b: i64| -(-a).div_euclid(b);
    match step.signum() {
        1 => (divide(-start, step), divide(size - start, step)),
        -1 => ((start - size).div_euclid(-step) + 1, start.div_euclid(-step) + 1),
        _ if (0..size).contains(&start) => (0, i64::MAX),
        _ => (0, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Frame, Table};

    #[test]
    fn tiles_that_follow_are_counted_along_rows_and_columns() {
        // Free, unknown, and of several states.
        let tiles = ["ffuuu", "ffuu.", "ffuuu", "fffff"];
        let (width, height) = (5 * SIDE, 4 * SIDE);
        let pixel = |n: usize| match tiles[n / width / SIDE].as_bytes()[n % width / SIDE] {
            b'f' => 254,
            b'u' => 205,
            _ => [0, 254][n % 2],
        };
        let pixels: Vec<u8> = (0..width * height).map(pixel).collect();
        let (table, frame) = (Table::trinary(), Frame::new(width, height, 0.05, [0.0; 3]));
        let grid = Grid::new(&pixels, true, &table, frame);
        let look = Look::new(&grid, &Tiles::new(&grid, 1));
        let ahead = |step: [f64; 2]| look.ahead(step).tiles.chunks(5).map(<[u8]>::to_vec).collect::<Vec<_>>();
        assert_eq!(ahead([1.0, 0.1]), [[1, 0, 2, 1, 0], [1, 0, 1, 0, 0], [1, 0, 2, 1, 0], [4, 3, 2, 1, 0]]);
        assert_eq!(ahead([-1.0, 0.1]), [[0, 1, 0, 1, 2], [0, 1, 0, 1, 0], [0, 1, 0, 1, 2], [0, 1, 2, 3, 4]]);
        assert_eq!(ahead([0.1, 1.0]), [[3, 3, 2, 2, 0], [2, 2, 1, 1, 0], [1, 1, 0, 0, 0], [0, 0, 0, 0, 0]]);
        assert_eq!(ahead([0.1, -1.0]), [[0, 0, 0, 0, 0], [1, 1, 1, 1, 0], [2, 2, 2, 2, 0], [3, 3, 0, 0, 0]]);
    }
}
