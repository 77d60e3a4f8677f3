//! II-E: what the parts of the map are.

mod beside;
mod confidence;
mod corridors;
mod junctions;
mod looks;
mod names;
mod near;
mod outline;
mod paper;
mod patterns;
mod places;
mod posts;
mod recall;
mod rooms;
mod rows;
mod sketch;
mod strips;
mod view;
mod ways;

pub use confidence::find_confidence;
pub use patterns::{Pattern, PatternKind, find_patterns};
pub use recall::{Memory, Recall};

use crate::adjacency::Adjacency;
use crate::bands::{Later, Side, side_by_side};
use crate::directions::Directions;
use crate::gradients::Gradients;
use crate::grid::Grid;
use crate::lines::Lines;
use crate::occupancy::Occupancy;
use crate::parameters::{Method, Parameters};
use crate::subdivision::Subdivision;
use crate::tiles::Tiles;
pub(crate) use posts::faces::with_faces;
pub(crate) use posts::legs::find as find_racks_on_legs;
pub(crate) use posts::uprights::find as find_uprights;
use rooms::Space;
pub(crate) use sketch::{Glance, Lined, Sight, Sketch};
use view::look::Look;

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
    /// A piece of free space that walls and doors set apart.
    Region {
        /// What it is for.
        purpose: Purpose,
        /// Faces that lie in it.
        faces: Vec<u32>,
        /// Its outline, counter-clockwise, metres.
        polygon: Vec<[f64; 2]>,
        /// What lies within the outline and is not of it, clockwise.
        holes: Vec<Vec<[f64; 2]>>,
        /// A point in it, far from its walls.
        at: [f64; 2],
        /// Free space, square metres.
        area: f64,
        /// Such as R3-07.
        name: String,
    },
    /// A way from one region into another.
    Door {
        /// Its middle.
        at: [f64; 2],
        /// Its two jambs.
        axis: [[f64; 2]; 2],
        /// Its free width, metres.
        width: f64,
        /// Ids of the two regions.
        between: [u32; 2],
    },
    /// A row that is taken, between ways.
    Rack {
        /// Faces that lie in it.
        faces: Vec<u32>,
        /// Its outline, counter-clockwise, metres.
        polygon: Vec<[f64; 2]>,
        /// Its centre line, end to end.
        axis: [[f64; 2]; 2],
        /// How deep it is, face to face, metres.
        width: f64,
        /// From post to post along it, metres, where posts recur.
        pitch: Option<f64>,
        /// From the first end of its axis to the first post, metres.
        phase: Option<f64>,
        /// Such as S2-04.
        name: String,
    },
    /// Something small that stands by itself and recurs.
    Pillar {
        /// Its middle.
        at: [f64; 2],
        /// How wide it is, metres.
        width: f64,
        /// The number of the pattern that it is of.
        pattern: u32,
        /// Such as P3-07.
        name: String,
    },
}

/// What a region is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Of one piece.
    Room,
    /// Long, and led into from its sides; or a passage, which one way fills from door to door.
    Corridor,
    /// Large.
    Hall,
}

impl Purpose {
    /// Its name in the survey.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Room => "room",
            Self::Corridor => "corridor",
            Self::Hall => "hall",
        }
    }
}

/// What the labels are found from: the map, and what the stages up to the lines made of it.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a> {
    /// The map.
    pub grid: &'a Grid<'a>,
    /// II-A: oriented gradients.
    pub gradients: &'a Gradients,
    /// II-A: dominant directions.
    pub directions: &'a Directions,
    /// II-B: lines.
    pub lines: &'a Lines,
    /// How to find them.
    pub parameters: &'a Parameters,
    /// At most so many.
    pub threads: usize,
    /// What is known from before.
    pub recall: &'a Recall,
}

/// What the map is seen from before there are lines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scene<'a> {
    pub grid: &'a Grid<'a>,
    pub directions: &'a Directions,
    /// At most so many.
    pub threads: usize,
    /// What is known from before.
    pub recall: &'a Recall,
}

impl<'a> Evidence<'a> {
    /// What of it needs no lines.
    fn scene(&self) -> Scene<'a> {
        let Self { grid, directions, threads, recall, .. } = *self;
        Scene { grid, directions, threads, recall }
    }

    /// For each direction's view: it shares its own work out among what threads are left.
    fn shared_out(&self) -> Self {
        Self { threads: self.scene().shared_out().threads, ..*self }
    }
}

impl Scene<'_> {
    /// The same.
    fn shared_out(&self) -> Self {
        Self { threads: self.threads / self.directions.angles.len().max(1), ..*self }
    }
}

/// The map as its lines divide it: what the labels' faces are taken from.
#[derive(Clone, Copy, Debug)]
pub struct Division<'a> {
    /// II-C: vertices, edges, faces.
    pub subdivision: &'a Subdivision,
    /// II-D: O(face), O(edge).
    pub occupancy: &'a Occupancy,
    /// II-D: the dual.
    pub adjacency: &'a Adjacency,
}

/// What the labels take from the pixels alone, whatever the stages before them find.
pub(crate) struct Ground<'scope, 'a> {
    pub look: Later<'scope, Look<'a>>,
    pub space: Later<'scope, Option<Space>>,
}

impl<'scope, 'a: 'scope> Ground<'scope, 'a> {
    /// Begins to look at a map.
    pub fn start(side: Side<'scope, '_>, grid: &'scope Grid<'a>, threads: usize, recall: &'scope Recall) -> Self {
        let look = side.start(move || {
            // Keys of the map are made here, where there are threads for them.
            recall.patches(grid, threads);
            Look::new(grid, &Tiles::new(grid, threads))
        });
        Self { look, space: side.start(move || Space::new(grid, threads, recall)) }
    }
}

/// The labels that a sketch shows, and for each label how sure it is, 0 to 1.
pub(crate) fn find_labels_in<'d>(
    evidence: &Evidence,
    division: impl Fn() -> Division<'d> + Sync,
    sketch: Sketch,
) -> (Vec<Label>, Vec<f64>) {
    let ask = |labels: &[Label]| confidence::each_by_itself(evidence, labels);
    let (labels, own) = strips::find(evidence, division, sketch, ask);
    let confidence = confidence::confidence(&labels, &own);
    (labels, confidence)
}

/// The lines, and those along the faces of racks on legs that none of them follows, of which a radiogram has no peak: what a survey
/// has. The labels by [`Method::Paper`] know of no racks, and leave the lines as they are.
#[must_use]
pub fn add_rack_faces(
    grid: &Grid,
    gradients: &Gradients,
    directions: &Directions,
    lines: Lines,
    parameters: &Parameters,
    threads: usize,
) -> Lines {
    if parameters.labels_method == Method::Paper {
        return lines;
    }
    let scene = Scene { grid, directions, threads, recall: &Recall::default() };
    let racks = find_racks_on_legs(&scene, &find_uprights(&grid.frame, &gradients.pixels));
    with_faces(lines, &racks, &grid.frame, parameters)
}

/// Finds the labels by the method that the parameters name; corridors first.
#[must_use]
pub fn find_labels(evidence: &Evidence, division: &Division) -> Vec<Label> {
    match evidence.parameters.labels_method {
        Method::Paper => paper::find(evidence, division),
        Method::Strips => side_by_side(evidence.threads, |side| {
            let Ground { look, space } = Ground::start(side, evidence.grid, evidence.threads, evidence.recall);
            let uprights = find_uprights(&evidence.grid.frame, &evidence.gradients.pixels);
            let racks = find_racks_on_legs(&evidence.scene(), &uprights);
            let glance = Later::Made(Glance::new(&evidence.scene(), look.get(), &uprights, &racks));
            let sketch = Sketch::beside(evidence, Sight::new(side, evidence, space, glance));
            strips::find(evidence, || *division, sketch, |_| Vec::<()>::new()).0
        }),
    }
}
