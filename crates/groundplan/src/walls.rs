//! II-D: cogency -> separating and freestanding walls, the abstraction (Fig. 6).

use crate::arrangement::NONE;
use crate::grid::{State, tidy};
use crate::occupancy::Occupancy;
use crate::parameters::Parameters;
use crate::subdivision::Subdivision;

/// How a wall was known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallKind {
    /// By what it separates: one side is taken, the other is not.
    Separating,
    /// By what lies on it: both sides are alike.
    Freestanding,
}

/// A piece of wall: cogent edges of one kind, joined along their line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Its ends, metres in the map frame.
    pub points: [[f64; 2]; 2],
    /// Its line.
    pub line: u32,
    /// How it was known.
    pub kind: WallKind,
}

/// C(edge) of the paper for each edge, and the walls that the cogent edges make.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walls {
    /// C(edge): there is a physical separation on it.
    pub cogent: Vec<bool>,
    /// Face disparity |O(f1) - O(f2)| of each edge; 0 on the border.
    pub disparity: Vec<f64>,
    /// The abstraction.
    pub walls: Vec<Wall>,
}

/// Against the unknown, disparity alone is the frontier of what was explored: a wall has this much on it as well.
const LEAST_OCCUPANCY_AT_FRONTIER: f64 = 0.2;

/// C(edge) = |O(f1) - O(f2)| > t1 or O(edge) > t2.
#[must_use]
pub fn find_walls(subdivision: &Subdivision, occupancy: &Occupancy, parameters: &Parameters) -> Walls {
    let disparity: Vec<f64> = subdivision
        .edge_faces
        .iter()
        .map(|&[l, r]| {
            if l == NONE || r == NONE {
                0.0
            } else {
                tidy((occupancy.faces[l as usize] - occupancy.faces[r as usize]).abs())
            }
        })
        .collect();
    let inner = |e: usize| !subdivision.edge_faces[e].contains(&NONE);
    let cogent: Vec<bool> = (0..disparity.len())
        .map(|e| {
            inner(e) && (disparity[e] > parameters.walls_disparity || occupancy.edges[e] > parameters.walls_occupancy)
        })
        .collect();
    let kind = |e: usize| {
        if !cogent[e] {
            return None;
        }
        let unknown = subdivision.edge_faces[e].iter().any(|&f| occupancy.states[f as usize] == State::Unknown);
        if unknown && occupancy.edges[e] < LEAST_OCCUPANCY_AT_FRONTIER {
            None
        } else if disparity[e] > parameters.walls_disparity {
            Some(WallKind::Separating)
        } else {
            Some(WallKind::Freestanding)
        }
    };
    // The edges of a line follow one another.
    let mut walls: Vec<Wall> = Vec::new();
    let mut open: Option<(u32, WallKind)> = None;
    for (edge, &line) in subdivision.edge_lines.iter().enumerate() {
        let found = kind(edge).map(|kind| (line, kind));
        let ends = subdivision.edge_vertices[edge].map(|v| subdivision.vertices[v as usize]);
        match (found, walls.last_mut()) {
            (Some(_), Some(wall)) if found == open => wall.points[1] = ends[1],
            (Some((line, kind)), _) => walls.push(Wall { points: ends, line, kind }),
            (None, _) => {}
        }
        open = found;
    }
    Walls { cogent, disparity, walls }
}
