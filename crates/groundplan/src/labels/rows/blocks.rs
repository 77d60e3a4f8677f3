//! Blocks: racks that are known by themselves, be there no aisle beside them: taken between two lines that are seen,
//! with floor before both, oblong, and of a depth that others on the map have too.

use crate::bands::flat_map_each;
use crate::bits::Bits;
use crate::ends::wider;
use crate::labels::beside::{Beside, placed};
use crate::labels::near::Near;
use crate::labels::recall::{Key, Recall};
use crate::labels::rows::{DEPTH, Row, apart};
use crate::labels::view::runs::{close, runs};
use crate::labels::view::turned::Turned;
use std::cell::OnceCell;
use std::ops::Range;

/// Floor shows before a block's faces from so far to so far off, metres.
const FRONT: [f64; 2] = [0.15, 0.65];
/// A column before a face is floor when no more of it than this is not free.
const FLOOR: f64 = 0.3;
/// Least share of a block's length before both of whose faces floor shows.
const STANDS: f64 = 0.8;
/// A face goes on over gaps as long as this, metres: between posts and goods.
const GAP: f64 = 1.5;
/// What stands before a block is no longer than this, metres.
const BEFORE: f64 = 2.0;
/// Least share of a block's length on which something touches each of its faces.
const SEEN: f64 = 0.7;
/// A block is at least so many metres long, and so many times as long as deep: less is a crate.
const OBLONG: (f64, f64) = (2.5, 2.2);
/// Least share of a block, without its faces, that is taken, if one could go through it.
const TAKEN: f64 = 0.12;
/// Nothing less deep than this is a block, metres.
const THINNEST: f64 = 0.4;
/// Where a lane as wide as this is free along it, metres, there are two blocks.
const LANE: f64 = 0.8;
const LANE_TAKEN: f64 = 0.05;
/// Beyond its ends a block meets floor, or a wall on one side: from so far to so far off, metres, with less than the one
/// share taken, or more than the other.
const END: [f64; 2] = [0.2, 0.7];
const ENDS: [f64; 2] = [0.3, 0.85];
/// What is taken over more than this share is solid for all that is seen, and a wall where it is less deep than the one,
/// or than the other where it joins on to something, metres.
const SHELL: f64 = 0.7;
const WALL: [f64; 2] = [0.5, 0.8];
/// Blocks are of a kind when their depths differ by no more than so much, metres, or than that share; and what is taken of
/// them.
const ALIKE: (f64, f64) = (0.15, 0.1);
const TAKEN_ALIKE: f64 = 0.4;
/// So many of a kind are racks, of which two have no more than so much floor between them, metres; and two that are so many
/// times as long as deep, side by side and as long as one another.
const KIND: usize = 3;
const LONG: f64 = 8.0;
const AISLE: f64 = 10.0;

/// One block is not so many times as long as another that is like it.
const LONGER: f64 = 1.3;

/// Before which of a block's faces, below and above, floor is asked for.
type Fronts = [bool; 2];

/// What may be one.
struct Block {
    row: Row,
    /// Share of it, without its faces, that is taken.
    taken: f64,
}

/// What may be a block, whatever ways there are beside it: found once, though racks are looked for again and again.
pub struct Standing<'a> {
    views: &'a [Turned],
    recall: &'a Recall,
    threads: usize,
    /// With floor on both sides, and with floor on one at least.
    free: OnceCell<Vec<Row>>,
    leaning: OnceCell<Vec<Row>>,
}

impl<'a> Standing<'a> {
    pub fn new(views: &'a [Turned], recall: &'a Recall, threads: usize) -> Self {
        Self { views, recall, threads, free: OnceCell::new(), leaning: OnceCell::new() }
    }

    fn before(&self, fronts: &[Fronts]) -> Vec<Row> {
        let views = || self.views.iter();
        let of = |view, fronts| candidates(view, fronts, self.recall, self.threads);
        let found = fronts.iter().flat_map(|&fronts| views().flat_map(move |view| of(view, fronts)));
        apart(self.views, found.collect())
    }

    fn free(&self) -> &[Row] {
        self.free.get_or_init(|| self.before(&[[true, true]]))
    }

    fn leaning(&self) -> &[Row] {
        self.leaning.get_or_init(|| self.before(&[[true, false], [false, true]]))
    }
}

/// The blocks of a kind that stand in rows. Rows of racks that are known already count for their kind.
pub fn find(views: &[Turned], known: &[Row], standing: &Standing) -> Vec<Row> {
    let found = standing.free();
    let count = found.len();
    let others = overlapping(views, known, found);
    let others = known.iter().zip(&others).filter(|(_, blocks)| blocks.is_empty()).map(|(row, _)| row.clone());
    let block = |row: Row| Block { taken: inner(&views[row.direction], &row), row };
    let blocks: Vec<Block> = found.iter().cloned().chain(others).map(block).collect();
    let kinds = Kinds::new(views, &blocks);
    let racks = blocks[..count].iter().filter(|block| kinds.are_racks(block));
    let mut racks: Vec<Row> = racks.map(|block| block.row.clone()).collect();
    if racks.is_empty() {
        return racks;
    }
    // What is like one of them and stands beside it is one too, be the floor on its other side not seen.
    let mut leaning = standing.leaning().to_vec();
    let is_like = |row: &Row, rack: &Row| beside(row, rack) && are_alike(rack, row) && is_as_long(row, rack);
    let placed = placed(views, racks.iter().map(Row::place));
    leaning.retain(|row| standing_near(&placed, row).into_iter().any(|n| is_like(row, &racks[n])));
    let met = overlapping(views, &leaning, &racks);
    racks.extend(leaning.into_iter().zip(met).filter(|(_, racks)| racks.is_empty()).map(|(row, _)| row));
    racks
}

/// For each row those of others that share ground with it.
pub fn overlapping(views: &[Turned], rows: &[Row], others: &[Row]) -> Vec<Vec<usize>> {
    let polygon = |row: &Row| views[row.direction].rectangle(row.along, row.across);
    let near = Near::polygons(&others.iter().map(polygon).collect::<Vec<_>>());
    let of = |row: &Row| {
        let beside = near.beside(&polygon(row)).into_iter().map(|n| n as usize);
        beside.filter(|&n| overlap(views, &others[n], row)).collect()
    };
    rows.iter().map(of).collect()
}

/// Of rows by their directions and places those that may be beside another, or behind it.
pub fn standing_near(placed: &[Beside], row: &Row) -> Vec<usize> {
    placed[row.direction].touching(wider(row.along, AISLE), wider(row.across, AISLE))
}

/// Blocks by their depths, and those of them that stand side by side or one behind the other.
struct Kinds<'a> {
    by_depth: Vec<&'a Block>,
    pairs: Vec<[&'a Block; 2]>,
}

impl<'a> Kinds<'a> {
    fn new(views: &[Turned], blocks: &'a [Block]) -> Self {
        let placed = placed(views, blocks.iter().map(|block| block.row.place()));
        let are_near = |[one, two]: &[&Block; 2]| beside(&one.row, &two.row) || behind(&one.row, &two.row);
        let before = |n: usize| standing_near(&placed, &blocks[n].row).into_iter().take_while(move |m| *m < n);
        let pairs = (0..blocks.len()).flat_map(|n| before(n).map(move |m| [&blocks[m], &blocks[n]]));
        let mut pairs: Vec<_> = pairs.filter(are_near).collect();
        pairs.sort_by(|a, b| a[0].row.depth().total_cmp(&b[0].row.depth()));
        let mut by_depth: Vec<&Block> = blocks.iter().collect();
        by_depth.sort_by(|a, b| a.row.depth().total_cmp(&b.row.depth()));
        Self { by_depth, pairs }
    }

    /// True when there are enough of a block's kind, itself among them, and two of them stand near each other.
    fn are_racks(&self, of: &Block) -> bool {
        let is_alike = |block: &&Block| are_alike(&of.row, &block.row) && (block.taken - of.taken).abs() <= TAKEN_ALIKE;
        let depth = of.row.depth();
        let reach = 2.0 * as_deep(depth);
        let first = |of: &[&Block]| of.partition_point(|block| block.row.depth() < depth - reach);
        let ahead =
            self.by_depth[first(&self.by_depth)..].iter().take_while(|block| block.row.depth() <= depth + reach);
        let is_kind = ahead.copied().filter(is_alike).take(KIND).count() == KIND;
        let first = self.pairs.partition_point(|[block, _]| block.row.depth() < depth - reach);
        let pairs = self.pairs[first..].iter().take_while(|[block, _]| block.row.depth() <= depth + reach);
        let mut pairs = pairs.filter(|pair| pair.iter().all(&is_alike));
        pairs.any(|[one, two]| is_kind || is_pair(&one.row, &two.row))
    }
}

/// True when two that stand side by side are racks, be there no third.
fn is_pair(one: &Row, two: &Row) -> bool {
    let is_long = |row: &Row| row.length() >= LONG * row.depth();
    beside(one, two) && is_as_long(one, two) && is_long(one) && is_long(two)
}

/// True when no more than an aisle lies between the long sides of two rows.
pub fn beside(one: &Row, two: &Row) -> bool {
    let shorter = one.length().min(two.length());
    let gap = gap(one.across, two.across);
    one.direction == two.direction && -self::gap(one.along, two.along) >= shorter / 2.0 && (0.0..=AISLE).contains(&gap)
}

/// True when no more than an aisle lies between the ends of two rows.
fn behind(one: &Row, two: &Row) -> bool {
    one.direction == two.direction && gap(one.across, two.across) < 0.0 && gap(one.along, two.along) <= AISLE
}

/// True when two rows are about as long.
fn is_as_long(one: &Row, two: &Row) -> bool {
    (1.0 / LONGER..=LONGER).contains(&(one.length() / two.length()))
}

/// True when a row is long enough for a rack, and for its depth.
pub fn is_oblong(row: &Row) -> bool {
    row.length() >= OBLONG.0.max(OBLONG.1 * row.depth())
}

fn gap(one: [f64; 2], two: [f64; 2]) -> f64 {
    one[0].max(two[0]) - one[1].min(two[1])
}

/// True when two rows are about as deep.
pub fn are_alike(one: &Row, two: &Row) -> bool {
    (one.depth() - two.depth()).abs() <= as_deep(one.depth())
}

/// Rows that differ from one so deep by no more are as deep, metres.
pub fn as_deep(depth: f64) -> f64 {
    ALIKE.0.max(ALIKE.1 * depth)
}

/// True when the middle of one of two rows lies in the other.
fn overlap(views: &[Turned], one: &Row, two: &Row) -> bool {
    one.holds(views, two.middle(views)) || two.holds(views, one.middle(views))
}

/// Pairs of lines between which something stands, with floor before it.
fn candidates(view: &Turned, fronts: Fronts, recall: &Recall, threads: usize) -> Vec<Row> {
    let columns = |metres: f64| (metres / view.cell).round() as usize;
    let least = columns(OBLONG.0);
    let long = |touched: &Bits| {
        let mut runs = touched.joined(0..view.size[0], columns(GAP));
        runs.retain(|run| run.len() >= least);
        runs
    };
    let runs: Vec<Vec<Range<usize>>> = view.touched.iter().map(long).collect();
    let above = |n: usize| {
        let (low, mut found) = (view.offsets[n], Vec::new());
        for (m, &high) in view.offsets.iter().enumerate().skip(n + 1) {
            if high - low > DEPTH.1 {
                break;
            }
            if high - low < THINNEST {
                continue;
            }
            let shared = runs[n].iter().flat_map(|run| {
                let first = runs[m].partition_point(|other| other.end < run.start + least);
                let ahead = runs[m][first..].iter().take_while(|other| other.start + least <= run.end);
                let shared = ahead.map(|other| run.start.max(other.start)..run.end.min(other.end));
                shared.filter(|shared| shared.start + least <= shared.end)
            });
            let mut shared = shared.peekable();
            if shared.peek().is_none() {
                continue;
            }
            let key = || fronts.into_iter().map(u64::from).fold(view.key([low, high], FRONT[1]), Key::with);
            found.extend(
                recall
                    .blocks
                    .or_find(key, || shared.flat_map(|shared| standing(view, [n, m], fronts, shared)).collect()),
            );
        }
        found
    };
    flat_map_each(view.offsets.len(), threads, above)
}

/// Of a range of columns between two lines, the pieces that stand free.
fn standing(view: &Turned, lines: [usize; 2], fronts: Fronts, range: Range<usize>) -> Vec<Row> {
    let columns = |metres: f64| (metres / view.cell).round() as usize;
    let across = lines.map(|line| view.offsets[line]);
    let depth = across[1] - across[0];
    let from = range.start;
    let below = view.some_blocked(range.clone(), across[0] - FRONT[1], across[0] - FRONT[0]);
    let above = view.some_blocked(range, across[1] + FRONT[0], across[1] + FRONT[1]);
    let free: Vec<bool> =
        below.iter().zip(&above).map(|(a, b)| (*a < FLOOR || !fronts[0]) && (*b < FLOOR || !fronts[1])).collect();
    let share = |flags: &[bool]| flags.iter().filter(|flag| **flag).count() as f64 / flags.len() as f64;
    let touched =
        |line: usize, piece: &Range<usize>| view.touched[line].count(piece.clone()) as f64 / piece.len() as f64;
    let mut found = Vec::new();
    for (s, e) in closed(&free, columns(BEFORE)) {
        let piece = from + s..from + e;
        let length = piece.len() as f64 * view.cell;
        if length < OBLONG.0.max(OBLONG.1 * depth)
            || share(&free[s..e]) < STANDS
            || lines.iter().any(|&line| touched(line, &piece) < SEEN)
        {
            continue;
        }
        let reach = END.map(columns);
        let width = view.size[0];
        let before = piece.start.saturating_sub(reach[1])..piece.start.saturating_sub(reach[0]);
        let after = (piece.end + reach[0]).min(width)..(piece.end + reach[1]).min(width);
        let mut ends = [before, after].map(|beyond| view.mean_blocked(beyond, across[0], across[1]));
        ends.sort_by(f64::total_cmp);
        let is_open = ends[0] < ENDS[0] && (ends[1] < ENDS[0] || ends[1] > ENDS[1]);
        let along = [view.along(piece.start), view.along(piece.end)];
        let row = Row { direction: view.direction, along, across, between: None };
        let taken = inner(view, &row);
        // What is thin and shows nothing of its inside is a wall, where it does not stand by itself.
        let is_wall = taken > SHELL && (depth < WALL[0] || depth < WALL[1] && ends[1] > ENDS[0]);
        if (taken >= TAKEN || depth < LANE) && !is_wall && is_open && !has_lane(view, piece, across) {
            found.push(row);
        }
    }
    found
}

/// Share of a row, without its faces, that is taken.
fn inner(view: &Turned, row: &Row) -> f64 {
    let columns = view.column(row.along[0])..view.column(row.along[1]).max(view.column(row.along[0]) + 1);
    view.mean_blocked(columns, row.across[0] + FRONT[0], row.across[1] - FRONT[0])
}

/// True where one can go through all along.
fn has_lane(view: &Turned, piece: Range<usize>, across: [f64; 2]) -> bool {
    let steps = ((across[1] - across[0] - LANE) / view.cell).floor().max(-1.0);
    (0..(steps + 1.0) as usize).any(|n| {
        let low = across[0] + n as f64 * view.cell;
        let blocked = view.some_blocked(piece.clone(), low, low + LANE);
        let taken = blocked.iter().filter(|share| **share > 0.0).count();
        (taken as f64) < LANE_TAKEN * blocked.len() as f64
    })
}

/// Runs of what is true, closed over gaps: from, to.
fn closed(flags: &[bool], gap: usize) -> Vec<(usize, usize)> {
    let mut flags = flags.to_vec();
    close(&mut flags, gap);
    runs(&flags, true)
}
