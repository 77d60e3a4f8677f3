//! II-A: oriented gradients of the occupied pixels, row band by row band.
//!
//! The gradient of a trinary map's single pixels votes for 0, 45 and 90 degrees, whatever the wall's angle, because
//! a wall is a staircase there. So the gradient of an edge pixel is taken over a window: the eigenvectors of the
//! scatter matrix of the edge pixels around it give the direction along the wall and the normal across it, and the
//! eigenvalues' disparity is the gradient's magnitude. Sums of integers only, so nothing depends on the order.

use crate::bands::{BAND_ROWS, map_bands};
use crate::bits::{WORD, Wanted};
use crate::grid::{Grid, State, rounded, undirected};
use crate::parameters::Parameters;
use crate::pixels::Pixels;
use std::ops::Range;

/// Edge pixels (occupied, with a 4-neighbour that is not) and the gradient at each, in rows from the bottom up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gradients {
    /// Column and row (from the bottom) of each edge pixel.
    pub pixels: Pixels,
    /// Direction along the wall on the grid (the gradient is perpendicular to it), radians in [-pi/2, pi/2).
    pub angles: Vec<f32>,
    /// Magnitude, 0 (no direction: a speck, a post) to 255 (a straight wall).
    pub magnitudes: Vec<u8>,
}

/// Gradients of this magnitude or less are specks: posts, and the corners of goods.
pub const SPECK: u8 = 100;

impl Gradients {
    /// Column and row, angle and magnitude of each edge pixel; quickest by what takes them all, such as `for_each`.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], f32, u8)> + '_ {
        self.pixels.runs().flat_map(|(places, pixels)| {
            let values = self.angles[places.clone()].iter().zip(&self.magnitudes[places]);
            pixels.zip(values).map(|(pixel, (&angle, &magnitude))| (pixel, angle, magnitude))
        })
    }

    /// Those that are specks.
    #[must_use]
    pub fn specks(&self) -> Self {
        let mut specks = Self::default();
        specks.extend(self.iter().filter(|(_, _, magnitude)| *magnitude <= SPECK));
        specks
    }

    fn extend(&mut self, edge: impl Iterator<Item = ([u32; 2], f32, u8)>) {
        edge.for_each(|(pixel, angle, magnitude)| {
            self.pixels.push(pixel);
            self.angles.push(angle);
            self.magnitudes.push(magnitude);
        });
    }
}

/// Smallest window in which a staircase shows its slope, pixels. A larger one leaves nothing of the end of a row of racks
/// on a coarse map: it holds a corner everywhere.
const MIN_RADIUS: usize = 4;
/// Largest window, pixels; beyond it only time is lost.
const MAX_RADIUS: usize = 32;

/// Rows of which the gradients are found before they are put to the others.
const TOGETHER: usize = 64 * BAND_ROWS;

/// Radius of the window, pixels.
fn radius(resolution: f64, parameters: &Parameters) -> usize {
    let radius = (parameters.gradients_radius / resolution).round();
    (radius.clamp(0.0, MAX_RADIUS as f64) as usize).clamp(MIN_RADIUS, MAX_RADIUS)
}

/// How far a pixel bears on gradients around it, pixels along either axis: on those of the edge pixels whose window
/// holds it or a neighbour of it. The resolution is in metres per pixel.
#[must_use]
pub fn reach(resolution: f64, parameters: &Parameters) -> usize {
    radius(resolution, parameters) + 1
}

/// No pixel bears on gradients farther from it than this, metres.
pub(crate) fn reach_across(resolution: f64, parameters: &Parameters) -> f64 {
    std::f64::consts::SQRT_2 * reach(resolution, parameters) as f64 * resolution
}

/// Finds the edge pixels and their gradients.
#[must_use]
pub fn find_gradients(grid: &Grid, parameters: &Parameters, threads: usize) -> Gradients {
    find_gradients_in(grid, 0..grid.frame.height, 0..grid.frame.width, parameters, threads)
}

/// The gradients of some rows and columns, as [`find_gradients`] has them there. Of the grid the rows within [`reach`]
/// of these need be at hand.
#[must_use]
pub fn find_gradients_in(
    grid: &Grid,
    rows: Range<usize>,
    columns: Range<usize>,
    parameters: &Parameters,
    threads: usize,
) -> Gradients {
    let radius = radius(grid.frame.resolution, parameters);
    let around = |range: &Range<usize>, end: usize| range.start.saturating_sub(radius)..(range.end + radius).min(end);
    let across = around(&columns, grid.frame.width);
    let shifted = |band: Range<usize>, by: usize| band.start + by..band.end + by;
    let mut all = Gradients::default();
    // Some bands at a time, so that of large maps little is held beside what is made.
    for first in rows.clone().step_by(TOGETHER) {
        let some = first..rows.end.min(first + TOGETHER);
        let window = around(&some, grid.frame.height);
        let edges = map_bands([across.len(), window.len()], threads, |band| {
            edge_pixels(grid, shifted(band, window.start), &across)
        });
        let edges = Edges { first: window.start, rows: edges.into_iter().flatten().collect() };
        let parts = map_bands([columns.len(), some.len()], threads, |band| {
            let mut part = Gradients::default();
            let band = shifted(band, some.start);
            let bits = Bits::new(&edges, &band, &across, radius);
            for y in band {
                row_gradients(&edges, &bits, y, &columns, &mut part);
            }
            part
        });
        for part in parts {
            all.extend(part.iter());
        }
    }
    all
}

/// Columns of the edge pixels of each row, from the first one on.
struct Edges {
    first: usize,
    rows: Vec<Vec<u32>>,
}

impl Edges {
    /// Those of a row that lie among some columns.
    fn among(&self, y: usize, columns: &Range<usize>) -> &[u32] {
        let own = &self.rows[y - self.first];
        let from = own.partition_point(|&x| (x as usize) < columns.start);
        &own[from..own.partition_point(|&x| (x as usize) < columns.end)]
    }
}

/// Columns of the edge pixels of each row of the band, among some columns.
fn edge_pixels(grid: &Grid, band: Range<usize>, among: &Range<usize>) -> Vec<Vec<u32>> {
    let taken = Wanted::new(grid.table.states.map(|s| s == State::Occupied));
    // With a column to either side, where there is one.
    let wider = among.start.saturating_sub(1)..(among.end + 1).min(grid.frame.width);
    let words =
        |y: usize| -> Vec<u64> { grid.row(y)[wider.clone()].chunks(WORD).map(|pixels| taken.word(pixels)).collect() };
    // The map's border is no edge: what lies beyond it is not seen.
    let (top, last) = (grid.frame.height - 1, wider.len() - 1);
    let mut rows = [words(band.start.saturating_sub(1)), words(band.start), Vec::new()];
    let mut columns = Vec::new();
    band.map(|y| {
        rows[2] = words((y + 1).min(top));
        let [below, own, above] = &rows;
        columns.clear();
        for (n, &word) in own.iter().enumerate().filter(|(_, word)| **word != 0) {
            let left = word << 1 | if n == 0 { word & 1 } else { own[n - 1] >> (WORD - 1) };
            let next =
                if n == last / WORD { (word >> (last % WORD) & 1) << (last % WORD) } else { own[n + 1] << (WORD - 1) };
            let mut edge = word & !(left & (word >> 1 | next) & below[n] & above[n]);
            while edge != 0 {
                columns.push((wider.start + n * WORD + edge.trailing_zeros() as usize) as u32);
                edge &= edge - 1;
            }
        }
        columns.retain(|&x| among.contains(&(x as usize)));
        rows.rotate_left(1);
        columns.clone()
    })
    .collect()
}

/// The edge pixels of a band of rows and of those within the radius of it, a bit for each, and windows upon them.
struct Bits {
    /// The lowest row and the leftmost column, of the first byte after the margin.
    first: usize,
    left: usize,
    /// Row after row, with a margin at both ends wider than any window.
    bytes: Vec<u8>,
    stride: usize,
    radius: usize,
    /// Of the rows from the lowest to the highest in the window: which of its columns are in it.
    masks: Vec<[u64; 2]>,
}

/// Bytes beside the bits of a row.
const MARGIN: usize = 16;
/// Bytes of a window that are taken from one word: the word's last are lost when its first bits are shifted out.
const TAKEN: usize = 7;

/// How many bits of a byte are set, the sum of their places, and that of the squares of their places, in the low 16
/// bits, the next 24 and the upper 24, where the sums over the largest window fit; the byte's first place is eight times
/// its number in the window.
static MOMENTS: [[u64; 256]; 2 * TAKEN] = {
    let mut all = [[0u64; 256]; 2 * TAKEN];
    let mut n = 0;
    while n < 2 * TAKEN * 256 * 8 {
        let (number, byte, bit) = (n / 2048, n / 8 % 256, n % 8);
        if byte >> bit & 1 == 1 {
            let place = (8 * number + bit) as u64;
            all[number][byte] += 1 | place << 16 | (place * place) << 40;
        }
        n += 1;
    }
    all
};

impl Bits {
    fn new(edges: &Edges, band: &Range<usize>, among: &Range<usize>, radius: usize) -> Self {
        let rows = band.start.saturating_sub(radius).max(edges.first)..band.end + radius;
        let rows = rows.start..rows.end.min(edges.first + edges.rows.len());
        let stride = among.len().div_ceil(8) + 2 * MARGIN;
        let mut bytes = vec![0; rows.len() * stride];
        for (bytes, columns) in
            bytes.chunks_mut(stride).zip(&edges.rows[rows.start - edges.first..rows.end - edges.first])
        {
            for &x in columns {
                let x = x as usize - among.start;
                bytes[MARGIN + x / 8] |= 1 << (x % 8);
            }
        }
        let mask = |row: usize| {
            let reach = (radius.pow(2) - radius.abs_diff(row).pow(2)).isqrt();
            let whole = ((1u128 << (2 * reach + 1)) - 1) << (radius - reach);
            [whole as u64 & ((1 << (8 * TAKEN)) - 1), (whole >> (8 * TAKEN)) as u64]
        };
        Self {
            first: rows.start,
            left: among.start,
            bytes,
            stride,
            radius,
            masks: (0..=2 * radius).map(mask).collect(),
        }
    }

    /// Of the edge pixels around one: how many there are, the sums of x, y, x x, x y and y y, counted from the window's
    /// lower left.
    fn sums(&self, x: usize, y: usize) -> [i64; 6] {
        // From the lowest row that is there, which may lie above the window's.
        let below = (y - self.first).min(self.radius);
        let lowest = y - self.first - below;
        let place = x - self.left + 8 * MARGIN - self.radius;
        let (byte, shift) = (place / 8, place % 8);
        if self.radius < 8 {
            return self.few_sums(lowest * self.stride + byte, shift, &self.masks[self.radius - below..]);
        }
        let rows = self.bytes.chunks_exact(self.stride).skip(lowest);
        let (mut sums, mut by_row, mut by_square) = (0u64, [0u64; 2], 0u64);
        for (row, (bytes, mask)) in rows.zip(&self.masks[self.radius - below..]).enumerate() {
            let word = |from: usize| {
                let bytes: [u8; 8] = bytes[from..from + 8].try_into().unwrap_or_default();
                u64::from_le_bytes(bytes) >> shift
            };
            let near = word(byte) & mask[0];
            let mut found = moments(near, &MOMENTS[..TAKEN]);
            if mask[1] != 0 {
                found += moments(word(byte + TAKEN) & mask[1], &MOMENTS[TAKEN..]);
            }
            let row = row as u64;
            sums += found;
            let count = found & 0xffff;
            by_row = [by_row[0] + count * row, by_row[1] + (found >> 16 & 0xff_ffff) * row];
            by_square += count * row * row;
        }
        [sums & 0xffff, sums >> 16 & 0xff_ffff, by_row[0], sums >> 40, by_row[1], by_square].map(|sum| sum as i64)
    }

    /// The same of a window that is two bytes wide, whose lowest row begins in a byte: what its rows are times their numbers
    /// fits into the same bits. From the highest row down each adds all above it, and so multiplies nothing.
    fn few_sums(&self, first: usize, shift: usize, masks: &[[u64; 2]]) -> [i64; 6] {
        let count = masks.len().min((self.bytes.len() - first).div_ceil(self.stride));
        let (mut sums, mut by_row, mut by_pair) = (0u64, 0u64, 0u64);
        let mut from = first + count * self.stride;
        for mask in masks[..count].iter().rev() {
            by_row += sums;
            by_pair += by_row;
            from -= self.stride;
            let bytes: [u8; 4] = self.bytes[from..from + 4].try_into().unwrap_or_default();
            let near = (u32::from_le_bytes(bytes) >> shift & mask[0] as u32) as usize;
            sums += MOMENTS[0][near & 255] + MOMENTS[1][near >> 8 & 255];
        }
        let [count, count_by_row, count_by_pair] = [sums, by_row, by_pair].map(|sum| sum & 0xffff);
        let [x, x_by_row] = [sums, by_row].map(|sum| sum >> 16 & 0xff_ffff);
        // Pairs of rows up to one are half of its square and half of itself.
        [count, x, count_by_row, sums >> 40, x_by_row, 2 * count_by_pair - count_by_row].map(|sum| sum as i64)
    }
}

/// Of a word's bits, from the first byte on that tables are given for.
fn moments(mut word: u64, tables: &[[u64; 256]]) -> u64 {
    let mut sum = 0;
    for table in tables {
        if word == 0 {
            break;
        }
        sum += table[word as usize & 255];
        word >>= 8;
    }
    sum
}

/// Gradients of one row's edge pixels among some columns, from the scatter of the edge pixels within the radius. The
/// window is round: of a wall's two faces a square one would cut off unequal ends, and so turn them towards its own
/// corners.
fn row_gradients(edges: &Edges, bits: &Bits, y: usize, among: &Range<usize>, out: &mut Gradients) {
    let own = edges.among(y, among);
    for &column in own {
        let [n, sx, sy, sxx, sxy, syy] = bits.sums(column as usize, y);
        // Central second moments, all times n: still integers.
        let (xx, xy, yy) = (n * sxx - sx * sx, n * sxy - sx * sy, n * syy - sy * sy);
        let spread = (xx + yy) as f64;
        let split = (((xx - yy) as f64).powi(2) + ((2 * xy) as f64).powi(2)).sqrt();
        let magnitude = if spread > 0.0 { split / spread } else { 0.0 };
        out.pixels.push([column, y as u32]);
        out.angles.push(undirected(0.5 * libm::atan2((2 * xy) as f64, (xx - yy) as f64)) as f32);
        out.magnitudes.push(rounded(magnitude * 255.0) as u8);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_holds_what_lies_in_it() {
        let (width, height) = (90u32, 80usize);
        let is_edge = |x: &u32, y: usize| (x * x + 7 * y as u32 * y as u32 + 3 * x * y as u32) % 11 < 5;
        let rows = (0..height).map(|y| (0..width).filter(|x| is_edge(x, y)).collect()).collect();
        let edges = Edges { first: 0, rows };
        for radius in [4, 7, 8, 20, 32] {
            let bits = Bits::new(&edges, &(0..height), &(0..width as usize), radius);
            for [x, y] in [[0usize, 0], [45, 3], [89, 40], [40, 41], [50, 79], [3, 60]] {
                let mut expected = [0; 6];
                // Counted from the window's left column, and from its lowest row that is there.
                let (left, lowest) = (x as i64 - radius as i64, y.saturating_sub(radius) as i64);
                for (row, columns) in edges.rows.iter().enumerate() {
                    for &column in columns {
                        let [dx, dy] = [i64::from(column) - x as i64, row as i64 - y as i64];
                        if dx * dx + dy * dy <= (radius * radius) as i64 {
                            let [x, y] = [i64::from(column) - left, row as i64 - lowest];
                            expected.iter_mut().zip([1, x, y, x * x, x * y, y * y]).for_each(|(sum, own)| *sum += own);
                        }
                    }
                }
                assert_eq!(bits.sums(x, y), expected, "{radius} {x} {y}");
            }
        }
    }
}
