//! The stages in a row.

use crate::adjacency::{Adjacency, find_adjacency};
use crate::arrangement::arrange;
use crate::bands::{Awaited, Later, side_by_side, worth};
use crate::coverage::Covered;
use crate::directions::{Directions, find_directions};
use crate::gradients::{Gradients, find_gradients};
use crate::grid::{Frame, Grid, angle_between};
use crate::labels::{
    Division, Evidence, Glance, Ground, Label, Memory, Pattern, Recall, Scene, Sight, Sketch, add_rack_faces,
    find_confidence, find_labels, find_labels_in, find_patterns, find_racks_on_legs, find_uprights, with_faces,
};
use crate::lines::{Lines, find_lines};
use crate::occupancy::Occupancy;
use crate::parameters::{Method, Parameters};
use crate::radiograms::{Radiogram, find_radiograms};
use crate::sparing;
use crate::subdivision::Subdivision;
use crate::sums::FaceSums;
use crate::walls::{Walls, find_walls};

/// Partial trouble: a stable code and a sentence that names the value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// Such as `few-edges`.
    pub code: &'static str,
    /// A sentence.
    pub message: String,
}

/// What every stage made of a grid.
#[derive(Clone, Debug)]
pub struct Survey {
    /// II-A: oriented gradients.
    pub gradients: Gradients,
    /// II-A: dominant directions.
    pub directions: Directions,
    /// II-B: one for each direction.
    pub radiograms: Vec<Radiogram>,
    /// II-B: lines.
    pub lines: Lines,
    /// II-C: vertices, edges, faces; nothing where it is not kept.
    pub subdivision: Subdivision,
    /// II-D: O(face), O(edge).
    pub occupancy: Occupancy,
    /// II-D: C(edge) and the abstraction.
    pub walls: Walls,
    /// II-E: what is what.
    pub labels: Vec<Label>,
    /// How sure each label is, 0 to 1.
    pub confidence: Vec<f64>,
    /// What recurs among them.
    pub patterns: Vec<Pattern>,
    /// Partial trouble.
    pub warnings: Vec<Warning>,
    /// What is kept for a survey after the map has changed.
    pub memory: Memory,
}

/// Stages' results that are given, not found: how one stage is replaced.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// In place of II-A's gradients, such as parts that were found one by one.
    pub gradients: Option<Gradients>,
    /// In place of II-A.
    pub directions: Option<Directions>,
    /// In place of II-B.
    pub lines: Option<Lines>,
    /// What the pixels add to the faces that these lines make.
    pub sums: Option<FaceSums>,
    /// What a survey of the same parameters kept; gradients that are given with it are those of the pixels.
    pub memory: Option<Memory>,
    /// The gradients, and what is found on the way to the labels, will be wanted again: where the map is large they are
    /// let go if not.
    pub keep: bool,
}

impl Given {
    /// Those that are given, or else found.
    fn gradients(&mut self, grid: &Grid, parameters: &Parameters, threads: usize) -> Gradients {
        self.gradients.take().unwrap_or_else(|| find_gradients(grid, parameters, threads))
    }

    fn directions(
        &mut self,
        frame: &Frame,
        gradients: &Gradients,
        parameters: &Parameters,
        threads: usize,
    ) -> Directions {
        self.directions.take().unwrap_or_else(|| find_directions(frame, gradients, parameters, threads))
    }
}

/// Surveys a grid. Total: any grid and parameters give a valid subdivision, at worst one face, and warnings.
#[must_use]
pub fn survey(grid: &Grid, parameters: &Parameters, mut given: Given, threads: usize) -> Survey {
    let frame = &grid.frame;
    let strips = parameters.labels_method == Method::Strips;
    if strips && !given.keep && sparing::is_large(frame) {
        return survey_sparingly(grid, parameters, given, threads);
    }
    // What the labels need of the pixels alone, then of the directions, and then of the lines, is made beside other stages.
    let recall = Recall::new(given.keep.then(|| given.memory.take().unwrap_or_default()));
    let mut survey = side_by_side(threads, |side| {
        let ground = strips.then(|| Ground::start(side, grid, threads, &recall));
        let gradients = given.gradients(grid, parameters, threads);
        // What is looked for in the edge pixels alone, beside what lines up.
        let (directions, uprights) = side_by_side(worth(frame.width * frame.height, threads), |side| {
            let uprights = strips.then(|| side.start(|| find_uprights(frame, &gradients.pixels)));
            (given.directions(frame, &gradients, parameters, threads), uprights.map(Later::get))
        });
        let scene = Scene { grid, directions: &directions, threads, recall: &recall };
        let on_legs = uprights.as_ref().map(|uprights| find_racks_on_legs(&scene, uprights)).unwrap_or_default();
        let (radiograms, lines, divided, walls, labels, confidence) = side_by_side(threads, |side| {
            let seen = ground.zip(uprights).map(|(Ground { look, space }, uprights)| {
                let on_legs = &on_legs;
                (space, side.start(move || Glance::new(&scene, look.get(), &uprights, on_legs)))
            });
            let radiograms = find_radiograms(frame, &gradients, &directions, parameters, threads);
            let lines = given.lines.take().unwrap_or_else(|| {
                let lines = find_lines(&radiograms, parameters, threads);
                with_faces(lines, &on_legs, frame, parameters)
            });
            let (gradients, directions) = (&gradients, &directions);
            let evidence =
                Evidence { grid, gradients, directions, lines: &lines, parameters, threads, recall: &recall };
            let (divided, walls, labels, confidence) = side_by_side(threads, |side| {
                let divided = side.start(|| Divided::new(&evidence, given.sums));
                let sketch =
                    seen.map(|(space, glance)| Sketch::beside(&evidence, Sight::new(side, &evidence, space, glance)));
                labelled(&evidence, Awaited::new(divided), sketch)
            });
            (radiograms, lines, divided, walls, labels, confidence)
        });
        let Divided { subdivision, occupancy } = divided;
        let patterns = find_patterns(&directions, &labels);
        let warnings = Vec::new();
        Survey {
            gradients,
            directions,
            radiograms,
            lines,
            subdivision,
            occupancy,
            walls,
            labels,
            confidence,
            patterns,
            warnings,
            memory: Memory::default(),
        }
    });
    survey.memory = recall.memory();
    survey.warnings = find_warnings(&survey, frame, survey.gradients.pixels.len(), parameters);
    debug_assert_eq!(survey.subdivision.problems(), Vec::<String>::new());
    debug_assert_eq!(survey.occupancy.pixels.iter().sum::<u64>(), (grid.frame.width * grid.frame.height) as u64);
    survey
}

/// The same with labels by strips, in far less memory and somewhat more time: one stage after another, and neither the
/// gradients are kept nor the subdivision, which [`arrange`] and [`Subdivision::new`] make of the lines. Maps of many
/// pixels are surveyed so.
#[must_use]
pub fn survey_sparingly(grid: &Grid, parameters: &Parameters, given: Given, threads: usize) -> Survey {
    let (mut survey, edges) = sparing::survey(grid, parameters, given, threads);
    survey.warnings = find_warnings(&survey, &grid.frame, edges, parameters);
    survey
}

/// What lines up: the stages up to the lines.
pub(crate) struct Structure {
    pub gradients: Gradients,
    pub directions: Directions,
    pub radiograms: Vec<Radiogram>,
    pub lines: Lines,
}

impl Structure {
    pub fn new(grid: &Grid, parameters: &Parameters, given: &mut Given, threads: usize) -> Self {
        let frame = &grid.frame;
        let gradients = given.gradients(grid, parameters, threads);
        let directions = given.directions(frame, &gradients, parameters, threads);
        let radiograms = find_radiograms(frame, &gradients, &directions, parameters, threads);
        let lines = given.lines.take().unwrap_or_else(|| {
            let lines = find_lines(&radiograms, parameters, threads);
            add_rack_faces(grid, &gradients, &directions, lines, parameters, threads)
        });
        Self { gradients, directions, radiograms, lines }
    }

    /// What labels are found from.
    pub fn evidence<'a>(
        &'a self,
        grid: &'a Grid<'a>,
        parameters: &'a Parameters,
        threads: usize,
        recall: &'a Recall,
    ) -> Evidence<'a> {
        let Self { gradients, directions, lines, .. } = self;
        Evidence { grid, gradients, directions, lines, parameters, threads, recall }
    }
}

/// The map as its lines divide it.
struct Divided {
    subdivision: Subdivision,
    occupancy: Occupancy,
}

impl Divided {
    fn new(evidence: &Evidence, given: Option<FaceSums>) -> Self {
        let Evidence { grid, gradients, directions, lines, parameters, threads, .. } = *evidence;
        let frame = &grid.frame;
        let arrangement = arrange(frame, &directions.angles, lines, threads);
        let fits = |sums: &FaceSums| sums.fits(&arrangement);
        let found = || FaceSums::new(grid, &arrangement, 0..frame.height, threads);
        let occupancy = side_by_side(threads, |side| {
            let covered = || Covered::new(frame, &arrangement, directions, lines, gradients, parameters, threads);
            let covered = side.start(covered);
            Occupancy::of_faces(&given.filter(fits).unwrap_or_else(found)).with(covered.get())
        });
        Self { subdivision: Subdivision::new(frame, arrangement, threads), occupancy }
    }
}

/// The labels, from a sketch or by the paper's method, and the walls of what is being divided. Labels by strips ask nothing
/// of walls, and of faces last.
fn labelled(
    evidence: &Evidence,
    divided: Awaited<Divided>,
    sketch: Option<Sketch>,
) -> (Divided, Walls, Vec<Label>, Vec<f64>) {
    let walls =
        || find_walls(&divided.get().subdivision, &divided.get().occupancy, evidence.parameters, evidence.threads);
    let division = |adjacency| {
        let Divided { subdivision, occupancy } = divided.get();
        Division { subdivision, occupancy, adjacency }
    };
    let (walls, labels, confidence) = if let Some(sketch) = sketch {
        let no_links = Adjacency::default();
        side_by_side(evidence.threads, |side| {
            let walls = side.start(walls);
            let (labels, confidence) = find_labels_in(evidence, || division(&no_links), sketch);
            (walls.get(), labels, confidence)
        })
    } else {
        let walls = walls();
        let adjacency = find_adjacency(&divided.get().subdivision.edge_faces, &walls.cogent);
        let labels = find_labels(evidence, &division(&adjacency));
        let confidence = find_confidence(evidence, &labels);
        (walls, labels, confidence)
    };
    (divided.into_made(), walls, labels, confidence)
}

/// The evidence does not decide a label that is no surer than this.
pub const UNSURE: f64 = 0.5;

/// A warning where the evidence does not decide what something is.
fn undecided(labels: &[Label], confidence: &[f64]) -> Option<Warning> {
    let count = confidence.iter().filter(|sure| **sure <= UNSURE).count();
    let least = confidence.iter().copied().fold(1.0, f64::min);
    let all = labels.len();
    (count > 0).then(|| Warning {
        code: "unsure-labels",
        message: format!(
            "the evidence does not decide {count} of {all} labels: their confidence is {UNSURE} or less, down to {least}"
        ),
    })
}

/// What is said of the nearest two directions where they are nearer than any that are found: they were given.
fn near_directions(angles: &[f64], separation: f64) -> Option<String> {
    let pairs = angles.iter().enumerate().flat_map(|(n, &one)| angles[n + 1..].iter().map(move |&other| [one, other]));
    let (least, pair) =
        pairs.map(|[one, other]| (angle_between(one, other), [one, other])).min_by(|a, b| a.0.total_cmp(&b.0))?;
    let degrees = |angle: f64| (angle.to_degrees() * PARTS).round() / PARTS;
    let (least, [one, other]) = (degrees(least), pair.map(degrees));
    (least < separation).then(|| {
        format!(
            "the directions {one} and {other} deg that were given are {least} deg apart: \
             directions.separation_deg = {separation} makes one of two that are found so near, but both are kept"
        )
    })
}

/// Angles that are given are told and compared to so many parts of a degree.
const PARTS: f64 = 1e4;
/// Fewer edge pixels than this are no structure.
const FEW_EDGE_PIXELS: usize = 100;
/// Larger pixels, and smaller maps, are rather a slip in the resolution than a site, metres.
const LARGEST_PIXEL: f64 = 1.0;
const SMALLEST_MAP: f64 = 1.0;
/// Less of the structure lined up than this is no ground plan.
const LITTLE_EXPLAINED: f64 = 0.12;
/// Two directions hold at least this much of what lines up, or it is not one ground plan.
const PAIR_SHARE: f64 = 0.75;

fn find_warnings(survey: &Survey, frame: &Frame, edges: usize, parameters: &Parameters) -> Vec<Warning> {
    let Survey { directions, lines, labels, .. } = survey;
    let mut warnings = Vec::new();
    let mut warn = |code, message| warnings.push(Warning { code, message });
    let (pixel, longest) = (frame.resolution, frame.width.max(frame.height) as f64 * frame.resolution);
    if pixel > LARGEST_PIXEL {
        warn("odd-scale", format!("a pixel is {pixel} m wide: is the resolution in metres per pixel?"));
    } else if longest < SMALLEST_MAP {
        let millimetres = (1000.0 * longest).ceil();
        warn("odd-scale", format!("the whole map is {millimetres} mm long: is the resolution in metres per pixel?"));
    }
    if edges < FEW_EDGE_PIXELS {
        let count = match edges {
            0 => "no edge pixels".to_owned(),
            1 => "only 1 edge pixel".to_owned(),
            _ => format!("only {edges} edge pixels"),
        };
        warn("few-edges", format!("the map has {count}: nothing much can be said of it"));
    }
    if directions.angles.is_empty() {
        warn("no-structure", "no direction stands out: the map has no straight structure".to_owned());
    } else if directions.explained < LITTLE_EXPLAINED {
        let percent = (100.0 * directions.explained).round();
        let share = if percent < 1.0 { "less than 1".to_owned() } else { format!("only {percent}") };
        warn("little-structure", format!("{share} percent of the structure lines up along the directions found"));
    }
    let pair: f64 = directions.weights.iter().take(2).sum();
    let all: f64 = directions.weights.iter().sum();
    if pair < PAIR_SHARE * all {
        let (count, percent) = (directions.weights.len(), (100.0 * pair / all).round());
        warn(
            "scattered-structure",
            format!(
                "the structure is scattered over {count} directions, and the strongest two hold only {percent} percent"
            ),
        );
    }
    if let Some(count) = parameters.directions_count
        && directions.angles.len() < count
    {
        warn("few-directions", format!("{count} directions were asked for and {} found", directions.angles.len()));
    }
    if let Some(message) = near_directions(&directions.angles, parameters.directions_separation_deg) {
        warn("near-directions", message);
    }
    if !directions.angles.is_empty() && lines.is_empty() {
        warn("no-lines", "no line stands out of the radiograms".to_owned());
    }
    let is_way = |label: &Label| matches!(label, Label::Corridor { .. } | Label::Junction { .. });
    if !lines.is_empty() && !labels.iter().any(is_way) {
        let (least, most, aspect) =
            (parameters.labels_min_width, parameters.labels_max_width, parameters.labels_min_aspect);
        let regions = labels.iter().filter(|label| matches!(label, Label::Region { .. })).count();
        warn(
            "no-labels",
            format!(
                "no corridor and no junction was found (regions: {regions}); a corridor has walls on both sides, is \
                 labels.min_width = {least} to labels.max_width = {most} m wide and labels.min_aspect = {aspect} times \
                 as long"
            ),
        );
    }
    warnings.extend(undecided(labels, &survey.confidence));
    warnings
}
