//! The cells of a view as sums: of how many samples, or cells, of a column something is true between any two places
//! across.
//!
//! A view of few cells keeps its sums from the first row on. One of many keeps squares of cells, and where it is gone over
//! from row to row the sums of some rows for as long as they are asked.

use super::squares::{self, Band, SquaredRows};
use super::summed::{Part, Summed, SummedRows};
use crate::bands::{BAND_ROWS, band_rows, map_bands, map_bands_in, worth};
use crate::bits::Bits;
use crate::labels::recall::{Key, Recall};
use std::ops::Range;
use std::sync::Arc;

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

/// Whether so many cells along and across are kept in squares.
pub fn are_many([width, height]: [usize; 2]) -> bool {
    width * height > MANY || height > usize::from(u16::MAX) / SAMPLES
}

/// The cells of a view.
pub enum Cells {
    Summed(Summed),
    /// Bands of rows of squares, and the sums of some rows.
    Squared {
        width: usize,
        samples: u16,
        bands: Arc<Vec<Arc<Band>>>,
        near: Summed,
    },
}

/// A row of cells as a whole; it has a key where keys are asked for.
#[derive(Clone, Copy, Debug, Default)]
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
        Self::Squared { width: 0, samples: 0, bands: Arc::default(), near: Summed::default() }
    }
}

/// Bands of a large view that another has seen as it will, and what is told of all of that one's rows.
#[derive(Default)]
pub struct Known {
    bands: Vec<Option<Arc<Band>>>,
    told: Arc<Vec<Told>>,
}

impl Known {
    /// Those of some cells for which it is so of their rows.
    pub fn of(cells: &Cells, told: &Arc<Vec<Told>>, is_so: impl Fn(Range<usize>) -> bool) -> Self {
        let Cells::Squared { bands, .. } = cells else { return Self::default() };
        let band = |(n, band): (usize, &Arc<Band>)| is_so(band_rows(n, told.len())).then(|| Arc::clone(band));
        Self { bands: bands.iter().enumerate().map(band).collect(), told: Arc::clone(told) }
    }

    fn band(&self, rows: Range<usize>) -> Option<(Arc<Band>, Vec<Told>)> {
        let band = self.bands.get(rows.start / BAND_ROWS)?.as_ref()?;
        Some((Arc::clone(band), self.told[rows].to_vec()))
    }
}

/// What cells are made from.
pub struct Source<'k, M, K> {
    /// Makes the cells of some rows, a byte each, from some column on.
    pub make: M,
    /// The key of all that the cells of some rows are made from.
    pub key: K,
    pub known: &'k Known,
}

impl Cells {
    /// From what makes the cells of any row: of a view of so many cells along and across, with so many samples to a cell,
    /// in a part of which something was seen; and what is told of each row.
    pub fn new<M, K>(
        [width, height]: [usize; 2],
        samples: u16,
        seen: Part,
        Source { make, key, known }: Source<M, K>,
        recall: &Recall,
        threads: usize,
    ) -> (Self, Vec<Told>)
    where
        M: Fn(Range<usize>, usize, &mut [u8]) + Sync,
        K: Fn(Range<usize>) -> Key + Sync,
    {
        let keyed = recall.keeps();
        if are_many([width, height]) {
            let made = map_bands_in([width, height], threads, |(cells, squares): &mut (Vec<u8>, _), band| {
                recall.views.or_find(
                    || key(band.clone()),
                    || {
                        if let Some(known) = known.band(band.clone()) {
                            return known;
                        }
                        cells.resize(band.len() * width, 0);
                        make(band.clone(), 0, cells);
                        let told: Vec<Told> = cells.chunks(width).map(|row| Told::new(row, keyed)).collect();
                        (Arc::new(Band::new(width, cells, squares)), told)
                    },
                )
            });
            let (bands, told): (_, Vec<_>) = made.into_iter().unzip();
            return (Self::Squared { width, samples, bands: Arc::new(bands), near: Summed::default() }, told.concat());
        }
        // Where keys are asked for, they are of whole rows.
        let seen = if keyed || seen.columns.is_empty() { Part { columns: 0..width, rows: 0..height } } else { seen };
        let Part { columns, rows } = seen;
        let summed = |band: Range<usize>| {
            let part = Part { columns: columns.clone(), rows: rows.start + band.start..rows.start + band.end };
            Summed::new(part, samples, keyed, |n, row| make(n..n + 1, columns.start, row))
        };
        // Without threads one band, which nothing need be put to.
        let size = [columns.len(), rows.len()];
        let is_one = worth(size[0] * size[1], threads) == 1;
        let parts = if is_one { vec![summed(0..rows.len())] } else { map_bands(size, threads, summed) };
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
            Self::Squared { near, .. } if near.holds(what, from..to) => Rows::Summed(near.rows(what, from, to)),
            Self::Squared { width, bands, .. } => Rows::Squared(SquaredRows::new(bands, *width, what, from, to)),
        }
    }

    /// Squares with the sums of some rows, of what will be asked of them; they take the room of others.
    pub fn near(&self, what: &[What], rows: Range<usize>, room: Summed) -> Option<Self> {
        let &Self::Squared { width, samples, ref bands, .. } = self else { return None };
        let near = squares::sums(bands, width, samples, what, rows, room);
        Some(Self::Squared { width, samples, bands: Arc::clone(bands), near })
    }

    /// The sums of some rows that there are beside squares.
    pub fn into_near(self) -> Summed {
        match self {
            Self::Summed(_) => Summed::default(),
            Self::Squared { near, .. } => near,
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

    /// Which of some columns have a sum as large as that; the first of them is the first bit.
    pub fn reached(&self, columns: Range<usize>, least: u32) -> Bits {
        match self {
            Self::Summed(rows) => rows.reached(&columns, least),
            Self::Squared(rows) => rows.reached(&columns, least),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_laid_out_answer_as_the_squares_they_are_from() {
        // So high that it is kept in squares: stretches that are all alike, and others.
        let (width, height) = (45, 7300);
        let make = |rows: Range<usize>, first: usize, cells: &mut [u8]| {
            let places = rows.flat_map(|row| (first..width).map(move |column| [row, column]));
            for ([row, column], cell) in places.zip(cells) {
                let mixed = (row / 20 + column / 9) % 3 == 0;
                *cell = if mixed { [0, 4, 0x21, 0x44][(row * 7 + column * 5) % 4] } else { 4 };
            }
        };
        let part = Part { columns: 0..width, rows: 0..height };
        let source = Source { make, key: |_| Key::default(), known: &Known::default() };
        let (squared, _) = Cells::new([width, height], 4, part, source, &Recall::default(), 1);
        let asked = [What::Blocked, What::Barred];
        let mut room = Summed::default();
        for rows in [0..130, 61..333, 7170..7300, 505..506] {
            let near = squared.near(&asked, rows.clone(), room).unwrap();
            let ends = [(rows.start, rows.end), (rows.start, rows.start + 1), (rows.end - 1, rows.end)];
            let middle = rows.start.midpoint(rows.end);
            for (from, to) in ends.into_iter().chain([(middle, middle), (rows.start, middle), (middle, rows.end)]) {
                for what in asked {
                    let rows = near.rows(what, from, to);
                    assert!(matches!(rows, Rows::Summed(_)));
                    let others = squared.rows(what, from, to);
                    assert_eq!(rows.over(0..width), others.over(0..width));
                    for (columns, least) in [(0..width, 1), (3..width - 2, 2), (9..9, 0), (11..14, 0), (0..17, 900)] {
                        let [own, other] = [&rows, &others].map(|rows| rows.reached(columns.clone(), least));
                        assert!((0..columns.len()).all(|n| own.get(n) == other.get(n)));
                    }
                }
            }
            // What was not laid out is asked of the squares.
            let others =
                [near.rows(What::Occupied, middle, middle + 1), near.rows(What::Barred, rows.start, rows.end + 1)];
            assert!(rows.end == height || others.iter().all(|rows| matches!(rows, Rows::Squared(_))));
            room = near.into_near();
        }
    }
}
