//! II-A: the angle at which the projection of some pixels is sharpest.

use crate::projection::{Points, Sum};
use std::borrow::Cow;

/// How sharp the projection of some pixels is: the sum of the squares of its smoothed bins, or of a lower power. It is
/// greatest where walls fall on single bins. The bins are finer than a pixel and smoothed over one or more, so that it
/// does not matter where between the bins a wall falls: else an angle slightly off, at which the walls happen to fall
/// upon bins, would look sharper than the right one.
pub(crate) struct Sharpness<'a> {
    points: &'a Points,
    narrow: bool,
    small: Vec<u32>,
    large: Vec<u64>,
    threads: usize,
}

/// The widest smoothing, bins.
const WIDEST: usize = 8;
/// Bins are smoothed so many at a time.
const CHUNK: usize = 128;
/// Powers are added up in so many sums, which do not wait for one another.
const LANES: usize = 8;
type Bins = [u32; CHUNK];

impl<'a> Sharpness<'a> {
    pub fn new(points: &'a Points, threads: usize) -> Self {
        Self { points, narrow: points.are_narrow(), small: Vec::new(), large: Vec::new(), threads }
    }

    /// Of few bins and smoothed little: a few short lines show among much else.
    pub fn roughly_at(&mut self, angle: f64) -> f64 {
        self.over::<2, 2>(angle, squares)
    }

    /// Of many bins and smoothed more: so the angle is the more exact.
    fn at(&mut self, angle: f64) -> f64 {
        self.over::<4, 8>(angle, squares)
    }

    /// Of many bins, smoothed over a pixel, so that walls of two halls that are a little apart are not one where the angle
    /// is slightly off; and of a power at which each wall has its say, not the longest alone.
    pub fn finely_at(&mut self, angle: f64) -> f64 {
        self.over::<4, 4>(angle, powers)
    }

    /// With so many bins to the pixel, on which pixels in a row fall, and smoothed twice over some; the sum of something of
    /// the bins.
    fn over<const PER_PIXEL: usize, const WIDTH: usize>(&mut self, angle: f64, of: impl Fn(&Bins) -> f64) -> f64 {
        // So much is free at both ends that smoothing finds zeros there, and whole chunks beyond.
        let across = self.points.across(angle, PER_PIXEL, 2 * WIDTH);
        if self.narrow {
            self.points.sums(&across, &mut self.small, self.threads);
            summed::<u32, WIDTH>(&mut self.small, of)
        } else {
            self.points.sums(&across, &mut self.large, self.threads);
            summed::<u64, WIDTH>(&mut self.large, of)
        }
    }
}

/// The sum of something of the bins, given what lies between them, smoothed twice over so many.
fn summed<T: Sum, const WIDTH: usize>(sums: &mut Vec<T>, of: impl Fn(&Bins) -> f64) -> f64 {
    sums.resize(sums.len().next_multiple_of(CHUNK) + 2 * WIDTH, T::default());
    let chunks = sums.windows(CHUNK + 2 * WIDTH - 1).step_by(CHUNK);
    chunks.map(|sums| of(&smoothed::<T, WIDTH>(sums))).sum()
}

fn squares(bins: &Bins) -> f64 {
    bins.iter().map(|&v| u64::from(v).pow(2)).sum::<u64>() as f64
}

/// The sum of the powers of 3/2.
fn powers(bins: &Bins) -> f64 {
    let mut sums = [0.0; LANES];
    for part in bins.chunks_exact(LANES) {
        let powers: [f32; LANES] = std::array::from_fn(|n| part[n] as f32 * (part[n] as f32).sqrt());
        sums.iter_mut().zip(powers).for_each(|(sum, power)| *sum += f64::from(power));
    }
    sums.iter().sum()
}

/// A chunk of bins, given what lies between them, smoothed twice over so many.
fn smoothed<T: Sum, const WIDTH: usize>(sums: &[T]) -> Bins {
    let mut bins = [0u32; CHUNK + 2 * WIDEST];
    for (to, pair) in bins.iter_mut().zip(sums.windows(2)) {
        *to = T::on_bin(pair[0], pair[1]);
    }
    // Sums over two twice over, of them over two, and so on.
    let mut width = 1;
    while width < WIDTH {
        for n in 0..CHUNK + 2 * (WIDTH - 2 * width) {
            bins[n] = bins[n].wrapping_add(bins[n + width] << 1).wrapping_add(bins[n + 2 * width]);
        }
        width *= 2;
    }
    std::array::from_fn(|n| bins[n])
}

/// The search begins so far to both sides and with such steps, degrees.
pub(crate) const SCAN_DEG: f64 = 3.0;
const STEP_DEG: f64 = 0.5;
/// While the best is at the end of what was looked at it goes on, by so many steps at most.
const FURTHER: i32 = 6;
/// What is looked for is known so well that what is furthest away moves by no more than so many pixels, before it is asked whether
/// it is worth more: a line that is spread over more than that may not stand out of its background (`aligned.rs`).
const KNOWN_PIXELS: f64 = 10.0;
/// So many pixels say where the sharpest is; how sharp it is there takes all.
const SAMPLE: usize = 4096;
/// Steps get smaller until what is furthest away moves by no more than so many pixels.
const FINEST_PIXELS: f64 = 0.1;
/// How often a step is taken again, at most.
const MOVES: usize = 4;

/// The angle near `start` at which the projection of pixels is sharpest, on a map of so many pixels from corner to
/// corner; none where it is not `worth` the search, which is asked when the angle is known to half a degree, and better on a
/// map that is large.
///
/// What lines up over a length of l pixels is spread over l sin(a) bins at an angle a beside its own, so sharpness falls
/// off as 1 / a, and halved steps climb to its top.
pub(crate) fn sharpest(
    pixels: &Points,
    start: f64,
    diagonal: f64,
    threads: usize,
    worth: impl Fn(f64) -> bool,
) -> Option<f64> {
    let sample = sample(pixels, SAMPLE);
    let mut some = Sharpness::new(&sample, threads);
    let mut best = scan(start, |angle| some.roughly_at(angle));
    let mut step = STEP_DEG.to_radians() / 2.0;
    best.climb(step, |angle| some.roughly_at(angle));
    // The search goes on from where it was: by finer steps a sample would lead it by its own pixels.
    let (mut known, mut finer) = (best, step);
    while finer / 2.0 * diagonal > KNOWN_PIXELS {
        finer /= 2.0;
        known.climb(finer, |angle| some.roughly_at(angle));
    }
    if !worth(known.angle) {
        return None;
    }
    best.value = some.at(best.angle);
    step /= 2.0;
    let mut top = best.climb(step, |angle| some.at(angle));
    let mut all = Sharpness::new(pixels, threads);
    best = Best { angle: top, value: all.finely_at(top) };
    while step > FINEST_PIXELS / diagonal {
        step /= 4.0;
        top = best.climb(step, |angle| all.finely_at(angle));
    }
    Some(top)
}

/// The sharpest of angles around `start`.
fn scan(start: f64, mut sharpness: impl FnMut(f64) -> f64) -> Best {
    let angle = |n: i32| start + (f64::from(n) * STEP_DEG).to_radians();
    let mut best = Best { angle: start, value: f64::NEG_INFINITY };
    let mut look = |n: i32, best: &mut Best| {
        let value = sharpness(angle(n));
        if value > best.value {
            *best = Best { angle: angle(n), value };
        }
    };
    let steps = (SCAN_DEG / STEP_DEG).round() as i32;
    (-steps..=steps).for_each(|n| look(n, &mut best));
    for side in [-1, 1] {
        let mut n = steps;
        while n < steps + FURTHER && best.angle == angle(side * n) {
            n += 1;
            look(side * n, &mut best);
        }
    }
    best
}

/// The sharpest so far.
#[derive(Clone, Copy)]
struct Best {
    angle: f64,
    value: f64,
}

impl Best {
    /// Goes on by steps to the side as long as that is better; where the parabola through the last three has its top.
    fn climb(&mut self, step: f64, mut sharpness: impl FnMut(f64) -> f64) -> f64 {
        let (mut left, mut right) = (sharpness(self.angle - step), sharpness(self.angle + step));
        for _ in 0..MOVES {
            if left.max(right) <= self.value {
                break;
            }
            if left > right {
                (right, *self) = (self.value, Self { angle: self.angle - step, value: left });
                left = sharpness(self.angle - step);
            } else {
                (left, *self) = (self.value, Self { angle: self.angle + step, value: right });
                right = sharpness(self.angle + step);
            }
        }
        self.angle + step * parabola(left, self.value, right)
    }
}

/// Where the parabola through three values a step apart has its top, steps from the middle one; no more than half of one.
pub(crate) fn parabola(left: f64, middle: f64, right: f64) -> f64 {
    let bend = left - 2.0 * middle + right;
    if bend < 0.0 { (0.5 * (left - right) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

/// About so many of the pixels, by where they are: what changes elsewhere changes nothing of it.
pub(crate) fn sample(pixels: &Points, count: usize) -> Cow<'_, Points> {
    let share = (pixels.len() / count + 1).ilog2();
    let hash = |[x, y]: [u32; 2]| (x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77)).wrapping_mul(0xC2B2_AE3D);
    if share == 0 {
        return Cow::Borrowed(pixels);
    }
    Cow::Owned(pixels.only(|pixel| u64::from(hash(pixel)) << share >> u32::BITS == 0))
}
