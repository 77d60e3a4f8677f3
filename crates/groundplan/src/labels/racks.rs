//! Racks: rows that are taken, between two ways that run along them.
//!
//! A row is known by its two faces, be it half empty: it lies between neighbouring corridors of one direction, is cut
//! where other corridors cross, and holds something.

use super::corridors::Strip;
use super::turned::Turned;

/// A piece of a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Index of the direction that it runs along.
    pub direction: usize,
    /// Where it begins and ends, along.
    pub along: [f64; 2],
    /// Its two faces, across.
    pub across: [f64; 2],
}

/// Two faces are this far apart, metres: less is a wall, more is a room.
const DEPTH: (f64, f64) = (0.5, 6.0);
/// A row's piece is at least so long, metres.
const SHORTEST: f64 = 1.2;
/// Least share of a row that is taken.
const TAKEN: f64 = 0.12;
/// Sides nearer than this are the same, metres.
const SAME: f64 = 0.3;

/// The rows between the corridors, in the order of the corridors.
pub fn find(views: &[Turned], strips: &[Strip], extents: &[[f64; 2]]) -> Vec<Row> {
    let mut rows = Vec::new();
    for (n, low) in strips.iter().enumerate() {
        let view = &views[low.direction];
        // What of its upper side no nearer corridor has taken yet.
        let mut open = vec![(extents[n][0], extents[n][1])];
        let mut above: Vec<usize> = (0..strips.len())
            .filter(|&m| strips[m].direction == low.direction && strips[m].across[0] > low.across[1] - SAME && m != n)
            .collect();
        above.sort_by(|&a, &b| strips[a].across[0].total_cmp(&strips[b].across[0]));
        for m in above {
            let (high, reach) = (&strips[m], extents[m]);
            let across = [low.across[1], high.across[0]];
            let depth = across[1] - across[0];
            if depth > DEPTH.1 {
                break;
            }
            let shared: Vec<(f64, f64)> =
                open.iter().map(|(a, b)| (a.max(reach[0]), b.min(reach[1]))).filter(|(a, b)| a < b).collect();
            open = without(open, reach[0], reach[1]);
            if depth < DEPTH.0 {
                continue;
            }
            let mut pieces = shared;
            for (k, crossing) in strips.iter().enumerate().filter(|(_, s)| s.direction != low.direction) {
                let [from, to] = crossed(view, &views[crossing.direction], crossing, extents[k], across);
                pieces = without(pieces, from, to);
            }
            rows.extend(
                pieces
                    .into_iter()
                    .map(|(from, to)| Row { direction: low.direction, along: [from, to], across })
                    .filter(|row| row.along[1] - row.along[0] >= SHORTEST && taken(view, row) >= TAKEN),
            );
        }
    }
    rows
}

/// Pieces without what lies between two places.
fn without(pieces: Vec<(f64, f64)>, from: f64, to: f64) -> Vec<(f64, f64)> {
    let cut = pieces.into_iter().flat_map(|(a, b)| [(a, b.min(from)), (a.max(to), b)]);
    cut.filter(|(a, b)| a < b).collect()
}

/// From where to where, along `view`, a corridor of another direction crosses the middle of a row; nothing when it
/// ends before.
fn crossed(view: &Turned, other: &Turned, crossing: &Strip, extent: [f64; 2], across: [f64; 2]) -> [f64; 2] {
    let middle = f64::midpoint(across[0], across[1]);
    let turn = other.angle - view.angle;
    let (sin, cos) = (libm::sin(turn), libm::cos(turn));
    // A point at (s, t) of the other direction lies at u = s cos - t sin, v = s sin + t cos.
    let place = |t: f64| {
        let s = (middle - t * cos) / sin;
        (s, s * cos - t * sin)
    };
    let ends = crossing.across.map(place);
    let within = ends.iter().any(|(s, _)| (extent[0]..=extent[1]).contains(s));
    if within { [ends[0].1.min(ends[1].1), ends[0].1.max(ends[1].1)] } else { [0.0, 0.0] }
}

/// Share of a row that is not free.
fn taken(view: &Turned, row: &Row) -> f64 {
    let columns = view.column(row.along[0])..view.column(row.along[1]).max(view.column(row.along[0]) + 1);
    let count = columns.len() as f64;
    columns.map(|c| view.blocked(c, row.across[0], row.across[1])).sum::<f64>() / count
}
