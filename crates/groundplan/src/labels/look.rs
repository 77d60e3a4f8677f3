//! Looking along straight lines over the map, from sample to sample, over what is all alike in one leap.

use crate::grid::{Grid, State};
use crate::tiles::{SIDE, Tiles};

/// Of a sample: not free, and occupied as well.
pub const BLOCKED: u8 = 1;
pub const OCCUPIED: u8 = 16 + BLOCKED;

/// Fixed-point bits of a place.
const BITS: u32 = 32;

/// The map, and where it is all alike.
pub struct Look<'a> {
    rows: Vec<&'a [u8]>,
    width: usize,
    samples: [u8; 256],
    across: usize,
    reaches: Vec<u8>,
}

impl<'a> Look<'a> {
    pub fn new(grid: &Grid<'a>, tiles: &Tiles) -> Self {
        Self {
            rows: (0..grid.frame.height).map(|y| grid.row(y)).collect(),
            width: grid.frame.width,
            samples: grid.table.states.map(|state| match state {
                State::Free => 0,
                State::Occupied => OCCUPIED,
                State::Unknown => BLOCKED,
            }),
            across: tiles.width,
            reaches: tiles.reaches(),
        }
    }

    /// What lies at each sample, the first at `start`, each a `step` on, in pixels of the grid; outside the map nothing
    /// was seen.
    pub fn along(&self, start: [f64; 2], step: [f64; 2], samples: &mut [u8]) {
        let fixed = |p: [f64; 2]| p.map(|v| (v * (1i64 << BITS) as f64).round() as i64);
        let (start, step) = (fixed(start), fixed(step));
        let size = [self.width, self.rows.len()];
        let (mut from, mut to) = (0, samples.len() as i64);
        for axis in [0, 1] {
            let (first, last) = within(start[axis], step[axis], (size[axis] as i64) << BITS);
            (from, to) = (from.max(first), to.min(last));
        }
        let mut n = from.min(samples.len() as i64) as usize;
        let to = (to.max(0) as usize).max(n);
        samples[..n].fill(BLOCKED);
        samples[to..].fill(BLOCKED);
        // Pixels to the border of a tile, times this, are samples.
        let pace = step.map(|s| if s == 0 { 0.0 } else { (1i64 << BITS) as f64 / s.abs() as f64 } as f32);
        while n < to {
            let place = [0, 1].map(|axis| start[axis] + n as i64 * step[axis]);
            let [x, y] = place.map(|p| (p >> BITS) as usize);
            let reach = self.reaches[y / SIDE * self.across + x / SIDE];
            if reach == 0 {
                let end = to.min(n + SIDE);
                let mut place = place;
                for sample in &mut samples[n..end] {
                    let [x, y] = place.map(|p| (p >> BITS) as usize);
                    *sample = self.samples[usize::from(self.rows[y][x])];
                    place = [place[0] + step[0], place[1] + step[1]];
                }
                n = end;
                continue;
            }
            let sample = self.samples[usize::from(self.rows[y][x])];
            let beyond = ((usize::from(reach) - 1) * SIDE) as f32;
            let leap = [0, 1].map(|axis| {
                let in_tile = (place[axis] & (((SIDE as i64) << BITS) - 1)) as f32 / (1i64 << BITS) as f32;
                let left = if step[axis] > 0 { SIDE as f32 - in_tile } else { in_tile };
                if step[axis] == 0 { f32::MAX } else { (left + beyond) * pace[axis] }
            });
            // A little less, for what floats round.
            let leap = (leap[0].min(leap[1]) - 0.01).max(0.0) as usize + 1;
            let end = to.min(n + leap);
            samples[n..end].fill(sample);
            n = end;
        }
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
