//! What a strip between two lines is, column by column, and which pieces of it are corridors.

use super::barriers;
use super::columns::{self, BAY, Column, NARROWED, Side, Walled, count};
use super::family::Family;
use crate::bits::{Bits, WORD, lowest};
use crate::ends::sorted;
use crate::labels::corridors::{Strip, UNTOLD};
use crate::labels::view::runs::{best_pieces, runs};
use crate::labels::view::shares::{BARRED, IMPASSABLE};
use std::ops::Range;

/// Lines this near to a strip's side belong to it, metres.
pub const INNER: f64 = 0.45;
/// Walls lie this far within the strip's sides, metres.
const MARGIN: f64 = 0.2;
/// Where the strip just beyond a side, from so far to so far, metres, is not free by this share, the side holds without
/// structure on it: a wall too faint to be occupied, or goods behind the posts.
pub const BESIDE: (f64, f64) = (0.1, 0.5);
const BEYOND: f64 = 0.8;
/// Least share of a corridor's length that is walled on both sides.
const LEAST_WALLED: f64 = 0.2;
/// A corridor so many times as long as wide is a long one.
const LONG: f64 = 4.5;
const VERY_LONG: f64 = 6.5;
/// Least share of a long corridor's walls that is more than posts, on one side at least.
const FACED_LONG: f64 = 0.55;
/// The same for a short one, which may be a row of empty bays: so much on one side, and on the other so much too, or
/// nearly all on the one.
const FACED: f64 = 0.7;
const FACED_TWICE: f64 = 0.4;
const FACED_ONCE: f64 = 0.85;
/// Where no bays recur it is none when so much of its length has no more than posts on a side.
const BARE: f64 = 0.7;
/// No less than a walled column says for a corridor, and no more than one that is not says against it: in thousandths, and
/// apart from what floats round.
const MOST_FOR: i64 = 1000;
const LEAST_AGAINST: i64 = (1000.0 * columns::OPEN) as i64 - 1;
/// A strip from so many to so many pitches wide may be a row of bays.
pub const BAY_WIDTH: (f64, f64) = (0.65, 1.17);
/// It is none when walls run along both its sides, with hardly a gap.
const WALLED: f64 = 0.8;
/// Nor when it is long, nearly all of it has structure on a side, and so much has it on the weaker one.
const WEAKER: f64 = 0.45;
/// Nor when a wall runs along nearly all of one side, and so much has structure on the other.
const WALL: f64 = 0.9;
const WEAKER_AT_WALL: f64 = 0.38;

impl Family<'_> {
    /// The stretches of a strip that are not closed and are long enough for a corridor.
    pub fn open(&self, across: [f64; 2]) -> Vec<Range<usize>> {
        let (view, width) = (self.view, across[1] - across[0]);
        let margin = MARGIN.min(0.2 * width);
        let blocked = view.blocked_in(across[0] + margin, across[1] - margin);
        let closed = blocked.least(|share| share > IMPASSABLE);
        let least = (self.parameters.labels_min_aspect * width / view.cell) as usize;
        blocked.open(0..view.size[0], least.max(1), closed, &[])
    }

    /// The two lines, and those between them that part a strip.
    fn lines(&self, [low, high]: [usize; 2]) -> ([&Side; 2], Vec<&Side>) {
        let [from, to] = [low, high].map(|n| self.view.offsets[n]);
        let inner = INNER.min(0.25 * (to - from));
        let parts = (low + 1..high)
            .filter(|&n| self.view.offsets[n] - from > inner && to - self.view.offsets[n] > inner)
            .map(|n| &self.sides[n]);
        ([low, high].map(|n| &self.sides[n]), parts.collect())
    }

    /// At which of some columns the ground beyond each side is not free.
    fn beyond(&self, [low, high]: [f64; 2], range: &Range<usize>) -> [Bits; 2] {
        let beyond = [[low - BESIDE.1, low - BESIDE.0], [high + BESIDE.0, high + BESIDE.1]];
        beyond.map(|[low, high]| self.view.blocked_where(range.clone(), low, high, |share| share > BEYOND))
    }

    /// The pieces among some columns between two lines, if there may be any: mostly walls are too few, which is told from
    /// these alone.
    pub fn pieces_in(&self, sides: [usize; 2], range: Range<usize>) -> Vec<(Strip, bool)> {
        let across = sides.map(|n| self.view.offsets[n]);
        let beyond = self.beyond(across, &range);
        let ([low, high], parts) = self.lines(sides);
        let mut walled = Bits::new(range.len());
        for from in range.clone().step_by(WORD) {
            let place = from - range.start;
            let walls =
                (low.walls.word(from) | beyond[0].word(place)) & (high.walls.word(from) | beyond[1].word(place));
            let parted = parts.iter().fold(0, |parted, part| parted | part.faces.word(from));
            walled.add(place, walls & !parted & lowest(range.end - from));
        }
        // No column says more for a corridor than that it is walled, and none that is not says less against it than OPEN: so
        // each piece lies in one of these.
        let mut scores = Vec::new();
        let mut ends = Vec::new();
        for run in walled.runs(0..range.len(), true) {
            let before = ends.last().map_or(0, |last: &Range<usize>| last.end);
            scores.extend([-LEAST_AGAINST * (run.start - before) as i64, MOST_FOR * run.len() as i64]);
            ends.extend([before..run.start, run]);
        }
        let is_long = |&(from, to): &(usize, usize)| self.is_long(ends[to - 1].end - ends[from].start, across);
        if !best_pieces(&scores).iter().any(is_long) {
            return Vec::new();
        }
        self.pieces(&self.columns(sides, range.clone()), range.start, across)
    }

    /// So many columns are long enough for a corridor between two places across.
    fn is_long(&self, columns: usize, across: [f64; 2]) -> bool {
        columns as f64 * self.view.cell >= self.parameters.labels_min_aspect * (across[1] - across[0])
    }

    /// What some columns between two lines hold.
    pub fn columns(&self, lines: [usize; 2], range: Range<usize>) -> Vec<Column> {
        let across = lines.map(|n| self.view.offsets[n]);
        let (sides, parts) = self.lines(lines);
        let margin = MARGIN.min(0.2 * (across[1] - across[0]));
        let view = self.view;
        let within = [across[0] + margin, across[1] - margin];
        let first = range.start;
        let blocked = view.some_blocked(range.clone(), within[0], within[1]);
        let barred = view.barred_where(range.clone(), within[0], within[1], |barred| barred > BARRED);
        let beyond = self.beyond(across, &range);
        let barriers = barriers::among(view, across, range.clone());
        let mut columns = Vec::with_capacity(range.len());
        for (from, blocked) in range.step_by(WORD).zip(blocked.chunks(WORD)) {
            // Many columns at a time, a bit for each.
            let place = from - first;
            let closed = barred.word(place) | barriers.word(place);
            let parted = parts.iter().fold(0, |parted, part| parted | part.faces.word(from));
            let beyond = beyond.each_ref().map(|beyond| beyond.word(place));
            let walls = sides.map(|side| side.walls.word(from));
            let near = sides.map(|side| side.near.word(from));
            let faces = sides.map(|side| side.faces.word(from));
            let mouths = sides.map(|side| side.mouths.word(from));
            let walled = (walls[0] | beyond[0]) & (walls[1] | beyond[1]);
            columns.extend(blocked.iter().enumerate().map(|(n, &blocked)| {
                let is = |word: u64| word >> n & 1 == 1;
                Column {
                    blocked,
                    closed: blocked > IMPASSABLE || is(closed),
                    parted: is(parted),
                    walled: is(walled),
                    near: is(near[0] | near[1]),
                    faces: faces.map(is),
                    held: [0, 1].map(|n| is(beyond[n] | mouths[n])),
                }
            }));
        }
        columns
    }

    /// The corridors among a strip's columns, of which the first is given: the pieces in which what speaks for a
    /// corridor outweighs what speaks against it, each as long as that holds.
    pub fn strips(&self, columns: &[Column], first: usize, across: [f64; 2]) -> Vec<Strip> {
        let pieces = self.pieces(columns, first, across).into_iter();
        pieces.filter(|(_, is_corridor)| *is_corridor).map(|(strip, _)| strip).collect()
    }

    /// The same of all pieces that are long enough, and which of them are corridors.
    pub fn pieces(&self, columns: &[Column], first: usize, across: [f64; 2]) -> Vec<(Strip, bool)> {
        let scores: Vec<f64> = columns.iter().map(|c| c.score()).collect();
        let pieces = best_pieces(&scores).into_iter();
        let view = self.view;
        let width = across[1] - across[0];
        let strip = |(from, to): (usize, usize)| Strip {
            direction: view.direction,
            along: [view.along(first + from), view.along(first + to)],
            across,
            score: scores[from..to].iter().sum::<f64>() * view.cell,
            bays: self.is_like_bays(&columns[from..to], width),
            is_ragged: false,
            stops: [false; 2],
            found: UNTOLD,
            held: self.held(&columns[from..to]).map(|column| view.along(first + from + column)),
        };
        let long = |(from, to): &(usize, usize)| self.is_long(to - from, across);
        let judged = |(from, to)| {
            let edged = || self.edged(first + from..first + to, across);
            (strip((from, to)), self.is_corridor(&columns[from..to], width, edged))
        };
        pieces.filter(long).map(judged).collect()
    }

    /// The first column of a piece, and that after its last one, without what lies beyond gaps longer than a bay and is
    /// no more than a speck, or nothing: a wall at which a row ends that seems to go on as over a missing post.
    fn held(&self, columns: &[Column]) -> [usize; 2] {
        let cells = |metres: f64| (metres / self.view.cell) as usize;
        let near: Vec<bool> = columns.iter().map(|column| column.near).collect();
        let mut runs = &runs(&near, true)[..];
        let is_speck = |run: &(usize, usize)| run.1 - run.0 <= cells(BAY / 2.0);
        while let [first, next, ..] = runs
            && is_speck(first)
            && next.0 - first.1 > cells(BAY)
        {
            runs = &runs[1..];
        }
        while let [.., next, last] = runs
            && is_speck(last)
            && last.0 - next.1 > cells(BAY)
        {
            runs = &runs[..runs.len() - 1];
        }
        let count = columns.len();
        let from = runs.first().map_or(0, |first| first.0);
        let to = runs.last().map_or(count, |last| last.1);
        [if from > cells(BAY) { from } else { 0 }, if count - to > cells(BAY) { to } else { count }]
    }

    /// What is so wide may be a row of bays.
    pub fn is_wide_as_bays(&self, width: f64) -> bool {
        self.pitches.iter().any(|pitch| (BAY_WIDTH.0 * pitch..=BAY_WIDTH.1 * pitch).contains(&width))
    }

    /// As wide as a bay, and walled no better than a row of empty ones.
    fn is_like_bays(&self, columns: &[Column], width: f64) -> bool {
        if !self.is_wide_as_bays(width) {
            return false;
        }
        let all = columns.len() as f64;
        let Walled { near, once, twice, weaker } = Walled::new(columns);
        let length = all * self.view.cell;
        // Between frames that are closed on both sides and go on and on, it is a cross aisle as wide as a bay.
        let closed = near >= WALLED * all && twice >= WALLED * near;
        let long = length >= LONG * width && once >= FACED_ONCE * near && weaker >= WEAKER * near;
        // Nor does a wall go on along a row of bays past the ways between the rows.
        let wall = (0..2).any(|n| count(columns, |c| c.faces[n]) >= WALL * all) && weaker >= WEAKER_AT_WALL * all;
        !(length >= VERY_LONG * width || long || closed || wall)
    }

    /// At which of some columns, on either side of a strip, the ground is free up to it and taken from there on: of racks
    /// whose inside nobody saw no more may show between their posts.
    fn edged(&self, columns: Range<usize>, [low, high]: [f64; 2]) -> [Vec<bool>; 2] {
        let taken = |[low, high]: [f64; 2], least: f64| {
            self.view.blocked_where(columns.clone(), low, high, |share| share > least)
        };
        [(low, -1.0), (high, 1.0)].map(|(side, beyond)| {
            let reach = |to: f64| sorted([BESIDE.0, BESIDE.1].map(|metres| side + to * metres));
            let (before, beyond) = (taken(reach(-beyond), 1.0 - BEYOND), taken(reach(beyond), BEYOND));
            (0..columns.len()).map(|n| beyond.get(n) && !before.get(n)).collect()
        })
    }

    /// Walled enough, and by more than posts; with the columns at which the ground ends at a side.
    fn is_corridor(&self, columns: &[Column], width: f64, edged: impl FnOnce() -> [Vec<bool>; 2]) -> bool {
        let Walled { near, once, twice, .. } = Walled::new(columns);
        let length = columns.len() as f64 * self.view.cell;
        // Posts alone are a side where racks stand, and elsewhere pillars.
        let bare = (0..2).map(|n| count(columns, |c| c.walled && !c.faces[n] && !c.held[n])).fold(0.0, f64::max);
        if !self.racked && bare > BARE * columns.len() as f64 {
            return false;
        }
        let structured = if length >= LONG * width {
            let sided = || {
                let edged = edged();
                let is_sided =
                    |n: &usize| columns[*n].walled && (0..2).all(|side| edged[side][*n] || columns[*n].faces[side]);
                (0..columns.len()).filter(is_sided).count() as f64
            };
            once >= FACED_LONG * near || (!self.is_wide_as_bays(width) && sided() >= FACED_LONG * near)
        } else {
            once >= FACED * near && (twice >= FACED_TWICE * near || once >= FACED_ONCE * near)
        };
        let walled = count(columns, |c| c.walled && c.blocked < NARROWED);
        structured && walled >= LEAST_WALLED * columns.len() as f64
    }
}
