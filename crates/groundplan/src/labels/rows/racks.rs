//! Racks: rows that are taken, between two ways that run along them.
//!
//! A row may be half empty, and it holds something.

use super::blocks;
use crate::bands::flat_map_each;
use crate::labels::corridors::Strip;
use crate::labels::rows::{Crossings, DEPTH, Row, apart, lines_behind, without};
use crate::labels::view::runs::close;
use crate::labels::view::turned::Turned;
use std::ops::Range;

/// Least share of a row that is taken.
const TAKEN: f64 = 0.12;
/// The same where no corridor runs along its other side.
const TAKEN_OUTSIDE: f64 = 0.5;
const SEEN_OUTSIDE: f64 = 0.5;
/// What stands so near to a face, metres, stands on it; it does on both faces of an outline over so much of it, and for
/// each such part on one alone over so much.
const ON_FACE: f64 = 0.15;
const OUTLINED: (f64, f64) = (0.5, 0.05);
/// No robot comes through a gap that is narrower, metres.
pub const WAY_IN: f64 = 0.5;
/// A place has racks when it has so many, and so many metres of them for a metre of corridor: of offices that were looked at
/// what lies between corridors is .28 at most, of warehouses .31 at least (docs/approaches/racks.md).
const PLACE: (usize, f64) = (3, 0.29);
/// So many between two corridors are enough where bays recur along them.
const WITH_BAYS: usize = 2;

/// The rows between the corridors and at the outer sides of them, the longest first.
pub fn find(views: &[Turned], strips: &[Strip], extents: &[[f64; 2]], threads: usize) -> Vec<Row> {
    find_by(views, strips, &Crossings::new(views, strips, extents), threads)
}

/// The same where racks are asked for: what is as deep as rooms is one where bays recur along it, and its sides are asked anew
/// where they do not.
pub fn with_bays(views: &[Turned], strips: &[Strip], extents: &[[f64; 2]], rows: &[Row], threads: usize) -> Vec<Row> {
    if rows.iter().all(|row| row.depth() <= DEPTH.1 || views[row.direction].pitch_of(row).is_some()) {
        return rows.to_vec();
    }
    find_by(views, strips, &Crossings::of_racks(views, strips, extents), threads)
}

fn find_by(views: &[Turned], strips: &[Strip], crossings: &Crossings, threads: usize) -> Vec<Row> {
    let between = crossings.between();
    let holds = |view: &Turned, row: &Row| taken(view, row) >= TAKEN || is_outlined(view, row);
    let held = |n: usize| Some(&between[n]).filter(|row| holds(&views[row.direction], row)).cloned();
    let mut rows = flat_map_each(between.len(), threads, held);
    rows.extend(flat_map_each(strips.len(), threads, |n| {
        let (strip, mut rows) = (&strips[n], Vec::new());
        let view = &views[strip.direction];
        let reached = crossings.reached(n);
        for side in [0, 1] {
            // What of the side no nearer corridor has taken yet.
            let mut open = crossings.open(n, side);
            let own = strip.across[side];
            // Where no corridor runs along its other side, a row's other face must have been seen.
            for (depth, line) in lines_behind(view, own, side) {
                if open.is_empty() {
                    break;
                }
                let across = if side == 1 { [own, own + depth] } else { [own - depth, own] };
                let row = |along| Row { direction: strip.direction, along, across, between: None };
                let (pieces, mouths) = reached.between_mouths(across, open.clone());
                let pieces = crossings.uncrossed(strip.direction, across, pieces);
                let is_row = |row: &Row| {
                    let is_outlined = || blocks::is_oblong(row) && is_outlined(view, row);
                    is_taken(view, row) && stands_before(view, row, side) && seen(view, line, row) >= SEEN_OUTSIDE
                        || is_outlined()
                };
                let found: Vec<Row> = pieces.into_iter().map(row).filter(is_row).collect();
                open = left_of(open, &found, &mouths);
                rows.extend(found);
            }
        }
        rows
    }));
    apart(views, rows)
}

/// True where rows are racks: in an office, what lies between two corridors are rooms. With where each corridor begins
/// and ends, along.
pub fn are_here(views: &[Turned], rows: &[Row], corridors: &[[f64; 2]]) -> bool {
    let has_bays = |row: &&Row| row.between.is_some() && views[row.direction].pitch_of(row).is_some();
    let are_several = || rows.len() >= PLACE.0 || rows.iter().filter(has_bays).count() >= WITH_BAYS;
    let length = |ends: &[f64; 2]| ends[1] - ends[0];
    let racks: f64 = rows.iter().map(|row| length(&row.along)).sum();
    are_several() && racks >= PLACE.1 * corridors.iter().map(length).sum::<f64>()
}

/// Share of a row's length on which structure lies on one of its view's lines.
fn seen(view: &Turned, line: usize, row: &Row) -> f64 {
    let columns = view.columns(row.along);
    view.covered[line].count(columns.clone()) as f64 / columns.len() as f64
}

/// Pieces without rows that were found, and then without the mouths between these: no deeper row has floor before it.
pub fn left_of(pieces: Vec<(f64, f64)>, rows: &[Row], mouths: &[[f64; 2]]) -> Vec<(f64, f64)> {
    let mouths = if rows.is_empty() { &[] } else { mouths };
    let taken = rows.iter().map(|row| row.along).chain(mouths.iter().copied());
    taken.fold(pieces, |left, [from, to]| without(left, from, to))
}

/// True when something stands on both faces of a row over much of it, and hardly anywhere on one alone, but for gaps through
/// which no robot comes: it is drawn by its outline, and what floor shows within it nobody comes to.
fn is_outlined(view: &Turned, row: &Row) -> bool {
    let [one, two] = row.across.map(|face| {
        let stands = view.some_occupied(columns(view, row), face - ON_FACE, face + ON_FACE);
        let mut stands: Vec<bool> = stands.iter().map(|share| *share > 0.0).collect();
        close(&mut stands, (WAY_IN / view.cell) as usize);
        stands
    });
    let stand = |on: fn(bool, bool) -> bool| one.iter().zip(&two).filter(|(one, two)| on(**one, **two)).count() as f64;
    let both = stand(|one, two| one && two);
    both >= OUTLINED.0 * one.len() as f64 && stand(|one, two| one != two) <= OUTLINED.1 * both
}

/// Share of a row that is not free.
fn taken(view: &Turned, row: &Row) -> f64 {
    view.mean_blocked(columns(view, row), row.across[0], row.across[1])
}

/// True when enough of a row is taken that has a corridor on one side alone.
pub fn is_taken(view: &Turned, row: &Row) -> bool {
    taken(view, row) >= TAKEN_OUTSIDE
}

/// True when something stands at the face of a row that lies away from the one on `side`.
pub fn stands_before(view: &Turned, row: &Row, side: usize) -> bool {
    let mut front = row.clone();
    front.across[side] = if side == 1 { row.across[0] + DEPTH.0 } else { row.across[1] - DEPTH.0 };
    taken(view, &front) >= TAKEN
}

/// The columns of a row, one at least.
fn columns(view: &Turned, row: &Row) -> Range<usize> {
    let [from, to] = row.along.map(|u| view.column(u));
    from..to.max(from + 1)
}
