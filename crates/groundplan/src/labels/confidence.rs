//! How sure a label is: what the pixels around it say of the question that it answers, from 0 (nothing speaks for it)
//! to 1 (nothing against it). Each kind has its own question; the map itself is asked, not the steps that led to the
//! label, so that two ways to find a label are held to one measure. Racks bear witness for those that are as deep.

use super::looks::{Looks, STEP, along, frame_of};
use super::recall::Key;
use super::rows::blocks::as_deep;
use super::{Evidence, JunctionKind, Label};
use crate::bands::map_each;
use crate::grid::State;
use crate::subdivision::distance;

/// So many labels are worth a thread's while.
const TOGETHER: usize = 16;
/// A side's structure lies from so far within a corridor to so far outside it, metres.
const SIDE: [f64; 2] = [-0.2, 0.4];
/// The middle part of a way's width in which it must be free.
const MIDDLE: f64 = 0.7;
/// Beyond a junction an arm is open, or closed, so far, metres.
const ARM: f64 = 3.0;
/// A corridor is an arm of a junction when it goes on so far beyond it, metres.
const BEYOND: f64 = 1.0;
/// So far beside a door its two spaces are measured, metres, and no wider than so many times the door.
const ASIDE: f64 = 0.8;
const WIDER: f64 = 3.0;
/// Floor shows so far before a rack's faces, metres.
const FRONT: f64 = 0.4;
/// Faces more solid than this are more and more like walls.
const SOLID: f64 = 0.85;
/// Less of a rack than this is taken where there is floor under it: then its posts are looked for.
const HOLLOW: f64 = 0.5;
/// So much does another rack that is as deep, and sure, weigh beside what a rack looks like itself.
const WITNESS: f64 = 0.5;
/// Floor shows round a pillar at this distance from its faces, metres.
const ROUND: f64 = 0.3;

/// How deep racks are, in order, each with how sure those before it are together: racks come in kinds, and one as deep
/// as others is less in doubt, the less the surer they are.
struct Kinds(Vec<(f64, f64)>);

impl Kinds {
    fn new(labels: &[Label], sure: &[f64]) -> Self {
        let racks = labels.iter().zip(sure).filter_map(|(label, sure)| match label {
            Label::Rack { width, .. } => Some((*width, *sure)),
            _ => None,
        });
        let mut racks: Vec<_> = racks.collect();
        racks.sort_by(|one, two| one.0.total_cmp(&two.0));
        racks.push((f64::INFINITY, 0.0));
        let mut before = 0.0;
        for (_, sure) in &mut racks {
            before += std::mem::replace(sure, before);
        }
        Self(racks)
    }

    /// How sure a rack is beside all that are as deep.
    fn witnessed(&self, depth: f64, own: f64) -> f64 {
        let off = as_deep(depth);
        let [from, to] = [depth - off, depth + off].map(|end| self.0[self.0.partition_point(|rack| rack.0 < end)].1);
        1.0 - (1.0 - own) / (1.0 + WITNESS * (to - from - own).max(0.0))
    }
}

/// For each label how sure it is, 0 to 1.
#[must_use]
pub fn find_confidence(evidence: &Evidence, labels: &[Label]) -> Vec<f64> {
    confidence(labels, &each_by_itself(evidence, labels))
}

/// How sure each of some labels is by itself; where there are junctions, the corridors that meet there come first.
pub(crate) fn each_by_itself(evidence: &Evidence, labels: &[Label]) -> Vec<f64> {
    let Evidence { grid, threads, recall, .. } = *evidence;
    let ask = |map: &Looks, label: &Label| match label {
        Label::Corridor { axis, width, .. } => map.corridor(*axis, *width),
        Label::Junction { kind, at, corridors, .. } => map.junction(labels, *kind, *at, corridors),
        Label::Region { polygon, .. } => map.region(polygon),
        Label::Door { axis, .. } => map.door(*axis),
        Label::Rack { axis, width, .. } => map.rack(*axis, *width),
        Label::Pillar { at, width, .. } => map.pillar(*at, *width),
    };
    let patches = recall.patches(grid, threads);
    let sure = |label: &Label| {
        let look = || {
            let map = Looks::new(grid);
            (ask(&map, label), map.asked())
        };
        recall.sure.or_look(patches, || key(labels, label), look)
    };
    let parts: Vec<&[Label]> = labels.chunks(TOGETHER).collect();
    map_each(parts.len(), threads, |n| parts[n].iter().map(sure).collect::<Vec<_>>()).concat()
}

/// How sure all labels are beside one another, by how sure each is by itself.
pub(crate) fn confidence(labels: &[Label], own: &[f64]) -> Vec<f64> {
    let kinds = Kinds::new(labels, own);
    let witnessed = |(label, own): (&Label, &f64)| match label {
        Label::Rack { width, .. } => kinds.witnessed(*width, *own),
        _ => *own,
    };
    let rounded = |sure: f64| (sure.clamp(0.0, 1.0) * 1000.0).round() / 1000.0;
    labels.iter().zip(own).map(witnessed).map(rounded).collect()
}

/// The key of all that is asked about a label but for the map.
fn key(labels: &[Label], label: &Label) -> Key {
    let axis = |key: Key, axis: &[[f64; 2]; 2], width: f64| key.numbers(axis.as_flattened()).number(width);
    let kind = |number| Key::default().with(number);
    match label {
        Label::Corridor { axis: own, width, .. } => axis(kind(0), own, *width),
        Label::Junction { kind: own, at, corridors, .. } => {
            let known = kind(1).with(*own as u64).numbers(at);
            corridors.iter().fold(known, |known, &id| match labels.get(id as usize) {
                Some(Label::Corridor { axis: own, width, .. }) => axis(known, own, *width),
                _ => known,
            })
        }
        Label::Region { polygon, .. } => kind(2).numbers(polygon.as_flattened()),
        Label::Door { axis: own, .. } => axis(kind(3), own, 0.0),
        Label::Rack { axis: own, width, .. } => axis(kind(4), own, *width),
        Label::Pillar { at, width, .. } => kind(5).numbers(at).number(*width),
    }
}

/// A way out of a junction: where that lies, whereto it leads, across what width, and how far out it begins, metres.
struct Out {
    at: [f64; 2],
    way: [f64; 2],
    across: [f64; 2],
    width: f64,
    from: f64,
}

impl Out {
    /// The place so far out in its middle.
    fn place(&self, t: f64) -> [f64; 2] {
        [0, 1].map(|n| self.at[n] + t * self.way[n])
    }
}

impl Looks<'_> {
    /// Free along its middle, and structure along both sides: of an empty rack posts are enough, as long as they come
    /// again and again.
    fn corridor(&self, axis: [[f64; 2]; 2], width: f64) -> f64 {
        let [_, across] = frame_of(axis);
        let mut free = 0.0;
        let mut walled = [0.0; 2];
        let places = along(axis, self.step());
        for &at in &places {
            free += self.open(at, across, MIDDLE * width);
            for (side, share) in [-1.0, 1.0].into_iter().zip(&mut walled) {
                *share += f64::from(u8::from(self.is_bounded(at, across, side, width / 2.0)));
            }
        }
        let count = places.len() as f64;
        let [left, right] = [0, 1].map(|side| {
            let walled = 2.0 * walled[side] / count;
            // No posts make more of a side that is walled.
            if walled < 1.0 { walled.max(self.posts(axis, [-1.0, 1.0][side] * width / 2.0)).min(1.0) } else { 1.0 }
        });
        free / count * left.min(right).sqrt()
    }

    /// True when something that is not free lies about a way's side.
    fn is_bounded(&self, at: [f64; 2], across: [f64; 2], side: f64, half: f64) -> bool {
        let reach = SIDE.map(|off| half + off);
        let steps = ((reach[1] - reach[0]) / self.step_through_walls()).ceil() as usize;
        (0..=steps).any(|n| {
            let v = side * (reach[0] + (reach[1] - reach[0]) * n as f64 / steps as f64);
            !self.is_free([at[0] + v * across[0], at[1] + v * across[1]])
        })
    }

    /// Every way out that its type counts is open for some metres, or as far as it leads, and every one that it denies is
    /// closed.
    fn junction(&self, labels: &[Label], kind: JunctionKind, at: [f64; 2], corridors: &[u32]) -> f64 {
        let mut sure = 1.0_f64;
        let own: Vec<([[f64; 2]; 2], f64)> = corridors
            .iter()
            .filter_map(|&id| match labels.get(id as usize) {
                Some(Label::Corridor { axis, width, .. }) => Some((*axis, *width)),
                _ => None,
            })
            .collect();
        let widest = own.iter().map(|(_, width)| *width).fold(0.0, f64::max);
        for (n, &(axis, width)) in own.iter().enumerate() {
            let [heading, across] = frame_of(axis);
            let others = own.iter().enumerate().filter(|(m, _)| *m != n).map(|(_, (_, width))| *width);
            let [side, reach] = if kind == JunctionKind::End {
                [0.0; 2]
            } else {
                let met = others.fold(0.0, f64::max);
                [met, met.max(0.5 * width)].map(|width| width / 2.0)
            };
            for sign in [-1.0, 1.0] {
                let way = [sign * heading[0], sign * heading[1]];
                // Another corridor may be this one's other half.
                let is_along = |other: &[[f64; 2]; 2]| {
                    let [direction, _] = frame_of(*other);
                    (direction[0] * way[0] + direction[1] * way[1]).abs() > 0.9
                };
                let ends = own.iter().filter(|(other, _)| is_along(other)).flat_map(|(other, _)| other);
                let far = ends.map(|end| (end[0] - at[0]) * way[0] + (end[1] - at[1]) * way[1]).fold(0.0, f64::max);
                let out = |from| Out { at, way, across, width: MIDDLE * width, from };
                sure = sure.min(if far > reach + BEYOND {
                    self.opened(&out(reach), ARM.min(far - reach))
                } else {
                    self.closed(&out(side), ARM.max(widest))
                });
            }
        }
        if own.is_empty() { 0.0 } else { sure }
    }

    /// Free share of a way out where it is the least open, over some metres.
    fn opened(&self, out: &Out, depth: f64) -> f64 {
        let steps = (depth / self.step()).ceil() as usize;
        let places = (1..=steps).map(|n| out.from + n as f64 * depth / steps as f64);
        places.map(|t| self.open(out.place(t), out.across, out.width)).fold(1.0, f64::min)
    }

    /// Share of a way out that does not lead on so many metres: something that is not free lies in it.
    fn closed(&self, out: &Out, depth: f64) -> f64 {
        let step = self.step_through_walls();
        let steps = ((depth - SIDE[0]) / step).ceil() as usize;
        let is_closed = |lane: [f64; 2]| {
            let place = |t: f64| [0, 1].map(|n| lane[n] + t * out.way[n]);
            (0..=steps).any(|n| !self.is_free(place(SIDE[0] + n as f64 * step)))
        };
        let lanes = self.lanes(out.place(out.from), out.across, out.width);
        let count = lanes.len() as f64;
        lanes.filter(|lane| is_closed(*lane)).count() as f64 / count
    }

    /// Share of the outline with something behind it: the rest is open, a door or the end of what was seen.
    fn region(&self, polygon: &[[f64; 2]]) -> f64 {
        let (mut bounded, mut all) = (0usize, 0usize);
        for (n, &from) in polygon.iter().enumerate() {
            let side = [from, polygon[(n + 1) % polygon.len()]];
            let [_, [nx, ny]] = frame_of(side);
            for [x, y] in along(side, self.step()) {
                all += 1;
                // Counter-clockwise: outside is on the right.
                let pixel = self.resolution();
                let near = (0..(0.2 / pixel).round().max(1.0) as usize).map(|n| (n as f64 + 0.5) * pixel);
                bounded +=
                    usize::from(near.into_iter().any(|d| self.state([x - d * nx, y - d * ny]) == State::Occupied));
            }
        }
        bounded as f64 / all.max(1) as f64
    }

    /// How much narrower it is than the spaces on both its sides.
    fn door(&self, axis: [[f64; 2]; 2]) -> f64 {
        let [along, across] = frame_of(axis);
        let width = distance(axis[0], axis[1]).max(STEP);
        let middle = [0, 1].map(|n| f64::midpoint(axis[0][n], axis[1][n]));
        let beside = |side: f64| {
            let depths = (1..=4).map(|n| ASIDE * f64::from(n) / 2.0);
            depths
                .map(|depth| {
                    let at = [middle[0] + side * depth * across[0], middle[1] + side * depth * across[1]];
                    let reach = |way: f64| {
                        let steps = (WIDER * width / (STEP / 2.0)) as usize;
                        let free = (0..steps).take_while(|n| {
                            let t = way * *n as f64 * STEP / 2.0;
                            self.is_free([at[0] + t * along[0], at[1] + t * along[1]])
                        });
                        free.count() as f64 * STEP / 2.0
                    };
                    reach(1.0) + reach(-1.0)
                })
                .fold(0.0, f64::max)
        };
        1.0 - width / beside(1.0).min(beside(-1.0)).max(width)
    }

    /// Something stands in it all along, or where there is floor between its faces posts come back at one pitch on both, or
    /// both are closed; and both its faces were seen: of what lies behind a face that was not, nobody knows where it ends.
    fn rack(&self, axis: [[f64; 2]; 2], width: f64) -> f64 {
        let [_, across] = frame_of(axis);
        let places = along(axis, self.step());
        let taken: f64 = places.iter().map(|&at| (2.0 * (1.0 - self.open(at, across, width))).min(1.0)).sum();
        let seen = [-1.0, 1.0].map(|side| {
            let is_seen = |at: &&[f64; 2]| {
                let before = [0, 1].map(|n| at[n] + side * (width / 2.0 + FRONT) * across[n]);
                self.is_free(before)
            };
            places.iter().filter(is_seen).count() as f64
        });
        let solid = [-1.0, 1.0].map(|side| {
            let is_solid = |at: &&[f64; 2]| self.is_taken(**at, across, side * width / 2.0);
            places.iter().filter(is_solid).count() as f64
        });
        let count = places.len() as f64;
        let taken = if taken < HOLLOW * count {
            let posts = [-1.0, 1.0].map(|side| self.posts(axis, side * width / 2.0));
            // Or it is drawn by its outline.
            taken.max(count * posts[0].min(posts[1])).max(solid[0].min(solid[1]))
        } else {
            taken
        };
        // Goods and posts leave gaps; two faces without any may be walls with nothing known between.
        let walls = ((solid[0].min(solid[1]) / count - SOLID) / (1.0 - SOLID)).max(0.0);
        (1.0 - walls / 2.0) * taken / count * f64::midpoint(1.0, seen[0].min(seen[1]) / count) * seen[0].max(seen[1])
            / count
    }

    /// Share of the ring round it that is floor.
    fn pillar(&self, at: [f64; 2], width: f64) -> f64 {
        let radius = width / std::f64::consts::SQRT_2 + ROUND;
        let ring = (0..32).map(|n| f64::from(n) * std::f64::consts::TAU / 32.0);
        let free = ring.filter(|a| self.is_free([at[0] + radius * libm::cos(*a), at[1] + radius * libm::sin(*a)]));
        free.count() as f64 / 32.0
    }
}
