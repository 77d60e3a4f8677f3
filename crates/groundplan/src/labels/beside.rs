//! What lies along one direction by its places, in buckets to which more can be put: what may touch a piece is found
//! without asking all.

use super::view::turned::Turned;

/// Sides of a bucket along and across, metres: corridors and rows are much longer than wide.
const SIDES: [f64; 2] = [16.0, 8.0];
/// There are no more than so many along or across.
const MOST: f64 = 512.0;

/// Numbers of things in rectangles of places along and across a direction.
pub struct Beside {
    low: [f64; 2],
    sides: [f64; 2],
    size: [usize; 2],
    /// Those that reach into each bucket.
    buckets: Vec<Vec<u32>>,
}

impl Beside {
    /// Of nothing yet. What lies beyond the view's ends is kept at them.
    pub fn of(view: &Turned) -> Self {
        Self::over(view.start, view.size.map(|cells| cells as f64 * view.cell))
    }

    fn over(low: [f64; 2], extent: [f64; 2]) -> Self {
        let sides = [0, 1].map(|axis| SIDES[axis].max(extent[axis] / MOST));
        let size = [0, 1].map(|axis| (extent[axis] / sides[axis]) as usize + 1);
        Self { low, sides, size, buckets: vec![Vec::new(); size[0] * size[1]] }
    }

    /// With one more.
    pub fn add(&mut self, number: usize, along: [f64; 2], across: [f64; 2]) {
        let [columns, rows] = self.reached(along, across);
        for row in rows[0]..=rows[1] {
            for bucket in &mut self.buckets[row * self.size[0]..][columns[0]..=columns[1]] {
                bucket.push(number as u32);
            }
        }
    }

    /// Those that may share a place with a rectangle, be it on its border, in the order of their numbers.
    pub fn touching(&self, along: [f64; 2], across: [f64; 2]) -> Vec<usize> {
        let [columns, rows] = self.reached(along, across);
        let of_row = |row: usize| &self.buckets[row * self.size[0]..][columns[0]..=columns[1]];
        let mut found: Vec<usize> = (rows[0]..=rows[1]).flat_map(of_row).flatten().map(|&n| n as usize).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// The first and the last bucket that a rectangle reaches into, along and across.
    fn reached(&self, along: [f64; 2], across: [f64; 2]) -> [[usize; 2]; 2] {
        let bucket = |axis: usize, place: f64| {
            (((place - self.low[axis]) / self.sides[axis]).max(0.0) as usize).min(self.size[axis] - 1)
        };
        let span = |axis: usize, ends: [f64; 2]| {
            let from = bucket(axis, ends[0]);
            [from, bucket(axis, ends[1]).max(from)]
        };
        [span(0, along), span(1, across)]
    }
}

/// Things in the order of their numbers, each with its direction and its places along and across; by direction.
pub fn placed(views: &[Turned], things: impl Iterator<Item = (usize, [f64; 2], [f64; 2])>) -> Vec<Beside> {
    let mut placed: Vec<Beside> = views.iter().map(Beside::of).collect();
    things.enumerate().for_each(|(n, (direction, along, across))| placed[direction].add(n, along, across));
    placed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ends::wider;

    #[test]
    fn all_that_touches_a_piece_is_found_and_nothing_far_away() {
        let mut state = 1u64;
        let mut random = |most: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 * most
        };
        // Some reach beyond the ends, and some end where others begin.
        let mut piece = || {
            let [u, v] = [random(420.0) - 10.0, random(320.0) - 10.0].map(f64::round);
            [[u, u + random(60.0).round()], [v, v + random(4.0).round()]]
        };
        let all: Vec<[[f64; 2]; 2]> = (0..400).map(|_| piece()).collect();
        let mut beside = Beside::over([0.0; 2], [400.0, 300.0]);
        for (n, [along, across]) in all.iter().enumerate() {
            let touches = |[a, b]: [f64; 2], [c, d]: [f64; 2]| a <= d && c <= b;
            let found = beside.touching(*along, *across);
            let is_found = |m: &usize| touches(all[*m][0], *along) && touches(all[*m][1], *across);
            assert!((0..n).filter(is_found).all(|m| found.contains(&m)));
            assert!(found.is_sorted_by(|a, b| a < b));
            // What lies beyond the ends is as near as they are.
            let on_map = |ends: [f64; 2], end: f64| ends.map(|place| place.clamp(0.0, end));
            let is_near = |m: &usize| {
                [(0, 400.0), (1, 300.0)].into_iter().all(|(axis, end)| {
                    touches(wider(on_map(all[*m][axis], end), SIDES[axis]), on_map([*along, *across][axis], end))
                })
            };
            assert!(found.iter().all(is_near));
            beside.add(n, *along, *across);
        }
    }
}
