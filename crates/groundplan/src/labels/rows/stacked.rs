//! Stacked rows: as deep as rooms are, where goods stand one behind another.

use super::blocks::are_alike;
use crate::ends::wider;
use crate::labels::rows::Row;
use crate::labels::view::runs::runs;
use crate::labels::view::turned::Turned;

/// So deep a stacked row is at most, metres.
pub const STACKED: f64 = 6.0;
/// Lanes of the one width, metres, are an aisle where they are free over more than that share of their length.
const FREE: (f64, f64) = (1.6, 0.5);
/// Of lanes of the one width, metres, nothing is known where something stands in them over less than that share.
const EMPTY: (f64, f64) = (1.2, 0.1);
/// Lanes are tried no farther apart, metres.
const STEP: f64 = 0.4;
/// A wall between two rooms leads over so much of the way from face to face and is no thicker, metres, but for a cell; of rows of
/// one depth there are so many for a metre: in drawn hotels .22 at least, in halls with racks .13 at most.
const LEADS: f64 = 0.7;
const THICK: f64 = 0.55;
const ROOMS: f64 = 0.18;
/// What stands so near to a face is of it, metres.
const FACE: f64 = 0.3;

/// Which of some rows, all deeper than others are, are stacked.
pub fn are_stacked(views: &[Turned], rows: &[Row]) -> Vec<bool> {
    let are_filled: Vec<bool> = rows.iter().map(|row| is_filled(&views[row.direction], row)).collect();
    let filled = || rows.iter().zip(&are_filled).filter(|(_, is_filled)| **is_filled).map(|(row, _)| row);
    let walls: Vec<(&Row, usize)> = filled().map(|row| (row, walls_within(&views[row.direction], row))).collect();
    let are_rooms = |row: &Row| {
        let (mut count, mut length) = (0, 0.0);
        for (other, walls) in walls.iter().filter(|(other, _)| are_alike(row, other)) {
            count += walls;
            length += other.length();
        }
        count as f64 >= ROOMS * length
    };
    rows.iter().zip(&are_filled).map(|(row, is_filled)| *is_filled && !are_rooms(row)).collect()
}

/// True when in all lanes along a row something stands, and none is free.
fn is_filled(view: &Turned, row: &Row) -> bool {
    let columns = view.columns(row.along);
    let any_lane = |width: f64, is_lane: &dyn Fn([f64; 2]) -> bool| {
        let rest = row.depth() - width;
        let steps = (rest / STEP).ceil();
        let lanes = (0..=steps as u32).map(|n| row.across[0] + rest * f64::from(n) / steps);
        lanes.map(|from| [from, from + width]).any(is_lane)
    };
    let is_free = |[low, high]: [f64; 2]| {
        let blocked = view.some_blocked(columns.clone(), low, high);
        blocked.iter().filter(|share| **share <= 0.0).count() as f64 > FREE.1 * columns.len() as f64
    };
    let is_empty = |[low, high]: [f64; 2]| view.share_touched(columns.clone(), low, high) < EMPTY.1;
    !any_lane(FREE.0, &is_free) && !any_lane(EMPTY.0, &is_empty)
}

/// How many walls lead from face to face of a row.
fn walls_within(view: &Turned, row: &Row) -> usize {
    let [low, high] = wider(row.across, -FACE);
    let occupied = view.some_occupied(view.columns(row.along), low, high);
    let leads: Vec<bool> = occupied.iter().map(|share| *share > LEADS).collect();
    runs(&leads, true).into_iter().filter(|(from, to)| (to - from) as f64 * view.cell <= THICK + view.cell).count()
}
