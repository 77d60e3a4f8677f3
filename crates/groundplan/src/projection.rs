//! II-A: pixels projected across many angles, one after another.

use crate::bands::fold;
use crate::ends::around;

/// A pixel's weight, in whole parts.
pub(crate) const FRACTIONS: u32 = 16;
/// From here on a float holds whole numbers only. More than any map has bins.
const WHOLE: f32 = 8_388_608.0;
/// Pixels are projected so many at a time.
const CHUNK: usize = 16;
/// Of so many parts of all of them in turn.
const PARTS: usize = 8;
/// So many pixels are worth a thread's while.
pub(crate) const SHARE: usize = 1 << 16;

/// Where some pixels are, to be projected.
#[derive(Clone)]
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
    /// Which bin each pixel lies in, and what it adds there.
    fn places<T: Sum>(&self, xs: &[f32], ys: &[f32], bins: &mut [u32; CHUNK], added: &mut [T; CHUNK]) {
        let [nx, ny] = self.normal;
        for (((bin, added), x), y) in bins.iter_mut().zip(added).zip(xs).zip(ys) {
            // Rounded: of such a float the last bits are the whole number.
            let place = (x * nx + y * ny + self.shift + WHOLE).to_bits() & (WHOLE as u32 - 1);
            *bin = place / FRACTIONS;
            *added = T::one(place % FRACTIONS);
        }
    }

    /// The bin that a pixel's centre lies nearest to, if any.
    pub fn nearest(&self, [x, y]: [f32; 2]) -> Option<usize> {
        let [nx, ny] = self.normal;
        let place = x * nx + y * ny + self.shift;
        usize::try_from((place / FRACTIONS as f32 + 0.5) as i64).ok()
    }
}

impl Points {
    /// Pixels' centres.
    pub fn new(xs: Vec<f32>, ys: Vec<f32>) -> Self {
        let within = [ends(&xs), ends(&ys)];
        Self { xs, ys, within }
    }

    /// Those of the pixels that are wanted.
    pub fn only(&self, wanted: impl Fn([u32; 2]) -> bool) -> Self {
        let mut some = [Vec::new(), Vec::new()];
        for (xs, ys) in self.xs.chunks(CHUNK).zip(self.ys.chunks(CHUNK)) {
            let mut kept = [[0.0; CHUNK]; 2];
            let mut count = 0;
            for (&x, &y) in xs.iter().zip(ys) {
                [kept[0][count], kept[1][count]] = [x, y];
                count += usize::from(wanted([x as u32, y as u32]));
            }
            some.iter_mut().zip(&kept).for_each(|(some, kept)| some.extend_from_slice(&kept[..count]));
        }
        let [xs, ys] = some;
        Self::new(xs, ys)
    }

    pub fn len(&self) -> usize {
        self.xs.len()
    }

    /// The longer side of what all lie within.
    pub fn extent(&self) -> f64 {
        self.within.iter().map(|[low, high]| high - low).fold(0.0, f64::max)
    }

    /// Those in each square of such a side, by its column and row; none where there are none.
    pub fn blocks(&self, side: f64) -> impl Iterator<Item = ([usize; 2], Self)> {
        let lows = self.within.map(|[low, _]| low);
        let [columns, rows] = self.within.map(|[low, high]| ((high - low) / side) as usize + 1);
        let mut blocks = vec![[Vec::new(), Vec::new()]; columns * rows];
        for (&x, &y) in self.xs.iter().zip(&self.ys) {
            let [column, row] = [(x, lows[0]), (y, lows[1])].map(|(at, low)| ((f64::from(at) - low) / side) as usize);
            let [xs, ys] = &mut blocks[row * columns + column];
            xs.push(x);
            ys.push(y);
        }
        let some = blocks.into_iter().enumerate().filter(|(_, [xs, _])| !xs.is_empty());
        some.map(move |(n, [xs, ys])| ([n % columns, n / columns], Self::new(xs, ys)))
    }

    /// Across `angle`, with so many bins to the pixel, and `margin` of them free at both ends.
    pub fn across(&self, angle: f64, per_pixel: usize, margin: usize) -> Across {
        let scale = per_pixel as f64;
        let (nx, ny) = (-libm::sin(angle) * scale, libm::cos(angle) * scale);
        let [xs, ys] = if self.xs.is_empty() { [[0.5; 2]; 2] } else { self.within };
        let corners = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| nx * xs[i] + ny * ys[j]);
        let [low, high] = around(corners.into_iter());
        let (low, high) = (low.floor() as i64 - 1 - margin as i64, high.ceil() as i64 + 2 + margin as i64);
        let parts = f64::from(FRACTIONS);
        Across {
            normal: [(nx * parts) as f32, (ny * parts) as f32],
            shift: (-low as f64 * parts) as f32,
            count: (high - low) as usize,
        }
    }

    /// What lies between each bin and the next.
    pub fn sums<T: Sum>(&self, across: &Across, sums: &mut Vec<T>, threads: usize) {
        sums.clear();
        sums.resize(across.count, T::default());
        let add = |sums: &mut Vec<T>, from: usize, to: usize| {
            // Neighbours fall into one bin, and would wait for each other: parts in turn.
            let part = (to - from) / PARTS / CHUNK * CHUNK;
            let mut places = [([0u32; CHUNK], [T::default(); CHUNK]); PARTS];
            for chunk in (from..from + part).step_by(CHUNK) {
                for (n, (bins, added)) in places.iter_mut().enumerate() {
                    let own = chunk + n * part..chunk + n * part + CHUNK;
                    across.places(&self.xs[own.clone()], &self.ys[own], bins, added);
                }
                for n in 0..CHUNK {
                    for (bins, added) in &places {
                        sums[bins[n] as usize].add(added[n]);
                    }
                }
            }
            let rest = from + PARTS * part..to;
            for (xs, ys) in self.xs[rest.clone()].chunks(CHUNK).zip(self.ys[rest].chunks(CHUNK)) {
                let (bins, added) = &mut places[0];
                across.places(xs, ys, bins, added);
                for (&bin, &added) in bins.iter().zip(&*added).take(xs.len()) {
                    sums[bin as usize].add(added);
                }
            }
        };
        let shares = self.len() / SHARE;
        if threads <= 1 || shares <= 1 {
            return add(sums, 0, self.len());
        }
        let end = |share: usize| self.len() * share / shares;
        let empty = || vec![T::default(); across.count];
        let merge = |sum: &mut Vec<T>, part: Vec<T>| sum.iter_mut().zip(part).for_each(|(sum, part)| sum.add(part));
        *sums = fold(shares, threads, empty, |sums, share| add(sums, end(share), end(share + 1)), merge);
    }

    /// True where no more pixels lie between a bin and the next than a [`Sum`] of 32 bits counts, with two bins to the
    /// pixel or more: of a row or of a column there is one.
    pub fn are_narrow(&self) -> bool {
        self.within.iter().all(|[low, high]| high - low < f64::from(MOST))
    }
}

/// How many pixels there are, in the upper half, and the sum of their parts in the lower.
pub(crate) trait Sum: Copy + Default + Send {
    /// A pixel with so many parts.
    fn one(parts: u32) -> Self;
    fn add(&mut self, other: Self);
    fn count(self) -> u32;
    fn parts(self) -> u32;

    /// What falls on a bin, given what lies before and behind it, in parts.
    fn on_bin(before: Self, behind: Self) -> u32 {
        (FRACTIONS * behind.count()).wrapping_sub(behind.parts()).wrapping_add(before.parts())
    }
}

impl Sum for u64 {
    fn one(parts: u32) -> Self {
        1 << 32 | Self::from(parts)
    }
    fn add(&mut self, other: Self) {
        *self = self.wrapping_add(other);
    }
    fn count(self) -> u32 {
        (self >> 32) as u32
    }
    fn parts(self) -> u32 {
        self as u32
    }
}

/// So many pixels at most.
const MOST: u32 = u16::MAX as u32 / FRACTIONS;

impl Sum for u32 {
    fn one(parts: u32) -> Self {
        1 << 16 | parts
    }
    fn add(&mut self, other: Self) {
        *self = self.wrapping_add(other);
    }
    fn count(self) -> u32 {
        self >> 16
    }
    fn parts(self) -> u32 {
        self & 0xffff
    }
}

/// The lowest and the highest of some numbers.
fn ends(values: &[f32]) -> [f64; 2] {
    let (mut low, mut high) = ([f32::INFINITY; CHUNK], [f32::NEG_INFINITY; CHUNK]);
    let chunks = values.chunks_exact(CHUNK);
    let rest = chunks.remainder();
    for chunk in chunks {
        for ((value, low), high) in chunk.iter().zip(&mut low).zip(&mut high) {
            *low = if value < low { *value } else { *low };
            *high = if value > high { *value } else { *high };
        }
    }
    // One loop over the chunks and what is left loses some of this where it is compiled for AVX2 (rustc 1.95).
    let low = low.iter().chain(rest).copied().reduce(f32::min);
    let high = high.iter().chain(rest).copied().reduce(f32::max);
    [low, high].map(|end| f64::from(end.unwrap_or_default()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_lie_within_their_lowest_and_highest_however_many_they_are() {
        for count in 1..100 {
            let values: Vec<f32> = (0..count).map(|n| (n * 37 % 101) as f32).collect();
            let naive =
                [f32::min, f32::max].map(|one| f64::from(values.iter().copied().reduce(one).unwrap_or_default()));
            assert_eq!(ends(&values), naive, "of {count}");
        }
    }
}
