//! The stages in a row for a map of many pixels: one after another, and what each makes is let go as soon as nothing
//! needs it any more. What is small against the time that it takes to find it is kept, all else is found again.

use crate::adjacency::Adjacency;
use crate::arrangement::{Arrangement, arrange};
use crate::bands::side_by_side;
use crate::coverage::Coverage;
use crate::gradients::Gradients;
use crate::grid::{Frame, Grid};
use crate::labels::{Division, Ground, Lined, Memory, Recall, Sketch, find_labels_in, find_patterns};
use crate::occupancy::Occupancy;
use crate::parameters::Parameters;
use crate::subdivision::Subdivision;
use crate::sums::FaceSums;
use crate::survey::{Given, Structure, Survey};
use crate::walls::{disparities, trace_walls};
use std::borrow::Cow;

/// Maps of more pixels than this are surveyed so.
const MANY: usize = 1 << 27;

/// True of maps of so many pixels that memory is spared.
#[must_use]
pub fn is_large(frame: &Frame) -> bool {
    frame.width * frame.height > MANY
}

/// As [`crate::survey`] makes it, with labels by strips; but neither gradients nor adjacency are kept, nor the
/// subdivision, which the lines make again. The number of edge pixels comes with it.
pub(crate) fn survey(grid: &Grid, parameters: &Parameters, mut given: Given, threads: usize) -> (Survey, usize) {
    let recall = Recall::default();
    let frame = &grid.frame;
    let mut structure = Structure::new(grid, parameters, &mut given, threads);
    let count = structure.gradients.pixels.len();
    let arranged = |of: &Structure| arrange(frame, &of.directions.angles, &of.lines, threads);
    // What the labels ask of the faces: what they mostly are and their middles. And the lines that have edges.
    let (subdivision, occupancy, mut coverage, given, under) = {
        let arrangement = arranged(&structure);
        let given = given.sums.filter(|sums| sums.fits(&arrangement));
        let sums = match &given {
            Some(sums) => Cow::Borrowed(sums),
            None => Cow::Owned(FaceSums::new(grid, &arrangement, 0..frame.height, threads)),
        };
        let Structure { directions, lines, .. } = &structure;
        let coverage = Coverage::new(frame, &arrangement, directions, lines, parameters);
        let occupancy = Occupancy::states_of(&sums);
        let under = match sums {
            Cow::Owned(sums) => sums.under,
            Cow::Borrowed(_) => Vec::new(),
        };
        let centres = Subdivision::new(frame, arrangement, threads).centres;
        (Subdivision { centres, ..Subdivision::default() }, occupancy, coverage, given, under)
    };
    coverage.add(&structure.gradients, threads);
    let lined = {
        let evidence = structure.evidence(grid, parameters, threads, &recall);
        side_by_side(1, |side| Lined::new(&evidence, Ground::start(side, grid, threads, &recall)))
    };
    // What is seen between the lines and the labels' racks need specks, and no other stage needs gradients.
    structure.gradients = structure.gradients.specks();
    let (labels, confidence) = {
        let evidence = structure.evidence(grid, parameters, threads, &recall);
        let no_links = Adjacency::default();
        let division = Division { subdivision: &subdivision, occupancy: &occupancy, adjacency: &no_links };
        find_labels_in(&evidence, || division, Sketch::new(&evidence, lined.seen(&evidence)))
    };
    drop((subdivision, occupancy));
    structure.gradients = Gradients::default();

    let mut arrangement = arranged(&structure);
    let occupancy = {
        // Walls are found from the edges alone.
        arrangement.face_halves = Vec::new();
        let sums = given.unwrap_or_else(|| FaceSums::again(grid, &arrangement, under, threads));
        let Arrangement { face_offsets, edge_lines, rows_below, .. } = &mut arrangement;
        for list in [face_offsets, edge_lines, rows_below] {
            *list = Vec::new();
        }
        Occupancy::of_faces(&sums)
    };
    let Structure { gradients, directions, radiograms, lines } = structure;
    let covered = coverage.of_edges(&arrangement);
    let occupancy = occupancy.with(covered);
    let edges = (0..).zip(&arrangement.line_edges).filter(|(_, edges)| !edges.is_empty());
    let edges: Vec<_> = edges.map(|(line, edges)| (line, edges.start as usize..edges.end as usize)).collect();
    let mut subdivision = Subdivision::of_edges(frame, arrangement, threads);
    let mut walls = trace_walls(&subdivision, &edges, &occupancy, parameters, 1);
    let edge_faces = std::mem::take(&mut subdivision.edge_faces);
    drop(subdivision);
    walls.disparity = disparities(&edge_faces, &occupancy);
    let survey = Survey {
        memory: Memory::default(),
        patterns: find_patterns(&directions, &labels),
        gradients,
        directions,
        radiograms,
        lines,
        subdivision: Subdivision::default(),
        occupancy,
        walls,
        labels,
        confidence,
        warnings: Vec::new(),
    };
    (survey, count)
}
