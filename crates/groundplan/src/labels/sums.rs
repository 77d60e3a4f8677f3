//! The cells of a view as sums: of how many samples, or cells, of a column something is true between any two places
//! across.
//!
//! A view of few cells keeps its sums from the first row on. One of many keeps squares of cells.

use super::recall::Key;
use super::squares::{Band, SquaredRows};
use super::summed::{Part, Summed, SummedRows};
use crate::bands::map_bands;
use std::ops::Range;

/// What is asked of a cell.
#[derive(Clone, Copy)]
pub enum What {
    /// Samples that are not free.
    Blocked,
    /// Samples that are occupied.
    Occupied,
    /// The cell itself: something stands in it or in the ones beside it.
    Barred,
}

/// Views of more cells than this keep squares.
const MANY: usize = 1 << 23;
/// A cell has so many samples at most.
const SAMPLES: usize = 9;

/// The cells of a view.
pub enum Cells {
    Summed(Summed),
    /// Bands of rows of squares.
    Squared {
        width: usize,
        bands: Vec<Band>,
    },
}

/// A row of cells as a whole; it has a key where keys are asked for.
#[derive(Clone, Copy, Default)]
pub struct Told {
    pub key: Key,
    /// Occupied samples.
    pub occupied: u64,
}

impl Told {
    pub fn new(row: &[u8], keyed: bool) -> Self {
        let key = if keyed { Key::default().bytes(row) } else { Key::default() };
        // In chunks whose sums fit in what adds up fastest.
        let occupied = |cells: &[u8]| cells.iter().map(|cell| u32::from(cell >> 4)).sum::<u32>();
        Self { key, occupied: row.chunks(1 << 16).map(|cells| u64::from(occupied(cells))).sum() }
    }
}

impl Default for Cells {
    fn default() -> Self {
        Self::Squared { width: 0, bands: Vec::new() }
    }
}

impl Cells {
    /// From what makes the cells of any row, a byte each, from some column on: of a view of so many cells along and
    /// across, with so many samples to a cell, in a part of which something was seen; and what is told of each row.
    pub fn new(
        [width, height]: [usize; 2],
        samples: u16,
        seen: Part,
        keyed: bool,
        threads: usize,
        make: impl Fn(usize, usize, &mut [u8]) + Sync,
    ) -> (Self, Vec<Told>) {
        if width * height > MANY || height > usize::from(u16::MAX) / SAMPLES {
            let made = map_bands(height, threads, |band| {
                let mut cells = vec![0u8; band.len() * width];
                cells.chunks_mut(width).zip(band).for_each(|(row, n)| make(n, 0, row));
                let told: Vec<Told> = cells.chunks(width).map(|row| Told::new(row, keyed)).collect();
                (Band::new(width, &cells), told)
            });
            let (bands, told): (_, Vec<_>) = made.into_iter().unzip();
            return (Self::Squared { width, bands }, told.concat());
        }
        // Where keys are asked for, they are of whole rows.
        let seen = if keyed || seen.columns.is_empty() { Part { columns: 0..width, rows: 0..height } } else { seen };
        let Part { columns, rows } = seen;
        let summed = |band: Range<usize>| {
            let part = Part { columns: columns.clone(), rows: rows.start + band.start..rows.start + band.end };
            Summed::new(part, samples, keyed, |n, row| make(n, columns.start, row))
        };
        // Without threads one band, which nothing need be put to.
        let parts = if threads <= 1 { vec![summed(0..rows.len())] } else { map_bands(rows.len(), threads, summed) };
        let mut parts = parts.into_iter();
        let mut all = parts.next().unwrap_or_default();
        parts.for_each(|part| all.extend(part));
        let mut told = vec![Told::default(); rows.start];
        told.append(&mut all.told);
        told.resize(height, Told::default());
        (Self::Summed(all), told)
    }

    /// The rows from one to before another.
    pub fn rows(&self, what: What, from: usize, to: usize) -> Rows<'_> {
        match self {
            Self::Summed(summed) => Rows::Summed(summed.rows(what, from, to)),
            Self::Squared { width, bands } => Rows::Squared(SquaredRows::new(bands, *width, what, from, to)),
        }
    }
}

/// Some rows of cells.
pub enum Rows<'a> {
    Summed(SummedRows<'a>),
    Squared(SquaredRows<'a>),
}

impl Rows<'_> {
    /// The sum over them of one column.
    pub fn at(&self, column: usize) -> u32 {
        match self {
            Self::Summed(rows) => rows.at(column),
            Self::Squared(rows) => rows.at(column),
        }
    }

    /// The first of some columns whose sum is as large as that.
    pub fn first(&self, columns: Range<usize>, least: u32) -> Option<usize> {
        match self {
            Self::Summed(rows) => rows.first(columns, least),
            Self::Squared(rows) => rows.first(&columns, least),
        }
    }

    /// The last of some columns whose sum is as large as that.
    pub fn last(&self, columns: Range<usize>, least: u32) -> Option<usize> {
        match self {
            Self::Summed(rows) => rows.last(columns, least),
            Self::Squared(rows) => rows.last(&columns, least),
        }
    }

    /// Which of some columns have a sum as large as that.
    pub fn reached(&self, columns: Range<usize>, least: u32) -> Vec<bool> {
        match self {
            Self::Summed(rows) => rows.reached(&columns, least),
            Self::Squared(rows) => rows.over(&columns).into_iter().map(|sum| sum >= least).collect(),
        }
    }

    /// The sums over them of some columns.
    pub fn over(&self, columns: Range<usize>) -> Vec<u32> {
        match self {
            Self::Summed(rows) => rows.over(&columns),
            Self::Squared(rows) => rows.over(&columns),
        }
    }
}

/// In which cells something stands, or beside which along their row: a wall one pixel thick, or not quite square to the
/// columns, shows in two or three of them.
pub fn barred(row: &[u8], barred: &mut [u8]) {
    barred.iter_mut().zip(row).for_each(|(to, cell)| *to = cell >> 4);
    barred.iter_mut().zip(&row[1..]).for_each(|(to, next)| *to |= next >> 4);
    barred[1..].iter_mut().zip(row).for_each(|(to, before)| *to |= before >> 4);
    for to in barred {
        *to = u8::from(*to != 0);
    }
}
