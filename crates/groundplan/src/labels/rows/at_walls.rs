//! Racks at walls: they hide the wall behind them but for gaps between goods and what of it is beyond their ends.

use super::blocks;
use super::racks;
use super::whole::{RIM, trimmed};
use crate::bands::flat_map_each;
use crate::ends::{sorted, wider};
use crate::labels::beside::placed;
use crate::labels::corridors::Strip;
use crate::labels::rows::{Crossings, Row, SAME, lines_behind, without};
use crate::labels::view::turned::Turned;

/// Behind a wall from so far to so far off, metres, more than this share is not free.
const BEYOND: [f64; 2] = [0.2, 0.7];
const UNSEEN: f64 = 0.9;
/// A wall is looked for between goods, where no more than this share of a row's depth is taken, and so far beyond its
/// ends, metres, and it is there over more than that share.
const SHOWN: f64 = 0.15;
const ENDS: f64 = 2.0;
const WALL_SHOWN: f64 = 0.6;
/// Least share of a row at a wall that is taken, and the share of its near face that is solid in walls only.
const TAKEN: f64 = 0.25;
const SOLID: f64 = 0.95;
/// Goods are looked for no nearer to it, metres.
const BEFORE: f64 = 0.3;

/// What tells a row at a wall: the row, the line of the wall, on which side of the row that is, and the mouths beside it.
type Told = fn(&Turned, &Row, (usize, usize), &[[f64; 2]]) -> bool;

/// Rows between a corridor and a wall to which the ways past their ends lead on, and which shows there.
pub fn past_which_ways_lead(
    views: &[Turned],
    strips: &[Strip],
    extents: &[[f64; 2]],
    known: &[Row],
    threads: usize,
) -> Vec<Row> {
    find(views, strips, extents, known, threads, |view, row, (line, _), mouths| {
        is_wall(view, line, mouths) && blocks::is_oblong(row) && racks::is_taken(view, row)
    })
}

/// Rows between a corridor and a wall that goods hide but for gaps between them, and that is seen beyond their ends.
pub fn of_goods(views: &[Turned], strips: &[Strip], extents: &[[f64; 2]], known: &[Row], threads: usize) -> Vec<Row> {
    find(views, strips, extents, known, threads, |view, row, (line, side), _| hides_wall(view, line, side, row))
}

fn find(
    views: &[Turned],
    strips: &[Strip],
    extents: &[[f64; 2]],
    known: &[Row],
    threads: usize,
    is_row: Told,
) -> Vec<Row> {
    let crossings = Crossings::of_racks(views, strips, extents);
    let rows = placed(views, known.iter().map(Row::place));
    let beside = |n: usize| {
        let (strip, mut found) = (&strips[n], Vec::new());
        let view = &views[strip.direction];
        let reached = crossings.reached(n);
        for side in [0, 1] {
            let own = strip.across[side];
            let mut open = crossings.open(n, side);
            for row in rows[strip.direction].touching(extents[n], wider([own; 2], SAME)).into_iter().map(|m| &known[m])
            {
                if (row.across[1 - side] - own).abs() < SAME {
                    open = without(open, row.along[0], row.along[1]);
                }
            }
            for (_, line) in lines_behind(view, own, side) {
                if open.is_empty() {
                    break;
                }
                let far = view.offsets[line];
                let across = sorted([own, far]);
                let row = |along| Row { direction: strip.direction, along, across, between: None };
                let (pieces, mouths) = reached.between_mouths(across, open.clone());
                let rows = crossings.uncrossed(strip.direction, across, pieces).into_iter().map(row);
                let rows = rows.filter_map(|row| trimmed(view, &row, before(&row, side)));
                let rows: Vec<Row> = rows
                    .filter(|row| racks::stands_before(view, row, side) && is_row(view, row, (line, side), &mouths))
                    .collect();
                open = racks::left_of(open, &rows, &mouths);
                found.extend(rows);
            }
        }
        found
    };
    flat_map_each(strips.len(), threads, beside)
}

/// Where goods stand that hide a wall on one side of a row.
fn before(row: &Row, side: usize) -> [f64; 2] {
    let mut across = row.across;
    across[side] += if side == 1 { -BEFORE } else { BEFORE };
    across
}

/// True when goods stand in a row and a wall behind it: it shows between them and beyond the row's ends, and nothing
/// shows behind it.
fn hides_wall(view: &Turned, line: usize, side: usize, row: &Row) -> bool {
    let columns = view.columns(row.along);
    let far = row.across[side];
    let beyond =
        |metres: [f64; 2]| if side == 1 { metres.map(|m| far + m) } else { [far - metres[1], far - metres[0]] };
    let [low, high] = beyond(BEYOND);
    let before = before(row, side);
    let ends = (ENDS / view.cell) as usize;
    let wide = columns.start.saturating_sub(ends)..(columns.end + ends).min(view.size[0]);
    let inside = view.some_blocked(wide.clone(), before[0], before[1]);
    let shown: Vec<bool> =
        wide.zip(&inside).filter(|(_, b)| **b < SHOWN).map(|(c, _)| view.touched[line].get(c)).collect();
    let near = if side == 1 { row.across[0] } else { row.across[1] };
    view.mean_blocked(columns.clone(), before[0], before[1]) >= TAKEN
        && view.share_touched(columns.clone(), near - RIM, near + RIM) < SOLID
        && view.mean_blocked(columns, low, high) > UNSEEN
        && shown.len() as f64 * view.cell >= 1.0
        && shown.iter().filter(|is| **is).count() as f64 > WALL_SHOWN * shown.len() as f64
}

/// True when a wall shows in one of the mouths between which racks hide it; through others ways may lead on.
fn is_wall(view: &Turned, line: usize, mouths: &[[f64; 2]]) -> bool {
    mouths.iter().any(|mouth| {
        let columns = view.column(mouth[0])..view.column(mouth[1]);
        !columns.is_empty() && view.touched[line].count(columns.clone()) as f64 >= WALL_SHOWN * columns.len() as f64
    })
}
