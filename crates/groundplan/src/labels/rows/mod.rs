//! Rows: what lies between neighbouring corridors, or on one side of one, be it taken or not.
//!
//! A row is known by its two faces and cut where other corridors cross.

pub(super) mod at_walls;
pub(super) mod blocks;
pub(super) mod closing;
pub(super) mod faced;
pub(super) mod racks;
pub(super) mod sections;
pub(super) mod seen;
pub(super) mod shelves;
pub(super) mod stacked;
pub(super) mod whole;

use super::beside::{Beside, placed};
use super::corridors::{self, Strip};
use super::near::Near;
use super::view::turned::{Turned, least_sine};
use crate::ends::{holds, overlap, shared, wider};
use stacked::STACKED;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// A piece of a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Index of the direction that it runs along.
    pub direction: usize,
    /// Where it begins and ends, along.
    pub along: [f64; 2],
    /// Its two faces, across.
    pub across: [f64; 2],
    /// The corridors below and above it, where there are two.
    pub between: Option<[usize; 2]>,
}

impl Row {
    pub fn length(&self) -> f64 {
        self.along[1] - self.along[0]
    }

    pub fn depth(&self) -> f64 {
        self.across[1] - self.across[0]
    }

    /// No deeper than many a wall.
    pub fn is_shallow(&self) -> bool {
        self.depth() < DEPTH.0
    }

    /// True when it is a wall beside another, with the next hall behind it: that one is a row of racks, and it is not.
    pub fn is_wall_beside(&self, other: &Self) -> bool {
        self.is_shallow() && !other.is_shallow()
    }

    /// Its direction and its places, as [`placed`] takes them.
    pub fn place(&self) -> (usize, [f64; 2], [f64; 2]) {
        (self.direction, self.along, self.across)
    }

    /// Of the sides of what leads past one of its ends the one that lies before that end, or the end.
    pub fn inner(&self, [low, high]: [f64; 2]) -> f64 {
        if low <= self.along[0] || high < self.along[1] { high.min(self.along[1]) } else { low.max(self.along[0]) }
    }

    /// Its middle in the map frame.
    pub fn middle(&self, views: &[Turned]) -> [f64; 2] {
        let [u, v] = [self.along, self.across].map(|ends| f64::midpoint(ends[0], ends[1]));
        views[self.direction].to_map([u, v])
    }

    /// True when a point of the map frame lies in it.
    pub fn holds(&self, views: &[Turned], point: [f64; 2]) -> bool {
        let [u, v] = views[self.direction].place(point);
        holds(self.along, u) && holds(self.across, v)
    }
}

/// Two faces are this far apart, metres: less is a wall, more is a room.
pub const DEPTH: (f64, f64) = (0.5, 3.6);
/// Between two corridors what is so deep from edge to edge, which is a pixel less than it is, may be a row of shelves or
/// machines, metres, as others beside it are.
const SHALLOW: f64 = 0.24;
/// A row's piece is at least so long, metres.
pub const SHORTEST: f64 = 1.2;
/// The corridors along a rack are so many times as long as a gap in it.
const LONGER: f64 = 1.5;
/// So much of what is floor between racks may be taken, and so much of a row with no empty bays be floor.
const CLUTTER: f64 = 0.1;
const EMPTY: f64 = 0.1;
/// A way beside a rack is so many times as wide as what of its inside is free, and lies beside so much of that.
const WIDER: f64 = 1.7;
const ALONG: f64 = 0.7;
/// A beam is no deeper, metres; and in racks there are so many such lanes at least.
const BEAM: f64 = 0.24;
const LANES: usize = 2;
/// What runs along within a stacked row for less shows between its goods, metres, and is no way.
const WAY: f64 = 4.5;
/// Sides nearer than this are the same, metres.
pub const SAME: f64 = 0.3;

/// The lines on one side of a corridor that may be a row's other face, and how far from its own side, the nearest first.
pub fn lines_behind(view: &Turned, own: f64, side: usize) -> Vec<(f64, usize)> {
    let depth = |offset: f64| if side == 1 { offset - own } else { own - offset };
    let near = view.lines(own - 2.0 * DEPTH.1, own + 2.0 * DEPTH.1);
    let all = near.map(|line| (depth(view.offsets[line]), line));
    let mut lines: Vec<_> = all.filter(|(depth, _)| (DEPTH.0..=DEPTH.1).contains(depth)).collect();
    lines.sort_by(|a, b| a.0.total_cmp(&b.0));
    lines
}

/// What lies between neighbouring corridors, and may be a row, be it taken or not.
pub fn between(views: &[Turned], strips: &[Strip], extents: &[[f64; 2]]) -> Vec<Row> {
    Crossings::new(views, strips, extents).between()
}

/// The corridors of a place: those of one direction lie beside rows, and those of others cross them.
pub struct Crossings<'a> {
    views: &'a [Turned],
    strips: &'a [Strip],
    extents: &'a [[f64; 2]],
    near: Near,
    placed: Vec<Beside>,
    /// How far along a row a crossing one may reach beyond where its other side crosses it.
    reach: f64,
    /// Of stacked rows those alone count along which bays recur.
    with_bays: bool,
    /// Where stacked rows lie, by the corridors below and above them, once they are asked for.
    stacked: OnceLock<BTreeMap<[usize; 2], Vec<[f64; 2]>>>,
}

/// What lies behind one side of a corridor, up to another one.
struct Behind {
    /// That one.
    corridor: usize,
    /// How far off it is, metres.
    depth: f64,
    /// Where it is known to lie, along.
    along: Vec<[f64; 2]>,
}

impl<'a> Crossings<'a> {
    pub fn new(views: &'a [Turned], strips: &'a [Strip], extents: &'a [[f64; 2]]) -> Self {
        let polygons: Vec<_> =
            strips.iter().zip(extents).map(|(s, extent)| views[s.direction].rectangle(*extent, s.across)).collect();
        let widest = corridors::widest(strips);
        let placed = placed(views, strips.iter().zip(extents).map(|(s, extent)| (s.direction, *extent, s.across)));
        Self {
            views,
            strips,
            extents,
            near: Near::polygons(&polygons),
            placed,
            reach: widest / least_sine(views, f64::MIN_POSITIVE),
            with_bays: false,
            stacked: OnceLock::new(),
        }
    }

    /// The same where racks are asked for: of what is as deep as rooms that counts alone along which bays recur.
    pub fn of_racks(views: &'a [Turned], strips: &'a [Strip], extents: &'a [[f64; 2]]) -> Self {
        Self { with_bays: true, ..Self::new(views, strips, extents) }
    }

    /// What lies behind one side of a corridor and may be a row, the nearest first.
    fn behind(&self, n: usize, side: usize) -> Vec<Behind> {
        let mut found = self.others(n, side, [-SAME, DEPTH.1]);
        let stacked = self.stacked.get_or_init(|| self.stacked());
        found.extend(self.others(n, side, [DEPTH.1, STACKED]).into_iter().filter_map(|behind| {
            let pair = if side == 1 { [n, behind.corridor] } else { [behind.corridor, n] };
            stacked.get(&pair).map(|along| Behind { along: along.clone(), ..behind })
        }));
        found
    }

    /// The corridors on one side of a corridor that are further off than the one depth, and no further than the other, the nearest
    /// first.
    fn others(&self, n: usize, side: usize, [from, to]: [f64; 2]) -> Vec<Behind> {
        let own = &self.strips[n];
        let depth = |m: usize| {
            let other = &self.strips[m];
            if side == 1 { other.across[0] - own.across[1] } else { own.across[0] - other.across[1] }
        };
        let near = self.placed[own.direction].touching(self.extents[n], wider(own.across, to));
        let others = near.into_iter().filter(|&m| m != n && depth(m) > from && depth(m) <= to);
        let mut found: Vec<Behind> =
            others.map(|m| Behind { corridor: m, depth: depth(m), along: vec![self.extents[m]] }).collect();
        found.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        found
    }

    /// What of one side of a corridor no row between corridors may lie along.
    pub fn open(&self, n: usize, side: usize) -> Vec<(f64, f64)> {
        let behind = self.behind(n, side).into_iter().flat_map(|behind| behind.along);
        behind.fold(vec![(self.extents[n][0], self.extents[n][1])], |open, [from, to]| without(open, from, to))
    }

    /// The pieces of stacked rows, by the corridors below and above them. None is laid over a corridor.
    fn stacked(&self) -> BTreeMap<[usize; 2], Vec<[f64; 2]>> {
        let Self { strips, extents, .. } = *self;
        let pieces = |n: usize| {
            let own = &strips[n];
            self.others(n, 1, [DEPTH.1, STACKED]).into_iter().flat_map(move |Behind { corridor: m, .. }| {
                let across = [own.across[1], strips[m].across[0]];
                let along = shared(extents[n], extents[m]);
                let pieces = self.uncrossed(own.direction, across, vec![(along[0], along[1])]).into_iter();
                let row = move |along| Row { direction: own.direction, along, across, between: Some([n, m]) };
                pieces.map(row).filter(|row| !self.has_way(row)).map(move |row| ([n, m], row))
            })
        };
        let (pairs, rows): (Vec<_>, Vec<_>) = (0..strips.len()).flat_map(pieces).unzip();
        let is_stacked = stacked::are_stacked(self.views, &rows);
        let mut found: BTreeMap<_, Vec<_>> = BTreeMap::new();
        for (pair, row) in pairs.into_iter().zip(rows).zip(is_stacked).filter_map(|(row, is)| is.then_some(row)) {
            if !self.with_bays || self.views[row.direction].pitch_of(&row).is_some() {
                found.entry(pair).or_default().push(row.along);
            }
        }
        found
    }

    /// True when a corridor runs along a row within it.
    fn has_way(&self, row: &Row) -> bool {
        let near = self.placed[row.direction].touching(row.along, row.across).into_iter();
        near.filter(|&n| overlap(self.extents[n], row.along) >= WAY).any(|n| holds(row.across, self.strips[n].middle()))
    }

    /// A row from face to face, without so much behind those of its faces along which no corridor runs, metres.
    pub fn before_backs(&self, row: &Row, by: f64) -> [f64; 2] {
        let near = self.placed[row.direction].touching(row.along, wider(row.across, SAME));
        let is_before =
            |side: usize| near.iter().any(|&n| (self.strips[n].across[1 - side] - row.across[side]).abs() <= SAME);
        let [low, high] = [0, 1].map(|side| if is_before(side) { 0.0 } else { by });
        [row.across[0] + low, row.across[1] - high]
    }

    /// What lies between neighbouring corridors.
    pub fn between(&self) -> Vec<Row> {
        self.so_deep(|n| self.behind(n, 1), |depth| depth >= SHALLOW)
    }

    /// What lies between neighbouring corridors and is too thin for a row; their sides may lie a little within one another.
    pub fn walls(&self) -> Vec<Row> {
        self.so_deep(|n| self.others(n, 1, [-SAME, SHALLOW]), |depth| depth < SHALLOW)
    }

    /// What lies between neighbouring corridors and is as deep as is asked for.
    fn so_deep(&self, behind: impl Fn(usize) -> Vec<Behind>, is_so_deep: impl Fn(f64) -> bool) -> Vec<Row> {
        let Self { strips, extents, .. } = *self;
        let mut rows = Vec::new();
        for (n, strip) in strips.iter().enumerate() {
            let mut open = vec![(extents[n][0], extents[n][1])];
            for Behind { corridor: m, depth, along } in behind(n) {
                let within = |[from, to]: &[f64; 2]| {
                    let shared = open.iter().map(|(a, b)| (a.max(*from), b.min(*to)));
                    shared.filter(|(a, b)| a < b).collect::<Vec<_>>()
                };
                let shared = along.iter().flat_map(within).collect();
                open = along.iter().fold(open, |open, [from, to]| without(open, *from, *to));
                if is_so_deep(depth) {
                    let across = [strip.across[1], strips[m].across[0]];
                    let pieces = self.uncrossed(strip.direction, across, shared).into_iter();
                    rows.extend(pieces.map(|along| Row {
                        direction: strip.direction,
                        along,
                        across,
                        between: Some([n, m]),
                    }));
                }
            }
        }
        rows
    }

    /// Pieces of a row beside a corridor that no other corridor crosses, each long enough.
    pub fn uncrossed(&self, direction: usize, across: [f64; 2], mut pieces: Vec<(f64, f64)>) -> Vec<[f64; 2]> {
        let view = &self.views[direction];
        let middle = f64::midpoint(across[0], across[1]);
        let ends = [pieces.first().map_or(0.0, |piece| piece.0), pieces.last().map_or(0.0, |piece| piece.1)];
        let row = view.rectangle([ends[0] - self.reach, ends[1] + self.reach], [middle; 2]);
        for other in self.near.beside(&row).into_iter().map(|other| other as usize) {
            let crossing = &self.strips[other];
            if crossing.direction != direction
                && let Some([from, to]) =
                    crossed(view, &self.views[crossing.direction], crossing, self.extents[other], across)
            {
                pieces = without(pieces, from, to);
            }
        }
        pieces.into_iter().filter(|(from, to)| to - from >= SHORTEST).map(|(from, to)| [from, to]).collect()
    }

    /// A corridor with those that may reach it.
    pub fn reached(&self, n: usize) -> Reached<'_> {
        let own = &self.strips[n];
        let ground = self.views[own.direction].rectangle(self.extents[n], own.across);
        let near = self.near.beside(&ground).into_iter().map(|other| &self.strips[other as usize]);
        Reached { crossings: self, n, by: near.filter(|other| other.direction != own.direction).collect() }
    }
}

/// A corridor, and those of other directions that may reach it.
pub struct Reached<'a> {
    crossings: &'a Crossings<'a>,
    n: usize,
    by: Vec<&'a Strip>,
}

impl Reached<'_> {
    /// Pieces of a row on one side of the corridor without the mouths of what reaches it, and these: where others
    /// lead up to it they end in it, and where there is floor between racks they go on to the wall behind. A row in
    /// which there is floor elsewhere too has empty bays, and no mouths that one could tell from them.
    pub fn between_mouths(&self, across: [f64; 2], pieces: Vec<(f64, f64)>) -> (Vec<(f64, f64)>, Vec<[f64; 2]>) {
        let Crossings { views, strips, extents, .. } = self.crossings;
        let own = &strips[self.n];
        let view = &views[own.direction];
        let end_in = |other: &Strip| {
            let ends = across_row(view, &views[other.direction], other, across).map(|[_, u]| u);
            shared(ends, extents[self.n])
        };
        // What stands on its near face is of it, and a wall at its far one may be.
        let [low, high] = across;
        let [low, high] =
            if low < own.middle() { [low + SAME, high + view.cell] } else { [low - view.cell, high - SAME] };
        let floor = |[from, to]: [f64; 2]| {
            let columns = view.column(from)..view.column(to.max(from));
            let taken = view.blocked_where(columns.clone(), low, high, |share| share > 0.0).count(0..columns.len());
            [columns.len() - taken, columns.len()].map(|count| count as f64)
        };
        // Of the cells at its sides the racks' ends may be a part.
        let is_open = |mouth: &[f64; 2]| {
            let [free, all] = floor(wider(*mouth, -view.cell));
            all > 0.0 && free >= (1.0 - CLUTTER) * all
        };
        let mouths: Vec<_> = self.by.iter().map(|other| end_in(other)).filter(is_open).collect();
        if mouths.is_empty() {
            return (pieces, mouths);
        }
        let left = mouths.iter().fold(pieces.clone(), |left, [from, to]| without(left, *from, *to));
        let elsewhere: Vec<_> = left.iter().map(|(from, to)| floor([*from, *to])).collect();
        let [free, all] = [0, 1].map(|n| elsewhere.iter().map(|counts| counts[n]).sum::<f64>());
        if free <= EMPTY * all { (left, mouths) } else { (pieces, Vec::new()) }
    }
}

/// True when a strip lies between two much longer corridors that are no further apart than the faces of a rack; of all it
/// is known where they lie.
pub fn is_within_row(strips: &[Strip], placed: &[Beside], n: usize) -> bool {
    let own = &strips[n];
    let near = placed[own.direction].touching(own.along, wider(own.across, 2.0 * DEPTH.1));
    let beside =
        |other: &&Strip| overlap(other.along, own.along) > own.length() / 2.0 && other.length() > LONGER * own.length();
    let strips = || near.iter().map(|&n| &strips[n]).filter(beside);
    let [below, above] = facing(own, strips());
    above - below <= DEPTH.1
}

/// Where the nearest of some strips beside another end and begin, below it and above it; nowhere where there are none.
pub fn facing<'a>(own: &Strip, strips: impl Iterator<Item = &'a Strip> + Clone) -> [f64; 2] {
    let below = strips.clone().map(|strip| strip.across[1]).filter(|v| *v <= own.across[0] + SAME);
    let above = strips.map(|strip| strip.across[0]).filter(|v| *v >= own.across[1] - SAME);
    [below.fold(f64::NEG_INFINITY, f64::max), above.fold(f64::INFINITY, f64::min)]
}

/// The strips without those inside racks: along most of them between two wider ways that are no further apart than the faces of racks,
/// with no more than a beam to one of them, as others as wide do.
pub fn without_lanes(views: &[Turned], strips: Vec<Strip>) -> Vec<Strip> {
    let placed = placed(views, strips.iter().map(Strip::place));
    let is_lane = |own: &&Strip| {
        let near = placed[own.direction].touching(own.along, wider(own.across, DEPTH.1));
        let is_way = |other: &&Strip| {
            overlap(other.along, own.along) >= ALONG * own.length() && other.width() >= WIDER * own.width()
        };
        let [below, above] = facing(own, near.iter().map(|&n| &strips[n]).filter(is_way));
        above - below <= DEPTH.1 && (own.across[0] - below).min(above - own.across[1]) <= BEAM
    };
    let lanes: Vec<&Strip> = strips.iter().filter(is_lane).collect();
    let is_inside = |own: &Strip| {
        let is_alike = |other: &&&Strip| other.direction == own.direction && own.is_as_wide(other);
        lanes.contains(&own) && lanes.iter().filter(is_alike).count() >= LANES
    };
    let stays: Vec<bool> = strips.iter().map(|own| !is_inside(own)).collect();
    let mut stays = stays.into_iter();
    strips.into_iter().filter(|_| stays.next().unwrap_or(true)).collect()
}

/// Of rows that overlap the longest.
pub fn apart(views: &[Turned], rows: Vec<Row>) -> Vec<Row> {
    heaviest(views, rows.into_iter().map(|row| (row.length(), row)).collect())
}

/// Of rows that overlap the one of most weight; the heaviest first.
pub fn heaviest(views: &[Turned], mut weighed: Vec<(f64, Row)>) -> Vec<Row> {
    weighed.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut rows: Vec<Row> = weighed.into_iter().map(|(_, row)| row).collect();
    let polygons: Vec<_> = rows.iter().map(|row| views[row.direction].rectangle(row.along, row.across)).collect();
    let middles: Vec<_> = (0..).zip(rows.iter().map(|row| row.middle(views))).collect();
    let (holding, held) = (Near::polygons(&polygons), Near::points(middles.iter().copied()));
    let mut kept = vec![false; rows.len()];
    for (n, row) in rows.iter().enumerate() {
        let own = middles[n].1;
        let is_kept = |other: &&u32| kept[**other as usize];
        let within = holding.at(own).iter().filter(is_kept).any(|&other| rows[other as usize].holds(views, own));
        let around = held.within(&polygons[n]);
        kept[n] = !within && !around.iter().filter(is_kept).any(|&other| row.holds(views, middles[other as usize].1));
    }
    let mut flags = kept.into_iter();
    rows.retain(|_| flags.next().unwrap_or(false));
    rows
}

/// Pieces without what lies between two places.
pub fn without(pieces: Vec<(f64, f64)>, from: f64, to: f64) -> Vec<(f64, f64)> {
    let cut = pieces.into_iter().flat_map(|(a, b)| [(a, b.min(from)), (a.max(to), b)]);
    cut.filter(|(a, b)| a < b).collect()
}

/// From where to where, along `view`, a corridor of another direction crosses the middle of a row; nothing when it
/// ends before.
pub fn crossed(
    view: &Turned,
    other: &Turned,
    crossing: &Strip,
    extent: [f64; 2],
    across: [f64; 2],
) -> Option<[f64; 2]> {
    let ends = across_row(view, other, crossing, across);
    let within = ends.iter().any(|[s, _]| holds(extent, *s));
    within.then(|| ends.map(|[_, u]| u))
}

/// Where the two sides of a strip of another direction cross the middle of a row: the place along that strip, and along the
/// row, in whose order they are.
fn across_row(view: &Turned, other: &Turned, strip: &Strip, across: [f64; 2]) -> [[f64; 2]; 2] {
    let middle = f64::midpoint(across[0], across[1]);
    let [one, two] = strip.across.map(|t| view.crossing(other, middle, t));
    if one[1] <= two[1] { [one, two] } else { [two, one] }
}
