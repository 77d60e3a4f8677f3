//! Whether what leads through some rows of a place is an empty bay: where another way leads through all of them, and more of
//! the rows is open.

use super::corridors::Strip;
use super::passing::{Passing, Place};
use super::runs::{Run, length, outside};
use super::seldom;
use super::widths::are_alike;
use std::collections::BTreeSet;

/// Of rows some bays are empty when so much of them is open as wide, besides their ways.
const OPEN: f64 = 0.02;
/// What is open so near to a way is of that, metres.
const NEAR: f64 = 0.3;

/// True when what leads through some rows between their ends lies as empty bays do: more of the rows is open as wide
/// elsewhere, and not as many lead through each. What leads through most of them and lies open in the others is none.
pub fn is_empty(place: &Place, strips: &[Strip], n: usize) -> bool {
    let own = &place.passing[n];
    let (Some(first), width) = (place.first_of(own), strips[n].width()) else { return false };
    if !own.is_within {
        return false;
    }
    let rows = place.rows_with(first);
    let is_alike = |m: &&usize| {
        let other = &place.passing[**m];
        other.is_within && !other.next.is_empty() && are_alike(strips[**m].width(), width)
    };
    let as_many = |row: usize| place.through[row].iter().filter(is_alike).count();
    let own_many = as_many(first);
    let goes_on = || {
        let is_most = own.rows.len() > own.next.len() && own.rows.len() + own.next.len() == rows.len();
        is_most && own.next.iter().all(|&row| is_open_at(place, &strips[n], row))
    };
    rows.iter().any(|&row| as_many(row) != own_many) && have_empty_bays(place, strips, &rows, width) && !goes_on()
}

/// True when more of some rows is open over as much as a width than what leads through them.
pub fn have_empty_bays(place: &Place, strips: &[Strip], rows: &BTreeSet<usize>, width: f64) -> bool {
    let [open, all] = rows.iter().fold([0; 2], |sum, &row| {
        let own = open_besides(place, strips, row, width);
        [sum[0] + own[0], sum[1] + own[1]]
    });
    open as f64 > OPEN * all as f64
}

/// True when the rows of the part of the place that something passes through have empty bays as wide.
pub fn are_about(place: &Place, strips: &[Strip], own: &Passing, width: f64) -> bool {
    place.first_of(own).is_some_and(|first| have_empty_bays(place, strips, &place.rows_with(first), width))
}

/// True when a row is open all across a strip, were that longer.
fn is_open_at(place: &Place, strip: &Strip, row: usize) -> bool {
    let [from, to] = columns(place, strip, row, -NEAR);
    let holds = |run: &Run| run.0 <= from && to <= run.1;
    from < to && place.shelves(row).open().iter().any(holds)
}

/// How many columns of a row are open over as much as a width, and how many there are, both without those of its ways.
fn open_besides(place: &Place, strips: &[Strip], row: usize, width: f64) -> [usize; 2] {
    let shelves = place.shelves(row);
    let mut ways: Vec<Run> = place.through[row]
        .iter()
        .map(|&way| columns(place, &strips[way], row, NEAR))
        .map(|[from, to]| (from, to))
        .collect();
    ways.retain(|(from, to)| from < to);
    ways.sort_unstable();
    let least = (seldom::AS_WIDE * width / place.views[0].cell) as usize;
    let wide = outside(&shelves.open(), &ways).into_iter().filter(|(from, to)| to - from >= least);
    [length(wide), length(outside(&[(0, shelves.count())], &ways))]
}

/// From which to which of a row's columns a strip would cross it, and so much more on either side, metres.
fn columns(place: &Place, strip: &Strip, row: usize, more: f64) -> [usize; 2] {
    let [view, other] = place.views;
    let row = &place.rows[row].0;
    let [first, end] = row.along.map(|u| view.column(u));
    let [_, u] = view.crossing(other, f64::midpoint(row.across[0], row.across[1]), strip.middle());
    let reach = strip.width() / 2.0 + more;
    [u - reach, u + reach].map(|u| view.column(u).saturating_sub(first).min(end - first))
}
