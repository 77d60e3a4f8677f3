//! What opens into a way between the ends of two rows or of two walls, as far as it was seen: a place to turn into.

use super::stretches;
use crate::bits::{Bits, WORD, lowest};
use crate::ends::{overlap, sorted, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::Strip;
use crate::labels::junctions::shut;
use crate::labels::rows::sections::{BAY, WIDTH};
use crate::labels::rows::{DEPTH, Row};
use crate::labels::view::runs::{Run, runs};
use crate::labels::view::turned::Turned;
use crate::labels::ways::across::square_to;
use crate::parameters::Parameters;
use std::ops::Range;

/// It is so deep at least, metres, and so many times as deep as wide; and is looked into no farther than that.
const DEEP: (f64, f64) = (1.2, 0.3);
const LOOK: f64 = 8.0;
/// The rows beside it end no farther than this from the side of what leads past them, and its sides are as near to their
/// corners, metres.
const END: f64 = 0.5;
const CORNER: f64 = 0.3;
/// Where the first bay of a row is empty that is so deep at most, in depths of what opens, and metres.
const SHALLOW: (f64, f64) = (0.5, 1.9);
/// A row has so many bays at least.
const BAYS: f64 = 2.0;
/// A cell of which more than this share is not free is none of it.
const TAKEN: f64 = 0.5;
/// At a frontier something stands in no more than this share of it.
const SHUT: f64 = 0.3;
/// From so far within a side to so far beyond, metres, something stands over so much of what holds it.
const SIDE: f64 = 0.3;
const SIDED: f64 = 0.4;
/// What lies from so far beyond a side to so far, metres, is not free where it is held.
const BESIDE: (f64, f64) = (0.1, 0.5);

/// What opens into a way.
pub struct Opening {
    /// From that one's side as far as is free, or as it is looked into.
    pub way: Strip,
    /// Where that one's middle lies, along.
    pub middle: f64,
    /// Over so much of that each of its sides is held, metres, and over so much something stands there.
    pub held: [f64; 2],
    pub stands: [f64; 2],
    /// At its corner on each side a row ends that is as deep as rows are.
    pub ends_row: [bool; 2],
    /// It ends at a frontier: nothing stands there.
    pub is_frontier: bool,
    /// It is free farther than it is looked into.
    pub goes_on: bool,
}

/// The rows that have bays, by where they lie: nothing else has.
pub struct Bays<'a> {
    views: &'a [Turned],
    rows: Vec<&'a Row>,
    placed: Vec<Beside>,
}

impl<'a> Bays<'a> {
    /// Of some rows.
    pub fn new(views: &'a [Turned], rows: &'a [Row]) -> Self {
        let is_of_bays = |row: &&Row| views[row.direction].pitch.is_some_and(|pitch| row.length() >= BAYS * pitch);
        let rows: Vec<&Row> = rows.iter().filter(is_of_bays).collect();
        let placed = placed(views, rows.iter().map(|row| row.place()));
        Self { views, rows, placed }
    }

    /// Those beside one side of a way, if there are some.
    fn beside(&self, way: &Strip, side: usize) -> Option<BaysBeside> {
        let at = way.across[side];
        let near = self.placed[way.direction].touching(way.along, wider([at; 2], END)).into_iter();
        let is_beside = |row: &&Row| (row.across[1 - side] - at).abs() <= END;
        let along: Vec<[f64; 2]> = near.map(|n| self.rows[n]).filter(is_beside).map(|row| row.along).collect();
        self.views[way.direction].pitch.filter(|_| !along.is_empty()).map(|pitch| BaysBeside { along, pitch })
    }
}

/// Rows with bays beside one side of a way: from where to where along it each is, and how far it is from post to post, metres.
struct BaysBeside {
    along: Vec<[f64; 2]>,
    pitch: f64,
}

/// What opens into a way from one side or the other, square to it, and is no bay. Of what may be one opening the parts come before
/// the whole, of which the middle was not seen, and both before what is wider by what corners hid.
pub fn of(views: &[Turned], way: &Strip, bays: &Bays, parameters: &Parameters) -> Vec<Opening> {
    let view = &views[way.direction];
    let Some(other) = square_to(views, way.direction) else { return Vec::new() };
    let passing = |side| Passing { view, other, way, side, bays: bays.beside(way, side), parameters };
    [0, 1].into_iter().flat_map(|side| passing(side).openings()).collect()
}

/// A way past the ends of rows on one of its sides.
struct Passing<'a> {
    view: &'a Turned,
    other: &'a Turned,
    way: &'a Strip,
    side: usize,
    /// Of the rows along that side, if they have some.
    bays: Option<BaysBeside>,
    parameters: &'a Parameters,
}

impl Passing<'_> {
    fn openings(&self) -> Vec<Opening> {
        let columns = self.free();
        let depths = self.depths(&columns);
        let mut deep: Vec<bool> = depths.iter().map(|depth| self.is_deep(*depth)).collect();
        let mut open = runs(&deep, true);
        // And what may be one of which the middle was not seen so far: there only what a ray hits tells that it is free up to that.
        for (from, to) in runs(&deep, false) {
            let is_within = from > 0 && to < deep.len();
            if is_within && !(from..to).any(|n| self.stands(columns.start + n, depths[n])) {
                deep[from..to].fill(true);
            }
        }
        let whole = runs(&deep, true).into_iter().filter(|run| !open.contains(run)).collect::<Vec<_>>();
        open.extend(whole);
        for n in 0..open.len() {
            let wider = self.up_to_corners(&columns, &depths, open[n]);
            if !open.contains(&wider) {
                open.push(wider);
            }
        }
        let is_way = |from: usize, to: usize| self.is_as_a_way(columns.start + from..columns.start + to);
        let opens = |&(from, to): &Run| is_way(from, to) && self.has_corners(&columns, &depths, from..to);
        let open = open.into_iter().filter(opens);
        open.filter_map(|(from, to)| self.opening(&columns, &depths, from..to)).collect()
    }

    /// What opens with what was seen less deep beside it, behind the corner of a row.
    fn up_to_corners(&self, columns: &Range<usize>, depths: &[usize], (from, to): Run) -> Run {
        let is_seen = |n: &usize| depths[*n] > 0 && !self.stands(columns.start + n, depths[*n]);
        let before = (0..from).rev().take_while(is_seen).count();
        let after = (to..depths.len()).take_while(is_seen).count();
        (from - before, to + after)
    }

    /// So many cells, metres.
    fn metres(&self, cells: usize) -> f64 {
        cells as f64 * self.view.cell
    }

    fn is_deep(&self, cells: usize) -> bool {
        self.metres(cells) >= DEEP.0
    }

    /// True when something stands where a column is free up to, so many cells beyond the side.
    fn stands(&self, column: usize, depth: usize) -> bool {
        let [low, high] = wider(self.beyond(depth), self.view.cell);
        self.view.occupied(column, low, high) > 0.0
    }

    /// It is looked into so many cells deep.
    fn most(&self) -> usize {
        (LOOK / self.view.cell) as usize
    }

    /// The columns in which the way is free, with those beyond its ends.
    fn free(&self) -> Range<usize> {
        let [low, high] = shut::inner(self.way);
        let most = self.parameters.labels_max_width;
        let [first, last] = self.way.along.map(|u| self.view.column(u));
        let [from, to] = wider(self.way.along, most).map(|u| self.view.column(u));
        let taken = |columns: Range<usize>| self.view.some_blocked(columns, low, high);
        let before = taken(from..first).iter().rev().take_while(|share| **share <= TAKEN).count();
        let after = taken(last..to + 1).iter().take_while(|share| **share <= TAKEN).count();
        first - before..last + after
    }

    /// From so many cells beyond the side to one more.
    fn beyond(&self, cells: usize) -> [f64; 2] {
        let outwards = if self.side == 0 { -1.0 } else { 1.0 };
        sorted([cells, cells + 1].map(|cells| self.way.across[self.side] + outwards * self.metres(cells)))
    }

    /// How many cells beyond the side are free of each of some columns.
    fn depths(&self, columns: &Range<usize>) -> Vec<usize> {
        let count = columns.len();
        let mut depths = vec![self.most(); count];
        let mut known = Bits::new(count);
        for cells in 0..self.most() {
            let [low, high] = self.beyond(cells);
            let taken = self.view.blocked_where(columns.clone(), low, high, |share| share > TAKEN);
            for word in (0..count).step_by(WORD) {
                let mut first = taken.word(word) & !known.word(word) & lowest(count - word);
                while first != 0 {
                    depths[word + first.trailing_zeros() as usize] = cells;
                    first &= first - 1;
                }
            }
            known |= &taken;
            if known.count(0..count) == count {
                break;
            }
        }
        depths
    }

    /// True when some columns are as wide as a way, and wider than a bay where they would be one of a row beside the way past them.
    fn is_as_a_way(&self, columns: Range<usize>) -> bool {
        let (width, along) = (self.metres(columns.len()), [columns.start, columns.end].map(|n| self.view.along(n)));
        let is_wider =
            |bays: &BaysBeside| width > BAY * bays.pitch || !bays.along.iter().any(|row| overlap(*row, along) > 0.0);
        (self.parameters.labels_min_width.max(WIDTH.0)..=self.parameters.labels_max_width).contains(&width)
            && self.bays.as_ref().is_none_or(is_wider)
    }

    /// True when at either side of some columns, of which the way's are given, a row ends, be its first bay empty, or the way
    /// itself does, at a wall.
    fn has_corners(&self, all: &Range<usize>, depths: &[usize], open: Range<usize>) -> bool {
        let near = (CORNER / self.view.cell).ceil() as usize;
        let least = END.max(SHALLOW.1.min(SHALLOW.0 * self.metres(median(&depths[open.clone()]))));
        let is_corner = |beside: Range<usize>, end: usize| {
            if beside.is_empty() {
                return shut::is_shut_at(self.view, self.way, end);
            }
            depths[beside].iter().any(|depth| self.metres(*depth) <= least)
        };
        is_corner(open.start.saturating_sub(near)..open.start, all.start)
            && is_corner(open.end..(open.end + near).min(depths.len()), all.end)
    }

    /// On which sides of some columns a row ends that is as deep as rows are.
    fn ends_row(&self, all: &[usize], open: Range<usize>) -> [bool; 2] {
        let is_end = |depth: &&usize| self.metres(**depth) <= END;
        let before = all[..open.start].iter().rev().take_while(is_end).count();
        let after = all[open.end..].iter().take_while(is_end).count();
        let is_row = |count: usize, is_whole: bool| is_whole && (DEPTH.0..=DEPTH.1).contains(&self.metres(count));
        [is_row(before, before < open.start), is_row(after, open.end + after < all.len())]
    }

    /// What opens through some of the way's columns, where it is deep enough.
    fn opening(&self, all: &Range<usize>, depths: &[usize], open: Range<usize>) -> Option<Opening> {
        let columns = all.start + open.start..all.start + open.end;
        let ends_row = self.ends_row(depths, open.clone());
        let depths = &depths[open];
        let deep: Vec<(usize, usize)> =
            columns.clone().zip(depths.iter().copied()).filter(|(_, depth)| self.is_deep(*depth)).collect();
        let cells = median(&deep.iter().map(|(_, depth)| *depth).collect::<Vec<_>>());
        let (depth, width) = (self.metres(cells), self.metres(columns.len()));
        if depth < DEEP.1 * width {
            return None;
        }
        let shut = deep.iter().filter(|(column, depth)| self.stands(*column, *depth)).count();
        let sides = [columns.start, columns.end].map(|column| self.view.along(column));
        let end = self.beyond(cells)[usize::from(self.side == 0)];
        let corners = [[sides[0], self.way.across[self.side]], [sides[1], end]];
        let [one, two] = corners.map(|place| self.other.place(self.view.to_map(place)));
        let [along, across] = [0, 1].map(|axis| sorted([one[axis], two[axis]]));
        let middle = self.other.place(self.view.to_map([sides[0], self.way.middle()]))[0];
        let [held, stands] = self.held(along, across);
        Some(Opening {
            way: stretches::ragged(self.other, along, across, depth),
            middle,
            held,
            stands,
            ends_row,
            is_frontier: cells < self.most() && shut as f64 <= SHUT * deep.len() as f64,
            goes_on: cells == self.most(),
        })
    }

    /// Over how much of it each side is held, metres: something stands there and what lies beyond is not free; and over how
    /// much something stands.
    fn held(&self, along: [f64; 2], across: [f64; 2]) -> [[f64; 2]; 2] {
        let last = self.other.size[0];
        let columns = self.other.border(along[0]).min(last)..self.other.border(along[1]).min(last);
        let of_side = |(side, outwards): (f64, f64)| {
            let [low, high] = sorted([BESIDE.0, BESIDE.1].map(|metres| side + outwards * metres));
            let held = self.other.blocked_where(columns.clone(), low, high, |share| share > TAKEN);
            let held = held.count(0..columns.len()) as f64 * self.other.cell;
            let stands = self.other.share_touched(columns.clone(), side - SIDE, side + SIDE) * (along[1] - along[0]);
            [if stands >= SIDED * held { held } else { 0.0 }, stands]
        };
        let [low, high] = [(across[0], -1.0), (across[1], 1.0)].map(of_side);
        [0, 1].map(|n| [low[n], high[n]])
    }
}

/// Of some numbers that which half of the others are no more than.
fn median(numbers: &[usize]) -> usize {
    *numbers.to_vec().select_nth_unstable(numbers.len() / 2).1
}
