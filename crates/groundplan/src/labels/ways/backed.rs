//! Ways told by the backs of racks: where empty bays show something between a row's halves, its racks have backs, and what is open
//! from aisle to aisle without one is no bay, be it as wide as bays are.

use crate::labels::corridors::Strip;
use crate::labels::rows::sections::WIDTH;
use crate::labels::rows::seen::{self, Seen};
use crate::labels::rows::shelves::Shelves;
use crate::labels::view::runs::{Run, length};

/// Rows of a kind differ by no more than so much in depth, metres, each from the next.
const ALIKE: f64 = 0.2;
/// So many bays that are empty show their backs, for this share at least of what is open without one and no known way.
const SEVERAL: usize = 3;
const SHARE: f64 = 0.5;
/// A back that is by so much of a bay shorter is that of one more.
const HIDDEN: f64 = 0.2;

/// The ways where backs are missing through rows between so many aisles, place by place, by others of a kind. What is known for one
/// does not count as open without a back, but is given again: bays may have been taken for such ways, and they for bays.
pub fn find(seen: &[Seen], aisles: usize, is_known: impl Fn(&Strip) -> bool) -> Vec<Strip> {
    let kinds = seen::by_place(seen, aisles).into_iter().flat_map(of_kinds);
    kinds.flat_map(|rows| among(&rows, &is_known)).collect()
}

/// Rows of which each is about as deep as the next, which may be of other racks than deeper ones.
fn of_kinds<'a, 'b>(mut rows: Vec<&'a Seen<'b>>) -> Vec<Vec<&'a Seen<'b>>> {
    rows.sort_by(|one, other| one.row.depth().total_cmp(&other.row.depth()));
    rows.chunk_by(|one, next| next.row.depth() - one.row.depth() <= ALIKE).map(<[_]>::to_vec).collect()
}

fn among(rows: &[&Seen], is_known: impl Fn(&Strip) -> bool) -> Vec<Strip> {
    let shelves: Vec<Shelves> = rows.iter().map(|row| Shelves::new(row.views[0], row.row)).collect();
    let with = || rows.iter().copied().zip(&shelves);
    let gates: Vec<Strip> = with().flat_map(|(row, own)| gates(row, own)).collect();
    let clear = gates.iter().filter(|gate| !is_known(gate)).map(Strip::width).sum::<f64>();
    let narrowest = gates.iter().map(Strip::width).fold(f64::INFINITY, f64::min);
    let backs = with().flat_map(|(row, own)| {
        let bay = row.views[0].pitch_of(row.row).unwrap_or(narrowest).min(narrowest);
        own.backs(row.views[0]).iter().map(move |back| (length([*back]) as f64 * row.views[0].cell, bay))
    });
    let backs: Vec<(f64, f64)> = backs.collect();
    let bays: usize = backs.iter().map(|(length, bay)| (length / bay + HIDDEN) as usize).sum();
    let backed: f64 = backs.iter().map(|back| back.0).sum();
    if bays >= SEVERAL && backed >= SHARE * clear { gates } else { Vec::new() }
}

/// What is open through a row and as wide as ways are.
fn gates(row: &Seen, shelves: &Shelves) -> Vec<Strip> {
    let view = row.views[0];
    let first = view.column(row.row.along[0]);
    let gate = |(from, to): Run| {
        let ends = [from, to].map(|n| view.along(first + n));
        (WIDTH.0 - view.cell..=WIDTH.1).contains(&(ends[1] - ends[0])).then(|| row.gate(ends)).flatten()
    };
    shelves.open(view).iter().copied().filter_map(gate).collect()
}
