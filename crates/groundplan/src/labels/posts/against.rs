//! Racks on legs that end at a wall: the last legs stand against it and are seen as bumps, one bay beyond the last ones that stand by
//! themselves.

use super::legs::{Rack, UP_TO_WALL};
use super::map::{Map, steps};
use crate::ends::wider;
use crate::grid::State;
use crate::labels::junctions::shut::sign;

/// A leg is looked for so far to either side of where it would stand, metres, and reaches no less far before the wall, nor less than
/// a pixel.
const ASIDE: f64 = 0.05;
const BUMP: f64 = 0.04;
/// The wall itself is looked at so far beside the faces, metres.
const BESIDE: [f64; 3] = [0.3, 0.4, 0.5];
/// So many legs of all racks that may end at a wall are seen, and such a share of them, and no more of what lies beside them.
const LEGS: usize = 3;
const SEEN: f64 = 0.4;
const CHANCE: f64 = 0.1;

/// The racks of a direction, those that stand against a wall up to that.
pub fn up_to_walls(map: &Map, racks: &mut [Rack]) {
    for side in [0, 1] {
        let beyond = |rack: &Rack| rack.row.along[side] + sign(side) * rack.pitch;
        let may_end = |rack: &Rack| map.is_walled(wider([beyond(rack); 2], UP_TO_WALL), rack.row.across);
        let ending: Vec<usize> = (0..racks.len()).filter(|&n| may_end(&racks[n])).collect();
        let looks: Vec<_> = ending.iter().filter_map(|&n| seen(map, &racks[n], side)).collect();
        let [legs, wall] = [0, 1].map(|of| looks.iter().flat_map(|look| &look[of]).copied().collect::<Vec<bool>>());
        let bumps = |all: &[bool]| all.iter().filter(|is_bump| **is_bump).count();
        let share = |all: &[bool]| bumps(all) as f64 / all.len().max(1) as f64;
        if bumps(&legs) >= LEGS && share(&legs) >= SEEN && share(&wall) <= CHANCE {
            for n in ending {
                racks[n].row.along[side] = beyond(&racks[n]);
                racks[n].frames += 1;
            }
        }
    }
}

/// Whether a bump is seen on the wall one bay beyond a rack's end, where its legs would stand, and beside these.
fn seen(map: &Map, rack: &Rack, side: usize) -> Option<[Vec<bool>; 2]> {
    let pixel = map.grid.frame.resolution;
    let from = rack.row.along[side] + sign(side) * rack.pitch / 2.0;
    let before_wall = |v: f64| {
        let mut offs = steps([0.0, rack.pitch / 2.0 + UP_TO_WALL], pixel / 2.0);
        offs.find(|off| map.state([from + sign(side) * off, v]) == State::Occupied)
    };
    let nearest = |v: f64| [v - ASIDE, v, v + ASIDE].into_iter().filter_map(before_wall).reduce(f64::min);
    let [low, high] = rack.row.across;
    let beside = BESIDE.into_iter().flat_map(|off| [low - off, high + off]);
    let walls: Vec<f64> = beside.filter_map(nearest).collect();
    let mut sorted = walls.clone();
    sorted.sort_by(f64::total_cmp);
    let wall = *sorted.get(sorted.len() / 2)?;
    let is_bump = |off: f64| off <= wall - pixel.max(BUMP);
    let inner = [low + rack.depth, high - rack.depth];
    let is_double = inner[0] < inner[1];
    let legs = [low, high].into_iter().chain(inner.into_iter().filter(|_| is_double));
    Some([legs.filter_map(nearest).map(is_bump).collect(), walls.into_iter().map(is_bump).collect()])
}
