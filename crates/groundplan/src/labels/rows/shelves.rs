//! What of a row of racks is open, by its columns, and where something stands along its faces.

use super::sections::{self, FACE, LEFT};
use crate::labels::rows::Row;
use crate::labels::view::runs::{Run, close, common, length, outside, runs};
use crate::labels::view::turned::Turned;
use std::cell::OnceCell;
use std::ops::Range;

/// So many columns on either side of what is open are of its ends.
pub const ENDS: usize = 2;
/// What stands so near to a face, metres, or within that share of the row's depth, is of the face and no back. Backs are so
/// long at least, but for gaps up to that, metres.
const OFF_FACE: (f64, f64) = (0.35, 0.25);
const BACK: f64 = 0.5;
const GAP: f64 = 0.3;
/// They close what they stand in for more than this share.
const BACKED: f64 = 0.5;

/// A row, and from which to which of its columns what is open.
pub struct Shelves {
    pub row: Row,
    /// Which of the view's columns it has.
    columns: Range<usize>,
    /// Of each half.
    pub halves: [Vec<Run>; 2],
    /// Where something stands at each face, once it is asked.
    faces: OnceCell<[Vec<Run>; 2]>,
    /// Where something stands between its open halves, once it is asked.
    backs: OnceCell<Vec<Run>>,
    /// Where it is open from aisle to aisle, once it is asked.
    open: OnceCell<Vec<Run>>,
}

impl Shelves {
    pub fn new(view: &Turned, row: &Row) -> Self {
        let columns = view.column(row.along[0])..view.column(row.along[1]);
        let middle = f64::midpoint(row.across[0], row.across[1]);
        // The ground of racks on legs is taken; their empty bays are those in which nothing stands.
        let on_legs = view.on_legs_at(middle, columns.clone());
        let halves = [[row.across[0], middle], [middle, row.across[1]]].map(|[low, high]| {
            let blocked = view.blocked_where(columns.clone(), low, high, |share| share > LEFT);
            let mut open: Vec<bool> = (0..columns.len()).map(|n| !blocked.get(n)).collect();
            if !on_legs.is_empty() {
                let stands = view.some_occupied(columns.clone(), low, high);
                on_legs.iter().flat_map(|&(from, to)| from..to).for_each(|n| open[n] |= stands[n] <= 0.0);
            }
            runs(&open, true)
        });
        Self {
            row: row.clone(),
            columns,
            halves,
            faces: OnceCell::new(),
            backs: OnceCell::new(),
            open: OnceCell::new(),
        }
    }

    /// How many columns it has.
    pub fn count(&self) -> usize {
        self.columns.len()
    }

    /// Where it is open from aisle to aisle.
    pub fn open(&self, view: &Turned) -> &[Run] {
        self.open.get_or_init(|| outside(&common(&self.halves[0], &self.halves[1]), self.backs(view)))
    }

    /// Where it is, and no wall runs along it.
    pub fn passable(&self, view: &Turned) -> Vec<Run> {
        let first = self.columns.start;
        let is_walled = |&(from, to): &Run| sections::is_walled(view, &self.row, first + from..first + to);
        self.open(view).iter().copied().filter(|run| !is_walled(run)).collect()
    }

    /// Where both halves are open and something stands all along between them, as backs of racks do.
    pub fn backs(&self, view: &Turned) -> &[Run] {
        self.backs.get_or_init(|| {
            let both = common(&self.halves[0], &self.halves[1]);
            let [low, high] = self.row.across;
            let off = OFF_FACE.0.min(OFF_FACE.1 * (high - low));
            let first = self.columns.start;
            let of_run = |(from, to): Run| {
                let stands = view.some_occupied(first + from..first + to, low + off, high - off);
                let mut stands: Vec<bool> = stands.into_iter().map(|share| share > 0.0).collect();
                close(&mut stands, (GAP / view.cell).round() as usize);
                let backs = runs(&stands, true).into_iter().map(move |back| (from + back.0, from + back.1));
                backs.filter(|back| (back.1 - back.0) as f64 * view.cell >= BACK).collect::<Vec<_>>()
            };
            both.into_iter().flat_map(of_run).collect()
        })
    }

    /// True when backs close most of it from one place along to another.
    pub fn is_backed(&self, view: &Turned, along: [f64; 2]) -> bool {
        let [from, to] = along.map(|u| view.column(u).saturating_sub(self.columns.start).min(self.count()));
        let within = length(common(self.backs(view), &[(from, to)]));
        from < to && within as f64 > BACKED * (to - from) as f64
    }

    /// How long it is from the first to the last place at which something of it was seen, metres.
    pub fn seen(&self, view: &Turned) -> f64 {
        let seen = self.halves.iter().chain(self.faces(view)).flatten();
        let [from, to] = seen.fold([self.count(), 0], |all, run| [all[0].min(run.0), all[1].max(run.1)]);
        to.saturating_sub(from) as f64 * view.cell
    }

    /// True of what is open up to an end of the row.
    pub fn is_end(&self, (from, to): Run) -> bool {
        from == 0 || to == self.count()
    }

    /// The row but for where it is open from aisle to aisle at some width, and past its ends.
    pub fn elsewhere(&self, view: &Turned, is_as_wide: impl Fn(usize) -> bool) -> Elsewhere<'_> {
        // Past its ends nothing stands, in empty bays there do posts.
        let is_left_out = |&(from, to): &Run| {
            if !self.is_end((from, to)) {
                return is_as_wide(to - from);
            }
            let within = [(from + ENDS, to.saturating_sub(ENDS))];
            let stands = |face: &[Run]| !common(face, &within).is_empty();
            !self.faces(view).iter().any(|face| stands(face))
        };
        let left_out: Vec<Run> = self.open(view).iter().copied().filter(is_left_out).collect();
        let open = left_out.iter().filter(|run| !self.is_end(**run)).count();
        let wider = |(from, to): Run| (from.saturating_sub(ENDS), (to + ENDS).min(self.count()));
        Elsewhere { shelves: self, open, left_out: left_out.into_iter().map(wider).collect() }
    }

    /// Where something stands at each face.
    pub fn faces(&self, view: &Turned) -> &[Vec<Run>; 2] {
        self.faces.get_or_init(|| {
            self.row.across.map(|face| {
                let stands = view.some_occupied(self.columns.clone(), face - FACE, face + FACE);
                runs(&stands.into_iter().map(|share| share > 0.0).collect::<Vec<_>>(), true)
            })
        })
    }
}

/// A row but for some places at which it is open.
pub struct Elsewhere<'a> {
    pub shelves: &'a Shelves,
    /// How many they are, without those past its ends.
    pub open: usize,
    /// Each with what is of its ends.
    left_out: Vec<Run>,
}

impl Elsewhere<'_> {
    /// How many columns there are elsewhere.
    pub fn columns(&self) -> usize {
        length(outside(&[(0, self.shelves.count())], &self.left_out))
    }

    /// Over how many columns, of both halves, a half is open there for so many one after another.
    pub fn free(&self, least: f64) -> usize {
        let of_half = |half: &Vec<Run>| {
            let open = outside(half, &self.left_out);
            length(open.into_iter().filter(|(from, to)| (to - from) as f64 >= least))
        };
        self.shelves.halves.iter().map(of_half).sum()
    }

    /// At how many columns, of both faces, something stands there.
    pub fn stands(&self, view: &Turned) -> usize {
        self.shelves.faces(view).iter().map(|face| length(outside(face, &self.left_out))).sum()
    }
}
