//! The stages in a row for a map of many pixels: one after another, and what each makes is let go as soon as nothing
//! needs it any more. What is small against the time that it takes to find it is kept, all else is found again.

use crate::adjacency::Adjacency;
use crate::arrangement::arrange;
use crate::bands::side_by_side;
use crate::coverage::Coverage;
use crate::gradients::{Gradients, find_gradients_in};
use crate::grid::Grid;
use crate::labels::{Division, Ground, Memory, Recall, Sight, Sketch, find_confidence, find_labels_in, find_patterns};
use crate::occupancy::Occupancy;
use crate::parameters::Parameters;
use crate::subdivision::Subdivision;
use crate::sums::FaceSums;
use crate::survey::{Given, Structure, Survey};
use crate::walls::find_walls;

/// Maps of more pixels than this are surveyed so.
pub(crate) const MANY: usize = 1 << 27;
/// Rows of which the gradients are found anew at once.
const ROWS: usize = 1024;

/// As [`crate::survey`] makes it, with labels by strips; but neither gradients nor adjacency are kept. The number of
/// edge pixels comes with it.
pub(crate) fn survey(grid: &Grid, parameters: &Parameters, mut given: Given, threads: usize) -> (Survey, usize) {
    let recall = Recall::default();
    let frame = &grid.frame;
    let mut structure = Structure::new(grid, parameters, &mut given, threads);
    let count = structure.gradients.pixels.len();
    let sight = {
        let evidence = structure.evidence(grid, parameters, threads, &recall);
        side_by_side(1, |side| Sight::new(side, &evidence, Ground::start(side, grid, threads, &recall)).done())
    };
    // The labels' racks need specks, and no other stage needs gradients but the coverage of edges, which takes them
    // part by part.
    structure.gradients = structure.gradients.specks();
    let evidence = structure.evidence(grid, parameters, threads, &recall);

    let sketch = Sketch::new(&evidence, sight);
    let arranged = |of: &Structure| arrange(frame, &of.directions.angles, &of.lines, threads);
    let sums = given.sums;
    let measured = |arrangement: &_| match &sums {
        Some(sums) if sums.fits(arrangement) => Occupancy::of_faces(sums),
        _ => Occupancy::of_faces(&FaceSums::new(grid, arrangement, 0..frame.height, threads)),
    };
    let (labels, confidence) = {
        // What the labels ask of the faces: their middles and what they mostly are.
        let arrangement = arranged(&structure);
        let states = measured(&arrangement).states;
        let occupancy = Occupancy { states, ..Occupancy::default() };
        let centres = Subdivision::new(frame, arrangement, threads).centres;
        let subdivision = Subdivision { centres, ..Subdivision::default() };
        let division = Division { subdivision: &subdivision, occupancy: &occupancy, adjacency: &Adjacency::default() };
        let labels = find_labels_in(&evidence, &division, sketch);
        let confidence = find_confidence(&evidence, &labels);
        (labels, confidence)
    };
    structure.gradients = Gradients::default();

    let arrangement = arranged(&structure);
    let Structure { gradients, directions, radiograms, lines } = structure;
    let mut coverage = Coverage::new(frame, &arrangement, &directions, &lines, parameters);
    for first in (0..frame.height).step_by(ROWS) {
        let rows = first..frame.height.min(first + ROWS);
        coverage.add(&find_gradients_in(grid, rows, 0..frame.width, parameters, threads));
    }
    let covered = coverage.of_edges(&arrangement);
    let occupancy = measured(&arrangement).with(covered);
    let subdivision = Subdivision::new(frame, arrangement, threads);
    let walls = find_walls(&subdivision, &occupancy, parameters);
    let survey = Survey {
        memory: Memory::default(),
        patterns: find_patterns(&directions, &labels),
        gradients,
        directions,
        radiograms,
        lines,
        subdivision,
        occupancy,
        walls,
        labels,
        confidence,
        warnings: Vec::new(),
    };
    (survey, count)
}
