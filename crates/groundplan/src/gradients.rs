//! II-A: oriented gradients of the occupied pixels, row band by row band.
//!
//! The gradient of a trinary map's single pixels votes for 0, 45 and 90 degrees, whatever the wall's angle, because
//! a wall is a staircase there. So the gradient of an edge pixel is taken over a window: the eigenvectors of the
//! scatter matrix of the edge pixels around it give the direction along the wall and the normal across it, and the
//! eigenvalues' disparity is the gradient's magnitude. Sums of integers only, so nothing depends on the order.

use crate::bands::{BAND_ROWS, map_bands};
use crate::grid::{Grid, State, undirected};
use crate::parameters::Parameters;
use std::ops::Range;

/// Edge pixels (occupied, with a 4-neighbour that is not) and the gradient at each, in rows from the bottom up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gradients {
    /// Column and row (from the bottom) of each edge pixel.
    pub pixels: Vec<[u32; 2]>,
    /// Direction along the wall on the grid (the gradient is perpendicular to it), radians in [-pi/2, pi/2).
    pub angles: Vec<f32>,
    /// Magnitude, 0 (no direction: a speck, a post) to 255 (a straight wall).
    pub magnitudes: Vec<u8>,
}

/// Gradients of this magnitude or less are specks: posts, and the corners of goods.
pub const SPECK: u8 = 100;

impl Gradients {
    /// Those that are specks.
    #[must_use]
    pub fn specks(&self) -> Self {
        let mut specks = Self::default();
        for ((pixel, angle), magnitude) in self.pixels.iter().zip(&self.angles).zip(&self.magnitudes) {
            if *magnitude <= SPECK {
                specks.pixels.push(*pixel);
                specks.angles.push(*angle);
                specks.magnitudes.push(*magnitude);
            }
        }
        specks
    }
}

/// Smallest window in which a staircase shows its slope, pixels.
const MIN_RADIUS: usize = 7;
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
    let (window, across) = (around(&rows, grid.frame.height), around(&columns, grid.frame.width));
    let shifted = |band: Range<usize>, by: usize| band.start + by..band.end + by;
    let edges = map_bands(window.len(), threads, |band| edge_pixels(grid, shifted(band, window.start), &across));
    let edges = Edges { first: window.start, rows: edges.into_iter().flatten().collect() };
    // Room for all at once, and of large maps no more than some bands beside it.
    let mut all = Gradients::default();
    let count = rows.clone().map(|y| edges.among(y, &columns).len()).sum();
    all.pixels.reserve_exact(count);
    all.angles.reserve_exact(count);
    all.magnitudes.reserve_exact(count);
    for first in rows.clone().step_by(TOGETHER) {
        let some = first..rows.end.min(first + TOGETHER);
        let parts = map_bands(some.len(), threads, |band| {
            let mut part = Gradients::default();
            for y in shifted(band, some.start) {
                row_gradients(&edges, y, &columns, radius, &mut part);
            }
            part
        });
        for part in parts {
            all.pixels.extend(part.pixels);
            all.angles.extend(part.angles);
            all.magnitudes.extend(part.magnitudes);
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

/// Pixels that are looked at together.
const WORD: usize = 8;

/// Columns of the edge pixels of each row of the band, among some columns.
fn edge_pixels(grid: &Grid, band: Range<usize>, among: &Range<usize>) -> Vec<Vec<u32>> {
    let taken = grid.table.states.map(|s| s == State::Occupied);
    let (width, height) = (grid.frame.width, grid.frame.height);
    let is_taken = |row: &[u8], x: usize| taken[usize::from(row[x])];
    band.map(|y| {
        let row = grid.row(y);
        // The map's border is no edge: what lies beyond it is not seen.
        let below = grid.row(y.saturating_sub(1));
        let above = grid.row((y + 1).min(height - 1));
        let mut columns = Vec::new();
        for (n, pixels) in row[among.clone()].chunks(WORD).enumerate() {
            // Eight free or unknown pixels alike are the most of a map.
            if pixels == [pixels[0]; WORD] && !taken[usize::from(pixels[0])] {
                continue;
            }
            let first = among.start + n * WORD;
            for x in first..first + pixels.len() {
                if is_taken(row, x)
                    && !(is_taken(row, x.saturating_sub(1))
                        && is_taken(row, (x + 1).min(width - 1))
                        && is_taken(below, x)
                        && is_taken(above, x))
                {
                    columns.push(x as u32);
                }
            }
        }
        columns
    })
    .collect()
}

/// Gradients of one row's edge pixels among some columns, from the scatter of the edge pixels within `radius`. The
/// window is round: of a wall's two faces a square one would cut off unequal ends, and so turn them towards its own
/// corners.
fn row_gradients(edges: &Edges, y: usize, among: &Range<usize>, radius: usize, out: &mut Gradients) {
    let Edges { first, rows } = edges;
    let own = edges.among(y, among);
    if own.is_empty() {
        return;
    }
    let around = y.saturating_sub(radius).max(*first)..(y + radius + 1).min(first + rows.len());
    let reaches: Vec<i64> =
        around.clone().map(|other| (radius.pow(2) - y.abs_diff(other).pow(2)).isqrt() as i64).collect();
    let mut starts = vec![0usize; around.len()];
    for &column in own {
        let x = i64::from(column);
        let (mut n, mut sx, mut sy, mut sxx, mut sxy, mut syy) = (0i64, 0i64, 0i64, 0i64, 0i64, 0i64);
        for ((start, &reach), other) in starts.iter_mut().zip(&reaches).zip(around.clone()) {
            let row = &rows[other - first];
            while *start < row.len() && i64::from(row[*start]) < x - reach {
                *start += 1;
            }
            let dy = other as i64 - y as i64;
            let (mut count, mut sum, mut squares) = (0, 0, 0);
            for &near in &row[*start..] {
                let dx = i64::from(near) - x;
                if dx > reach {
                    break;
                }
                count += 1;
                sum += dx;
                squares += dx * dx;
            }
            n += count;
            sx += sum;
            sxx += squares;
            sy += count * dy;
            sxy += sum * dy;
            syy += count * dy * dy;
        }
        // Central second moments, all times n: still integers.
        let (xx, xy, yy) = (n * sxx - sx * sx, n * sxy - sx * sy, n * syy - sy * sy);
        let spread = (xx + yy) as f64;
        let split = (((xx - yy) as f64).powi(2) + ((2 * xy) as f64).powi(2)).sqrt();
        let magnitude = if spread > 0.0 { split / spread } else { 0.0 };
        out.pixels.push([column, y as u32]);
        out.angles.push(undirected(0.5 * libm::atan2((2 * xy) as f64, (xx - yy) as f64)) as f32);
        out.magnitudes.push((magnitude * 255.0).round() as u8);
    }
}
