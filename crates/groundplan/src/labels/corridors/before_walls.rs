//! Ways before a wall that are known by the one that ends there: what opens to its one side is in line with what opens to the other,
//! and of the aisles beside it, to which they lead, not much was seen.

use super::frontiers::IN_LINE;
use super::openings::Opening;
use crate::ends::{both, holds, overlap, shared, sorted, wider};
use crate::labels::corridors::Strip;
use crate::labels::junctions::shut;
use crate::labels::view::turned::Turned;

/// A way ends so near to what opens to its sides, metres, and the wall stands no farther beyond the far side of that.
const NEAR: f64 = 0.5;

/// What leads to both sides at an end of a way, of what opens into it.
pub fn find<'a>(views: &[Turned], passing: &Strip, openings: impl Iterator<Item = &'a Opening>) -> Vec<Strip> {
    let at_ends: Vec<&Strip> =
        openings.map(|opening| &opening.way).filter(|way| is_at_end(views, passing, way)).collect();
    let pairs = at_ends.iter().enumerate().flat_map(|(n, one)| at_ends[n + 1..].iter().map(move |two| (*one, *two)));
    let facing = pairs.filter(|(one, two)| one.is_in_line(two, IN_LINE) && overlap(one.along, two.along) <= 0.0);
    let whole = |(one, two): (&Strip, &Strip)| Strip {
        along: both(one.along, two.along),
        across: shared(one.across, two.across),
        ..one.clone()
    };
    facing.map(whole).collect()
}

/// True when a way ends where another opens into it, and a wall closes it on that one's far side.
fn is_at_end(views: &[Turned], passing: &Strip, way: &Strip) -> bool {
    let view = &views[passing.direction];
    let at = sorted(way.across.map(|across| view.crossing(&views[way.direction], passing.middle(), across)[1]));
    (0..2).any(|side| {
        let end = passing.along[side];
        holds(wider(at, NEAR), end) && shut::closed(view, passing, side, (at[side] - end).abs() + NEAR).is_some()
    })
}
