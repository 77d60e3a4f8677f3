//! Racks on legs that end at a wall: the last legs stand against it and are seen as bumps, one bay beyond the last ones that stand by
//! themselves.

use super::map::{Map, steps};
use super::rack::{Rack, UP_TO_WALL};
use crate::ends::{holds, wider};
use crate::grid::State;
use crate::labels::junctions::shut::sign;

/// A leg is looked for so far to either side of where it would stand, metres, and reaches so far before the wall at least, no less than
/// a pixel, and at most: what reaches farther stands before the wall.
const ASIDE: f64 = 0.05;
const BUMP: [f64; 2] = [0.04, 0.3];
/// The wall itself is looked at so far beside the legs, metres: pilasters and goods are wider than these.
const BESIDE: [f64; 4] = [0.25, 0.35, 0.45, 0.55];
/// So many legs of the racks that may end at a wall are seen, and such a share of them, and no more of what lies beside them.
const LEGS: usize = 3;
const SEEN: f64 = 0.4;
const CHANCE: f64 = 0.12;
/// None of a rack's legs is seen where that is no less likely than this.
const UNSEEN: f64 = 0.02;
/// Racks that end so near to each other along end at one wall, metres.
const IN_LINE: f64 = 0.5;

/// What is seen one bay beyond an end of a rack: whether a bump on the wall where each of its legs would stand, and beside these.
struct Look {
    rack: usize,
    legs: Vec<bool>,
    beside: Vec<bool>,
}

/// The racks of a direction, those that stand against a wall up to that. Of the legs there not all are seen: those of all racks that
/// end at the wall tell.
pub fn up_to_walls(map: &Map, racks: &mut [Rack]) {
    for side in [0, 1] {
        let beyond = |rack: &Rack| rack.row.along[side] + sign(side) * rack.pitch;
        let may_end =
            |rack: &Rack| !rack.closed[side] && map.is_walled(wider([beyond(rack); 2], UP_TO_WALL), rack.row.across);
        let mut ending: Vec<usize> = (0..racks.len()).filter(|&n| may_end(&racks[n])).collect();
        ending.sort_by(|&a, &b| beyond(&racks[a]).total_cmp(&beyond(&racks[b])));
        let at_one_wall = |a: &usize, b: &usize| (beyond(&racks[*b]) - beyond(&racks[*a])).abs() <= IN_LINE;
        let walls: Vec<Vec<usize>> = ending.chunk_by(at_one_wall).map(<[usize]>::to_vec).collect();
        for wall in walls {
            let looks: Vec<Look> = wall.iter().filter_map(|&n| look(map, racks, n, side)).collect();
            if stand_against(&looks) {
                for look in looks.iter().filter(|look| may_stand(look, &looks)) {
                    let rack = &mut racks[look.rack];
                    rack.row.along[side] += sign(side) * rack.pitch;
                    rack.frames += 1;
                }
            }
        }
    }
}

/// True when legs are seen on a wall, and hardly anything beside them.
fn stand_against(looks: &[Look]) -> bool {
    let count = |all: &[bool]| all.iter().filter(|is_bump| **is_bump).count();
    let sum = |of: fn(&Look) -> &Vec<bool>| {
        let all = looks.iter().map(of);
        all.fold([0, 0], |[bumps, places], own| [bumps + count(own), places + own.len()])
    };
    let ([legs, places], [others, beside]) = (sum(|look| &look.legs), sum(|look| &look.beside));
    legs >= LEGS && legs as f64 >= SEEN * places as f64 && others as f64 <= CHANCE * beside as f64
}

/// True when some of a rack's legs are seen, or none might be as seldom as those of the others are.
fn may_stand(own: &Look, all: &[Look]) -> bool {
    let some: Vec<bool> =
        all.iter().filter(|look| look.legs.contains(&true)).flat_map(|look| &look.legs).copied().collect();
    let unseen = some.iter().filter(|is_seen| !**is_seen).count() as f64 / some.len().max(1) as f64;
    own.legs.contains(&true) || !own.legs.is_empty() && unseen.powi(own.legs.len() as i32) >= UNSEEN
}

/// Nothing where no wall is seen beside the legs.
fn look(map: &Map, racks: &[Rack], n: usize, side: usize) -> Option<Look> {
    let (rack, pixel) = (&racks[n], map.grid.frame.resolution);
    let from = rack.row.along[side] + sign(side) * rack.pitch / 2.0;
    let before_wall = |v: f64| {
        let mut offs = steps([0.0, rack.pitch / 2.0 + UP_TO_WALL], pixel / 2.0);
        offs.find(|off| map.state([from + sign(side) * off, v]) == State::Occupied)
    };
    let nearest = |v: f64| [v - ASIDE, v, v + ASIDE].into_iter().filter_map(before_wall).reduce(f64::min);
    let [low, high] = rack.row.across;
    let inner = [low + rack.depth, high - rack.depth];
    let is_double = inner[0] < inner[1];
    let legs = [low, high].into_iter().chain(inner.into_iter().filter(|_| is_double));
    let within = BESIDE.into_iter().filter(|off| *off < rack.depth / 2.0).flat_map(|off| [low + off, high - off]);
    let beside = BESIDE.into_iter().flat_map(|off| [low - off, high + off]).chain(within);
    let beside: Vec<f64> = beside.filter_map(nearest).collect();
    let mut in_order = beside.clone();
    in_order.sort_by(f64::total_cmp);
    let wall = *in_order.get(in_order.len() / 2)?;
    let is_bump = |off: f64| holds([pixel.max(BUMP[0]), BUMP[1]], wall - off);
    let is_before = |off: f64| wall - off >= pixel.max(BUMP[0]);
    Some(Look {
        rack: n,
        legs: legs.filter_map(nearest).map(is_bump).collect(),
        beside: beside.into_iter().map(is_before).collect(),
    })
}
