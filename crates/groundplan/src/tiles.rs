//! Tiles of 8 x 8 pixels: where the map is all of one state. What lies in the midst of the free, the occupied or the
//! unknown is most of a map, and no pass need look at it pixel by pixel.

use crate::bands::map_bands;
use crate::grid::{Grid, State};

/// Pixels along a tile's side: a word of eight bytes. A band of rows has whole tiles.
pub(crate) const SIDE: usize = 8;

/// The tiles of a map, row after row from the bottom; those at its right and upper borders may be cut off.
pub(crate) struct Tiles {
    /// Tiles in a row.
    pub width: usize,
    /// Rows of tiles.
    pub height: usize,
    /// For each tile the states that its pixels have, a bit for each: [`bit`].
    pub states: Vec<u8>,
}

/// A state in a set of states.
pub(crate) const fn bit(state: State) -> u8 {
    1 << state as u8
}

impl Tiles {
    /// Looks at every pixel of the map once, eight at a time.
    pub fn new(grid: &Grid, threads: usize) -> Self {
        let (width, height) = (grid.frame.width.div_ceil(SIDE), grid.frame.height.div_ceil(SIDE));
        let bits = grid.table.states.map(bit);
        let states = map_bands([grid.frame.width, grid.frame.height], threads, |band| {
            let mut states = vec![0u8; band.len().div_ceil(SIDE) * width];
            // Of each whole tile the lowest eight pixels, and what is not as the first of them: mostly nothing.
            let mut first = vec![0u64; grid.frame.width / SIDE];
            let mut differing = first.clone();
            for (tiles, low) in states.chunks_mut(width).zip(band.clone().step_by(SIDE)) {
                let rows = low..(low + SIDE).min(band.end);
                for ((first, differing), word) in first.iter_mut().zip(&mut differing).zip(words(grid.row(low))) {
                    (*first, *differing) = (word, word ^ word.rotate_left(8));
                }
                for y in low + 1..rows.end {
                    for ((first, differing), word) in first.iter().zip(&mut differing).zip(words(grid.row(y))) {
                        *differing |= word ^ first;
                    }
                }
                let of = |set: u8, pixels: &[u8]| pixels.iter().fold(set, |set, &pixel| set | bits[usize::from(pixel)]);
                for (n, (tile, (first, differing))) in tiles.iter_mut().zip(first.iter().zip(&differing)).enumerate() {
                    let pixels = |y: usize| &grid.row(y)[n * SIDE..(n + 1) * SIDE];
                    *tile = if *differing == 0 {
                        bits[usize::from(*first as u8)]
                    } else {
                        rows.clone().map(pixels).fold(0, of)
                    };
                }
                for y in rows {
                    let rest = grid.row(y).chunks_exact(SIDE).remainder();
                    tiles[width - 1] = of(tiles[width - 1], rest);
                }
            }
            states
        });
        Self { width, height, states: states.concat() }
    }

    /// The corners, in pixels, of the first and the last tile of each row in which not all is unknown.
    pub fn seen(&self) -> Vec<[f64; 2]> {
        let mut corners = Vec::new();
        for (y, row) in self.states.chunks(self.width.max(1)).enumerate() {
            let is_seen = |states: &u8| *states != bit(State::Unknown);
            if let (Some(first), Some(last)) = (row.iter().position(is_seen), row.iter().rposition(is_seen)) {
                corners.extend([[first, y], [last + 1, y], [first, y + 1], [last + 1, y + 1]]);
            }
        }
        corners.into_iter().map(|corner| corner.map(|n| (n * SIDE) as f64)).collect()
    }

    /// How far from each tile all is alike: 0 where it is of several states itself, 1 when a neighbour is not like it,
    /// 2 when a neighbour's neighbour is not, and so on. Beyond the map's borders all is unknown.
    pub fn reaches(&self) -> Vec<u8> {
        let (w, h) = (self.width, self.height);
        // With a border, so that no tile asks where it lies.
        let wide = w + 2;
        let mut states = vec![bit(State::Unknown); wide * (h + 2)];
        for (to, from) in states[wide + 1..].chunks_mut(wide).zip(self.states.chunks(w.max(1))) {
            to[..w].copy_from_slice(from);
        }
        let mut reaches = vec![u8::MAX; states.len()];
        // There and back again: the least of the four neighbours that are done, and one more.
        let visit = |reaches: &mut [u8], at: usize, done: [usize; 4]| {
            let own = states[at];
            let near = |n: usize| if states[n] == own { reaches[n] } else { 0 };
            let least = done.into_iter().map(near).fold(u8::MAX, u8::min);
            reaches[at] = if own.is_power_of_two() { reaches[at].min(least.saturating_add(1)) } else { 0 };
        };
        for y in 1..=h {
            for at in y * wide + 1..y * wide + 1 + w {
                visit(&mut reaches, at, [at - 1, at - wide - 1, at - wide, at - wide + 1]);
            }
        }
        for y in (1..=h).rev() {
            for at in (y * wide + 1..y * wide + 1 + w).rev() {
                visit(&mut reaches, at, [at + 1, at + wide + 1, at + wide, at + wide - 1]);
            }
        }
        (1..=h).flat_map(|y| reaches[y * wide + 1..y * wide + 1 + w].iter().copied()).collect()
    }
}

/// A row's pixels, eight at a time, without those that are left.
fn words(row: &[u8]) -> impl Iterator<Item = u64> + '_ {
    row.chunks_exact(SIDE).map(|pixels| pixels.iter().rev().fold(0, |word, &pixel| word << 8 | u64::from(pixel)))
}
