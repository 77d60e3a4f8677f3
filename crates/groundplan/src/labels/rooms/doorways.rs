//! Doors: what is left between two different regions of all that might part them.

use super::raster::Raster;
use super::runs::Runs;
use super::{Bar, TOGETHER};
use crate::subdivision::distance;
use std::collections::BTreeMap;

/// The regions beside a door lie within so many pixels of it; the nearest pixel may be under the cut itself.
const BESIDE: i32 = 8;
/// Openings between the same two regions are one when they are nearer than this share of their width.
const SAME: f64 = 0.75;

/// A door in the raster's places, and the two regions' numbers.
pub struct Doorway {
    pub between: [u32; 2],
    pub ends: [[f64; 2]; 2],
}

impl Doorway {
    pub fn middle(&self) -> [f64; 2] {
        [0, 1].map(|axis| f64::midpoint(self.ends[0][axis], self.ends[1][axis]))
    }

    pub fn width(&self) -> f64 {
        distance(self.ends[0], self.ends[1])
    }

    /// Another closure of the same opening, or another piece of it.
    fn is_same(&self, other: &Self, near: f64) -> bool {
        let touch = || self.ends.iter().any(|&p| other.ends.iter().any(|&q| distance(p, q) <= near));
        let overlap = distance(self.middle(), other.middle()) <= SAME * self.width().max(other.width());
        self.between == other.between && (overlap || touch())
    }

    /// Takes in another: from the one's end to the other's that lie farthest apart.
    fn extend(&mut self, other: &Self) {
        let all = [self.ends[0], self.ends[1], other.ends[0], other.ends[1]];
        for p in all {
            for q in all {
                if distance(p, q) > self.width() {
                    self.ends = [p, q];
                }
            }
        }
    }
}

/// What is left between two different regions, each doorway once.
pub fn find(raster: &Raster, numbers: &Runs, openings: Vec<[[f64; 2]; 2]>) -> Vec<Doorway> {
    let mut found: Vec<Doorway> = Vec::new();
    // Between each pair of regions.
    let mut known: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for ends in openings {
        let [ux, uy] = Bar::new(ends).heading();
        let door = Doorway { between: [0; 2], ends };
        let [x, y] = door.middle();
        let beside = |side: f64| {
            (2..=BESIDE)
                .map(|n| side * f64::from(n))
                .filter_map(|n| raster.at([x - uy * n, y + ux * n]))
                .map(|pixel| numbers.at(pixel))
                .find(|&number| number != 0)
                .unwrap_or(0)
        };
        let (left, right) = (beside(1.0), beside(-1.0));
        if left == 0 || right == 0 || left == right {
            continue;
        }
        let door = Doorway { between: [left.min(right), left.max(right)], ..door };
        let between = known.entry(door.between).or_default();
        if let Some(&n) = between.iter().find(|&&n| found[n].is_same(&door, raster.pixels(TOGETHER))) {
            found[n].extend(&door);
        } else {
            between.push(found.len());
            found.push(door);
        }
    }
    found
}
