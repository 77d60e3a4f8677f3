//! Racks as they stand: rows beside corridors end where what stands in them ends and not where a corridor does, those
//! that are shells of walls go, and blocks that no corridor runs along come.

use super::at_walls;
use super::blocks::{self, Standing, are_alike, beside, standing_near};
use super::racks;
use crate::bands::flat_map_each;
use crate::ends::{both, overlap, shared, wider};
use crate::labels::beside::placed;
use crate::labels::corridors::{self, Strip};
use crate::labels::junctions::shut::sign;
use crate::labels::rows::{Crossings, Row, SHORTEST, heaviest};
use crate::labels::view::turned::Turned;
use std::ops::Range;

/// So many times its length a row counts whose two faces are seen.
const SEEN_BOTH: f64 = 1.3;
/// Legs stand so far beyond a row's faces at most, metres, and what goes on beyond the last of them for less is no bay.
const FACE: f64 = 0.3;
const BAY: f64 = 1.0;
/// What stands so near to a row's faces is of it, metres.
pub const RIM: f64 = 0.1;
/// A row is followed in steps of this, metres, and goes on where before one of its faces more than that share of a step
/// is floor, and more than the other share of it is taken; over one step where it does not.
const STEP: f64 = 1.0;
const FRONT: [f64; 2] = [0.15, 0.65];
const FLOOR: f64 = 0.6;
const TAKEN: f64 = 0.25;
const OVER: usize = 1;

/// Rows by their depths are asked for the nearest on either side, so many.
const KIN: usize = 2;
/// A shell has a face that is closed over that share of its length, within so far, metres; so far behind its faces more
/// than the other share of it is unknown, or than the last where no floor is seen before its other face. Between goods
/// something of a rack's inside shows.
const CLOSED: f64 = 0.95;
const NEAR: f64 = 0.15;
const INSET: f64 = 0.3;
const UNKNOWN: f64 = 0.965;
const HIDDEN: f64 = 0.4;
/// Of a wall that is drawn solid so much is occupied, and of what goes on beyond its ends for so far, metres, is not free.
const SOLID: f64 = 0.95;
const ON: f64 = 0.5;

/// The racks of a place; the rows between its corridors are known, and the racks that stand on legs.
pub fn find(
    views: &[Turned],
    strips: &[Strip],
    extents: &[[f64; 2]],
    [rows, on_legs]: [&[Row]; 2],
    standing: &Standing,
    threads: usize,
) -> Vec<Row> {
    let mut known = without_walls(views, rows);
    known.extend(at_walls::past_which_ways_lead(views, strips, extents, &known, threads));
    if racks::are_here(views, &known, extents) && racks::are_here(views, &of_a_kind(&known), extents) {
        known.extend(at_walls::of_goods(views, strips, extents, &known, threads));
    } else {
        known.clear();
    }
    let crossings = Crossings::new(views, strips, extents);
    let half = corridors::widest(strips) / 2.0;
    let whole = |row: &Row| {
        let view = &views[row.direction];
        // A pillar that stands at its back is not of it.
        let row = trimmed(view, row, crossings.before_backs(row, 2.0 * RIM))?;
        // One beside a single aisle goes on to the corner behind what crosses that, and no farther.
        let most = if row.between.is_some() { f64::INFINITY } else { half };
        Some(followed(view, &crossings, &row, most))
    };
    let found = flat_map_each(known.len(), threads, |n| whole(&known[n]));
    let mut blocks = blocks::find(views, &found, standing);
    let met = blocks::overlapping(views, &blocks, on_legs);
    let mut met = met.into_iter();
    blocks.retain(|_| met.next().is_some_and(|racks| racks.is_empty()));
    let met = blocks::overlapping(views, on_legs, &found);
    blocks.extend(on_legs.iter().zip(met).map(|(rack, met)| in_row(rack, met.into_iter().map(|n| &found[n]))));
    let met = blocks::overlapping(views, &blocks, rows);
    for (block, met) in blocks.iter_mut().zip(met) {
        block.between = met.into_iter().find_map(|n| rows[n].between);
    }
    // Of a block both faces are seen, be it known from its aisle already.
    let met = blocks::overlapping(views, &found, &blocks);
    let weigh = |(row, met): (Row, Vec<usize>)| {
        let is_block = met.into_iter().any(|n| blocks[n] == row);
        (if is_block { SEEN_BOTH } else { 1.0 } * row.length(), row)
    };
    let mut weighed: Vec<(f64, Row)> = found.into_iter().zip(met).map(weigh).collect();
    weighed.extend(blocks.into_iter().map(|row| (SEEN_BOTH * row.length(), row)));
    heaviest(views, weighed)
}

/// A rack on legs as far as the row goes in which it lies: of the frames beyond goods may hide one leg or both, and of two racks
/// back to back all of the one.
fn in_row<'a>(rack: &Row, rows: impl Iterator<Item = &'a Row>) -> Row {
    let mut whole = rack.clone();
    for row in rows {
        let is_within = row.direction == rack.direction
            && row.across[0] <= rack.across[0] + FACE
            && rack.across[1] <= row.across[1] + FACE
            && overlap(rack.along, row.along) > rack.length() / 2.0;
        if is_within {
            let [before, beyond] = [whole.along[0] - row.along[0], row.along[1] - whole.along[1]];
            whole.along[0] -= if before >= BAY { before } else { 0.0 };
            whole.along[1] += if beyond >= BAY { beyond } else { 0.0 };
            whole.across = both(whole.across, row.across);
        }
    }
    whole
}

/// Racks without what ways lead through of them: between pieces of one block of goods these may be as narrow as gaps.
pub fn uncrossed(views: &[Turned], strips: &[Strip], extents: &[[f64; 2]], racks: &[Row]) -> Vec<Row> {
    let crossings = Crossings::new(views, strips, extents);
    let pieces = |rack: &Row| {
        let view = &views[rack.direction];
        let mut left = crossings.uncrossed(rack.direction, rack.across, vec![(rack.along[0], rack.along[1])]);
        // What a way passes by at an end stands there.
        let [first, .., last] = &mut left[..] else { return vec![rack.clone()] };
        (first[0], last[1]) = (rack.along[0], rack.along[1]);
        let piece = |along: [f64; 2]| trimmed(view, &Row { along, ..rack.clone() }, rack.across);
        left.into_iter().filter_map(piece).collect()
    };
    racks.iter().flat_map(pieces).collect()
}

/// Rows between two corridors, and of those beside one those as deep as another: racks of a place come in kinds, rooms and
/// what nobody saw beside a corridor do not.
fn of_a_kind(rows: &[Row]) -> Vec<Row> {
    let mut by_depth: Vec<&Row> = rows.iter().collect();
    by_depth.sort_by(|a, b| a.depth().total_cmp(&b.depth()));
    let has_kin = |row: &&Row| {
        let at = by_depth.partition_point(|other| other.depth() < row.depth());
        let near = by_depth[at.saturating_sub(KIN)..].iter().take(2 * KIN);
        row.between.is_some() || near.filter(|other| are_alike(row, other)).count() > 1
    };
    rows.iter().filter(has_kin).cloned().collect()
}

/// Rows without those that are walls for all that is seen, and none of the kind across an aisle.
fn without_walls(views: &[Turned], rows: &[Row]) -> Vec<Row> {
    let (walls, others): (Vec<_>, Vec<_>) = rows.iter().zip(0..).partition(|(row, _)| is_as_walls(views, row));
    let alone: Vec<&Row> = walls.iter().map(|(row, _)| *row).collect();
    let kin = have_kin(views, &alone, &alone);
    let of_a_kind = walls.into_iter().zip(kin).filter(|(_, has_kin)| *has_kin).map(|(wall, _)| wall);
    let mut kept: Vec<_> = of_a_kind.chain(others).collect();
    kept.sort_by_key(|(_, n): &(&Row, usize)| *n);
    kept.into_iter().map(|(row, _)| row.clone()).collect()
}

/// Which rows are the unknown between two halls: walls for all that is seen, and none as deep across an aisle.
pub fn are_between_halls(views: &[Turned], rows: &[&Row]) -> Vec<bool> {
    let kin = have_kin(views, rows, rows);
    rows.iter().zip(kin).map(|(row, has_kin)| !has_kin && is_as_walls(views, row)).collect()
}

/// Which rows have one as deep across an aisle, of some.
pub fn have_kin(views: &[Turned], rows: &[&Row], others: &[&Row]) -> Vec<bool> {
    let placed = placed(views, others.iter().map(|row| row.place()));
    let has_kin = |row: &Row| {
        let mut near = standing_near(&placed, row).into_iter().map(|n| others[n]);
        near.any(|other| beside(row, other) && are_alike(row, other))
    };
    rows.iter().map(|row| has_kin(row)).collect()
}

/// True when a row is no deeper than walls are, or closed all along and nothing known between, or solid and goes on as that.
fn is_as_walls(views: &[Turned], row: &Row) -> bool {
    let view = &views[row.direction];
    row.is_shallow() || is_shell(view, row) || is_solid(view, row)
}

/// True when all of a row is occupied and something that is not free lies beyond both its ends: it goes on to the corners of
/// the walls, as it would where a plan was drawn.
fn is_solid(view: &Turned, row: &Row) -> bool {
    let [first, end] = row.along.map(|u| view.column(u));
    let beyond = (ON / view.cell).ceil() as usize;
    let [low, high] = wider(row.across, -view.cell);
    let goes_on = |columns: Range<usize>| view.mean_blocked(columns, low, high) >= SOLID;
    let occupied = || view.some_occupied(first..end, low, high).iter().sum::<f64>() / (end - first).max(1) as f64;
    goes_on(first.saturating_sub(beyond)..first)
        && goes_on(end..(end + beyond).min(view.size[0]))
        && occupied() >= SOLID
}

fn is_shell(view: &Turned, row: &Row) -> bool {
    let columns = view.columns(row.along);
    let count = columns.len() as f64;
    let closed = |face: f64| view.share_touched(columns.clone(), face - NEAR, face + NEAR) >= CLOSED;
    let blocked = |low, high| view.mean_blocked(columns.clone(), low, high);
    let [low, high] = row.across;
    let inset = INSET.min(row.depth() / 4.0);
    let occupied = view.some_occupied(columns.clone(), low + inset, high - inset).iter().sum::<f64>() / count;
    let unknown = blocked(low + inset, high - inset) - occupied;
    let before = [blocked(low - FRONT[1], low - FRONT[0]), blocked(high + FRONT[0], high + FRONT[1])];
    let near = if before[0] < before[1] { low } else { high };
    let one_sided = before[0].max(before[1]) > FLOOR;
    unknown > UNKNOWN && row.across.into_iter().any(closed) || one_sided && unknown > HIDDEN && closed(near)
}

/// A row from the first to the last thing that stands between two places across; nothing where that is too short.
pub fn trimmed(view: &Turned, row: &Row, [low, high]: [f64; 2]) -> Option<Row> {
    let first = view.column(row.along[0]);
    let occupied = view.some_occupied(first..view.column(row.along[1]) + 1, low - RIM, high + RIM);
    let from = first + occupied.iter().position(|share| *share > 0.0)?;
    let to = first + occupied.iter().rposition(|share| *share > 0.0)? + 1;
    let along = [row.along[0].max(view.along(from)), row.along[1].min(view.along(to))];
    (along[1] - along[0] >= SHORTEST).then(|| Row { along, ..row.clone() })
}

/// A row with what goes on beyond its ends, up to the corridors that cross it, and no farther than so much, metres: of what a
/// corridor on one side does not reach, one face is seen.
fn followed(view: &Turned, crossings: &Crossings, row: &Row, most: f64) -> Row {
    let whole = vec![(view.along(0), view.along(view.size[0]))];
    let middle = f64::midpoint(row.along[0], row.along[1]);
    let uncrossed = crossings.uncrossed(row.direction, row.across, whole);
    let Some(limits) = uncrossed.into_iter().find(|[from, to]| (*from..=*to).contains(&middle)) else {
        return row.clone();
    };
    let limits = shared(limits, wider(row.along, most));
    let goes_on = |from: f64, to: f64| {
        let columns = view.column(from)..view.column(to).max(view.column(from) + 1);
        let mean = |low, high| view.mean_blocked(columns.clone(), low, high);
        let [low, high] = row.across;
        let before = mean(low - FRONT[1], low - FRONT[0]).min(mean(high + FRONT[0], high + FRONT[1]));
        before < 1.0 - FLOOR && mean(low, high) > TAKEN
    };
    let reach = |side: usize| {
        let out = sign(side);
        let place = |n: u32| out * (out * row.along[side] + f64::from(n) * STEP).min(out * limits[side]);
        let (mut reach, mut missed) = (row.along[side], 0);
        for n in 1.. {
            let [from, to] = [n - 1, n].map(place);
            if missed > OVER || (to - from).abs() < view.cell {
                break;
            }
            if goes_on(from.min(to), from.max(to)) {
                (reach, missed) = (to, 0);
            } else {
                missed += 1;
            }
        }
        reach
    };
    let along = [0, 1].map(reach);
    trimmed(view, &Row { along, ..row.clone() }, row.across).unwrap_or_else(|| row.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_beside_one_way_are_of_a_kind_where_another_row_is_as_deep() {
        let row = |depth: f64, between| Row { direction: 0, along: [0.0, 9.0], across: [1.0, 1.0 + depth], between };
        let depths = |rows: &[Row]| of_a_kind(rows).iter().map(Row::depth).collect::<Vec<_>>();
        let rooms = [row(1.75, None), row(2.9, None), row(3.5, None)];
        assert_eq!(depths(&rooms), []);
        let racks = [row(1.0, None), row(2.25, Some([0, 1])), row(1.125, None), row(3.5, None)];
        assert_eq!(depths(&racks), [1.0, 2.25, 1.125]);
    }

    #[test]
    fn a_rack_on_legs_goes_as_far_as_the_row_in_which_it_lies() {
        let row = |along: [f64; 2], across: [f64; 2]| Row { direction: 0, along, across, between: None };
        let rack = row([0.0, 10.0], [0.0, 1.0]);
        let whole = |other: Row| {
            let whole = in_row(&rack, [&other].into_iter());
            (whole.along, whole.across)
        };
        assert_eq!(whole(row([-0.5, 12.7], [0.0, 1.0])), ([0.0, 12.7], [0.0, 1.0]));
        assert_eq!(whole(row([0.0, 10.0], [0.1, 2.3])), ([0.0, 10.0], [0.0, 2.3]));
        // What lies before it is none of it, nor what is not as deep.
        assert_eq!(whole(row([8.0, 20.0], [0.0, 1.0])), ([0.0, 10.0], [0.0, 1.0]));
        assert_eq!(whole(row([0.0, 20.0], [0.5, 1.0])), ([0.0, 10.0], [0.0, 1.0]));
    }
}
