//! Bars across the ends of rows: where they stand there, and seldom beside empty bays, what lies between two of them is a way,
//! be it as wide as bays and through one row alone, and what has none is a bay.

use super::lead::Lead;
use super::passing::Place;
use super::seldom;
use super::walled;
use crate::ends::{overlap, wider};
use crate::labels::Evidence;
use crate::labels::corridors::Strip;
use crate::labels::junctions::meeting::CLUTTER;
use crate::labels::rows::SHORTEST;
use crate::labels::rows::closing::Closing;
use crate::labels::rows::sections::{Columns, SIDE};
use crate::labels::view::look::Look;
use std::borrow::Cow;
use std::cell::OnceCell;
use std::iter::{self, Sum};

/// What is so near to a way's sides is of that, metres, and a wall so near to a row's end ends it.
const NEAR: f64 = 0.3;
/// What lies between bars is no narrower than so many bays: posts or goods narrow an empty one.
const AS_WIDE: f64 = 0.95;
/// A post, with what an edge is off on either side, takes so much of a bay, metres.
const POST: f64 = 0.25;
/// Posts and goods narrow no empty bay by so much, metres; half of one, with what goods leave beside it, is no wider than this share.
const NARROWER: f64 = 0.4;
const MORE_THAN_HALF: f64 = 0.62;
/// Of all that are as wide but for so much, metres, as where posts and goods narrow them, one in so many leads through two racks.
const ALIKE: f64 = 0.16;
const DOUBLE: usize = 3;
/// Fewer others tell nothing.
const OTHERS: usize = 3;
/// What shares so much of a way's width is in line with it.
const IN_LINE: f64 = 0.5;
/// A way is told from an empty bay by its sides when these are so many times as likely those of the one as those of the other.
const LIKELIER: f64 = 10.0;
/// Where racks end is sought in such steps, metres.
const STEP: f64 = 0.1;
/// Rows that are closed at so many ends end at sheets where so large a share of these are.
const SHEETS: (u32, f64) = (2, 0.7);

/// Which of some strips lie between bars, from one on; of all the places are known that they lead through.
pub fn are_between(evidence: &Evidence, look: &Look, places: &[Place], strips: &[Strip], first: usize) -> Vec<bool> {
    let bars: Vec<Bars> = places.iter().map(|place| Bars::new(evidence, look, place, strips)).collect();
    (first..strips.len()).map(|n| bars.iter().any(|bars| bars.are_beside(n) || bars.are_beside_all(n))).collect()
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

    /// True when it is clearly closed as often as the one, and not as the other.
    fn is_as(self, one: Self, other: Self) -> bool {
        self.likelihood(one.share()) > LIKELIER * self.likelihood(other.share())
    }
}

impl Sum for Often {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), Self::and)
    }
}

/// How often bars stand at the rows' ends in a part of a place, and beside bays; and whether those are sheets.
#[derive(Clone, Copy)]
struct Part {
    ends: Often,
    bays: Often,
    has_sheets: bool,
}

impl Part {
    fn new(rows: &[&Closed]) -> Self {
        let ends = || rows.iter().flat_map(|row| row.ends.iter().copied());
        let [closed, sheets] = [Closing::Whole, Closing::Sheet].map(|least| Often::of(ends().map(|end| end >= least)));
        // Between two bars a way may lie that is not known.
        let bays = rows.iter().flat_map(|row| &row.bays).filter(|sides| sides.iter().any(|side| !side.is_whole()));
        Self {
            ends: closed,
            bays: Often::of(bays.flatten().copied().map(Closing::is_whole)),
            has_sheets: closed.closed >= SHEETS.0 && f64::from(sheets.closed) >= SHEETS.1 * f64::from(closed.closed),
        }
    }
}

/// How often bars stand at the sides of something, and what they do in its part of the place.
struct Told {
    sides: Often,
    /// True when all of them are sheets.
    are_sheets: bool,
    part: Part,
}

impl Told {
    /// They stand there as at rows' ends.
    fn is_way(&self) -> bool {
        self.sides.is_as(self.part.ends, self.part.bays)
    }

    /// They stand at all sides, and at most ends.
    fn is_closed(&self) -> bool {
        self.sides.open == 0 && self.part.ends.closed > self.part.ends.open
    }

    /// Sheets do: goods of two racks seldom stand so.
    fn is_between_sheets(&self) -> bool {
        self.are_sheets && self.part.has_sheets && self.is_closed()
    }

    /// None stands there, as beside bays.
    fn is_bay(&self) -> bool {
        self.sides.closed == 0 && self.sides.is_as(self.part.bays, self.part.ends)
    }
}

/// What closes the rows of a place: each is looked at when it is first asked.
pub struct Bars<'a> {
    evidence: &'a Evidence<'a>,
    look: &'a Look<'a>,
    place: &'a Place<'a>,
    strips: &'a [Strip],
    rows: Vec<OnceCell<Closed<'a>>>,
    /// How the sides of each strip are closed in all rows that it passes through, once it is asked.
    closed: Vec<OnceCell<Vec<Closing>>>,
}

/// A row, and how it is closed at its ends, but for those at walls, and on both sides of what is free of it and no way.
struct Closed<'a> {
    columns: Columns<'a>,
    /// Of two racks: what no flue parts is a sheet there.
    is_double: bool,
    ends: Vec<Closing>,
    bays: Vec<[Closing; 2]>,
}

impl Closed<'_> {
    /// How the row is closed at a place along.
    fn closing_at(&self, along: f64) -> Closing {
        of_racks(self.is_double, self.columns.closing_at(along))
    }
}

/// How one or two racks are closed: one has no flue that would part a sheet.
fn of_racks(are_two: bool, closing: Closing) -> Closing {
    if closing == Closing::Whole && !are_two { Closing::Sheet } else { closing }
}

impl<'a> Bars<'a> {
    pub fn new(evidence: &'a Evidence, look: &'a Look, place: &'a Place, strips: &'a [Strip]) -> Self {
        let rows = place.rows.iter().map(|_| OnceCell::new()).collect();
        let closed = strips.iter().map(|_| OnceCell::new()).collect();
        Self { evidence, look, place, strips, rows, closed }
    }

    /// True when what one of the strips passes through of the rows, between their ends, lies between bars and is no narrower than a
    /// bay, if bays are known. Through all rows that there are it may be narrower by a post if these are of two racks and bars stand
    /// at all its sides: goods seldom line up so there.
    pub fn are_beside(&self, n: usize) -> bool {
        let own = &self.place.passing[n];
        let bay = self.place.pitch_of(own).unwrap_or(0.0);
        let is_as_wide = |least: f64| self.strips[n].width() >= least;
        let is_all = || own.next.is_empty() && self.place.are_double(own) && self.are_all_beside(n);
        is_as_wide(AS_WIDE * bay) && self.tell(n) || is_as_wide(bay - POST) && is_all()
    }

    /// True when bars stand beside what one of the strips passes through of the rows as at their ends, and not as beside bays.
    pub fn tell(&self, n: usize) -> bool {
        self.told(n, &self.place.passing[n].rows).is_some_and(|told| told.is_way())
    }

    /// True when one of the strips lies between bars and is too narrow for a bay, and what is as wide in its part of the place lies
    /// between bars as often as rows end at them: many do, and enough of them through two racks back to back, whose goods seldom
    /// line up as a bar does.
    pub fn are_beside_all(&self, n: usize) -> bool {
        let (own, width) = (&self.place.passing[n], self.strips[n].width());
        let is_no_bay = |bay: f64| width <= bay - NARROWER && width >= MORE_THAN_HALF * bay;
        let may_be = self.place.pitch_of(own).is_some_and(is_no_bay);
        let Some(told) = self.told(n, &own.rows).filter(|told| may_be && told.sides.open == 0) else {
            return false;
        };
        if self.place.are_double(own) && told.is_between_sheets() {
            return true;
        }
        let Some(part) = self.place.first_of(own).map(|row| self.place.rows_with(row)) else { return false };
        let is_alike = |&m: &usize| {
            let other = &self.place.passing[m];
            m != n
                && other.is_within
                && (self.strips[m].width() - width).abs() <= ALIKE
                && !other.rows.is_empty()
                && other.rows.iter().all(|row| part.contains(row))
        };
        let others: Vec<usize> = (0..self.strips.len()).filter(is_alike).collect();
        let sides = told
            .sides
            .and(others.iter().map(|&m| Often::of(self.closed(m).iter().copied().map(Closing::is_whole))).sum());
        let is_of_two_racks = |m: &&usize| self.place.are_double(&self.place.passing[**m]);
        let double = iter::once(&n).chain(&others).filter(is_of_two_racks).count();
        others.len() >= OTHERS && DOUBLE * double > others.len() && Told { sides, ..told }.is_way()
    }

    /// True when bars stand at all sides of what one of the strips passes through, and end most rows.
    fn are_all_beside(&self, n: usize) -> bool {
        self.told(n, &self.place.passing[n].rows).is_some_and(|told| told.is_closed())
    }

    /// True when they do, and beside no bay.
    pub fn stand_beside_no_bays(&self, n: usize) -> bool {
        self.told(n, &self.place.passing[n].rows).is_some_and(|told| told.is_closed() && told.part.bays.closed == 0)
    }

    /// True when each of the rows whose ends one of the strips leads past ends there at a bar, as most do in that part of the
    /// place, and none stands beside a bay.
    pub fn end_rows_before(&self, n: usize) -> bool {
        let own = &self.place.passing[n];
        let Some(first) = self.place.first_of(own).filter(|_| !own.is_within) else { return false };
        let Part { ends, bays, .. } = self.part_with(first);
        bays.closed == 0 && ends.closed > ends.open && self.are_before_bars(n, 0.0)
    }

    /// True when all rows that one of the strips passes through end at bars, no farther before it than so much, metres.
    pub fn are_before_bars(&self, n: usize, off: f64) -> bool {
        let is_barred = |&row: &usize| {
            let sides = self.sides(n, row);
            let inner = self.place.rows[row].0.inner(sides);
            let inwards = if inner > f64::midpoint(sides[0], sides[1]) { STEP } else { -STEP };
            let mut steps = 0..=(off / STEP) as usize;
            steps.any(|step| self.row(row).columns.is_closed_at(inner + step as f64 * inwards))
        };
        self.place.passing[n].rows.iter().all(is_barred)
    }

    /// True when no bar stands at a side of what one of the strips passes through, though bars end the rows and do not stand
    /// beside their bays, which are known.
    pub fn are_missed(&self, n: usize) -> bool {
        self.is_bay(n, &self.place.passing[n].rows)
    }

    /// True when something of the rows beside one of the strips stands where it would lead through them.
    pub fn reach_into(&self, n: usize) -> bool {
        !self.place.passing[n].next.iter().all(|&row| self.row(row).columns.is_bare(self.sides(n, row)))
    }

    /// True when something of them stands in the half of it that lies at one of its sides.
    pub fn reach_into_half(&self, n: usize, side: usize) -> bool {
        let half = self.strips[n].half(side);
        let sides = |row: usize| Lead { views: self.place.views, row: &self.place.rows[row].0, strip: &half }.sides();
        !self.place.passing[n].next.iter().all(|&row| self.row(row).columns.is_bare(sides(row)))
    }

    /// True when nothing of the rows that one of the strips passes through stands in it.
    pub fn are_bare(&self, n: usize) -> bool {
        self.place.passing[n].rows.iter().all(|&row| self.row(row).columns.is_bare(self.sides(n, row)))
    }

    /// True when posts that stand within what one of the strips passes through part it in each of the rows, between their ends, where
    /// it is an empty bay and a part of the next, or that backs of racks close it there.
    pub fn are_parted(&self, n: usize) -> bool {
        let own = &self.place.passing[n];
        own.is_within && own.rows.iter().all(|&row| self.is_parted_in(n, row) || self.is_backed(n, row))
    }

    /// True when one of the strips is as wide as bays of two racks, and in each of its rows a flue parts what closes a side, where
    /// rows end at sheets.
    pub fn is_beside_flues(&self, n: usize) -> bool {
        let own = &self.place.passing[n];
        let first = self.place.first_of(own).filter(|_| own.is_within && self.place.pitch_of(own).is_some());
        let is_flued = |&row: &usize| {
            let sides = self.sides(n, row).map(|side| self.row(row).closing_at(side));
            sides.contains(&Closing::Whole)
        };
        self.place.is_as_bays(own, self.strips[n].width())
            && own.rows.iter().all(is_flued)
            && first.is_some_and(|first| self.part_with(first).has_sheets)
    }

    /// True when backs of racks stand across a strip in one row.
    fn is_backed(&self, n: usize, row: usize) -> bool {
        self.place.shelves(row).is_backed(self.place.views[0], self.sides(n, row))
    }

    /// True when posts part a strip in one row, were it so long, into pieces none of which is wider than a bay.
    fn is_parted_in(&self, n: usize, row: usize) -> bool {
        self.row(row).columns.is_parted(self.sides(n, row))
    }

    /// One of the strips without the rows in which posts stand between its sides and bars beside it are missed, or that backs of
    /// racks close: it is in pieces then, and where the next row is such a one it stops. Nothing where it stays as it is.
    pub fn cut(&self, n: usize) -> Option<Vec<Strip>> {
        let (own, strip) = (&self.place.passing[n], &self.strips[n]);
        if !own.is_within {
            return None;
        }
        let mut ends = strip.stops;
        for row in own.next.iter().copied().filter(|&row| !self.is_led_through(n, row) && self.has_bay(n, row)) {
            ends[usize::from(self.along(n, row)[0] > strip.along[0])] = true;
        }
        let (bays, ways): (Vec<_>, Vec<_>) = own.rows.iter().copied().partition(|&row| self.has_bay(n, row));
        if bays.is_empty() || ways.is_empty() {
            return (ends != strip.stops).then(|| vec![Strip { stops: ends, ..strip.clone() }]);
        }
        let mut without: Vec<[f64; 2]> = bays.iter().map(|&row| self.along(n, row)).collect();
        without.sort_by(|one, two| one[0].total_cmp(&two[0]));
        let leads_through = |along| ways.iter().any(|&row| overlap(along, self.along(n, row)) > SHORTEST);
        let [mut from, last] = strip.along;
        let mut pieces = Vec::new();
        for [to, next] in without.into_iter().chain(iter::once([last; 2])) {
            if leads_through([from, to]) {
                let stops = [ends[0] || from != strip.along[0], ends[1] || to != last];
                pieces.push(Strip { along: [from, to], stops, ..strip.clone() });
            }
            from = from.max(next);
        }
        Some(pieces)
    }

    /// True when a strip leads over an empty bay of a row, by its back or by its posts, and where they do not part it by the bars.
    /// What costs least is asked first.
    fn has_bay(&self, n: usize, row: usize) -> bool {
        // What would part one that leads through all rows of a place was left in it.
        let is_parted = || !self.place.passing[n].is_whole() && self.is_parted_in(n, row);
        let by_bars = || self.row(row).columns.posts_between(self.sides(n, row)) && self.is_bay(n, &[row]);
        let is_known = || self.place.pitch_of(&self.place.passing[n]).is_some();
        self.lead(n, row).is_within()
            && (self.is_backed(n, row) || is_known() && self.passes_by(n, row) && (is_parted() || by_bars()))
    }

    /// True when bays are known, and what some rows have between the sides of a strip is one by the bars.
    fn is_bay(&self, n: usize, rows: &[usize]) -> bool {
        self.place.pitch_of(&self.place.passing[n]).is_some() && self.told(n, rows).is_some_and(|told| told.is_bay())
    }

    /// What bars tell of a strip in some rows, where it passes between rows' ends.
    fn told(&self, n: usize, rows: &[usize]) -> Option<Told> {
        let first = self.place.first_of(&self.place.passing[n]).filter(|_| self.place.passing[n].is_within)?;
        let part = self.part_with(first);
        let is_all = rows == self.place.passing[n].rows;
        let closed = if is_all { Cow::Borrowed(self.closed(n)) } else { Cow::Owned(self.closed_in(n, rows)) };
        let are_sheets = closed.iter().all(|side| *side == Closing::Sheet);
        Some(Told { sides: Often::of(closed.iter().copied().map(Closing::is_whole)), are_sheets, part })
    }

    /// How the rows that one of the strips passes through are closed at its sides.
    fn closed(&self, n: usize) -> &[Closing] {
        self.closed[n].get_or_init(|| self.closed_in(n, &self.place.passing[n].rows))
    }

    /// The same of some rows.
    fn closed_in(&self, n: usize, rows: &[usize]) -> Vec<Closing> {
        rows.iter().flat_map(|&row| self.sides(n, row).map(|side| self.row(row).closing_at(side))).collect()
    }

    /// The part of the place that a row is of.
    fn part_with(&self, row: usize) -> Part {
        let rows: Vec<&Closed> = self.place.rows_with(row).into_iter().map(|row| self.row(row)).collect();
        Part::new(&rows)
    }

    /// A strip across a row.
    fn lead(&self, n: usize, row: usize) -> Lead<'a> {
        Lead { views: self.place.views, row: &self.place.rows[row].0, strip: &self.strips[n] }
    }

    /// From the middle of the aisle on a row's one side to that on the other, along a strip.
    fn along(&self, n: usize, row: usize) -> [f64; 2] {
        let middle = |aisle: usize| self.strips[self.place.aisles[aisle]].middle();
        self.lead(n, row).along(self.place.rows[row].1.map(middle))
    }

    /// From where to where along a row a strip lies.
    fn sides(&self, n: usize, row: usize) -> [f64; 2] {
        self.lead(n, row).sides()
    }

    /// How far a row ends before the outer side of a strip that leads past its end, or would, metres.
    pub fn clear_of_side(&self, n: usize, row: usize) -> Option<f64> {
        let (sides, along) = (self.sides(n, row), self.place.rows[row].0.along);
        let is_low = f64::midpoint(sides[0], sides[1]) < f64::midpoint(along[0], along[1]);
        let off = self.row(row).columns.first(is_low)[0]?;
        Some(if is_low { along[0] + off - sides[0] } else { sides[1] - along[1] + off })
    }

    /// True when another leads through a row in line with a strip.
    fn is_led_through(&self, n: usize, row: usize) -> bool {
        let own = &self.strips[n];
        self.place.through[row]
            .iter()
            .any(|&m| m != n && overlap(self.strips[m].across, own.across) > IN_LINE * own.width())
    }

    /// True when something of a row stands in a strip, and one gets past it.
    fn passes_by(&self, n: usize, row: usize) -> bool {
        let (lead, other) = (self.lead(n, row), self.place.views[1]);
        let ([low, high], along) = (wider(lead.strip.across, -SIDE), lead.along(lead.row.across));
        let blocked = if low < high { other.some_blocked(other.columns(along), low, high) } else { Vec::new() };
        blocked.iter().any(|share| *share > 0.0) && blocked.iter().all(|share| *share <= CLUTTER)
    }

    fn row(&self, n: usize) -> &Closed<'a> {
        self.rows[n].get_or_init(|| self.look_at(n))
    }

    fn look_at(&self, n: usize) -> Closed<'a> {
        let (place, strips) = (self.place, self.strips);
        let ([view, other], (row, between), ways) = (place.views, &place.rows[n], &place.through[n]);
        let columns = Columns::new(self.look, &self.evidence.grid.frame, [view, other], row, view.pitch_of(row));
        let sides = |way: usize| self.sides(way, n);
        let between = between.map(|aisle| place.aisles[aisle]);
        let is_at_wall = |end: f64| walled::ends(view, strips, row, between, view.columns(wider([end; 2], NEAR))).any();
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
        let is_double = seldom::is_double(row);
        let of_racks = |closing: Closing| of_racks(is_double, closing);
        let ends = own.filter(|&end| !is_at_wall(end)).map(|end| of_racks(columns.closing_at(end))).collect();
        let free = columns.free().into_iter().filter(|(ends, _)| !is_of_way(*ends));
        let bays = free.map(|(_, closed)| closed.map(of_racks)).collect();
        Closed { columns, is_double, ends, bays }
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
