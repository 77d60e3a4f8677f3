//! Ways through rows of racks, and past their ends: one that what stands in rows reaches into from its sides is as wide as
//! that leaves it, one that is part of what a row leaves is all of that, and one whose sides are no lines ends with the racks
//! beside it, unless it leads on to something.

use super::across::leading_across;
use super::lead::Lead;
use crate::ends::{around, both, overlap, shared, wider};
use crate::labels::beside::Beside;
use crate::labels::corridors::Strip;
use crate::labels::rows::seen::Seen;
use crate::labels::rows::{DEPTH, Row, SAME};
use crate::labels::view::turned::Turned;

/// Racks leave no less of a way than this share of its width, or what they stand in is none along it.
const LEFT: f64 = 0.5;
/// Lines lie no farther within the uprights at a way's sides, both together, metres.
const WIDER: f64 = 0.4;
/// Two middles so near to each other are one, metres.
const NEAR: f64 = 0.12;
/// What a rack along a way takes of it counts from so far within its side on, metres.
const TAKEN: f64 = 0.12;
/// A rack stands across a direction when the cosine of the angle between is no more than this.
const ASKEW: f64 = 0.05;

/// The strips, each from upright to upright of that row which leaves most, of those that it leads through between their ends;
/// where they leave less than the least that a corridor is, it is as it was. It is known where all of them lie, and none is
/// wider than the widest.
pub fn between_uprights(strips: &[Strip], rows: &[Seen], placed: &[Beside], [least, widest]: [f64; 2]) -> Vec<Strip> {
    let mut most: Vec<Option<[f64; 2]>> = vec![None; strips.len()];
    for seen in rows {
        for n in leading_across(seen.views, placed, seen.row, widest) {
            let strip = &strips[n];
            let lead = Lead { views: seen.views, row: seen.row, strip };
            if lead.is_across() && lead.is_within() {
                let left = seen.gap_about(strip.middle()).map_or(strip.across, |gap| own_of(strip, gap));
                let is_wider = |most: [f64; 2]| most[1] - most[0] >= left[1] - left[0];
                most[n] = most[n].filter(|most| is_wider(*most)).or(Some(left));
            }
        }
    }
    let narrow = |(strip, most): (&Strip, Option<[f64; 2]>)| {
        let across = most.filter(|[low, high]| high - low >= least).unwrap_or(strip.across);
        Strip { across, ..strip.clone() }
    };
    strips.iter().zip(most).map(narrow).collect()
}

/// The strips; what leads through one row alone is the whole of the way there from upright to upright, where it is part of one: a line
/// that lies in its middle is of something else.
pub fn whole(strips: &[Strip], rows: &[Seen], placed: &[Beside], widest: f64) -> Vec<Strip> {
    let mut passed = vec![0; strips.len()];
    let mut ways: Vec<Option<[f64; 2]>> = vec![None; strips.len()];
    for seen in rows {
        for n in leading_across(seen.views, placed, seen.row, widest) {
            let strip = &strips[n];
            let lead = Lead { views: seen.views, row: seen.row, strip };
            if lead.is_across() {
                passed[n] += 1;
                ways[n] = seen.way_about(strip.middle()).filter(|way| {
                    way[1] - way[0] > strip.width() + WIDER && lead.is_within() && !seen.is_as_bays(*way)
                });
            }
        }
    }
    let whole = |((strip, way), passed): ((&Strip, Option<[f64; 2]>), usize)| {
        let across = way.filter(|_| passed == 1).unwrap_or(strip.across);
        Strip { across, ..strip.clone() }
    };
    strips.iter().zip(ways).zip(passed).map(whole).collect()
}

/// What of a gap between uprights is a strip's: all of it, if that is little wider, about the strip's own middle, if that is no
/// farther off: lines are known more closely than where uprights end.
fn own_of(strip: &Strip, gap: [f64; 2]) -> [f64; 2] {
    let own = if gap[1] - gap[0] <= strip.width() + WIDER { gap } else { shared(strip.across, gap) };
    let is_about = (f64::midpoint(own[0], own[1]) - strip.middle()).abs() <= NEAR;
    if is_about { wider([strip.middle(); 2], (own[1] - own[0]) / 2.0) } else { own }
}

/// The strips, each between the racks that reach into it, and from where to where it leads along; none becomes narrower
/// than the least that a corridor is.
pub fn past(views: &[Turned], strips: &[Strip], racks: &[Row], reached: &[[f64; 2]], least: f64) -> Vec<Strip> {
    let mut past = strips.to_vec();
    for view in views {
        let places: Vec<_> = racks.iter().map(|rack| place(view, &views[rack.direction], rack)).collect();
        let mut placed = Beside::of(view);
        places.iter().enumerate().for_each(|(n, &[along, across])| placed.add(n, along, across));
        // Faces along a way are known more closely than where racks across it end.
        let counts_from = |n: usize| {
            let racked = racks[n].direction;
            let is_across = || libm::cos(views[racked].angle - view.angle).abs() <= ASKEW;
            if racked == view.direction { Some(TAKEN) } else { is_across().then_some(SAME) }
        };
        for (strip, reached) in past.iter_mut().zip(reached).filter(|(strip, _)| strip.direction == view.direction) {
            let near = placed.touching(strip.along, strip.across).into_iter();
            let left = between(strip, near.filter_map(|n| Some((places[n], counts_from(n)?))));
            if left == strip.across || left[1] - left[0] < least.max(LEFT * strip.width()) {
                continue;
            }
            strip.across = left;
            if strip.is_ragged {
                let beside = wider(left, DEPTH.0);
                let near = placed.touching(strip.along, beside).into_iter().map(|n| places[n]);
                let near = near.filter(|[_, across]| beside[0] <= across[1] && across[0] <= beside[1]);
                strip.along = shared(strip.along, near.map(|[along, _]| along).fold(*reached, both));
            }
        }
    }
    past
}

/// What is left of a strip between racks, each of which takes what is beyond it from the side that it is nearer to.
/// It counts from so far within the strip on.
fn between(strip: &Strip, racks: impl Iterator<Item = ([[f64; 2]; 2], f64)>) -> [f64; 2] {
    let mut left = strip.across;
    // At its ends it goes past what stands along the ways that it meets.
    let stretch = wider(strip.along, -strip.width() / 2.0);
    for ([along, across], least) in racks {
        if overlap(along, stretch) < SAME || overlap(across, strip.across) < least {
            continue;
        }
        if f64::midpoint(across[0], across[1]) < strip.middle() {
            left[0] = left[0].max(across[1]);
        } else {
            left[1] = left[1].min(across[0]);
        }
    }
    left
}

/// From where to where a rack stands, along and across a direction.
fn place(view: &Turned, own: &Turned, rack: &Row) -> [[f64; 2]; 2] {
    let corners = own.rectangle(rack.along, rack.across);
    [0, 1].map(|axis| around(corners.iter().map(|&corner| view.place(corner)[axis])))
}
