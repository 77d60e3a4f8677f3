//! Ways through racks that show their faces alone: where goods or shelves stand all along both faces of a row, and nothing closes what
//! is open from aisle to aisle, that is no empty bay.

use super::gates::IN_LINE;
use super::widths::are_alike;
use crate::labels::corridors::Strip;
use crate::labels::rows::sections::{FACE, TAKEN, WIDTH};
use crate::labels::rows::seen::Seen;
use crate::labels::rows::shelves::Shelves;
use crate::labels::rows::{Row, SHORTEST};
use crate::labels::view::runs::{Run, common, length, outside};
use std::iter;

/// Both faces begin and end beside a way at one place, but for so much, metres.
const ALIKE: f64 = 0.35;
/// Two racks back to back are no deeper, metres; between such as are deeper than a corridor is narrow one sees their backs, or nothing:
/// so near to its middle, metres, no more of a row is free than that.
const DEEPEST: f64 = 2.6;
const LANE: f64 = 1.3;
const MIDDLE: f64 = 0.3;
const FREE: f64 = 0.8;
/// What is so much narrower than gates through other rows is one here: bays that are empty would break the faces elsewhere, metres.
const NARROWER: f64 = 0.3;
/// Something stands along so much of what was seen of the faces elsewhere, which are so many times as long as the way.
const SOLID: f64 = 0.96;
const LONG: f64 = 1.5;
/// And along so much of as much as the shortest rack beside it.
const BESIDE: f64 = 0.8;

/// The ways through rows whose faces are solid: what nothing closes on either side; of what something closes on one that is as wide
/// as one of these, and what is in line with one, be the faces beside it solid or not. Deeper rows may be rooms between two
/// corridors.
pub fn find(rows: &[Seen]) -> Vec<Strip> {
    let racks = rows.iter().filter(|seen| seen.row.depth() <= DEEPEST);
    let found: Vec<Gap> = racks.flat_map(|seen| Faces::new(seen).gaps()).collect();
    let (open, others): (Vec<_>, Vec<_>) = found.into_iter().partition(|gap| gap.closed == Some(0));
    let is_like_open = |gap: &Gap| {
        let is_so = |one: &Gap| {
            one.way.direction == gap.way.direction
                && ((one.way.middle() - gap.way.middle()).abs() <= IN_LINE.0
                    || gap.closed == Some(1) && are_alike(gap.way.width(), one.way.width()))
        };
        open.iter().any(is_so)
    };
    let others: Vec<Strip> = others.into_iter().filter(is_like_open).map(|gap| gap.way).collect();
    open.into_iter().map(|gap| gap.way).chain(others).collect()
}

/// What is open through a row, and where its faces are solid, on how many sides something closes the row.
struct Gap {
    way: Strip,
    closed: Option<usize>,
}

/// The faces of a row, without what lies between its ends and walls.
struct Faces<'a, 'b> {
    seen: &'a Seen<'b>,
    shelves: Shelves,
    /// Where nothing stands at each of them.
    open: [Vec<Run>; 2],
}

impl<'a, 'b> Faces<'a, 'b> {
    fn new(seen: &'a Seen<'b>) -> Self {
        let row = Row { along: seen.own, ..seen.row.clone() };
        let shelves = Shelves::new(seen.views[0], &row);
        let open = shelves.faces(seen.views[0]).each_ref().map(|face| outside(&[(0, shelves.count())], face));
        Self { seen, shelves, open }
    }

    fn gaps(&self) -> Vec<Gap> {
        let gaps: Vec<Run> =
            self.open[0].iter().filter_map(|gap| self.of_both(*gap)).filter(|gap| self.may_be_way(*gap)).collect();
        if gaps.is_empty() || self.is_lane() {
            return Vec::new();
        }
        let is_solid = self.are_solid_but_for(&gaps);
        let gap = |gap: Run| {
            let ends = self.ends(gap);
            let closed = ends.iter().filter(|end| self.seen.columns.is_closed_at(**end)).count();
            Some(Gap { way: self.seen.gate(ends)?, closed: is_solid.then_some(closed) })
        };
        gaps.into_iter().filter_map(gap).collect()
    }

    /// True when it may be a corridor between two rooms.
    fn is_lane(&self) -> bool {
        let (view, row) = (self.seen.views[0], &self.shelves.row);
        let middle = f64::midpoint(row.across[0], row.across[1]);
        let blocked = view.some_blocked(view.columns(row.along), middle - MIDDLE, middle + MIDDLE);
        let free = blocked.iter().filter(|share| **share <= 0.0).count() as f64;
        row.depth() > LANE && free >= FREE * blocked.len() as f64
    }

    fn metres(&self, cells: usize) -> f64 {
        cells as f64 * self.seen.views[0].cell
    }

    fn cells(&self, metres: f64) -> usize {
        (metres / self.seen.views[0].cell).ceil() as usize
    }

    fn faces(&self) -> &[Vec<Run>; 2] {
        self.shelves.faces(self.seen.views[0])
    }

    /// Where a gap lies along.
    fn ends(&self, (from, to): Run) -> [f64; 2] {
        let view = self.seen.views[0];
        let first = view.column(self.seen.own[0]);
        [from, to].map(|n| view.along(first + n))
    }

    /// What a gap in the one face has in common with one in the other, if they begin and end alike.
    fn of_both(&self, (from, to): Run) -> Option<Run> {
        let is_near = |one: usize, other: usize| self.metres(one.abs_diff(other)) <= ALIKE;
        let other = self.open[1].iter().find(|other| is_near(from, other.0) && is_near(to, other.1));
        other.map(|other| (from.max(other.0), to.min(other.1)))
    }

    /// True when it is as wide as ways are and no bay, and racks end beside it: not posts beyond which the next bay is empty.
    fn may_be_way(&self, (from, to): Run) -> bool {
        let (count, least) = (self.shelves.count(), self.cells(SHORTEST));
        let ends = self.ends((from, to));
        let are_solid = |beside: Run| {
            let stands = |face: &Vec<Run>| length(common(face, &[beside])) as f64 >= BESIDE * least as f64;
            self.faces().iter().all(stands)
        };
        (WIDTH.0 - NARROWER..=WIDTH.1).contains(&self.metres(to - from))
            && self.seen.columns.is_free(ends)
            && !self.seen.columns.is_as_bays(ends)
            && are_solid((from.saturating_sub(least), from))
            && are_solid((to, (to + least).min(count)))
    }

    /// True when something stands nearly all along what was seen of both faces between the row's ends, but for some gaps.
    fn are_solid_but_for(&self, gaps: &[Run]) -> bool {
        let (view, row, count) = (self.seen.views[0], &self.shelves.row, self.shelves.count());
        let columns = view.columns(row.along);
        let widest = gaps.iter().map(|(from, to)| to - from).max().unwrap_or(0);
        // One face may end farther on than the other.
        let near = self.cells(ALIKE);
        let first = self.faces().iter().filter_map(|face| face.first()).map(|run| run.0).min().unwrap_or(0);
        let last = self.faces().iter().filter_map(|face| face.last()).map(|run| run.1).max().unwrap_or(0);
        let wider = |&(from, to): &Run| (from.saturating_sub(near), to + near);
        let left_out: Vec<Run> = iter::once((0, first + near))
            .chain(gaps.iter().map(wider))
            .chain(iter::once((last.saturating_sub(near), count)))
            .collect();
        (0..2).all(|side| {
            let own = row.across[side];
            let unseen = view.blocked_where(columns.clone(), own - FACE, own + FACE, |share| share > TAKEN);
            let unseen: Vec<Run> = unseen.runs(0..count, true).map(|run| (run.start, run.end)).collect();
            let stands = length(outside(&self.faces()[side], &left_out));
            let bare = length(outside(&outside(&self.open[side], &left_out), &unseen));
            stands as f64 >= SOLID * (stands + bare) as f64 && stands as f64 >= LONG * widest as f64
        })
    }
}
