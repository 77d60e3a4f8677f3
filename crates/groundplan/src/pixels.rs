//! Columns and rows of many pixels, in about a quarter of the room that two numbers take.

use std::ops::Range;

/// Columns are told apart by so many bits within a run.
const BITS: u32 = 16;

/// Pixels in any order, as runs of one row: those of an edge come row after row.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pixels {
    runs: Vec<Run>,
    /// The low bits of each pixel's column.
    columns: Vec<u16>,
}

/// Pixels one after another that are of one row and whose columns have the same high bits.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Run {
    row: u32,
    high: u32,
    /// Where it begins in the list.
    start: usize,
}

impl Pixels {
    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// True where there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// One more.
    pub fn push(&mut self, pixel: [u32; 2]) {
        self.extend([pixel]);
    }

    /// Column and row of each, in their order; quickest by what takes them all, such as `for_each`.
    pub fn iter(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.runs().flat_map(|(_, pixels)| pixels)
    }

    /// The places in the list of those of a row one after another, and column and row of each.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (Range<usize>, impl Iterator<Item = [u32; 2]> + '_)> + '_ {
        let ends = self.runs.iter().skip(1).map(|run| run.start).chain([self.columns.len()]);
        self.runs.iter().zip(ends).map(|(&Run { row, high, start }, end)| {
            let columns = &self.columns[start..end];
            (start..end, columns.iter().map(move |&low| [high << BITS | u32::from(low), row]))
        })
    }
}

impl Extend<[u32; 2]> for Pixels {
    fn extend<T: IntoIterator<Item = [u32; 2]>>(&mut self, pixels: T) {
        let Self { runs, columns } = self;
        let mut last = runs.last().map(|run| (run.row, run.high));
        let count = columns.len();
        let column = |(n, [x, row]): (usize, [u32; 2])| {
            let high = x >> BITS;
            if last != Some((row, high)) {
                last = Some((row, high));
                runs.push(Run { row, high, start: count + n });
            }
            x as u16
        };
        columns.extend(pixels.into_iter().enumerate().map(column));
    }
}

impl FromIterator<[u32; 2]> for Pixels {
    fn from_iter<T: IntoIterator<Item = [u32; 2]>>(pixels: T) -> Self {
        let mut made = Self::default();
        made.extend(pixels);
        made
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_come_out_as_they_went_in() {
        // Of wide maps too, and in any order.
        let all = [[3, 0], [70_000, 0], [70_001, 0], [9, 4], [65_535, 4], [65_536, 4], [2, 1], [2, 1], [u32::MAX, 7]];
        let made: Pixels = all.into_iter().collect();
        assert_eq!(made.iter().collect::<Vec<_>>(), all);
        assert_eq!((made.len(), made.is_empty()), (all.len(), false));
        assert_eq!(Pixels::default().iter().count(), 0);
    }
}
