//! Ways along a strip whose sides are no lines.
//!
//! A strip is asked column by column for its clear extent. Where that is all of the strip, and ends on both sides
//! within a share of its width beyond, the column speaks for a way along it, wherever in there the side may stand. A
//! long way that nothing narrows needs no more of a side than machines or pallets in a row, with gaps between them.

use super::barriers;
use crate::bits::Bits;
use crate::labels::corridors::{Strip, UNTOLD};
use crate::labels::view::runs::best_pieces;
use crate::labels::view::shares::{IMPASSABLE, Shares};
use crate::labels::view::sums::What;
use crate::labels::view::turned::Turned;
use std::cell::OnceCell;
use std::ops::Range;

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
/// What may lie over empty bays, from row to row, is held on both sides over so much of it.
const LEAST_BOTH_BAY: f64 = 0.8;
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

    /// How many cells a side of a way of a width has at least in which something stands, and how many columns along lines.
    pub fn fewest(self, view: &Turned, width: f64) -> [f64; 2] {
        // A column less, for what floats round.
        let shortest = self.shortest(width) / view.cell - 1.0;
        [LEAST_SEEN * shortest, if self == Self::Thin { LEAST_FACED * shortest } else { 0.0 }]
    }

    /// Least share of a way's columns that are clear.
    fn least_clear(self) -> f64 {
        if self == Self::Thin { LEAST_CLEAR_THIN } else { LEAST_CLEAR }
    }
}

/// A way, what holds its sides, and whether walls at its ends have cut it.
pub type Found = (Strip, Held, bool);

/// Where a strip lies across, and the rows of cells there.
#[derive(Clone, Copy)]
pub struct Borders {
    pub across: [f64; 2],
    /// From which row on its lower side may stand, those of its own borders, and up to which its upper side may.
    rows: [usize; 4],
}

impl Borders {
    pub fn new(view: &Turned, across: [f64; 2]) -> Self {
        let [[below, low], [high, above]] = beyond(across);
        let mut rows = [below, low, high, above].map(|v| view.border_across(v));
        for n in 1..rows.len() {
            rows[n] = rows[n].max(rows[n - 1]);
        }
        Self { across, rows }
    }

    /// The rows of cells in it.
    fn inside(&self) -> Range<usize> {
        self.rows[1]..self.rows[2]
    }

    /// Those in which its sides may stand.
    pub fn sides(&self) -> [Range<usize>; 2] {
        let [below, low, high, above] = self.rows;
        [below..low, high..above]
    }
}

/// A strip, asked column by column.
pub struct Candidate<'a> {
    view: &'a Turned,
    across: [f64; 2],
    /// It may be a row of empty bays.
    bay: bool,
    asked: Asked<'a>,
}

/// What is asked of the columns of one strip, or of what several have in common.
struct Asked<'a> {
    view: &'a Turned,
    /// How wide each is, metres.
    width: f64,
    /// From where to where across each side may stand.
    beyond: [[f64; 2]; 2],
    /// The rows of cells there.
    sides: [Range<usize>; 2],
    /// The least of them that any of the strips has there.
    deep: [u32; 2],
    blocked: Shares<'a>,
    /// Of blocked samples, the least for which nothing gets through.
    closed: u32,
}

/// Columns of a strip one after another that are not closed, a bit for each: what is asked of them whatever holds the
/// sides is asked once.
struct Stretch {
    columns: Range<usize>,
    unclear: Bits,
    /// Beyond which side much is not free.
    deep: [OnceCell<Bits>; 2],
}

impl Stretch {
    fn all(&self) -> Range<usize> {
        0..self.columns.len()
    }
}

/// What the columns of a stretch are to a way along the strip.
struct Columns {
    held: [Bits; 2],
    both: Bits,
    scores: Vec<i64>,
}

impl<'a> Asked<'a> {
    fn new(view: &'a Turned, borders: &Borders) -> Self {
        let across = borders.across;
        let blocked = view.shares_of(What::Blocked, borders.inside());
        let closed = blocked.least(|share| share > IMPASSABLE);
        let sides = borders.sides();
        let deep = sides.each_ref().map(|rows| rows.len() as u32);
        Self { view, width: across[1] - across[0], beyond: beyond(across), sides, deep, blocked, closed }
    }

    /// Several of one width, the lowest first: what they have in common, between sides that may stand wherever one's may.
    /// Of its columns at least as much speaks for a way as of any one's.
    fn common(view: &'a Turned, all: &[Borders]) -> Option<Self> {
        let (first, last) = (all.first()?, all.last()?);
        let most = all.iter().map(|own| own.inside().len()).max()? as u32;
        let (from, to) = (last.inside().start, first.inside().end);
        let blocked = view.shares_of(What::Blocked, from..to.max(from)).of_cells(most);
        let closed = blocked.least(|share| share > IMPASSABLE);
        let least = |side: usize| all.iter().map(|own| own.sides()[side].len() as u32).min();
        let deep = [least(0)?, least(1)?];
        let both = [first, last].map(|own| beyond(own.across));
        let beyond = [0, 1].map(|side| [both[0][side][0], both[1][side][1]]);
        let both = [first, last].map(Borders::sides);
        let sides = [0, 1].map(|side| both[0][side].start..both[1][side].end);
        let width = all.iter().map(|own| own.across[1] - own.across[0]).fold(f64::INFINITY, f64::min);
        Some(Self { view, width, beyond, sides, deep, blocked, closed })
    }

    /// In which columns of a stretch each side holds, and both do, where so many of them may be a way.
    fn sides(&self, stretch: &Stretch, by: Held, least: usize) -> Option<([Bits; 2], Bits)> {
        let all = stretch.all();
        let enough = |count: usize, share: f64| count as f64 >= share * least as f64;
        if !enough(all.len() - stretch.unclear.count(all.clone()), by.least_clear()) {
            return None;
        }
        // Sides that are thin need lines along them, of which mostly there are none: these are counted soonest.
        if by == Held::Thin && self.beyond.iter().any(|side| !self.may_face(stretch, *side, least)) {
            return None;
        }
        let low = self.held(stretch, by, 0);
        if !enough(low.count(all.clone()), LEAST_HELD) {
            return None;
        }
        let held = [low, self.held(stretch, by, 1)];
        let both = &held[0] & &held[1];
        enough(both.count(all), LEAST_BOTH).then_some((held, both))
    }

    /// What the columns of a stretch are, where so many of them may be a way.
    fn columns(&self, stretch: &Stretch, by: Held, least: usize) -> Option<Columns> {
        let (held, both) = self.sides(stretch, by, least)?;
        let cluttered = self.blocked.least(|share| share > CLUTTERED);
        let cluttered = self.blocked.reached(stretch.columns.clone(), cluttered);
        let score = |n: usize| match (!stretch.unclear.get(n), [held[0].get(n), held[1].get(n)]) {
            _ if cluttered.get(n) => -BLOCKED,
            (false, _) if by == Held::Thin => -BLOCKED,
            (true, [true, true]) => FULL,
            (false, [true, true]) => NARROWED,
            (_, [false, false]) => -OPEN,
            _ => ONE_SIDED,
        };
        let scores = stretch.all().map(score).collect();
        Some(Columns { held, both, scores })
    }

    /// True when so many columns of a stretch may hold a way that has structure along lines on a side.
    fn may_face(&self, stretch: &Stretch, [low, high]: [f64; 2], least: usize) -> bool {
        let lines = &self.view.covered[self.view.lines(low, high)];
        let most: usize = lines.iter().map(|line| line.count(stretch.columns.clone())).sum();
        most as f64 / least as f64 >= LEAST_FACED
    }

    /// In which columns of a stretch a side holds.
    fn held(&self, stretch: &Stretch, by: Held, side: usize) -> Bits {
        let rows = || self.sides[side].clone();
        let columns = || stretch.columns.clone();
        let deep = || {
            let of = self.view.shares_of(What::Blocked, rows()).of_cells(self.deep[side]);
            of.reached(columns(), of.least(|share| share >= HELD))
        };
        let mut held = stretch.deep[side].get_or_init(deep).clone();
        if by == Held::Thin {
            held |= &self.view.shares_of(What::Occupied, rows()).reached(columns(), 1);
            held.close(stretch.all(), (GAP / self.view.cell) as usize);
        }
        held
    }

    /// The stretches of so many columns at least that are not closed, among some columns.
    fn stretches(&self, within: Range<usize>, least: usize, rivals: &[Range<usize>]) -> Vec<Stretch> {
        let open = self.blocked.open(within, least, self.closed, rivals);
        let unclear = self.blocked.least(|share| share > CLEAR);
        let stretch = |columns: Range<usize>| {
            let unclear = self.blocked.reached(columns.clone(), unclear);
            Stretch { columns, unclear, deep: Default::default() }
        };
        open.into_iter().map(stretch).collect()
    }

    /// Columns of the shortest way along it.
    fn least(&self, by: Held) -> usize {
        ((by.shortest(self.width) / self.view.cell) as usize).max(1)
    }
}

impl<'a> Candidate<'a> {
    /// What is no wider than `bay`, metres, may be a row of them.
    pub fn new(view: &'a Turned, across: [f64; 2], bay: f64) -> Self {
        Self { view, across, bay: may_be_bay(across, bay), asked: Asked::new(view, &Borders::new(view, across)) }
    }

    /// False when none of several strips of one width, the lowest first, is a way.
    pub fn may_be(view: &'a Turned, all: &[Borders], by: &[Held]) -> bool {
        let Some(common) = Asked::common(view, all) else { return false };
        let least = by.iter().map(|&by| common.least(by)).min().unwrap_or(1);
        let stretches = common.stretches(0..view.size[0], least, &[]);
        let holds = |by: Held| {
            let least = common.least(by);
            let mut long = stretches.iter().filter(|stretch| stretch.columns.len() >= least);
            long.any(|stretch| common.sides(stretch, by, least).is_some())
        };
        by.iter().any(|&by| holds(by))
    }

    /// The columns around a way along it up to where it is closed: beyond nothing bears on what lies there.
    pub fn around(&self, way: &Strip) -> Range<usize> {
        let [first, last] = way.along.map(|u| self.view.column(u));
        let from = self.asked.blocked.last(0..first, self.asked.closed).map_or(0, |c| c + 1);
        from..self.asked.blocked.first(last..self.view.size[0], self.asked.closed).unwrap_or(self.view.size[0])
    }

    /// The ways along it, of what may hold their sides.
    pub fn ways(&self, by: &[Held]) -> Vec<Found> {
        // Where a short way fits, a long one may.
        let least = by.iter().map(|&by| self.asked.least(by)).min().unwrap_or(1);
        let stretches = self.asked.stretches(0..self.view.size[0], least, &[]);
        let found = |by: Held| self.ways_in(by, &stretches).into_iter().map(move |(way, is_cut)| (way, by, is_cut));
        by.iter().copied().flat_map(found).collect()
    }

    /// The ways along it that rivals leave, among some columns.
    pub fn ways_left(&self, by: Held, within: Range<usize>, rivals: &[&Strip]) -> Vec<(Strip, bool)> {
        let view = self.view;
        let rivals: Vec<Range<usize>> = rivals.iter().map(|rival| view.columns(rival.along)).collect();
        self.ways_in(by, &self.asked.stretches(within, self.asked.least(by), &rivals))
    }

    /// The ways along it in stretches that are not closed, and which of them walls at their ends have cut.
    fn ways_in(&self, by: Held, stretches: &[Stretch]) -> Vec<(Strip, bool)> {
        let view = self.view;
        let width = self.across[1] - self.across[0];
        let least = self.asked.least(by);
        let mut ways = Vec::new();
        for stretch in stretches.iter().filter(|stretch| stretch.columns.len() >= least) {
            let Some(columns) = self.asked.columns(stretch, by, least) else { continue };
            let pieces = best_pieces(&columns.scores).into_iter().filter(|(from, to)| to - from >= least);
            for piece in pieces.map(|(from, to)| from..to).filter(|piece| self.is_way(stretch, &columns, by, piece)) {
                let Some(left) = self.between_walls(stretch, &columns, by, piece.clone()) else { continue };
                let along = [left.start, left.end].map(|column| view.along(stretch.columns.start + column));
                let score = columns.scores[left.clone()].iter().sum::<i64>() as f64 / FULL as f64 * view.cell * width;
                ways.push((ragged(view, along, self.across, score), left != piece));
            }
        }
        ways
    }

    /// What walls across a way, or askew to it, leave of it. Nearer than it is wide to its end they end it; what goes on
    /// behind one leads through a door, and parts of rooms are no way.
    fn between_walls(
        &self,
        stretch: &Stretch,
        columns: &Columns,
        by: Held,
        range: Range<usize>,
    ) -> Option<Range<usize>> {
        let (view, first) = (self.view, stretch.columns.start);
        let on_map = first + range.start..first + range.end;
        let mut walls = barriers::across(view, self.across, on_map.clone());
        walls |= &barriers::doors(view, beyond(self.across), on_map.clone());
        let near = ((self.across[1] - self.across[0]) / view.cell) as usize;
        let inner = near..range.len().saturating_sub(near);
        let ends = |walls: &Bits| inner.is_empty() && walls.any() || walls.count(inner.clone()) > 0;
        // What ends it already need not be asked where else it stops.
        if ends(&walls) {
            return None;
        }
        for stop in barriers::stops(view, self.across, on_map) {
            walls.insert(stop - first - range.start);
        }
        if !walls.any() {
            return Some(range);
        }
        if ends(&walls) {
            return None;
        }
        let from = walls.runs(0..inner.start, true).last().map_or(0, |run| run.end);
        let to = walls.runs(inner.end..range.len(), true).next().map_or(range.len(), |run| run.start);
        let left = range.start + from..range.start + to;
        let is_way = left.len() >= self.asked.least(by)
            && self.is_way(stretch, columns, by, &left)
            && !barriers::among(view, self.across, first + left.start..first + left.end).any();
        is_way.then_some(left)
    }

    fn is_way(&self, stretch: &Stretch, columns: &Columns, by: Held, range: &Range<usize>) -> bool {
        let (view, sides) = (self.view, beyond(self.across));
        let length = range.len() as f64;
        let share = |flags: &Bits| flags.count(range.clone()) as f64 / length;
        let first = stretch.columns.start;
        let on_map = first + range.start..first + range.end;
        let seen = |[low, high]: [f64; 2]| {
            let of = view.occupied_in(low, high);
            let seen = of.reached(on_map.clone(), of.least(|share| share > 0.0));
            seen.count(0..range.len()) as f64 / length
        };
        let faced = |[low, high]: [f64; 2]| {
            let mut faced = Bits::new(view.size[0]);
            view.covered[view.lines(low, high)].iter().for_each(|line| faced |= line);
            faced.count(on_map.clone()) as f64 / length
        };
        let clear = (range.len() - stretch.unclear.count(range.clone())) as f64 / length;
        clear >= by.least_clear()
            && columns.held.iter().all(|held| share(held) >= LEAST_HELD)
            && share(&columns.both) >= if by == Held::Thin && self.bay { LEAST_BOTH_BAY } else { LEAST_BOTH }
            && sides.into_iter().all(|side| seen(side) >= LEAST_SEEN)
            && (by == Held::Deep || sides.into_iter().all(|side| faced(side) >= LEAST_FACED))
    }
}

/// A way whose sides are no lines.
pub fn ragged(view: &Turned, along: [f64; 2], across: [f64; 2], score: f64) -> Strip {
    Strip {
        direction: view.direction,
        along,
        across,
        score,
        bays: false,
        is_ragged: true,
        stops: [false; 2],
        held: UNTOLD,
        found: UNTOLD,
    }
}

/// What is no wider than `bay`, metres, may be a row of empty bays.
pub fn may_be_bay(across: [f64; 2], bay: f64) -> bool {
    across[1] - across[0] <= bay
}

/// How far beyond a strip's borders its sides may stand, metres.
pub fn depth(across: [f64; 2]) -> f64 {
    DEPTH.1.max(DEPTH.0 * (across[1] - across[0]))
}

/// Where a strip's sides may stand, across.
pub fn beyond(across: [f64; 2]) -> [[f64; 2]; 2] {
    let depth = depth(across);
    [[across[0] - depth, across[0]], [across[1], across[1] + depth]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::directions::Directions;
    use crate::grid::{Frame, Grid, Table};
    use crate::labels::Scene;
    use crate::labels::recall::Recall;
    use crate::labels::view::look::Look;
    use crate::tiles::Tiles;

    /// An aisle of 2 m between goods that stand back from it by up to so many pixels, with gaps between them.
    fn aisle(back: usize) -> Vec<u8> {
        let mut pixels = vec![254; 400 * 200];
        for (n, from) in (0..400).step_by(16).enumerate() {
            let by = [3, 7, 1, 5, 2, 6].map(|k| k * n % (back + 1));
            for (low, high) in [(40, 80 - by[0]), (120 + by[1], 160)] {
                let length = 16 - by[2] % 4;
                (low..high).for_each(|y| pixels[y * 400 + from..][..length].fill(0));
            }
        }
        pixels
    }

    #[test]
    fn what_strips_have_in_common_rules_out_no_way_along_one_of_them() {
        let (table, recall) = (Table::trinary(), Recall::default());
        let directions = Directions { angles: vec![0.0], ..Directions::default() };
        for back in 0..12 {
            let pixels = aisle(back);
            let grid = Grid::new(&pixels, false, &table, Frame::new(400, 200, 0.05, [0.0; 3]));
            let scene = Scene { grid: &grid, directions: &directions, threads: 1, recall: &recall };
            let mut view = Turned::new(&scene, 0, &[]);
            view.see(&scene, &Look::new(&grid, &Tiles::new(&grid, 1)), None);
            let mut ways = 0;
            for (width, n) in [1.2, 1.6, 2.0].into_iter().flat_map(|width| (0..80).map(move |n| (width, n))) {
                let low = 2.0 + 0.05 * f64::from(n);
                let pair = [low, low + 0.1].map(|low| Borders::new(&view, [low, low + width]));
                let is_way =
                    |borders: &Borders| !Candidate::new(&view, borders.across, 0.0).ways(&[Held::Deep]).is_empty();
                if pair.iter().any(is_way) {
                    ways += 1;
                    assert!(Candidate::may_be(&view, &pair, &[Held::Deep]), "{width} m wide from {low} m, {back} back");
                }
            }
            assert!(ways > 0, "{back} back");
        }
    }
}
