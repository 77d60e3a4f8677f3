//! II-D: O(face), by what the pixels add to it, and O(edge).

use crate::arrangement::Arrangement;
use crate::coverage::Covered;
use crate::directions::Directions;
use crate::gradients::Gradients;
use crate::grid::{Frame, State, tidy};
use crate::lines::Lines;
use crate::parameters::Parameters;
use crate::sums::{FaceSums, Sums};

/// What lies in the faces and on the edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Occupancy {
    /// O(face): average occupancy of its pixels, 0 to 1; unknown pixels count 0.5, the prior of an occupancy grid. A
    /// sliver without pixels has that of the pixel which it lies in; so have the two shares that follow.
    pub faces: Vec<f64>,
    /// Share of unknown pixels of each face, 0 to 1.
    pub unknown: Vec<f64>,
    /// Share of free pixels of each face, 0 to 1.
    pub free: Vec<f64>,
    /// Pixels with their centre in each face; together all of the map's.
    pub pixels: Vec<u64>,
    /// What each face mostly is.
    pub states: Vec<State>,
    /// O(edge): share of the edge's length on which occupied pixels lie, 0 to 1; nothing on the border.
    pub edges: Vec<f64>,
    /// Where on the edges they lie: from, to, metres from the edge's first vertex, in the edges' order and along each.
    pub runs: Vec<[f64; 2]>,
    /// Edge e has the runs from `run_offsets[e]` to `run_offsets[e + 1]`.
    pub run_offsets: Vec<u32>,
}

impl Occupancy {
    /// O(face), from what the pixels add to the faces; nothing of the edges yet.
    pub(crate) fn of_faces(sums: &FaceSums) -> Self {
        let pixels: Vec<u64> = sums.within.iter().map(|s| s.pixels.unsigned_abs()).collect();
        let room = || Vec::with_capacity(pixels.len());
        let (mut faces, mut unseen, mut free) = (room(), room(), room());
        let state = |sums: Sums| {
            let (occupied, unknown) = (occupied(sums), unknown(sums));
            faces.push(occupied);
            unseen.push(unknown);
            free.push(share(sums.free, sums.pixels));
            state(occupied, unknown)
        };
        let states = sums.evidence().map(state).collect();
        Self { faces, unknown: unseen, free, pixels, states, ..Self::default() }
    }

    /// What each face mostly is, and no more.
    pub(crate) fn states_of(sums: &FaceSums) -> Self {
        let states = sums.evidence().map(|sums| state(occupied(sums), unknown(sums))).collect();
        Self { states, ..Self::default() }
    }

    /// And O(edge).
    pub(crate) fn with(self, covered: Covered) -> Self {
        Self { edges: covered.shares, runs: covered.runs, run_offsets: covered.offsets, ..self }
    }

    /// The parts of an edge on which occupied pixels lie: from, to, metres from its first vertex.
    #[must_use]
    pub fn runs_of(&self, edge: usize) -> &[[f64; 2]] {
        &self.runs[self.run_offsets[edge] as usize..self.run_offsets[edge + 1] as usize]
    }
}

fn share(part: i64, of: i64) -> f64 {
    tidy(part as f64 / of as f64)
}

fn occupied(sums: Sums) -> f64 {
    share(sums.percent, 100 * sums.pixels)
}

fn unknown(sums: Sums) -> f64 {
    share(sums.unknown, sums.pixels)
}

/// A face is occupied when its average occupancy exceeds this and it is not mostly unknown.
const OCCUPIED: f64 = 0.5;

fn state(occupied: f64, unknown: f64) -> State {
    if unknown > 0.5 {
        State::Unknown
    } else if occupied > OCCUPIED {
        State::Occupied
    } else {
        State::Free
    }
}

/// Measures faces and edges, from what the pixels add to the faces and from the edge pixels.
#[must_use]
pub fn find_occupancy(
    frame: &Frame,
    sums: &FaceSums,
    arrangement: &Arrangement,
    directions: &Directions,
    lines: &Lines,
    gradients: &Gradients,
    parameters: &Parameters,
) -> Occupancy {
    Occupancy::of_faces(sums).with(Covered::new(frame, arrangement, directions, lines, gradients, parameters, 1))
}
