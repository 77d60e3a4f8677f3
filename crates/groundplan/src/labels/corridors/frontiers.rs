//! Ways of which little more was seen than where they open into others. They end at a frontier, between what was seen and what was
//! not (Yamauchi 1997), before they are long enough for a way: past the ends of two rows, or through a row in line with a way, a
//! robot saw as far as its sensor reaches, and went on. And ways before a wall, or on along one, into which such ways may open.

use super::along_walls::{self, On};
use super::before_walls;
use super::openings::{self, Opening};
use super::ragged;
use crate::ends::{around, both, holds, shared, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::Strip;
use crate::labels::junctions::shut;
use crate::labels::rows::Row;
use crate::labels::view::turned::Turned;
use crate::parameters::Parameters;

/// One side is held over so much of what was seen, and so many metres; the other over so many, as by the end of a row.
const HELD: f64 = 0.6;
const HELD_METRES: [f64; 2] = [0.5, 2.0];
/// Along rows, and across them in line with a known way, as ways lead on, the ends of two rows are enough, over so many metres of
/// each of which something stands: walls beside a gate are not so deep.
const ROW: f64 = 0.8;
/// What is in line with another has its sides no farther than this from that one's, metres.
const IN_LINE: f64 = 0.5;

/// The ways with those that end at frontiers or lead before walls and are as wide as others, and with what they lead on along walls;
/// none where there is no such.
pub fn with(views: &[Turned], strips: &[Strip], rows: &[Row], parameters: &Parameters) -> Option<Vec<Strip>> {
    let mut ways = strips.to_vec();
    let mut placed = placed(views, strips.iter().map(Strip::place));
    let pitches = openings::pitches(views, rows);
    let is_alike = |way: &Strip| strips.iter().any(|one| one.direction == way.direction && one.is_as_wide(way));
    let is_along_rows = |way: &Strip| rows.iter().any(|row| row.direction == way.direction);
    // The last is asked first: each way, what leads before the wall at its end, and when all are known what ways lead on over along
    // walls, which they do where others open into that.
    let mut rest: Vec<(Strip, Option<On>)> =
        along_walls::find(views, strips, &placed, rows).into_iter().map(|on| (on.floor.clone(), Some(on))).collect();
    rest.extend(strips.iter().rev().map(|strip| (strip.clone(), None)));
    while let Some((passing, on)) = rest.pop() {
        let passing = &passing;
        let found = openings::of(views, passing, &pitches, parameters);
        for way in before_walls::find(views, passing, found.iter().filter(|opening| is_held(opening))) {
            let is_known = |n: usize| ragged::is_beside(&ways[n], &way);
            if is_alike(&way) && !placed[way.direction].touching(way.along, way.across).into_iter().any(is_known) {
                placed[way.direction].add(ways.len(), way.along, way.across);
                rest.push((way.clone(), None));
                ways.push(way);
            }
        }
        let mut leads_on = on.as_ref().is_some_and(|on| along_walls::is_led_to(views, on, &ways, &placed));
        let is_way = |opening: &Opening| {
            opening.is_frontier
                && is_alike(&opening.way)
                && (is_held(opening)
                    || is_between_rows(opening)
                        && (is_along_rows(&opening.way) || is_led_to(views, &opening.way, &ways, &placed))
                        && !is_through_another(views, &opening.way, passing, &ways, &placed))
        };
        for Opening { mut way, middle, .. } in found.into_iter().filter(is_way).collect::<Vec<_>>() {
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
            leads_on = true;
            placed[ways[n].direction].add(n, ways[n].along, ways[n].across);
        }
        if let Some(On { way, along, .. }) = on.filter(|_| leads_on) {
            ways[way].along = both(ways[way].along, along);
            placed[passing.direction].add(way, ways[way].along, ways[way].across);
        }
    }
    (ways != strips).then_some(ways)
}

/// True when what opens lies between two sides of which one may be no more than the end of a row.
fn is_held(opening: &Opening) -> bool {
    let [low, high] = opening.held;
    low.min(high) >= HELD_METRES[0] && low.max(high) >= HELD_METRES[1].max(HELD * opening.way.length())
}

/// True when it lies between the ends of two rows.
fn is_between_rows(opening: &Opening) -> bool {
    opening.stands.into_iter().all(|metres| metres >= ROW)
}

/// True when a way leads to another in line with it: nothing stands across between them. Of all ways it is known where they
/// lie.
fn is_led_to(views: &[Turned], way: &Strip, ways: &[Strip], placed: &[Beside]) -> bool {
    let view = &views[way.direction];
    let is_open = |one: &Strip| {
        let [to, from] = shared(one.along, way.along);
        from >= to || !(view.column(from)..view.column(to)).any(|n| shut::is_shut_at(view, way, n))
    };
    let in_line = placed[way.direction].touching([f64::NEG_INFINITY, f64::INFINITY], way.across).into_iter();
    in_line.map(|n| &ways[n]).any(|one| is_in_line(one, way) && is_open(one))
}

/// True when what opens into one way was seen through the next one: into that it opens as well, or not. Of all ways it is
/// known where they lie.
fn is_through_another(views: &[Turned], way: &Strip, passing: &Strip, ways: &[Strip], placed: &[Beside]) -> bool {
    let [view, other] = [way, passing].map(|way| &views[way.direction]);
    let corners = view.rectangle(way.along, way.across);
    let [along, across] = [0, 1].map(|axis| around(corners.iter().map(|&corner| other.place(corner)[axis])));
    placed[passing.direction].touching(along, across).into_iter().map(|n| &ways[n]).any(|next| {
        let [s, u] = view.crossing(other, way.middle(), next.middle());
        holds(way.along, u) && holds(next.along, s)
    })
}

/// True when one way lies in line with another.
pub fn is_in_line(one: &Strip, other: &Strip) -> bool {
    one.direction == other.direction && (0..2).all(|side| (one.across[side] - other.across[side]).abs() <= IN_LINE)
}
