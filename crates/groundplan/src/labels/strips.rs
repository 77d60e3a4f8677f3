//! II-E, the successor of Algorithm 1: labels from a sketch and the faces that lie in what it shows.

use super::corridors::Strip;
use super::junctions::meeting::Meeting;
use super::names::{Named, names};
use super::near::Near;
use super::outline;
use super::places::{Placed, Squares};
use super::posts::bays;
use super::posts::period::Period;
use super::posts::pillars;
use super::rooms::{self, Racked, Raster};
use super::rows::{Row, whole};
use super::sketch::{Plan, Sketch};
use super::view::turned::Turned;
use super::{Division, Evidence, JunctionKind, Label};
use crate::bands::side_by_side;
use crate::ends::{sorted, wider};
use crate::grid::{State, tidy};
use std::collections::BTreeSet;

/// So far round a rack there are no doors, metres.
const RIM: f64 = 0.4;
/// So far within a corridor's sides there may be some, metres.
const SIDE: f64 = 0.15;

/// The labels that a sketch shows, with the faces that lie in them: the division is waited for when all else is known of
/// them. And what is asked of some as soon as they are known: of corridors, junctions and racks together, of regions and
/// doors, and of pillars.
pub fn find<'d, A: Send>(
    evidence: &Evidence,
    division: impl Fn() -> Division<'d> + Sync,
    sketch: Sketch,
    ask: impl Fn(&[Label]) -> Vec<A> + Sync,
) -> (Vec<Label>, Vec<A>) {
    let Sketch { mut views, plan, free } = sketch;
    let Plan { strips, meetings, ends, extents, rows: between, racks: rows } = plan;

    let junctions: Vec<Label> = meetings
        .iter()
        .map(|meeting| (meeting.kind, square(&views, &strips, meeting), meeting.at, meeting.corridors.clone()))
        .chain(ends.iter().map(|&(n, side, place)| {
            let (strip, view) = (&strips[n], &views[strips[n].direction]);
            let inwards = if side == 0 { strip.width() } else { -strip.width() };
            let along = sorted([place, place + inwards]);
            let at = view.to_map([place, strip.middle()]);
            (JunctionKind::End, rectangle(view, along, strip.across), at, vec![n])
        }))
        .map(|(kind, polygon, at, corridors)| Label::Junction {
            kind,
            faces: Vec::new(),
            polygon,
            at: at.map(tidy),
            corridors: corridors.into_iter().map(|c| c as u32).collect(),
        })
        .collect();
    let main = main_of(&views, &strips);
    let squares = Squares::new(main, evidence);
    let named = strips.iter().zip(&extents).map(|(strip, along)| Named {
        angle: views[strip.direction].angle,
        is_main: main.is_some_and(|main| main.direction == strip.direction),
        middle: views[strip.direction].to_map([f64::midpoint(along[0], along[1]), strip.middle()]),
        length: along[1] - along[0],
    });
    let names = names(&squares, &named.collect::<Vec<_>>());
    let mut ways: Vec<Label> = strips
        .iter()
        .zip(&extents)
        .zip(names)
        .map(|((strip, along), name)| {
            let view = &views[strip.direction];
            let polygon = rectangle(view, *along, strip.across);
            let axis = along.map(|u| view.to_map([u, strip.middle()]).map(tidy));
            Label::Corridor { faces: Vec::new(), polygon, axis, width: tidy(strip.width()), name }
        })
        .collect();
    let racked = racked(&views, &strips, &extents, &meetings, [&rows, &between]);
    ways.extend(junctions);
    // Of the views their places are asked from here on, and the regions need the room.
    views.iter_mut().for_each(Turned::let_go);
    let corridors = rooms::Corridor::among(&ways);
    let first = ways.len() + rows.len();
    let asked = |labels: Vec<Label>| {
        let answers = ask(&labels);
        (labels, answers)
    };
    let with_racks = || {
        let division = division();
        take_faces(&division, &mut ways);
        ways.extend(rack_labels(evidence, &division, &views, &rows, &squares));
        asked(ways)
    };
    let Some((space, bars)) = free else { return with_racks() };
    let rack = |row: &Row| {
        let [along, across] = [row.along, row.across].map(|ends| wider(ends, pillars::RIM));
        rectangle(&views[row.direction], along, across)
    };
    let grounds: Vec<_> = rows.iter().map(rack).collect();
    let [ways, rooms, pillars] = side_by_side(evidence.threads, |side| {
        let others = side.start(|| [with_racks(), asked(pillar_labels(evidence, &space.raster, &grounds, &squares))]);
        let rooms = asked(rooms::find(evidence, &division, &space, bars, first, &racked, &corridors, &squares));
        let [ways, pillars] = others.get();
        [ways, rooms, pillars]
    });
    let (mut labels, mut answers) = ways;
    for (more, their_answers) in [rooms, pillars] {
        labels.extend(more);
        answers.extend(their_answers);
    }
    (labels, answers)
}

/// Takes the free faces that lie in corridors and junctions: a face is of one junction at most, and of one corridor.
fn take_faces(division: &Division, ways: &mut [Label]) {
    let mut left = Faces::new(division, |state| state == State::Free);
    let all = left.left.clone();
    for way in &mut *ways {
        if let Label::Corridor { faces, polygon, .. } = way {
            *faces = left.take(polygon);
        }
    }
    left.left = all;
    for way in ways {
        if let Label::Junction { faces, polygon, .. } = way {
            *faces = left.take(polygon);
        }
    }
}

/// The racks' own ground, and, with a rim round it, the corridors along racks and those that cross them.
fn racked(
    views: &[Turned],
    strips: &[Strip],
    extents: &[[f64; 2]],
    meetings: &[Meeting],
    [rows, between]: [&[Row]; 2],
) -> Racked {
    if rows.is_empty() {
        return Racked::default();
    }
    let mut along: Vec<usize> = rows.iter().filter_map(|row| row.between).flatten().collect();
    along.sort_unstable();
    along.dedup();
    let aisles = along.clone();
    for meeting in meetings.iter().filter(|meeting| meeting.corridors.iter().any(|c| aisles.contains(c))) {
        along.extend(&meeting.corridors);
    }
    along.sort_unstable();
    along.dedup();
    let corridors = along.into_iter().map(|n| {
        let strip = &strips[n];
        // A wall that is thin has its line, and doors have theirs, where the corridor ends.
        rectangle(&views[strip.direction], extents[n], wider(strip.across, -SIDE.min(strip.width() / 4.0)))
    });
    let around = |row: &Row| rectangle(&views[row.direction], wider(row.along, RIM), wider(row.across, RIM));
    // What a rack leaves of the row between two corridors leads from one to the other, and is a way too.
    let left = |racks: &[&Row]| {
        let racks: BTreeSet<_> = racks.iter().filter_map(|rack| rack.between).collect();
        let left = between.iter().filter(move |row| row.between.is_some_and(|pair| racks.contains(&pair)));
        // At its ends it may lead to a wall with a door.
        left.map(|row| rectangle(&views[row.direction], row.along, wider(row.across, RIM))).collect::<Vec<_>>()
    };
    let all: Vec<&Row> = rows.iter().collect();
    let kin = whole::have_kin(views, &all, &all);
    let with_kin: Vec<&Row> = all.iter().zip(kin).filter(|(_, has_kin)| *has_kin).map(|(row, _)| *row).collect();
    Racked {
        ways: corridors.collect(),
        rows: rows.iter().map(around).chain(left(&all)).collect(),
        left: left(&with_kin),
        racks: with_kin.into_iter().map(around).collect(),
        grounds: rows.iter().map(|row| rectangle(&views[row.direction], row.along, row.across)).collect(),
    }
}

/// The direction that has most corridor, or where there is none, most structure.
fn main_of<'a>(views: &'a [Turned], strips: &[Strip]) -> Option<&'a Turned> {
    let length =
        |view: &Turned| strips.iter().filter(|s| s.direction == view.direction).map(Strip::length).sum::<f64>();
    views.iter().rev().max_by(|a, b| length(a).total_cmp(&length(b)))
}

fn pillar_labels(evidence: &Evidence, raster: &Raster, grounds: &[Vec<[f64; 2]>], squares: &Squares) -> Vec<Label> {
    let pillars = pillars::find(evidence, raster, grounds);
    let items: Vec<_> = pillars
        .iter()
        .map(|pillar| Placed { place: squares.place(pillar.at), weight: pillar.width, size: 0.0 })
        .collect();
    let names = squares.names("P", &items);
    let label = |(pillar, name): (&pillars::Pillar, String)| Label::Pillar {
        at: pillar.at.map(tidy),
        width: tidy(pillar.width),
        pattern: pillar.pattern,
        name,
    };
    pillars.iter().zip(names).map(label).collect()
}

fn rack_labels(
    evidence: &Evidence,
    division: &Division,
    views: &[Turned],
    rows: &[Row],
    squares: &Squares,
) -> Vec<Label> {
    if rows.is_empty() {
        return Vec::new();
    }
    let mut faces = Faces::new(division, |_| true);
    let middle = |row: &Row| {
        let place = [row.along, row.across].map(|ends| f64::midpoint(ends[0], ends[1]));
        squares.place(views[row.direction].to_map(place))
    };
    let placed = |row: &Row| Placed { place: middle(row), weight: row.length(), size: 0.0 };
    let items: Vec<_> = rows.iter().map(placed).collect();
    let names = squares.names("S", &items);
    let periods = bays::find(evidence, views, rows);
    rows.iter()
        .zip(periods)
        .zip(names)
        .map(|((row, period), name)| {
            let phase = |period: Period| (period.phase - row.along[0]).rem_euclid(period.pitch);
            let view = &views[row.direction];
            let polygon = rectangle(view, row.along, row.across);
            let middle = f64::midpoint(row.across[0], row.across[1]);
            Label::Rack {
                faces: faces.take(&polygon),
                polygon,
                axis: row.along.map(|u| view.to_map([u, middle]).map(tidy)),
                width: tidy(row.across[1] - row.across[0]),
                pitch: period.map(|period| tidy(period.pitch)),
                phase: period.map(|period| tidy(phase(period))),
                name,
            }
        })
        .collect()
}

/// The piece that two corridors share, counter-clockwise.
fn square(views: &[Turned], strips: &[Strip], meeting: &Meeting) -> Vec<[f64; 2]> {
    let [one, two] = [0, 1].map(|n| &strips[meeting.corridors[n]]);
    let heading = |strip: &Strip| {
        let angle = views[strip.direction].angle;
        [libm::cos(angle), libm::sin(angle)]
    };
    let (p, q) = (heading(one), heading(two));
    let [a, b] = meeting.reach;
    let mut corners: Vec<[f64; 2]> = [[-a, -b], [a, -b], [a, b], [-a, b]]
        .iter()
        .map(|[s, t]| [0, 1].map(|n| tidy(meeting.at[n] + s * p[n] + t * q[n])))
        .collect();
    if p[0] * q[1] - p[1] * q[0] < 0.0 {
        corners.reverse();
    }
    corners
}

/// A rectangle in a direction's own places, as a polygon in the map frame.
fn rectangle(view: &Turned, along: [f64; 2], across: [f64; 2]) -> Vec<[f64; 2]> {
    view.rectangle(along, across).into_iter().map(|corner| corner.map(tidy)).collect()
}

/// Faces that no label of a kind has yet.
struct Faces<'a> {
    centres: &'a [[f64; 2]],
    near: Near,
    left: Vec<bool>,
}

impl<'a> Faces<'a> {
    fn new(division: &Division<'a>, of: impl Fn(State) -> bool) -> Self {
        let centres = &division.subdivision.centres;
        let left: Vec<bool> = division.occupancy.states.iter().map(|state| of(*state)).collect();
        let points = (0u32..).zip(centres).filter(|(face, _)| left[*face as usize]).map(|(face, at)| (face, *at));
        let near = Near::points(points);
        Self { centres, near, left }
    }

    /// Takes the faces whose centres lie in a convex polygon.
    fn take(&mut self, polygon: &[[f64; 2]]) -> Vec<u32> {
        let mut inside = self.near.within(polygon);
        inside.retain(|&face| self.left[face as usize] && outline::holds(polygon, self.centres[face as usize]));
        inside.sort_unstable();
        // More were near.
        inside.shrink_to_fit();
        for &face in &inside {
            self.left[face as usize] = false;
        }
        inside
    }
}
