//! Bends: a passage ends where its walls turn, and leads on along another direction to a way that runs askew to it; the walls
//! from there on are too short to be lines. Before the bend it may be too short for a way by itself.

use super::barriers;
use super::known::{Known, Led};
use super::openings::{self, Bays, Opening};
use super::stretches;
use crate::ends::{around, holds, sorted, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::{self, ASKEW, Strip};
use crate::labels::junctions;
use crate::labels::junctions::meeting::{LEAST_SINE, Meeting, of_each};
use crate::labels::junctions::shut::{inner, sign};
use crate::labels::rows::Row;
use crate::labels::view::turned::Turned;
use crate::parameters::Parameters;
use std::ops::Range;

/// It turns no farther from where the sides of the known way end than so many of its widths, and is tried in steps of so
/// much, metres.
const NEAR: f64 = 1.5;
const STEP: f64 = 0.1;
/// Beyond the bend walls run along both its sides for so long at least and at most, metres.
const LENGTH: [f64; 2] = [1.0, 10.0];
/// It is so many times as wide as the known way, and their middles cross within so much of its own, in widths.
const WIDTHS: [f64; 2] = [0.7, 1.4];
const MIDDLE: f64 = 0.15;
/// No more than this share of it is not free.
const CLUTTER: f64 = 0.05;
/// A side lies where something stands along so much of its length in one row of cells, and along so much of it within this
/// share of the width.
const SIDE: f64 = 0.5;
const WALLED: f64 = 0.85;
const WALL: f64 = 0.1;

/// The ways with those that they lead to round a bend; none where there are no such.
pub fn with(
    views: &[Turned],
    strips: &[Strip],
    meetings: &[Meeting],
    rows: &[Row],
    parameters: &Parameters,
) -> Option<Vec<Strip>> {
    // One that it leads along, one that it turns to and one of the way that it meets.
    if views.len() < 3 {
        return None;
    }
    let bays = Bays::new(views, rows);
    let mut known = Known::new(views, strips);
    let placed = placed(views, strips.iter().map(Strip::place));
    let widest = corridors::widest(strips);
    let bend = |own: &Strip, side: usize| {
        let from = &views[own.direction];
        let legs = views.iter().flat_map(|view| [-1.0, 1.0].map(|to| (view, to)));
        let bends = legs
            .filter_map(|(view, to)| Bend { views, strips, placed: &placed, widest, own, from, side, view, to }.best());
        bends.min_by(|one, two| one.off.total_cmp(&two.off)).map(|found| found.led)
    };
    for (n, met) in of_each(meetings, strips.len()).into_iter().enumerate() {
        let is_met = |side| {
            junctions::is_met(&views[strips[n].direction], &strips[n], n, side, met.iter().map(|&m| &meetings[m]))
        };
        for side in (0..2).filter(|&side| !is_met(side)) {
            if let Some(led) = bend(&strips[n], side) {
                known.add(led);
            }
        }
    }
    for strip in strips {
        // Of what opens into it what lies in no other.
        let is_new = |way: &Strip| {
            let ends = [way.along[0], f64::midpoint(way.along[0], way.along[1]), way.along[1]];
            let points = ends.map(|u| views[way.direction].to_map([u, way.middle()]));
            !views.iter().any(|its| {
                points.map(|point| its.place(point)).iter().any(|&[u, v]| {
                    let mut near = placed[its.direction].touching([u; 2], [v; 2]).into_iter().map(|n| &strips[n]);
                    near.any(|other| other != strip && holds(other.along, u) && holds(other.across, v))
                })
            })
        };
        let is_leg = |opening: &Opening| opening.held.iter().all(|held| *held >= LENGTH[0]) && is_new(&opening.way);
        for Opening { way, middle, .. } in openings::of(views, strip, &bays, parameters).into_iter().filter(is_leg) {
            let side = usize::from(middle < way.along[0]);
            if let Some(led) = bend(&way, side) {
                known.add(led);
                let middles = way.along;
                known.add(Led { way, middles });
            }
        }
    }
    known.with_more()
}

/// What a way may lead to from one of its ends: along another direction, that way or the other.
struct Bend<'a> {
    views: &'a [Turned],
    strips: &'a [Strip],
    placed: &'a [Beside],
    /// Of all strips.
    widest: f64,
    own: &'a Strip,
    from: &'a Turned,
    side: usize,
    view: &'a Turned,
    to: f64,
}

/// A way round a bend, and how far from its middle the known one's leads, in widths.
struct Found {
    led: Led,
    off: f64,
}

impl<'a> Bend<'a> {
    /// The one of which the middle lies best.
    fn best(&self) -> Option<Found> {
        let Self { view, from, .. } = *self;
        let cos = libm::cos(view.angle - from.angle) * self.to * sign(self.side);
        let may_meet = |other: &Turned| other.sine(from) >= LEAST_SINE && other.sine(view) >= ASKEW;
        if view.sine(from) < ASKEW || cos < -ASKEW || !self.views.iter().any(may_meet) {
            return None;
        }
        let tried = (2.0 * NEAR * self.own.width() / STEP) as usize;
        let first = self.own.along[self.side] - NEAR * self.own.width();
        // The inner side begins where it meets the known way's.
        let inner = self.own.width() / 2.0 * libm::tan(libm::acos(cos) / 2.0);
        let found = (0..=tried).filter_map(|n| self.at(first + n as f64 * STEP, inner));
        found.min_by(|one, two| one.off.total_cmp(&two.off))
    }

    /// The one that turns at a place along the known way's middle, with its inner side from so far beyond.
    fn at(&self, turn: f64, inner: f64) -> Option<Found> {
        let Self { view, to, own, .. } = *self;
        let [u, v] = view.place(self.from.to_map([turn, own.middle()]));
        let begins = u + to * inner;
        let core = wider([v; 2], WIDTHS[0] / 4.0 * own.width());
        let is_free = |columns, [low, high]: [f64; 2]| view.mean_blocked(columns, low, high) <= CLUTTER;
        if !is_free(view.columns(sorted([u, begins + to * LENGTH[0]])), core) || !self.leads_to(turn) {
            return None;
        }
        let (ends, middle) = self.ahead([u, v])?;
        if !holds(LENGTH, (ends - begins) * to) || !is_free(view.columns(sorted([u, ends])), core) {
            return None;
        }
        let walled = view.columns(sorted([begins, ends]));
        let across = self.sides(v, walled.clone())?;
        let width = across[1] - across[0];
        let off = (f64::midpoint(across[0], across[1]) - v).abs() / width;
        let is_way = off <= MIDDLE
            && holds(WIDTHS.map(|share| share * own.width()), width)
            && is_free(walled, wider(across, -WALL * width))
            && !barriers::among(view, across, view.columns(sorted([u, ends]))).any()
            // A wall askew to it reaches beyond the near side of the way that it leads to.
            && barriers::stops(view, across, view.columns(sorted([begins, middle]))).is_empty();
        is_way.then(|| {
            let way = stretches::ragged(view, sorted([u, ends]), across, (ends - u).abs());
            Found { led: Led { way, middles: sorted([u, middle]) }, off }
        })
    }

    /// True when nothing stands in the known way from its end to a place along.
    fn leads_to(&self, turn: f64) -> bool {
        let end = self.own.along[self.side];
        let [low, high] = inner(self.own);
        (turn - end) * sign(self.side) <= 0.0
            || self.from.mean_blocked(self.from.columns(sorted([end, turn])), low, high) <= CLUTTER
    }

    /// The near side and the middle, along, of the first way that one from a place leads to, unless that one runs as the
    /// known way does: then what lies between them is of a row.
    fn ahead(&self, [u, v]: [f64; 2]) -> Option<(f64, f64)> {
        let Self { view, to, .. } = *self;
        let met_along = |other: &'a Turned| {
            let sine = other.sine(view);
            let ends = [u, u + to * (LENGTH[1] + self.widest / sine)].map(|u| other.place(view.to_map([u, v])));
            let [along, across] = [0, 1].map(|axis| around(ends.iter().map(|end| end[axis])));
            let near = self.placed[other.direction].touching(along, across).into_iter().map(|n| &self.strips[n]);
            near.filter_map(move |strip| {
                let [there, middle] = view.crossing(other, v, strip.middle());
                let side = middle - to * strip.width() / 2.0 / sine;
                let is_met = strip != self.own && holds(strip.along, there) && (side - u) * to > 0.0;
                is_met.then_some((side, middle, other))
            })
        };
        let met = self.views.iter().filter(|other| other.sine(view) >= ASKEW).flat_map(met_along);
        let (side, middle, other) = met.min_by(|one, two| (one.0 * to).total_cmp(&(two.0 * to)))?;
        (other.sine(self.from) >= LEAST_SINE).then_some((side, middle))
    }

    /// Both sides of a way about a middle, where walls run along both over some columns.
    fn sides(&self, middle: f64, columns: Range<usize>) -> Option<[f64; 2]> {
        let cell = self.view.cell;
        let rows = (WIDTHS[1] * self.own.width() / cell) as usize;
        let is_held = |row: [f64; 2]| self.view.mean_blocked(columns.clone(), row[0], row[1]) >= SIDE;
        let side = |sign: f64| {
            let far = (0..rows)
                .map(|n| n as f64 * cell)
                .find(|far| is_held(sorted([*far, far + cell].map(|far| middle + sign * far))))?;
            Some(middle + sign * far)
        };
        let across = [side(-1.0)?, side(1.0)?];
        let near = WALL * (across[1] - across[0]);
        let is_walled = |side: &f64| {
            let held = self.view.blocked_where(columns.clone(), side - near, side + near, |share| share > 0.0);
            held.count(0..columns.len()) as f64 >= WALLED * columns.len() as f64
        };
        across.iter().all(is_walled).then_some(across)
    }
}
