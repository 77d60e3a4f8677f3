//! Ways between bars: where bars close the ends of rows, and not those of empty bays, what lies between two of them is a way,
//! be it as wide as bays and through one row alone.

use super::Evidence;
use super::corridors::Strip;
use super::gates::walled;
use super::look::Look;
use super::passing::Place;
use super::sections::Columns;
use super::turned::Turned;
use crate::ends::{overlap, sorted, wider};
use std::cell::OnceCell;
use std::iter::Sum;

/// What is free of a row for so much, metres, has two ends of its own.
const FREE: f64 = 0.5;
/// What is so near to a way's sides is of that, metres, and a wall so near to a row's end ends it.
const NEAR: f64 = 0.3;
/// What lies between bars is no narrower than so many bays: posts or goods narrow an empty one.
const AS_WIDE: f64 = 0.95;
/// Bars stand beside a way when that is so many times as likely as that they do beside an empty bay.
const LIKELIER: f64 = 10.0;

/// Which of some more strips lie between bars.
pub fn are_between(evidence: &Evidence, look: &Look, views: &[Turned], strips: &[Strip], more: &[Strip]) -> Vec<bool> {
    let all = [strips, more].concat();
    let mut between = vec![false; more.len()];
    for place in Place::of_each(views, &all) {
        let bars = Bars::new(evidence, look, &place, &all);
        for (n, is_between) in between.iter_mut().enumerate() {
            *is_between |= bars.are_beside(strips.len() + n);
        }
    }
    between
}

/// How often something is closed.
#[derive(Clone, Copy, Default)]
struct Often {
    closed: u32,
    open: u32,
}

impl Often {
    fn of(sides: impl IntoIterator<Item = bool>) -> Self {
        sides.into_iter().fold(Self::default(), Self::with)
    }

    fn with(self, is_closed: bool) -> Self {
        Self { closed: self.closed + u32::from(is_closed), open: self.open + u32::from(!is_closed) }
    }

    fn and(self, other: Self) -> Self {
        Self { closed: self.closed + other.closed, open: self.open + other.open }
    }

    /// As if one more were closed and one were not.
    fn share(self) -> f64 {
        f64::from(self.closed + 1) / f64::from(self.closed + self.open + 2)
    }

    /// How likely just so many are closed where so large a share is, but for a factor.
    fn likelihood(self, share: f64) -> f64 {
        libm::pow(share, f64::from(self.closed)) * libm::pow(1.0 - share, f64::from(self.open))
    }

    /// True when it is clearly closed as often as rows' ends are, and not as what is beside bays.
    fn is_as(self, ends: Self, bays: Self) -> bool {
        self.likelihood(ends.share()) > LIKELIER * self.likelihood(bays.share())
    }
}

impl Sum for Often {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), Self::and)
    }
}

/// What closes the rows of a place: each is looked at when it is first asked.
pub struct Bars<'a> {
    evidence: &'a Evidence<'a>,
    look: &'a Look<'a>,
    place: &'a Place<'a>,
    strips: &'a [Strip],
    rows: Vec<OnceCell<Closed>>,
}

/// What closes a row: at its ends, but for those at walls, beside what is free of it and no way, and beside each way.
struct Closed {
    ends: Often,
    bays: Often,
    ways: Vec<Often>,
}

impl<'a> Bars<'a> {
    pub fn new(evidence: &'a Evidence, look: &'a Look, place: &'a Place, strips: &'a [Strip]) -> Self {
        Self { evidence, look, place, strips, rows: place.rows.iter().map(|_| OnceCell::new()).collect() }
    }

    /// True when what one of the strips passes through of the rows, between their ends, lies between bars.
    pub fn are_beside(&self, n: usize) -> bool {
        let is_as_wide = |bay: f64| self.strips[n].width() >= AS_WIDE * bay;
        self.place.views[0].pitch.is_none_or(is_as_wide)
            && self.beside(n).is_some_and(|[sides, ends, bays]| sides.is_as(ends, bays))
    }

    /// True when bays are known and bars stand at no side of it, as they do not beside bays and do at the rows' ends.
    pub fn are_missed(&self, n: usize) -> bool {
        self.place.views[0].pitch.is_some()
            && self.beside(n).is_some_and(|[sides, ends, bays]| sides.closed == 0 && sides.is_as(bays, ends))
    }

    /// How often the sides of what one of the strips passes through are closed, and the ends of the rows of that part of the
    /// place, and what is beside their bays.
    fn beside(&self, n: usize) -> Option<[Often; 3]> {
        let own = &self.place.passing[n];
        let first = self.place.first_of(own).filter(|_| own.is_within)?;
        let part: Vec<&Closed> = self.place.rows_with(first).into_iter().map(|row| self.row(row)).collect();
        let beside = |&row: &usize| {
            let place = self.place.through[row].iter().position(|&way| way == n);
            place.map_or(Often::default(), |place| self.row(row).ways[place])
        };
        Some([
            own.rows.iter().map(beside).sum(),
            part.iter().map(|row| row.ends).sum(),
            part.iter().map(|row| row.bays).sum(),
        ])
    }

    fn row(&self, n: usize) -> &Closed {
        self.rows[n].get_or_init(|| Closed::new(self.evidence, self.look, self.place, self.strips, n))
    }
}

impl Closed {
    fn new(evidence: &Evidence, look: &Look, place: &Place, strips: &[Strip], row: usize) -> Self {
        let ([view, other], (row, between), ways) = (place.views, &place.rows[row], &place.through[row]);
        let columns = Columns::new(look, &evidence.grid.frame, [view, other], row, view.pitch);
        let middle = f64::midpoint(row.across[0], row.across[1]);
        let place_of = |across: f64| view.crossing(other, middle, across)[1];
        let sides = |way: usize| sorted(strips[way].across.map(place_of));
        let between = between.map(|aisle| place.aisles[aisle]);
        let is_at_wall = |end: f64| walled(view, strips, row, between, view.columns(wider([end; 2], NEAR))).any();
        let is_of_way = |ends: [f64; 2]| ways.iter().any(|&way| overlap(wider(sides(way), NEAR), ends) >= 0.0);
        // What leads past the row's end, or through all rows, is a way.
        let centre = f64::midpoint(row.along[0], row.along[1]);
        let known = ways.iter().flat_map(|&way| {
            let ([low, high], passing) = (sides(way), &place.passing[way]);
            match (passing.is_within, f64::midpoint(low, high) < centre) {
                (true, _) if passing.is_whole() => vec![low, high],
                (true, _) => Vec::new(),
                (false, true) => vec![high],
                (false, false) => vec![low],
            }
        });
        let own = row.along.into_iter().filter(|&end| !is_of_way([end; 2])).chain(known);
        let ends = Often::of(own.filter(|&end| !is_at_wall(end)).map(|end| columns.is_closed_at(end)));
        let free = columns.free(FREE).into_iter().filter(|&(ends, _)| !is_of_way(ends));
        // Between two bars a way may lie that is not known.
        let closed = |sides: [bool; 2]| if sides == [true; 2] { Often::default() } else { Often::of(sides) };
        let bays = free.map(|(_, sides)| closed(sides)).sum();
        let ways = ways.iter().map(|&way| Often::of(sides(way).map(|side| columns.is_closed_at(side)))).collect();
        Self { ends, bays, ways }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn often(closed: u32, open: u32) -> Often {
        Often { closed, open }
    }

    #[test]
    fn two_bars_tell_a_way_where_they_end_rows_and_do_not_stand_beside_bays() {
        assert!(often(2, 0).is_as(often(8, 0), often(0, 8)));
        assert!(!often(1, 1).is_as(often(8, 0), often(0, 8)));
        // Frames that close their bays, rows that nothing ends, and too little that is known of either.
        assert!(!often(2, 0).is_as(often(8, 0), often(4, 4)));
        assert!(!often(2, 0).is_as(often(0, 8), often(0, 8)));
        assert!(!often(2, 0).is_as(often(0, 0), often(0, 1)));
    }
}
