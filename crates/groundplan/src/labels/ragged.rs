//! Corridors whose sides are no lines: goods at every depth, or a wall that the map bends.
//!
//! A strip is asked column by column for its clear extent. Where that is all of the strip, and ends on both sides
//! within a share of its width beyond, the column speaks for a way along it, wherever in there the side may stand.

use super::barriers;
use super::corridors::{Strip, best_pieces};
use super::turned::{Shares, Turned};
use crate::parameters::Parameters;
use std::ops::Range;

/// Widths are tried in such steps, and places across in such shares of the width.
const WIDER: f64 = 1.25;
const STEP: f64 = 0.125;
/// The narrowest, metres: what is narrower has its sides nearer than goods are apart.
const NARROWEST: f64 = 1.2;
/// The widest is so much of the widest corridor: with what its sides leave it is as wide.
const WIDEST: f64 = 0.75;
/// A side may stand this far beyond the strip's border, in widths, metres at least.
const DEPTH: (f64, f64) = (0.8, 1.0);
/// Over so much of that depth something is not free.
const HELD: f64 = 0.3;
/// A column is clear up to this share, and in the way from that one on.
const CLEAR: f64 = 0.1;
const CLUTTERED: f64 = 0.35;
/// A way is at least so many times as long as wide, and so long, metres: less is a room.
const LONG: f64 = 4.2;
const SHORTEST: f64 = 7.0;
/// Least shares of its columns that are clear, that hold on each side and on both, and on which something seen stands
/// there.
const LEAST_CLEAR: f64 = 0.75;
const LEAST_HELD: f64 = 0.5;
const LEAST_BOTH: f64 = 0.45;
const LEAST_SEEN: f64 = 0.3;
/// A way that shares more than this of its width with a known one is none.
const SHARED: f64 = 0.25;
/// What a column says for a way, or against it: it is clear between two sides; it is narrowed; it has one side; it has
/// none; something stands in the way.
const FULL: i64 = 10;
const NARROWED: i64 = 2;
const ONE_SIDED: i64 = 1;
const OPEN: i64 = 7;
const BLOCKED: i64 = 20;
/// No way goes on through what closes it: a column of which so much is not free.
const IMPASSABLE: f64 = 0.7;

/// The ways along one direction beside those that are known, the best first.
pub fn find(view: &Turned, parameters: &Parameters, known: &[Strip]) -> Vec<Strip> {
    let mut candidates: Vec<Strip> = Vec::new();
    let mut width = NARROWEST.max(parameters.labels_min_width);
    while width <= WIDEST * parameters.labels_max_width {
        let step = (STEP * width).max(view.cell);
        let extent = view.size[1] as f64 * view.cell;
        for n in 0..((extent - width) / step).max(0.0) as usize {
            let low = view.start[1] + n as f64 * step;
            candidates.extend(Candidate::new(view, [low, low + width]).ways());
        }
        width *= WIDER;
    }
    candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut found: Vec<Strip> = Vec::new();
    for candidate in candidates {
        let rivals: Vec<&Strip> = known.iter().chain(&found).filter(|other| is_beside(&candidate, other)).collect();
        if rivals.is_empty() {
            found.push(candidate);
            continue;
        }
        let whole = Candidate::new(view, candidate.across);
        let ways = whole.ways_in(whole.around(&candidate), &rivals);
        found.extend(
            ways.into_iter().filter(|way| way.along[0] < candidate.along[1] && candidate.along[0] < way.along[1]),
        );
    }
    found
}

/// True when two strips share so much of their width that one of them is too much.
fn is_beside(one: &Strip, two: &Strip) -> bool {
    let shared = one.across[1].min(two.across[1]) - one.across[0].max(two.across[0]);
    let together = one.along[1].min(two.along[1]) - one.along[0].max(two.along[0]);
    together > 0.0 && shared > SHARED * one.width().min(two.width())
}

/// A strip, asked column by column.
struct Candidate<'a> {
    view: &'a Turned,
    across: [f64; 2],
    blocked: Shares<'a>,
    /// Of blocked cells, the least that count as so much.
    closed: u32,
    cluttered: u32,
    unclear: u32,
    /// What lies beyond its sides, and how many blocked cells hold there.
    beyond: [(Shares<'a>, u32); 2],
}

/// What a column is to a way along the strip.
#[derive(Clone, Copy)]
struct Column {
    clear: bool,
    held: [bool; 2],
    score: i64,
}

impl<'a> Candidate<'a> {
    fn new(view: &'a Turned, across: [f64; 2]) -> Self {
        let blocked = view.blocked_in(across[0], across[1]);
        let beyond = beyond(across).map(|[low, high]| {
            let side = view.blocked_in(low, high);
            let held = side.least(|share| share >= HELD);
            (side, held)
        });
        Self {
            view,
            across,
            closed: blocked.least(|share| share > IMPASSABLE),
            cluttered: blocked.least(|share| share > CLUTTERED),
            unclear: blocked.least(|share| share > CLEAR),
            blocked,
            beyond,
        }
    }

    /// The stretches of so many columns at least none of which is closed or a rival's.
    fn open(&self, within: Range<usize>, least: usize, rivals: &[Range<usize>]) -> Vec<Range<usize>> {
        let count = within.end;
        let is_closed = |c: &usize| self.blocked.at(*c) >= self.closed || rivals.iter().any(|rival| rival.contains(c));
        let mut stretches = Vec::new();
        let mut from = within.start;
        while from + least <= count {
            // From its far end, so that most columns are never asked.
            if let Some(closed) = (from..from + least).rev().find(is_closed) {
                from = closed + 1;
                continue;
            }
            let to = (from + least..count).find(is_closed).unwrap_or(count);
            stretches.push(from..to);
            from = to + 1;
        }
        stretches
    }

    fn column(&self, c: usize) -> Column {
        let blocked = self.blocked.at(c);
        let clear = blocked < self.unclear;
        let held = [0, 1].map(|side| self.beyond[side].0.at(c) >= self.beyond[side].1);
        let score = match (clear, held) {
            _ if blocked >= self.cluttered => -BLOCKED,
            (true, [true, true]) => FULL,
            (false, [true, true]) => NARROWED,
            (_, [false, false]) => -OPEN,
            _ => ONE_SIDED,
        };
        Column { clear, held, score }
    }

    /// The columns around a way along it up to where it is closed: beyond nothing bears on what lies there.
    fn around(&self, way: &Strip) -> Range<usize> {
        let is_closed = |c: &usize| self.blocked.at(*c) >= self.closed;
        let [first, last] = way.along.map(|u| self.view.column(u));
        let from = (0..first).rev().find(is_closed).map_or(0, |c| c + 1);
        from..(last..self.view.size[0]).find(is_closed).unwrap_or(self.view.size[0])
    }

    /// The ways along it.
    fn ways(&self) -> Vec<Strip> {
        self.ways_in(0..self.view.size[0], &[])
    }

    /// The ways along it that rivals leave, among some columns.
    fn ways_in(&self, within: Range<usize>, rivals: &[&Strip]) -> Vec<Strip> {
        let view = self.view;
        let width = self.across[1] - self.across[0];
        let least = ((SHORTEST.max(LONG * width) / view.cell) as usize).max(1);
        let rivals: Vec<Range<usize>> =
            rivals.iter().map(|rival| view.column(rival.along[0])..view.column(rival.along[1]) + 1).collect();
        let mut ways = Vec::new();
        for stretch in self.open(within, least, &rivals) {
            let columns: Vec<Column> = stretch.clone().map(|c| self.column(c)).collect();
            let clear = columns.iter().filter(|column| column.clear).count();
            if (clear as f64) < LEAST_CLEAR * least as f64 {
                continue;
            }
            let scores: Vec<i64> = columns.iter().map(|column| column.score).collect();
            let pieces = best_pieces(&scores).into_iter().filter(|(from, to)| to - from >= least);
            ways.extend(pieces.filter(|&(from, to)| self.is_way(&columns[from..to], stretch.start + from)).map(
                |(from, to)| Strip {
                    direction: view.direction,
                    along: [view.along(stretch.start + from), view.along(stretch.start + to)],
                    across: self.across,
                    score: scores[from..to].iter().sum::<i64>() as f64 / FULL as f64 * view.cell * width,
                },
            ));
        }
        ways
    }

    fn is_way(&self, columns: &[Column], first: usize) -> bool {
        let view = self.view;
        let range = first..first + columns.len();
        let share = |is: &dyn Fn(&Column) -> bool| {
            columns.iter().filter(|column| is(column)).count() as f64 / columns.len() as f64
        };
        let seen = |[low, high]: [f64; 2]| {
            let seen = view.some_occupied(range.clone(), low, high).into_iter().filter(|share| *share > 0.0);
            seen.count() as f64 / columns.len() as f64
        };
        share(&|column| column.clear) >= LEAST_CLEAR
            && [0, 1].iter().all(|&side| share(&|column| column.held[side]) >= LEAST_HELD)
            && share(&|column| column.held == [true, true]) >= LEAST_BOTH
            && beyond(self.across).into_iter().all(|side| seen(side) >= LEAST_SEEN)
            && !barriers::across(view, self.across, range.clone()).contains(&true)
    }
}

/// Where a strip's sides may stand, across.
fn beyond(across: [f64; 2]) -> [[f64; 2]; 2] {
    let depth = DEPTH.1.max(DEPTH.0 * (across[1] - across[0]));
    [[across[0] - depth, across[0]], [across[1], across[1] + depth]]
}
