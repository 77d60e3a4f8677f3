//! II-E: what the parts of the map are.

mod corridors;
mod junctions;
mod outline;
mod paper;
mod strips;
mod turned;

use crate::adjacency::Adjacency;
use crate::directions::Directions;
use crate::gradients::Gradients;
use crate::grid::Grid;
use crate::lines::Lines;
use crate::occupancy::Occupancy;
use crate::parameters::{Method, Parameters};
use crate::subdivision::Subdivision;

/// Kinds of junctions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum JunctionKind {
    /// Two arms that turn.
    L,
    /// Three arms, two of them in line.
    T,
    /// Four arms.
    X,
    /// Three arms that are not square.
    Y,
    /// One arm: a dead end.
    End,
}

impl JunctionKind {
    /// Its name in the survey.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::L => "L",
            Self::T => "T",
            Self::X => "X",
            Self::Y => "Y",
            Self::End => "end",
        }
    }
}

/// What a part of the map is, and the faces that it was made from.
#[derive(Clone, Debug, PartialEq)]
pub enum Label {
    /// A way between facing walls.
    Corridor {
        /// Faces that lie in it.
        faces: Vec<u32>,
        /// Its outline, counter-clockwise, metres.
        polygon: Vec<[f64; 2]>,
        /// Its centre line, end to end.
        axis: [[f64; 2]; 2],
        /// The free width across it, metres.
        width: f64,
        /// Such as A03.
        name: String,
    },
    /// Where corridors meet, turn or end.
    Junction {
        /// By its arms.
        kind: JunctionKind,
        /// Faces that lie in it.
        faces: Vec<u32>,
        /// Its outline, counter-clockwise, metres.
        polygon: Vec<[f64; 2]>,
        /// Its middle.
        at: [f64; 2],
        /// Ids of the corridors that meet here.
        corridors: Vec<u32>,
    },
}

/// What the labels are found from.
pub(crate) struct Evidence<'a> {
    pub grid: &'a Grid<'a>,
    pub gradients: &'a Gradients,
    pub directions: &'a Directions,
    pub lines: &'a Lines,
    pub subdivision: &'a Subdivision,
    pub occupancy: &'a Occupancy,
    pub adjacency: &'a Adjacency,
    pub parameters: &'a Parameters,
    pub threads: usize,
}

/// Finds the labels by the method that the parameters name; corridors first.
pub(crate) fn find_labels(evidence: &Evidence) -> Vec<Label> {
    match evidence.parameters.labels_method {
        Method::Strips => strips::find(evidence),
        Method::Paper => paper::find(evidence),
    }
}
