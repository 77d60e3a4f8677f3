//! Whether rows of racks are open from aisle to aisle more often than chance makes: where the one of two racks back to back is
//! empty the other seldom is as well, unless a way leads through both; and where hardly a shelf is empty no whole bay is.

use super::rows::Row;
use super::runs::runs;
use super::sections::{FACE, LEFT};
use super::turned::Turned;

/// Two racks back to back are so deep, metres.
const TWO: f64 = 1.5;
/// What is open over so much of a width is as wide.
pub const AS_WIDE: f64 = 0.85;
/// So many cells on either side of what is open are of its ends.
const ENDS: usize = 2;
/// Shorter ones, in widths, have no room for a way between racks.
const LONG: f64 = 2.0;
/// Fewer such rows tell nothing.
const ROWS: usize = 2;
/// It is not by chance that as many places are open when that is less likely than this.
const UNLIKELY: f64 = 0.01;
/// The same where each of the rows is open at as many, which chance seldom makes.
const UNLIKELY_IN_FULL: f64 = 0.1;
/// What is open of a half for less, metres, is between its goods.
const SHELF: f64 = 0.5;
/// Something stands along so much of the faces of rows without bays.
const SOLID: f64 = 0.97;

/// True when a row may be of two racks.
pub fn is_double(row: &Row) -> bool {
    row.depth() >= TWO
}

/// True when each of several rows side by side that are of two racks is open at a place of a width, and all are at as many as
/// they would hardly be by chance if each rack were empty where it is, whatever the other is.
pub fn are_open<'a>(view: &Turned, rows: impl Iterator<Item = &'a Row>, width: f64) -> bool {
    let (mut half_open, mut open, mut places) = (0, 0, 0.0);
    let rows: Vec<&Row> = rows.filter(|row| is_double(row) && row.length() >= LONG * width).collect();
    if rows.len() < ROWS {
        return false;
    }
    for row in rows {
        let halves = open_halves(view, row);
        let count = halves[0].len();
        let least = (AS_WIDE * width / view.cell).ceil().max(1.0) as usize;
        let as_wide = |flags: &[bool]| {
            let within = runs(flags, true).into_iter().filter(|&(from, to)| from > 0 && to < count);
            within.map(|(from, to)| (to - from) / least).sum::<usize>()
        };
        let both = both_open(&halves);
        let own = as_wide(&both);
        if own == 0 {
            return false;
        }
        open += own;
        half_open += halves.iter().map(|half| as_wide(half).saturating_sub(own)).sum::<usize>();
        places += row.length() / width;
    }
    is_more_than_chance(open, half_open as f64, places)
}

/// True when rows side by side are each open at as many places of a width, as where a way leads through each, and so little
/// else of their halves is that as many would hardly be by chance: no shelves are empty there.
pub fn are_full_elsewhere<'a>(view: &Turned, rows: impl Iterator<Item = &'a Row>, width: f64) -> bool {
    let (mut ways, mut free, mut all, mut faced) = (Vec::new(), 0, 0, 0);
    let [least, most] = [AS_WIDE * width / view.cell, width / AS_WIDE / view.cell + ENDS as f64];
    for row in rows {
        let mut halves = open_halves(view, row);
        let count = halves[0].len();
        // Past its ends a row is open too: ways lead there.
        let is_past_end = |&(from, to): &(usize, usize)| from == 0 || to == count;
        let is_as_wide = |(from, to): &(usize, usize)| (least..=most).contains(&((to - from) as f64));
        let (ends, within): (Vec<_>, Vec<_>) = runs(&both_open(&halves), true).into_iter().partition(is_past_end);
        let open: Vec<_> = within.into_iter().filter(is_as_wide).collect();
        let mut is_elsewhere = vec![true; count];
        for &(from, to) in ends.iter().chain(&open) {
            let beside = from.saturating_sub(ENDS)..(to + ENDS).min(count);
            is_elsewhere[beside.clone()].fill(false);
            for half in &mut halves {
                half[beside.clone()].fill(false);
            }
        }
        ways.push(open.len());
        let first = view.column(row.along[0]);
        for face in row.across {
            let stands = view.some_occupied(first..first + count, face - FACE, face + FACE);
            faced += stands.iter().zip(&is_elsewhere).filter(|(share, is)| **share > 0.0 && **is).count();
        }
        all += 2 * is_elsewhere.into_iter().filter(|is| *is).count();
        let lengths = halves.iter().flat_map(|half| runs(half, true)).map(|(from, to)| to - from);
        free += lengths.filter(|length| *length as f64 >= SHELF / view.cell).sum::<usize>();
    }
    // Rows that nothing of is open, and along which something stands all the way, have no bays that could be empty.
    if free == 0 && faced as f64 >= SOLID * all as f64 {
        return true;
    }
    if ways.iter().any(|n| *n != ways[0]) {
        return false;
    }
    // Half a place more is open and one more is there, as so few tell little.
    let [free, all, own] = [free as f64, all as f64, width / view.cell];
    let share = (free + 0.5 * own) / (all + own);
    chance(ways.iter().sum(), all / 2.0 / own * share * share) < UNLIKELY_IN_FULL
}

/// In which columns each half of a row is open.
fn open_halves(view: &Turned, row: &Row) -> [Vec<bool>; 2] {
    let columns = view.column(row.along[0])..view.column(row.along[1]);
    let middle = f64::midpoint(row.across[0], row.across[1]);
    [[row.across[0], middle], [middle, row.across[1]]].map(|[low, high]| {
        let blocked = view.blocked_where(columns.clone(), low, high, |share| share > LEFT);
        (0..columns.len()).map(|n| !blocked.get(n)).collect()
    })
}

/// In which columns a row is open from aisle to aisle.
pub fn open(view: &Turned, row: &Row) -> Vec<bool> {
    both_open(&open_halves(view, row))
}

fn both_open([one, two]: &[Vec<bool>; 2]) -> Vec<bool> {
    one.iter().zip(two).map(|(one, two)| *one && *two).collect()
}

/// True when both racks would hardly be empty at so many of all places by chance, where one of them is at so many more.
fn is_more_than_chance(open: usize, half_open: f64, places: f64) -> bool {
    // How often the one is empty where the other is not.
    let shut = (places - open as f64 - half_open).max(0.0);
    let share = (half_open + 0.5) / (half_open + 2.0 * shut + 1.0);
    chance(open, places * share * share) < UNLIKELY
}

/// How likely so many or more are where so many are expected (Poisson's distribution).
fn chance(count: usize, expected: f64) -> f64 {
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
            assert!((chance(count, expected) - said).abs() < 1e-4, "{count} of {expected}");
        }
    }

    #[test]
    fn where_one_of_two_racks_is_seldom_empty_both_are_not_by_chance() {
        assert!(is_more_than_chance(2, 2.0, 40.0));
        assert!(!is_more_than_chance(2, 30.0, 40.0));
        assert!(!is_more_than_chance(0, 2.0, 40.0));
    }
}
