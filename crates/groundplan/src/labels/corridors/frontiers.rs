//! Ways of which little more was seen than where they open into others. They end at a frontier, between what was seen and what was
//! not (Yamauchi 1997), before they are long enough for a way: past the ends of two rows, or through a row in line with a way, a
//! robot saw as far as its sensor reaches, and went on. Or they go on along a row of which too little was seen to show them for ways.
//! And ways before a wall, or on along one, into which such ways may open.

use super::along_walls;
use super::before_walls;
use super::openings::{self, Bays, Opening};
use super::ragged;
use crate::ends::{around, both, holds, shared, sorted, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::{Strip, UNTOLD};
use crate::labels::junctions::shut;
use crate::labels::rows::{DEPTH, Row};
use crate::labels::view::turned::Turned;
use crate::parameters::Parameters;

/// One side is held over so much of what was seen, and so many metres; the other over so many, as by the end of a row.
const HELD: f64 = 0.6;
const HELD_METRES: [f64; 2] = [0.5, 2.0];
/// Along rows, and across them in line with a known way, as ways lead on, the ends of two rows are enough, over so many metres of
/// each of which something stands: walls beside a gate are not so deep.
pub const ROW: f64 = 0.8;
/// What goes on farther than it is looked into does so along a row of which so much is not free; and the end of one of which so much
/// is not holds a side of which no more was seen.
const ALONG: f64 = 0.35;
const FILLED: f64 = 0.7;
/// What is in line with another has its sides no farther than this from that one's, metres.
pub const IN_LINE: f64 = 0.5;

/// The ways with those that end at frontiers or lead before walls and are as wide as others, and with what they lead on along walls;
/// none where there is no such.
pub fn with(views: &[Turned], strips: &[Strip], rows: &[Row], parameters: &Parameters) -> Option<Vec<Strip>> {
    let bays = Bays::new(views, rows);
    let openings = |passing: &Strip| openings::of(views, passing, &bays, parameters);
    let mut known =
        Known { views, strips, rows, ways: strips.to_vec(), placed: placed(views, strips.iter().map(Strip::place)) };
    for strip in strips {
        let mut rest = vec![strip.clone()];
        while let Some(passing) = rest.pop() {
            let found = openings(&passing);
            rest.extend(known.add_before_walls(&passing, &found));
            known.add_at_frontiers(&passing, found);
        }
    }
    // When all are known, with what they were led on to: ways lead on where others open into that.
    for on in along_walls::find(views, &known.ways, &known.placed, rows) {
        // What is open for long there is floor.
        let ending = openings(&on.floor).into_iter().filter(|opening| opening.is_frontier).collect();
        let is_opened_into = known.add_at_frontiers(&on.floor, ending);
        if is_opened_into || along_walls::is_led_to(views, &on, &known.ways, &known.placed) {
            known.lead_on(on.way, on.along);
        }
    }
    (known.ways != strips).then_some(known.ways)
}

/// What ways are known, and of all where they lie; and which there were before.
struct Known<'a> {
    views: &'a [Turned],
    strips: &'a [Strip],
    rows: &'a [Row],
    ways: Vec<Strip>,
    placed: Vec<Beside>,
}

impl Known<'_> {
    fn add(&mut self, way: Strip) {
        self.placed[way.direction].add(self.ways.len(), way.along, way.across);
        self.ways.push(way);
    }

    fn lead_on(&mut self, n: usize, along: [f64; 2]) {
        let way = &mut self.ways[n];
        let long = both(way.along, along);
        for side in (0..2).filter(|&side| long[side] != way.along[side]) {
            (way.stops[side], way.held[side]) = (false, UNTOLD[side]);
        }
        way.along = long;
        self.placed[way.direction].add(n, way.along, way.across);
    }

    /// Those known that lie beside a way, or over it.
    fn beside(&self, way: &Strip) -> Vec<usize> {
        let near = self.placed[way.direction].touching(way.along, way.across).into_iter();
        near.filter(|&n| ragged::is_beside(&self.ways[n], way)).collect()
    }

    /// True when one that was known before is as wide.
    fn is_alike(&self, way: &Strip) -> bool {
        self.strips.iter().any(|one| one.direction == way.direction && one.is_as_wide(way))
    }

    /// Adds what leads before the wall at an end of a way, of what opens into that one, and gives it.
    fn add_before_walls(&mut self, passing: &Strip, found: &[Opening]) -> Vec<Strip> {
        let mut added =
            before_walls::find(self.views, passing, found.iter().filter(|opening| is_held(opening, [false; 2])));
        added.retain(|way| {
            let is_new = self.is_alike(way) && self.beside(way).is_empty();
            if is_new {
                self.add(way.clone());
            }
            is_new
        });
        added
    }

    /// Adds what of what opens into a way ends at a frontier, or goes on along rows; true where there is such.
    fn add_at_frontiers(&mut self, passing: &Strip, mut found: Vec<Opening>) -> bool {
        found.retain(|opening| self.is_way(opening, passing));
        let mut is_any = false;
        for Opening { mut way, middle, goes_on, .. } in found {
            way.along = both(way.along, [middle; 2]);
            let reaching = Strip { along: wider(way.along, passing.width() / 2.0), ..way.clone() };
            match self.beside(&reaching)[..] {
                [] => self.add(way),
                // Another one ends there, in line; where what opens goes on, where that ends is told better by its own sides.
                [n] if self.ways[n].is_in_line(&way, IN_LINE) => {
                    self.lead_on(n, if goes_on { [middle; 2] } else { way.along });
                }
                _ => continue,
            }
            is_any = true;
        }
        is_any
    }

    /// True when what opens into a way is as wide as others, ends at a frontier or goes on beside a row, and is held or between two rows.
    fn is_way(&self, opening: &Opening, passing: &Strip) -> bool {
        if !(opening.is_frontier || opening.goes_on) || !self.is_alike(&opening.way) {
            return false;
        }
        let filled = self.rows_beside(opening);
        let is_along_rows = || self.rows.iter().any(|row| row.direction == opening.way.direction);
        let leads = || {
            is_between_rows(opening)
                && (is_along_rows() || self.is_led_to(&opening.way))
                && !self.is_through_another(&opening.way, passing)
        };
        (opening.is_frontier || filled.into_iter().any(|share| share >= ALONG))
            && (is_held(opening, filled.map(|share| share >= FILLED)) || leads())
    }

    /// How much of the rows is not free that end beside what opens, between it and ways along their other sides; on either side the
    /// most, or nothing.
    fn rows_beside(&self, Opening { way, ends_row, .. }: &Opening) -> [f64; 2] {
        let view = &self.views[way.direction];
        let filled = |side: usize, other: &Strip| {
            let along = shared(other.along, way.along);
            let [low, high] = sorted([way.across[side], other.across[1 - side]]);
            let depth = shut::sign(side) * (other.across[1 - side] - way.across[side]);
            let is_row = along[0] < along[1] && (DEPTH.0..=DEPTH.1).contains(&depth);
            if is_row { view.mean_blocked(view.columns(along), low, high) } else { 0.0 }
        };
        [0, 1].map(|side| {
            let beyond = sorted([DEPTH.0, DEPTH.1].map(|depth| way.across[side] + shut::sign(side) * depth));
            let near = if ends_row[side] { self.placed[way.direction].touching(way.along, beyond) } else { Vec::new() };
            near.into_iter().map(|n| filled(side, &self.ways[n])).fold(0.0, f64::max)
        })
    }

    /// True when a way leads to another in line with it: nothing stands across between them.
    fn is_led_to(&self, way: &Strip) -> bool {
        let view = &self.views[way.direction];
        let is_open = |one: &Strip| {
            let [to, from] = shared(one.along, way.along);
            from >= to || !(view.column(from)..view.column(to)).any(|n| shut::is_shut_at(view, way, n))
        };
        let in_line = self.placed[way.direction].touching([f64::NEG_INFINITY, f64::INFINITY], way.across).into_iter();
        in_line.map(|n| &self.ways[n]).any(|one| one.is_in_line(way, IN_LINE) && is_open(one))
    }

    /// True when what opens into one way was seen through the next one: into that it opens as well, or not.
    fn is_through_another(&self, way: &Strip, passing: &Strip) -> bool {
        let [view, other] = [way, passing].map(|way| &self.views[way.direction]);
        let corners = view.rectangle(way.along, way.across);
        let [along, across] = [0, 1].map(|axis| around(corners.iter().map(|&corner| other.place(corner)[axis])));
        let near = self.placed[passing.direction].touching(along, across).into_iter().map(|n| &self.ways[n]);
        near.into_iter().any(|next| {
            let [s, u] = view.crossing(other, way.middle(), next.middle());
            holds(way.along, u) && holds(next.along, s)
        })
    }
}

/// True when what opens lies between two sides of which one may be no more than the end of a row, be it that such is known there.
fn is_held(opening: &Opening, are_ends: [bool; 2]) -> bool {
    let is_long = |side: usize| opening.held[side] >= HELD_METRES[1].max(HELD * opening.way.length());
    let is_end = |side: usize| opening.held[side] >= HELD_METRES[0] || are_ends[side];
    is_long(0) && is_end(1) || is_end(0) && is_long(1)
}

/// True when it lies between the ends of two rows.
fn is_between_rows(opening: &Opening) -> bool {
    opening.stands.into_iter().all(|metres| metres >= ROW)
}
