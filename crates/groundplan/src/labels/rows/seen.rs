//! A row between two corridors, and what is asked of it where something may lead through.

use super::sections::Columns;
use crate::ends::{holds, overlap, sorted, wider};
use crate::labels::beside::Beside;
use crate::labels::corridors::{Strip, UNTOLD};
use crate::labels::rows::{DEPTH, Row};
use crate::labels::view::turned::Turned;
use crate::labels::ways::walled;
use crate::sets::Sets;
use std::collections::BTreeMap;

/// A row goes on up to a wall that is so near to its end, metres.
const NEAR: f64 = 0.3;
/// What stands so near to a corridor's side, metres, or so far behind it as racks at walls are deep, over so much of a place
/// bounds that.
const BESIDE: f64 = 0.3;
const OUTWARDS: f64 = 2.0;
const BOUNDED: f64 = 0.8;

/// A row and what stands in it.
pub struct Seen<'a> {
    /// With what lies between its ends and the walls beyond them.
    pub row: &'a Row,
    /// Where it begins and ends, along.
    pub own: [f64; 2],
    pub columns: Columns<'a>,
    /// What leads through it between uprights, from where to where along.
    pub ways: Vec<[f64; 2]>,
    /// Of the direction that it runs along, and of the one that crosses it.
    pub views: [&'a Turned; 2],
    /// The two corridors beside it, and the places across of their middles.
    pub between: [usize; 2],
    pub middles: [f64; 2],
    /// How wide the wider of the two is, metres.
    pub widest: f64,
}

/// Rows between so many aisles, place by place: they are of one where aisles lie between them.
pub fn by_place<'a, 'b>(seen: &'a [Seen<'b>], aisles: usize) -> Vec<Vec<&'a Seen<'b>>> {
    let mut places = Sets::new(aisles);
    for row in seen {
        let [one, other] = row.between.map(|aisle| aisle as u32);
        places.join_first(one, other);
    }
    let mut rows: BTreeMap<_, Vec<&Seen>> = BTreeMap::new();
    for row in seen {
        rows.entry((row.row.direction, places.of(row.between[0] as u32))).or_default().push(row);
    }
    rows.into_values().collect()
}

impl Seen<'_> {
    fn middle(&self) -> f64 {
        f64::midpoint(self.row.across[0], self.row.across[1])
    }

    /// Where nothing stands in it, across the direction that crosses it.
    pub fn open(&self) -> Vec<[f64; 2]> {
        self.columns.open().into_iter().map(|ends| self.across(ends)).collect()
    }

    /// The place along it where something crosses it.
    fn along(&self, across: f64) -> f64 {
        let [view, other] = self.views;
        view.crossing(other, self.middle(), across)[1]
    }

    /// From where to where along it something crosses it.
    pub fn stretch(&self, across: [f64; 2]) -> [f64; 2] {
        sorted(across.map(|end| self.along(end)))
    }

    /// Between which two of its uprights something crosses it, across the direction that crosses it.
    pub fn gap_about(&self, across: f64) -> Option<[f64; 2]> {
        self.columns.gap_about(self.along(across)).map(|ends| self.across(ends))
    }

    /// The way through it in which a place lies, across the direction that crosses it.
    pub fn way_about(&self, across: f64) -> Option<[f64; 2]> {
        let along = self.along(across);
        self.ways.iter().find(|way| holds(**way, along)).map(|way| self.across(*way))
    }

    /// What lies so along it, across the direction that crosses it.
    fn across(&self, ends: [f64; 2]) -> [f64; 2] {
        let [view, other] = self.views;
        sorted(ends.map(|u| other.place(view.to_map([u, self.middle()]))[1]))
    }

    /// True when a stretch is as wide as a bay, or as some beside one another.
    pub fn is_as_bays(&self, ends: [f64; 2]) -> bool {
        self.columns.is_as_bays(self.stretch(ends))
    }

    /// True when what lies there across the crossing direction crosses it.
    pub fn holds(&self, across: f64) -> bool {
        holds(self.row.along, self.along(across))
    }

    /// True when a wall ends the row and the corridors beside it, but for what leads on through a gate.
    pub fn is_at_wall(&self, strips: &[Strip], side: usize) -> bool {
        let (view, end) = (self.views[0], self.row.along[side]);
        let beyond = if side == 0 { [end - NEAR, end] } else { [end, end + NEAR] };
        walled::ends(view, strips, self.row, self.between, view.columns(beyond)).any()
    }

    /// The corridors that run along it no further off than a row is deep, and lead as near to a stretch as that is long.
    pub fn corridors_beside(&self, strips: &[Strip], placed: &[Beside], stretch: [f64; 2]) -> Vec<usize> {
        let [below, above] = self.between;
        let beside = wider([strips[below].across[0], strips[above].across[1]], DEPTH.1);
        let near = wider(stretch, stretch[1] - stretch[0]);
        let mut found = placed[self.row.direction].touching(near, beside);
        found.retain(|&n| overlap(strips[n].along, near) > 0.0 && overlap(strips[n].across, beside) > 0.0);
        found
    }

    /// True when one of the two corridors leads to a place beyond the row, or a wall goes on along its far side: else that
    /// is open floor.
    pub fn is_bounded(&self, strips: &[Strip], ends: [f64; 2]) -> bool {
        let (view, middle) = (self.views[0], f64::midpoint(ends[0], ends[1]));
        let columns = view.column(ends[0])..view.column(ends[1]);
        let is_held = |low: f64, high: f64| {
            let held = view.blocked_where(columns.clone(), low, high, |share| share > 0.0);
            held.count(0..columns.len()) as f64 >= BOUNDED * columns.len() as f64
        };
        let leads = |n: usize| holds(strips[n].along, middle);
        let [below, above] = self.between;
        let [low, high] = [strips[below].across[0], strips[above].across[1]];
        [below, above].into_iter().any(leads)
            || is_held(low - OUTWARDS, low + BESIDE)
            || is_held(high - BESIDE, high + OUTWARDS)
    }

    /// A way through it, from where to where along, that lies between its own ends.
    pub fn gate(&self, ends: [f64; 2]) -> Option<Strip> {
        let is_within = self.own[0] < ends[0] && ends[1] < self.own[1];
        is_within.then(|| self.way(ends))
    }

    /// A way through it, from where to where along, from the middle of one corridor to that of the other.
    pub fn way(&self, ends: [f64; 2]) -> Strip {
        way(self.views, self.row, self.middles, ends)
    }
}

/// A way through a row, from where to where along, as a strip of the direction that crosses it, from one place across to
/// another.
pub fn way([view, other]: [&Turned; 2], row: &Row, middles: [f64; 2], [from, to]: [f64; 2]) -> Strip {
    let sin = libm::sin(other.angle - view.angle);
    let v = f64::midpoint(row.across[0], row.across[1]);
    let [s, t] = other.place(view.to_map([f64::midpoint(from, to), v]));
    let width = (to - from) * sin.abs();
    let ends = middles.map(|middle| s + (middle - v) / sin);
    Strip {
        direction: other.direction,
        along: sorted(ends),
        across: [t - width / 2.0, t + width / 2.0],
        score: row.depth(),
        bays: false,
        is_ragged: false,
        stops: [false; 2],
        held: UNTOLD,
        found: UNTOLD,
    }
}
