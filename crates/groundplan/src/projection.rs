//! II-A: pixels projected across many angles, one after another.

use crate::bands::fold;

/// A pixel's weight, in whole parts.
pub(crate) const FRACTIONS: u32 = 16;
/// From here on a float holds whole numbers only. More than any map has bins.
const WHOLE: f32 = 8_388_608.0;
/// Pixels are projected so many at a time.
const CHUNK: usize = 16;
/// So many pixels are worth a thread's while.
pub(crate) const SHARE: usize = 1 << 16;

/// Where some pixels are, to be projected.
pub(crate) struct Points {
    xs: Vec<f32>,
    ys: Vec<f32>,
    /// What all of them lie within: from, to, along x and y.
    within: [[f64; 2]; 2],
}

/// How pixels fall on bins across an angle.
#[derive(Clone, Copy)]
pub(crate) struct Across {
    /// Parts of bins to the pixel, along x and y.
    normal: [f32; 2],
    /// Parts of bins from the first one's middle.
    shift: f32,
    /// How many there are.
    pub count: usize,
}

impl Across {
    /// Which bin each pixel lies in, in parts.
    fn places(&self, xs: &[f32], ys: &[f32], places: &mut [u32; CHUNK]) {
        let [nx, ny] = self.normal;
        for ((place, x), y) in places.iter_mut().zip(xs).zip(ys) {
            // Rounded: of such a float the last bits are the whole number.
            *place = (x * nx + y * ny + self.shift + WHOLE).to_bits() & (WHOLE as u32 - 1);
        }
    }

    /// The bin that a pixel lies nearest to, if any.
    pub fn nearest(&self, [x, y]: [u32; 2]) -> Option<usize> {
        let [nx, ny] = self.normal;
        let place = (x as f32 + 0.5) * nx + (y as f32 + 0.5) * ny + self.shift;
        usize::try_from((place / FRACTIONS as f32 + 0.5) as i64).ok()
    }
}

impl Points {
    /// None yet, with room for so many.
    pub fn with_capacity(count: usize) -> Self {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        Self { xs: Vec::with_capacity(count), ys: Vec::with_capacity(count), within: [none; 2] }
    }

    /// And some pixels more.
    pub fn extend(&mut self, pixels: &[[u32; 2]]) {
        let middle = |axis: usize| pixels.iter().map(move |pixel| pixel[axis] as f32 + 0.5);
        self.xs.extend(middle(0));
        self.ys.extend(middle(1));
        for (axis, ends) in self.within.iter_mut().enumerate() {
            let places = || pixels.iter().map(|pixel| pixel[axis]);
            if let (Some(low), Some(high)) = (places().min(), places().max()) {
                *ends = [ends[0].min(f64::from(low) + 0.5), ends[1].max(f64::from(high) + 0.5)];
            }
        }
    }

    /// Those of the pixels that are wanted.
    pub fn only(&self, wanted: impl Fn([u32; 2]) -> bool) -> Self {
        let mut some = Self::with_capacity(0);
        let pixels = self.xs.iter().zip(&self.ys).map(|(&x, &y)| [x as u32, y as u32]);
        pixels.filter(|&pixel| wanted(pixel)).for_each(|pixel| some.extend(&[pixel]));
        some
    }

    pub fn len(&self) -> usize {
        self.xs.len()
    }

    /// Across `angle`, with so many bins to the pixel, and `margin` of them free at both ends.
    pub fn across(&self, angle: f64, per_pixel: usize, margin: usize) -> Across {
        let scale = per_pixel as f64;
        let (nx, ny) = (-libm::sin(angle) * scale, libm::cos(angle) * scale);
        let [xs, ys] = if self.xs.is_empty() { [[0.5; 2]; 2] } else { self.within };
        let corners = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| nx * xs[i] + ny * ys[j]);
        let low = corners.into_iter().fold(f64::INFINITY, f64::min).floor() as i64 - 1 - margin as i64;
        let high = corners.into_iter().fold(f64::NEG_INFINITY, f64::max).ceil() as i64 + 2 + margin as i64;
        let parts = f64::from(FRACTIONS);
        Across {
            normal: [(nx * parts) as f32, (ny * parts) as f32],
            shift: (-low as f64 * parts) as f32,
            count: (high - low) as usize,
        }
    }

    /// How many pixels lie between each bin and the next in the upper half, and the sum of their parts in the lower.
    pub fn sums(&self, across: &Across, sums: &mut Vec<u64>, threads: usize) {
        sums.clear();
        sums.resize(across.count, 0);
        let count = |sums: &mut Vec<u64>, place: u32| {
            sums[(place / FRACTIONS) as usize] += 1 << u32::BITS | u64::from(place % FRACTIONS);
        };
        let add = |sums: &mut Vec<u64>, from: usize, to: usize| {
            // Neighbours fall into one bin, and would wait for each other: every fourth part in turn.
            let quarter = (to - from) / 4 / CHUNK * CHUNK;
            let mut places = [[0u32; CHUNK]; 4];
            for chunk in (from..from + quarter).step_by(CHUNK) {
                for (n, places) in places.iter_mut().enumerate() {
                    let own = chunk + n * quarter..chunk + n * quarter + CHUNK;
                    across.places(&self.xs[own.clone()], &self.ys[own], places);
                }
                for n in 0..CHUNK {
                    for places in &places {
                        count(sums, places[n]);
                    }
                }
            }
            let rest = from + 4 * quarter..to;
            for (xs, ys) in self.xs[rest.clone()].chunks(CHUNK).zip(self.ys[rest].chunks(CHUNK)) {
                across.places(xs, ys, &mut places[0]);
                for &place in &places[0][..xs.len()] {
                    count(sums, place);
                }
            }
        };
        let shares = self.len() / SHARE;
        if threads <= 1 || shares <= 1 {
            return add(sums, 0, self.len());
        }
        let end = |share: usize| self.len() * share / shares;
        let empty = || vec![0; across.count];
        let merge = |sum: &mut Vec<u64>, part: Vec<u64>| sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        *sums = fold(shares, threads, empty, |sums, share| add(sums, end(share), end(share + 1)), merge);
    }
}
