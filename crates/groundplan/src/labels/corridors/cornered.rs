//! Ways behind the last rows of a place, of which little was seen: where ways between the rows lead on past them, the rows'
//! corners show where a way along their backs begins, and what stands across from these where it ends.

use super::barriers;
use super::family;
use super::known::{Known, Led};
use super::stretches;
use crate::ends::{around, holds, overlap, sorted, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::Strip;
use crate::labels::rows::{DEPTH, SAME};
use crate::labels::view::runs::runs;
use crate::labels::view::turned::Turned;
use crate::labels::ways::across::square_to;
use crate::parameters::Parameters;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// What stands so near to a way's side, metres, stands on it.
const SIDE: f64 = 0.25;
/// What leads there is free but for this share within this share of its width, and nothing but this share stands in the way.
const CLUTTER: f64 = 0.2;
const INNER: f64 = 0.6;
const TAKEN: f64 = 0.05;
/// So much of it was not seen between two ways that lead to it: of what was seen more is told by its sides. And no more.
const UNSEEN: [f64; 2] = [0.1, 0.85];

/// The ways with those behind the last rows that are not known; none where there are no such.
pub fn with(views: &[Turned], strips: &[Strip], parameters: &Parameters) -> Option<Vec<Strip>> {
    let mut known = Known::new(views, strips);
    let placed = placed(views, strips.iter().map(Strip::place));
    for view in views {
        let Some(other) = square_to(views, view.direction) else { continue };
        for side in [0, 1] {
            let behind = Behind { view, other, strips, placed: &placed[view.direction], side, parameters };
            behind.ways().into_iter().for_each(|way| known.add(way));
        }
    }
    known.with_more()
}

/// The corner of a row beside a way that leads past it.
struct Corner {
    way: usize,
    /// On which side of the way, along the rows.
    side: usize,
    /// From the corner to what stands across from it, across the rows.
    gap: [f64; 2],
}

impl Corner {
    fn is_in_line(&self, other: &Self) -> bool {
        (0..2).all(|n| (self.gap[n] - other.gap[n]).abs() <= SAME)
    }
}

/// The corners in line with one, and its gap: each time with the one, of those left, in line with which most are.
fn in_lines(corners: &[Corner]) -> Vec<([f64; 2], Vec<&Corner>)> {
    let from = |n: usize| corners[n].gap[0];
    let mut order: Vec<usize> = (0..corners.len()).collect();
    order.sort_by(|&a, &b| from(a).total_cmp(&from(b)));
    let in_line = |n: usize, is_left: &[bool]| -> Vec<usize> {
        // Twice as far on both sides, for what floats round.
        let [low, high] = wider([from(n); 2], 2.0 * SAME);
        let near = order[order.partition_point(|&m| from(m) < low)..].iter().copied();
        near.take_while(|&m| from(m) <= high).filter(|&m| is_left[m] && corners[n].is_in_line(&corners[m])).collect()
    };
    let mut is_left = vec![true; corners.len()];
    let all = (0..corners.len()).map(|n| (in_line(n, &is_left).len(), Reverse(n)));
    let mut most: BinaryHeap<(usize, Reverse<usize>)> = all.collect();
    let mut found = Vec::new();
    while let Some((count, Reverse(n))) = most.pop() {
        let now = if is_left[n] { in_line(n, &is_left) } else { continue };
        if now.len() < count {
            most.push((now.len(), Reverse(n)));
            continue;
        }
        for &m in &now {
            is_left[m] = false;
        }
        found.push((corners[n].gap, now.into_iter().map(|m| &corners[m]).collect()));
    }
    found
}

/// One side of the aisles of a direction, and the ways that cross them.
struct Behind<'a> {
    view: &'a Turned,
    other: &'a Turned,
    strips: &'a [Strip],
    /// Those along the aisles.
    placed: &'a Beside,
    side: usize,
    parameters: &'a Parameters,
}

impl Behind<'_> {
    fn ways(&self) -> Vec<Led> {
        let leading = (0..self.strips.len()).filter(|&n| self.strips[n].direction == self.other.direction);
        let corners: Vec<Corner> = leading.flat_map(|n| self.corners(n)).collect();
        in_lines(&corners).into_iter().flat_map(|(gap, in_line)| self.along(gap, &in_line)).collect()
    }

    /// The corners on both sides of a way behind the last aisle that it crosses.
    fn corners(&self, n: usize) -> Vec<Corner> {
        let way = &self.strips[n];
        let Some(last) = self.last_crossed(way) else { return Vec::new() };
        let reach = DEPTH.1 + self.parameters.labels_max_width;
        let place = |far: f64| {
            let outer = last.across[self.side];
            self.view.crossing(self.other, if self.side == 0 { outer - far } else { outer + far }, way.middle())
        };
        let columns = |ends: [f64; 2]| self.other.columns(sorted(ends.map(|far| place(far)[0])));
        let widest = self.parameters.labels_max_width.min(last.width() / family::LED_TO);
        let least = self.parameters.labels_min_width.max(last.width() * family::LED_TO);
        let is_outwards = place(reach)[0] > place(0.0)[0];
        let corner = |k: usize| {
            let stands = self.other.some_occupied(columns([0.0, reach]), way.across[k] - SIDE, way.across[k] + SIDE);
            let mut stands: Vec<bool> = stands.into_iter().map(|share| share > 0.0).collect();
            if !is_outwards {
                stands.reverse();
            }
            let far = |column: usize| column as f64 * self.other.cell;
            let gaps = runs(&stands, false).into_iter().filter(|&(_, to)| to < stands.len());
            let mut gaps = gaps.map(|(from, to)| [far(from), far(to)]);
            let gap = gaps.find(|[from, to]| to - from >= least)?;
            let inner = wider(way.across, (INNER - 1.0) / 2.0 * way.width());
            let far_side = place(gap[1])[0];
            let on = if is_outwards { way.along[1] - far_side } else { far_side - way.along[0] };
            // Behind the last rows no more than racks at a wall is left, and what leads between them.
            let is_corner = on <= DEPTH.1
                && (DEPTH.0..=DEPTH.1).contains(&gap[0])
                && gap[1] - gap[0] <= widest
                && self.other.mean_blocked(columns([0.0, gap[1]]), inner[0], inner[1]) <= CLUTTER;
            let at = |far: f64| self.view.place(self.other.to_map([place(far)[0], way.across[k]]));
            let side = usize::from(at(0.0)[0] > place(0.0)[1]);
            is_corner.then(|| Corner { way: n, side, gap: sorted(gap.map(|far| at(far)[1])) })
        };
        (0..2).filter_map(corner).collect()
    }

    /// The outermost aisle that a way crosses.
    fn last_crossed(&self, way: &Strip) -> Option<&Strip> {
        let is_crossed = |aisle: &&Strip| {
            let [s, u] = self.view.crossing(self.other, aisle.middle(), way.middle());
            holds(way.along, s) && overlap(aisle.along, wider([u; 2], way.width() / 2.0)) >= 0.0
        };
        let ends = way.along.map(|s| self.view.place(self.other.to_map([s, way.middle()])));
        let [along, across] = [0, 1].map(|axis| wider(around(ends.iter().map(|end| end[axis])), way.width()));
        let near = self.placed.touching(along, across).into_iter().map(|n| &self.strips[n]);
        let outwards = |aisle: &Strip| if self.side == 0 { -aisle.middle() } else { aisle.middle() };
        near.filter(is_crossed).max_by(|a, b| outwards(a).total_cmp(&outwards(b)))
    }

    /// The ways along a gap behind rows that show both their corners, one beside another.
    fn along(&self, gap: [f64; 2], corners: &[&Corner]) -> Vec<Led> {
        let middle = f64::midpoint(gap[0], gap[1]);
        let ends = |n: usize| sorted(self.strips[n].across.map(|t| self.view.crossing(self.other, middle, t)[1]));
        let mut sides: BTreeMap<usize, [bool; 2]> = BTreeMap::new();
        for corner in corners {
            sides.entry(corner.way).or_default()[corner.side] = true;
        }
        let mut leading: Vec<([f64; 2], [bool; 2])> = sides.into_iter().map(|(n, sides)| (ends(n), sides)).collect();
        leading.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        let goes_on = |one: &([f64; 2], [bool; 2]), two: &([f64; 2], [bool; 2])| {
            one.1[1] && two.1[0] && one.0[1] < two.0[0] && self.is_way([one.0[1], two.0[0]], gap)
        };
        let runs = leading.chunk_by(goes_on).filter(|run| run.len() > 1);
        runs.map(|run| {
            let [first, last] = [run[0].0, run[run.len() - 1].0];
            let way = stretches::ragged(self.view, [first[0], last[1]], gap, last[1] - first[0]);
            Led { way, middles: [first, last].map(|ends| f64::midpoint(ends[0], ends[1])) }
        })
        .collect()
    }

    /// True when nothing stands between two ways that lead to what was seen in part.
    fn is_way(&self, between: [f64; 2], gap: [f64; 2]) -> bool {
        let columns = self.view.columns(between);
        let [low, high] = wider(gap, -SIDE);
        let taken = self.view.some_occupied(columns.clone(), low, high);
        let unseen = self.view.mean_blocked(columns.clone(), low, high);
        taken.iter().sum::<f64>() <= TAKEN * taken.len() as f64
            && holds(UNSEEN, unseen)
            && !barriers::among(self.view, gap, columns).any()
    }
}
