//! Spatial frequencies: the pitch at which things recur along a line, which the paper leaves as future work.
//!
//! Each place is a phase on a circle of the pitch's circumference; the length of the phases' mean is 1 when all recur
//! at that pitch and about 1 / sqrt(n) when they lie anyhow (Rayleigh).

use crate::ends::around;
use std::f64::consts::TAU;

/// What recurs at half a pitch recurs at the whole one too if it does so as well as this: then the whole is the pitch.
const AS_GOOD: f64 = 0.8;
/// Frequencies are looked at in steps of this share of what the extent of the places tells apart.
const FINE: f64 = 0.15;
/// Two places are one pitch apart at most, and this much for the map's error, metres.
const MARGIN: f64 = 0.5;

/// A recurrence: places lie at `phase` + n `pitch`, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period {
    pub pitch: f64,
    /// In [0, pitch), from the zero of the places.
    pub phase: f64,
    /// Length of the mean phase, 0 to 1.
    pub strength: f64,
}

/// The longest pitch between two that is about as strong as any, from places along a line.
pub fn find(places: &[f64], range: [f64; 2]) -> Option<Period> {
    let frequencies = frequencies(std::iter::once(places), range)?;
    let all = strengths(places, &frequencies);
    let best = all.iter().copied().fold(0.0, f64::max);
    let good = all.iter().position(|strength| *strength >= AS_GOOD * best)?;
    // Up to the top of that peak, and to it between the steps.
    let top = (good..all.len()).take_while(|&n| n == good || all[n] > all[n - 1]).last()?;
    let step = frequencies.get(1).map_or(0.0, |second| second - frequencies[0]);
    let near = (-20..=20).map(|n| measure(places, 1.0 / (frequencies[top] + f64::from(n) * step / 20.0)));
    near.max_by(|a, b| a.strength.total_cmp(&b.strength))
}

/// The frequencies that rows of places tell apart, for pitches from the longest to the shortest.
pub fn frequencies<'a>(rows: impl Iterator<Item = &'a [f64]>, [shortest, longest]: [f64; 2]) -> Option<Vec<f64>> {
    let extent = |places: &[f64]| {
        let [low, high] = around(places.iter().copied());
        high - low
    };
    let extent = rows.filter(|places| places.len() >= 2).map(extent).fold(0.0, f64::max);
    let longest = longest.min(extent + MARGIN);
    if extent <= 0.0 || longest <= shortest {
        return None;
    }
    let step = FINE / extent;
    let (first, last) = (1.0 / longest, 1.0 / shortest);
    Some((0..=((last - first) / step).ceil() as usize).map(|n| first + n as f64 * step).collect())
}

/// How well places recur at each of some frequencies, which are equally far apart: a place turns by as much from each
/// to the next.
pub fn strengths(places: &[f64], frequencies: &[f64]) -> Vec<f64> {
    let &[first, ref rest @ ..] = frequencies else { return Vec::new() };
    let step = rest.first().map_or(0.0, |second| second - first);
    let mut sums = vec![[0.0; 2]; frequencies.len()];
    for place in places {
        let (mut at, by) = (turned(place * first), turned(place * step));
        for sum in &mut sums {
            *sum = [sum[0] + at[0], sum[1] + at[1]];
            at = times(at, by);
        }
    }
    sums.into_iter().map(|[cos, sin]| libm::hypot(sin, cos) / places.len().max(1) as f64).collect()
}

/// The squared strengths at a pitch and its harmonics, so many together.
pub fn power(places: &[f64], pitch: f64, harmonics: usize) -> f64 {
    let mut sums = vec![[0.0; 2]; harmonics];
    for place in places {
        let by = turned(place / pitch);
        let mut at = by;
        for sum in &mut sums {
            *sum = [sum[0] + at[0], sum[1] + at[1]];
            at = times(at, by);
        }
    }
    let squared = |[cos, sin]: [f64; 2]| cos * cos + sin * sin;
    sums.into_iter().map(squared).sum::<f64>() / (places.len().max(1) as f64).powi(2)
}

/// Cosine and sine of so many turns.
fn turned(turns: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(TAU * (turns - turns.floor()));
    [cos, sin]
}

/// One turn after another.
fn times([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a * c - b * d, a * d + b * c]
}

/// How well places recur at a pitch.
pub fn measure(places: &[f64], pitch: f64) -> Period {
    let [cos, sin] = places.iter().fold([0.0; 2], |[cos, sin], place| {
        let [c, s] = turned(place / pitch);
        [cos + c, sin + s]
    });
    let turn = libm::atan2(sin, cos) / TAU;
    let strength = libm::hypot(sin, cos) / places.len().max(1) as f64;
    Period { pitch, phase: (turn - turn.floor()) * pitch, strength }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn posts_with_two_missing_have_the_pitch_of_all() {
        let posts: Vec<f64> = [0, 1, 3, 4, 5, 8].iter().map(|n| 1.3 + 2.7 * f64::from(*n)).collect();
        let found = find(&posts, [1.0, 6.5]).unwrap();
        assert!((found.pitch - 2.7).abs() < 0.01, "{found:?}");
        assert!((found.phase - 1.3).abs() < 0.05 && found.strength > 0.99, "{found:?}");
    }

    #[test]
    fn what_lies_anyhow_hardly_recurs() {
        let places: Vec<f64> = (0..40).map(|n| f64::from(n * n % 41) * 0.73 + f64::from(n % 7) * 0.11).collect();
        assert!(find(&places, [2.0, 6.0]).unwrap().strength < 0.6);
    }
}
