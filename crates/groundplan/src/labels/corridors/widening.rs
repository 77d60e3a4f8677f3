//! Ways that go on as wider ones: what was led on over where these begin leads to the first way there.

use crate::labels::beside::placed;
use crate::labels::corridors::Strip;
use crate::labels::junctions::meeting::{Meeting, of_each};
use crate::labels::junctions::shut::sign;
use crate::labels::view::turned::Turned;

/// The middle of what both ways meet may lie so far before the place where the wider one begins, metres.
const SLACK: f64 = 0.25;

/// The ways, each up to those in line with it that are wider and begin where it was not found, and what it meets there.
pub fn up_to(views: &[Turned], strips: &[Strip], meetings: &[Meeting]) -> Vec<Strip> {
    let placed = placed(views, strips.iter().map(Strip::place));
    let met = of_each(meetings, strips.len());
    let up_to = |(n, way): (usize, &Strip)| {
        let near = placed[way.direction].touching(way.along, way.across).into_iter().map(|m| &strips[m]);
        let mut short = way.clone();
        for (other, side) in near.filter(|other| other.is_wider_over(way)).flat_map(|other| [(other, 0), (other, 1)]) {
            // Along the way, outwards.
            let out = |place: f64| place * sign(side);
            let found = out(way.found[side]);
            if out(other.found_along()[1 - side]) < found {
                continue;
            }
            let begins = out(other.along[1 - side]).max(found) - SLACK;
            let places = met[n].iter().map(|&m| out(views[way.direction].place(meetings[m].at)[0]));
            let first = places.filter(|place| *place >= begins).min_by(f64::total_cmp);
            if let Some(first) = first.filter(|first| *first < out(short.along[side])) {
                short.along[side] = out(first);
                short.stops[side] = true;
            }
        }
        short
    };
    strips.iter().enumerate().map(up_to).collect()
}
