//! What leads through one row alone: a way, where the rows beside have as many, or an empty bay, which may lie anywhere.

use super::passing::{Passing, Place};
use super::widths::are_alike;
use crate::ends::overlap;
use crate::labels::corridors::Strip;
use crate::labels::posts::lags::LONGEST;
use crate::labels::rows::SHORTEST;
use std::collections::BTreeSet;

/// Ways that lead through one row each are as many in each of so many rows at least.
const ROWS: usize = 3;
/// What is so many times as wide as the aisles beside it is wider than a bay.
const WIDER: f64 = 1.3;
/// One row in so many is few, and where other ways lead through all rows, one in so many.
const FEW: (usize, usize) = (4, 2);

/// What leads through each of the rows of a place within it.
pub struct Alone {
    /// How wide what leads through this one alone is, metres.
    alone: Vec<Vec<f64>>,
    /// Whether something leads through this one and others.
    on: Vec<bool>,
}

impl Alone {
    pub fn new(place: &Place, strips: &[Strip]) -> Self {
        let rows = place.rows.len();
        let mut made = Self { alone: vec![Vec::new(); rows], on: vec![false; rows] };
        for (strip, own) in strips.iter().zip(&place.passing).filter(|(_, own)| own.is_within) {
            match own.rows[..] {
                [row] => made.alone[row].push(strip.width()),
                _ => own.rows.iter().for_each(|&row| made.on[row] = true),
            }
        }
        made
    }

    /// True when it is longer than beams are, and nothing else as wide leads through its rows alone: bays recur.
    pub fn is_longer_than_bays(&self, own: &Passing, width: f64) -> bool {
        width > LONGEST && own.rows.iter().all(|&row| self.alike(row, width) <= 1)
    }

    /// True when it lies as empty bays do, and not as ways that are alike: one as wide leads through few of the rows of its
    /// place alone, or through no more than half of them where something else leads through all. What is longer than beams, or
    /// much wider than both aisles beside it, is no bay.
    pub fn is_as_bays_lie(&self, place: &Place, strips: &[Strip], own: &Passing, width: f64) -> bool {
        let (&[row], true) = (&own.rows[..], own.is_within) else { return false };
        let is_narrower = |&aisle: &usize| width < WIDER * strips[place.aisles[aisle]].width();
        if width > LONGEST || !place.rows[row].1.iter().any(is_narrower) {
            return false;
        }
        let rows = place.rows_with(row);
        let with = rows.iter().filter(|&&n| self.alike(n, width) > 0).count();
        let few = if rows.iter().all(|&n| self.on[n]) { FEW.1 } else { FEW.0 };
        few * with <= rows.len()
    }

    /// True when as many ways as wide as one lead through each of the rows of its place, and none through several: shelves
    /// are empty anywhere. Pieces in line are one row, and what has no room for a way between racks is none.
    pub fn is_in_every_row(&self, place: &Place, own: &Passing, width: f64) -> bool {
        let &[row] = &own.rows[..] else { return false };
        let whole = in_line(place, place.rows_with(row));
        let whole: Vec<_> = whole.into_iter().filter(|rows| length(place, rows) >= width + 2.0 * SHORTEST).collect();
        let alike = |rows: &BTreeSet<usize>| rows.iter().map(|&n| self.alike(n, width)).sum::<usize>();
        let own_alike = whole.iter().find(|rows| rows.contains(&row)).map(alike);
        let is_as_own = |rows: &BTreeSet<usize>| rows.iter().all(|&n| !self.on[n]) && Some(alike(rows)) == own_alike;
        whole.len() >= ROWS && whole.iter().all(is_as_own)
    }

    /// How many as wide lead through a row alone.
    fn alike(&self, row: usize, width: f64) -> usize {
        self.alone[row].iter().filter(|other| are_alike(**other, width)).count()
    }
}

/// True when as many ways of any width lead through each of the rows of a way's place between their ends, alone or with others.
pub fn is_one_of_each(place: &Place, own: &Passing) -> bool {
    let Some(first) = place.first_of(own).filter(|_| own.is_within) else { return false };
    let whole = in_line(place, place.rows_with(first));
    let many = |rows: &BTreeSet<usize>| {
        let through = rows.iter().flat_map(|&row| &place.through[row]);
        through.filter(|way| place.passing[**way].is_within).collect::<BTreeSet<_>>().len()
    };
    whole.len() >= ROWS && whole.iter().all(|rows| many(rows) == many(&whole[0]))
}

/// Rows that are in line with one another are pieces of one: where one of the aisles beside it was seen in pieces.
fn in_line(place: &Place, rows: BTreeSet<usize>) -> Vec<BTreeSet<usize>> {
    let across = |row: usize| place.rows[row].0.across;
    let mut whole: Vec<BTreeSet<usize>> = Vec::new();
    for row in rows {
        let is_in_line = |&other: &usize| {
            let least = f64::min(place.rows[row].0.depth(), place.rows[other].0.depth());
            overlap(across(row), across(other)) > least / 2.0
        };
        match whole.iter_mut().find(|pieces| pieces.iter().any(is_in_line)) {
            Some(pieces) => _ = pieces.insert(row),
            None => whole.push(BTreeSet::from([row])),
        }
    }
    whole
}

/// How long some rows are together, metres.
fn length(place: &Place, rows: &BTreeSet<usize>) -> f64 {
    rows.iter().map(|&row| place.rows[row].0.length()).sum()
}
