//! II-A: edge pixels by their angles, so that those along a direction are found.
//!
//! Where they are few they are put in the order of their angles, and those along a direction lie together. Many are
//! looked through where they lie: that takes longer, but no room.

use crate::bits::Bits;
use crate::gradients::Gradients;
use crate::grid::{angle_between, undirected};
use crate::projection::Points;
use crate::radiograms::has_direction;
use std::f64::consts::PI;
use std::ops::Range;

/// Bins of the histogram of oriented gradients: a quarter of a degree each.
pub(crate) const BINS: usize = 720;
/// More edge pixels than this are many.
const MANY: usize = 1 << 23;
/// So many are looked at together.
const TOGETHER: usize = 1 << 8;
/// From here on a float holds whole numbers only.
const WHOLE: f64 = 4_503_599_627_370_496.0;
/// So many pixels one after another are counted apart.
const TURNS: usize = 2;

/// Edge pixels that have a direction.
pub(crate) struct Oriented<'a> {
    /// How many there are in each bin.
    counts: Vec<usize>,
    /// Summed magnitudes over the angle on the grid; specks count there too, as long as the others last.
    histogram: Vec<u64>,
    held: Held<'a>,
}

enum Held<'a> {
    Sorted(Sorted),
    /// All edge pixels, and which of them are gone.
    Whole(&'a Gradients, Bits),
}

/// Sorted by the histogram's bins: in each as many as are counted, and behind them the room of those that are gone.
#[derive(Default)]
struct Sorted {
    /// Where each bin begins.
    starts: Vec<usize>,
    /// The pixels' centres.
    xs: Vec<f32>,
    ys: Vec<f32>,
    angles: Vec<f32>,
    magnitudes: Vec<u8>,
}

fn bin(angle: f32) -> usize {
    (((f64::from(angle) / PI + 0.5) * BINS as f64) as usize).min(BINS - 1)
}

/// The same of some, side by side.
fn bins_of(angles: &[f32], bins: &mut [u16; TOGETHER]) {
    for (to, &angle) in bins.iter_mut().zip(angles) {
        let place = ((f64::from(angle) / PI + 0.5) * BINS as f64).clamp(0.0, BINS as f64);
        // Rounded: of such a float the last bits are the whole number.
        let near = place + WHOLE;
        let above = if near - WHOLE > place { 1.0 } else { 0.0 };
        *to = ((near - above).to_bits() as u16).min(BINS as u16 - 1);
    }
}

/// The bins that hold all within `tolerance` of `angle`, on the grid, and whether they hold nothing else.
fn bins(angle: f64, tolerance: f64) -> impl Iterator<Item = (usize, bool)> {
    let reach = (tolerance / PI * BINS as f64).ceil() as usize + 1;
    let middle = bin(undirected(angle) as f32);
    let all = 2 * reach + 1 >= BINS;
    let bins = if all { 0..BINS } else { middle + BINS - reach..middle + BINS + reach + 1 };
    let (first, last) = (bins.start + 3, bins.end - 3);
    bins.map(move |n| (n % BINS, !all && (first..last).contains(&n)))
}

impl<'a> Oriented<'a> {
    pub fn new(gradients: &'a Gradients) -> Self {
        Self::of(gradients, gradients.pixels.len() > MANY)
    }

    fn of(gradients: &'a Gradients, many: bool) -> Self {
        // Neighbours are often of one bin, and would wait for each other: they are counted in turns.
        let mut turns = vec![[[0u64; 2]; TURNS]; BINS];
        let mut bins = Vec::with_capacity(if many { 0 } else { gradients.pixels.len() });
        let mut some = [0; TOGETHER];
        for (angles, magnitudes) in gradients.angles.chunks(TOGETHER).zip(gradients.magnitudes.chunks(TOGETHER)) {
            bins_of(angles, &mut some);
            for (bins, magnitudes) in some.chunks(TURNS).zip(magnitudes.chunks(TURNS)) {
                for (turn, (&bin, &magnitude)) in bins.iter().zip(magnitudes).enumerate() {
                    let [count, sum] = &mut turns[usize::from(bin)][turn];
                    *count += u64::from(has_direction(magnitude));
                    *sum += u64::from(magnitude);
                }
            }
            if !many {
                bins.extend_from_slice(&some[..angles.len()]);
            }
        }
        let counts: Vec<usize> =
            turns.iter().map(|turns| turns.iter().map(|[count, _]| *count as usize).sum()).collect();
        let histogram = turns.iter().map(|turns| turns.iter().map(|[_, sum]| sum).sum()).collect();
        let held = if many {
            Held::Whole(gradients, Bits::new(gradients.pixels.len()))
        } else {
            Held::Sorted(Sorted::new(gradients, &bins, &counts))
        };
        Self { counts, histogram, held }
    }

    /// Summed magnitudes over the angle on the grid.
    pub fn histogram(&self) -> &[u64] {
        &self.histogram
    }

    /// No fewer than lie along `angle` within `tolerance`.
    pub fn at_most_along(&self, angle: f64, tolerance: f64) -> usize {
        bins(angle, tolerance).map(|(bin, _)| self.counts[bin]).sum()
    }

    /// The pixels that lie along `angle`, on the grid, within `tolerance`.
    pub fn along(&self, angle: f64, tolerance: f64) -> Points {
        let room = self.at_most_along(angle, tolerance);
        let (mut xs, mut ys) = (Vec::with_capacity(room), Vec::with_capacity(room));
        match &self.held {
            Held::Sorted(sorted) => {
                for (bin, whole) in bins(angle, tolerance) {
                    let places = sorted.places(bin, &self.counts);
                    if whole {
                        xs.extend_from_slice(&sorted.xs[places.clone()]);
                        ys.extend_from_slice(&sorted.ys[places]);
                        continue;
                    }
                    for n in places.filter(|&n| sorted.is_near(n, angle, tolerance)) {
                        xs.push(sorted.xs[n]);
                        ys.push(sorted.ys[n]);
                    }
                }
            }
            Held::Whole(all, gone) => {
                let is_along = is_along(angle, tolerance);
                all.iter().enumerate().for_each(|(n, (pixel, along, magnitude))| {
                    if is_along(along, magnitude) && !gone.get(n) {
                        let [x, y] = centre(pixel);
                        xs.push(x);
                        ys.push(y);
                    }
                });
            }
        }
        Points::new(xs, ys)
    }

    /// Takes out those of the pixels along `angle`, on the grid, within `tolerance`, whose centres are such as are to go.
    pub fn remove(&mut self, angle: f64, tolerance: f64, goes: impl Fn([f32; 2]) -> bool) {
        let Self { counts, histogram, held } = self;
        match held {
            Held::Sorted(sorted) => {
                for (bin, whole) in bins(angle, tolerance) {
                    let places = sorted.places(bin, counts);
                    let first = places.start;
                    let mut to = first;
                    for n in places {
                        sorted.xs[to] = sorted.xs[n];
                        sorted.ys[to] = sorted.ys[n];
                        sorted.angles[to] = sorted.angles[n];
                        sorted.magnitudes[to] = sorted.magnitudes[n];
                        let near = whole || sorted.is_near(to, angle, tolerance);
                        if near && goes([sorted.xs[to], sorted.ys[to]]) {
                            histogram[bin] -= u64::from(sorted.magnitudes[to]);
                        } else {
                            to += 1;
                        }
                    }
                    counts[bin] = to - first;
                }
            }
            Held::Whole(all, gone) => {
                let is_along = is_along(angle, tolerance);
                all.iter().enumerate().for_each(|(n, (pixel, along, magnitude))| {
                    if is_along(along, magnitude) && !gone.get(n) && goes(centre(pixel)) {
                        gone.insert(n);
                        counts[bin(along)] -= 1;
                        histogram[bin(along)] -= u64::from(magnitude);
                    }
                });
            }
        }
    }
}

fn centre(pixel: [u32; 2]) -> [f32; 2] {
    pixel.map(|place| place as f32 + 0.5)
}

/// True of what has a direction and lies along `angle`, on the grid, within `tolerance`.
fn is_along(angle: f64, tolerance: f64) -> impl Fn(f32, u8) -> bool {
    move |along, magnitude| has_direction(magnitude) && angle_between(f64::from(along), angle) <= tolerance
}

impl Sorted {
    fn new(gradients: &Gradients, bins: &[u16], counts: &[usize]) -> Self {
        let mut count = 0;
        let mut start = |own: &usize| {
            count += own;
            count - own
        };
        let starts: Vec<usize> = counts.iter().map(&mut start).collect();
        let mut next = starts.clone();
        let none = || vec![0.0; count];
        let mut made = Self { starts, xs: none(), ys: none(), angles: none(), magnitudes: vec![0; count] };
        gradients.iter().zip(bins).for_each(|((pixel, angle, magnitude), &bin)| {
            if has_direction(magnitude) {
                let next = &mut next[usize::from(bin)];
                [made.xs[*next], made.ys[*next]] = centre(pixel);
                made.angles[*next] = angle;
                made.magnitudes[*next] = magnitude;
                *next += 1;
            }
        });
        made
    }

    fn places(&self, bin: usize, counts: &[usize]) -> Range<usize> {
        self.starts[bin]..self.starts[bin] + counts[bin]
    }

    fn is_near(&self, n: usize, angle: f64, tolerance: f64) -> bool {
        angle_between(f64::from(self.angles[n]), angle) <= tolerance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::projection::Sum;

    #[test]
    fn angles_side_by_side_fall_into_the_bins_that_each_falls_into() {
        let ends = [-PI as f32 / 2.0, PI as f32 / 2.0, -9.0, 9.0, 0.0];
        let all = (0..TOGETHER).map(|n| ((n as f32 / TOGETHER as f32) - 0.5) * PI as f32);
        let angles: Vec<f32> = ends.into_iter().chain(all).collect();
        for angles in angles.chunks(TOGETHER) {
            let mut bins = [0; TOGETHER];
            bins_of(angles, &mut bins);
            assert!(angles.iter().zip(bins).all(|(&angle, found)| bin(angle) == usize::from(found)));
        }
    }

    #[test]
    fn many_are_found_and_taken_out_as_few_are() {
        let mut all = Gradients::default();
        for n in 0..20_000u32 {
            all.pixels.push([n * 7919 % 70_001, n / 100]);
            all.angles.push(((f64::from(n) * 0.618_034).fract() * PI - PI / 2.0) as f32);
            all.magnitudes.push((n * 31 % 256) as u8);
        }
        let (mut few, mut many) = (Oriented::of(&all, false), Oriented::of(&all, true));
        for (angle, tolerance) in [(0.3, 0.08), (-1.56, 0.1), (1.75, 0.1), (0.3, 0.1), (1.0, 2.0)] {
            let [one, other] = [&few, &many].map(|of| of.along(angle, tolerance));
            assert_eq!(one.len(), other.len());
            assert!(one.len() > 100);
            let across = one.across(angle, 1, 1);
            let (mut sums, mut others) = (Vec::<u32>::new(), Vec::<u64>::new());
            one.sums(&across, &mut sums, 1);
            other.sums(&across, &mut others, 1);
            assert!(
                sums.iter().map(|sum| (sum.count(), sum.parts())).eq(others.iter().map(|s| (s.count(), s.parts())))
            );
            let goes = |[x, y]: [f32; 2]| (x + y) as u32 % 3 != 0;
            few.remove(angle, tolerance, goes);
            many.remove(angle, tolerance, goes);
            assert_eq!((&few.counts, &few.histogram), (&many.counts, &many.histogram));
            assert!(few.along(angle, tolerance).len() < one.len());
        }
    }
}
