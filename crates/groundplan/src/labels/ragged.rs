//! Corridors whose sides are no lines: goods at every depth, or a wall that the map bends.
//!
//! A strip is asked column by column for its clear extent. Where that is all of the strip, and ends on both sides
//! within a share of its width beyond, the column speaks for a way along it, wherever in there the side may stand.

use super::barriers;
use super::corridors::{Strip, best_pieces};
use super::turned::Turned;
use crate::parameters::Parameters;

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
/// What a column says for a way, where one that is clear between two sides says 1: it is narrowed; it has one side; it
/// has none; something stands in the way.
const NARROWED: f64 = 0.2;
const ONE_SIDED: f64 = 0.1;
const OPEN: f64 = 0.7;
const BLOCKED: f64 = 2.0;
/// No way goes on through what closes it: a column of which so much is not free.
const CLOSED: f64 = 1e6;
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
            candidates.extend(Candidate::new(view, [low, low + width]).ways(&[]));
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
        let ways = Candidate::new(view, candidate.across).ways(&rivals);
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

/// A strip, column by column.
struct Candidate<'a> {
    view: &'a Turned,
    across: [f64; 2],
    clear: Vec<bool>,
    held: [Vec<bool>; 2],
    scores: Vec<f64>,
}

impl<'a> Candidate<'a> {
    fn new(view: &'a Turned, across: [f64; 2]) -> Self {
        let beyond = beyond(across);
        let held = beyond.map(|[low, high]| view.all_blocked(low, high).into_iter().map(|b| b >= HELD).collect());
        let blocked = view.all_blocked(across[0], across[1]);
        let mut made =
            Self { view, across, clear: blocked.iter().map(|b| *b <= CLEAR).collect(), held, scores: Vec::new() };
        made.scores = blocked.iter().enumerate().map(|(c, blocked)| made.score(c, *blocked)).collect();
        made
    }

    /// What a column says for a way along the strip or against it.
    fn score(&self, c: usize, blocked: f64) -> f64 {
        if blocked > IMPASSABLE {
            return -CLOSED;
        }
        if blocked > CLUTTERED {
            return -BLOCKED;
        }
        match (self.clear[c], [0, 1].map(|n| self.held[n][c])) {
            (true, [true, true]) => 1.0,
            (false, [true, true]) => NARROWED,
            (_, [false, false]) => -OPEN,
            _ => ONE_SIDED,
        }
    }

    /// The ways along it that rivals leave.
    fn ways(&self, rivals: &[&Strip]) -> Vec<Strip> {
        let view = self.view;
        let width = self.across[1] - self.across[0];
        let least = (SHORTEST.max(LONG * width) / view.cell) as usize;
        let mut scores = self.scores.clone();
        for rival in rivals {
            let [from, to] = rival.along.map(|u| view.column(u));
            scores[from..=to].fill(-CLOSED);
        }
        let strip = |&(from, to): &(usize, usize)| Strip {
            direction: view.direction,
            along: [view.along(from), view.along(to)],
            across: self.across,
            score: scores[from..to].iter().sum::<f64>() * view.cell * width,
        };
        let pieces: Vec<(usize, usize)> =
            best_pieces(&scores).into_iter().filter(|(from, to)| to - from >= least).collect();
        pieces.iter().filter(|piece| self.is_way(**piece)).map(strip).collect()
    }

    fn is_way(&self, (from, to): (usize, usize)) -> bool {
        let view = self.view;
        let share = |flags: &[bool]| flags.iter().filter(|flag| **flag).count() as f64 / flags.len() as f64;
        let seen = |[low, high]: [f64; 2]| {
            (from..to).filter(|&c| view.occupied(c, low, high) > 0.0).count() as f64 / (to - from) as f64
        };
        let both = (from..to).filter(|&c| self.held[0][c] && self.held[1][c]).count() as f64;
        share(&self.clear[from..to]) >= LEAST_CLEAR
            && self.held.iter().all(|held| share(&held[from..to]) >= LEAST_HELD)
            && both >= LEAST_BOTH * (to - from) as f64
            && beyond(self.across).into_iter().all(|side| seen(side) >= LEAST_SEEN)
            && !barriers::across(view, self.across, from..to).contains(&true)
    }
}

/// Where a strip's sides may stand, across.
fn beyond(across: [f64; 2]) -> [[f64; 2]; 2] {
    let depth = DEPTH.1.max(DEPTH.0 * (across[1] - across[0]));
    [[across[0] - depth, across[0]], [across[1], across[1] + depth]]
}
