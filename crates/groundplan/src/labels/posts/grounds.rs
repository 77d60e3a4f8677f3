//! The ground of racks that stand on legs, in the places of a view: it is taken, though the map shows floor there.

use crate::directions::Directions;
use crate::ends::{around, sorted};
use crate::labels::recall::Key;
use crate::labels::rows::Row;
use crate::labels::view::axes::Axes;
use crate::labels::view::turned::Turned;
use std::ops::Range;

/// The sides of what stands across the direction, or nearly, are so much off it at most.
const ASKEW: f64 = 0.02;
/// Racks are kept by so many rows of cells.
const ROWS: usize = 64;

/// Where racks on legs stand.
#[derive(Default)]
pub struct Grounds {
    /// Their corners, in places along and across.
    corners: Vec<[[f64; 2]; 4]>,
    /// Those that reach into so many rows of cells, and the next, and so on.
    near: Vec<Vec<u32>>,
}

impl Grounds {
    pub fn new(directions: &Directions, view: &Turned, racks: &[Row]) -> Self {
        let corners = |rack: &Row| on_map(directions, rack).map(|corner| view.place(corner));
        let corners: Vec<_> = racks.iter().map(corners).collect();
        let mut near = vec![Vec::new(); if racks.is_empty() { 0 } else { view.size[1] / ROWS + 1 }];
        for (n, corners) in (0u32..).zip(&corners) {
            let band = |v: f64| ((v - view.start[1]) / view.cell).max(0.0) as usize / ROWS;
            let [from, to] = across(corners).map(band);
            near.iter_mut().take(to + 1).skip(from).for_each(|band| band.push(n));
        }
        Self { corners, near }
    }

    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// From where to where each rack goes that lies at a place across, which is in a row of cells.
    pub fn at(&self, row: usize, v: f64) -> impl Iterator<Item = [f64; 2]> {
        let near = self.near.get(row / ROWS).into_iter().flatten();
        near.filter_map(move |&n| crossed(&self.corners[n as usize], v))
    }

    /// A key with those that reach into rows of cells, which lie from one place across to another.
    pub fn key(&self, key: Key, rows: &Range<usize>, [low, high]: [f64; 2]) -> Key {
        let bands = self.near.iter().take(rows.end.div_ceil(ROWS)).skip(rows.start / ROWS);
        let lies_there = |corners: &&[[f64; 2]; 4]| {
            let [from, to] = across(corners);
            to >= low && from <= high
        };
        let near = bands.flatten().map(|&n| &self.corners[n as usize]).filter(lies_there);
        near.flatten().flatten().copied().fold(key, Key::number)
    }

    /// The sides that lie along the direction: where they are across, and from where to where along.
    pub fn sides(&self) -> Vec<(f64, [f64; 2])> {
        let along =
            self.corners.iter().flat_map(sides).filter(|[a, b]| (a[1] - b[1]).abs() <= ASKEW * (a[0] - b[0]).abs());
        along.map(|[a, b]| (f64::midpoint(a[1], b[1]), sorted([a[0], b[0]]))).collect()
    }
}

/// The corners of a row in the map frame, counter-clockwise.
pub fn on_map(directions: &Directions, row: &Row) -> [[f64; 2]; 4] {
    Axes::of(directions, row.direction).rectangle(row.along, row.across)
}

fn sides(corners: &[[f64; 2]; 4]) -> [[[f64; 2]; 2]; 4] {
    std::array::from_fn(|n| [corners[n], corners[(n + 1) % 4]])
}

/// From where to where across corners lie.
fn across(corners: &[[f64; 2]; 4]) -> [f64; 2] {
    around(corners.iter().map(|corner| corner[1]))
}

/// From where to where along a convex piece goes at a place across.
fn crossed(corners: &[[f64; 2]; 4], v: f64) -> Option<[f64; 2]> {
    let met = sides(corners).into_iter().filter(|[a, b]| (a[1] <= v) != (b[1] <= v));
    let places = met.map(|[a, b]| a[0] + (b[0] - a[0]) * (v - a[1]) / (b[1] - a[1]));
    let ends = around(places);
    (ends[0] < ends[1]).then_some(ends)
}
