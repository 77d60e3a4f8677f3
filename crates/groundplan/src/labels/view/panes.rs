//! Panes of glass in walls: what a lidar sees through one is a fan of rays over no floor of the site, so it is as good as
//! the wall on both its sides.

use super::turned::Turned;
use crate::bits::Bits;
use crate::ends::{holds, overlap, sorted};
use crate::labels::corridors::{ASKEW, Strip};
use crate::labels::junctions::shut;
use std::ops::Range;
use std::sync::Arc;

/// Gaps up to this long, metres, are none in a wall, which goes on beside a pane for so long at least.
const GAP: f64 = 0.3;
const WALL: f64 = 0.6;
/// How long a pane is, metres.
const LONG: (f64, f64) = (0.6, 20.0);
/// The floor before a pane, and what is seen right behind it, lie so far from the wall, metres, and are free but for this
/// share; beside it, right behind the wall, so much is not.
const NEAR: [f64; 2] = [0.3, 0.8];
const CLEAR: f64 = 0.25;
const BEHIND: [f64; 2] = [0.15, 0.45];
const HIDDEN: f64 = 0.4;
/// Rays spread: so far behind the wall, metres, there is free ground beside it as well, where between racks there is none.
const SPREAD: [f64; 2] = [1.0, 3.0];
const UNSPREAD: f64 = 0.75;
/// Something stands in no more than this share of the columns behind a pane up to the map's end, where an outer wall would in
/// all of them; nor in more of the rows of cells so far behind it, metres, and beside that, as the walls of a way would.
const HIT: f64 = 0.15;
const FAR: f64 = 6.0;
/// A pane bars a way when it lies across so much of its width, what stands at its sides left out.
const BARS: f64 = 0.5;
/// A way ends at a pane when it does so near to it, metres.
const SLACK: f64 = 0.5;

/// A pane in a wall along a direction, in its places.
pub struct Pane {
    along: [f64; 2],
    across: f64,
    /// On which of its sides nothing but rays is.
    outside: usize,
}

/// A pane that lies across a direction.
pub struct Across {
    /// In the direction's places.
    ends: [[f64; 2]; 2],
    /// Which way along the direction its outside lies.
    outside: usize,
}

impl Across {
    /// Where it bars a strip, along it.
    fn bars(&self, strip: &Strip) -> Option<f64> {
        let [[u, v], [to_u, to_v]] = self.ends;
        let is_across = overlap(shut::inner(strip), sorted([v, to_v])) >= BARS * strip.width();
        is_across.then(|| u + (to_u - u) * (strip.middle() - v) / (to_v - v))
    }
}

impl Turned {
    /// Finds the panes in its walls, and has them for walls.
    pub fn glaze(&mut self) {
        let mut panes = Vec::new();
        for outside in [0, 1] {
            let count = self.offsets.len();
            // In which columns there is another line beyond: mostly there is, and nothing more is to be asked.
            let mut beyond = Bits::new(self.size[0]);
            for line in (0..count).map(|n| if outside == 0 { n } else { count - 1 - n }) {
                panes.extend(self.panes_in(line, outside, &beyond).into_iter().map(|gap| (line, gap, outside)));
                beyond |= &self.covered[line];
            }
        }
        if panes.is_empty() {
            return;
        }
        let (mut covered, mut touched) = (self.covered.to_vec(), self.touched.to_vec());
        for (line, columns, _) in &panes {
            covered[*line].fill(columns.clone());
            touched[*line].fill(columns.clone());
        }
        let of = |(line, columns, outside): (usize, Range<usize>, usize)| Pane {
            along: [columns.start, columns.end].map(|column| self.along(column)),
            across: self.offsets[line],
            outside,
        };
        self.panes = Arc::new(panes.into_iter().map(of).collect());
        (self.covered, self.touched) = (Arc::new(covered), Arc::new(touched));
    }

    /// In which columns the panes in a line lie through which nothing but rays is seen on a side.
    fn panes_in(&self, line: usize, outside: usize, beyond: &Bits) -> Vec<Range<usize>> {
        let mut walls = self.covered[line].joined(0..self.size[0], self.in_columns(GAP));
        walls.retain(|wall| wall.len() >= self.in_columns(WALL));
        let long = self.in_columns(LONG.0)..=self.in_columns(LONG.1);
        let is_outermost = |gap: &Range<usize>| beyond.count(gap.clone()) as f64 <= HIT * gap.len() as f64;
        let gaps = walls.windows(2).map(|pair| pair[0].end..pair[1].start).filter(|gap| long.contains(&gap.len()));
        gaps.filter(is_outermost).filter(|gap| self.is_pane(line, gap, outside)).collect()
    }

    /// Columns of so many metres.
    fn in_columns(&self, metres: f64) -> usize {
        (metres / self.cell).round() as usize
    }

    /// True when through a gap in a wall nothing but rays is seen on a side.
    fn is_pane(&self, line: usize, gap: &Range<usize>, side: usize) -> bool {
        let across = self.offsets[line];
        let behind = |off: [f64; 2], side: usize| {
            sorted(off.map(|metres| if side == 0 { across - metres } else { across + metres }))
        };
        let blocked = |columns: &Range<usize>, off: [f64; 2], side: usize| {
            let [low, high] = behind(off, side);
            self.mean_blocked(columns.clone(), low, high)
        };
        let margin = self.in_columns(GAP);
        let inner = gap.start + margin..gap.end - margin.min(gap.len().saturating_sub(margin + 1));
        let around = |off: f64| {
            gap.start.saturating_sub(self.in_columns(off))..(gap.end + self.in_columns(off)).min(self.size[0])
        };
        let [near, far] = [WALL, SPREAD[1]].map(around);
        let beside = [near.start..gap.start - margin, gap.end + margin..near.end];
        let is_hit = |row: &usize| {
            let [low, high] = behind([0, 1].map(|n| NEAR[0] + (row + n) as f64 * self.cell), side);
            self.share_touched(far.clone(), low, high) > 0.0
        };
        let rows = self.in_columns(FAR);
        let [low, top] = self.reach_across();
        let end = if side == 0 { across - low } else { top - across };
        [side, 1 - side].into_iter().all(|side| blocked(&inner, NEAR, side) <= CLEAR)
            && beside.iter().all(|columns| blocked(columns, BEHIND, side) >= HIDDEN)
            && beside.iter().all(|columns| blocked(columns, SPREAD, side) <= UNSPREAD)
            && {
                let [low, high] = behind([NEAR[0], end.max(NEAR[1])], side);
                self.share_touched(near, low, high) <= HIT
            }
            && (0..rows).filter(is_hit).count() as f64 <= HIT * rows as f64
    }
}

/// Tells each view of the panes of others that lie across it.
pub fn share(views: &mut [Turned]) {
    let across = |own: &Turned| -> Vec<Across> {
        let others = views.iter().filter(|other| own.sine(other) >= ASKEW);
        let panes = others.flat_map(|other| other.panes.iter().map(move |pane| (other, pane)));
        let of = |(other, pane): (&Turned, &Pane)| {
            let to_own = |u: f64, v: f64| own.place(other.to_map([u, v]));
            let beyond = pane.across + if pane.outside == 0 { -1.0 } else { 1.0 };
            let [start, outside] = [pane.across, beyond].map(|v| to_own(pane.along[0], v)[0]);
            Across { ends: pane.along.map(|u| to_own(u, pane.across)), outside: usize::from(outside > start) }
        };
        panes.map(of).collect()
    };
    let all: Vec<_> = views.iter().map(across).collect();
    views.iter_mut().zip(all).for_each(|(view, across)| view.across = Arc::new(across));
}

/// Where a pane bars the way beyond one of a strip's ends, no farther off than that.
pub fn beyond(view: &Turned, strip: &Strip, side: usize, look: f64) -> Option<f64> {
    let end = strip.along[side];
    let reach = if side == 0 { [end - look, end + SLACK] } else { [end - SLACK, end + look] };
    let places = view.across.iter().filter(|pane| pane.outside == side).filter_map(|pane| pane.bars(strip));
    places.filter(|place| holds(reach, *place)).min_by(|a, b| (a - end).abs().total_cmp(&(b - end).abs()))
}

/// Ways without what of them lies behind panes, where something is left.
pub fn cut(views: &[Turned], ways: &mut Vec<Strip>) {
    for way in ways.iter_mut() {
        for pane in views[way.direction].across.iter() {
            if let Some(place) = pane.bars(way).filter(|place| holds(way.along, *place)) {
                way.along[pane.outside] = place;
                way.stops[pane.outside] = false;
            }
        }
    }
    ways.retain(|way| way.along[0] < way.along[1]);
}
