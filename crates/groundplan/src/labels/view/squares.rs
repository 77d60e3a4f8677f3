//! The cells of a large view in squares, those that are all alike as one number: most of a large map is.

use super::summed::Summed;
use super::sums::What;
use crate::bits::{Bits, bits_of, lowest};
use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;

/// Cells along the side of a square.
const SIDE: usize = 8;
/// A byte for each of eight columns.
const ONES: u64 = 0x0101_0101_0101_0101;
const LOW: u64 = 0x0f0f_0f0f_0f0f_0f0f;
/// Of a square that is all alike: its cells' byte, and the bit that says so.
const ALIKE: u32 = 1 << 31;

/// A row of squares after another.
#[derive(Debug)]
pub struct Band {
    /// For each square its byte if it is all alike, or its place in the list.
    places: Vec<u32>,
    squares: Vec<Square>,
}

/// Rows of cells, a byte for each column with its blocked samples in the low half and its occupied ones in the high
/// half; and for each row a bit that says whether something stands in the cell before it, and one for the cell after it.
#[derive(Clone, Copy, Debug)]
pub struct Square {
    // Bytes, and not numbers, take no more room than they need.
    cells: [[u8; SIDE]; SIDE],
    beside: [u8; 2],
}

impl Square {
    fn row(&self, n: usize) -> u64 {
        u64::from_le_bytes(self.cells[n])
    }

    /// What a row holds, a byte for each column.
    #[inline]
    fn of_row(&self, what: What, n: usize) -> u64 {
        match what {
            What::Blocked => self.row(n) & LOW,
            What::Occupied => self.row(n) >> 4 & LOW,
            What::Barred => {
                // One where there is more than nothing.
                let stands = ((self.row(n) >> 4 & LOW) + 0x7f * ONES) >> 7 & ONES;
                let [before, after] = self.beside.map(|bits| u64::from(bits >> n & 1));
                stands | stands << 8 | stands >> 8 | before | after << 56
            }
        }
    }

    /// What its rows hold.
    fn rows(&self, what: What) -> [u64; SIDE] {
        match what {
            What::Blocked => std::array::from_fn(|n| self.of_row(What::Blocked, n)),
            What::Occupied => std::array::from_fn(|n| self.of_row(What::Occupied, n)),
            What::Barred => std::array::from_fn(|n| self.of_row(What::Barred, n)),
        }
    }

    /// The sums of some rows, a byte for each column.
    fn add_up(&self, what: What, rows: Range<usize>) -> u64 {
        match what {
            What::Blocked => rows.map(|n| self.of_row(What::Blocked, n)).sum(),
            What::Occupied => rows.map(|n| self.of_row(What::Occupied, n)).sum(),
            What::Barred => rows.map(|n| self.of_row(What::Barred, n)).sum(),
        }
    }
}

/// Some rows of cells.
pub struct SquaredRows<'a> {
    layers: Vec<Layer<'a>>,
    what: What,
    /// The columns that were asked last, eight at once, and their sums: mostly the next to be asked is beside.
    last: Cell<usize>,
    sums: [Cell<u32>; SIDE],
}

impl<'a> SquaredRows<'a> {
    /// The rows from one to before another of bands of a view so many cells wide.
    pub fn new(bands: &'a [Arc<Band>], width: usize, what: What, from: usize, to: usize) -> Self {
        let across = width.div_ceil(SIDE);
        let layer = |n: usize| {
            let band = &bands[n / BAND];
            let rows = [from.saturating_sub(n * SIDE), (to - n * SIDE).min(SIDE)];
            Layer { places: &band.places[n % BAND * across..][..across], squares: &band.squares, rows }
        };
        let layers = (from / SIDE..to.div_ceil(SIDE)).map(layer).collect();
        Self { layers, what, last: Cell::new(usize::MAX), sums: Default::default() }
    }

    pub fn at(&self, column: usize) -> u32 {
        let n = column / SIDE;
        if self.last.get() != n {
            self.last.set(n);
            self.sums.iter().zip(of_square(&self.layers, n, self.what)).for_each(|(own, sum)| own.set(sum));
        }
        self.sums[column % SIDE].get()
    }

    /// The first of some columns whose sum is as large as that.
    pub fn first(&self, columns: &Range<usize>, least: u32) -> Option<usize> {
        squares(columns).find_map(|(n, own)| {
            let sums = of_square(&self.layers, n, self.what);
            own.clone().find(|&place| sums[place] >= least).map(|place| n * SIDE + place)
        })
    }

    /// The last of them.
    pub fn last(&self, columns: &Range<usize>, least: u32) -> Option<usize> {
        squares(columns).rev().find_map(|(n, own)| {
            let sums = of_square(&self.layers, n, self.what);
            own.clone().rfind(|&place| sums[place] >= least).map(|place| n * SIDE + place)
        })
    }

    /// Which of some columns have a sum as large as that.
    pub fn reached(&self, columns: &Range<usize>, least: u32) -> Bits {
        let mut reached = Bits::new(columns.len());
        for (n, own) in squares(columns) {
            let sums = if self.layers.len() <= FEW {
                // Mostly a row or a few are asked, and nothing stands in them.
                let bytes = of_few(&self.layers, n, self.what);
                if bytes == 0 && least > 0 {
                    continue;
                }
                bytes.to_le_bytes().map(u32::from)
            } else {
                of_square(&self.layers, n, self.what)
            };
            let bits = bits_of(sums.map(|sum| u8::from(sum >= least))) >> own.start;
            reached.add(n * SIDE + own.start - columns.start, bits & lowest(own.len()));
        }
        reached
    }

    /// The sums over them of some columns.
    pub fn over(&self, columns: &Range<usize>) -> Vec<u32> {
        let squares = columns.start / SIDE..columns.end.div_ceil(SIDE);
        let before = columns.start - squares.start * SIDE;
        let mut sums = vec![[0; SIDE]; squares.len()];
        for few in self.layers.chunks(FEW) {
            squares.clone().zip(&mut sums).for_each(|(n, sums)| add_up(few, n, self.what, sums));
        }
        let mut sums = sums.into_flattened();
        sums.truncate(before + columns.len());
        sums.drain(..before);
        sums
    }
}

/// The sums of some rows of bands of a view so many cells wide, with so many samples to a cell, of what is asked; they take
/// the room of others.
pub fn sums(
    bands: &[Arc<Band>],
    width: usize,
    samples: u16,
    what: &[What],
    rows: Range<usize>,
    room: Summed,
) -> Summed {
    let across = width.div_ceil(SIDE);
    let width = across * SIDE;
    Summed::of_rows(width, samples, rows.clone(), what, room, |what, sums| {
        sums[..width].fill(0);
        for n in rows.start / SIDE..rows.end.div_ceil(SIDE) {
            let band = &bands[n / BAND];
            let own = rows.start.saturating_sub(n * SIDE)..(rows.end - n * SIDE).min(SIDE);
            let (before, after) = sums.split_at_mut((n * SIDE + own.start - rows.start + 1) * width);
            let last = before[before.len() - width..].chunks_exact(SIDE);
            let mut after: Vec<_> = after.chunks_mut(width).take(own.len()).collect();
            let places = &band.places[n % BAND * across..][..across];
            for (&place, (last, from)) in places.iter().zip(last.zip((0..).step_by(SIDE))) {
                let mut sum = [0u8; SIDE];
                sum.copy_from_slice(last);
                let rows = if place & ALIKE != 0 {
                    // Most of a map is free, and nothing stands in it.
                    let each = of_cell(place as u8, what);
                    if each == 0 {
                        for to in &mut after {
                            to[from..from + SIDE].copy_from_slice(&sum);
                        }
                        continue;
                    }
                    [u64::from(each) * ONES; SIDE]
                } else {
                    band.squares[place as usize].rows(what)
                };
                for (row, to) in rows[own.clone()].iter().zip(&mut after) {
                    sum.iter_mut().zip(row.to_le_bytes()).for_each(|(sum, byte)| *sum = sum.wrapping_add(byte));
                    to[from..from + SIDE].copy_from_slice(&sum);
                }
            }
        }
    })
}

/// Some rows of a row of squares.
struct Layer<'a> {
    places: &'a [u32],
    squares: &'a [Square],
    rows: [usize; 2],
}

/// Of so many squares above each other the sums still fit in a byte.
const FEW: usize = 3;

/// What a few rows of squares hold in the n-th square of each, a byte for each of its columns.
fn of_few(few: &[Layer], n: usize, what: What) -> u64 {
    few.iter().map(|layer| layer.add_up(n, what)).sum()
}

/// Adds to `sums`, a number for each of its columns, what a few rows of squares hold in the n-th square of each.
fn add_up(few: &[Layer], n: usize, what: What, sums: &mut [u32; SIDE]) {
    let bytes = of_few(few, n, what);
    if bytes != 0 {
        sums.iter_mut().zip(bytes.to_le_bytes()).for_each(|(sum, byte)| *sum += u32::from(byte));
    }
}

/// What rows of squares hold in the columns of the n-th of each.
fn of_square(layers: &[Layer], n: usize, what: What) -> [u32; SIDE] {
    let mut sums = [0; SIDE];
    layers.chunks(FEW).for_each(|few| add_up(few, n, what, &mut sums));
    sums
}

/// The squares that some columns lie in, and which of each one's columns they are.
fn squares(columns: &Range<usize>) -> impl DoubleEndedIterator<Item = (usize, Range<usize>)> + use<> {
    let Range { start, end } = *columns;
    let squares = if start < end { start / SIDE..end.div_ceil(SIDE) } else { 0..0 };
    squares.map(move |n| (n, start.saturating_sub(n * SIDE)..(end - n * SIDE).min(SIDE)))
}

/// Rows of squares in a band.
const BAND: usize = crate::bands::BAND_ROWS / SIDE;

impl Layer<'_> {
    /// The sums over the rows of a square's columns, a byte each.
    fn add_up(&self, n: usize, what: What) -> u64 {
        let (place, [from, to]) = (self.places[n], self.rows);
        if place & ALIKE != 0 {
            return u64::from(of_cell(place as u8, what)) * (to - from) as u64 * ONES;
        }
        self.squares[place as usize].add_up(what, from..to)
    }
}

impl Band {
    /// From its rows of cells; `squares` is room.
    pub fn new(width: usize, cells: &[u8], squares: &mut Vec<Square>) -> Self {
        let across = width.div_ceil(SIDE);
        let mut places = Vec::with_capacity(across * BAND);
        squares.clear();
        for cells in cells.chunks(SIDE * width) {
            // What lies beyond the borders is like what lies on them.
            let last = cells.len() / width - 1;
            let rows: [&[u8]; SIDE] = std::array::from_fn(|row| &cells[row.min(last) * width..][..width]);
            for from in (0..width).step_by(SIDE) {
                let own = rows.map(|row| eight(row, from));
                let stands = |column: usize| {
                    let stands = |row: &[u8]| row.get(column).is_some_and(|cell| cell >> 4 != 0);
                    (0..).zip(rows).map(|(n, row)| u8::from(stands(row)) << n).sum()
                };
                let beside = [from.checked_sub(1).map_or(0, stands), stands(from + SIDE)];
                let first = own[0][0];
                let alike = own == [[first; SIDE]; SIDE] && (of_cell(first, What::Barred) == 1 || beside == [0; 2]);
                places.push(if alike { ALIKE | u32::from(first) } else { squares.len() as u32 });
                if !alike {
                    squares.push(Square { cells: own, beside });
                }
            }
        }
        // No more room than they take.
        Self { places, squares: squares.clone() }
    }
}

fn of_cell(cell: u8, what: What) -> u8 {
    match what {
        What::Blocked => cell & 15,
        What::Occupied => cell >> 4,
        What::Barred => u8::from(cell >> 4 != 0),
    }
}

/// Eight bytes of a row from a column on, of which there is one; beyond its end all are like the last.
fn eight(row: &[u8], from: usize) -> [u8; SIDE] {
    let own = &row[from..row.len().min(from + SIDE)];
    let mut bytes = [own[own.len() - 1]; SIDE];
    bytes[..own.len()].copy_from_slice(own);
    bytes
}
