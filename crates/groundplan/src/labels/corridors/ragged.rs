//! Corridors whose sides are no lines: goods at every depth, or a wall that the map bends. Strips of many widths are tried
//! at every place across ([`stretches`](super::stretches)), of those that overlap the best stays, and it is as wide as next
//! to nothing stands along it.

use super::onward;
use super::pieces;
use super::stretches::{Borders, Candidate, Found, Held, beyond, depth, may_be_bay, ragged};
use crate::ends::{overlap, wider};
use crate::grid::whole;
use crate::labels::Evidence;
use crate::labels::beside::Beside;
use crate::labels::corridors::{self, Strip};
use crate::labels::recall::Key;
use crate::labels::view::sums::What;
use crate::labels::view::sweep::Sweep;
use crate::labels::view::turned::Turned;
use std::cell::OnceCell;
use std::ops::Range;

/// Widths are tried in such steps, and places across in such shares of the width.
const WIDER: f64 = 1.25;
const STEP: f64 = 0.125;
/// So many places are asked together before each of them is.
const GROUP: usize = 2;
/// So many columns of them are worth a thread's while.
const TOGETHER: usize = 1 << 17;
/// None is narrower, metres, however narrow corridors may be.
const FINEST: f64 = 0.05;
/// The narrowest with deep sides, metres: what is narrower has its sides nearer than goods are apart.
const NARROWEST: f64 = 1.2;
/// The widest is so much of the widest corridor: with what its sides leave it is as wide.
const WIDEST: f64 = 0.75;
/// Up to so many pitches of the rows that it crosses it may lie over empty bays, from row to row.
const BAY: f64 = pieces::BAY_WIDTH.1;
/// A way that shares more than this of its width with a known one is none.
const SHARED: f64 = 0.25;
/// A way of which others leave less than this share is none.
const MOST: f64 = 0.75;
/// What stands over so much of a way's length farther within it than so much, metres, and over no more, across, parts it.
const PARTED: f64 = 0.7;
const WITHIN: f64 = 0.3;
const THICK: f64 = 0.2;
/// What lies beside a way is of it where no more than this share of it is not free.
const REACHED: f64 = 0.05;

/// What may be a way.
#[derive(Default)]
pub struct Ways {
    /// Those that are, of ragged ones the best first.
    pub sure: Vec<Strip>,
    /// Over known ones that are too short by themselves, for where these turn out to be none.
    pub over: Vec<Strip>,
    /// What walls at its ends leave of one, for places of racks.
    pub cut: Vec<Strip>,
    /// What goes on beyond the ends of known ones.
    pub on: Vec<Strip>,
}

/// The ways along one direction beside those that are known.
pub fn find(evidence: &Evidence, views: &[Turned], view: &Turned, known: &[Strip], threads: usize) -> Ways {
    let parameters = evidence.parameters;
    let bay = corridors::pitches(views, view).into_iter().fold(0.0, |widest, pitch| f64::max(widest, BAY * pitch));
    let seen = Seen::new(view);
    // Strips, what may hold their sides, and those of them that are asked together first.
    let (mut tried, mut by, mut groups) = (Vec::new(), Vec::new(), Vec::<Range<usize>>::new());
    let mut widest: f64 = 0.0;
    let mut width = parameters.labels_min_width.max(FINEST);
    while width <= WIDEST * parameters.labels_max_width {
        let step = (STEP * width).max(view.cell);
        let extent = view.size[1] as f64 * view.cell;
        let fewest = [Held::Deep, Held::Thin].map(|by| by.fewest(view, width));
        let mut next = usize::MAX;
        for n in 0..((extent - width) / step).max(0.0) as usize {
            let low = view.start[1] + n as f64 * step;
            let borders = Borders::new(view, [low, low + width]);
            let may_be = fewest.map(|fewest| borders.sides().iter().all(|rows| seen.are_as_many(rows, fewest)));
            let own: &[Held] = match [width >= NARROWEST && may_be[0], may_be[1]] {
                [true, true] => &[Held::Deep, Held::Thin],
                [true, false] => &[Held::Deep],
                [false, true] => &[Held::Thin],
                [false, false] => continue,
            };
            match groups.last_mut() {
                Some(group) if n == next && group.len() < GROUP && own == by[group.start] => group.end += 1,
                _ => groups.push(tried.len()..tried.len() + 1),
            }
            tried.push(borders);
            by.push(own);
            next = n + 1;
            widest = widest.max(width);
        }
        width *= WIDER;
    }
    let depth_of_all = depth([0.0, widest]);
    let group = (GROUP - 1) as f64 * (STEP * widest).max(view.cell);
    let around = [depth_of_all, group + widest + depth_of_all];
    let lows: Vec<f64> = groups.iter().map(|group| tried[group.start].across[0]).collect();
    let sweep = Sweep { view, places: &lows, around, what: &[What::Blocked, What::Occupied] };
    let mut candidates = sweep.find(TOGETHER, threads, |near, n, found| {
        let group = groups[n].clone();
        let one_may = OnceCell::new();
        for n in group.clone() {
            let (across, by) = (tried[n].across, by[n]);
            let told = [may_be_bay(across, bay), by.contains(&Held::Deep)].map(u64::from);
            let key = || told.into_iter().fold(view.key(across, depth(across)), Key::with);
            let may_be = || Candidate::may_be(near.view(), &tried[group.clone()], by);
            let may_be = || group.len() == 1 || *one_may.get_or_init(may_be);
            let ways = || if may_be() { Candidate::new(near.view(), across, bay).ways(by) } else { Vec::new() };
            let ways = evidence.recall.ragged.or_find(key, ways);
            found.extend(ways.iter().map(|way| Short::new(view, n, way)));
        }
    });
    candidates.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.tried.cmp(&b.tried)));
    let mut all = known.to_vec();
    let [mut over, mut cut, mut on] = [0; 3].map(|_| Apart { ways: Vec::new(), placed: Beside::of(view) });
    let mut placed = Beside::of(view);
    let mut next = 0;
    for short in candidates {
        let (candidate, by) = (short.strip(view, tried[short.tried as usize].across), short.by);
        if short.is_cut {
            cut.add(&candidate);
            continue;
        }
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
        for way in onward::of(view, &candidate, &rivals) {
            on.add(&way);
        }
        if rivals.iter().all(|rival| rival.is_short()) {
            over.add(&candidate);
        }
        let whole = Candidate::new(view, candidate.across, bay);
        let ways = whole.ways_left(by, whole.around(&candidate), &rivals);
        let is_of_it = |way: &Strip| way.along[0] < candidate.along[1] && candidate.along[0] < way.along[1];
        all.extend(ways.into_iter().filter(|(way, is_cut)| !is_cut && is_of_it(way)).map(|(way, _)| way));
    }
    // What is wider from side to side than corridors may be is none. Up to here it has kept out what is narrower there, which
    // is a part of the same space.
    let whole = |way: Strip| {
        let across = widened(view, &way);
        let may_be = across[1] - across[0] <= parameters.labels_max_width && !is_parted_along(view, &way);
        may_be.then_some(Strip { across, ..way })
    };
    let [sure, over, cut] =
        [all.split_off(known.len()), over.ways, cut.ways].map(|ways| ways.into_iter().filter_map(whole).collect());
    Ways { sure, over, cut, on: on.ways }
}

/// True when something stands all along a way within it, as what parts two racks back to back: what is free on either side is of
/// these.
fn is_parted_along(view: &Turned, way: &Strip) -> bool {
    let columns = view.columns(way.along);
    let [low, high] = wider(way.across, -WITHIN);
    let rows = ((high - low - THICK) / view.cell).max(0.0) as usize;
    let at = |n: usize| low + n as f64 * view.cell;
    (0..rows).any(|n| view.share_touched(columns.clone(), at(n), at(n) + THICK) >= PARTED)
}

/// Ways that share no ground with one another, the best first.
struct Apart {
    ways: Vec<Strip>,
    placed: Beside,
}

impl Apart {
    fn add(&mut self, way: &Strip) {
        let near = self.placed.touching(way.along, way.across);
        if !near.into_iter().any(|n| is_beside(way, &self.ways[n])) {
            self.placed.add(self.ways.len(), way.along, way.across);
            self.ways.push(way.clone());
        }
    }
}

/// A way in little room: of a large map there are millions, of which few stay.
struct Short {
    score: f64,
    /// The place across that was tried.
    tried: u32,
    /// From column to column.
    columns: [u32; 2],
    by: Held,
    is_cut: bool,
}

impl Short {
    fn new(view: &Turned, tried: usize, (way, by, is_cut): &Found) -> Self {
        let columns = way.along.map(|u| view.border(u) as u32);
        Self { score: way.score, tried: tried as u32, columns, by: *by, is_cut: *is_cut }
    }

    fn strip(&self, view: &Turned, across: [f64; 2]) -> Strip {
        let along = self.columns.map(|column| view.along(column as usize));
        ragged(view, along, across, self.score)
    }
}

/// True when two strips share so much of their width that one of them is too much.
pub fn is_beside(one: &Strip, two: &Strip) -> bool {
    overlap(one.along, two.along) > 0.0 && share_width(one, two)
}

fn share_width(one: &Strip, two: &Strip) -> bool {
    overlap(one.across, two.across) > SHARED * one.width().min(two.width())
}

/// What others at its ends, as far as they were found, leave of a way, where that is most of it.
pub fn clear_of(way: &Strip, others: &[Strip]) -> Option<Strip> {
    let mut along = way.along;
    for other in others.iter().filter(|other| other.direction == way.direction && share_width(way, other)) {
        let found = other.found_along();
        if overlap(way.along, found) <= 0.0 {
            continue;
        }
        if found[0] <= along[0] {
            along[0] = along[0].max(found[1]);
        } else if found[1] >= along[1] {
            along[1] = found[0];
        } else {
            return None;
        }
    }
    (along[1] - along[0] >= MOST * way.length()).then(|| Strip { along, ..way.clone() })
}

/// How much is occupied in rows of cells, and how much structure lies on lines there: where it is next to nothing, no
/// column need be asked.
struct Seen {
    /// Occupied samples below each row of cells, and columns with structure on each line below it, together.
    below: Vec<[u64; 2]>,
}

impl Seen {
    fn new(view: &Turned) -> Self {
        let mut rows: Vec<[u64; 2]> = view.rows.iter().map(|row| [row.occupied, 0]).collect();
        for (offset, line) in view.offsets.iter().zip(view.covered.iter()) {
            let row = whole((offset - view.start[1]) / view.cell).min(view.size[1] - 1);
            rows[row][1] += line.count(0..view.size[0]) as u64;
        }
        let mut below = vec![[0; 2]];
        for (n, row) in rows.iter().enumerate() {
            below.push([0, 1].map(|of| below[n][of] + row[of]));
        }
        Self { below }
    }

    /// True where there is as much of both in some rows, of lines a row to either side included, which may lie between.
    fn are_as_many(&self, rows: &Range<usize>, [samples, lined]: [f64; 2]) -> bool {
        let count = |of: usize, from: usize, to: usize| (self.below[to][of] - self.below[from][of]) as f64;
        count(0, rows.start, rows.end) >= samples
            && count(1, rows.start.saturating_sub(1), (rows.end + 1).min(self.below.len() - 1)) >= lined
    }
}

/// From side to side of a way: with all beside it along which next to nothing stands, no farther than its sides may stand.
fn widened(view: &Turned, way: &Strip) -> [f64; 2] {
    let columns = view.column(way.along[0])..view.column(way.along[1]);
    let [below, above] = beyond(way.across);
    let is_clear = |low: f64| view.mean_blocked(columns.clone(), low, low + view.cell) <= REACHED;
    let [mut low, mut high] = way.across;
    while low - view.cell >= below[0] && is_clear(low - view.cell) {
        low -= view.cell;
    }
    while high + view.cell <= above[1] && is_clear(high) {
        high += view.cell;
    }
    [low, high]
}
