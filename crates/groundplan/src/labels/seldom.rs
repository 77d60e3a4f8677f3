//! Whether rows of two racks back to back are open from aisle to aisle more often than chance makes: where the one is empty
//! the other seldom is as well, unless a way leads through both.

use super::rows::Row;
use super::runs::runs;
use super::sections::LEFT;
use super::turned::Turned;

/// Two racks back to back are so deep, metres.
const TWO: f64 = 1.5;
/// What is open over so much of a width is as wide.
const AS_WIDE: f64 = 0.85;
/// Fewer such rows tell nothing.
const ROWS: usize = 2;
/// It is not by chance that as many places are open when that is less likely than this.
const UNLIKELY: f64 = 0.01;

/// True when a row may be of two racks.
pub fn is_double(row: &Row) -> bool {
    row.depth() >= TWO
}

/// True when each of several rows side by side that are of two racks is open at a place of a width, and all are at as many as
/// they would hardly be by chance if each rack were empty where it is, whatever the other is.
pub fn are_open<'a>(view: &Turned, rows: impl Iterator<Item = &'a Row>, width: f64) -> bool {
    let (mut half_open, mut open, mut places) = (0, 0, 0.0);
    let rows: Vec<&Row> = rows.filter(|row| is_double(row)).collect();
    if rows.len() < ROWS {
        return false;
    }
    for row in rows {
        let columns = view.column(row.along[0])..view.column(row.along[1]);
        let middle = f64::midpoint(row.across[0], row.across[1]);
        let blocked = |low: f64, high: f64| view.blocked_where(columns.clone(), low, high, |share| share > LEFT);
        let blocked = [blocked(row.across[0], middle), blocked(middle, row.across[1])];
        let least = (AS_WIDE * width / view.cell).ceil().max(1.0) as usize;
        let count = columns.len();
        let as_wide = |flags: &[bool]| {
            let within = runs(flags, true).into_iter().filter(|&(from, to)| from > 0 && to < count);
            within.map(|(from, to)| (to - from) / least).sum::<usize>()
        };
        let halves = blocked.map(|blocked| (0..count).map(|n| !blocked.get(n)).collect::<Vec<bool>>());
        let both: Vec<bool> = halves[0].iter().zip(&halves[1]).map(|(one, two)| *one && *two).collect();
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

/// True when both racks would hardly be empty at so many of all places by chance, where one of them is at so many more.
fn is_more_than_chance(open: usize, half_open: f64, places: f64) -> bool {
    // How often the one is empty where the other is not.
    let shut = (places - open as f64 - half_open).max(0.0);
    let share = (half_open + 0.5) / (half_open + 2.0 * shut + 1.0);
    is_unlikely(open, places * share * share)
}

/// True when so many are unlikely where so many are expected (Poisson's distribution).
fn is_unlikely(count: usize, expected: f64) -> bool {
    let mut term = libm::exp(-expected);
    let mut fewer = 0.0;
    for n in 0..count {
        fewer += term;
        term *= expected / (n + 1) as f64;
    }
    1.0 - fewer < UNLIKELY
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_as_unlikely_as_the_distribution_says() {
        // At 0.1 two or more have a chance of 0.0047, one or more of 0.095; at 1 five or more of 0.0037, four or more of 0.019.
        for (count, expected, is_so) in
            [(0, 0.1, false), (1, 0.1, false), (2, 0.1, true), (4, 1.0, false), (5, 1.0, true)]
        {
            assert_eq!(is_unlikely(count, expected), is_so, "{count} of {expected}");
        }
    }

    #[test]
    fn where_one_of_two_racks_is_seldom_empty_both_are_not_by_chance() {
        assert!(is_more_than_chance(2, 2.0, 40.0));
        assert!(!is_more_than_chance(2, 30.0, 40.0));
        assert!(!is_more_than_chance(0, 2.0, 40.0));
    }
}
