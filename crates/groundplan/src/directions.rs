//! II-A: the histogram of oriented gradients finds the directions, the sharpness of their radiograms measures them.

use crate::gradients::Gradients;
use crate::grid::{Frame, angle_between, tidy, tidy_angle, undirected};
use crate::oriented::{BINS, Oriented, Sharpness};
use crate::parameters::Parameters;
use crate::radiograms::{UNIT, bins, metres_per_unit, project};
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
/// Where to look for what lines up by chance, degrees from a candidate.
const CONTROLS_DEG: [f64; 6] = [-26.0, -19.0, -13.0, 13.0, 19.0, 26.0];
/// A pixel speaks for a direction when it lies within this angle of it, degrees.
const ALIGNED_DEG: f64 = 6.0;
/// A direction has this many times as much lined up as chance has.
const CONTRAST: f64 = 3.0;
/// So many of the controls may lie on other directions.
const OTHERS_AMONG_CONTROLS: usize = 4;
/// Where there would be one direction only, a second one needs this share of its structure.
const SECOND: f64 = 0.04;
/// Directions that are given closer than this are one, radians.
const CLOSEST: f64 = 1e-6;
/// Steps of the search for the sharpest radiogram: half range and step, degrees. The first is over coarser bins.
const SEARCH: [(f64, f64); 3] = [(3.0, 0.25), (0.3, 0.05), (0.06, 0.01)];
/// How often the search moves on, at most.
const MOST_MOVES: usize = 2;
/// Directions are whole parts of a right angle, 2 to this power of them: what changes in a corner of a map as a rule
/// turns none of them, and so moves no line elsewhere.
const PARTS_BITS: u32 = 15;
/// Of a large map so many more that this moves the end of a line against its middle by no more than that, pixels.
const MOST_MOVED: f64 = 0.1;
/// A line shorter than this many pixels says nothing of a direction.
const SHORTEST_PIXELS: f64 = 20.0;
/// Half the window of the background that a line must stand out of, pixels.
const BACKGROUND_PIXELS: usize = 20;

/// Finds the dominant directions, or measures how much lines up along those that are given.
///
/// The strongest peak of the histogram is measured first and the pixels that lie on its lines are taken out, so that
/// no pixel speaks for two directions; then the next, until what lines up is no longer worth the name.
#[must_use]
pub fn find_directions(frame: &Frame, gradients: &Gradients, parameters: &Parameters) -> Directions {
    let mut rest = Oriented::new(gradients);
    let histogram = rest.histogram();
    let given = parameters.directions_angles_deg.as_ref();
    let mut found = match given {
        Some(angles) => measure(frame, &mut rest, angles, parameters),
        None => search(frame, &mut rest, parameters),
    };
    found.sort_by(|a, b| b.metres.total_cmp(&a.metres));
    let strongest = found.first().map_or(0.0, |f| f.metres);
    match parameters.directions_count {
        Some(count) => found.truncate(count),
        None if given.is_some() => {}
        None => {
            let (strong, weak): (Vec<_>, Vec<_>) =
                found.into_iter().partition(|f| f.metres >= parameters.directions_min_weight * strongest);
            found = strong.into_iter().filter(|f| f.exceeds_chance(OTHERS_AMONG_CONTROLS)).collect();
            // A ground plan has two directions, be it only by the ends of its racks.
            if found.len() == 1 {
                let second = |f: &Candidate| f.metres >= SECOND * strongest && f.exceeds_chance(1);
                found.extend(weak.into_iter().find(second));
            }
        }
    }
    let sum: f64 = found.iter().map(|f| f.metres).sum();
    let total = gradients.pixels.len() as f64 * frame.resolution;
    Directions {
        angles: found.iter().map(|f| tidy_angle(frame.angle_to_map(f.angle))).collect(),
        weights: found.iter().map(|f| if strongest > 0.0 { tidy(f.metres / strongest) } else { 0.0 }).collect(),
        histogram: turned(&histogram, frame),
        explained: if total > 0.0 { tidy((sum / total).min(1.0)) } else { 0.0 },
    }
}

/// A direction that may be one.
struct Candidate {
    angle: f64,
    /// Metres of structure that line up along it.
    metres: f64,
    /// What lines up beside it, least first: scattered pixels line up there as well as they do here.
    beside: [f64; CONTROLS_DEG.len()],
}

impl Candidate {
    /// Clearly more lines up here than beside; so many of the greatest controls may be other directions.
    fn exceeds_chance(&self, others: usize) -> bool {
        self.metres > CONTRAST * self.beside[self.beside.len() - 1 - others]
    }
}

/// How much lines up along the directions that are given, degrees in the map frame; each once.
fn measure(frame: &Frame, rest: &mut Oriented, angles: &[f64], parameters: &Parameters) -> Vec<Candidate> {
    let mut found: Vec<Candidate> = Vec::new();
    for angle in angles.iter().map(|a| frame.angle_to_grid(a.to_radians())) {
        if found.iter().all(|other| angle_between(other.angle, angle) > CLOSEST) {
            let lines = aligned(frame, rest, angle);
            take(rest, angle, &lines, parameters);
            found.push(Candidate { angle, metres: lines.metres, beside: Default::default() });
        }
    }
    found
}

/// Takes direction after direction out of `rest`.
fn search(frame: &Frame, rest: &mut Oriented, parameters: &Parameters) -> Vec<Candidate> {
    let separation = parameters.directions_separation_deg.to_radians();
    // What is less than this share of the strongest is of no use, unless so many directions were asked for.
    let least = if parameters.directions_count.is_some() { 0.0 } else { parameters.directions_min_weight.min(SECOND) };
    let mut strongest: f64 = 0.0;
    let mut found: Vec<Candidate> = Vec::new();
    let mut tried: Vec<f64> = Vec::new();
    while tried.len() < MOST_CANDIDATES {
        let candidates = candidates(&rest.histogram());
        let fresh = |angle: &f64| tried.iter().all(|other| angle_between(*other, *angle) >= separation / 2.0);
        let Some(start) = candidates.into_iter().find(fresh) else {
            break;
        };
        tried.push(start);
        let around = rest.along(start, (ALIGNED_DEG + SEARCH[0].0).to_radians());
        let most = around.len() as f64 * frame.resolution * std::f64::consts::SQRT_2;
        if most < least * strongest {
            continue;
        }
        let angle = sharpest(frame, rest, start, parameters);
        if found.iter().all(|other| angle_between(other.angle, angle) >= separation) {
            let lines = aligned(frame, rest, angle);
            let metres = lines.metres;
            let mut beside = [f64::INFINITY; CONTROLS_DEG.len()];
            if metres >= least * strongest {
                beside = CONTROLS_DEG.map(|turn| aligned(frame, rest, angle + turn.to_radians()).metres);
                beside.sort_by(f64::total_cmp);
            }
            strongest = strongest.max(metres);
            take(rest, angle, &lines, parameters);
            found.push(Candidate { angle, metres, beside });
        }
    }
    found
}

/// The histogram over the angle in the map frame.
fn turned(histogram: &[u64], frame: &Frame) -> Vec<f64> {
    let shift = (frame.origin[2] / PI * BINS as f64).round().rem_euclid(BINS as f64) as usize;
    (0..BINS).map(|bin| histogram[(bin + BINS - shift) % BINS] as f64).collect()
}

/// Peaks of the smoothed histogram, highest first, as angles on the grid.
fn candidates(histogram: &[u64]) -> Vec<f64> {
    let at = |bin: usize, shift: isize| histogram[(bin as isize + shift).rem_euclid(BINS as isize) as usize];
    let reach = SMOOTHING as isize;
    let smooth: Vec<u64> =
        (0..BINS).map(|bin| (-reach..=reach).map(|s| at(bin, s) * (reach + 1 - s.abs()) as u64).sum()).collect();
    let highest = smooth.iter().copied().max().unwrap_or(0);
    let mut peaks: Vec<usize> = (0..BINS)
        .filter(|&bin| {
            let value = smooth[bin];
            let lower = |s: isize| smooth[(bin as isize + s).rem_euclid(BINS as isize) as usize];
            value > 0
                && value as f64 >= LOWEST_CANDIDATE * highest as f64
                && (1..=reach).all(|s| value > lower(-s) && value >= lower(s))
        })
        .collect();
    peaks.sort_by_key(|&bin| (std::cmp::Reverse(smooth[bin]), bin));
    peaks.truncate(MOST_CANDIDATES);
    peaks.into_iter().map(|bin| undirected(((bin as f64 + 0.5) / BINS as f64 - 0.5) * PI)).collect()
}

/// The angle near `start` at which the radiogram is sharpest.
fn sharpest(frame: &Frame, rest: &Oriented, start: f64, parameters: &Parameters) -> f64 {
    let tolerance = parameters.radiograms_tolerance_deg.to_radians();
    let mut sharpness = Sharpness::new(frame, rest, &rest.along(start, tolerance));
    let mut best = start;
    for (level, (range, step)) in SEARCH.into_iter().enumerate() {
        let steps = (range / step).round() as i64;
        // A peak of the histogram may lie further off than the range: while the best is at its end, it moves on.
        for _ in 0..MOST_MOVES {
            let centre = best;
            let tried: Vec<(f64, f64)> = (-steps..=steps)
                .map(|n| centre + (n as f64 * step).to_radians())
                .map(|angle| (angle, if level == 0 { sharpness.at::<3>(angle) } else { sharpness.at::<7>(angle) }))
                .collect();
            let top = (0..tried.len()).max_by(|&a, &b| tried[a].1.total_cmp(&tried[b].1)).unwrap_or(0);
            best = tried[top].0;
            if let (Some(left), Some(right)) = (top.checked_sub(1), tried.get(top + 1)) {
                best += step.to_radians() * vertex(tried[left].1, tried[top].1, right.1);
                break;
            }
        }
    }
    undirected(settled(frame, best))
}

/// The nearest whole part of a right angle.
fn settled(frame: &Frame, angle: f64) -> f64 {
    let reach = libm::hypot(frame.width as f64, frame.height as f64) / 2.0;
    let mut part = FRAC_PI_2 / f64::from(1u32 << PARTS_BITS);
    while part / 2.0 * reach > MOST_MOVED {
        part /= 2.0;
    }
    (angle / part).round() * part
}

/// Where the parabola through three equally spaced values has its top, in steps from the middle one.
fn vertex(left: f64, middle: f64, right: f64) -> f64 {
    let bend = left - 2.0 * middle + right;
    if bend < 0.0 { (0.5 * (left - right) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

/// Structure that lines up along an angle.
struct Aligned {
    /// Metres that stand out of the background as lines.
    metres: f64,
    /// The first bin of the projection, and for each bin whether a line lies there.
    first: i64,
    on_line: Vec<bool>,
}

fn aligned(frame: &Frame, rest: &Oriented, angle: f64) -> Aligned {
    let indices = rest.along(angle, ALIGNED_DEG.to_radians());
    let (first, bins) = project(frame, angle, indices.iter().map(|&n| (rest.pixel(n), UNIT)));
    let unit = metres_per_unit(frame, angle) / frame.resolution;
    let values: Vec<f64> = bins.iter().map(|&bin| bin as f64 * unit).collect();
    let mut sums = vec![0.0];
    for value in &values {
        sums.push(sums[sums.len() - 1] + value);
    }
    let over = |from: usize, to: usize| sums[to.min(values.len())] - sums[from];
    let mut on_line = vec![false; values.len()];
    let mut metres = 0.0;
    let mut n = 1;
    while n + 1 < values.len() {
        let peak = over(n - 1, n + 2);
        let top = values[n] >= values[n - 1] && values[n] > values[n + 1];
        let (from, to) = (n.saturating_sub(BACKGROUND_PIXELS), (n + BACKGROUND_PIXELS + 1).min(values.len()));
        let around = (over(from, to) - peak) / (to - from) as f64 * 3.0;
        n += 1;
        if top && peak > SHORTEST_PIXELS && peak > 2.0 * around {
            metres += (peak - around) * frame.resolution;
            on_line[n.saturating_sub(3)..(n + 2).min(values.len())].fill(true);
            n += 1;
        }
    }
    Aligned { metres, first, on_line }
}

/// Takes out the pixels on lines.
fn take(rest: &mut Oriented, angle: f64, lines: &Aligned, parameters: &Parameters) {
    let indices = rest.along(angle, parameters.radiograms_tolerance_deg.to_radians());
    let is_on_line = |bin: i64| lines.on_line[(bin - lines.first) as usize];
    let bins = bins(angle, indices.iter().map(|&n| rest.pixel(n)));
    let gone: Vec<u32> =
        indices.iter().zip(bins).filter(|(_, bin)| is_on_line(*bin)).map(|(&index, _)| index).collect();
    rest.remove(gone.into_iter());
}
