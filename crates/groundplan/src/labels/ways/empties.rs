//! How much of the rows of a place is open as empty bays are, besides the ways through them, and what of that chance would put
//! in line.

use super::passing::{Passing, Place};
use super::seldom;
use super::widths::are_alike;
use crate::labels::corridors::Strip;
use crate::labels::view::runs::{Run, length, outside};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// Of rows some bays are empty when so much of them is open as wide, besides their ways.
const OPEN: f64 = 0.02;
/// Of a way no less than this share of its width is left where goods reach into it.
const LEFT: f64 = 0.6;
/// What is open so near to a way is of that, metres.
const NEAR: f64 = 0.3;

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

/// How many places would be expected at which chance opens as many rows one beside another as wide, by how much of each of
/// those that a strip leads through, and of all of their part, is so elsewhere; nothing where it leads through walls alone. What
/// else is as wide counts as empty bays, but for what leads through all rows or through the same ones: of several ways none
/// speaks against another.
pub fn expected(place: &Place, strips: &[Strip], n: usize) -> Option<f64> {
    expected_of(place, strips, n, false)
}

/// The same of places along the faces of which nothing stands either.
pub fn expected_bare(place: &Place, strips: &[Strip], n: usize) -> Option<f64> {
    expected_of(place, strips, n, true)
}

fn expected_of(place: &Place, strips: &[Strip], n: usize, are_bare: bool) -> Option<f64> {
    let (own, width) = (&place.passing[n], strips[n].width());
    let part = place.rows_with(place.first_of(own)?);
    let is_way = |other: &Passing| other.is_within && other.is_whole() || own.racks > 1 && other.rows == own.rows;
    let is_left_out = |way: usize| way == n || is_way(&place.passing[way]) || !are_alike(strips[way].width(), width);
    let places = |columns: usize| columns as f64 * place.views[0].cell / width;
    // Goods reach into it in some rows: what is open elsewhere as far as it is there counts as well.
    let free = own.rows.iter().map(|&row| widest_within(place, &strips[n], row)).fold(width, f64::min);
    let least = free.max(LEFT * width);
    let of_row = |row: usize| open_without(place, strips, row, least, are_bare, is_left_out).map(places);
    let all: Vec<[f64; 2]> = part.iter().map(|&row| of_row(row)).collect();
    let [open, count] = all.iter().fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
    // As if half a place more were open and one more were there: few tell little.
    let common = (open + 0.5) / (count + 1.0);
    let passed = part.iter().zip(&all).filter(|(row, _)| own.rows.contains(row));
    let chance: f64 = passed.map(|(_, [open, count])| common.max(open / count.max(1.0))).product();
    // As many rows one beside another begin at each but the last ones.
    let firsts = (part.len() + 1).saturating_sub(own.racks).max(1) as f64;
    Some(chance * firsts * all.iter().map(|[_, count]| *count).fold(0.0, f64::max))
}

/// How much of what a strip crosses of a row is open in one piece, metres.
fn widest_within(place: &Place, strip: &Strip, row: usize) -> f64 {
    let [from, to] = columns(place, strip, row, 0.0);
    let within = |(first, last): Run| last.min(to).saturating_sub(first.max(from));
    let widest = place.shelves(row).open(place.views[0]).iter().copied().map(within).max().unwrap_or(0);
    widest as f64 * place.views[0].cell / seldom::AS_WIDE
}

/// How many columns of a row are open over as much as a width, and how many there are, both without those of its ways.
fn open_besides(place: &Place, strips: &[Strip], row: usize, width: f64) -> [usize; 2] {
    open_without(place, strips, row, width, false, |_| true)
}

/// The same without those of some of its ways; and if they are to be bare nothing stands along their faces either, as beams do.
fn open_without(
    place: &Place,
    strips: &[Strip],
    row: usize,
    width: f64,
    are_bare: bool,
    is_left_out: impl Fn(usize) -> bool,
) -> [usize; 2] {
    let shelves = place.shelves(row);
    let mut ways: Vec<Run> = place.through[row]
        .iter()
        .filter(|way| is_left_out(**way))
        .map(|&way| columns(place, &strips[way], row, NEAR))
        .map(|[from, to]| (from, to))
        .collect();
    ways.retain(|(from, to)| from < to);
    ways.sort_unstable();
    let least = (seldom::AS_WIDE * width / place.views[0].cell) as usize;
    let mut open = Cow::Borrowed(shelves.open(place.views[0]));
    if are_bare {
        open = shelves.faces(place.views[0]).iter().fold(open, |open, face| Cow::Owned(outside(&open, face)));
    }
    let wide = outside(&open, &ways).into_iter().filter(|(from, to)| to - from >= least);
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
