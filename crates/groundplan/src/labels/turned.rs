//! The map turned so that one direction lies along the columns: how much of any piece of a strip is not free, and
//! where structure lies on each line.

use super::Evidence;
use crate::bands::map_bands;
use crate::grid::State;
use crate::radiograms::weight;

/// Cells of the turned raster are about this large, metres.
const CELL: f64 = 0.1;
/// Pixels this near to a line lie on it, metres, or at least so many pixels.
const NEAR: (f64, f64) = (0.12, 2.0);

/// Lines with less structure than this, metres, and than this share of a strong line's, are no sides of corridors but
/// the faces of single goods.
const STRONG: (f64, f64) = (2.0, 0.08);

/// Nothing gets through where more than this share is not free, or more than this is barred by a wall, be it thin.
const IMPASSABLE: f64 = 0.7;
const BARRED: f64 = 0.7;

/// One direction's view of the map. Places along it (u) and across it (v) are metres in the map frame turned by the
/// direction: u = p.t with t = (cos, sin), v = p.n with n = (-sin, cos).
pub struct Turned {
    /// Index of the direction.
    pub direction: usize,
    /// Its angle in the map frame.
    pub angle: f64,
    /// Side of a cell, metres.
    pub cell: f64,
    /// Place of the first cell's lower corner.
    pub start: [f64; 2],
    /// Cells along and across.
    pub size: [usize; 2],
    /// Sums over v of blocked samples, of occupied ones, and of all samples of the places that something stands in or
    /// beside; for each column one more than there are places.
    sums: Vec<[u32; 3]>,
    /// Samples in a cell.
    samples: u32,
    /// Distance from post to post along its lines, metres, where posts recur.
    pub pitch: Option<f64>,
    /// Lines of the direction: their ids, ascending in offset.
    pub lines: Vec<usize>,
    /// Their offsets.
    pub offsets: Vec<f64>,
    /// For each of those lines, whether structure lies on it in each column.
    pub covered: Vec<Vec<bool>>,
}

impl Turned {
    /// The map seen along one direction.
    pub fn new(evidence: &Evidence, direction: usize) -> Self {
        let frame = &evidence.grid.frame;
        let angle = evidence.directions.angles[direction];
        let (cos, sin) = (libm::cos(angle), libm::sin(angle));
        let turn = |[x, y]: [f64; 2]| [x * cos + y * sin, y * cos - x * sin];
        let (w, h) = (frame.width as f64, frame.height as f64);
        let corners = [[0.0, 0.0], [w, 0.0], [0.0, h], [w, h]].map(|p| turn(frame.to_metres(p)));
        let low = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::INFINITY, f64::min);
        let high = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::NEG_INFINITY, f64::max);
        let side = (CELL / frame.resolution).round().max(1.0);
        let cell = side * frame.resolution;
        let start = [low(0), low(1)];
        let size = [0, 1].map(|axis| ((high(axis) - start[axis]) / cell).ceil().max(1.0) as usize);
        let mut made = Self {
            direction,
            angle,
            cell,
            start,
            size,
            sums: Vec::new(),
            samples: (side as u32).clamp(1, 3).pow(2),
            pitch: None,
            lines: Vec::new(),
            offsets: Vec::new(),
            covered: Vec::new(),
        };
        made.sum_blocked(evidence);
        made.cover_lines(evidence);
        made.pitch = super::pitch::find(evidence, &made);
        made
    }

    fn sum_blocked(&mut self, evidence: &Evidence) {
        let frame = &evidence.grid.frame;
        let (nu, nv) = (self.size[0], self.size[1]);
        let rows: Vec<&[u8]> = (0..frame.height).map(|y| evidence.grid.row(y)).collect();
        let counts = evidence.grid.table.states.map(|s| [u32::from(s != State::Free), u32::from(s == State::Occupied)]);
        let per_side = f64::from(self.samples).sqrt();
        // Steps on the grid, in pixels, of one sample along and across.
        let origin = frame.to_pixels(self.point(0.0, 0.0));
        let step = |u: f64, v: f64| {
            let [x, y] = frame.to_pixels(self.point(u, v));
            [(x - origin[0]) / per_side, (y - origin[1]) / per_side]
        };
        let (along, across) = (step(self.cell, 0.0), step(0.0, self.cell));
        let count = per_side as usize;
        let cells = map_bands(nu, evidence.threads, |band| {
            let mut cells = Vec::with_capacity(band.len() * nv);
            for column in band {
                for n in 0..nv {
                    let mut cell = [0u32; 2];
                    for i in 0..count {
                        let a = (column * count + i) as f64 + 0.5;
                        for j in 0..count {
                            let b = (n * count + j) as f64 + 0.5;
                            let x = origin[0] + a * along[0] + b * across[0];
                            let y = origin[1] + a * along[1] + b * across[1];
                            let inside =
                                x >= 0.0 && y >= 0.0 && (x as usize) < frame.width && (y as usize) < frame.height;
                            let [blocked, occupied] =
                                if inside { counts[usize::from(rows[y as usize][x as usize])] } else { [1, 0] };
                            cell[0] += blocked;
                            cell[1] += occupied;
                        }
                    }
                    cells.push(cell);
                }
            }
            cells
        })
        .concat();
        self.sums = Vec::with_capacity(nu * (nv + 1));
        for column in 0..nu {
            let mut sum = [0u32; 3];
            self.sums.push(sum);
            for n in 0..nv {
                let [blocked, occupied] = cells[column * nv + n];
                // A wall one pixel thick, or not quite square to the columns, shows in two or three of them.
                let near = column.saturating_sub(1)..(column + 2).min(nu);
                let barred = near.into_iter().any(|c| cells[c * nv + n][1] > 0);
                sum = [sum[0] + blocked, sum[1] + occupied, sum[2] + u32::from(barred) * self.samples];
                self.sums.push(sum);
            }
        }
    }

    fn cover_lines(&mut self, evidence: &Evidence) {
        let frame = &evidence.grid.frame;
        let lines = evidence.lines;
        let strong = STRONG.0.min(STRONG.1 * lines.typical_amplitude());
        self.lines = (0..lines.len())
            .filter(|&n| lines.directions[n] as usize == self.direction && lines.amplitudes[n] >= strong)
            .collect();
        self.lines.sort_by(|&a, &b| lines.offsets[a].total_cmp(&lines.offsets[b]));
        self.offsets = self.lines.iter().map(|&n| lines.offsets[n]).collect();
        self.covered = vec![vec![false; self.size[0]]; self.lines.len()];
        let near = NEAR.0.max(NEAR.1 * frame.resolution);
        let tolerance = evidence.parameters.radiograms_tolerance_deg.to_radians();
        let on_grid = frame.angle_to_grid(self.angle);
        let gradients = evidence.gradients;
        for ((pixel, &along), &magnitude) in gradients.pixels.iter().zip(&gradients.angles).zip(&gradients.magnitudes) {
            if weight(f64::from(along), magnitude, on_grid, tolerance, true) == 0 {
                continue;
            }
            let [u, v] = self.place(frame.to_metres(pixel.map(|p| f64::from(p) + 0.5)));
            let column = self.column(u);
            let first = self.lines.partition_point(|&n| lines.offsets[n] < v - near);
            for (place, &n) in self.lines.iter().enumerate().skip(first) {
                if lines.offsets[n] > v + near {
                    break;
                }
                self.covered[place][column] = true;
            }
        }
    }

    /// Place along and across of a point of the map frame.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (cos, sin) = (libm::cos(self.angle), libm::sin(self.angle));
        [x * cos + y * sin, y * cos - x * sin]
    }

    /// The point of the map frame `u` along and `v` across from the raster's start.
    fn point(&self, u: f64, v: f64) -> [f64; 2] {
        self.to_map([self.start[0] + u, self.start[1] + v])
    }

    /// The point of the map frame at a place.
    pub fn to_map(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let (cos, sin) = (libm::cos(self.angle), libm::sin(self.angle));
        [u * cos - v * sin, u * sin + v * cos]
    }

    /// The column that holds place `u`, the first or last when it lies outside.
    pub fn column(&self, u: f64) -> usize {
        (((u - self.start[0]) / self.cell).max(0.0) as usize).min(self.size[0] - 1)
    }

    /// Place along of a column's lower border.
    pub fn along(&self, column: usize) -> f64 {
        self.start[0] + column as f64 * self.cell
    }

    /// Share of a column that is not free between two places across, 0 to 1; all of it where there is no cell between.
    pub fn blocked(&self, column: usize, low: f64, high: f64) -> f64 {
        self.share(column, low, high, 0)
    }

    /// Share of the way across a column that is barred: something stands in it, or in the columns beside it.
    pub fn barred(&self, column: usize, low: f64, high: f64) -> f64 {
        self.share(column, low, high, 2)
    }

    /// True when nothing gets through a column between two places across.
    pub fn is_closed(&self, column: usize, low: f64, high: f64) -> bool {
        self.blocked(column, low, high) > IMPASSABLE || self.barred(column, low, high) > BARRED
    }

    /// Share of a column that is occupied.
    pub fn occupied(&self, column: usize, low: f64, high: f64) -> f64 {
        self.share(column, low, high, 1)
    }

    fn share(&self, column: usize, low: f64, high: f64, kind: usize) -> f64 {
        let at = |v: f64| (((v - self.start[1]) / self.cell).round().max(0.0) as usize).min(self.size[1]);
        let (from, to) = (at(low), at(high).max(at(low)));
        if from == to {
            return 1.0;
        }
        let sums = &self.sums[column * (self.size[1] + 1)..];
        f64::from(sums[to][kind] - sums[from][kind]) / f64::from((to - from) as u32 * self.samples)
    }
}
