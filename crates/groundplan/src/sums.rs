//! II-D: what the pixels of the map, or of some of its rows, add to each face, by sums over rows between line
//! crossings.

use crate::arrangement::{Arrangement, NONE};
use crate::bands::{BAND_ROWS, map_bands};
use crate::grid::{Grid, State};
use std::ops::Range;

/// Sums over some pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sums {
    /// Occupancy in percent.
    pub percent: i64,
    /// Pixels that are unknown.
    pub unknown: i64,
    /// Pixels that are free.
    pub free: i64,
    /// All pixels.
    pub pixels: i64,
}

impl Sums {
    fn add(&mut self, sign: i64, other: Self) {
        self.percent += sign * other.percent;
        self.unknown += sign * other.unknown;
        self.free += sign * other.free;
        self.pixels += sign * other.pixels;
    }
}

/// What some rows of pixels add to each face. What all rows add is the sum of what each of them does.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaceSums {
    /// Over the pixels whose centres lie in the face.
    pub within: Vec<Sums>,
    /// Of slivers between the pixels' centres, in the order of the faces: the pixel that the middle of each lies in.
    pub under: Vec<(u32, Sums)>,
}

impl FaceSums {
    /// What the pixels of some rows add, which are at hand.
    #[must_use]
    pub fn new(grid: &Grid, arrangement: &Arrangement, rows: Range<usize>, threads: usize) -> Self {
        let within = face_sums(grid, arrangement, rows.clone(), threads);
        let slivers = within.iter().enumerate().filter(|(_, sums)| sums.pixels == 0);
        let under = slivers.filter_map(|(face, _)| Some((face as u32, pixel_under(grid, arrangement, face, &rows)?)));
        let under = under.collect();
        Self { within, under }
    }

    /// True when they are of as many faces as there are.
    #[must_use]
    pub fn fits(&self, arrangement: &Arrangement) -> bool {
        self.within.len() == arrangement.face_count()
    }

    /// What each face is judged by: its pixels, or where it has none the one under its middle.
    pub fn evidence(&self) -> impl Iterator<Item = Sums> + '_ {
        let mut under = self.under.iter().peekable();
        self.within.iter().zip(0..).map(move |(within, face)| {
            let under = under.next_if(|(sliver, _)| *sliver == face);
            if within.pixels > 0 { *within } else { under.map_or_else(Sums::default, |(_, sums)| *sums) }
        })
    }
}

/// The pixel that the middle of a face's vertices lies in, where it is in these rows.
fn pixel_under(grid: &Grid, arrangement: &Arrangement, face: usize, rows: &Range<usize>) -> Option<Sums> {
    let (mut count, mut x, mut y) = (0.0, 0.0, 0.0);
    for &half in arrangement.around(face) {
        let [vx, vy] = arrangement.vertices[arrangement.start(half) as usize];
        (count, x, y) = (count + 1.0, x + vx, y + vy);
    }
    let column = ((x / count) as usize).min(grid.frame.width - 1);
    let row = ((y / count) as usize).min(grid.frame.height - 1);
    if !rows.contains(&row) {
        return None;
    }
    let value = usize::from(grid.row(row)[column]);
    let state = grid.table.states[value];
    Some(Sums {
        percent: i64::from(grid.table.occupancy[value]),
        unknown: i64::from(state == State::Unknown),
        free: i64::from(state == State::Free),
        pixels: 1,
    })
}

/// Pixels that are looked at together.
const WORD: usize = 8;
/// Rows that are added up before they are put to the others.
const TOGETHER: usize = 64 * BAND_ROWS;

/// Sums of each face: what lies left of its right side less what lies left of its left side, row by row. A pixel
/// belongs to the face that its centre lies in; a centre on a line belongs to the right of it or above.
fn face_sums(grid: &Grid, arrangement: &Arrangement, rows: Range<usize>, threads: usize) -> Vec<Sums> {
    let width = grid.frame.width;
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
    let mut totals = vec![Sums::default(); arrangement.face_count()];
    // Some bands at a time, each with the faces that it has a part of: few of all.
    for first in rows.clone().step_by(TOGETHER) {
        let some = first..rows.end.min(first + TOGETHER);
        let parts = map_bands(some.len(), threads, |band| {
            let band = band.start + some.start..band.end + some.start;
            let mut left = vec![0u128; width / WORD + 1];
            let crossings = Crossings::new(arrangement, band.clone());
            let mut sums = vec![Sums::default(); crossings.faces.len()];
            for y in band {
                let row = grid.row(y);
                let words = row.chunks_exact(WORD);
                let mut sum = 0u128;
                for (before, word) in left.iter_mut().zip(words) {
                    *before = sum;
                    // Eight pixels alike are the most of a map.
                    if *word == [word[0]; WORD] {
                        sum += packed[usize::from(word[0])] << WORD.ilog2();
                    } else {
                        sum += word.iter().map(|&value| packed[usize::from(value)]).sum::<u128>();
                    }
                }
                left[width / WORD] = sum;
                crossings.of_row(arrangement, y, width, |faces, column| {
                    let rest = &row[column - column % WORD..column];
                    let sum = left[column / WORD] + rest.iter().map(|&value| packed[usize::from(value)]).sum::<u128>();
                    let part = unpack(sum, column as i64);
                    for (face, sign) in faces.into_iter().zip([1, -1]) {
                        if face != NONE {
                            sums[face as usize].add(sign, part);
                        }
                    }
                });
            }
            (crossings.faces, sums)
        });
        for (face, sums) in parts.into_iter().flat_map(|(faces, sums)| faces.into_iter().zip(sums)) {
            totals[face as usize].add(1, sums);
        }
    }
    totals
}

/// Edges that cross the rows of a band, by row.
struct Crossings {
    first_row: usize,
    /// The faces beside them, ascending.
    faces: Vec<u32>,
    /// Half-edges that run upwards across each row, and where among those faces the ones left and right of each are.
    rows: Vec<Vec<(u32, [u32; 2])>>,
}

impl Crossings {
    fn new(arrangement: &Arrangement, band: Range<usize>) -> Self {
        let mut crossing = Vec::new();
        let mut add = |edge: u32| {
            let [p, q] = arrangement.edges[edge as usize].map(|v| arrangement.rows_below[v as usize] as usize);
            let rows = p.min(q).max(band.start)..p.max(q).min(band.end);
            if !rows.is_empty() {
                crossing.push((2 * edge + u32::from(p > q), rows));
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
        (border as u32..arrangement.edges.len() as u32).for_each(&mut add);
        let beside = |half: u32| [half, Arrangement::twin(half)].map(|half| arrangement.face(half));
        let mut faces: Vec<u32> = crossing.iter().flat_map(|(half, _)| beside(*half)).collect();
        faces.sort_unstable();
        faces.dedup();
        // The outside is none, and would be the last.
        if faces.last() == Some(&NONE) {
            faces.pop();
        }
        let mut rows = vec![Vec::new(); band.len()];
        for (half, crossed) in crossing {
            let own = beside(half).map(|face| faces.binary_search(&face).map_or(NONE, |place| place as u32));
            for row in &mut rows[crossed.start - band.start..crossed.end - band.start] {
                row.push((half, own));
            }
        }
        Self { first_row: band.start, faces, rows }
    }

    /// Calls `visit` with the places of the faces left and right of each half-edge that runs upwards across row `y`, and
    /// the number of pixels left of it.
    fn of_row(&self, arrangement: &Arrangement, y: usize, width: usize, mut visit: impl FnMut([u32; 2], usize)) {
        for &(half, faces) in &self.rows[y - self.first_row] {
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
            visit(faces, column);
        }
    }
}
