//! Ways through several rows: where all of them are free at one place, which chance would not make.
//!
//! A row of empty bays looks like a way, but rows side by side have their empty bays anywhere. How likely so many are
//! free at one place is told by how much of all of them is free elsewhere.

use super::beside::Beside;
use super::corridors::{Strip, UNTOLD};
use super::gates;
use super::rows::{DEPTH, Row};
use super::sections::{Columns, WIDTH};
use super::turned::Turned;
use super::whole;
use super::widths::Widths;
use crate::ends::{overlap, shared, sorted, wider};
use std::collections::{BTreeMap, BTreeSet};

/// A row and what stands in it.
pub struct Seen<'a> {
    /// With what lies between its ends and the walls beyond them.
    pub row: &'a Row,
    /// Where it begins and ends, along.
    pub own: [f64; 2],
    pub columns: Columns<'a>,
    /// Of the direction that it runs along, and of the one that crosses it.
    pub views: [&'a Turned; 2],
    /// The two corridors beside it, and the places across of their middles.
    pub between: [usize; 2],
    pub middles: [f64; 2],
}

/// What is open in some rows, one beside another.
#[derive(Clone)]
struct Common {
    /// From where to where, across the direction that crosses the rows.
    ends: [f64; 2],
    rows: Vec<usize>,
    /// How likely it is that all of them are open there.
    chance: f64,
}

impl Common {
    fn width(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}

/// A stretch that ends between cells is so much longer than what is open of it, metres.
pub const BETWEEN_CELLS: f64 = 0.1;
/// An opening so much shorter than another is as long, metres.
const SLACK: f64 = 0.25;
/// What is likelier than this is no way, whatever else is one.
const LIKELY: f64 = 0.3;
/// A row goes on up to a wall that is so near to its end, metres.
const NEAR: f64 = 0.3;
/// What stands so near to a corridor's side, metres, or so far behind it as racks at walls are deep, over so much of a place
/// bounds that.
const BESIDE: f64 = 0.3;
const OUTWARDS: f64 = 2.0;
const BOUNDED: f64 = 0.8;
/// Widths are counted in such steps, metres.
const STEP: f64 = 0.1;
/// What crosses all rows of a place is a way when it is as wide as other ways and less likely than this by chance; when
/// none is known; and when it has another width than those. Past the ends of all rows there are ways in most halls, and
/// LIKELY is enough.
const ALIKE: f64 = 0.05;
const FIRST: f64 = 0.01;
const OTHER: f64 = 0.005;
/// The same where there are more rows at that place, as of those that lie side by side there are many, and where it has
/// another width than those and a bay's.
const SOME: f64 = 0.0005;

/// The rows of a place, and where each is open.
pub struct Through<'a> {
    rows: Vec<Seen<'a>>,
    /// For each row, across the direction that crosses it.
    open: Vec<Vec<[f64; 2]>>,
    /// For each row those above it and below it, with which it shares a corridor.
    above: Vec<Vec<usize>>,
    below: Vec<Vec<usize>>,
    /// Which of the rows are walls between halls.
    walls: Vec<bool>,
    /// For each row, which of its ends are at a wall, when that is known.
    walled: Vec<[bool; 2]>,
    /// For each direction and each width in steps, how many places of its rows are open, and of how many.
    all: Vec<Vec<[f64; 2]>>,
}

impl<'a> Through<'a> {
    pub fn new(views: &[Turned], rows: Vec<Seen<'a>>) -> Self {
        let open: Vec<_> = rows.iter().map(Seen::open).collect();
        // A corridor is of one direction, and so are the rows beside it.
        let mut beside: BTreeMap<usize, [Vec<usize>; 2]> = BTreeMap::new();
        for (n, Seen { between: [below, above], .. }) in rows.iter().enumerate() {
            beside.entry(*above).or_default()[0].push(n);
            beside.entry(*below).or_default()[1].push(n);
        }
        let next = |side: usize| rows.iter().map(|row| beside[&row.between[side]][side].clone()).collect();
        let (below, above) = (next(0), next(1));
        let walls = whole::are_between_halls(views, &rows.iter().map(|seen| seen.row).collect::<Vec<_>>());
        let all = vec![Vec::new(); views.len()];
        let mut made = Self { rows, open, above, below, walls, walled: Vec::new(), all };
        made.count();
        made
    }

    /// The ways, where those of known widths are, each through one row after another.
    pub fn find(mut self, strips: &[Strip], widths: &mut [Widths]) -> Vec<Strip> {
        self.walled = self.rows.iter().map(|seen| [0, 1].map(|side| seen.is_at_wall(strips, side))).collect();
        let mut left = Vec::new();
        for (n, open) in self.open.iter().enumerate() {
            for &ends in open {
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
                if self.is_way(common, widths) && !is_taken(&taken, common) {
                    common.rows.iter().for_each(|&row| taken[row].push(common.ends));
                    ways.push(common.clone());
                }
            }
            if ways.len() == known {
                return ways
                    .iter()
                    .flat_map(|way| way.rows.iter().map(|&n| self.rows[n].way(self.rows[n].stretch(way.ends))))
                    .collect();
            }
            for way in &ways[known..] {
                let first = &self.rows[way.rows[0]];
                // What passes the ends is as wide as the hall leaves: if that is a bay's width it tells no others.
                if !(first.is_as_bays(way.ends) && self.is_past_ends(way)) {
                    widths[first.views[1].direction].add(way.width() + BETWEEN_CELLS);
                }
                self.take(way);
            }
            self.count();
            left.retain(|common| !is_taken(&taken, common));
            for common in &mut left {
                common.chance = self.chance(&common.rows, common.ends);
            }
        }
    }

    /// The ways between the last of a row and a wall that ends it and the corridors beside it, and whether each is doubtful:
    /// where all rows beside one another end in line there, for else more rows tell by one another what is a way.
    pub fn at_walls(&self, strips: &[Strip], placed: &[Beside]) -> Vec<(Strip, bool)> {
        let at_wall = |seen: &Seen, side: usize| {
            let (ends, is_doubtful) = seen.columns.way_at_end(side)?;
            seen.is_at_wall(strips, side).then(|| (seen.way(ends), seen.is_bounded(strips, ends), is_doubtful))
        };
        let mut found = Vec::new();
        for side in [0, 1] {
            let ways: Vec<_> = self.rows.iter().map(|seen| at_wall(seen, side)).collect();
            for (n, at_wall) in ways.iter().enumerate() {
                let Some((way, _, is_doubtful)) = at_wall else { continue };
                let beside = self.beside(n, way.middle());
                let is_in_line = |m: &usize| {
                    let is_so = |end: usize, other: &Strip| (other.across[end] - way.across[end]).abs() <= SLACK;
                    ways[*m].as_ref().is_some_and(|(other, ..)| is_so(0, other) && is_so(1, other))
                };
                let is_bounded = |m: &usize| ways[*m].as_ref().is_some_and(|(_, is_bounded, _)| *is_bounded);
                if beside.iter().all(is_in_line)
                    && beside.iter().any(is_bounded)
                    && self.are_all(&beside, strips, placed)
                {
                    found.push((way.clone(), *is_doubtful));
                }
            }
        }
        found
    }

    /// What lies between the racks of rows that no other row is beside, from aisle to aisle, and how far from post to post.
    pub fn of_rows_alone(&self) -> Vec<(Strip, Option<f64>)> {
        let alone = (0..self.rows.len()).filter(|&n| self.above[n].is_empty() && self.below[n].is_empty());
        let gates = alone.map(|n| &self.rows[n]).flat_map(|seen| {
            let gates = seen.columns.between_racks().into_iter().filter_map(|way| seen.gate(way));
            gates.map(|gate| (gate, seen.views[0].pitch))
        });
        gates.collect()
    }

    /// A row and those beside it, one beside another, that reach up to a place across the direction that crosses them.
    fn beside(&self, row: usize, place: f64) -> BTreeSet<usize> {
        let (mut found, mut next) = (BTreeSet::from([row]), vec![row]);
        while let Some(n) = next.pop() {
            let beside = self.above[n].iter().chain(&self.below[n]).copied();
            next.extend(beside.filter(|&m| !self.walls[m] && self.rows[m].holds(place) && found.insert(m)));
        }
        found
    }

    /// True when no corridor runs beside some rows but those between which they are known, no further off than a row is deep,
    /// and those behind a wall.
    fn are_all(&self, rows: &BTreeSet<usize>, strips: &[Strip], placed: &[Beside]) -> bool {
        let walls = rows.iter().flat_map(|&n| self.above[n].iter().chain(&self.below[n])).filter(|&&m| self.walls[m]);
        let known: BTreeSet<usize> = rows.iter().chain(walls).flat_map(|&n| self.rows[n].between).collect();
        rows.iter().all(|&n| self.rows[n].corridors_beside(strips, placed).iter().all(|strip| known.contains(strip)))
    }

    /// What of a stretch that is open in some rows goes on through the next ones.
    fn follow(&self, rows: &mut Vec<usize>, ends: [f64; 2], found: &mut Vec<Common>) {
        let last = rows[rows.len() - 1];
        if rows.len() > 1 && ends[1] - ends[0] <= WIDTH.1 {
            let chance = self.chance(rows, ends);
            if chance <= LIKELY {
                found.push(Common { ends, rows: rows.clone(), chance });
            }
        }
        for &next in &self.above[last] {
            for open in &self.open[next] {
                let both = shared(ends, *open);
                if both[1] - both[0] >= WIDTH.0 {
                    rows.push(next);
                    self.follow(rows, both, found);
                    rows.pop();
                }
            }
        }
    }

    /// Takes a way from what is open in its rows.
    fn take(&mut self, way: &Common) {
        let [from, to] = way.ends;
        for &n in &way.rows {
            let cut = self.open[n].iter().flat_map(|&[a, b]| [[a, b.min(from)], [a.max(to), b]]);
            self.open[n] = cut.filter(|[a, b]| a < b).collect();
        }
    }

    /// Counts the places of all rows anew.
    fn count(&mut self) {
        self.all = (0..self.all.len()).map(|direction| self.counts_of_all(direction)).collect();
    }

    /// How likely it is that some rows are open at one place, by how much of each, and of all, is so elsewhere: of each
    /// where not all others are open, for of several ways none speaks against another.
    fn chance(&self, rows: &[usize], ends: [f64; 2]) -> f64 {
        let width = ends[1] - ends[0];
        let [free, places] = self.all[self.rows[rows[0]].row.direction][(width / STEP) as usize];
        let all = self.open_in_all(rows, width);
        let others = rows.iter().map(|n| {
            let others: Vec<usize> = rows.iter().copied().filter(|m| m != n).collect();
            self.open_in_all(&others, width)
        });
        let others: Vec<f64> = others.collect();
        let (own, left) = (rows.len() as f64 * all, others.iter().sum::<f64>());
        let common = ((free - own).max(0.0) + 0.5) / ((places - left).max(0.0) + 1.0);
        let chance = |(&n, others): (&usize, &f64)| {
            let [free, places] = self.counts(n, width);
            common.max(((free - all).max(0.0) / (places - others).max(1.0)).min(1.0))
        };
        rows.iter().zip(&others).map(chance).product()
    }

    /// How many places as wide are open in each of some rows: one at least, which is being asked of.
    fn open_in_all(&self, rows: &[usize], width: f64) -> f64 {
        let first = rows.first().map(|&n| self.open[n].clone()).unwrap_or_default();
        let common = rows.iter().skip(1).fold(first, |common, &n| {
            let both = common.iter().flat_map(|&one| self.open[n].iter().map(move |&two| shared(one, two)));
            both.filter(|[from, to]| from < to).collect()
        });
        as_wide(&common, width).max(1.0)
    }

    /// How many places as wide of a row are open, and how many it has.
    fn counts(&self, n: usize, width: f64) -> [f64; 2] {
        [as_wide(&self.open[n], width), self.rows[n].row.length() / width]
    }

    fn counts_of_all(&self, direction: usize) -> Vec<[f64; 2]> {
        let rows: Vec<_> = (0..self.rows.len()).filter(|&n| self.rows[n].row.direction == direction).collect();
        let of_width = |step: usize| {
            let counts = rows.iter().map(|&n| self.counts(n, (step as f64 * STEP).max(WIDTH.0)));
            counts.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]])
        };
        (0..=(WIDTH.1 / STEP) as usize).map(of_width).collect()
    }

    fn is_way(&self, common: &Common, widths: &[Widths]) -> bool {
        let [view, other] = self.rows[common.rows[0]].views;
        let known = &widths[other.direction];
        let limit = match (self.is_whole(common), known.have(common.width() + BETWEEN_CELLS, view.pitch)) {
            (false, _) => SOME,
            (true, _) if self.is_past_ends(common) => LIKELY,
            (true, true) => ALIKE,
            (true, false) if known.is_empty() => FIRST,
            (true, false) if self.rows[common.rows[0]].is_as_bays(common.ends) => SOME,
            (true, false) => OTHER,
        };
        common.chance < limit
    }

    /// True when it lies between the ends of all its rows, which are in line, and a wall that ends them.
    fn is_past_ends(&self, common: &Common) -> bool {
        let is_last = |n: usize, side: usize| {
            let seen = &self.rows[n];
            let ends = seen.stretch(common.ends);
            let open = self.open[n].iter().map(|&open| seen.stretch(open)).find(|&open| overlap(open, ends) > 0.0);
            self.walled[n][side]
                && (ends[side] - seen.row.along[side]).abs() <= SLACK
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

/// How many places of a width there are in some stretches.
fn as_wide(open: &[[f64; 2]], width: f64) -> f64 {
    open.iter().map(|[from, to]| ((to - from) / (width - SLACK)).floor()).sum()
}

impl Seen<'_> {
    fn middle(&self) -> f64 {
        f64::midpoint(self.row.across[0], self.row.across[1])
    }

    /// Where nothing stands in it, across the direction that crosses it.
    fn open(&self) -> Vec<[f64; 2]> {
        let [view, other] = self.views;
        let place = |u: f64| other.place(view.to_map([u, self.middle()]))[1];
        self.columns.open().into_iter().map(|ends| sorted(ends.map(place))).collect()
    }

    /// The place along it where something crosses it.
    fn along(&self, across: f64) -> f64 {
        let [view, other] = self.views;
        view.crossing(other, self.middle(), across)[1]
    }

    /// From where to where along it something crosses it.
    fn stretch(&self, across: [f64; 2]) -> [f64; 2] {
        sorted(across.map(|end| self.along(end)))
    }

    /// True when a stretch is as wide as a bay, or as some beside one another.
    fn is_as_bays(&self, ends: [f64; 2]) -> bool {
        self.columns.is_as_bays(self.stretch(ends))
    }

    /// True when what lies there across the crossing direction crosses it.
    fn holds(&self, across: f64) -> bool {
        (self.row.along[0]..=self.row.along[1]).contains(&self.along(across))
    }

    /// True when a wall ends the row and the corridors beside it, but for what leads on through a gate.
    fn is_at_wall(&self, strips: &[Strip], side: usize) -> bool {
        let (view, end) = (self.views[0], self.row.along[side]);
        let beyond = if side == 0 { [end - NEAR, end] } else { [end, end + NEAR] };
        gates::walled(view, strips, self.row, self.between, view.column(beyond[0])..view.column(beyond[1]) + 1).any()
    }

    /// The corridors that run along it no further off than a row is deep.
    fn corridors_beside(&self, strips: &[Strip], placed: &[Beside]) -> Vec<usize> {
        let [below, above] = self.between;
        let beside = wider([strips[below].across[0], strips[above].across[1]], DEPTH.1);
        let mut found = placed[self.row.direction].touching(self.row.along, beside);
        found.retain(|&n| overlap(strips[n].along, self.row.along) > 0.0 && overlap(strips[n].across, beside) > 0.0);
        found
    }

    /// True when one of the two corridors leads to a place beyond the row, or a wall goes on along its far side: else that
    /// is open floor.
    fn is_bounded(&self, strips: &[Strip], ends: [f64; 2]) -> bool {
        let (view, middle) = (self.views[0], f64::midpoint(ends[0], ends[1]));
        let columns = view.column(ends[0])..view.column(ends[1]);
        let is_held = |low: f64, high: f64| {
            let held = view.blocked_where(columns.clone(), low, high, |share| share > 0.0);
            held.count(0..columns.len()) as f64 >= BOUNDED * columns.len() as f64
        };
        let leads = |n: usize| (strips[n].along[0]..=strips[n].along[1]).contains(&middle);
        let [below, above] = self.between;
        let [low, high] = [strips[below].across[0], strips[above].across[1]];
        [below, above].into_iter().any(leads)
            || is_held(low - OUTWARDS, low + BESIDE)
            || is_held(high - BESIDE, high + OUTWARDS)
    }

    /// A way through it, from where to where along, that lies between its own ends.
    pub fn gate(&self, ends: [f64; 2]) -> Option<Strip> {
        let is_within = self.own[0] < ends[0] && ends[1] < self.own[1];
        is_within.then(|| self.way(ends))
    }

    /// A way through it, from where to where along, as a strip of the direction that crosses it, from the middle of one
    /// corridor to that of the other.
    fn way(&self, [from, to]: [f64; 2]) -> Strip {
        let [view, other] = self.views;
        let sin = libm::sin(other.angle - view.angle);
        let v = self.middle();
        let [s, t] = other.place(view.to_map([f64::midpoint(from, to), v]));
        let width = (to - from) * sin.abs();
        let ends = self.middles.map(|middle| s + (middle - v) / sin);
        Strip {
            direction: other.direction,
            along: sorted(ends),
            across: [t - width / 2.0, t + width / 2.0],
            score: self.row.depth(),
            bays: false,
            is_ragged: false,
            unseen: [false; 2],
            held: UNTOLD,
        }
    }
}
