//! Rows of which nothing is open but for gaps from aisle to aisle: where these lie as no bays can they are ways.

use super::passing::{Passing, Place};
use super::seldom::{AS_WIDE, Rest};
use super::widths::are_alike;
use crate::labels::corridors::Strip;
use crate::labels::view::runs::outside;
use std::collections::BTreeSet;

/// Fewer rows tell nothing.
const ROWS: usize = 3;
/// One gap by itself may be an empty bay of a hall in which no others are.
const SEVERAL: usize = 2;
/// Of more than so many for each row some are empty bays, and which is not told; the same of gaps of any widths.
const MANY: f64 = 1.25;
const OF_ALL: f64 = 2.0;
/// Bays recur by so much less than a gap is wide, metres, where goods stand back from it, to so much more, where posts stand
/// between them, tried in such steps.
const RECUR: (f64, f64) = (-0.45, 0.3);
const STEP: f64 = 0.01;
/// What stands between gaps is known to so much, metres.
const OFF: f64 = 0.2;

/// True when several ways lead through some of the rows of one's part of a place between their ends, next to nothing of these
/// rows is open elsewhere, and what stands beside the gaps is no whole number of bays: beside those that are as wide as that one,
/// or of most rows beside all of them.
pub fn is_way(place: &Place, strips: &[Strip], own: &Passing, width: f64) -> bool {
    let Some(first) = place.first_of(own).filter(|_| own.is_within) else { return false };
    let part = place.rows_with(first);
    let is_within = |way: &&usize| place.passing[**way].is_within && !place.passing[**way].is_whole();
    let of_row = |row: usize| -> BTreeSet<usize> { place.through[row].iter().filter(is_within).copied().collect() };
    let all: BTreeSet<usize> = part.iter().flat_map(|&row| of_row(row)).collect();
    let widths_of = |ways: &BTreeSet<usize>| -> Vec<f64> { ways.iter().map(|&way| strips[way].width()).collect() };
    let lengths = |least: f64| -> Vec<f64> { part.iter().flat_map(|&row| standing(place, row, least)).collect() };
    let is_count = |count: usize, many: f64| (SEVERAL as f64..=many * part.len() as f64).contains(&(count as f64));
    let rest = |least: f64| Rest::but_for_wider(place.views[0], part.iter().map(|&row| place.shelves(row)), least);

    let widths = widths_of(&all);
    let alike: Vec<f64> = widths.iter().copied().filter(|&other| are_alike(other, width)).collect();
    if part.len() >= ROWS
        && is_count(alike.len(), MANY)
        && rest(width).is_seldom_open()
        && !are_bays(&lengths(width), &alike)
    {
        return true;
    }
    let least = widths.iter().copied().fold(width, f64::min);
    let rest = rest(least);
    let through: usize = part.iter().map(|&row| of_row(row).len()).sum();
    // Where as much is open beside something that stands in it, that is an empty bay.
    if !is_count(all.len(), OF_ALL) || rest.open() != through || !rest.is_seldom_open() {
        return false;
    }
    // Bays of one row may be longer than those of another.
    let open: Vec<usize> = part.iter().copied().filter(|&row| !of_row(row).is_empty()).collect();
    let have_bays = |row: &&usize| are_bays(&standing(place, **row, least), &widths_of(&of_row(**row)));
    !are_bays(&lengths(least), &widths) && (open.len() < ROWS || 2 * open.iter().filter(have_bays).count() < open.len())
}

/// How long what stands of a row is, between gaps no narrower than so much, metres; nothing where it has no gaps.
fn standing(place: &Place, row: usize, least: f64) -> Vec<f64> {
    let (cell, shelves) = (place.views[0].cell, place.shelves(row));
    // What is open up to a row's end is before it, however short.
    let mut open = shelves.open(place.views[0]).to_vec();
    open.retain(|&(from, to)| shelves.is_end((from, to)) || (to - from) as f64 >= AS_WIDE * least / cell);
    let has_gaps = open.iter().any(|&run| !shelves.is_end(run));
    let standing = if has_gaps { outside(&[(0, shelves.count())], &open) } else { Vec::new() };
    standing.into_iter().map(|(from, to)| (to - from) as f64 * cell).collect()
}

/// True when all of some lengths may be whole numbers of bays with what stands between them, and gaps of some widths too, the
/// narrowest of one bay; metres.
fn are_bays(lengths: &[f64], widths: &[f64]) -> bool {
    let narrowest = widths.iter().copied().fold(f64::INFINITY, f64::min);
    let off = |length: f64, pitch: f64| length - (length / pitch).round() * pitch;
    (0..=((RECUR.1 - RECUR.0) / STEP) as usize).any(|n| {
        let pitch = narrowest + RECUR.0 + n as f64 * STEP;
        lengths.iter().all(|&length| off(length, pitch).abs() <= OFF)
            && widths.iter().all(|&width| (-RECUR.1..=-RECUR.0).contains(&off(width, pitch)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_between_empty_bays_is_a_whole_number_of_bays() {
        // Bays of 2.7 m, of which 0.1 m is a post.
        assert!(are_bays(&[2.8, 8.2, 16.3, 27.1], &[2.6]));
        assert!(are_bays(&[21.6, 8.1, 16.2, 43.2, 5.4], &[2.75]));
        assert!(!are_bays(&[2.8, 8.2, 17.5, 27.1], &[2.6]));
        assert!(!are_bays(&[9.6, 21.5], &[3.0]));
        // Goods that stand back by 0.2 m from the posts at their ends.
        assert!(are_bays(&[16.7, 2.7, 2.75, 16.6], &[3.15, 3.2]));
    }
}
