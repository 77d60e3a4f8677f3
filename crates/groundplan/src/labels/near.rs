//! Things by their places, in square buckets, so that those near a point or in a polygon are found without asking all.

use super::outline;
use crate::ends::{around, wider};
use std::collections::BTreeMap;

/// A little more than rounding may move a point, metres.
const SLACK: f64 = 1e-3;
/// There are about so many buckets for each thing, and not many more than so many in all.
const FOR_EACH: f64 = 0.5;
const MOST: f64 = (1 << 22) as f64;

/// Numbers of things, bucket after bucket.
pub struct Near {
    low: [f64; 2],
    side: f64,
    size: [usize; 2],
    starts: Vec<u32>,
    things: Vec<u32>,
}

impl Near {
    /// Points with their numbers; [`Near::within`] and [`Near::about`] ask for them.
    pub fn points(points: impl Iterator<Item = (u32, [f64; 2])> + Clone) -> Self {
        let made = Self::over(points.clone().map(|(_, point)| point), points.clone().count());
        let (starts, things) = made.sorted(points.map(|(number, point)| (made.bucket(point), number)));
        Self { starts, things, ..made }
    }

    /// Convex polygons, numbered as they come; [`Near::at`] and [`Near::beside`] ask for them.
    pub fn polygons(polygons: &[Vec<[f64; 2]>]) -> Self {
        let made = Self::over(polygons.iter().flatten().copied(), polygons.len());
        let mut entries = Vec::new();
        for (number, polygon) in polygons.iter().enumerate() {
            made.buckets(polygon, |bucket| entries.push((bucket, number as u32)));
        }
        let (starts, things) = made.sorted(entries.iter().copied());
        Self { starts, things, ..made }
    }

    /// The polygons that may hold a point, in the order of their numbers.
    pub fn at(&self, point: [f64; 2]) -> &[u32] {
        let beyond = [0, 1].into_iter().any(|axis| {
            let place = point[axis] - self.low[axis];
            !(0.0..=self.side * self.size[axis] as f64).contains(&place)
        });
        if beyond { &[] } else { self.of(self.bucket(point)) }
    }

    /// The points that may lie in a convex polygon, in no order.
    pub fn within(&self, polygon: &[[f64; 2]]) -> Vec<u32> {
        let mut found = Vec::new();
        self.buckets(polygon, |bucket| found.extend_from_slice(self.of(bucket)));
        found
    }

    /// The points that may lie within a distance of a place, in no order.
    pub fn about(&self, [x, y]: [f64; 2], distance: f64) -> Vec<u32> {
        self.within(&[[x - distance, y - distance], [x + distance, y + distance]])
    }

    /// The polygons that may touch another, in the order of their numbers.
    pub fn beside(&self, polygon: &[[f64; 2]]) -> Vec<u32> {
        let mut found = self.within(polygon);
        found.sort_unstable();
        found.dedup();
        found
    }

    fn over(points: impl Iterator<Item = [f64; 2]>, count: usize) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            for axis in [0, 1] {
                low[axis] = low[axis].min(point[axis] - SLACK);
                high[axis] = high[axis].max(point[axis] + SLACK);
            }
        }
        if low[0] > high[0] {
            (low, high) = ([0.0; 2], [SLACK; 2]);
        }
        let extent = [0, 1].map(|axis| high[axis] - low[axis]);
        let wanted = (FOR_EACH * count as f64).clamp(1.0, MOST);
        // What is long and thin has one row of buckets, each as long as it must be.
        let side = (extent[0] * extent[1] / wanted).sqrt().max(extent[0].max(extent[1]) / wanted);
        let size = extent.map(|length| (length / side).floor() as usize + 1);
        Self { low, side, size, starts: Vec::new(), things: Vec::new() }
    }

    /// Numbers by their buckets, in each in the order in which they come (a counting sort), and where each bucket begins.
    fn sorted(&self, entries: impl Iterator<Item = (u32, u32)> + Clone) -> (Vec<u32>, Vec<u32>) {
        let mut starts = vec![0; self.size[0] * self.size[1] + 1];
        for (bucket, _) in entries.clone() {
            starts[bucket as usize + 1] += 1;
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut next = starts.clone();
        let mut things = vec![0; starts[starts.len() - 1] as usize];
        for (bucket, number) in entries {
            let place = &mut next[bucket as usize];
            things[*place as usize] = number;
            *place += 1;
        }
        (starts, things)
    }

    fn of(&self, bucket: u32) -> &[u32] {
        &self.things[self.starts[bucket as usize] as usize..self.starts[bucket as usize + 1] as usize]
    }

    fn place(&self, axis: usize, value: f64) -> usize {
        (((value - self.low[axis]) / self.side).max(0.0) as usize).min(self.size[axis] - 1)
    }

    fn bucket(&self, [x, y]: [f64; 2]) -> u32 {
        (self.place(1, y) * self.size[0] + self.place(0, x)) as u32
    }

    /// Calls `visit` with each bucket that a convex polygon reaches into, row by row.
    fn buckets(&self, polygon: &[[f64; 2]], mut visit: impl FnMut(u32)) {
        let [low, high] = wider(around(polygon.iter().map(|p| p[1])), SLACK);
        if low > high {
            return;
        }
        for row in self.place(1, low)..=self.place(1, high) {
            // Of each side what lies in the row.
            let rows = [row, row + 1].map(|n| self.low[1] + n as f64 * self.side);
            let [from, to] = [rows[0] - SLACK, rows[1] + SLACK];
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for (n, p) in polygon.iter().enumerate() {
                let q = polygon[(n + 1) % polygon.len()];
                let (p, q) = if p[1] <= q[1] { (*p, q) } else { (q, *p) };
                if q[1] < from || p[1] > to {
                    continue;
                }
                let rise = (q[1] - p[1]).max(f64::MIN_POSITIVE);
                for y in [p[1].max(from), q[1].min(to)] {
                    let x = p[0] + (q[0] - p[0]) * ((y - p[1]) / rise).clamp(0.0, 1.0);
                    (left, right) = (left.min(x), right.max(x));
                }
                if q[1] - p[1] < SLACK {
                    (left, right) = (left.min(p[0]).min(q[0]), right.max(p[0]).max(q[0]));
                }
            }
            if left <= right {
                for column in self.place(0, left - SLACK)..=self.place(0, right + SLACK) {
                    visit((row * self.size[0] + column) as u32);
                }
            }
        }
    }
}

/// Convex polygons of which it is asked which hold a point.
pub struct Polygons<'a> {
    near: Near,
    pub all: &'a [Vec<[f64; 2]>],
}

impl<'a> Polygons<'a> {
    pub fn new(all: &'a [Vec<[f64; 2]>]) -> Self {
        Self { near: Near::polygons(all), all }
    }

    /// Does any hold a point?
    pub fn hold(&self, point: [f64; 2]) -> bool {
        self.at(point).next().is_some()
    }

    /// What part of some points each polygon holds that holds any.
    pub fn shares(&self, points: &[[f64; 2]]) -> impl Iterator<Item = f64> {
        let mut counts = BTreeMap::new();
        points.iter().flat_map(|&point| self.at(point)).for_each(|n| *counts.entry(n).or_insert(0) += 1);
        counts.into_values().map(|count| f64::from(count) / points.len() as f64)
    }

    /// Those that hold a point.
    fn at(&self, point: [f64; 2]) -> impl Iterator<Item = u32> {
        self.near.at(point).iter().copied().filter(move |&n| outline::holds(&self.all[n as usize], point))
    }
}
