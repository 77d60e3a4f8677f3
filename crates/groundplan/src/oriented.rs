//! II-A: edge pixels in the order of their angles, so that those along a direction lie together.

use crate::gradients::Gradients;
use crate::grid::angle_between;
use crate::radiograms::has_direction;
use std::f64::consts::PI;
use std::ops::Range;

/// Bins of the histogram of oriented gradients: a quarter of a degree each.
pub(crate) const BINS: usize = 720;

/// Edge pixels that have a direction, sorted by the histogram's bins.
pub(crate) struct Oriented {
    /// Column and row.
    pixels: Vec<[u32; 2]>,
    angles: Vec<f32>,
    magnitudes: Vec<u8>,
    /// Where each bin begins, and where the last one ends.
    starts: Vec<usize>,
    /// Summed magnitudes over the angle on the grid; specks count there too, as long as the others last.
    histogram: Vec<u64>,
}

fn bin(angle: f32) -> usize {
    (((f64::from(angle) / PI + 0.5) * BINS as f64) as usize).min(BINS - 1)
}

impl Oriented {
    pub fn new(gradients: &Gradients) -> Self {
        let mut histogram = vec![0u64; BINS];
        let mut starts = vec![0usize; BINS + 1];
        let bins: Vec<u16> = gradients.angles.iter().map(|&angle| bin(angle) as u16).collect();
        for (&bin, &magnitude) in bins.iter().zip(&gradients.magnitudes) {
            histogram[usize::from(bin)] += u64::from(magnitude);
            starts[usize::from(bin) + 1] += usize::from(has_direction(magnitude));
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let count = starts[BINS];
        let (mut pixels, mut angles, mut magnitudes) = (vec![[0; 2]; count], vec![0.0; count], vec![0; count]);
        let mut next = starts.clone();
        for (n, (&bin, &magnitude)) in bins.iter().zip(&gradients.magnitudes).enumerate() {
            if has_direction(magnitude) {
                let place = next[usize::from(bin)];
                next[usize::from(bin)] += 1;
                pixels[place] = gradients.pixels[n];
                angles[place] = gradients.angles[n];
                magnitudes[place] = magnitude;
            }
        }
        Self { pixels, angles, magnitudes, starts, histogram }
    }

    /// Summed magnitudes over the angle on the grid.
    pub fn histogram(&self) -> &[u64] {
        &self.histogram
    }

    /// The bins that hold all within `tolerance` of `angle`, on the grid: the two at their ends hold others too.
    fn bins(angle: f64, tolerance: f64) -> impl Iterator<Item = (usize, bool)> {
        let reach = (tolerance / PI * BINS as f64).ceil() as usize + 1;
        let middle = bin(angle as f32);
        let all = 2 * reach + 1 >= BINS;
        let bins = if all { 0..BINS } else { middle + BINS - reach..middle + BINS + reach + 1 };
        let (first, last) = (bins.start + 3, bins.end - 3);
        bins.map(move |n| (n % BINS, !all && (first..last).contains(&n)))
    }

    /// No fewer than lie along `angle` within `tolerance`.
    pub fn at_most_along(&self, angle: f64, tolerance: f64) -> usize {
        Self::bins(angle, tolerance).map(|(bin, _)| self.starts[bin + 1] - self.starts[bin]).sum()
    }

    /// Calls `visit` with the indices of the pixels that lie along `angle`, on the grid, within `tolerance`.
    fn visit_along(&self, angle: f64, tolerance: f64, mut visit: impl FnMut(Range<usize>)) {
        for (bin, whole) in Self::bins(angle, tolerance) {
            let places = self.starts[bin]..self.starts[bin + 1];
            if whole {
                visit(places);
            } else {
                let near = |n: &usize| angle_between(f64::from(self.angles[*n]), angle) <= tolerance;
                places.filter(near).for_each(|n| visit(n..n + 1));
            }
        }
    }

    /// The pixels that lie along `angle`, on the grid, within `tolerance`.
    pub fn along(&self, angle: f64, tolerance: f64) -> Vec<[u32; 2]> {
        let mut found = Vec::with_capacity(self.at_most_along(angle, tolerance));
        self.visit_along(angle, tolerance, |places| found.extend_from_slice(&self.pixels[places]));
        found
    }

    /// Takes out those of the pixels along `angle`, in the order of [`Oriented::along`], that are `gone`.
    pub fn remove(&mut self, angle: f64, tolerance: f64, gone: &[bool]) {
        let mut is_gone = vec![false; self.pixels.len()];
        let mut gone = gone.iter();
        self.visit_along(angle, tolerance, |places| {
            is_gone[places].iter_mut().zip(&mut gone).for_each(|(to, from)| *to = *from);
        });
        let mut to = 0;
        for bin in 0..BINS {
            let places = self.starts[bin]..self.starts[bin + 1];
            self.starts[bin] = to;
            for from in places {
                if is_gone[from] {
                    self.histogram[bin] -= u64::from(self.magnitudes[from]);
                    continue;
                }
                self.pixels[to] = self.pixels[from];
                self.angles[to] = self.angles[from];
                self.magnitudes[to] = self.magnitudes[from];
                to += 1;
            }
        }
        self.starts[BINS] = to;
    }
}
