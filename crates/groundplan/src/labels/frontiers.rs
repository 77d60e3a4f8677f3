//! Ways that end at a frontier, between what was seen and what was not (Yamauchi 1997), before they are long enough for one:
//! past the ends of two rows a robot saw as far between them as its sensor reaches, and went on.

use super::beside::placed;
use super::corridors::Strip;
use super::openings::{self, Opening};
use super::ragged;
use super::turned::Turned;
use crate::ends::{both, wider};
use crate::parameters::Parameters;

/// One side is held over so much of what was seen, and so many metres; the other over so many, as by the end of a row.
const HELD: f64 = 0.6;
const HELD_METRES: [f64; 2] = [0.5, 2.0];
/// What is in line with another has its sides no farther than this from that one's, metres.
const IN_LINE: f64 = 0.5;

/// The ways with those that end at frontiers and are as wide as others; none where there are no such.
pub fn with(views: &[Turned], strips: &[Strip], parameters: &Parameters) -> Option<Vec<Strip>> {
    let mut ways = strips.to_vec();
    let mut placed = placed(views, strips.iter().map(Strip::place));
    let is_alike = |way: &Strip| strips.iter().any(|one| one.direction == way.direction && one.is_as_wide(way));
    let leads_on = |opening: &Opening| {
        let is_known = || strips.iter().any(|one| is_in_line(one, &opening.way));
        let [low, high] = opening.held;
        let is_long = low.max(high) >= HELD_METRES[1].max(HELD * opening.way.length());
        opening.is_frontier && low.min(high) >= HELD_METRES[0] && (is_long || is_known())
    };
    for passing in strips {
        let found = openings::of(views, passing, parameters).into_iter().filter(leads_on);
        for Opening { mut way, middle, .. } in found.filter(|opening| is_alike(&opening.way)) {
            way.along = both(way.along, [middle; 2]);
            let reaching = Strip { along: wider(way.along, passing.width() / 2.0), ..way.clone() };
            let near = placed[way.direction].touching(reaching.along, way.across).into_iter();
            let near = near.filter(|&n| ragged::is_beside(&ways[n], &reaching));
            let n = match near.collect::<Vec<usize>>()[..] {
                [] => {
                    ways.push(way);
                    ways.len() - 1
                }
                // Another one ends there, in line.
                [n] if is_in_line(&ways[n], &way) => {
                    ways[n].along = both(ways[n].along, way.along);
                    n
                }
                _ => continue,
            };
            placed[ways[n].direction].add(n, ways[n].along, ways[n].across);
        }
    }
    (ways != strips).then_some(ways)
}

/// True when one way lies in line with another.
fn is_in_line(one: &Strip, other: &Strip) -> bool {
    one.direction == other.direction && (0..2).all(|side| (one.across[side] - other.across[side]).abs() <= IN_LINE)
}
