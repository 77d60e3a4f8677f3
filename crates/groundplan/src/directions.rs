//! II-A: the histogram of oriented gradients finds the directions, the sharpness of their radiograms measures them.

use crate::aligned::{ALIGNED_DEG, Aligned, aligned, take};
use crate::bent;
use crate::candidate::{CONTROLS_DEG, Candidate, NONE_QUIET, SQUARE, WING, alone, is_square, seconds, wings};
use crate::gradients::Gradients;
use crate::grid::{Frame, angle_between, tidy, tidy_angle, undirected};
use crate::oriented::{BINS, Oriented};
use crate::parameters::Parameters;
use crate::sharpness::{SCAN_DEG, sharpest};
use std::f64::consts::{FRAC_PI_2, PI};

/// The dominant directions, strongest first, and what they were decided from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Directions {
    /// Angle of the lines themselves in the map frame, radians in [-pi/2, pi/2).
    pub angles: Vec<f64>,
    /// Structure that lines up along each, as a share of the strongest's.
    pub weights: Vec<f64>,
    /// Histogram of oriented gradients: summed magnitude over the angle in the map frame, bins from -pi/2 upwards.
    pub histogram: Vec<f64>,
    /// Share of the edge pixels' length that lines up along the directions, 0 to 1.
    pub explained: f64,
}

/// The histogram is smoothed by a triangle of this half width, in bins.
const SMOOTHING: usize = 6;
/// Candidates lower than this share of the highest bin are not looked at.
const LOWEST_CANDIDATE: f64 = 0.04;
/// How many candidates are measured at most.
const MOST_CANDIDATES: usize = 16;
/// A direction has this many times as much lined up as chance has.
const CONTRAST: f64 = 3.0;
/// Beside a direction there may be another that has more, unless as much lined up along the one that was found as this
/// share of what lies along the new one. What the weaker one took stays with it: hardly anything lined up there.
const LINED_UP: f64 = 0.5;
/// Directions that are given closer than this are one, radians.
pub const SAME_DIRECTION: f64 = 1e-6;
/// While a candidate's angle is known to so many degrees, on a large map to fewer, it may have this share of what will be found.
const HALF_KNOWN_DEG: f64 = 0.5;
const HALF_KNOWN: f64 = 0.5;
/// Directions are whole parts of a right angle, 2 to this power of them: what changes in a corner of a map as a rule
/// turns none of them, and so moves no line elsewhere.
const PARTS_BITS: u32 = 15;
/// Of a large map so many more that this moves the end of a line against its middle by no more than that, pixels.
const MOST_MOVED: f64 = 0.1;

/// Finds the dominant directions, or measures how much lines up along those that are given.
///
/// The strongest peak of the histogram is measured first and the pixels that lie on its lines are taken out, so that
/// no pixel speaks for two directions; then the next, until what lines up is no longer worth the name.
#[must_use]
pub fn find_directions(frame: &Frame, gradients: &Gradients, parameters: &Parameters, threads: usize) -> Directions {
    let mut rest = Oriented::new(gradients);
    let histogram = turned(rest.histogram(), frame);
    let given = parameters.directions_angles_deg.as_ref();
    let mut found = match given {
        Some(angles) => measure(frame, &mut rest, angles, parameters, threads),
        None => search(frame, &mut rest, parameters, threads),
    };
    found.sort_by(|a, b| b.metres.total_cmp(&a.metres));
    let strongest = found.first().map_or(0.0, |f| f.metres);
    match parameters.directions_count {
        Some(count) => found.truncate(count),
        None if given.is_some() => {}
        None => {
            let (strong, weak): (Vec<_>, Vec<_>) =
                found.into_iter().partition(|f| f.metres >= parameters.directions_min_weight * strongest);
            found = strong.into_iter().filter(Candidate::exceeds_chance).collect();
            // What is a wing's is no hall's second.
            let wings = wings(&weak, &found, strongest, parameters);
            let is_of_wing = |f: &Candidate| wings.iter().any(|of_wing| of_wing.angle == f.angle);
            let others: Vec<Candidate> = weak.into_iter().filter(|f| !is_of_wing(f)).collect();
            found.extend(seconds(&others, &found));
            found.extend(wings);
        }
    }
    let diagonal = libm::hypot(frame.width as f64, frame.height as f64);
    // What has a direction of its own so near to another is a wing, and no part of a bent hall.
    let apart = 2.0 * parameters.directions_separation_deg.to_radians();
    let is_near = |(n, f): (usize, &Candidate)| found[..n].iter().any(|g| angle_between(f.angle, g.angle) < apart);
    let has_wing = found.iter().enumerate().any(is_near);
    let mean = |f: &Candidate| f.mean.filter(|_| !has_wing);
    let angle = |f: &Candidate| mean(f).map_or(f.angle, |mean| undirected(settled(diagonal, mean)));
    let sum: f64 = found.iter().map(|f| f.metres).sum();
    let total = gradients.pixels.len() as f64 * frame.resolution;
    Directions {
        angles: found.iter().map(|f| tidy_angle(frame.angle_to_map(angle(f)))).collect(),
        weights: found.iter().map(|f| if strongest > 0.0 { tidy(f.metres / strongest) } else { 0.0 }).collect(),
        histogram,
        explained: if total > 0.0 { tidy((sum / total).min(1.0)) } else { 0.0 },
    }
}

/// How much lines up along the directions that are given, degrees in the map frame; each once.
fn measure(
    frame: &Frame,
    rest: &mut Oriented,
    angles: &[f64],
    parameters: &Parameters,
    threads: usize,
) -> Vec<Candidate> {
    let mut found: Vec<Candidate> = Vec::new();
    for angle in angles.iter().map(|a| frame.angle_to_grid(a.to_radians())) {
        if found.iter().all(|other| angle_between(other.angle, angle) > SAME_DIRECTION) {
            let lines = aligned(frame, rest, angle, threads);
            take(rest, angle, &lines, parameters);
            let Aligned { metres, longest, .. } = lines;
            found.push(Candidate { angle, mean: None, metres, longest, quiet: NONE_QUIET });
        }
    }
    found
}

/// Takes direction after direction out of `rest`.
fn search(frame: &Frame, rest: &mut Oriented, parameters: &Parameters, threads: usize) -> Vec<Candidate> {
    let separation = parameters.directions_separation_deg.to_radians();
    let tolerance = parameters.radiograms_tolerance_deg.to_radians();
    let diagonal = libm::hypot(frame.width as f64, frame.height as f64);
    let mut strongest: f64 = 0.0;
    let mut found: Vec<Candidate> = Vec::new();
    let mut tried: Vec<f64> = Vec::new();
    let mut candidates = candidates(rest.histogram());
    while tried.len() < MOST_CANDIDATES {
        let fresh = |angle: &f64| tried.iter().all(|other| angle_between(*other, *angle) >= separation / 2.0);
        let Some(start) = candidates.iter().copied().find(fresh) else {
            break;
        };
        tried.push(start);
        // What may be a wing's has another square to it.
        let is_other = |f: &Candidate| is_square(start, f, ALIGNED_DEG) && f.metres >= WING.1 * strongest;
        let has_other =
            || found.iter().any(is_other) || most(frame, rest, start + FRAC_PI_2, ALIGNED_DEG) >= WING.1 * strongest;
        let [useful, perhaps] = [&found[..], &[]].map(|found| least(found, strongest, start, has_other, parameters));
        let most = most(frame, rest, start, ALIGNED_DEG + SCAN_DEG);
        if most < useful {
            continue;
        }
        // Else the staircase of walls beside it may have led there.
        let is_found = |other: &Candidate| other.metres >= LINED_UP * most;
        let is_far = |other: &Candidate, angle: f64, by: f64| angle_between(other.angle, angle) >= by;
        let far = |angle: f64, by: f64| found.iter().all(|other| is_far(other, angle, by) || !is_found(other));
        let worth = |angle: f64| {
            let metres = || aligned(frame, rest, angle, threads).metres;
            far(angle, separation - HALF_KNOWN_DEG.to_radians()) && (perhaps == 0.0 || metres() >= HALF_KNOWN * perhaps)
        };
        let sought = |start: f64| sharpest(&rest.along(start, tolerance), start, diagonal, threads, worth);
        // The walls may lie far from where their staircases look like: then what lies along them has not been asked yet, and
        // where the search ended is not the sharpest, but as far as it went.
        let is_far_off = |angle: f64| angle_between(angle, start) > SCAN_DEG.to_radians();
        let again = |angle: f64| if is_far_off(angle) { sought(angle) } else { Some(angle) };
        let Some(angle) = sought(start).and_then(again) else {
            continue;
        };
        let angle = undirected(settled(diagonal, angle));
        if far(angle, separation) {
            let lines = aligned(frame, rest, angle, threads);
            let Aligned { metres, longest, .. } = lines;
            if found.iter().any(|other| !is_far(other, angle, separation) && other.metres >= metres) {
                continue;
            }
            let quiet = if metres >= useful { quiet(frame, rest, angle, metres, threads) } else { NONE_QUIET };
            // What the strongest shows of the map counts for the others.
            let is_bent = found.first().is_some_and(|first| first.mean.is_some());
            let mean = || bent::mean(&rest.along(angle, tolerance), angle, frame.resolution, is_bent);
            let mean = if found.is_empty() || is_bent { mean() } else { None };
            strongest = strongest.max(metres);
            take(rest, angle, &lines, parameters);
            found.retain(|other| is_far(other, angle, separation));
            found.push(Candidate { angle, mean, metres, longest, quiet });
            candidates = self::candidates(rest.histogram());
        }
    }
    found
}

/// Beside those that were found, what is less than so many metres about an angle is of no use. Whether another may be square
/// to it is asked where it counts.
fn least(
    found: &[Candidate],
    strongest: f64,
    angle: f64,
    has_other: impl Fn() -> bool,
    parameters: &Parameters,
) -> f64 {
    let weight = parameters.directions_min_weight;
    if parameters.directions_count.is_some() {
        return 0.0;
    }
    let is_strong = |f: &&Candidate| f.metres >= weight * strongest && f.exceeds_chance();
    let strong: Vec<Candidate> = found.iter().filter(is_strong).copied().collect();
    if strong.len() < 2 {
        return weight.min(SQUARE.1) * strongest;
    }
    // Of the weak ones only what is square to one that has no other is taken, and a wing's.
    let near = |f: &&Candidate| is_square(angle, f, ALIGNED_DEG);
    let share = if has_other() { weight.min(WING.1) } else { weight };
    alone(&strong).filter(near).map(|f| SQUARE.1 * f.metres).fold(share * strongest, f64::min)
}

/// No less than lines up along an angle, by how many pixels lie along it.
fn most(frame: &Frame, rest: &Oriented, angle: f64, tolerance_deg: f64) -> f64 {
    rest.at_most_along(angle, tolerance_deg.to_radians()) as f64 * frame.resolution * std::f64::consts::SQRT_2
}

/// At which of the controls around an angle clearly less lines up than there.
fn quiet(frame: &Frame, rest: &Oriented, angle: f64, metres: f64, threads: usize) -> [bool; CONTROLS_DEG.len()] {
    CONTROLS_DEG.map(|turn| {
        let beside = angle + turn.to_radians();
        metres > CONTRAST * most(frame, rest, beside, ALIGNED_DEG)
            || metres > CONTRAST * aligned(frame, rest, beside, threads).metres
    })
}

/// The histogram over the angle in the map frame.
fn turned(histogram: &[u64], frame: &Frame) -> Vec<f64> {
    let shift = (frame.origin[2] / PI * BINS as f64).round().rem_euclid(BINS as f64) as usize;
    (0..BINS).map(|bin| histogram[(bin + BINS - shift) % BINS] as f64).collect()
}

/// Peaks of the smoothed histogram, highest first, as angles on the grid.
fn candidates(histogram: &[u64]) -> Vec<f64> {
    // Round about, so that none asks where it ends.
    let round = |values: &[u64]| -> Vec<u64> { [&values[BINS - SMOOTHING..], values, &values[..SMOOTHING]].concat() };
    let triangle = |around: &[u64]| {
        around.iter().enumerate().map(|(n, value)| value * (SMOOTHING + 1 - n.abs_diff(SMOOTHING)) as u64).sum()
    };
    let smooth: Vec<u64> = round(histogram).windows(2 * SMOOTHING + 1).map(triangle).collect();
    let highest = smooth.iter().copied().max().unwrap_or(0);
    let is_peak = |around: &[u64]| {
        let value = around[SMOOTHING];
        value > 0
            && value as f64 >= LOWEST_CANDIDATE * highest as f64
            && around[..SMOOTHING].iter().all(|lower| value > *lower)
            && around[SMOOTHING..].iter().all(|lower| value >= *lower)
    };
    let around = round(&smooth);
    let mut peaks: Vec<usize> = around
        .windows(2 * SMOOTHING + 1)
        .enumerate()
        .filter(|(_, around)| is_peak(around))
        .map(|(bin, _)| bin)
        .collect();
    peaks.sort_by_key(|&bin| (std::cmp::Reverse(smooth[bin]), bin));
    peaks.truncate(MOST_CANDIDATES);
    peaks.into_iter().map(|bin| undirected(((bin as f64 + 0.5) / BINS as f64 - 0.5) * PI)).collect()
}

/// The nearest whole part of a right angle, on a map of so many pixels from corner to corner.
fn settled(diagonal: f64, angle: f64) -> f64 {
    let mut part = FRAC_PI_2 / f64::from(1u32 << PARTS_BITS);
    while part / 2.0 * diagonal / 2.0 > MOST_MOVED {
        part /= 2.0;
    }
    (angle / part).round() * part
}
