//! Gates in walls between two ways that are too thin for rows.

use super::across::crossing;
use crate::ends::{sorted, wider};
use crate::labels::corridors::Strip;
use crate::labels::rows::sections::WIDTH;
use crate::labels::rows::seen::way;
use crate::labels::rows::{Crossings, Row, SAME, SHORTEST};
use crate::labels::view::runs::{close, runs};
use crate::labels::view::turned::Turned;

/// Between two ways stands a wall when it does over so much of where they run side by side.
const WALL: f64 = 0.5;
/// Holes in it up to so long, metres, let nothing through.
const HOLE: f64 = 0.5;
/// A gate is free but for this share.
const CLUTTER: f64 = 0.1;

/// The ways through walls between two strips, as strips of the direction that crosses them.
pub fn gates(views: &[Turned], strips: &[Strip]) -> Vec<Strip> {
    let extents: Vec<[f64; 2]> = strips.iter().map(|strip| strip.along).collect();
    let mut gates = Vec::new();
    for wall in Crossings::new(views, strips, &extents).walls() {
        let (Some(between), Some(other)) = (wall.between, crossing(views, wall.direction)) else { continue };
        let view = &views[wall.direction];
        let middles = between.map(|n| strips[n].middle());
        gates.extend(openings(view, &wall).into_iter().map(|ends| way([view, other], &wall, middles, ends)));
    }
    gates
}

/// Where nothing stands in a wall, from where to where along it: between two pieces of it as long as the shortest rack.
fn openings(view: &Turned, wall: &Row) -> Vec<[f64; 2]> {
    let [low, high] = wider(sorted(wall.across), SAME / 2.0);
    let columns = view.column(wall.along[0])..view.column(wall.along[1]);
    let cells = |metres: f64| (metres / view.cell).round() as usize;
    let mut stands: Vec<bool> =
        view.some_occupied(columns.clone(), low, high).iter().map(|share| *share > 0.0).collect();
    close(&mut stands, cells(HOLE));
    if (stands.iter().filter(|stands| **stands).count() as f64) < WALL * stands.len() as f64 {
        return Vec::new();
    }
    let is_piece =
        |from: usize, to: usize| stands.get(from..to).is_some_and(|piece| piece.iter().all(|stands| *stands));
    let is_gate = |&(from, to): &(usize, usize)| {
        let piece = cells(SHORTEST);
        let width = (to - from) as f64 * view.cell;
        (WIDTH.0..=WIDTH.1).contains(&width)
            && from >= piece
            && is_piece(from - piece, from)
            && is_piece(to, to + piece)
            && view.mean_blocked(columns.start + from..columns.start + to, low, high) <= CLUTTER
    };
    let place = |n: usize| wall.along[0] + n as f64 * view.cell;
    runs(&stands, false).into_iter().filter(is_gate).map(|(from, to)| [place(from), place(to)]).collect()
}
