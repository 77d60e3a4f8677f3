//! Frames: two legs of a rack that stand across from each other, or the plate that joins them.

use super::uprights::Upright;
use crate::ends::holds;
use std::collections::BTreeMap;

/// A leg is no wider than this, metres.
pub const LEG: f64 = 0.3;
/// From leg to leg across a frame, metres.
const DEPTH: [f64; 2] = [0.4, 1.6];
/// Legs of a frame are nearer to each other than so much of the aisle beyond them, which is looked for so far, metres.
const NEARER: f64 = 0.8;
pub const AISLE: f64 = 6.0;
/// Frames back to back are no further apart, metres.
pub const BACK: f64 = 0.6;
/// From leg to leg across what is between them, metres, where another leg of either is hidden: chairs stand farther off.
const FLUE: f64 = 0.37;
/// Legs back to back that are seen as one thing are no wider than this together, metres.
const TWO: f64 = 0.75;
/// The middle of a leg lies half of a usual one within the end of what it is a part of, metres.
const HALF: f64 = 0.05;
/// Legs stand so near to where they would without the map's error, metres.
pub const NEAR: f64 = 0.15;
/// A plate across two racks back to back is as deep as two frames in line with it, no farther off along than this, metres.
const ALONG: f64 = 9.0;

/// Two legs across from each other.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Along.
    pub at: f64,
    /// Across.
    pub faces: [f64; 2],
    /// A plate joins its legs.
    pub is_plate: bool,
}

impl Frame {
    pub fn depth(&self) -> f64 {
        self.faces[1] - self.faces[0]
    }

    /// True when it stands between two faces, but for the map's error.
    pub fn is_in_line(&self, faces: [f64; 2]) -> bool {
        self.faces.into_iter().zip(faces).all(|(own, other)| (own - other).abs() <= NEAR)
    }
}

/// What may be a leg.
#[derive(Clone, Copy)]
struct Leg {
    /// Along and across.
    at: [f64; 2],
    /// How long it is along and across together, metres.
    size: f64,
}

/// The frames that uprights make across a heading, by their places along it, and all legs.
pub fn frames(uprights: &[Upright], [cos, sin]: [f64; 2]) -> (Vec<Frame>, Legs) {
    let (mut frames, mut deep) = (Vec::new(), Vec::new());
    let mut all = Vec::new();
    for upright in uprights {
        let [x, y] = upright.at;
        let (u, v) = (x * cos + y * sin, y * cos - x * sin);
        let [along, across] = upright.extents([cos, sin]);
        if along > LEG {
            continue;
        }
        if across <= LEG {
            all.push(Leg { at: [u, v], size: along + across });
            continue;
        }
        if across <= TWO {
            let own = |side: f64| Leg { at: [u, v + side * (across / 2.0 - HALF)], size: 2.0 * along };
            all.extend([-1.0, 1.0].map(own));
        }
        let plate = Frame { at: u, faces: [v - across / 2.0 + HALF, v + across / 2.0 - HALF], is_plate: true };
        if holds(DEPTH, plate.depth()) {
            frames.push(plate);
        }
        if holds([2.0 * DEPTH[0], 2.0 * DEPTH[1] + BACK], plate.depth()) {
            deep.push(plate);
        }
    }
    let legs = Legs::new(&all);
    frames.extend(all.iter().filter_map(|leg| legs.frame(leg.at)));
    let shared = shared_plates(&deep, &frames);
    frames.extend(shared);
    frames.sort_by(|a, b| a.at.total_cmp(&b.at));
    (frames, legs)
}

/// The two frames back to back of each plate that is as deep as both, each as those in line with it that end at its lower face.
fn shared_plates(plates: &[Frame], frames: &[Frame]) -> Vec<Frame> {
    if plates.is_empty() {
        return Vec::new();
    }
    let strip = |face: f64| (face / NEAR).floor() as i64;
    let mut strips: BTreeMap<i64, Vec<&Frame>> = BTreeMap::new();
    for frame in frames {
        strips.entry(strip(frame.faces[0])).or_default().push(frame);
    }
    let both = |plate: &Frame| {
        let [low, high] = plate.faces;
        let is_half = |frame: &&Frame| {
            (frame.faces[0] - low).abs() <= NEAR
                && holds([-NEAR, BACK + NEAR], plate.depth() - 2.0 * frame.depth())
                && (frame.at - plate.at).abs() <= ALONG
        };
        let own = strip(low);
        let near = strips.range(own.saturating_sub(1)..=own.saturating_add(1)).flat_map(|(_, strip)| strip).copied();
        let off = |frame: &Frame| (frame.at - plate.at).abs();
        let half = near.filter(is_half).min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let depth = half.depth();
        Some([[low, low + depth], [high - depth, high]].map(|faces| Frame { faces, ..*plate }))
    };
    plates.iter().filter_map(both).flatten().collect()
}

/// Legs by columns as wide as they may be off, in the order of their places across.
pub struct Legs(BTreeMap<i64, Vec<Leg>>);

impl Legs {
    fn new(legs: &[Leg]) -> Self {
        let mut columns: BTreeMap<i64, Vec<Leg>> = BTreeMap::new();
        for leg in legs {
            columns.entry(Self::column(leg.at[0])).or_default().push(*leg);
        }
        for column in columns.values_mut() {
            column.sort_by(|a, b| a.at[1].total_cmp(&b.at[1]));
        }
        Self(columns)
    }

    fn column(u: f64) -> i64 {
        (u / NEAR).floor() as i64
    }

    /// True when a leg of a frame stands at a place along, be the other one not seen.
    pub fn stand_at(&self, u: f64, faces: [f64; 2]) -> bool {
        self.sizes_at(u, faces).next().is_some()
    }

    /// How large those are that stand at a place along, be it that of one leg of a frame.
    pub fn sizes_at(&self, u: f64, faces: [f64; 2]) -> impl Iterator<Item = f64> {
        let own = Self::column(u);
        let columns = self.0.range(own.saturating_sub(1)..=own.saturating_add(1));
        columns.flat_map(move |(_, column)| faces.map(|face| (column, face))).flat_map(move |(column, face)| {
            let first = column.partition_point(|leg| leg.at[1] < face - NEAR);
            let near = column[first..].iter().take_while(move |leg| leg.at[1] <= face + NEAR);
            near.filter(move |leg| (leg.at[0] - u).abs() <= NEAR).map(|leg| leg.size)
        })
    }

    /// The nearest in line with a leg on one side of it, no further off than an aisle is wide.
    fn next(&self, [u, v]: [f64; 2], side: f64) -> Option<[f64; 2]> {
        let own = Self::column(u);
        let near = self.0.range(own.saturating_sub(1)..=own.saturating_add(1)).filter_map(|(_, column)| {
            let is_next = |leg: &&Leg| (leg.at[0] - u).abs() <= NEAR && (leg.at[1] - v) * side > LEG / 2.0;
            let first = column.partition_point(|leg| leg.at[1] <= v);
            if side > 0.0 {
                column[first..].iter().take_while(|leg| leg.at[1] <= v + AISLE).find(is_next)
            } else {
                column[..first].iter().rev().take_while(|leg| leg.at[1] >= v - AISLE).find(is_next)
            }
        });
        let off = |leg: &Leg| (leg.at[1] - v).abs();
        near.min_by(|a, b| off(a).total_cmp(&off(b))).map(|leg| leg.at)
    }

    /// The frame that a leg makes with the next one.
    fn frame(&self, leg: [f64; 2]) -> Option<Frame> {
        let other = self.next(leg, 1.0)?;
        let depth = other[1] - leg[1];
        if !holds(DEPTH, depth) {
            return None;
        }
        let is_frame = self.is_open(leg, -1.0, depth) && self.is_open(other, 1.0, depth);
        (is_frame && !self.are_backs(leg, other)).then(|| Frame {
            at: f64::midpoint(leg[0], other[0]),
            faces: [leg[1], other[1]],
            is_plate: false,
        })
    }

    /// True when two legs are those in the middle of two frames back to back: the next on either side are as far off as each
    /// other, and beyond both lies an aisle.
    fn are_backs(&self, low: [f64; 2], high: [f64; 2]) -> bool {
        let back = high[1] - low[1];
        let beyond = [(low, -1.0), (high, 1.0)].map(|(leg, side)| {
            let far = self.next(leg, side)?;
            let depth = (far[1] - leg[1]).abs();
            let is_open = self.next(far, side).is_none_or(|next| depth <= NEARER * (next[1] - far[1]).abs());
            (is_open && depth > back).then_some(depth)
        });
        back <= BACK && matches!(beyond, [Some(one), Some(two)] if (one - two).abs() <= NEAR)
    }

    /// True when an aisle or nothing lies beyond a leg of a frame as deep, be it beyond another frame back to back, which
    /// may share the leg.
    fn is_open(&self, leg: [f64; 2], side: f64, depth: f64) -> bool {
        let gap = |leg: [f64; 2]| self.next(leg, side).map(|far| ((far[1] - leg[1]).abs(), far));
        let is_frame = |gap: f64| (gap - depth).abs() <= NEAR;
        let ends = |leg: [f64; 2]| gap(leg).is_none_or(|(gap, _)| depth <= NEARER * gap);
        match gap(leg) {
            Some((one, far)) if is_frame(one) => ends(far),
            Some((one, far)) if one <= BACK => match gap(far) {
                Some((two, far)) if is_frame(two) => ends(far),
                // So near the other leg of that frame is hidden by goods.
                _ => one <= FLUE && ends(far),
            },
            _ => ends(leg),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid;
    use crate::labels::posts::uprights;
    use crate::pixels::Pixels;

    /// The depths of the frames of racks along x, by what stands in pixels of 5 cm, from one corner to another.
    fn depths(things: &[[u32; 4]]) -> Vec<f64> {
        let frame = grid::Frame::new(200, 200, 0.05, [0.0; 3]);
        let columns =
            |[left, low, right, high]: [u32; 4]| (low..=high).flat_map(move |y| (left..=right).map(move |x| [x, y]));
        let mut pixels: Vec<[u32; 2]> = things.iter().flat_map(|&thing| columns(thing)).collect();
        pixels.sort_unstable_by_key(|&[x, y]| [y, x]);
        let (frames, _) = frames(&uprights::find(&frame, &Pixels::from_iter(pixels)), [1.0, 0.0]);
        frames.iter().map(Frame::depth).collect()
    }

    #[test]
    fn legs_back_to_back_that_are_seen_as_one_thing_make_two_frames() {
        // Legs at the faces, and in the middle two of 10 cm side by side, apart and as one.
        let apart = [[50, 20, 51, 21], [50, 38, 51, 39], [50, 42, 51, 43], [50, 60, 51, 61]];
        let one = [[50, 20, 51, 21], [50, 38, 51, 43], [50, 60, 51, 61]];
        for legs in [&apart[..], &one] {
            let depths = depths(legs);
            assert_eq!(depths.len(), 2, "{depths:?}");
            assert!(depths.iter().all(|depth| (depth - 0.9).abs() < 0.11), "{depths:?}");
        }
    }
}
