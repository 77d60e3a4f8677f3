//! Ways through several rows: where all of them are free at one place, which chance would not make.
//!
//! A row of empty bays looks like a way, but rows side by side have their empty bays anywhere. How likely so many are
//! free at one place is told by how much of all of them is free elsewhere.

use super::chance::{Openings, SLACK};
use super::turns;
use super::widths::{Widths, are_alike};
use crate::ends::{overlap, shared};
use crate::labels::beside::Beside;
use crate::labels::corridors::Strip;
use crate::labels::corridors::family;
use crate::labels::rows::sections::WIDTH;
use crate::labels::rows::seen::Seen;
use crate::labels::rows::whole;
use crate::labels::view::turned::Turned;
use std::collections::{BTreeMap, BTreeSet};

/// What is open in some rows, one beside another.
#[derive(Clone)]
pub struct Common {
    /// From where to where, across the direction that crosses the rows.
    pub ends: [f64; 2],
    pub rows: Vec<usize>,
    /// How likely it is that all of them are open there.
    pub chance: f64,
}

impl Common {
    pub fn width(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}

/// A stretch that ends between cells is so much longer than what is open of it, metres.
pub const BETWEEN_CELLS: f64 = 0.1;
/// What stands at a wall reaches so far before it at most: pillars, frames of doors, what leans there, metres.
const AT_WALL: f64 = 0.6;
/// What is likelier than this is no way, whatever else is one.
const LIKELY: f64 = 0.3;
/// What crosses all rows of a place is a way when it is as wide as other ways and less likely than this by chance; when none
/// is known, or none between the rows' ends and it is not much narrower than the aisles beside; and when it has another width
/// than those. Past the ends of all rows there are ways in most halls, and LIKELY is enough.
const ALIKE: f64 = 0.05;
const FIRST: f64 = 0.02;
const OTHER: f64 = 0.005;
/// The same where there are more rows at that place, as of those that lie side by side there are many, and where it has
/// another width than those and a bay's.
const SOME: f64 = 0.0005;

/// So many ends of rows tell what closes them, where so much of them is closed; what is less likely than this by chance is a
/// way whatever closes its sides.
const ENDS: usize = 4;
const GUARDED: f64 = 0.75;
const NEVER: f64 = 0.0001;
/// So many rows end before a wall that others reach, in line but for so much, metres.
const SEVERAL: usize = 2;
const RAGGED: f64 = 0.5;
/// They are open elsewhere for less than this share of what leads past them.
const FULL: f64 = 0.5;

/// The rows of a place, and where each is open.
pub struct Through<'a> {
    rows: Vec<Seen<'a>>,
    open: Openings<'a>,
    /// For each row those above it and below it, with which it shares a corridor.
    above: Vec<Vec<usize>>,
    below: Vec<Vec<usize>>,
    /// Which of the rows are walls between halls.
    walls: Vec<bool>,
    /// For each row, which of its ends are at a wall.
    walled: Vec<[bool; 2]>,
}

impl<'a> Through<'a> {
    pub fn new(views: &[Turned], strips: &[Strip], rows: Vec<Seen<'a>>) -> Self {
        // A corridor is of one direction, and so are the rows beside it.
        let mut beside: BTreeMap<usize, [Vec<usize>; 2]> = BTreeMap::new();
        for (n, Seen { between: [below, above], .. }) in rows.iter().enumerate() {
            beside.entry(*above).or_default()[0].push(n);
            beside.entry(*below).or_default()[1].push(n);
        }
        let next = |side: usize| rows.iter().map(|row| beside[&row.between[side]][side].clone()).collect();
        let (below, above) = (next(0), next(1));
        let walls = whole::are_between_halls(views, &rows.iter().map(|seen| seen.row).collect::<Vec<_>>());
        let walled = rows.iter().map(|seen| [0, 1].map(|side| seen.is_at_wall(strips, side))).collect();
        Self { open: Openings::new(views.len(), &rows), rows, above, below, walls, walled }
    }

    pub fn rows(&self) -> &[Seen<'a>] {
        &self.rows
    }

    /// Where a row is open, across the direction that crosses it.
    pub fn open(&self, row: usize) -> &[[f64; 2]] {
        self.open.of(row)
    }

    /// How likely it is that some rows are open at one place.
    pub fn chance(&self, rows: &[usize], ends: [f64; 2]) -> f64 {
        self.open.chance(rows, ends)
    }

    /// The rows next to one, above and below it.
    pub fn next_to(&self, row: usize) -> impl Iterator<Item = usize> {
        self.above[row].iter().chain(&self.below[row]).copied()
    }

    /// The rows above or below those that are next to one there, that reach up to a place, and walls are none.
    pub fn two_on(&self, row: usize, is_up: bool, place: f64) -> impl Iterator<Item = usize> {
        let beside = if is_up { &self.above } else { &self.below };
        let holds = move |&n: &usize| !self.walls[n] && self.rows[n].holds(place);
        beside[row].iter().copied().filter(holds).flat_map(|n| beside[n].iter().copied()).filter(holds)
    }

    /// True when it leads through its rows between their ends, and no wall runs along one there.
    pub fn is_within(&self, common: &Common) -> bool {
        !self.is_past_ends(common) && !self.is_walled(common)
    }

    /// True when a row is a wall between halls.
    pub fn is_wall(&self, row: usize) -> bool {
        self.walls[row]
    }

    /// The ways, where those of known widths are, each through one row after another; `known_within` tells of each direction
    /// whether some of those lead through rows between their ends.
    pub fn find(&mut self, widths: &mut [Widths], known_within: impl Fn(usize) -> bool) -> Vec<Strip> {
        let mut found_within = vec![false; widths.len()];
        let mut left = Vec::new();
        for n in 0..self.rows.len() {
            for &ends in self.open.of(n) {
                self.follow(&mut vec![n], ends, &mut left);
            }
        }
        let mut ways: Vec<Common> = Vec::new();
        // From where to where they lead through each row.
        let mut taken: Vec<Vec<[f64; 2]>> = vec![Vec::new(); self.rows.len()];
        let is_taken = |taken: &[Vec<[f64; 2]>], common: &Common| {
            common.rows.iter().any(|&row| taken[row].iter().any(|&ends| overlap(ends, common.ends) > 0.0))
        };
        // What is known to be a way is no longer what chance makes, and others are as wide.
        loop {
            left.sort_by(|a, b| a.chance.total_cmp(&b.chance));
            let known = ways.len();
            for common in &left {
                let is_told = |direction: usize| found_within[direction] || known_within(direction);
                if self.is_way(common, widths, is_told) && !is_taken(&taken, common) {
                    common.rows.iter().for_each(|&row| taken[row].push(common.ends));
                    ways.push(common.clone());
                }
            }
            if ways.len() == known {
                return self.strips(&ways);
            }
            for way in &ways[known..] {
                let first = &self.rows[way.rows[0]];
                let (direction, is_within) = (first.views[1].direction, !self.is_past_ends(way));
                // What passes the ends is as wide as the hall leaves: if that is a bay's width it tells no others.
                if is_within || !first.is_as_bays(way.ends) {
                    widths[direction].add(way.width() + BETWEEN_CELLS);
                }
                found_within[direction] |= is_within;
                self.open.take(&way.rows, way.ends);
            }
            self.open.count();
            left.retain(|common| !is_taken(&taken, common));
            for common in &mut left {
                common.chance = self.open.chance(&common.rows, common.ends);
            }
        }
    }

    /// Those that lead through rows in turns, of what is left when the others are found.
    pub fn turns(&self) -> Vec<Strip> {
        self.strips(&turns::find(self))
    }

    /// Each way through one row after another.
    fn strips(&self, ways: &[Common]) -> Vec<Strip> {
        let strip = |way: &Common, n: usize| self.rows[n].way(self.rows[n].stretch(way.ends));
        ways.iter().flat_map(|way| way.rows.iter().map(move |&n| strip(way, n))).collect()
    }

    /// The ways between the last of a row and a wall that ends it and the corridors beside it, and whether each is as wide as
    /// bays: where all rows beside one another end in line there, for else more rows tell by one another what is a way; or several
    /// that are full do, though others go on to the wall.
    pub fn at_walls(&self, strips: &[Strip], placed: &[Beside]) -> Vec<(Strip, bool)> {
        let at_wall = |seen: &Seen, side: usize| {
            let (ends, is_as_a_bay) = seen.columns.way_at_end(side)?;
            seen.is_at_wall(strips, side).then(|| (seen.way(ends), seen.is_bounded(strips, ends), is_as_a_bay))
        };
        let mut found = Vec::new();
        for side in [0, 1] {
            let ways: Vec<_> = self.rows.iter().map(|seen| at_wall(seen, side)).collect();
            for (n, at_wall) in ways.iter().enumerate() {
                let Some((way, _, is_as_a_bay)) = at_wall else { continue };
                let beside = self.beside(n, way.middle());
                let are_near = |m: usize, within: f64| {
                    let is_so = |end: usize, other: &Strip| (other.across[end] - way.across[end]).abs() <= within;
                    ways[m].as_ref().is_some_and(|(other, ..)| is_so(0, other) && is_so(1, other))
                };
                let is_in_line = |m: &usize| are_near(*m, SLACK);
                let is_bounded = |m: &usize| ways[*m].as_ref().is_some_and(|(_, is_bounded, _)| *is_bounded);
                let all_end = || {
                    beside.iter().all(is_in_line)
                        && beside.iter().any(is_bounded)
                        && self.are_all(&beside, way, strips, placed)
                };
                let several_end = || !is_as_a_bay && self.are_several_full(n, way, |m| are_near(m, RAGGED));
                if all_end() || several_end() {
                    found.push((way.clone(), *is_as_a_bay));
                }
            }
        }
        found
    }

    /// True when a row ends before a wall in line with others beside it, and none of these is open elsewhere for as long: where some go
    /// on to the wall, one alone might have an empty bay there.
    fn are_several_full(&self, row: usize, way: &Strip, is_near: impl Fn(usize) -> bool) -> bool {
        let found = self.beside_if(row, is_near);
        let is_full = |&n: &usize| {
            let own = self.rows[n].stretch(way.across);
            let open = self.open.of(n).iter().map(|&open| self.rows[n].stretch(open));
            open.filter(|open| overlap(*open, own) <= 0.0).all(|open| open[1] - open[0] < FULL * way.width())
        };
        found.len() >= SEVERAL && found.iter().all(is_full)
    }

    /// What lies between the racks of rows, from aisle to aisle, how far from post to post, and whether no other row is
    /// beside: else what is as wide as a bay is none.
    pub fn between_racks(&self) -> Vec<(Strip, Option<f64>, bool)> {
        let gates = self.rows.iter().enumerate().flat_map(|(n, seen)| {
            let is_alone = self.above[n].is_empty() && self.below[n].is_empty();
            let ways = seen.columns.between_racks().into_iter();
            let ways = ways.filter(move |way| is_alone || !seen.columns.is_as_a_bay(*way));
            ways.filter_map(|way| seen.gate(way)).map(move |gate| (gate, seen.views[0].pitch_of(seen.row), is_alone))
        });
        gates.collect()
    }

    /// The ways through rows between the ends of racks that are as wide as bays, where as many lead through each of the rows
    /// one beside another there: bays are empty anywhere.
    pub fn in_each_row(&self) -> Vec<Strip> {
        let width = |[from, to]: [f64; 2]| to - from;
        let alike = |m: usize, way: [f64; 2]| {
            self.rows[m].ways.iter().filter(|other| are_alike(width(**other), width(way))).count()
        };
        let is_told = |n: usize, gate: &Strip, way: [f64; 2]| {
            let (own, beside) = (alike(n, way), self.beside(n, gate.middle()));
            width(way) >= family::LED_TO * self.rows[n].widest
                && beside.len() > 1
                && beside.into_iter().all(|m| alike(m, way) == own)
        };
        let gates = self.rows.iter().enumerate().flat_map(|(n, seen)| {
            let ways = seen.ways.iter().filter(|way| seen.columns.is_as_bays(**way));
            ways.filter_map(move |&way| seen.gate(way).filter(|gate| is_told(n, gate, way)))
        });
        gates.collect()
    }

    /// A row and those beside it, one beside another, that reach up to a place across the direction that crosses them.
    fn beside(&self, row: usize, place: f64) -> BTreeSet<usize> {
        self.beside_if(row, |m| self.rows[m].holds(place))
    }

    /// A row and such beside it, one beside another, that are no walls.
    fn beside_if(&self, row: usize, is_such: impl Fn(usize) -> bool) -> BTreeSet<usize> {
        let (mut found, mut next) = (BTreeSet::from([row]), vec![row]);
        while let Some(n) = next.pop() {
            let beside = self.next_to(n).filter(|&m| !self.walls[m] && is_such(m));
            next.extend(beside.filter(|&m| found.insert(m)));
        }
        found
    }

    /// True when no corridor runs beside some rows near to a way but those between which they are known, no further off than a
    /// row is deep, and those behind a wall.
    fn are_all(&self, rows: &BTreeSet<usize>, way: &Strip, strips: &[Strip], placed: &[Beside]) -> bool {
        let walls = rows.iter().flat_map(|&n| self.above[n].iter().chain(&self.below[n])).filter(|&&m| self.walls[m]);
        let known: BTreeSet<usize> = rows.iter().chain(walls).flat_map(|&n| self.rows[n].between).collect();
        rows.iter().map(|&n| &self.rows[n]).all(|row| {
            let beside = row.corridors_beside(strips, placed, row.stretch(way.across));
            beside.iter().all(|strip| known.contains(strip))
        })
    }

    /// What of a stretch that is open in some rows goes on through the next ones.
    fn follow(&self, rows: &mut Vec<usize>, ends: [f64; 2], found: &mut Vec<Common>) {
        let last = rows[rows.len() - 1];
        if rows.len() > 1 && ends[1] - ends[0] <= WIDTH.1 {
            let chance = self.open.chance(rows, ends);
            if chance <= LIKELY {
                found.push(Common { ends, rows: rows.clone(), chance });
            }
        }
        for &next in &self.above[last] {
            for open in self.open.of(next) {
                let both = shared(ends, *open);
                if both[1] - both[0] + BETWEEN_CELLS >= WIDTH.0 {
                    rows.push(next);
                    self.follow(rows, both, found);
                    rows.pop();
                }
            }
        }
    }

    fn is_way(&self, common: &Common, widths: &[Widths], is_told_within: impl Fn(usize) -> bool) -> bool {
        let [view, other] = self.rows[common.rows[0]].views;
        let known = &widths[other.direction];
        let is_as_wide = known.have(common.width() + BETWEEN_CELLS, view.pitch_of(self.rows[common.rows[0]].row));
        let limit = match (self.is_whole(common), is_as_wide) {
            (false, _) => SOME,
            (true, _) if self.is_past_ends(common) => LIKELY,
            (true, true) => ALIKE,
            (true, false) if known.is_empty() || !is_told_within(other.direction) && self.is_as_aisles(common) => FIRST,
            // Goods hardly narrow an empty bay of each row alike; racks end so.
            (true, false) if self.rows[common.rows[0]].is_as_bays(common.ends) && !self.is_closed(common) => SOME,
            (true, false) => OTHER,
        };
        common.chance < limit && !self.is_walled(common) && !self.leads_through_bays(common)
    }

    /// True when something closes the rows' ends as a rule, but for those at walls, and next to nothing closes them on one side
    /// of what is as wide as bays: it leads through some.
    fn leads_through_bays(&self, common: &Common) -> bool {
        if common.chance < NEVER || !self.rows[common.rows[0]].is_as_bays(common.ends) || self.is_past_ends(common) {
            return false;
        }
        let (mut sides, mut ends) = ([Vec::new(), Vec::new()], Vec::new());
        for &n in &common.rows {
            let Seen { row, columns, .. } = &self.rows[n];
            let own = self.open_at(n, common.ends).unwrap_or(self.rows[n].stretch(common.ends));
            for side in [0, 1] {
                if !self.reaches_wall(n, own, side) {
                    sides[side].push(columns.is_closed_at(own[side]));
                }
                let off = columns.first(side == 0)[0];
                let end = off.map(|off| if side == 0 { row.along[0] + off } else { row.along[1] - off });
                let is_elsewhere = |end: &f64| {
                    own.iter().all(|side| (side - end).abs() > AT_WALL) && !self.reaches_wall(n, [*end; 2], side)
                };
                ends.extend(end.filter(is_elsewhere).map(|end| columns.is_closed_at(end)));
            }
        }
        let share = |closed: &[bool]| closed.iter().filter(|is| **is).count() as f64 / closed.len() as f64;
        ends.len() >= ENDS
            && share(&ends) >= GUARDED
            && sides.iter().any(|side| !side.is_empty() && share(side) <= 1.0 - GUARDED)
    }

    /// From where to where along a row what is open in several lies open in it.
    fn open_at(&self, row: usize, ends: [f64; 2]) -> Option<[f64; 2]> {
        let (seen, ends) = (&self.rows[row], self.rows[row].stretch(ends));
        let mut open = self.open.of(row).iter().map(|&open| seen.stretch(open));
        open.find(|&open| overlap(open, ends) > 0.0)
    }

    /// True when a stretch of a row goes on to a wall that ends it on one side.
    fn reaches_wall(&self, row: usize, ends: [f64; 2], side: usize) -> bool {
        self.walled[row][side] && (ends[side] - self.rows[row].row.along[side]).abs() <= AT_WALL
    }

    /// True when a wall runs along one of its rows there, as behind a rack of which only that is left.
    fn is_walled(&self, common: &Common) -> bool {
        common.rows.iter().any(|&n| self.rows[n].columns.is_walled(self.rows[n].stretch(common.ends)))
    }

    /// True when racks end on both its sides in each of its rows.
    fn is_closed(&self, common: &Common) -> bool {
        common.rows.iter().all(|&n| {
            let ends = self.rows[n].stretch(common.ends);
            let is_there = |way: &[f64; 2]| [0, 1].into_iter().all(|side| (way[side] - ends[side]).abs() <= SLACK);
            self.rows[n].ways.iter().any(is_there)
        })
    }

    /// True when it is no narrower than what leads from aisle to aisle.
    fn is_as_aisles(&self, common: &Common) -> bool {
        common.rows.iter().all(|&n| common.width() + BETWEEN_CELLS >= family::LED_TO * self.rows[n].widest)
    }

    /// True when it lies between the ends of all its rows, which are in line, and a wall that ends them.
    fn is_past_ends(&self, common: &Common) -> bool {
        let is_last = |n: usize, side: usize| {
            let ends = self.rows[n].stretch(common.ends);
            let open = self.open_at(n, common.ends);
            self.reaches_wall(n, ends, side)
                && open.is_some_and(|open| (open[1 - side] - ends[1 - side]).abs() <= SLACK)
        };
        [0, 1].into_iter().any(|side| common.rows.iter().all(|&n| is_last(n, side)))
    }

    /// True when it leads through the first row of its place and the last one.
    fn is_whole(&self, common: &Common) -> bool {
        let middle = f64::midpoint(common.ends[0], common.ends[1]);
        let (first, last) = (common.rows[0], common.rows[common.rows.len() - 1]);
        !self.above[last].iter().chain(&self.below[first]).any(|&n| self.rows[n].holds(middle))
    }
}
