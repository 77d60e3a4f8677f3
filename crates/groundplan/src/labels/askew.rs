//! Ways that lead askew through rows: where a hall's own two directions are square, what runs along those of another hall and
//! ends in the aisles beside such a row is no way but what empty bays leave free.

use super::across::{leading_across, square_to};
use super::beside::placed;
use super::corridors::{self, Strip};
use super::rows;
use super::turned::Turned;
use crate::ends::{holds, shared, sorted, wider};

/// What runs askew to a row has an angle to it of such sines: less is along it, more is across.
const ASKEW: [f64; 2] = [0.14, 0.98];
/// So much of an end may lie beyond the aisles, metres.
const BEYOND: f64 = 0.5;

/// The strips without those that lead askew through rows, and no farther than the aisles beside these.
pub fn without(views: &[Turned], strips: Vec<Strip>) -> Vec<Strip> {
    if views.len() < 3 {
        return strips;
    }
    let placed = placed(views, strips.iter().map(Strip::place));
    let widest = corridors::widest(&strips);
    // From where to where each lies in rows and in the aisles beside them.
    let mut within: Vec<Vec<[f64; 2]>> = vec![Vec::new(); strips.len()];
    for view in views {
        let Some(square) = square_to(views, view.direction) else { continue };
        let aisles: Vec<Strip> = strips.iter().filter(|strip| strip.direction == view.direction).cloned().collect();
        let extents: Vec<[f64; 2]> = aisles.iter().map(|aisle| aisle.along).collect();
        let rows = rows::between(views, &aisles, &extents);
        let askew = |other: &&Turned| other.direction != square.direction && holds(ASKEW, view.sine(other));
        for other in views.iter().filter(askew) {
            for (row, between) in rows.iter().filter_map(|row| row.between.map(|between| (row, between))) {
                let middle = f64::midpoint(row.across[0], row.across[1]);
                let sides = [aisles[between[0]].across[0], aisles[between[1]].across[1]];
                for n in leading_across([view, other], &placed, row, widest) {
                    let [s, u] = view.crossing(other, middle, strips[n].middle());
                    if holds(strips[n].along, s) && holds(row.along, u) {
                        within[n].push(sorted(sides.map(|side| view.crossing(other, side, strips[n].middle())[0])));
                    }
                }
            }
        }
    }
    let is_within = |(strip, some): (&Strip, &Vec<[f64; 2]>)| {
        let mut some = some.clone();
        some.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let [from, to] = wider(strip.along, -BEYOND);
        let reached = some.iter().filter(|ends| shared(**ends, strip.along)[0] < shared(**ends, strip.along)[1]);
        let end = reached.fold(from, |end, [low, high]| if *low <= end { end.max(*high) } else { end });
        !some.is_empty() && end >= to
    };
    let stays: Vec<bool> = strips.iter().zip(&within).map(|one| !is_within(one)).collect();
    strips.into_iter().zip(stays).filter_map(|(strip, stays)| stays.then_some(strip)).collect()
}
