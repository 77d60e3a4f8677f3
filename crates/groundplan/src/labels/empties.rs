//! Whether what leads through some rows of a place is an empty bay: where another way leads through all of them, and more of
//! the rows is open.

use super::corridors::Strip;
use super::passing::Place;
use super::runs::runs;
use super::seldom;
use super::widths::are_alike;

/// Of rows some bays are empty when so much of them is open besides their ways.
const OPEN: f64 = 0.02;
/// What is open over so much of a width is as wide.
const AS_WIDE: f64 = 0.85;
/// What is open so near to a way is of that, metres.
const BESIDE: f64 = 0.3;

/// True when what leads through some rows between their ends, which is no wider than bays, lies as empty bays do: elsewhere
/// as much of the rows is open, and not as many lead through each.
pub fn are_empty(place: &Place, strips: &[Strip], n: usize) -> bool {
    let own = &place.passing[n];
    let (Some(&first), width) = (own.rows.first(), strips[n].width()) else { return false };
    let rows = place.rows_with(first);
    let as_many = |row: usize| {
        let leads = place.passing.iter().zip(strips).filter(|(other, strip)| {
            other.is_within && !other.next.is_empty() && other.rows.contains(&row) && are_alike(strip.width(), width)
        });
        leads.count()
    };
    let is_uneven = own.is_within && rows.iter().any(|&row| as_many(row) != as_many(first));
    if !is_uneven {
        return false;
    }
    let [open, all] = rows
        .iter()
        .map(|&row| open_besides(place, strips, row, width))
        .fold([0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
    open as f64 > OPEN * all as f64
}

/// How many columns of a row are open over as much as a width, and how many there are, without what leads through it.
fn open_besides(place: &Place, strips: &[Strip], row: usize, width: f64) -> [usize; 2] {
    let [view, other] = place.views;
    let rack = &place.rows[row].0;
    let mut open = seldom::open(view, rack);
    let mut besides = vec![true; open.len()];
    let (first, middle) = (view.column(rack.along[0]), f64::midpoint(rack.across[0], rack.across[1]));
    let column = |u: f64| view.column(u).saturating_sub(first).min(open.len());
    for (strip, _) in strips.iter().zip(&place.passing).filter(|(_, passing)| passing.rows.contains(&row)) {
        let [_, u] = view.crossing(other, middle, strip.middle());
        let reach = strip.width() / 2.0 + BESIDE;
        besides[column(u - reach)..column(u + reach)].fill(false);
    }
    open.iter_mut().zip(&besides).for_each(|(open, is)| *open &= is);
    let least = (AS_WIDE * width / view.cell) as usize;
    let wide = runs(&open, true).into_iter().map(|(from, to)| to - from).filter(|length| *length >= least);
    [wide.sum(), besides.iter().filter(|is| **is).count()]
}
