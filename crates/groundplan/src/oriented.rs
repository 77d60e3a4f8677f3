//! II-A: edge pixels in the order of their angles, so that those along a direction lie together.

use crate::gradients::Gradients;
use crate::grid::{Frame, angle_between};
use crate::radiograms::has_direction;
use std::f64::consts::PI;

/// Bins of the histogram of oriented gradients: a quarter of a degree each.
pub(crate) const BINS: usize = 720;

/// Edge pixels sorted by the histogram's bins.
pub(crate) struct Oriented {
    /// Column and row.
    pixels: Vec<[u32; 2]>,
    angles: Vec<f32>,
    magnitudes: Vec<u8>,
    /// Where each bin begins, and where the last one ends.
    starts: Vec<usize>,
}

fn bin(angle: f32) -> usize {
    (((f64::from(angle) / PI + 0.5) * BINS as f64) as usize).min(BINS - 1)
}

impl Oriented {
    pub fn new(gradients: &Gradients) -> Self {
        let bins: Vec<u16> = gradients.angles.iter().map(|&angle| bin(angle) as u16).collect();
        let mut starts = vec![0usize; BINS + 1];
        for &bin in &bins {
            starts[usize::from(bin) + 1] += 1;
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let count = bins.len();
        let (mut pixels, mut angles, mut magnitudes) = (vec![[0; 2]; count], vec![0.0; count], vec![0; count]);
        let mut next = starts.clone();
        for (n, &bin) in bins.iter().enumerate() {
            let place = next[usize::from(bin)];
            next[usize::from(bin)] += 1;
            pixels[place] = gradients.pixels[n];
            angles[place] = gradients.angles[n];
            magnitudes[place] = gradients.magnitudes[n];
        }
        Self { pixels, angles, magnitudes, starts }
    }

    /// Summed magnitudes over the angle on the grid.
    pub fn histogram(&self) -> Vec<u64> {
        let sum = |ends: &[usize]| self.magnitudes[ends[0]..ends[1]].iter().map(|&m| u64::from(m)).sum();
        self.starts.windows(2).map(sum).collect()
    }

    pub fn pixel(&self, index: u32) -> [u32; 2] {
        self.pixels[index as usize]
    }

    /// Which pixels lie along `angle`, on the grid, within `tolerance`; specks lie along nothing.
    pub fn along(&self, angle: f64, tolerance: f64) -> Vec<u32> {
        let reach = (tolerance / PI * BINS as f64).ceil() as usize + 1;
        let middle = bin(angle as f32);
        let bins = if 2 * reach + 1 >= BINS { 0..BINS } else { middle + BINS - reach..middle + BINS + reach + 1 };
        let mut found = Vec::new();
        for bin in bins.map(|bin| bin % BINS) {
            let places = self.starts[bin]..self.starts[bin + 1];
            let all = places.clone().zip(&self.angles[places.clone()]).zip(&self.magnitudes[places]);
            found.extend(
                all.filter(|((_, along), magnitude)| {
                    has_direction(**magnitude) && angle_between(f64::from(**along), angle) <= tolerance
                })
                .map(|((n, _), _)| n as u32),
            );
        }
        found
    }

    /// Takes pixels out; their indices are those of [`Oriented::along`].
    pub fn remove(&mut self, indices: impl Iterator<Item = u32>) {
        let mut gone = vec![false; self.pixels.len()];
        indices.for_each(|index| gone[index as usize] = true);
        let mut to = 0;
        for bin in 0..BINS {
            let places = self.starts[bin]..self.starts[bin + 1];
            self.starts[bin] = to;
            for from in places.filter(|&n| !gone[n]) {
                self.pixels[to] = self.pixels[from];
                self.angles[to] = self.angles[from];
                self.magnitudes[to] = self.magnitudes[from];
                to += 1;
            }
        }
        self.starts[BINS] = to;
    }
}

/// How sharp the projection of some pixels is: the sum of the squares of its smoothed bins. It is greatest where walls
/// fall on single bins. The bins are finer than a pixel and smoothed over more than one, so that it does not matter
/// where between the bins a wall falls: else an angle slightly off, at which the walls happen to fall upon bins, would
/// look sharper than the right one.
pub(crate) struct Sharpness {
    xs: Vec<f32>,
    ys: Vec<f32>,
    size: [f64; 2],
    /// How many pixels lie between a bin and the next in the upper half, and the sum of their parts in the lower.
    bins: Vec<u64>,
    /// Sums of the sums of the bins.
    sums: Vec<u32>,
}

/// From here on a float holds whole numbers only. More than any map has bins.
const WHOLE: f32 = 8_388_608.0;
/// A pixel's weight, in whole parts.
const FRACTIONS: u32 = 16;
/// Pixels are projected so many at a time.
const CHUNK: usize = 64;

impl Sharpness {
    pub fn new(frame: &Frame, oriented: &Oriented, indices: &[u32]) -> Self {
        // Neighbours fall into one bin, and would wait for each other: every fourth part in turn.
        let quarter = indices.len().div_ceil(4);
        let order = || (0..quarter).flat_map(|n| (0..4).filter_map(move |q| indices.get(q * quarter + n)));
        let axis = |axis: usize| order().map(|&n| oriented.pixel(n)[axis] as f32 + 0.5).collect();
        Self {
            xs: axis(0),
            ys: axis(1),
            size: [frame.width as f64, frame.height as f64],
            bins: Vec::new(),
            sums: Vec::new(),
        }
    }

    /// Smoothed over `WIDTH` bins, 3 or 7: half as many bins, rounded up, to the pixel, so that pixels in a row fall on
    /// bins.
    pub fn at<const WIDTH: usize>(&mut self, angle: f64) -> f64 {
        let scale = WIDTH.div_ceil(2) as f64;
        let (nx, ny) = (-libm::sin(angle) * scale, libm::cos(angle) * scale);
        let [width, height] = self.size;
        let corners = [0.0, nx * width, ny * height, nx * width + ny * height];
        let low = corners.into_iter().fold(f64::INFINITY, f64::min).floor() - 2.0;
        let high = corners.into_iter().fold(f64::NEG_INFINITY, f64::max) + 2.0;
        // Nothing lies beyond the ends, so smoothing finds zeros there.
        let count = (high - low).ceil() as usize + 2;
        self.bins.clear();
        self.bins.resize(count + 2 * WIDTH, 0);
        let (nx, ny, low) = (nx as f32, ny as f32, (low - WIDTH as f64) as f32);
        let mut places = [0u32; CHUNK];
        for (xs, ys) in self.xs.chunks(CHUNK).zip(self.ys.chunks(CHUNK)) {
            for ((place, x), y) in places.iter_mut().zip(xs).zip(ys) {
                // Rounded: of such a float the last bits are the whole number.
                *place = ((x * nx + y * ny - low) * FRACTIONS as f32 + WHOLE).to_bits() & (WHOLE as u32 - 1);
            }
            for &place in &places[..xs.len()] {
                self.bins[(place / FRACTIONS) as usize] += 1 << u32::BITS | u64::from(place % FRACTIONS);
            }
        }
        // Each pixel is between the two nearest bins. Smoothed twice: of their sums' sums the second differences.
        self.sums.clear();
        self.sums.extend([0, 0]);
        let (mut part_before, mut sum, mut sums) = (0u32, 0u32, 0u32);
        self.sums.extend(self.bins.iter().map(|&bin| {
            let (count, part) = ((bin >> u32::BITS) as u32, bin as u32);
            sum = sum.wrapping_add(FRACTIONS * count - part + part_before);
            part_before = part;
            sums = sums.wrapping_add(sum);
            sums
        }));
        energy(&self.sums[..self.bins.len() + 2], WIDTH)
    }
}

/// The sum of the squares of the second differences over `width`.
fn energy(sums: &[u32], width: usize) -> f64 {
    let count = sums.len() - 2 * width;
    let (low, middle, high) = (&sums[..count], &sums[width..width + count], &sums[2 * width..]);
    let square = |((low, middle), high): ((&u32, &u32), &u32)| {
        let value = u64::from(high.wrapping_sub(*middle).wrapping_sub(middle.wrapping_sub(*low)));
        value * value
    };
    let all = low.chunks(CHUNK).zip(middle.chunks(CHUNK)).zip(high.chunks(CHUNK));
    all.map(|((low, middle), high)| low.iter().zip(middle).zip(high).map(square).sum::<u64>() as f64).sum()
}
