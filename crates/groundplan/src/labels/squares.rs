//! The cells of a large view in squares, those that are all alike as one number: most of a large map is.

use super::summed::Summed;
use super::sums::{What, barred};
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
/// half; and a byte for each row with a bit for each column that is barred.
#[derive(Debug)]
struct Square {
    cells: [u64; SIDE],
    barred: [u8; SIDE],
    /// Blocked samples of all rows, which is asked most, a byte for each column.
    whole: u64,
}

impl Square {
    fn new(cells: [u64; SIDE], barred: [u8; SIDE]) -> Self {
        Self { cells, barred, whole: cells.iter().map(|row| row & LOW).sum() }
    }

    /// What its rows hold, a byte for each column.
    fn rows(&self, what: What) -> [u64; SIDE] {
        match what {
            What::Blocked => self.cells.map(|row| row & LOW),
            What::Occupied => self.cells.map(|row| row >> 4 & LOW),
            What::Barred => self.barred.map(spread),
        }
    }

    /// The sums of some rows, a byte for each column.
    fn add_up(&self, what: What, rows: Range<usize>) -> u64 {
        match what {
            What::Blocked => self.cells[rows].iter().map(|row| row & LOW).sum(),
            What::Occupied => self.cells[rows].iter().map(|row| row >> 4 & LOW).sum(),
            What::Barred => self.barred[rows].iter().map(|row| spread(*row)).sum(),
        }
    }
}

/// Some rows of cells.
pub struct SquaredRows<'a> {
    layers: Vec<Layer<'a>>,
    what: What,
    /// The columns that were asked last, eight at once, and their sums: mostly the next to be asked is beside.
    last: Cell<(usize, [u32; SIDE])>,
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
        Self { layers, what, last: Cell::new((usize::MAX, [0; SIDE])) }
    }

    pub fn at(&self, column: usize) -> u32 {
        let n = column / SIDE;
        if self.last.get().0 != n {
            self.last.set((n, of_square(&self.layers, n, self.what)));
        }
        self.last.get().1[column % SIDE]
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

/// The sums of some rows of bands of a view so many cells wide, of what is asked; they take the room of others.
pub fn sums(bands: &[Arc<Band>], width: usize, what: &[What], rows: Range<usize>, room: Summed) -> Summed {
    let across = width.div_ceil(SIDE);
    let width = across * SIDE;
    Summed::of_rows(width, rows.clone(), what, room, |what, sums| {
        sums[..width].fill(0);
        for n in rows.start / SIDE..rows.end.div_ceil(SIDE) {
            let band = &bands[n / BAND];
            let own = rows.start.saturating_sub(n * SIDE)..(rows.end - n * SIDE).min(SIDE);
            let (before, after) = sums.split_at_mut((n * SIDE + own.start - rows.start + 1) * width);
            let last = before[before.len() - width..].chunks_exact(SIDE);
            let mut after: Vec<_> =
                after.chunks_mut(width).take(own.len()).map(|row| row.chunks_exact_mut(SIDE)).collect();
            for (&place, last) in band.places[n % BAND * across..][..across].iter().zip(last) {
                let rows = if place & ALIKE != 0 {
                    [u64::from(of_cell(place as u8, what)) * ONES; SIDE]
                } else {
                    band.squares[place as usize].rows(what)
                };
                let mut sum = [0u16; SIDE];
                sum.copy_from_slice(last);
                for (row, to) in rows[own.clone()].iter().zip(&mut after) {
                    sum.iter_mut().zip(row.to_le_bytes()).for_each(|(sum, byte)| *sum += u16::from(byte));
                    to.next().into_iter().for_each(|to| to.copy_from_slice(&sum));
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

/// Adds to `sums`, a number for each of its columns, what a few rows of squares hold in the n-th square of each.
fn add_up(few: &[Layer], n: usize, what: What, sums: &mut [u32; SIDE]) {
    let bytes: u64 = few.iter().map(|layer| layer.add_up(n, what)).sum();
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
        let square = &self.squares[place as usize];
        if matches!(what, What::Blocked) && 2 * (to - from) > SIDE {
            // Mostly all rows are asked, and of others what is not asked is less.
            return square.whole - square.add_up(what, 0..from) - square.add_up(what, to..SIDE);
        }
        square.add_up(what, from..to)
    }
}

impl Band {
    /// From its rows of cells.
    pub fn new(width: usize, cells: &[u8]) -> Self {
        let across = width.div_ceil(SIDE);
        let mut made = Self { places: Vec::with_capacity(across * BAND), squares: Vec::new() };
        let mut bars = vec![0; cells.len()];
        bars.chunks_mut(width).zip(cells.chunks(width)).for_each(|(bars, row)| barred(row, bars));
        for (cells, barred) in cells.chunks(SIDE * width).zip(bars.chunks(SIDE * width)) {
            for from in (0..width).step_by(SIDE) {
                // What lies beyond the borders is like what lies on them.
                let byte = |list: &[u8], row: usize, n: usize| {
                    list[row.min(list.len() / width - 1) * width + (from + n).min(width - 1)]
                };
                let (mut own, mut bars) = ([0u64; SIDE], [0u8; SIDE]);
                for row in 0..SIDE {
                    for n in 0..SIDE {
                        own[row] |= u64::from(byte(cells, row, n)) << (8 * n);
                        bars[row] |= byte(barred, row, n) << n;
                    }
                }
                let first = own[0] as u8;
                let is_barred = if of_cell(first, What::Barred) == 1 { 255 } else { 0 };
                let alike = own == [u64::from(first) * ONES; SIDE] && bars == [is_barred; SIDE];
                made.places.push(if alike { ALIKE | u32::from(first) } else { made.squares.len() as u32 });
                if !alike {
                    made.squares.push(Square::new(own, bars));
                }
            }
        }
        made.squares.shrink_to_fit();
        made
    }
}

fn of_cell(cell: u8, what: What) -> u8 {
    match what {
        What::Blocked => cell & 15,
        What::Occupied => cell >> 4,
        What::Barred => u8::from(cell >> 4 != 0),
    }
}

/// A byte for each bit.
fn spread(bits: u8) -> u64 {
    let apart = (u64::from(bits) * ONES) & 0x8040_2010_0804_0201;
    (apart + 0x7f * ONES) >> 7 & ONES
}
