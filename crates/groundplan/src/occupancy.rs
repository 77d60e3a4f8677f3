//! II-D: O(face) and O(edge), by sums over rows between line crossings.

use crate::arrangement::{Arrangement, NONE};
use crate::bands::fold_bands;
use crate::directions::Directions;
use crate::gradients::Gradients;
use crate::grid::{Grid, State, tidy};
use crate::lines::Lines;
use crate::parameters::Parameters;
use crate::radiograms::weight;

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
/// Pixels this near to a line lie on it even when the line is sharper.
const NEAREST_PIXELS: f64 = 1.5;
/// Pixels further than this from a line do not lie on it even when the line is wider.
const FARTHEST_PIXELS: f64 = 3.0;
/// A pixel covers this much of a line to both sides, so that the steps of a staircase leave no gaps.
const COVER_PIXELS: f64 = 0.75;

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

/// How much of each edge is covered, and where.
struct Covered {
    shares: Vec<f64>,
    runs: Vec<[f64; 2]>,
    offsets: Vec<u32>,
}

/// O(edge): the edge pixels that lie on each line mark the parts of its length that they cover.
fn cover_edges(
    grid: &Grid,
    arrangement: &Arrangement,
    directions: &Directions,
    lines: &Lines,
    gradients: &Gradients,
    parameters: &Parameters,
) -> Covered {
    let frame = &grid.frame;
    let tolerance = parameters.radiograms_tolerance_deg.to_radians();
    let mut shares = vec![0.0; arrangement.edges.len()];
    let mut by_line: Vec<Vec<(u32, [f64; 2])>> = vec![Vec::new(); lines.len()];
    for (direction, &angle) in directions.angles.iter().enumerate() {
        let angle = frame.angle_to_grid(angle);
        let (cos, sin) = (libm::cos(angle), libm::sin(angle));
        let mut members: Vec<(f64, f64, usize)> = (0..lines.len())
            .filter(|&n| lines.directions[n] as usize == direction && !arrangement.line_edges[n].is_empty())
            .map(|n| {
                let line = arrangement.lines[n];
                let scale = (((line.a as f64).powi(2)) + (line.b as f64).powi(2)).sqrt();
                let reach = (lines.widths[n] / frame.resolution).clamp(NEAREST_PIXELS, FARTHEST_PIXELS);
                (line.c as f64 / scale, reach, n)
            })
            .collect();
        members.sort_by(|p, q| p.0.total_cmp(&q.0));
        let diagonal = (frame.width + frame.height) as f64;
        let span = 2 * diagonal.ceil() as usize + 4;
        let mut covered: Vec<Vec<u64>> = vec![Vec::new(); members.len()];
        for ((pixel, &along), &magnitude) in gradients.pixels.iter().zip(&gradients.angles).zip(&gradients.magnitudes) {
            if weight(f64::from(along), magnitude, angle, tolerance, true) == 0 {
                continue;
            }
            let (x, y) = (f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
            let offset = y * cos - x * sin;
            let place = x * cos + y * sin + diagonal;
            let first = members.partition_point(|m| m.0 < offset - FARTHEST_PIXELS);
            for (m, member) in members.iter().enumerate().skip(first) {
                if member.0 > offset + FARTHEST_PIXELS {
                    break;
                }
                if (member.0 - offset).abs() <= member.1 {
                    let bits = &mut covered[m];
                    if bits.is_empty() {
                        bits.resize(span.div_ceil(64), 0);
                    }
                    for bin in [place - COVER_PIXELS, place, place + COVER_PIXELS] {
                        let bin = bin.max(0.0) as usize;
                        bits[bin / 64] |= 1 << (bin % 64);
                    }
                }
            }
        }
        for (bits, member) in covered.iter().zip(&members) {
            if bits.is_empty() {
                continue;
            }
            let sums = counts(bits);
            for edge in arrangement.line_edges[member.2].clone() {
                let ends = arrangement.edges[edge as usize].map(|v| {
                    let [x, y] = arrangement.vertices[v as usize];
                    x * cos + y * sin + diagonal
                });
                let (from, to) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                // Whole bins within; a shorter edge is judged by the bin that its middle lies in.
                let (mut first, mut last) = (from.round() as usize, to.round() as usize);
                if first == last {
                    first = f64::midpoint(from, to) as usize;
                    last = first + 1;
                }
                let count = count_below(bits, &sums, last) - count_below(bits, &sums, first);
                shares[edge as usize] = tidy(f64::from(count) / (last - first) as f64);
                let metres = |bin: usize| {
                    let place = if bin == first {
                        from
                    } else if bin == last {
                        to
                    } else {
                        bin as f64
                    };
                    tidy((place - ends[0]).abs() * frame.resolution)
                };
                let found = &mut by_line[member.2];
                let before = found.len();
                found.extend(runs(bits, first, last).map(|[a, b]| {
                    let (a, b) = (metres(a), metres(b));
                    (edge, [a.min(b), a.max(b)])
                }));
                if ends[0] > ends[1] {
                    found[before..].reverse();
                }
            }
        }
    }
    // The edges are numbered line after line.
    let mut offsets = vec![0; arrangement.edges.len() + 1];
    by_line.iter().flatten().for_each(|&(edge, _)| offsets[edge as usize + 1] += 1);
    for edge in 1..offsets.len() {
        offsets[edge] += offsets[edge - 1];
    }
    Covered { shares, runs: by_line.into_iter().flatten().map(|(_, run)| run).collect(), offsets }
}

/// Runs of set bits from bit `first` to before bit `last`.
fn runs(bits: &[u64], first: usize, last: usize) -> impl Iterator<Item = [usize; 2]> {
    let mut at = first;
    std::iter::from_fn(move || {
        let from = next(bits, at, last, true);
        at = next(bits, from, last, false);
        (from < at).then_some([from, at])
    })
}

/// The next bit that is `set`, from bit `at` on, or `last`.
fn next(bits: &[u64], at: usize, last: usize, set: bool) -> usize {
    let mut at = at;
    while at < last {
        let word = bits.get(at / 64).copied().unwrap_or(0) ^ if set { 0 } else { u64::MAX };
        let ahead = (word >> (at % 64)).trailing_zeros() as usize;
        if ahead < 64 {
            return (at + ahead).min(last);
        }
        at = (at / 64 + 1) * 64;
    }
    last
}

/// Set bits before each word.
fn counts(bits: &[u64]) -> Vec<u32> {
    let mut sum = 0;
    bits.iter()
        .map(|word| {
            let before = sum;
            sum += word.count_ones();
            before
        })
        .collect()
}

/// Set bits before bit `n`.
fn count_below(bits: &[u64], sums: &[u32], n: usize) -> u32 {
    let word = (n / 64).min(bits.len() - 1);
    let rest = if n / 64 >= bits.len() { u64::MAX } else { (1u64 << (n % 64)) - 1 };
    sums[word] + (bits[word] & rest).count_ones()
}
