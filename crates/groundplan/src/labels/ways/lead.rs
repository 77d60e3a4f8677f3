//! A strip that leads across a row, or would if it were longer, and where.

use crate::ends::{holds, sorted, wider};
use crate::labels::corridors::Strip;
use crate::labels::rows::Row;
use crate::labels::view::turned::Turned;

/// A strip and a row that it crosses or ends before, and the directions of the row and of the strip.
pub struct Lead<'a> {
    pub views: [&'a Turned; 2],
    pub row: &'a Row,
    pub strip: &'a Strip,
}

impl Lead<'_> {
    /// From where to where along it the strip would lie between two places across the row's direction.
    pub fn along(&self, across: [f64; 2]) -> [f64; 2] {
        let [view, other] = self.views;
        sorted(across.map(|v| view.crossing(other, v, self.strip.middle())[0]))
    }

    /// From where to where along the row it would lie.
    pub fn sides(&self) -> [f64; 2] {
        let [view, other] = self.views;
        let middle = f64::midpoint(self.row.across[0], self.row.across[1]);
        let reach = self.strip.width() / 2.0 / other.sine(view);
        wider([view.crossing(other, middle, self.strip.middle())[1]; 2], reach)
    }

    /// True when the strip goes on across the middle of the row's depth, be it past its end.
    pub fn is_across(&self) -> bool {
        let middle = f64::midpoint(self.row.across[0], self.row.across[1]);
        holds(self.strip.along, self.along([middle; 2])[0])
    }

    /// True when it would lie between the row's ends.
    pub fn is_within(&self) -> bool {
        let [from, to] = self.sides();
        self.row.along[0] < from && to < self.row.along[1]
    }
}
