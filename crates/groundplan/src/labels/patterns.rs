//! Regular patterns among the labels: what recurs, at which pitch, and from where.

use super::Label;
use super::posts::pillars;
use crate::directions::Directions;
use crate::grid::tidy;

/// What recurs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatternKind {
    /// The bays of one row of racks.
    Bays,
    /// A row or a grid of pillars.
    Pillars,
}

impl PatternKind {
    /// Its name in the survey.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bays => "bays",
            Self::Pillars => "pillars",
        }
    }
}

/// Places at `phase` + n `pitch`, metres, along an angle and square to it in the map frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    /// What recurs.
    pub kind: PatternKind,
    /// Ids of the labels that make it.
    pub labels: Vec<u32>,
    /// Radians in the map frame.
    pub angle: f64,
    /// Along the angle and square to it; nothing where nothing recurs.
    pub pitch: [Option<f64>; 2],
    /// Of x cos + y sin and of y cos - x sin, in [0, pitch).
    pub phase: [Option<f64>; 2],
}

/// The patterns that the labels make: pillars in the order of their numbers, then rows of bays in that of the racks.
#[must_use]
pub fn find_patterns(directions: &Directions, labels: &[Label]) -> Vec<Pattern> {
    let mut found: Vec<Pattern> = Vec::new();
    let mut groups: Vec<(Vec<u32>, Vec<[f64; 2]>)> = Vec::new();
    for (id, label) in labels.iter().enumerate() {
        if let Label::Pillar { at, pattern, .. } = label {
            let number = *pattern as usize;
            if groups.len() <= number {
                groups.resize(number.min(labels.len()) + 1, (Vec::new(), Vec::new()));
            }
            if let Some((ids, places)) = groups.get_mut(number) {
                ids.push(id as u32);
                places.push(*at);
            }
        }
    }
    let angles = pillars::angles(&directions.angles);
    for (ids, places) in groups {
        // Each number has its pattern, so that a pillar's number is its pattern's place.
        let lattice = pillars::lattice(&places, &angles);
        let periods = lattice.map_or([None; 2], |lattice| lattice.periods);
        found.push(Pattern {
            kind: PatternKind::Pillars,
            labels: ids,
            angle: tidy(lattice.map_or(0.0, |lattice| lattice.angle)),
            pitch: periods.map(|period| period.map(|period| tidy(period.pitch))),
            phase: periods.map(|period| period.map(|period| tidy(period.phase))),
        });
    }
    for (id, label) in labels.iter().enumerate() {
        if let Label::Rack { axis: [from, to], pitch: Some(pitch), phase: Some(phase), .. } = label {
            let angle = libm::atan2(to[1] - from[1], to[0] - from[0]);
            let start = from[0] * libm::cos(angle) + from[1] * libm::sin(angle) + phase;
            found.push(Pattern {
                kind: PatternKind::Bays,
                labels: vec![id as u32],
                angle: tidy(angle),
                pitch: [Some(*pitch), None],
                phase: [Some(tidy(start - (start / pitch).floor() * pitch)), None],
            });
        }
    }
    found
}
