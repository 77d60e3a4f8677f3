//! II-A: edge pixels by their angles, so that those along a direction are found.
//!
//! Where they are few they are put in the order of their angles, and those along a direction lie together. Many are
//! looked through where they lie: that takes longer, but no room.

use crate::bits::Bits;
use crate::gradients::Gradients;
use crate::grid::angle_between;
use crate::projection::Points;
use crate::radiograms::has_direction;
use std::f64::consts::PI;
use std::ops::Range;

/// Bins of the histogram of oriented gradients: a quarter of a degree each.
pub(crate) const BINS: usize = 720;
/// More edge pixels than this are many.
const MANY: usize = 1 << 23;
/// So many are handed on at a time.
const TOGETHER: usize = 1 << 10;

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

/// Sorted by the histogram's bins.
#[derive(Default)]
struct Sorted {
    /// Column and row.
    pixels: Vec<[u32; 2]>,
    angles: Vec<f32>,
    magnitudes: Vec<u8>,
}

fn bin(angle: f32) -> usize {
    (((f64::from(angle) / PI + 0.5) * BINS as f64) as usize).min(BINS - 1)
}

/// Where each bin begins, and where the last one ends.
fn starts(counts: &[usize]) -> Vec<usize> {
    let mut sum = 0;
    let ends = counts.iter().map(|count| {
        sum += count;
        sum
    });
    std::iter::once(0).chain(ends).collect()
}

/// The bins that hold all within `tolerance` of `angle`, on the grid, and whether they hold nothing else.
fn bins(angle: f64, tolerance: f64) -> impl Iterator<Item = (usize, bool)> {
    let reach = (tolerance / PI * BINS as f64).ceil() as usize + 1;
    let middle = bin(angle as f32);
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
        let mut histogram = vec![0u64; BINS];
        let mut counts = vec![0usize; BINS];
        for (&angle, &magnitude) in gradients.angles.iter().zip(&gradients.magnitudes) {
            let bin = bin(angle);
            histogram[bin] += u64::from(magnitude);
            counts[bin] += usize::from(has_direction(magnitude));
        }
        let held = if many {
            Held::Whole(gradients, Bits::new(gradients.pixels.len()))
        } else {
            Held::Sorted(Sorted::new(gradients, &counts))
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
        let mut found = Points::with_capacity(self.at_most_along(angle, tolerance));
        match &self.held {
            Held::Sorted(sorted) => {
                sorted.visit(&self.counts, angle, tolerance, |places| found.extend(&sorted.pixels[places]));
            }
            Held::Whole(all, gone) => {
                let mut some = Vec::with_capacity(TOGETHER);
                let is_along = is_along(angle, tolerance);
                all.iter().enumerate().for_each(|(n, (pixel, along, magnitude))| {
                    if is_along(along, magnitude) && !gone.get(n) {
                        some.push(pixel);
                        if some.len() == TOGETHER {
                            found.extend(&some);
                            some.clear();
                        }
                    }
                });
                found.extend(&some);
            }
        }
        found
    }

    /// Takes out those of the pixels along `angle`, on the grid, within `tolerance`, that are to go.
    pub fn remove(&mut self, angle: f64, tolerance: f64, goes: impl Fn([u32; 2]) -> bool) {
        let Self { counts, histogram, held } = self;
        match held {
            Held::Sorted(sorted) => {
                let mut gone = vec![false; sorted.pixels.len()];
                sorted.visit(counts, angle, tolerance, |places| {
                    gone[places.clone()]
                        .iter_mut()
                        .zip(&sorted.pixels[places])
                        .for_each(|(to, &pixel)| *to = goes(pixel));
                });
                sorted.drop(&gone, counts, histogram);
            }
            Held::Whole(all, gone) => {
                let is_along = is_along(angle, tolerance);
                all.iter().enumerate().for_each(|(n, (pixel, along, magnitude))| {
                    if is_along(along, magnitude) && !gone.get(n) && goes(pixel) {
                        gone.insert(n);
                        counts[bin(along)] -= 1;
                        histogram[bin(along)] -= u64::from(magnitude);
                    }
                });
            }
        }
    }
}

/// True of what has a direction and lies along `angle`, on the grid, within `tolerance`.
fn is_along(angle: f64, tolerance: f64) -> impl Fn(f32, u8) -> bool {
    move |along, magnitude| has_direction(magnitude) && angle_between(f64::from(along), angle) <= tolerance
}

impl Sorted {
    fn new(gradients: &Gradients, counts: &[usize]) -> Self {
        let mut next = starts(counts);
        let count = next[BINS];
        let mut made = Self { pixels: vec![[0; 2]; count], angles: vec![0.0; count], magnitudes: vec![0; count] };
        gradients.iter().filter(|(_, _, magnitude)| has_direction(*magnitude)).for_each(|(pixel, angle, magnitude)| {
            let next = &mut next[bin(angle)];
            made.pixels[*next] = pixel;
            made.angles[*next] = angle;
            made.magnitudes[*next] = magnitude;
            *next += 1;
        });
        made
    }

    /// Calls `visit` with the places of the pixels that lie along `angle`, on the grid, within `tolerance`.
    fn visit(&self, counts: &[usize], angle: f64, tolerance: f64, mut visit: impl FnMut(Range<usize>)) {
        let starts = starts(counts);
        for (bin, whole) in bins(angle, tolerance) {
            let places = starts[bin]..starts[bin + 1];
            if whole {
                visit(places);
            } else {
                let near = |n: &usize| angle_between(f64::from(self.angles[*n]), angle) <= tolerance;
                places.filter(near).for_each(|n| visit(n..n + 1));
            }
        }
    }

    /// Without those that are gone.
    fn drop(&mut self, gone: &[bool], counts: &mut [usize], histogram: &mut [u64]) {
        let mut to = 0;
        let mut from = 0;
        for (count, sum) in counts.iter_mut().zip(histogram) {
            let places = from..from + *count;
            from = places.end;
            for place in places {
                if gone[place] {
                    *count -= 1;
                    *sum -= u64::from(self.magnitudes[place]);
                    continue;
                }
                self.pixels[to] = self.pixels[place];
                self.angles[to] = self.angles[place];
                self.magnitudes[to] = self.magnitudes[place];
                to += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_are_found_and_taken_out_as_few_are() {
        let mut all = Gradients::default();
        for n in 0..20_000u32 {
            all.pixels.push([n * 7919 % 70_001, n / 100]);
            all.angles.push(((f64::from(n) * 0.618_034).fract() * PI - PI / 2.0) as f32);
            all.magnitudes.push((n * 31 % 256) as u8);
        }
        let (mut few, mut many) = (Oriented::of(&all, false), Oriented::of(&all, true));
        for (angle, tolerance) in [(0.3, 0.08), (-1.56, 0.1), (0.3, 0.1), (1.0, 2.0)] {
            let [one, other] = [&few, &many].map(|of| of.along(angle, tolerance));
            assert_eq!(one.len(), other.len());
            assert!(one.len() > 100);
            let across = one.across(angle, 1, 1);
            let [mut sums, mut others] = [Vec::new(), Vec::new()];
            one.sums(&across, &mut sums, 1);
            other.sums(&across, &mut others, 1);
            assert_eq!(sums, others);
            let goes = |[x, y]: [u32; 2]| (x + y) % 3 != 0;
            few.remove(angle, tolerance, goes);
            many.remove(angle, tolerance, goes);
            assert_eq!((&few.counts, &few.histogram), (&many.counts, &many.histogram));
            assert!(few.along(angle, tolerance).len() < one.len());
        }
    }
}
