//! II-D: what the pixels of the map, or of some of its rows, add to each face, by sums over rows between line
//! crossings.

use crate::arrangement::Arrangement;
use crate::bands::{BAND_ROWS, map_bands};
use crate::crossings::{Crossing, Crossings};
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

    /// The same again of what lacks the faces' half-edges: what they were needed for, the slivers, is known.
    pub(crate) fn again(grid: &Grid, arrangement: &Arrangement, under: Vec<(u32, Sums)>, threads: usize) -> Self {
        Self { within: face_sums(grid, arrangement, 0..grid.frame.height, threads), under }
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
/// Rows that lines are followed through together, so few that they stay at hand.
const NEAR: usize = 16;
/// Rows that are added up before they are put to the others.
const TOGETHER: usize = 64 * BAND_ROWS;

/// Four sums in one number, each from a bit on: unknown, free and all pixels, and percent. Over the rows of a band none
/// reaches into the next, be they 16 million pixels wide.
type Packed = u128;
const FIELDS: [u32; 4] = [0, 30, 60, 90];

/// What each value of a pixel adds.
fn packed(grid: &Grid) -> [Packed; 256] {
    std::array::from_fn(|value| {
        let state = grid.table.states[value];
        let is = |wanted: State| Packed::from(state == wanted);
        let sums = [is(State::Unknown), is(State::Free), 1, Packed::from(grid.table.occupancy[value])];
        sums.into_iter().zip(FIELDS).map(|(sum, from)| sum << from).sum()
    })
}

fn unpacked(packed: Packed) -> Sums {
    let of_pixels = |n: usize| (packed >> FIELDS[n] & ((1 << 30) - 1)) as i64;
    Sums { unknown: of_pixels(0), free: of_pixels(1), pixels: of_pixels(2), percent: (packed >> FIELDS[3]) as i64 }
}

fn is_alike(word: [u8; WORD]) -> bool {
    let word = u64::from_ne_bytes(word);
    word == word.rotate_left(u8::BITS)
}

/// Sums of each face: what lies left of its right side less what lies left of its left side, row by row. A pixel
/// belongs to the face that its centre lies in; a centre on a line belongs to the right of it or above.
fn face_sums(grid: &Grid, arrangement: &Arrangement, rows: Range<usize>, threads: usize) -> Vec<Sums> {
    let width = grid.frame.width;
    let packed = packed(grid);
    let mut totals = vec![Sums::default(); arrangement.face_count()];
    // Some bands at a time, each with the edges that cross it: few of all.
    for first in rows.clone().step_by(TOGETHER) {
        let some = first..rows.end.min(first + TOGETHER);
        let parts = map_bands([width, some.len()], threads, |band| {
            let band = band.start + some.start..band.end + some.start;
            let mut left: Vec<Vec<Packed>> = vec![vec![0; width / WORD + 1]; NEAR];
            let Crossings { mut walks, edges } = Crossings::new(arrangement, width, &band);
            // What the pixels left of each edge add, row by row.
            let mut sums: Vec<Packed> = vec![0; edges.len()];
            // What the first pixels of a word add; mostly all are alike.
            let of_first = |pixels: &[u8], count: usize| match pixels.first_chunk::<WORD>() {
                Some(word) if is_alike(*word) => packed[usize::from(word[0])] * count as Packed,
                _ => pixels[..count].iter().map(|&value| packed[usize::from(value)]).sum(),
            };
            for first in band.clone().step_by(NEAR) {
                let rows = first..band.end.min(first + NEAR);
                for (left, y) in left.iter_mut().zip(rows.clone()) {
                    let mut sum: Packed = 0;
                    // Most words are as the one before them.
                    let (mut last, mut of_last) = ([0; WORD], packed[0] << WORD.ilog2());
                    for (before, word) in left.iter_mut().zip(grid.row(y).chunks_exact(WORD)) {
                        *before = sum;
                        if *word != last {
                            last.copy_from_slice(word);
                            of_last = word.iter().map(|&value| packed[usize::from(value)]).sum();
                        }
                        sum += of_last;
                    }
                    left[width / WORD] = sum;
                }
                let near: Vec<_> = rows.clone().map(|y| grid.row(y)).zip(&left).collect();
                let left_of = |y: usize, column: usize| {
                    let ((row, left), rest) = (near[y - first], column % WORD);
                    left[column / WORD] + of_first(&row[column - rest..], rest)
                };
                for walk in &mut walks {
                    walk.add(&rows, &edges, width, &mut sums, left_of);
                }
            }
            (edges, sums)
        });
        for (Crossing { half, .. }, sum) in parts.into_iter().flat_map(|(edges, sums)| edges.into_iter().zip(sums)) {
            let left = unpacked(sum);
            for (half, sign) in [(half, 1), (Arrangement::twin(half), -1)] {
                if let Some(total) = totals.get_mut(arrangement.face(half) as usize) {
                    total.add(sign, left);
                }
            }
        }
    }
    totals
}
