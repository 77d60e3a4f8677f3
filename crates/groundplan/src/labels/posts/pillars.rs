//! Pillars: what is small, stands by itself in free space, and recurs as what carries a roof does and as what was left
//! on the floor does not.
//!
//! Two blobs in line, or three at a right angle, propose a row or a grid whose pitch divides their distances. How many
//! others it meets is held against how many it would meet if all lay anyhow: the proposal least to be had by chance is
//! a pattern when fewer than one in a hundred such would be expected of all that were tried (Desolneux, Moisan and
//! Morel 2000).

use super::period::{self, Period};
use crate::grid::{State, angle_between};
use crate::labels::Evidence;
use crate::labels::near::Polygons;
use crate::labels::rooms::Raster;
use std::f64::consts::FRAC_PI_2;

/// Pillars stand this near to their places, metres: the map's error, which finds itself.
const NEAR: [f64; 3] = [0.15, 0.3, 0.5];
/// And are no more different in width, metres.
const ALIKE: f64 = 0.15;
/// A pillar is at most so many times as long as thick.
const STOUT: f64 = 1.8;
/// Two that propose a row are at most so far apart, metres, and have at most so many places between them.
const REACH: f64 = 25.0;
const BETWEEN: u32 = 4;
/// Least distance in which anything recurs, metres.
const OTHER: f64 = 1.0;
/// So many patterns are expected by chance where one is believed.
const CHANCE: f64 = 0.01;
/// This near to a rack stand its posts, metres.
pub const RIM: f64 = 0.3;
/// Strength of the period that members of a pattern have.
const STRENGTH: f64 = 0.8;
/// Directions nearer than this are one, radians.
const APART: f64 = 0.05;
/// More small things than this are no pillars but a map of specks.
const MOST: usize = 400;

/// Something small.
#[derive(Clone, Copy, Debug)]
struct Blob {
    at: [f64; 2],
    width: f64,
}

/// A pillar.
#[derive(Clone, Copy, Debug)]
pub struct Pillar {
    pub at: [f64; 2],
    pub width: f64,
    /// Those of one number recur together.
    pub pattern: u32,
}

/// The pillars. Within `grounds`, convex polygons, stand racks and their posts.
pub fn find(evidence: &Evidence, raster: &Raster, grounds: &[Vec<[f64; 2]>]) -> Vec<Pillar> {
    let blobs = blobs(evidence, raster, grounds);
    let mut pillars = Vec::new();
    if blobs.len() > MOST {
        return pillars;
    }
    let angles = angles(&evidence.directions.angles);
    let least = evidence.parameters.pillars_min_pitch;
    let mut left = blobs;
    let mut pattern = 0;
    while let Some(members) = best(&left, &angles) {
        let places: Vec<[f64; 2]> = members.iter().map(|&n| left[n].at).collect();
        // What recurs more closely than pillars do is something else, and none of it is a pillar.
        if lattice(&places, &angles).is_some_and(|lattice| !lattice.is_finer(least)) {
            pillars.extend(members.iter().map(|&n| Pillar { at: left[n].at, width: left[n].width, pattern }));
            pattern += 1;
        }
        let mut number = 0..;
        left.retain(|_| number.next().is_some_and(|n| !members.contains(&n)));
    }
    pillars
}

/// The members of the pattern that is least to be had by chance, if it is not to be had at all.
fn best(blobs: &[Blob], angles: &[f64]) -> Option<Vec<usize>> {
    let mut best: Option<(f64, Vec<usize>)> = None;
    let mut tried = 0.0;
    let area = area(blobs);
    for (&angle, near) in angles.iter().flat_map(|angle| NEAR.map(|near| (angle, near))) {
        let places: Vec<[f64; 2]> = blobs.iter().map(|blob| turn(blob.at, angle)).collect();
        for first in 0..blobs.len() {
            let along = steps(blobs, &places, first, 0, near);
            let across = steps(blobs, &places, first, 1, near);
            for &u in &along {
                for v in std::iter::once(None).chain(across.iter().copied().map(Some)) {
                    tried += 1.0;
                    let on = |n: usize| {
                        let [du, dv] = [0, 1].map(|axis| places[n][axis] - places[first][axis]);
                        off(du, Some(u)) <= near && off(dv, v) <= near && alike(blobs, first, n)
                    };
                    let members: Vec<usize> = (0..blobs.len()).filter(|&n| on(n)).collect();
                    let given = if v.is_some() { 3 } else { 2 };
                    if members.len() <= given {
                        continue;
                    }
                    // A blob that lies anyhow is met with the share of the ground that is near to places.
                    let met = match v {
                        Some(v) => (2.0 * near / u) * (2.0 * near / v),
                        None => (2.0 * near / u) * (2.0 * near / area.sqrt()),
                    };
                    let chance = tail(blobs.len() as f64 * met.min(1.0), members.len() - given);
                    if best.as_ref().is_none_or(|(least, _)| chance < *least) {
                        best = Some((chance, members));
                    }
                }
            }
        }
    }
    best.filter(|(chance, _)| chance * tried < CHANCE).map(|(_, members)| members)
}

/// Pitches that blobs in line with the first propose along an axis.
fn steps(blobs: &[Blob], places: &[[f64; 2]], first: usize, axis: usize, near: f64) -> Vec<f64> {
    let mut steps = Vec::new();
    for n in (0..blobs.len()).filter(|&n| n != first && alike(blobs, first, n)) {
        let [du, dv] = [axis, 1 - axis].map(|axis| places[n][axis] - places[first][axis]);
        if du > 0.0 && du <= REACH && dv.abs() <= near {
            steps.extend((1..=BETWEEN).map(|count| du / f64::from(count)).filter(|step| *step >= OTHER));
        }
    }
    steps
}

fn alike(blobs: &[Blob], a: usize, b: usize) -> bool {
    (blobs[a].width - blobs[b].width).abs() <= ALIKE
}

/// From a distance to the nearest multiple of a pitch, or to nothing.
fn off(distance: f64, pitch: Option<f64>) -> f64 {
    pitch.map_or(distance.abs(), |pitch| (distance - (distance / pitch).round() * pitch).abs())
}

/// Chance of so many or more where `mean` are expected (Poisson).
fn tail(mean: f64, count: usize) -> f64 {
    let mut term = libm::exp(-mean);
    let mut below = 0.0;
    for n in 0..count {
        below += term;
        term *= mean / (n as f64 + 1.0);
    }
    // The sum from there on: what is left of one loses all digits when it is small.
    let mut above = 0.0;
    for n in count..count + 50 {
        above += term;
        term *= mean / (n as f64 + 1.0);
    }
    if below < 0.5 { 1.0 - below } else { above }
}

/// A row or a grid: places recur along an angle, square to it, or both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Radians in the map frame.
    pub angle: f64,
    /// Along the angle and square to it.
    pub periods: [Option<Period>; 2],
}

impl Lattice {
    fn is_finer(&self, least: f64) -> bool {
        self.periods.iter().flatten().any(|period| period.pitch < least)
    }
}

/// The lattice along one of some angles that holds places best.
pub fn lattice(places: &[[f64; 2]], angles: &[f64]) -> Option<Lattice> {
    let along = |angle: f64| {
        let turned: Vec<[f64; 2]> = places.iter().map(|&place| turn(place, angle)).collect();
        let periods = [0, 1].map(|axis| {
            let places: Vec<f64> = turned.iter().map(|place| place[axis]).collect();
            period::find(&places, [OTHER, REACH + OTHER]).filter(|period| period.strength >= STRENGTH)
        });
        Lattice { angle, periods }
    };
    let strength = |l: &Lattice| l.periods.iter().flatten().map(|period| period.strength).sum::<f64>();
    let best = angles.iter().rev().map(|&angle| along(angle)).max_by(|a, b| strength(a).total_cmp(&strength(b)));
    best.filter(|lattice| strength(lattice) > 0.0)
}

/// The directions and those square to them.
pub fn angles(directions: &[f64]) -> Vec<f64> {
    let mut angles: Vec<f64> = Vec::new();
    for angle in directions.iter().flat_map(|angle| [*angle, *angle + FRAC_PI_2]) {
        if angles.iter().all(|known| angle_between(*known, angle) > APART) {
            angles.push(angle);
        }
    }
    angles
}

/// What is small enough for a pillar and stands by itself, on no rack's ground.
fn blobs(evidence: &Evidence, raster: &Raster, grounds: &[Vec<[f64; 2]>]) -> Vec<Blob> {
    let (least, most) = (evidence.parameters.pillars_min_width, evidence.parameters.pillars_max_width);
    let frame = &evidence.grid.frame;
    let grounds = Polygons::new(grounds);
    let mut blobs = Vec::new();
    for island in &raster.islands.small {
        let width = (island.length * island.thickness).sqrt() * raster.resolution;
        let grid = raster.to_grid(island.middle);
        let at = frame.to_metres(grid);
        if !(least..=most).contains(&width) || island.length > STOUT * island.thickness {
            continue;
        }
        // Something was seen there: it is not what no ray has met.
        let reach = (island.length / 2.0 * raster.side as f64).ceil() as i64 + 1;
        let occupied = (-reach..=reach).any(|dy| {
            let y = grid[1] as i64 + dy;
            (0..frame.height as i64).contains(&y) && {
                let row = evidence.grid.row(y as usize);
                (-reach..=reach).any(|dx| {
                    let pixel = usize::try_from(grid[0] as i64 + dx).ok().and_then(|x| row.get(x));
                    pixel.is_some_and(|&p| evidence.grid.table.states[usize::from(p)] == State::Occupied)
                })
            }
        });
        if occupied && !grounds.hold(at) {
            blobs.push(Blob { at, width });
        }
    }
    blobs
}

/// Square metres over which blobs lie.
fn area(blobs: &[Blob]) -> f64 {
    let extent = |axis: usize| {
        let low = blobs.iter().map(|blob| blob.at[axis]).fold(f64::INFINITY, f64::min);
        let high = blobs.iter().map(|blob| blob.at[axis]).fold(f64::NEG_INFINITY, f64::max);
        (high - low).max(OTHER)
    };
    extent(0) * extent(1)
}

fn turn([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    [x * cos + y * sin, y * cos - x * sin]
}
