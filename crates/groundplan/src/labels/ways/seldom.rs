//! Whether rows of racks are open from aisle to aisle more often than chance makes: where the one of two racks back to back is
//! empty the other seldom is as well, unless a way leads through both; and where hardly a shelf is empty no whole bay is.

use crate::ends::holds;
use crate::labels::rows::Row;
use crate::labels::rows::sections::is_as_bays;
use crate::labels::rows::shelves::{ENDS, Elsewhere, Shelves};
use crate::labels::view::runs::Run;
use crate::labels::view::turned::Turned;

/// Two racks back to back are so deep, metres.
const TWO: f64 = 1.5;
/// What is open over so much of a width is as wide.
pub const AS_WIDE: f64 = 0.85;
/// Shorter ones, in widths, have no room for a way between racks.
const LONG: f64 = 2.0;
/// Fewer such rows tell nothing.
const ROWS: usize = 2;
/// It is not by chance that as many places are open, and dealt to the rows as evenly, when that is less likely than this.
const UNLIKELY: f64 = 0.01;
/// The same where each of the rows is open at as many, which chance seldom makes.
const UNLIKELY_IN_FULL: f64 = 0.1;
/// Where not each of the rows is open, chance makes fewer such places than this in all of them; or fewer than this share of those that
/// are open, where no more than so many of these are as wide as posts leave of one bay or several.
const EXPECTED: f64 = 0.1;
const FALSE: f64 = 0.1;
const AS_BAYS: f64 = 0.5;
/// Posts leave so much less than the bays are long, metres.
const POSTS: [f64; 2] = [0.0, 0.3];
/// Ways as wide as bays are no more than so many of a row's places, or so many where more than so many lead through each row: where
/// both of two racks are empty at more, they are as one. Where both are at more than so many nothing but legs was seen, and these tell.
const BAYS: [f64; 2] = [0.2, 0.8];
const MANY: (f64, usize) = (0.1, 3);
/// What is open of a half for less, metres, is between its goods.
const SHELF: f64 = 0.5;
/// Something stands along so much of the faces of solid rows, and no more than so much of their halves is open.
const SOLID: (f64, f64) = (0.9, 0.01);
/// One or two places at which they are open may be shelves that are empty.
const SEVERAL: usize = 3;

/// True when a row may be of two racks.
pub fn is_double(row: &Row) -> bool {
    row.depth() >= TWO
}

/// True when several of some rows side by side that are of two racks are open at places of a width, and all are at as many as
/// they would hardly be by chance if each rack were empty where it is, whatever the other is: where one is open nowhere,
/// hardly any such place is expected at all. How evenly they are dealt to the rows counts with how many they are. Where no rack
/// is empty alone both may be emptied together, bay by bay. And if that is asked for no more than some of the places may be as
/// wide as bays are.
pub fn are_open<'a>(
    view: &Turned,
    rows: impl Iterator<Item = &'a Shelves>,
    width: f64,
    pitch: Option<f64>,
    are_no_bays: bool,
) -> bool {
    let (mut half_open, mut opens, mut places) = (0, Vec::new(), 0.0);
    let (mut widths, mut bays) = (0, 0);
    let is_long = |shelves: &&Shelves| is_double(&shelves.row) && shelves.row.length() >= LONG * width;
    let rows: Vec<&Shelves> = rows.filter(is_long).collect();
    if rows.len() < ROWS {
        return false;
    }
    let count = rows.len();
    let least = (AS_WIDE * width / view.cell).ceil().max(1.0) as usize;
    for shelves in rows {
        let as_wide = |runs: &[Run]| {
            let within = runs.iter().filter(|run| !shelves.is_end(**run));
            within.map(|(from, to)| (to - from) / least).sum::<usize>()
        };
        let passable = shelves.passable(view);
        let own = as_wide(&passable);
        let wide = passable.iter().filter(|run| run.1 - run.0 >= least && !shelves.is_end(**run));
        for (from, to) in wide {
            widths += 1;
            bays += usize::from(pitch.is_none_or(|pitch| is_left_by_posts((to - from) as f64 * view.cell, pitch)));
        }
        opens.push(own);
        half_open += shelves.halves.iter().map(|half| as_wide(half).saturating_sub(own)).sum::<usize>();
        places += shelves.seen(view) / width;
    }
    let open = opens.iter().sum();
    let open_rows = opens.iter().filter(|own| **own > 0).count();
    let expected = by_chance(open, half_open as f64, places);
    let may_be_bay = pitch.is_some_and(|pitch| is_as_bays(width, pitch));
    // Both racks may be emptied together, bay by bay: what is as wide as posts leave is then most of what is open.
    let are_few = bays as f64 <= AS_BAYS * widths as f64;
    let share = if open > MANY.1 * count { MANY.0 } else { BAYS[0] };
    open_rows >= ROWS
        && (are_few || !are_no_bays)
        && !(may_be_bay && half_open > 0 && holds([share, BAYS[1]], open as f64 / places))
        && likely(open, expected) * evenly(&opens) < UNLIKELY
        && (open_rows == count
            || open >= SEVERAL
                && (expected < EXPECTED || are_few && expected < FALSE * open as f64)
                && (half_open > 0 || !may_be_bay))
}

/// True when something is as wide as posts leave of a bay, or of some beside one another.
fn is_left_by_posts(width: f64, pitch: f64) -> bool {
    let bays = ((width + POSTS[1] / 2.0) / pitch).round().max(1.0);
    holds(POSTS, bays * pitch - width)
}

/// Rows side by side but for some places at which they are open.
pub struct Rest<'a> {
    view: &'a Turned,
    rows: Vec<Elsewhere<'a>>,
    /// Columns of a width, of both the rows' halves and of those at which a half is open.
    width: f64,
    halves: f64,
    free: f64,
}

impl<'a> Rest<'a> {
    /// But for where they are open at a width.
    pub fn new(view: &'a Turned, rows: impl Iterator<Item = &'a Shelves>, width: f64) -> Self {
        Self::but_for(view, rows, width, width / AS_WIDE)
    }

    /// But for where they are open at a width and at wider ones.
    pub fn but_for_wider(view: &'a Turned, rows: impl Iterator<Item = &'a Shelves>, width: f64) -> Self {
        Self::but_for(view, rows, width, f64::INFINITY)
    }

    fn but_for(view: &'a Turned, rows: impl Iterator<Item = &'a Shelves>, width: f64, widest: f64) -> Self {
        let [least, most] = [AS_WIDE * width / view.cell, widest / view.cell + ENDS as f64];
        let as_wide = |length: usize| (least..=most).contains(&(length as f64));
        let rows: Vec<Elsewhere> = rows.map(|shelves| shelves.elsewhere(view, as_wide)).collect();
        let free = rows.iter().map(|row| row.free(SHELF / view.cell)).sum::<usize>() as f64;
        let halves = 2.0 * rows.iter().map(Elsewhere::columns).sum::<usize>() as f64;
        Self { view, rows, width: width / view.cell, halves, free }
    }

    /// At how many places, but for those past their ends, the rows are open that were left out.
    pub fn open(&self) -> usize {
        self.rows.iter().map(|row| row.open).sum()
    }

    /// True when the rows are of two racks and stand solid but for several places, however many each has.
    pub fn is_solid(&self) -> bool {
        self.open() >= SEVERAL && self.rows.iter().all(|row| is_double(&row.shelves.row)) && self.is_closed()
    }

    /// True when next to nothing of the rows is open but for those places, and something stands all along their faces.
    pub fn is_closed(&self) -> bool {
        self.halves > 0.0 && self.free <= SOLID.1 * self.halves && self.stands() >= SOLID.0 * self.halves
    }

    /// True when so little else of the rows' halves is open that as many places would hardly be by chance, and something stands
    /// all along the faces of what is closed.
    pub fn is_seldom_open(&self) -> bool {
        self.halves > 0.0 && self.by_chance() < UNLIKELY && self.stands() >= SOLID.0 * (self.halves - self.free)
    }

    /// At how many columns of their faces something stands elsewhere.
    fn stands(&self) -> f64 {
        self.rows.iter().map(|row| row.stands(self.view)).sum::<usize>() as f64
    }

    /// True when each row has as many places, as where a way leads through each, or as nearly as many as chance seldom deals
    /// them, and so little else of their halves is open that as many would hardly be by chance: no shelves are empty there.
    pub fn is_full(&self) -> bool {
        self.are_as_many() && self.by_chance() < UNLIKELY_IN_FULL
    }

    /// How likely as many places would be if halves were open there as often as they are elsewhere, whatever the other is.
    fn by_chance(&self) -> f64 {
        // Half a place more is open and one more is there, as so few tell little.
        let share = (self.free + 0.5 * self.width) / (self.halves + self.width);
        likely(self.open(), self.halves / 2.0 / self.width * share * share)
    }

    /// True when each row is open at as many places, or at as nearly as many as chance seldom deals them.
    fn are_as_many(&self) -> bool {
        // In pieces that are too short for any there is none.
        let long = self.rows.iter().filter(|row| row.shelves.count() as f64 >= LONG * self.width);
        let open: Vec<usize> = long.map(|row| row.open).collect();
        let (Some(least), Some(most)) = (open.iter().min(), open.iter().max()) else { return false };
        least == most || *least > 0 && evenly(&open) < UNLIKELY_IN_FULL
    }
}

/// How likely it is that chance deals as many places to some rows as evenly, where none has two more than another; else it is sure.
fn evenly(places: &[usize]) -> f64 {
    let [least, most] = places.iter().fold([usize::MAX, 0], |[a, b], own| [a.min(*own), b.max(*own)]);
    if least + 1 >= most { dealt_so_evenly(places.iter().sum(), places.len()) } else { 1.0 }
}

/// How likely it is that of places dealt to rows by chance, each row as likely as another, none has two more than another.
fn dealt_so_evenly(places: usize, rows: usize) -> f64 {
    let (least, more) = (places / rows, places % rows);
    let factorial = |n: usize| (1..=n).map(|n| libm::log(n as f64)).sum::<f64>();
    let which = factorial(rows) - factorial(more) - factorial(rows - more);
    let each = rows as f64 * factorial(least) + more as f64 * libm::log((least + 1) as f64);
    libm::exp(which + factorial(places) - each - places as f64 * libm::log(rows as f64))
}

/// At how many of all places both racks are expected to be empty by chance, where both are at so many and one of them is at so
/// many more.
fn by_chance(open: usize, half_open: f64, places: f64) -> f64 {
    // How often the one is empty where the other is not.
    let shut = (places - open as f64 - half_open).max(0.0);
    let share = (half_open + 0.5) / (half_open + 2.0 * shut + 1.0);
    places * share * share
}

/// How likely so many or more are where so many are expected (Poisson's distribution).
fn likely(count: usize, expected: f64) -> f64 {
    let mut term = libm::exp(-expected);
    let mut fewer = 0.0;
    for n in 0..count {
        fewer += term;
        term *= expected / (n + 1) as f64;
    }
    1.0 - fewer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_as_likely_as_the_distribution_says() {
        for (count, expected, said) in
            [(0, 0.1, 1.0), (1, 0.1, 0.0952), (2, 0.1, 0.0047), (4, 1.0, 0.0190), (5, 1.0, 0.0037)]
        {
            assert!((likely(count, expected) - said).abs() < 1e-4, "{count} of {expected}");
        }
    }

    #[test]
    fn places_are_dealt_as_evenly_as_counting_says() {
        // Of 27 deals of three places to three rows six have one in each, of 81 of four 36 two in one and one in the others.
        for (places, rows, said) in [(3, 3, 6.0 / 27.0), (4, 3, 36.0 / 81.0), (2, 2, 0.5), (400, 1, 1.0)] {
            assert!((dealt_so_evenly(places, rows) - said).abs() < 1e-9, "{places} to {rows}");
        }
        assert!(dealt_so_evenly(1000, 500) < 1e-9);
    }

    #[test]
    fn where_one_of_two_racks_is_seldom_empty_both_are_not_by_chance() {
        let is_more_than_chance = |open, half_open| likely(open, by_chance(open, half_open, 40.0)) < UNLIKELY;
        assert!(is_more_than_chance(2, 2.0));
        assert!(!is_more_than_chance(2, 30.0));
        assert!(!is_more_than_chance(0, 2.0));
    }
}
