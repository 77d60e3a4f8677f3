//! II-D: O(face), by sums over rows between line crossings, and O(edge).

use crate::arrangement::{Arrangement, NONE};
use crate::bands::fold_bands;
use crate::coverage::cover_edges;
use crate::directions::Directions;
use crate::gradients::Gradients;
use crate::grid::{Grid, State, tidy};
use crate::lines::Lines;
use crate::parameters::Parameters;

/// What lies in the faces and on the edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Occupancy {
    /// O(face): average occupancy of its pixels, 0 to 1; unknown pixels count 0.5, the prior of an occupancy grid. A
    /// sliver without pixels has that of the pixel which it lies in; so have the two shares that follow.
    pub faces: Vec<f64>,
    /// Share of unknown pixels of each face, 0 to 1.
    pub unknown: Vec<f64>,
    /// Share of free pixels of each face, 0 to 1.
    pub free: Vec<f64>,
    /// Pixels with their centre in each face; together all of the map's.
    pub pixels: Vec<u64>,
    /// What each face mostly is.
    pub states: Vec<State>,
    /// O(edge): share of the edge's length on which occupied pixels lie, 0 to 1; nothing on the border.
    pub edges: Vec<f64>,
    /// Where on the edges they lie: from, to, metres from the edge's first vertex, in the edges' order and along each.
    pub runs: Vec<[f64; 2]>,
    /// Edge e has the runs from `run_offsets[e]` to `run_offsets[e + 1]`.
    pub run_offsets: Vec<u32>,
}

impl Occupancy {
    /// The parts of an edge on which occupied pixels lie: from, to, metres from its first vertex.
    #[must_use]
    pub fn runs_of(&self, edge: usize) -> &[[f64; 2]] {
        &self.runs[self.run_offsets[edge] as usize..self.run_offsets[edge + 1] as usize]
    }
}

/// A face is occupied when its average occupancy exceeds this and it is not mostly unknown.
const OCCUPIED: f64 = 0.5;
/// Sums over the pixels of a face; packed into one number for each pixel of a row.
#[derive(Clone, Copy, Default)]
struct Sums {
    percent: i64,
    unknown: i64,
    free: i64,
    pixels: i64,
}

/// Measures faces and edges.
#[must_use]
pub fn find_occupancy(
    grid: &Grid,
    arrangement: &Arrangement,
    directions: &Directions,
    lines: &Lines,
    gradients: &Gradients,
    parameters: &Parameters,
    threads: usize,
) -> Occupancy {
    let sums = face_sums(grid, arrangement, threads);
    // A sliver between the pixels' centres has no pixels: it is what the pixel under its middle is.
    let evidence: Vec<Sums> = sums
        .iter()
        .enumerate()
        .map(|(face, sums)| if sums.pixels > 0 { *sums } else { pixel_under(grid, arrangement, face) })
        .collect();
    let share = |part: i64, of: i64| tidy(part as f64 / of as f64);
    let faces: Vec<f64> = evidence.iter().map(|s| share(s.percent, 100 * s.pixels)).collect();
    let unknown: Vec<f64> = evidence.iter().map(|s| share(s.unknown, s.pixels)).collect();
    let state = |(&occupancy, &unknown): (&f64, &f64)| {
        if unknown > 0.5 {
            State::Unknown
        } else if occupancy > OCCUPIED {
            State::Occupied
        } else {
            State::Free
        }
    };
    let covered = cover_edges(grid, arrangement, directions, lines, gradients, parameters);
    Occupancy {
        states: faces.iter().zip(&unknown).map(state).collect(),
        faces,
        unknown,
        free: evidence.iter().map(|s| share(s.free, s.pixels)).collect(),
        pixels: sums.iter().map(|s| s.pixels.unsigned_abs()).collect(),
        edges: covered.shares,
        runs: covered.runs,
        run_offsets: covered.offsets,
    }
}

/// The pixel that the middle of a face's vertices lies in.
fn pixel_under(grid: &Grid, arrangement: &Arrangement, face: usize) -> Sums {
    let (mut count, mut x, mut y) = (0.0, 0.0, 0.0);
    for &half in arrangement.around(face) {
        let [vx, vy] = arrangement.vertices[arrangement.start(half) as usize];
        (count, x, y) = (count + 1.0, x + vx, y + vy);
    }
    let (column, row) = ((x / count) as usize, (y / count) as usize);
    let value = usize::from(grid.row(row.min(grid.frame.height - 1))[column.min(grid.frame.width - 1)]);
    let state = grid.table.states[value];
    Sums {
        percent: i64::from(grid.table.occupancy[value]),
        unknown: i64::from(state == State::Unknown),
        free: i64::from(state == State::Free),
        pixels: 1,
    }
}

/// Sums of each face: what lies left of its right side less what lies left of its left side, row by row. A pixel
/// belongs to the face that its centre lies in; a centre on a line belongs to the right of it or above.
fn face_sums(grid: &Grid, arrangement: &Arrangement, threads: usize) -> Vec<Sums> {
    let (width, height) = (grid.frame.width, grid.frame.height);
    let table = grid.table;
    // Percent in the low 24 bits' place, unknown and free above: three sums in one addition.
    let mut packed = [0u128; 256];
    for (value, entry) in packed.iter_mut().enumerate() {
        *entry = u128::from(table.occupancy[value])
            | u128::from(table.states[value] == State::Unknown) << 48
            | u128::from(table.states[value] == State::Free) << 88;
    }
    let unpack = |sum: u128, pixels: i64| Sums {
        percent: (sum & ((1 << 48) - 1)) as i64,
        unknown: ((sum >> 48) & ((1 << 40) - 1)) as i64,
        free: (sum >> 88) as i64,
        pixels,
    };
    let empty = || vec![Sums::default(); arrangement.face_count()];
    fold_bands(
        height,
        threads,
        empty,
        |totals, band| {
            let mut left = vec![0u128; width + 1];
            let crossings = Crossings::new(arrangement, band.clone());
            for y in band {
                let mut sum = 0u128;
                for (entry, &value) in left[1..].iter_mut().zip(grid.row(y)) {
                    sum += packed[usize::from(value)];
                    *entry = sum;
                }
                crossings.of_row(arrangement, y, width, |half, column| {
                    let sums = unpack(left[column], column as i64);
                    for (half, sign) in [(half, 1), (Arrangement::twin(half), -1)] {
                        let face = arrangement.face(half);
                        if face != NONE {
                            let total = &mut totals[face as usize];
                            total.percent += sign * sums.percent;
                            total.unknown += sign * sums.unknown;
                            total.free += sign * sums.free;
                            total.pixels += sign * sums.pixels;
                        }
                    }
                });
            }
        },
        |totals, part| {
            for (total, sums) in totals.iter_mut().zip(part) {
                total.percent += sums.percent;
                total.unknown += sums.unknown;
                total.free += sums.free;
                total.pixels += sums.pixels;
            }
        },
    )
}

/// Edges that cross the rows of a band, by row.
struct Crossings {
    first_row: usize,
    /// Half-edges that run upwards across each row.
    rows: Vec<Vec<u32>>,
}

impl Crossings {
    fn new(arrangement: &Arrangement, band: std::ops::Range<usize>) -> Self {
        let mut rows = vec![Vec::new(); band.len()];
        let mut add = |edge: u32| {
            let [p, q] = arrangement.edges[edge as usize].map(|v| arrangement.rows_below[v as usize] as usize);
            let half = 2 * edge + u32::from(p > q);
            for y in p.min(q).max(band.start)..p.max(q).min(band.end) {
                rows[y - band.start].push(half);
            }
        };
        for (line, edges) in arrangement.lines.iter().zip(&arrangement.line_edges) {
            if line.a == 0 || edges.is_empty() {
                continue;
            }
            // Along a line the rows only rise or only fall: the first edge of the band is found by halving.
            let rising = line.a < 0;
            let before = |&edge: &u32| {
                let end = arrangement.rows_below[arrangement.edges[edge as usize][1] as usize] as usize;
                if rising { end <= band.start } else { end >= band.end }
            };
            let mut low = edges.start;
            let mut high = edges.end;
            while low < high {
                let middle = low + (high - low) / 2;
                if before(&middle) {
                    low = middle + 1;
                } else {
                    high = middle;
                }
            }
            for edge in low..edges.end {
                let start = arrangement.rows_below[arrangement.edges[edge as usize][0] as usize] as usize;
                if if rising { start >= band.end } else { start <= band.start } {
                    break;
                }
                add(edge);
            }
        }
        let border = arrangement.edge_lines.iter().rposition(|&line| line != NONE).map_or(0, |n| n + 1);
        (border as u32..arrangement.edges.len() as u32).for_each(add);
        Self { first_row: band.start, rows }
    }

    /// Calls `visit` with each half-edge that runs upwards across row `y` and the number of pixels left of it.
    fn of_row(&self, arrangement: &Arrangement, y: usize, width: usize, mut visit: impl FnMut(u32, usize)) {
        for &half in &self.rows[y - self.first_row] {
            let line = arrangement.edge_lines[(half >> 1) as usize];
            let column = if line == NONE {
                // Upwards along the right side, downwards (so its twin upwards) along the left.
                if half & 1 == 0 { width } else { 0 }
            } else {
                let line = arrangement.lines[line as usize];
                let (n, d) = (2 * line.c - line.b * (2 * y as i64 + 1) - line.a, 2 * line.a);
                let (n, d) = if d < 0 { (-n, -d) } else { (n, d) };
                (-(-n).div_euclid(d)).clamp(0, width as i64) as usize
            };
            visit(half, column);
        }
    }
}
