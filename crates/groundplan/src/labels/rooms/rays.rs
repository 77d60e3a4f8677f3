//! Rays through a window, or past the last of what was seen: narrow pieces of free space along which nothing stands.

use super::super::Evidence;
use super::raster::Raster;
use super::runs::Runs;
use crate::grid::{State, whole};

/// A ray is narrower than this in the mean, metres.
pub const NARROW: f64 = 0.6;
/// And along less than this share of its border something stands, no farther than so many metres beyond.
const STANDS: f64 = 0.1;
const BESIDE: f64 = 0.2;

/// Which of some narrow pieces are rays, by their numbers; `pieces` has that of each run.
pub fn find(evidence: &Evidence, raster: &Raster, runs: &Runs, pieces: &[u32], narrow: &[bool]) -> Vec<bool> {
    // Of each: sides of pixels beyond which it is not free, and those of them where something stands there.
    let mut sides = vec![[0usize; 2]; narrow.len()];
    for (run, &piece) in runs.all.iter().zip(pieces).filter(|(_, piece)| narrow[**piece as usize]) {
        let closed = |pixel: usize| !raster.free.get(pixel);
        for pixel in run.pixels() {
            let [above, left, right, below] = raster.sides(pixel).map(closed);
            let ways = [([0.0, -1.0], above), ([-1.0, 0.0], left), ([1.0, 0.0], right), ([0.0, 1.0], below)];
            for (way, _) in ways.into_iter().filter(|(_, is_closed)| *is_closed) {
                let [all, held] = &mut sides[piece as usize];
                *all += 1;
                *held += usize::from(is_held(evidence, raster, pixel, way));
            }
        }
    }
    let is_ray = |(&narrow, [all, held]): (&bool, [usize; 2])| narrow && (held as f64) < STANDS * all as f64;
    narrow.iter().zip(sides).map(is_ray).collect()
}

/// True when something stands beside a pixel, that way.
fn is_held(evidence: &Evidence, raster: &Raster, pixel: usize, way: [f64; 2]) -> bool {
    let grid = evidence.grid;
    let from = raster.to_grid(raster.place(pixel));
    let half = 0.5 * raster.side as f64;
    let state = |n: usize| {
        let [x, y] = [0, 1].map(|axis| from[axis] + way[axis] * (half + n as f64 + 0.5));
        let is_on_map = x >= 0.0 && y >= 0.0 && x < grid.frame.width as f64 && y < grid.frame.height as f64;
        is_on_map.then(|| grid.state_of([whole(x), whole(y)]))
    };
    let far = (BESIDE / grid.frame.resolution).round().max(1.0) as usize;
    (0..far).filter_map(state).any(|state| state == State::Occupied)
}
