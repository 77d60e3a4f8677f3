//! A row from upright to upright: its bays, and the ways through it.
//!
//! A bay is as wide as the posts recur, and a row of empty ones is free from one end to the other. A way has another
//! width, or the row is closed on both its sides.

use super::closing::{Closing, LinesAcross};
use crate::ends::{overlap, wider};
use crate::grid::Frame;
use crate::labels::posts::frames::{LEG, NEAR};
use crate::labels::rows::{Row, SHORTEST};
use crate::labels::view::look::Look;
use crate::labels::view::runs::runs;
use crate::labels::view::shares::Shares;
use crate::labels::view::turned::Turned;
use crate::labels::ways::step::{BAYS, Section};
use std::cell::OnceCell;
use std::mem;
use std::ops::Range;

/// A way is so wide, metres.
pub const WIDTH: (f64, f64) = (1.6, 8.0);
/// A section up to this many pitches is an empty bay, by what is seen of it: posts take a little of each.
pub const BAY: f64 = 1.03;
/// Where no bays recur, between ends that are closed what may be a way is narrower by so much, metres.
const CLOSED: f64 = 0.3;
/// What passes a row's end is at least so many pitches wide, or lies within its last bay.
const NARROW: f64 = 0.8;
/// A section this near to a whole number of pitches is one of empty bays, unless its ends are closed.
const WHOLE: f64 = 0.1;
/// What is free of a row for so much, metres, has two ends of its own.
const APART: f64 = 0.5;
/// What stands so near to a way's side stands at it, metres.
pub const SIDE: f64 = 0.35;
/// A column of which this share is not free is of what closes a row.
pub const TAKEN: f64 = 0.5;
/// Uprights end between columns, so far beyond those that are free, in columns, on either side.
const BETWEEN: f64 = 0.25;
/// No more than this share of a column is not free where nothing closes a row.
pub const LEFT: f64 = 0.25;
/// Racks end so near to a side, metres, beside goods that leave so much of what lies between.
const AT_SIDE: f64 = 0.5;
const BESIDE_GOODS: f64 = 0.4;
/// A way is free but for this share, metre for metre: one walks round what was left in it.
const CLUTTER: f64 = 0.2;
/// Two posts across from each other, be they off by the map's error, take no more along a row, metres.
const PAIR: f64 = LEG + NEAR;
/// Posts are no longer along a row, metres.
const POST: f64 = 0.6;
/// Of a row from which nothing reaches into a way so much is not free there.
const BARE: f64 = 0.05;
/// A way between posts, and not between frames, is free but for this share of its columns.
const FREE: f64 = 0.12;
/// A rack that is drawn by its outline stands on both its faces over so much of its length at least: not all of them may have
/// been hit.
const OUTLINED: f64 = 0.7;
/// A patch that nobody saw between rays is no longer, metres, and has floor in so many columns on each side at least.
const PATCH: f64 = 1.0;
const BESIDE: usize = 3;
/// Structure this near to a face stands on it, metres.
pub const FACE: f64 = 0.25;

/// The least width of what leads through a row, by those of the aisles beside it, metres: as vehicles want it, or as the widest of the
/// aisles, if people alone come through these.
pub fn least_width(aisles: impl Iterator<Item = f64>) -> f64 {
    WIDTH.0.min(aisles.fold(0.0, f64::max))
}

/// A row's columns, leaning as the direction does that its uprights stand along.
pub struct Columns<'a> {
    view: &'a Turned,
    row: &'a Row,
    lines: LinesAcross<'a>,
    /// From post to post, metres, where that is known.
    pitch: Option<f64>,
    /// For each column, share of it that is not free.
    blocked: Vec<f64>,
    /// For each column, on which of the two faces something stands.
    faces: Vec<[bool; 2]>,
    /// For each column, whether it is of an upright or of goods.
    stops: Vec<bool>,
    /// How many columns before each are of ways that are as wide as no bays, once it is asked.
    in_ways: OnceCell<Vec<u32>>,
}

/// Places of a row that do not overlap, as many as there is room for, and how many of them are free.
#[derive(Clone, Copy, Debug)]
pub struct Free {
    pub free: f64,
    pub places: f64,
}

impl<'a> Columns<'a> {
    /// The columns of a row; its uprights stand along the `other` direction.
    pub fn new(
        look: &'a Look<'a>,
        frame: &'a Frame,
        [view, other]: [&'a Turned; 2],
        row: &'a Row,
        pitch: Option<f64>,
    ) -> Self {
        let lean = view.lean(other);
        let middle = f64::midpoint(row.across[0], row.across[1]);
        let count = ((row.along[1] - row.along[0]) / view.cell) as usize;
        let lines = LinesAcross { look, frame, view, across: row.across, middle, lean };
        let mut made = Self {
            view,
            row,
            lines,
            pitch,
            blocked: Vec::with_capacity(count),
            faces: Vec::with_capacity(count),
            stops: Vec::new(),
            in_ways: OnceCell::new(),
        };
        let slices = (((row.across[1] - row.across[0]) / view.cell).round() as usize).max(1);
        let height = (row.across[1] - row.across[0]) / slices as f64;
        let slices: Vec<_> = (0..slices)
            .map(|k| row.across[0] + k as f64 * height)
            .map(|low| (low + height / 2.0, view.blocked_in(low, low + height)))
            // Of slices as high as cells some lie between the samples of one and those of the next.
            .filter(|(_, of)| of.has_samples())
            .collect();
        let faces = row.across.map(|v| (v, view.occupied_in(v - FACE, v + FACE)));
        for n in 0..count {
            let along = made.place(n) + view.cell / 2.0;
            let column = |v: f64| view.column(along + (v - middle) * lean);
            let share = |(v, of): &(f64, Shares)| of.share(of.at(column(*v)));
            let taken = slices.iter().map(share).sum::<f64>() / slices.len() as f64;
            made.blocked.push(if slices.is_empty() { 1.0 } else { taken });
            made.faces.push([0, 1].map(|face| share(&faces[face]) > 0.0));
        }
        made.stops = (0..count).map(|n| made.stands(n)).collect();
        made.pass_unseen();
        if pitch.is_none() {
            made.pass_by();
        }
        made
    }

    /// The ways through the row, from where to where along its middle, in order. Those that are narrower than vehicles want are so wide
    /// at least, metres.
    pub fn ways(&self, least: f64) -> Vec<[f64; 2]> {
        self.gaps(|from, to| self.is_way(from, to, least))
    }

    /// What is free between two ends of racks, be they of one of two that stand back to back: in a row whose bays are
    /// half empty it may be a way or a bay.
    pub fn between_racks(&self) -> Vec<[f64; 2]> {
        let is_rack = |n: usize| self.closing(n) != Closing::Open;
        self.gaps(|from, to| self.is_free_way(from, to, WIDTH.0 - self.view.cell) && is_rack(from) && is_rack(to))
    }

    /// The same, each with what is free along the faces beside it, where posts may recur.
    pub fn beside_racks(&self) -> Vec<Section> {
        let Some(pitch) = self.pitch else { return Vec::new() };
        let free = [0, 1].into_iter().flat_map(|face| {
            let stands: Vec<bool> = self.faces.iter().map(|faces| faces[face]).collect();
            runs(&stands, false)
        });
        let free: Vec<[f64; 2]> = free.map(|(from, to)| [self.place(from), self.place(to)]).collect();
        let within = |low: f64, high: f64| free.iter().copied().filter(move |[from, to]| *from >= low && *to <= high);
        let section = |ends: [f64; 2]| {
            let [below, above] = [within(ends[0] - BAYS * pitch, ends[0]), within(ends[1], ends[1] + BAYS * pitch)];
            Section { ends, beside: [below.collect(), above.collect()] }
        };
        self.between_racks().into_iter().map(section).collect()
    }

    /// What lies between two uprights, in order: its own ends are none that a way could lie between.
    fn gaps(&self, is_meant: impl Fn(usize, usize) -> bool) -> Vec<[f64; 2]> {
        let between = runs(&self.stops, false).into_iter().filter(|&(from, to)| from > 0 && to < self.stops.len());
        between.filter(|&(from, to)| is_meant(from, to)).map(|(from, to)| [self.place(from), self.place(to)]).collect()
    }

    /// The way between one of its ends, at which there is a wall, and what of the row stands nearest to that, if a rack
    /// ends there or posts show that it is no bay; and whether that may be one: as wide as bays or beside one of two racks
    /// back to back. At both its ends half a column may be free.
    pub fn way_at_end(&self, side: usize) -> Option<([f64; 2], bool)> {
        let count = self.blocked.len();
        let sections = runs(&self.stops, false);
        let &(from, to) = if side == 0 { sections.first()? } else { sections.last()? };
        let (off, upright) = if side == 0 { (from, to) } else { (count - to, from) };
        let ends = [self.place(from), self.place(to)];
        let is_way = off as f64 * self.view.cell <= SIDE
            && (1..count).contains(&upright)
            && self.is_free_way(from, to, WIDTH.0 - self.view.cell);
        if !is_way || self.is_between_posts(from, to) {
            return is_way.then_some((ends, false));
        }
        match self.closing(upright) {
            // Pallets of which the blocks are seen close nothing, but nothing within is open either.
            Closing::Open => self.is_full(ends).then_some((ends, true)),
            Closing::Half => Some((ends, true)),
            Closing::Whole | Closing::Sheet => Some((ends, self.is_as_bays(ends))),
        }
    }

    /// True when nothing else of the row is open between its ends for so much as half of a stretch.
    fn is_full(&self, [from, to]: [f64; 2]) -> bool {
        let ends = [self.place(0), self.place(self.blocked.len())];
        let is_within = |[low, high]: &[f64; 2]| *low > ends[0] && *high < ends[1];
        let is_other = |open: &&[f64; 2]| is_within(open) && overlap(**open, [from, to]) <= 0.0;
        self.open().iter().filter(is_other).all(|open| open[1] - open[0] < (to - from) / 2.0)
    }

    /// The stretches in which nothing closes the row, from where to where along its middle, in order.
    pub fn open(&self) -> Vec<[f64; 2]> {
        let is_open = |n: usize| !self.stops[n] && self.blocked[n] <= LEFT;
        let open: Vec<bool> = (0..self.blocked.len()).map(is_open).collect();
        runs(&open, true).into_iter().map(|(from, to)| [self.place(from), self.place(to)]).collect()
    }

    /// What is free between two uprights, and how the row is closed at its ends.
    pub fn free(&self) -> Vec<([f64; 2], [Closing; 2])> {
        let is_free =
            |from: usize, to: usize| self.place(to) - self.place(from) >= APART && self.share(from, to) <= CLUTTER;
        let closed = |ends: [f64; 2]| (ends, ends.map(|end| self.closing_at(end)));
        self.gaps(is_free).into_iter().map(closed).collect()
    }

    /// Whether the row is closed at each end of what is free of it, but for what lies between two sides.
    pub fn closed_elsewhere(&self, sides: [f64; 2]) -> Vec<bool> {
        let others = self.free().into_iter().filter(|(ends, _)| overlap(*ends, sides) <= 0.0);
        others.flat_map(|(_, closed)| closed).map(Closing::is_whole).collect()
    }

    /// Between which two uprights a place lies in which none stands, along the row's middle.
    pub fn gap_about(&self, along: f64) -> Option<[f64; 2]> {
        let n = ((along - self.row.along[0]) / self.view.cell).max(0.0) as usize;
        let gap = self.gaps(|from, to| (from..to).contains(&n)).first().copied()?;
        Some(wider(gap, BETWEEN * self.view.cell))
    }

    /// How far from its lower end, or from its upper one, the first of it stands, metres, and the first that fills half of it:
    /// nothing where nothing does.
    pub fn first(&self, from_low: bool) -> [Option<f64>; 2] {
        let count = self.blocked.len();
        let far = |is: &dyn Fn(usize) -> bool| {
            let off = (0..count).find(|off| is(if from_low { *off } else { count - 1 - off }))?;
            Some(off as f64 * self.view.cell)
        };
        [far(&|n| self.stops[n]), far(&|n| self.blocked[n] >= TAKEN)]
    }

    /// True when what is known to be a way elsewhere goes on through the row: it is wider than a bay, and free.
    pub fn lets_through(&self, sides: [f64; 2]) -> bool {
        self.pitch.is_some_and(|pitch| sides[1] - sides[0] > BAY * pitch) && self.is_free(sides)
    }

    /// True when the row may end at a way that passes by: that is hardly narrower than a bay, and no upright stands in
    /// it.
    pub fn may_end_at(&self, sides: [f64; 2]) -> bool {
        self.pitch.is_none_or(|pitch| sides[1] - sides[0] > NARROW * pitch) && !self.stands_between(sides)
    }

    /// True when an upright or goods stand between two sides, and not at these.
    pub fn stands_between(&self, sides: [f64; 2]) -> bool {
        let (first, last) = self.inner(sides);
        (first..last).any(|n| self.stops[n])
    }

    /// True when posts stand between two sides on both faces, with next to nothing beside them: goods are longer.
    pub fn posts_between(&self, sides: [f64; 2]) -> bool {
        let (first, last) = self.inner(sides);
        first < last
            && runs(&self.stops[first..last], true)
                .into_iter()
                .any(|(from, to)| self.are_posts(first + from, first + to))
    }

    /// True when what stands in some columns does so on both faces, and is no longer than posts.
    fn are_posts(&self, from: usize, to: usize) -> bool {
        let stands = |face: usize| self.faces[from..to].iter().any(|faces| faces[face]);
        (to - from) as f64 * self.view.cell <= POST && stands(0) && stands(1)
    }

    /// True when what stands between two sides on both faces parts the row there into pieces none of which is wider than a
    /// bay: an empty one lies there and a part of the next.
    pub fn is_parted(&self, sides: [f64; 2]) -> bool {
        let (first, last) = self.inner(sides);
        let stands = |n: &usize| self.faces[*n] == [true; 2];
        let mut from = sides[0];
        // What ends at a post is known to half a column to either side.
        let mut is_piece =
            |to: f64, next: f64| self.is_as_a_bay([mem::replace(&mut from, next) + self.view.cell / 2.0, to]);
        let mut posts = (first..last).filter(stands).map(|n| self.place(n)).peekable();
        posts.peek().is_some()
            && posts.all(|post| is_piece(post, post + self.view.cell))
            && is_piece(sides[1], sides[1])
    }

    /// True when next to nothing of the row is not free between two sides, but for what stands at these.
    pub fn is_bare(&self, sides: [f64; 2]) -> bool {
        let (first, last) = self.inner(sides);
        first >= last || self.share(first, last) <= BARE && !self.stands_between(sides)
    }

    /// True when some of the row lies between two sides, but for what stands at these.
    pub fn reaches(&self, sides: [f64; 2]) -> bool {
        let (first, last) = self.inner(sides);
        first < last
    }

    /// True when nothing stands in the row between two sides that one could not walk round.
    pub fn is_free(&self, sides: [f64; 2]) -> bool {
        let (first, last) = self.inner(sides);
        first < last && self.share(first, last) <= CLUTTER && !self.stands_between(sides)
    }

    /// True when racks end at both of two sides, and goods that stand between leave most of it free.
    pub fn is_free_beside_goods(&self, sides: [f64; 2]) -> bool {
        let ends = |side: f64| {
            let [from, to] = wider([side; 2], AT_SIDE).map(|u| self.column(u));
            (from..to).any(|n| self.blocked[n] >= TAKEN || self.closing(n).is_whole())
        };
        let (first, last) = self.inner(sides);
        let is_free: Vec<bool> = (first..last).map(|n| self.blocked[n] <= LEFT && !self.stops[n]).collect();
        let longest = runs(&is_free, true).into_iter().map(|(from, to)| to - from).max().unwrap_or(0);
        longest as f64 * self.view.cell >= BESIDE_GOODS * (sides[1] - sides[0]) && sides.into_iter().all(ends)
    }

    /// In how many places of the row, but for what lies between two sides and the ways through it that are no bays, as much beside one
    /// another is free: of several ways none speaks against another.
    pub fn free_elsewhere(&self, sides: [f64; 2]) -> Free {
        let (first, last) = self.inner(sides);
        let (count, length) = (self.blocked.len(), last - first);
        let (mut stops, mut taken) = (vec![0u32], vec![0.0]);
        for n in 0..count {
            stops.push(stops[n] + u32::from(self.stops[n]));
            taken.push(taken[n] + self.blocked[n]);
        }
        let ways = self.in_ways();
        let is_free = |n: &usize| {
            let end = n + length;
            stops[end] == stops[*n] && taken[end] - taken[*n] <= CLUTTER * length as f64
        };
        let others = || {
            let beside = (0..=count.saturating_sub(length)).filter(|n| n + length <= first || last <= *n);
            beside.filter(|n| ways[n + length] == ways[*n])
        };
        let places = |count: usize| count as f64 / length.max(1) as f64;
        Free { free: places(others().filter(is_free).count()), places: places(others().count()) }
    }

    /// How many columns before each, and in all, are of ways that are as wide as no bays, where these are known.
    fn in_ways(&self) -> &[u32] {
        self.in_ways.get_or_init(|| {
            let is_way = |&(from, to): &(usize, usize)| {
                from > 0
                    && to < self.stops.len()
                    && self.is_way(from, to, WIDTH.0)
                    && !self.is_as_bays([self.place(from), self.place(to)])
            };
            let mut count = vec![0; self.stops.len() + 1];
            if self.pitch.is_some() {
                for (from, to) in runs(&self.stops, false).into_iter().filter(is_way) {
                    count[from + 1..=to].fill(1);
                }
            }
            (1..count.len()).for_each(|n| count[n] += count[n - 1]);
            count
        })
    }

    /// The columns between two sides, without what stands at these.
    fn inner(&self, sides: [f64; 2]) -> (usize, usize) {
        (self.column(sides[0] + SIDE), self.column(sides[1] - SIDE))
    }

    /// The column that holds a place along the row's middle, the first or one beyond the last when it lies outside.
    fn column(&self, u: f64) -> usize {
        (((u - self.row.along[0]) / self.view.cell).max(0.0) as usize).min(self.blocked.len())
    }

    /// Share of the columns that is not free.
    fn share(&self, from: usize, to: usize) -> f64 {
        self.blocked[from..to].iter().sum::<f64>() / (to - from) as f64
    }

    /// Where a column begins, along the row's middle.
    fn place(&self, column: usize) -> f64 {
        self.row.along[0] + column as f64 * self.view.cell
    }

    /// True when a column may be of an upright or of goods: something stands on both faces, or in most of it.
    fn stands(&self, n: usize) -> bool {
        let near = n.saturating_sub(1)..(n + 2).min(self.faces.len());
        let stands = |face: usize| self.faces[near.clone()].iter().any(|faces| faces[face]);
        self.blocked[n] >= TAKEN || (self.faces[n].contains(&true) && stands(0) && stands(1))
    }

    /// Passes by patches that nobody saw and in which nothing stands, where floor was seen for half as much on both sides: rays
    /// leave such between them.
    fn pass_unseen(&mut self) {
        let is_no_floor = |n: usize| self.stops[n] || self.blocked[n] > LEFT;
        let no_floor: Vec<bool> = (0..self.stops.len()).map(is_no_floor).collect();
        for (from, to) in runs(&no_floor, true) {
            let beside = ((to - from) / 2).max(BESIDE);
            let is_patch = (to - from) as f64 * self.view.cell <= PATCH
                && from >= beside
                && to + beside <= no_floor.len()
                && !no_floor[from - beside..from].contains(&true)
                && !no_floor[to..to + beside].contains(&true)
                && self.faces[from..to].iter().all(|faces| *faces == [false; 2]);
            let columns = || self.view.columns([self.place(from), self.place(to)]);
            if is_patch && !self.view.stands_in(columns(), self.row.across) {
                self.stops[from..to].fill(false);
                self.blocked[from..to].fill(0.0);
            }
        }
    }

    /// Passes by what stands in the row and closes no rack's depth anywhere, unless it is two posts across from each
    /// other, or as long as a rack and drawn by its outline: goods on the floor.
    fn pass_by(&mut self) {
        for (from, to) in runs(&self.stops, true) {
            let both = || self.faces[from..to].iter().filter(|faces| **faces == [true; 2]).count() as f64;
            let length = (to - from) as f64;
            let is_long = length * self.view.cell >= SHORTEST;
            let is_frame =
                if is_long { both() >= OUTLINED * length } else { self.is_pair(from, to) || both() >= length };
            let is_within = from > 0 && to < self.stops.len();
            if is_within && !is_frame && (from..=to).all(|n| self.closing(n) == Closing::Open) {
                self.stops[from..to].fill(false);
            }
        }
    }

    /// True when two posts stand in some columns, one on each face, be they off by the map's error, and not two goods of which
    /// each reaches beyond these on a side of its own.
    fn is_pair(&self, from: usize, to: usize) -> bool {
        let beyond = |n: Option<usize>| n.and_then(|n| self.faces.get(n)).copied().unwrap_or_default();
        let [before, after] = [from.checked_sub(2), Some(to + 1)].map(beyond);
        let are_two = before[0] != before[1] && after == [before[1], before[0]];
        (to - from) as f64 * self.view.cell <= PAIR && self.are_posts(from, to) && !are_two
    }

    /// True when something closes all of the row's depth at a place along.
    pub fn is_closed_at(&self, along: f64) -> bool {
        self.closing_at(along).is_whole()
    }

    /// How the row is closed at a place along.
    pub fn closing_at(&self, along: f64) -> Closing {
        self.lines.closing(along)
    }

    /// How the row is closed where a column begins.
    fn closing(&self, n: usize) -> Closing {
        self.lines.closing(self.place(n))
    }

    /// True when what lies between two columns is free, and as wide as a way that is so wide at least.
    fn is_free_way(&self, from: usize, to: usize, least: f64) -> bool {
        (least..=WIDTH.1).contains(&(self.place(to) - self.place(from)))
            && self.share(from, to) <= CLUTTER
            && !self.is_walled([self.place(from), self.place(to)])
    }

    /// True when something stands in most of the columns of a stretch, be it ever so little: a wall joins what is beside it.
    pub fn is_walled(&self, ends: [f64; 2]) -> bool {
        let [from, to] = ends.map(|u| self.view.column(u));
        is_walled(self.view, self.row, from..to)
    }

    fn is_way(&self, from: usize, to: usize, least: f64) -> bool {
        let is_closed = || [from, to].into_iter().all(|n| self.closing(n).is_whole());
        let usual = if self.pitch.is_none() { WIDTH.0 - CLOSED } else { WIDTH.0 };
        // Shelves are as narrow as ways between aisles for people: where others are empty, too, it is one.
        let is_alone = || self.is_free_way(from, to, least) && self.is_full([self.place(from), self.place(to)]);
        (self.is_free_way(from, to, usual) || is_alone()) && is_closed()
            || self.is_free_way(from, to, WIDTH.0) && self.is_between_posts(from, to)
    }

    /// True when nothing stands between two columns and it is no bay that lies there, nor some of them.
    fn is_between_posts(&self, from: usize, to: usize) -> bool {
        let stands = |n: &usize| self.blocked[*n] > FREE || self.faces[*n].contains(&true);
        let free = (from + 1..to.saturating_sub(1)).filter(stands).count() == 0;
        free && self.pitch.is_some() && !self.is_as_bays([self.place(from), self.place(to)])
    }

    /// True when a section is no wider than a bay.
    pub fn is_as_a_bay(&self, [from, to]: [f64; 2]) -> bool {
        self.pitch.is_some_and(|pitch| to - from <= BAY * pitch)
    }

    /// True when a section is as wide as a bay, or as some beside one another.
    pub fn is_as_bays(&self, [from, to]: [f64; 2]) -> bool {
        self.pitch.is_some_and(|pitch| is_as_bays(to - from, pitch))
    }
}

/// True when something stands in most of some columns of a row.
pub fn is_walled(view: &Turned, row: &Row, columns: Range<usize>) -> bool {
    let [low, high] = wider(row.across, FACE);
    let stands = view.some_occupied(columns, low, high);
    stands.iter().filter(|share| **share > 0.0).count() as f64 > TAKEN * stands.len() as f64
}

/// True when what is so wide is as wide as a bay, or as some beside one another.
pub fn is_as_bays(width: f64, pitch: f64) -> bool {
    let count = (width / pitch).round();
    width <= BAY * pitch || (count >= 2.0 && (width / pitch - count).abs() < WHOLE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wider_than_from_post_to_post_is_no_bay() {
        assert!(is_as_bays(2.8, 3.0) && is_as_bays(3.05, 3.0) && is_as_bays(5.9, 3.0));
        assert!(!is_as_bays(3.15, 3.0) && !is_as_bays(4.5, 3.0));
    }
}
