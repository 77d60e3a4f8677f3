//! Corridors whose sides are no lines: goods at every depth, or a wall that the map bends.
//!
//! A strip is asked column by column for its clear extent. Where that is all of the strip, and ends on both sides
//! within a share of its width beyond, the column speaks for a way along it, wherever in there the side may stand. A
//! long way that nothing narrows needs no more of a side than machines or pallets in a row, with gaps between them. What
//! is found is as wide as next to nothing stands along it.

use super::beside::Beside;
use super::corridors::{self, Strip, UNTOLD};
use super::runs::{best_pieces, close};
use super::shares::Shares;
use super::sums::What;
use super::sweep::Sweep;
use super::turned::{IMPASSABLE, Turned};
use super::{Evidence, barriers, pieces};
use std::ops::Range;

/// Widths are tried in such steps, and places across in such shares of the width.
const WIDER: f64 = 1.25;
const STEP: f64 = 0.125;
/// So many are worth a thread's while.
const TOGETHER: usize = 64;
/// The narrowest with deep sides, metres: what is narrower has its sides nearer than goods are apart.
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
/// Gaps up to this long in a thin side are no gaps, metres.
const GAP: f64 = 1.4;
/// A way is at least so long, metres, and so many times as long as wide: less is a room. The same with thin sides.
const LONG: (f64, f64) = (7.0, 4.2);
const VERY_LONG: (f64, f64) = (10.0, 5.0);
/// Least shares of its columns that are clear (and that are where the sides are thin), that hold on each side and on
/// both, and on which something seen stands there.
const LEAST_CLEAR: f64 = 0.75;
const LEAST_CLEAR_THIN: f64 = 0.95;
const LEAST_HELD: f64 = 0.5;
const LEAST_BOTH: f64 = 0.45;
const LEAST_SEEN: f64 = 0.3;
/// Least share of a thin side on which structure lies along the way.
const LEAST_FACED: f64 = 0.2;
/// Up to so many pitches of the rows that it crosses it may lie over empty bays, from row to row: so much holds on both
/// sides then.
const BAY: f64 = pieces::BAY_WIDTH.1;
const LEAST_BOTH_BAY: f64 = 0.8;
/// A way that shares more than this of its width with a known one is none.
const SHARED: f64 = 0.25;
/// What lies beside a way is of it where no more than this share of it is not free.
const REACHED: f64 = 0.05;
/// What a column says for a way, or against it: it is clear between two sides; it is narrowed; it has one side; it has
/// none; something stands in the way, or narrows one with thin sides.
const FULL: i64 = 10;
const NARROWED: i64 = 2;
const ONE_SIDED: i64 = 1;
const OPEN: i64 = 7;
const BLOCKED: i64 = 20;

/// What holds a side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Held {
    /// Much of what lies beyond the strip's border is not free.
    Deep,
    /// Something stands there, now and then.
    Thin,
}

impl Held {
    /// The shortest way of a width with such sides, metres.
    fn shortest(self, width: f64) -> f64 {
        let (shortest, long) = if self == Self::Thin { VERY_LONG } else { LONG };
        shortest.max(long * width)
    }

    /// Least share of a way's columns that are clear.
    fn least_clear(self) -> f64 {
        if self == Self::Thin { LEAST_CLEAR_THIN } else { LEAST_CLEAR }
    }
}

/// The ways along one direction beside those that are known, the best first; and those over known ones that are too short
/// by themselves, for where these turn out to be none.
pub fn find(
    evidence: &Evidence,
    views: &[Turned],
    view: &Turned,
    known: &[Strip],
    threads: usize,
) -> (Vec<Strip>, Vec<Strip>) {
    let parameters = evidence.parameters;
    let bay = corridors::pitches(views, view).into_iter().fold(0.0, |widest, pitch| f64::max(widest, BAY * pitch));
    let seen = Seen::new(view);
    let (mut tried, mut lows) = (Vec::new(), Vec::new());
    let mut widest: f64 = 0.0;
    let mut width = parameters.labels_min_width;
    while width <= WIDEST * parameters.labels_max_width {
        let step = (STEP * width).max(view.cell);
        let extent = view.size[1] as f64 * view.cell;
        let deep = (width >= NARROWEST).then_some(Held::Deep);
        for n in 0..((extent - width) / step).max(0.0) as usize {
            let low = view.start[1] + n as f64 * step;
            let across = [low, low + width];
            if beyond(across).into_iter().any(|side| seen.between(side) < LEAST_SEEN * LONG.0 / view.cell) {
                continue;
            }
            tried.push((across, deep));
            lows.push(low);
            widest = widest.max(width);
        }
        width *= WIDER;
    }
    let depth_of_all = depth([0.0, widest]);
    let around = [depth_of_all, widest + depth_of_all];
    let sweep = Sweep { view, places: &lows, around, what: &[What::Blocked, What::Occupied] };
    let mut candidates = sweep.find(TOGETHER, threads, |near, n, found| {
        let (across, deep) = tried[n];
        let key = || view.key(across, depth(across)).number(bay).with(u64::from(deep.is_some()));
        let ways = evidence.recall.ragged.or_find(key, || Candidate::new(near.view(), across, bay).ways(deep));
        found.extend(ways.into_iter().map(|(way, by)| Short::new(view, n, &way, by)));
    });
    candidates.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.tried.cmp(&b.tried)));
    let mut all = known.to_vec();
    let mut over = Vec::new();
    let mut placed = Beside::of(view);
    let mut next = 0;
    for short in candidates {
        let (candidate, by) = (short.strip(view, tried[short.tried as usize].0), short.by);
        for strip in &all[next..] {
            placed.add(next, strip.along, strip.across);
            next += 1;
        }
        let near = placed.touching(candidate.along, candidate.across).into_iter().map(|n| &all[n]);
        let rivals: Vec<&Strip> = near.filter(|other| is_beside(&candidate, other)).collect();
        if rivals.is_empty() {
            all.push(candidate);
            continue;
        }
        if rivals.iter().all(|rival| rival.is_short()) && !over.iter().any(|way| is_beside(&candidate, way)) {
            over.push(candidate.clone());
        }
        let whole = Candidate::new(view, candidate.across, bay);
        let ways = whole.ways_left(by, whole.around(&candidate), &rivals);
        all.extend(
            ways.into_iter().filter(|way| way.along[0] < candidate.along[1] && candidate.along[0] < way.along[1]),
        );
    }
    let whole = |way: Strip| Strip { across: widened(view, &way, parameters.labels_max_width), ..way };
    let ways = all.split_off(known.len()).into_iter().map(whole).collect();
    (ways, over.into_iter().map(whole).collect())
}

/// A way in little room: of a large map there are millions, of which few stay.
struct Short {
    score: f64,
    /// The place across that was tried.
    tried: u32,
    /// From column to column.
    columns: [u32; 2],
    by: Held,
}

impl Short {
    fn new(view: &Turned, tried: usize, way: &Strip, by: Held) -> Self {
        let columns = way.along.map(|u| view.border(u) as u32);
        Self { score: way.score, tried: tried as u32, columns, by }
    }

    fn strip(&self, view: &Turned, across: [f64; 2]) -> Strip {
        let along = self.columns.map(|column| view.along(column as usize));
        ragged(view, along, across, self.score)
    }
}

/// A way whose sides are no lines.
fn ragged(view: &Turned, along: [f64; 2], across: [f64; 2], score: f64) -> Strip {
    Strip { direction: view.direction, along, across, score, bays: false, is_ragged: true, held: UNTOLD }
}

/// True when two strips share so much of their width that one of them is too much.
pub fn is_beside(one: &Strip, two: &Strip) -> bool {
    let shared = one.across[1].min(two.across[1]) - one.across[0].max(two.across[0]);
    let together = one.along[1].min(two.along[1]) - one.along[0].max(two.along[0]);
    together > 0.0 && shared > SHARED * one.width().min(two.width())
}

/// How much is occupied between two places across: where it is next to nothing, no column need be asked.
struct Seen<'a> {
    view: &'a Turned,
    /// Occupied samples below each row of cells.
    below: Vec<u64>,
}

impl<'a> Seen<'a> {
    fn new(view: &'a Turned) -> Self {
        let mut below = vec![0];
        for (n, row) in view.rows.iter().enumerate() {
            below.push(below[n] + row.occupied);
        }
        Self { view, below }
    }

    /// Occupied samples, a row to either side included.
    fn between(&self, [low, high]: [f64; 2]) -> f64 {
        let row = |v: f64| ((v - self.view.start[1]) / self.view.cell).max(0.0) as usize;
        let last = self.below.len() - 1;
        (self.below[(row(high) + 2).min(last)] - self.below[row(low).saturating_sub(1).min(last)]) as f64
    }
}

/// A strip, asked column by column.
struct Candidate<'a> {
    view: &'a Turned,
    across: [f64; 2],
    /// It may be a row of empty bays.
    bay: bool,
    blocked: Shares<'a>,
    /// Of blocked cells, the least that count as so much.
    closed: u32,
    unclear: u32,
}

/// What the columns of a stretch are to a way along the strip.
struct Columns {
    clear: Vec<bool>,
    held: [Vec<bool>; 2],
    scores: Vec<i64>,
}

impl<'a> Candidate<'a> {
    fn new(view: &'a Turned, across: [f64; 2], bay: f64) -> Self {
        let blocked = view.blocked_in(across[0], across[1]);
        Self {
            view,
            across,
            bay: across[1] - across[0] <= bay,
            closed: blocked.least(|share| share > IMPASSABLE),
            unclear: blocked.least(|share| share > CLEAR),
            blocked,
        }
    }

    /// What the columns of a stretch are, where so many of them may be a way.
    fn columns(&self, stretch: &Range<usize>, by: Held, least: usize) -> Option<Columns> {
        let enough = |count: usize, share: f64| count as f64 >= share * least as f64;
        let count = |flags: &[bool]| flags.iter().filter(|flag| **flag).count();
        let unclear = self.blocked.reached(stretch.clone(), self.unclear);
        if !enough(unclear.len() - count(&unclear), by.least_clear()) {
            return None;
        }
        let [low, high] = beyond(self.across);
        let low = self.held(stretch, by, low);
        if !enough(count(&low), LEAST_HELD) {
            return None;
        }
        let held = [low, self.held(stretch, by, high)];
        let both = held[0].iter().zip(&held[1]).filter(|(one, two)| **one && **two).count();
        if !enough(both, LEAST_BOTH) {
            return None;
        }
        let cluttered = self.blocked.least(|share| share > CLUTTERED);
        let cluttered = self.blocked.reached(stretch.clone(), cluttered);
        let clear: Vec<bool> = unclear.into_iter().map(|unclear| !unclear).collect();
        let score = |n: usize| match (clear[n], [held[0][n], held[1][n]]) {
            _ if cluttered[n] => -BLOCKED,
            (false, _) if by == Held::Thin => -BLOCKED,
            (true, [true, true]) => FULL,
            (false, [true, true]) => NARROWED,
            (_, [false, false]) => -OPEN,
            _ => ONE_SIDED,
        };
        let scores = (0..clear.len()).map(score).collect();
        Some(Columns { clear, held, scores })
    }

    /// In which columns of a stretch a side holds.
    fn held(&self, stretch: &Range<usize>, by: Held, [low, high]: [f64; 2]) -> Vec<bool> {
        let mut held = self.view.blocked_where(stretch.clone(), low, high, |share| share >= HELD);
        if by == Held::Thin {
            let seen = self.view.occupied_in(low, high).reached(stretch.clone(), 1);
            held.iter_mut().zip(seen).for_each(|(held, seen)| *held |= seen);
            close(&mut held, (GAP / self.view.cell) as usize);
        }
        held
    }

    /// The columns around a way along it up to where it is closed: beyond nothing bears on what lies there.
    fn around(&self, way: &Strip) -> Range<usize> {
        let [first, last] = way.along.map(|u| self.view.column(u));
        let from = self.blocked.last(0..first, self.closed).map_or(0, |c| c + 1);
        from..self.blocked.first(last..self.view.size[0], self.closed).unwrap_or(self.view.size[0])
    }

    /// Columns of the shortest way along it.
    fn least(&self, by: Held) -> usize {
        ((by.shortest(self.across[1] - self.across[0]) / self.view.cell) as usize).max(1)
    }

    /// The ways along it, those with deep sides first, if such are asked for.
    fn ways(&self, deep: Option<Held>) -> Vec<(Strip, Held)> {
        // Where a short way fits, a long one may.
        let kinds = deep.into_iter().chain([Held::Thin]);
        let least = kinds.clone().map(|by| self.least(by)).min().unwrap_or(1);
        let stretches = self.blocked.open(0..self.view.size[0], least, self.closed, &[]);
        kinds.flat_map(|by| self.ways_in(by, &stretches).into_iter().map(move |way| (way, by))).collect()
    }

    /// The ways along it that rivals leave, among some columns.
    fn ways_left(&self, by: Held, within: Range<usize>, rivals: &[&Strip]) -> Vec<Strip> {
        let view = self.view;
        let rivals: Vec<Range<usize>> =
            rivals.iter().map(|rival| view.column(rival.along[0])..view.column(rival.along[1]) + 1).collect();
        self.ways_in(by, &self.blocked.open(within, self.least(by), self.closed, &rivals))
    }

    /// The ways along it in stretches that are not closed.
    fn ways_in(&self, by: Held, stretches: &[Range<usize>]) -> Vec<Strip> {
        let view = self.view;
        let width = self.across[1] - self.across[0];
        let least = self.least(by);
        let mut ways = Vec::new();
        for stretch in stretches.iter().filter(|stretch| stretch.len() >= least) {
            let Some(columns) = self.columns(stretch, by, least) else { continue };
            let pieces = best_pieces(&columns.scores).into_iter().filter(|(from, to)| to - from >= least);
            ways.extend(pieces.filter(|&(from, to)| self.is_way(&columns, by, from..to, stretch.start)).map(
                |(from, to)| {
                    let along = [from, to].map(|column| view.along(stretch.start + column));
                    let score = columns.scores[from..to].iter().sum::<i64>() as f64 / FULL as f64 * view.cell * width;
                    ragged(view, along, self.across, score)
                },
            ));
        }
        ways
    }

    fn is_way(&self, columns: &Columns, by: Held, range: Range<usize>, first: usize) -> bool {
        let (view, sides) = (self.view, beyond(self.across));
        let length = range.len() as f64;
        let share = |flags: &[bool]| flags[range.clone()].iter().filter(|flag| **flag).count() as f64 / length;
        let both = range.clone().filter(|&c| columns.held[0][c] && columns.held[1][c]).count() as f64 / length;
        let on_map = first + range.start..first + range.end;
        let seen = |[low, high]: [f64; 2]| {
            let of = view.occupied_in(low, high);
            let seen = of.reached(on_map.clone(), of.least(|share| share > 0.0));
            seen.into_iter().filter(|seen| *seen).count() as f64 / length
        };
        let faced = |[low, high]: [f64; 2]| {
            let lines = &view.covered[view.lines(low, high)];
            on_map.clone().filter(|&c| lines.iter().any(|line| line.get(c))).count() as f64 / length
        };
        share(&columns.clear) >= by.least_clear()
            && columns.held.iter().all(|held| share(held) >= LEAST_HELD)
            && both >= if by == Held::Thin && self.bay { LEAST_BOTH_BAY } else { LEAST_BOTH }
            && sides.into_iter().all(|side| seen(side) >= LEAST_SEEN)
            && (by == Held::Deep || sides.into_iter().all(|side| faced(side) >= LEAST_FACED))
            && !barriers::across(view, self.across, on_map.clone()).contains(&true)
            && !barriers::doors(view, sides, on_map.clone()).contains(&true)
            && barriers::stops(view, self.across, on_map).is_empty()
    }
}

/// From side to side of a way: with all beside it along which next to nothing stands, no farther than its sides may stand
/// and no wider than that.
fn widened(view: &Turned, way: &Strip, widest: f64) -> [f64; 2] {
    let columns = view.column(way.along[0])..view.column(way.along[1]);
    let [below, above] = beyond(way.across);
    let is_clear = |low: f64| view.mean_blocked(columns.clone(), low, low + view.cell) <= REACHED;
    let [mut low, mut high] = way.across;
    let (mut down, mut up) = (true, true);
    while (down || up) && high - low + view.cell <= widest {
        down = down && low - view.cell >= below[0] && is_clear(low - view.cell);
        if down {
            low -= view.cell;
        }
        up = up && high + view.cell <= above[1] && is_clear(high);
        if up {
            high += view.cell;
        }
    }
    [low, high]
}

/// How far beyond a strip's borders its sides may stand, metres.
fn depth(across: [f64; 2]) -> f64 {
    DEPTH.1.max(DEPTH.0 * (across[1] - across[0]))
}

/// Where a strip's sides may stand, across.
fn beyond(across: [f64; 2]) -> [[f64; 2]; 2] {
    let depth = depth(across);
    [[across[0] - depth, across[0]], [across[1], across[1] + depth]]
}
