//! Ways along a wall before the heads of rows: where rows end each at its own place, their last bays are empty or they are few,
//! what lies between them and the wall has no line for its other side, or a wrong one, and yet the aisles between lead there.

use super::known::{Known, Led};
use super::pillared;
use super::stretches;
use crate::bands::flat_map_each;
use crate::ends::{around, holds, sorted};
use crate::grid::Frame;
use crate::labels::Evidence;
use crate::labels::corridors::Strip;
use crate::labels::junctions::shut;
use crate::labels::rows::Row;
use crate::labels::rows::sections::Columns;
use crate::labels::view::look::Look;
use crate::labels::view::turned::Turned;
use crate::labels::ways::across::square_to;
use crate::parameters::Parameters;
use std::collections::{BTreeMap, BTreeSet};

/// An aisle is looked along so far beyond its end for the wall, beside the widest way, metres.
const SHORT: f64 = 6.0;
/// The wall is one where aisles side by side meet it this near to each other, metres.
const IN_LINE: f64 = 0.5;
/// So many rows side by side end before it, at least; of one by itself the wall closes one of its aisles and not the other.
const ROWS: usize = 2;
/// What stands so near to its sides, in widths, does not bar the way.
const SIDES: f64 = 0.2;
/// What is no more than this from the wall is the wall, metres.
const WALL: f64 = 0.3;
/// Where no row ends more than so many pitches before the wall it may be by their last bays, which are empty.
const BAY: f64 = 1.15;
/// The longest row and what fills the shortest one differ by so much, metres: where rows end alike and are full up to
/// there, a line is the way's side, unless the wall is short and an aisle leads on past it.
const APART: f64 = 0.6;
/// A way in which one in so many of these rows ends, and `ROWS` at least, is too wide.
const ENDING: usize = 3;
/// A wall closes a row where so much of what lies along the wall is not free.
const CLOSED: f64 = 0.5;
/// A way is so many times as wide as the aisles that lead to it.
const LEADING: f64 = 0.42;
/// No more than this share of the way is not free.
const CLEAR: f64 = 0.1;

/// The ways with those before the heads of rows that are not known, or are so in part; none where there are no such.
pub fn with(evidence: &Evidence, look: &Look, views: &[Turned], strips: &[Strip], rows: &[Row]) -> Option<Vec<Strip>> {
    let (parameters, frame) = (evidence.parameters, &evidence.grid.frame);
    let mut known = Known::new(views, strips);
    for view in views {
        let Some(other) = square_to(views, view.direction) else { continue };
        for chain in chains(strips, rows, view.direction) {
            for side in [0, 1] {
                let heads = Heads { look, frame, view, other, strips, side, parameters, threads: evidence.threads };
                for Head { led, free } in heads.ways(&chain) {
                    let end_in = |way: &Strip| free.iter().filter(|free| way.width() - **free >= APART).count();
                    let least = free.len().div_ceil(ENDING).max(ROWS);
                    // Pillars that stand in it are no ends of rows.
                    known.narrow(&led.way, |way| end_in(way) >= least && !pillared::stand_in(other, way));
                    known.add(led);
                }
            }
        }
    }
    known.with_more()
}

/// Two aisles and the faces of the row between them.
#[derive(Clone, Copy)]
struct Between {
    aisles: [usize; 2],
    faces: [f64; 2],
}

/// The rows of a direction, of those between the same aisles one; such as follow one another together.
fn chains(strips: &[Strip], rows: &[Row], direction: usize) -> Vec<Vec<Between>> {
    let own = rows.iter().filter(|row| row.direction == direction);
    let pairs: BTreeMap<_, _> = own.filter_map(|row| row.between.map(|aisles| (aisles, row.across))).collect();
    let mut in_order: Vec<Between> = pairs.into_iter().map(|(aisles, faces)| Between { aisles, faces }).collect();
    in_order.sort_by(|a, b| strips[a.aisles[0]].middle().total_cmp(&strips[b.aisles[0]].middle()));
    let mut chains: Vec<Vec<Between>> = Vec::new();
    // Of each aisle the chains that lead up to it.
    let mut up_to: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for row in in_order {
        let chain = up_to.get_mut(&row.aisles[0]).and_then(BTreeSet::pop_first).unwrap_or(chains.len());
        if chain == chains.len() {
            chains.push(Vec::new());
        }
        chains[chain].push(row);
        up_to.entry(row.aisles[1]).or_default().insert(chain);
    }
    chains
}

/// A way before the heads of rows, and how far each of these ends before the wall, metres.
struct Head {
    led: Led,
    free: Vec<f64>,
}

/// One side of the aisles of a direction.
struct Heads<'a> {
    look: &'a Look<'a>,
    frame: &'a Frame,
    view: &'a Turned,
    other: &'a Turned,
    strips: &'a [Strip],
    side: usize,
    parameters: &'a Parameters,
    threads: usize,
}

impl Heads<'_> {
    /// The ways between a wall and the rows of a chain that end before it.
    fn ways(&self, chain: &[Between]) -> Vec<Head> {
        let least = self.parameters.labels_min_width;
        let before = |row: &Between| {
            let wall = self.wall_of(row.aisles)?;
            let [free, empty] = self.free(row, wall);
            (free >= least).then_some([wall, free, empty])
        };
        let ends: Vec<Option<[f64; 3]>> = flat_map_each(chain.len(), self.threads, |n| [before(&chain[n])]);
        let mut found = Vec::new();
        let mut from = 0;
        while from < chain.len() {
            let goes_on = |n: &usize| {
                let wall = |n: usize| ends[n].map(|[wall, ..]| wall);
                wall(*n).zip(wall(from)).is_some_and(|(one, two)| (one - two).abs() <= IN_LINE)
            };
            let to = (from..chain.len()).find(|n| !goes_on(n)).unwrap_or(chain.len());
            if to - from >= ROWS {
                let of = |value: usize| ends[from..to].iter().flatten().map(move |end| end[value]);
                let wall = of(0).sum::<f64>() / (to - from) as f64;
                let free: Vec<f64> = of(1).collect();
                let empty = of(2).fold(0.0, f64::max);
                let [width, most] = around(free.iter().copied());
                // Empty bays have their uprights: where one row has none for longer, it ends there.
                let are_bays = self.view.pitch.is_some_and(|pitch| most <= BAY * pitch);
                if !are_bays && (empty - width >= APART || self.is_opened(&chain[from..to], wall)) {
                    found.extend(self.way(&chain[from..to], wall, width).map(|led| Head { led, free }));
                }
            } else if let Some([wall, width, _]) = ends[from].filter(|&[wall, ..]| {
                let row = &chain[from..=from];
                self.leads_past(&chain[from], wall) || self.steps_out(chain, &ends, from) || self.is_led_out(row, wall)
            }) {
                found.extend(self.way(&chain[from..=from], wall, width).map(|led| Head { led, free: vec![width] }));
            }
            from = to.max(from + 1);
        }
        found
    }

    /// Where the wall before both aisles of a row begins, or before one where the other leads on past it: nothing that was seen
    /// closes that one there.
    fn wall_of(&self, aisles: [usize; 2]) -> Option<f64> {
        let [one, two] = aisles.map(|n| self.wall(n));
        match (one, two) {
            (Some(one), Some(two)) if (one - two).abs() <= IN_LINE => Some(f64::midpoint(one, two)),
            (Some(one), _) if self.leads_on(aisles[1], two, one) => Some(one),
            (_, Some(two)) if self.leads_on(aisles[0], one, two) => Some(two),
            _ => None,
        }
    }

    /// True when an aisle leads on past a wall: what closes it, if anything does, lies beyond.
    fn leads_on(&self, aisle: usize, own: Option<f64>, wall: f64) -> bool {
        own.is_none_or(|own| self.is_past(aisle, own, wall))
    }

    /// True when one of two aisles leads on past a wall that closes the other one and the row between.
    fn leads_past(&self, row: &Between, wall: f64) -> bool {
        let columns = self.view.column(wall - IN_LINE)..self.view.column(wall + IN_LINE);
        let taken = self.view.some_blocked(columns, row.faces[0], row.faces[1]);
        taken.iter().any(|share| *share >= CLOSED)
            && row.aisles.into_iter().any(|n| self.is_past(n, self.strips[n].along[self.side], wall))
    }

    /// True when something leads out through the wall before some rows: one of their aisles, or a way that begins there.
    fn is_opened(&self, rows: &[Between], wall: f64) -> bool {
        let end = |n: usize| self.wall(n).unwrap_or(self.strips[n].along[self.side]);
        let mut aisles = rows.iter().flat_map(|row| row.aisles);
        aisles.any(|n| self.is_past(n, end(n), wall)) || self.is_led_out(rows, wall)
    }

    /// True when a way that is none of their aisles begins at the wall before some rows and leads out.
    fn is_led_out(&self, rows: &[Between], wall: f64) -> bool {
        let [Some(first), Some(last)] = [rows.first(), rows.last()] else { return false };
        let middles = sorted([first.aisles[0], last.aisles[1]].map(|n| self.strips[n].middle()));
        let outwards = |place: f64| (place - wall) * shut::sign(self.side);
        self.strips.iter().any(|strip| {
            strip.direction == self.view.direction
                && holds(middles, strip.middle())
                && outwards(strip.along[1 - self.side]).abs() <= strip.width().max(IN_LINE)
                && outwards(strip.along[self.side]) >= strip.width()
        })
    }

    /// True when the wall before a row lies farther out than that before a row beside it: there the hall has a corner, and the row's
    /// two aisles meet before it.
    fn steps_out(&self, chain: &[Between], ends: &[Option<[f64; 3]>], n: usize) -> bool {
        let wall = |n: usize| ends.get(n).copied().flatten().map(|[wall, ..]| wall);
        let beside = [n.checked_sub(1), Some(n + 1)].into_iter().flatten().filter_map(wall);
        let is_past = |own: f64, other: f64| chain[n].aisles.iter().all(|&aisle| self.is_past(aisle, own, other));
        wall(n).is_some_and(|own| beside.into_iter().any(|other| is_past(own, other)))
    }

    /// True when a place along an aisle is farther outwards than a wall by as much as the aisle is wide.
    fn is_past(&self, aisle: usize, place: f64, wall: f64) -> bool {
        (place - wall) * shut::sign(self.side) >= self.strips[aisle].width()
    }

    /// Where what closes an aisle beyond its end begins.
    fn wall(&self, aisle: usize) -> Option<f64> {
        shut::closed(self.view, &self.strips[aisle], self.side, SHORT + self.parameters.labels_max_width)
    }

    /// How far a row ends before a wall, metres, and what fills it does; as far as is looked where nothing of it stands.
    fn free(&self, row: &Between, wall: f64) -> [f64; 2] {
        let most = SHORT + self.parameters.labels_max_width;
        let away = if self.side == 0 { 1.0 } else { -1.0 };
        let ends = [wall + away * WALL, wall + away * most];
        let before = Row { direction: self.view.direction, along: sorted(ends), across: row.faces, between: None };
        let columns =
            Columns::new(self.look, self.frame, [self.view, self.other], &before, self.view.pitch_of(&before));
        columns.first(self.side == 0).map(|off| off.map_or(most, |off| WALL + off))
    }

    /// The way past some rows, if it is free.
    fn way(&self, rows: &[Between], wall: f64, width: f64) -> Option<Led> {
        let aisles = rows.iter().flat_map(|row| row.aisles).map(|n| self.strips[n].width()).fold(0.0, f64::max);
        if !(LEADING * aisles..=self.parameters.labels_max_width).contains(&width) {
            return None;
        }
        let (first, last) = (&self.strips[rows.first()?.aisles[0]], &self.strips[rows.last()?.aisles[1]]);
        let inner = if self.side == 0 { wall + width } else { wall - width };
        let corners = [[wall, first.across[0]], [inner, last.across[1]]];
        let [one, two] = corners.map(|place| self.other.place(self.view.to_map(place)));
        let [along, across] = [0, 1].map(|axis| sorted([one[axis], two[axis]]));
        let place = |aisle: &Strip| self.other.place(self.view.to_map([wall, aisle.middle()]))[0];
        let middles = sorted([first, last].map(place));
        let margin = SIDES * width;
        let [low, high] = [across[0] + margin, across[1] - margin];
        let along = self.open_about(middles, along, [low, high])?;
        let columns = self.other.column(along[0] + WALL)..self.other.column(along[1] - WALL);
        let is_clear = self.other.mean_blocked(columns, low, high) <= CLEAR;
        let way = stretches::ragged(self.other, along, across, along[1] - along[0]);
        is_clear.then_some(Led { way, middles })
    }

    /// What of a way is open between the middles of the outermost aisles and on from these, which may be wider than where they meet it;
    /// nothing where something closes it between them.
    fn open_about(&self, [from, to]: [f64; 2], along: [f64; 2], [low, high]: [f64; 2]) -> Option<[f64; 2]> {
        let columns = self.other.column(along[0] + WALL)..self.other.column(along[1] - WALL);
        let closed = self.other.some_closed(columns.clone(), low, high);
        let runs = closed.runs(0..columns.len(), false).map(|run| columns.start + run.start..columns.start + run.end);
        let mut about = runs.filter(|run| run.start <= self.other.column(from) && self.other.column(to) < run.end);
        let open = about.next()?;
        let end = |column: usize, last: usize, own: f64| if column == last { own } else { self.other.along(column) };
        Some([end(open.start, columns.start, along[0]), end(open.end, columns.end, along[1])])
    }
}
