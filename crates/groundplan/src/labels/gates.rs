//! Gates: ways through a single row of racks, too short to be known by walls of their own.
//!
//! A gap in a row is a gate when nothing stands in it, on neither face of the row, and when it is wider than a bay; or,
//! where no pitch is known, when the row is closed at both its ends.

use super::corridors::{LONGEST_BAY, Strip};
use super::racks::Row;
use super::turned::Turned;

/// A gate is so wide, metres.
const WIDTH: (f64, f64) = (1.6, 8.0);
/// A gap up to this many pitches is an empty bay.
const BAY: f64 = 1.12;
/// A gap this near to a whole number of pitches is one of empty bays, unless its ends are closed.
const WHOLE: f64 = 0.1;
/// A column in which more than this share of the row is blocked is not of a gap.
const FREE: f64 = 0.12;
/// Structure this near to a face stands on it, metres.
const FACE: f64 = 0.3;
/// An end is closed when, so near to the gap, metres, so much of the row is blocked in one column.
const FRAME: (f64, f64) = (0.4, 0.5);
/// Gates whose middles are this near across are in line, and one when they end this near to each other, metres.
const IN_LINE: (f64, f64) = (0.7, 0.5);

/// The ways through the rows between corridors, as strips of the direction that crosses them.
pub fn find(views: &[Turned], strips: &[Strip], rows: &[Row]) -> Vec<Strip> {
    let mut gates = Vec::new();
    for row in rows {
        let (Some(between), Some(other)) = (row.between, crossing(views, row.direction)) else { continue };
        let view = &views[row.direction];
        let middles = between.map(|n| strips[n].middle());
        gates.extend(gaps(view, row).into_iter().map(|gap| strip(view, other, row, gap, middles)));
    }
    in_line(gates)
}

/// The direction that is most nearly square to another.
fn crossing(views: &[Turned], direction: usize) -> Option<&Turned> {
    let sine = |view: &&Turned| libm::sin(view.angle - views[direction].angle).abs();
    views.iter().max_by(|a, b| sine(a).total_cmp(&sine(b))).filter(|view| sine(view) > 0.5)
}

/// Gaps of a row that are gates: from, to, along.
fn gaps(view: &Turned, row: &Row) -> Vec<[f64; 2]> {
    let depth = row.across[1] - row.across[0];
    let margin = 0.1 * depth;
    let first = view.column(row.along[0]);
    let range = first..view.column(row.along[1]) + 1;
    let blocked: Vec<f64> =
        range.clone().map(|c| view.blocked(c, row.across[0] + margin, row.across[1] - margin)).collect();
    let faces: Vec<&Vec<bool>> = view
        .offsets
        .iter()
        .zip(&view.covered)
        .filter(|(offset, _)| row.across.iter().any(|face| (face - **offset).abs() <= FACE))
        .map(|(_, covered)| covered)
        .collect();
    let free: Vec<bool> =
        range.zip(&blocked).map(|(c, b)| *b <= FREE && faces.iter().all(|covered| !covered[c])).collect();
    let frame = (FRAME.0 / view.cell).ceil() as usize;
    let closed = |columns: &[f64]| columns.iter().any(|b| *b >= FRAME.1);
    let pitch = view.pitch.filter(|&pitch| pitch <= LONGEST_BAY);
    let is_gate = |&(from, to): &(usize, usize)| {
        // A row's own ends are no gaps in it.
        if from == 0 || to == free.len() {
            return false;
        }
        let width = (to - from) as f64 * view.cell;
        let framed =
            closed(&blocked[from.saturating_sub(frame)..from]) && closed(&blocked[to..(to + frame).min(free.len())]);
        let bays = pitch.is_some_and(|pitch| {
            let count = (width / pitch).round();
            width <= BAY * pitch || (count >= 2.0 && (width / pitch - count).abs() < WHOLE && !framed)
        });
        (WIDTH.0..=WIDTH.1).contains(&width) && !bays && (pitch.is_some() || framed)
    };
    let place = |c: usize| view.along(first + c);
    super::corridors::runs(&free, true).iter().filter(|run| is_gate(run)).map(|&(a, b)| [place(a), place(b)]).collect()
}

/// A gap as a strip of the crossing direction, from the middle of one corridor to that of the other.
fn strip(view: &Turned, other: &Turned, row: &Row, gap: [f64; 2], middles: [f64; 2]) -> Strip {
    let (sin, cos) = (libm::sin(other.angle - view.angle), libm::cos(other.angle - view.angle));
    let v = f64::midpoint(row.across[0], row.across[1]);
    let [s, t] = other.place(view.to_map([f64::midpoint(gap[0], gap[1]), v]));
    // Where the families are not square, a column is free over less than the gate.
    let depth = row.across[1] - row.across[0];
    let width = (gap[1] - gap[0]) * sin.abs() + depth * cos.abs();
    let ends = middles.map(|middle| s + (middle - v) / sin);
    Strip {
        direction: other.direction,
        along: [ends[0].min(ends[1]), ends[0].max(ends[1])],
        across: [t - width / 2.0, t + width / 2.0],
        score: depth,
    }
}

/// Gates that follow one another through neighbouring rows are one way.
fn in_line(mut gates: Vec<Strip>) -> Vec<Strip> {
    gates.sort_by(|a, b| a.direction.cmp(&b.direction).then(a.along[0].total_cmp(&b.along[0])));
    let mut joined: Vec<Strip> = Vec::new();
    for gate in gates {
        let before = joined.iter_mut().find(|other| {
            other.direction == gate.direction
                && (other.middle() - gate.middle()).abs() < IN_LINE.0
                && gate.along[0] - other.along[1] < IN_LINE.1
        });
        if let Some(other) = before {
            other.along[1] = other.along[1].max(gate.along[1]);
            other.across = [0, 1].map(|n| f64::midpoint(other.across[n], gate.across[n]));
            other.score += gate.score;
        } else {
            joined.push(gate);
        }
    }
    joined
}
