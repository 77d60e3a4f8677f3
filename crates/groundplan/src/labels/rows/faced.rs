//! Ways between two racks that face each other: such a way is as long as both, be it seen there or not.

use crate::ends::{holds, overlap, shared, wider};
use crate::labels::beside::placed;
use crate::labels::corridors::Strip;
use crate::labels::corridors::barriers;
use crate::labels::rows::{Row, SAME};
use crate::labels::view::turned::Turned;

/// So much of what was not seen may be taken.
const CLUTTER: f64 = 0.05;

/// The strips, each from where to where racks stand on both its sides, where nothing stands between these and no other
/// strip is.
pub fn whole(views: &[Turned], strips: &[Strip], racks: &[Row]) -> Vec<Strip> {
    let standing = placed(views, racks.iter().map(Row::place));
    let known = placed(views, strips.iter().map(Strip::place));
    let as_long = |(n, strip): (usize, &Strip)| {
        let view = &views[strip.direction];
        let near = standing[strip.direction].touching(strip.along, wider(strip.across, SAME));
        let is_free = |[from, to]: [f64; 2]| {
            let columns = view.columns([from, to]);
            let taken = view.some_occupied(columns.clone(), strip.across[0], strip.across[1]);
            let others = known[strip.direction].touching([from, to], strip.across);
            let is_other = |m: usize| {
                overlap(strips[m].along, [from, to]) > view.cell && overlap(strips[m].across, strip.across) > 0.0
            };
            taken.iter().sum::<f64>() <= CLUTTER * taken.len() as f64
                && !others.into_iter().any(|m| m != n && is_other(m))
                && !barriers::among(view, strip.across, columns).any()
        };
        let mut whole = strip.clone();
        for end in 0..2 {
            // The racks that stand along both its sides where it ends.
            let facing = |side: usize| {
                let is_beside = |rack: &&Row| {
                    (rack.across[1 - side] - strip.across[side]).abs() <= SAME && holds(rack.along, strip.along[end])
                };
                near.iter().map(|&n| &racks[n]).find(is_beside)
            };
            let (Some(one), Some(two)) = (facing(0), facing(1)) else { continue };
            let on = match (shared(one.along, two.along), end) {
                ([low, _], 0) => [low, strip.along[0]],
                ([_, high], _) => [strip.along[1], high],
            };
            if on[1] - on[0] > SAME && is_free(on) {
                whole.along[end] = on[end];
                whole.stops[end] = true;
            }
        }
        whole
    };
    strips.iter().enumerate().map(as_long).collect()
}
