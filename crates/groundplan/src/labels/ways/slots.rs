//! Slots in racks of several pallets' depth: places that are empty from one face on, which are no ways, be they as long as
//! some.

use super::across::crossing;
use crate::ends::{around, holds, wider};
use crate::labels::beside::placed;
use crate::labels::corridors::Strip;
use crate::labels::corridors::connected;
use crate::labels::corridors::family;
use crate::labels::junctions::meeting::CLUTTER;
use crate::labels::rows::DEPTH;
use crate::labels::rows::sections::WIDTH;
use crate::labels::view::turned::Turned;

/// Two aisles that a rack lies between are so far apart at most, metres: one that is filled from both its faces.
const DEEPEST: f64 = 2.0 * DEPTH.1;
/// What ends so near to an aisle opens into it, metres.
const MOUTH: f64 = 0.6;
/// The aisles beside a slot go on past it by so many times its width.
const PAST: f64 = 2.0;
/// A slot is narrower than this share of an aisle that it opens into.
const NARROWER: f64 = family::LED_TO;

/// The strips without slots. One leads from an aisle, is narrower than that, and something stands between its end and the next
/// aisle, no farther off than a rack is deep. Or it leads through to that, is too narrow for a way, and few are alike.
pub fn without(views: &[Turned], strips: Vec<Strip>) -> Vec<Strip> {
    let placed = placed(views, strips.iter().map(Strip::place));
    let is_slot = |n: usize| {
        let own = &strips[n];
        let (view, Some(other)) = (&views[own.direction], crossing(views, own.direction)) else { return false };
        let corners = view.rectangle(wider(own.along, DEEPEST), own.across);
        let [along, across] = [0, 1].map(|axis| around(corners.iter().map(|&corner| other.place(corner)[axis])));
        // From where to where along the strip each of the others lies, and how wide it is.
        let lies = |aisle: &Strip| {
            let [s, u] = view.crossing(other, own.middle(), aisle.middle());
            let reach = aisle.width() / 2.0 / other.sine(view);
            // At a rack's end it leads past that.
            let goes_on = holds(wider(aisle.along, -PAST * own.width()), s);
            (goes_on && aisle.length() > own.length()).then_some(([u - reach, u + reach], aisle.width()))
        };
        let near = placed[other.direction].touching(along, across).into_iter();
        let aisles: Vec<_> = near.filter_map(|m| lies(&strips[m])).collect();
        let middle = f64::midpoint(own.along[0], own.along[1]);
        let (before, behind): (Vec<_>, Vec<_>) =
            aisles.into_iter().partition(|([from, to], _)| from + to < 2.0 * middle);
        let before = before.into_iter().max_by(|a, b| a.0[1].total_cmp(&b.0[1]));
        let behind = behind.into_iter().min_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        let (Some((before, one)), Some((behind, two))) = (before, behind) else { return false };
        // What crosses an aisle leads on from there.
        if own.along[0] < before[0] - MOUTH || own.along[1] > behind[1] + MOUTH {
            return false;
        }
        let is_closed = |ends: [f64; 2]| view.mean_blocked(view.columns(ends), own.across[0], own.across[1]) > CLUTTER;
        let opens = [own.along[0] - before[1] <= MOUTH, behind[0] - own.along[1] <= MOUTH];
        // Where nothing stands between its end and an aisle it leads on to that.
        let between = [[before[1], own.along[0]], [own.along[1], behind[0]]];
        let leads = [0, 1].map(|side| opens[side] || !is_closed(between[side]));
        let is_narrower = |width: f64| own.width() < NARROWER * width;
        behind[0] - before[1] <= DEEPEST
            && match leads {
                [true, false] => is_narrower(one),
                [false, true] => is_narrower(two),
                [true, true] => {
                    own.width() < WIDTH.0
                        && is_narrower(one.min(two))
                        && !connected::is_one_of_many(&strips, &placed, n)
                }
                [false, false] => false,
            }
    };
    let stays: Vec<bool> = (0..strips.len()).map(|n| !is_slot(n)).collect();
    strips.into_iter().zip(stays).filter_map(|(strip, stays)| stays.then_some(strip)).collect()
}
