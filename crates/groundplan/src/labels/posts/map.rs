//! The map, asked place by place along and across a heading: what stands where frames of racks may be, and before their faces.

use super::frames::{LEG, NEAR};
use super::rack::Rack;
use crate::ends::wider;
use crate::grid::{Grid, State};
use crate::labels::rows::Row;

/// Floor shows before a face from so far to so far off, metres, over so much of its length.
const FRONT: [f64; 2] = [0.25, 0.65];
const FLOOR: f64 = 0.8;
const STEP: f64 = 0.1;
/// What stands across so much of a row's depth hides what is there.
const LOST: f64 = 0.5;
/// A wall across a row is seen over so much of it.
const WALL: f64 = 0.9;

/// The map, asked place by place.
pub struct Map<'a> {
    pub grid: &'a Grid<'a>,
    pub heading: [f64; 2],
}

impl Map<'_> {
    pub fn state(&self, [u, v]: [f64; 2]) -> State {
        let [cos, sin] = self.heading;
        self.grid.state_at([u * cos - v * sin, u * sin + v * cos])
    }

    /// True when what most of a rack's frames are of goes on past a face, and nothing does between them: rows that it lies
    /// across.
    pub fn goes_on(&self, rack: &Rack) -> bool {
        let beyond = |[low, high]: [f64; 2]| [[low - FRONT[1], low], [high, high + FRONT[1]]];
        beyond(rack.row.across).into_iter().any(|beyond| {
            let taken = |place: f64| {
                let at = rack.row.along[0] + place * rack.pitch;
                self.share(at, beyond, |state| state != State::Free)
            };
            let at_frames = (0..rack.frames).filter(|&n| taken(n as f64) >= WALL).count();
            let between = (1..rack.frames).filter(|&n| taken(n as f64 - 0.5) >= LOST).count();
            2 * at_frames > rack.frames && 2 * between < rack.frames
        })
    }

    /// True when goods at a place along a row hide what stands there, on either side of it: a plate is thinner.
    pub fn is_hidden(&self, at: f64, faces: [f64; 2]) -> bool {
        self.stands(at, faces) && [-LEG, LEG].into_iter().any(|off| self.hides(at + off, faces))
    }

    /// True when across so much of a row's depth no floor shows at a place along it.
    pub fn hides(&self, at: f64, faces: [f64; 2]) -> bool {
        self.share(at, faces, |state| state != State::Free) >= LOST
    }

    /// True when something stands across so much of a row's depth at a place along it.
    pub fn stands(&self, at: f64, faces: [f64; 2]) -> bool {
        self.share(at, faces, |state| state == State::Occupied) >= LOST
    }

    /// Over how much of a row's depth it is so at a place along it.
    fn share(&self, at: f64, faces: [f64; 2], is: impl Fn(State) -> bool) -> f64 {
        let is_taken = |v: &f64| steps([at - NEAR, at + NEAR], STEP).any(|u| is(self.state([u, *v])));
        steps(faces, STEP).filter(is_taken).count() as f64 / steps(faces, STEP).count() as f64
    }

    /// True when a wall runs across a row and past both its faces somewhere between two places along it, or where it ends.
    pub fn is_walled(&self, along: [f64; 2], faces: [f64; 2]) -> bool {
        let is_occupied = |u: f64, v: f64| self.state([u, v]) == State::Occupied;
        // A wall may be a single pixel thick and lie askew to the pixels.
        let finer = STEP.min(self.grid.frame.resolution / 2.0);
        let is_taken = |at: f64, v: f64| steps([at - NEAR, at + NEAR], finer).any(|u| is_occupied(u, v));
        let across = || steps(wider(faces, FRONT[1]), STEP);
        steps(along, STEP)
            .any(|at| across().filter(|&v| is_taken(at, v)).count() as f64 >= WALL * across().count() as f64)
    }

    /// True when floor shows before one of a rack's faces.
    pub fn shows_floor(&self, row: &Row) -> bool {
        [(row.across[0], -1.0), (row.across[1], 1.0)].into_iter().any(|(face, side)| {
            let places =
                || steps(row.along, STEP).flat_map(|u| steps(FRONT, STEP).map(move |off| [u, face + side * off]));
            let free = places().filter(|&place| self.state(place) == State::Free).count();
            free as f64 >= FLOOR * places().count() as f64
        })
    }
}

/// Places from one to another, no farther apart than a step.
pub fn steps([from, to]: [f64; 2], step: f64) -> impl Iterator<Item = f64> + Clone {
    let count = ((to - from) / step).ceil().max(1.0) as usize;
    (0..=count).map(move |n| from + (to - from) * n as f64 / count as f64)
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::grid::{Frame, Table};

    pub const EAST: [f64; 2] = [1.0, 0.0];

    /// What a map of 12 x 6 m at 0.05 m shows on which some pixels are occupied, and all others free.
    pub fn on_map<T>(is_occupied: impl Fn(usize, usize) -> bool, heading: [f64; 2], shows: impl Fn(&Map) -> T) -> T {
        let pixels: Vec<u8> =
            (0..120).flat_map(|y| (0..240).map(move |x| [x, y])).map(|[x, y]| u8::from(is_occupied(x, y))).collect();
        let (mut values, mut states) = ([0; 256], [0; 256]);
        (values[1], states[1]) = (100, 1);
        let table = Table::new(&values, &states);
        let grid = Grid::new(&pixels, true, &table, Frame::new(240, 120, 0.05, [0.0; 3]));
        shows(&Map { grid: &grid, heading })
    }

    #[test]
    fn a_wall_across_a_row_runs_past_both_its_faces() {
        // A wall of one pixel at 5 m from edge to edge, and a rack's end as deep as the row at 2 m.
        let is_occupied = |x: usize, y: usize| x == 100 || x == 40 && (40..62).contains(&y);
        let is_walled = |along| on_map(is_occupied, EAST, |map| map.is_walled(along, [2.0, 3.1]));
        assert_eq!([[0.5, 4.5], [3.0, 5.5], [3.0, 4.95], [6.0, 9.0]].map(is_walled), [false, true, true, false]);
    }

    #[test]
    fn a_wall_of_single_pixels_is_one_on_a_map_that_is_turned() {
        for degrees in [5.0, 20.0, 33.0, 45.0] {
            let (sin, cos) = libm::sincos(f64::to_radians(degrees));
            // Through the map's middle; from row to row of pixels no gap is left.
            let place = |y: f64| 6.0 - (y - 3.0) * sin / cos;
            let is_occupied = |x: usize, y: usize| {
                let ends = [y, y + 1].map(|y| place(y as f64 / 20.0) * 20.0);
                (ends[1].floor()..=ends[0].floor()).contains(&(x as f64))
            };
            let [u, v] = [6.0 * cos + 3.0 * sin, 3.0 * cos - 6.0 * sin];
            let is_walled = |off: f64| {
                let along = [u + off - 0.4, u + off + 0.4];
                on_map(is_occupied, [cos, sin], |map| map.is_walled(along, [v - 0.5, v + 0.5]))
            };
            assert_eq!([0.0, -1.0, 1.0].map(is_walled), [true, false, false], "{degrees}");
        }
    }
}
