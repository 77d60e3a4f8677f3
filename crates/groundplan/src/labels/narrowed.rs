//! Ways past the ends of racks: one that racks across it reach into from its sides is as wide as what they leave of it.

use super::beside::{Beside, wider};
use super::corridors::Strip;
use super::racks::{Row, SAME};
use super::turned::Turned;

/// Racks leave no less of a way than this share of its width, or what they stand in is none along it.
const LEFT: f64 = 0.5;
/// A rack stands across a direction when the cosine of the angle between is no more than this.
const ASKEW: f64 = 0.05;

/// The strips, each between the racks that reach into it; none becomes narrower than the least that a corridor is.
pub fn past(views: &[Turned], strips: &[Strip], racks: &[Row], least: f64) -> Vec<Strip> {
    let mut past = strips.to_vec();
    for view in views {
        let stand: Vec<_> = racks.iter().filter_map(|rack| place(view, &views[rack.direction], rack)).collect();
        let mut placed = Beside::of(view);
        stand.iter().enumerate().for_each(|(n, &[along, across])| placed.add(n, along, across));
        for strip in past.iter_mut().filter(|strip| strip.direction == view.direction) {
            let left = between(strip, placed.touching(strip.along, strip.across).into_iter().map(|n| stand[n]));
            if left[1] - left[0] >= least.max(LEFT * strip.width()) {
                strip.across = left;
            }
        }
    }
    past
}

/// What is left of a strip between racks, each of which takes what is beyond it from the side that it is nearer to.
fn between(strip: &Strip, racks: impl Iterator<Item = [[f64; 2]; 2]>) -> [f64; 2] {
    let shared = |one: [f64; 2], two: [f64; 2]| one[1].min(two[1]) - one[0].max(two[0]);
    let mut left = strip.across;
    // At its ends it goes past what stands along the ways that it meets.
    let stretch = wider(strip.along, -strip.width());
    for [along, across] in racks {
        if shared(along, stretch) < SAME || shared(across, strip.across) < SAME {
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

/// From where to where a rack that stands across a direction does so, along and across.
fn place(view: &Turned, own: &Turned, rack: &Row) -> Option<[[f64; 2]; 2]> {
    if libm::cos(own.angle - view.angle).abs() > ASKEW {
        return None;
    }
    let corners = own.rectangle(rack.along, rack.across).into_iter().map(|corner| view.place(corner));
    let ends = |axis: usize| {
        let places = corners.clone().map(|corner| corner[axis]);
        places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| [low.min(place), high.max(place)])
    };
    Some([ends(0), ends(1)])
}
