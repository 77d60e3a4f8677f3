//! The cells of a view as sums of all rows before: of any rows the sums are one row less another. A sum is held in a byte,
//! whatever it comes to: what it is less another is right up to 255, and more rows than have so much are asked in parts.

use super::sums::{Told, What, barred};
use crate::bits::{Bits, WORD, lowest, word_where};
use std::ops::Range;

/// The part of a view in which something was seen; beyond it all samples are blocked, and nothing stands.
#[derive(Clone, Default)]
pub struct Part {
    pub columns: Range<usize>,
    pub rows: Range<usize>,
}

/// For each thing that is asked, row after row of the part seen the sums of all rows before: a row of nothing, the
/// first row, the first two, and so on; and what is told of each row.
#[derive(Default)]
pub struct Summed {
    part: Part,
    /// Of a cell.
    samples: u16,
    /// With a word more than there are sums: a whole one is read from any.
    sums: [Vec<u8>; 3],
    pub told: Vec<Told>,
}

impl Summed {
    /// From what makes the cells of any row of a part, a byte each; of so many samples to a cell.
    pub fn new(part: Part, samples: u16, keyed: bool, make: impl Fn(usize, &mut [u8])) -> Self {
        let width = part.columns.len();
        let room = || {
            let mut sums = Vec::with_capacity((part.rows.len() + 1) * width + WORD);
            sums.resize(width, 0);
            sums
        };
        let (sums, told) = (std::array::from_fn(|_| room()), Vec::with_capacity(part.rows.len()));
        let mut made = Self { part, samples, sums, told };
        let (mut row, mut bars) = (vec![0; width], vec![0; width]);
        let mut last = [(); 3].map(|()| vec![0; width]);
        for n in made.part.rows.clone() {
            make(n, &mut row);
            barred(&row, &mut bars);
            made.told.push(Told::new(&row, keyed));
            let [blocked, occupied, barred] = &mut last;
            add(blocked, &row, |cell| cell & 15);
            add(occupied, &row, |cell| cell >> 4);
            add(barred, &bars, |cell| cell);
            made.sums.iter_mut().zip(&last).for_each(|(sums, last)| sums.extend_from_slice(last));
        }
        made.sums.iter_mut().for_each(|sums| sums.resize(sums.len() + WORD, 0));
        made
    }

    /// Of so many columns and some rows, of so many samples to a cell, without what is told of them; `add` puts in all sums,
    /// a row of nothing first, in place of what is there.
    pub fn of_rows(
        width: usize,
        samples: u16,
        rows: Range<usize>,
        what: &[What],
        room: Self,
        add: impl Fn(What, &mut [u8]),
    ) -> Self {
        let mut sums = room.sums;
        for (n, of) in sums.iter_mut().enumerate() {
            let Some(&what) = what.iter().find(|what| **what as usize == n) else {
                of.clear();
                continue;
            };
            let own = (rows.len() + 1) * width;
            of.resize(own + WORD, 0);
            add(what, &mut of[..own]);
        }
        Self { part: Part { columns: 0..width, rows }, samples, sums, told: Vec::new() }
    }

    /// True when it has the sums of some rows.
    pub fn holds(&self, what: What, rows: Range<usize>) -> bool {
        let own = &self.part.rows;
        !self.sums[what as usize].is_empty() && own.start <= rows.start && rows.end <= own.end
    }

    /// With the rows that follow.
    pub fn extend(&mut self, more: Self) {
        let width = self.part.columns.len();
        for (sums, more) in self.sums.iter_mut().zip(more.sums) {
            sums.truncate(sums.len() - WORD);
            let before = sums[sums.len() - width..].to_vec();
            for row in more[width..more.len() - WORD].chunks(width) {
                sums.extend(row.iter().zip(&before).map(|(own, before)| own.wrapping_add(*before)));
            }
            sums.resize(sums.len() + WORD, 0);
        }
        self.part.rows.end = more.part.rows.end;
        self.told.extend(more.told);
    }

    /// The rows from one to before another.
    pub fn rows(&self, what: What, from: usize, to: usize) -> SummedRows<'_> {
        let Part { columns, rows } = &self.part;
        let row = |n: usize| &self.sums[what as usize][(n - rows.start) * columns.len()..][..columns.len() + WORD];
        let inside = from.clamp(rows.start, rows.end)..to.clamp(rows.start, rows.end);
        // Beyond the part seen each cell has this.
        let each = if matches!(what, What::Blocked) { self.samples } else { 0 };
        let most = if matches!(what, What::Barred) { 1 } else { self.samples };
        let (mut first, mut more) = (Difference { below: row(inside.start), above: row(inside.end) }, Vec::new());
        if inside.len() * usize::from(most) > usize::from(u8::MAX) {
            let few = usize::from(u8::MAX) / usize::from(most);
            let part = |from: usize| Difference { below: row(from), above: row(inside.end.min(from + few)) };
            let mut parts = inside.clone().step_by(few).map(part);
            first = parts.next().unwrap_or(first);
            more.extend(parts);
        }
        SummedRows {
            first,
            more,
            columns: columns.clone(),
            besides: (to - from - inside.len()) as u16 * each,
            beyond: (to - from) as u16 * each,
        }
    }
}

/// Adds a part of each cell of a row.
fn add(sums: &mut [u8], row: &[u8], part: impl Fn(u8) -> u8) {
    sums.iter_mut().zip(row).for_each(|(sum, &cell)| *sum = sum.wrapping_add(part(cell)));
}

/// The sums before some rows and behind them, of rows that have no more than a byte holds.
struct Difference<'a> {
    below: &'a [u8],
    above: &'a [u8],
}

impl Difference<'_> {
    fn sums(&self, columns: Range<usize>) -> impl ExactSizeIterator<Item = u8> {
        let sums = self.above[columns.clone()].iter().zip(&self.below[columns]);
        sums.map(|(above, below)| above.wrapping_sub(*below))
    }

    /// The same of a whole word of columns from one on; what lies beyond the last is anything.
    #[inline]
    fn word(&self, column: usize) -> [u8; WORD] {
        let mut sums = [0; WORD];
        let rows = self.above[column..][..WORD].iter().zip(&self.below[column..][..WORD]);
        sums.iter_mut().zip(rows).for_each(|(sum, (above, below))| *sum = above.wrapping_sub(*below));
        sums
    }
}

/// How often a sum is as large as one that is asked for.
const SELDOM: bool = true;
const OFTEN: bool = false;

/// Some rows of them.
pub struct SummedRows<'a> {
    /// Mostly the first is all.
    first: Difference<'a>,
    more: Vec<Difference<'a>>,
    /// The columns of the part seen.
    columns: Range<usize>,
    /// What these columns have besides, of rows beyond the part, and what the columns beyond it have.
    besides: u16,
    beyond: u16,
}

impl SummedRows<'_> {
    pub fn at(&self, column: usize) -> u32 {
        if !self.columns.contains(&column) {
            return self.beyond.into();
        }
        let n = column - self.columns.start;
        let all = std::iter::once(&self.first).chain(&self.more);
        all.map(|rows| u32::from(rows.above[n].wrapping_sub(rows.below[n]))).sum::<u32>() + u32::from(self.besides)
    }

    /// The first of some columns whose sum is as large as that.
    pub fn first(&self, columns: Range<usize>, least: u32) -> Option<usize> {
        let [before, seen, after] = self.split(&columns);
        let beyond = |columns: &Range<usize>| self.beyond(least) && !columns.is_empty();
        let within = || {
            seen.clone().step_by(WORD).find_map(|from| {
                let word = self.word::<SELDOM>(from..seen.end.min(from + WORD), least);
                (word != 0).then(|| from + word.trailing_zeros() as usize)
            })
        };
        beyond(&before).then_some(before.start).or_else(within).or_else(|| beyond(&after).then_some(after.start))
    }

    /// The last of some columns whose sum is as large as that.
    pub fn last(&self, columns: Range<usize>, least: u32) -> Option<usize> {
        let [before, seen, after] = self.split(&columns);
        let beyond = |columns: &Range<usize>| (self.beyond(least) && !columns.is_empty()).then(|| columns.end - 1);
        let within = || {
            // From the far end, many at a time.
            let mut end = seen.end;
            while end > seen.start {
                let from = seen.start.max(end.saturating_sub(WORD));
                let word = self.word::<SELDOM>(from..end, least);
                if word != 0 {
                    return Some(from + word.ilog2() as usize);
                }
                end = from;
            }
            None
        };
        beyond(&after).or_else(within).or_else(|| beyond(&before))
    }

    /// Which of some columns have a sum as large as that.
    pub fn reached(&self, columns: &Range<usize>, least: u32) -> Bits {
        let [before, seen, after] = self.split(columns);
        let words = |from: usize| self.word::<OFTEN>(from..seen.end.min(from + WORD), least);
        // Mostly all of them were seen.
        if seen.len() == columns.len() {
            return Bits::of_words(columns.len(), seen.clone().step_by(WORD).map(words));
        }
        let mut reached = Bits::new(columns.len());
        let place = |column: usize| column - columns.start;
        if self.beyond(least) {
            for beside in [before, after] {
                reached.fill(place(beside.start)..place(beside.end));
            }
        }
        for from in seen.clone().step_by(WORD) {
            reached.add(place(from), words(from));
        }
        reached
    }

    /// The sums over them of some columns.
    pub fn over(&self, columns: &Range<usize>) -> Vec<u32> {
        let [before, seen, after] = self.split(columns);
        let mut all = Vec::with_capacity(columns.len());
        all.resize(before.len(), self.beyond.into());
        // None of them may be in the part seen, and then they are anywhere.
        let first = self.columns.start;
        let seen = if seen.is_empty() { 0..0 } else { seen.start - first..seen.end - first };
        all.extend(self.first.sums(seen.clone()).map(|sum| u32::from(sum) + u32::from(self.besides)));
        for more in &self.more {
            let sums = all[before.len()..].iter_mut().zip(more.sums(seen.clone()));
            sums.for_each(|(sum, more)| *sum += u32::from(more));
        }
        all.resize(all.len() + after.len(), self.beyond.into());
        all
    }

    /// Which of up to a word of columns of the part seen have a sum as large as that; where mostly none has, that is asked
    /// first.
    #[inline]
    fn word<const IS_SELDOM: bool>(&self, seen: Range<usize>, least: u32) -> u64 {
        let column = seen.start - self.columns.start;
        let least = least.saturating_sub(self.besides.into());
        let word = if self.more.is_empty() {
            let Ok(least) = u8::try_from(least) else { return 0 };
            let sums = self.first.word(column);
            if IS_SELDOM && sums.iter().copied().fold(0, u8::max) < least {
                return 0;
            }
            word_where(sums.iter().map(|sum| *sum >= least))
        } else {
            self.word_of_all(column, least)
        };
        word & lowest(seen.len())
    }

    /// The same of a whole word, of rows in several parts.
    #[inline(never)]
    fn word_of_all(&self, column: usize, least: u32) -> u64 {
        let mut sums = self.first.word(column).map(u16::from);
        for rows in &self.more {
            sums.iter_mut().zip(rows.word(column)).for_each(|(sum, more)| *sum += u16::from(more));
        }
        word_where(sums.iter().map(|sum| u32::from(*sum) >= least))
    }

    /// True when columns beyond the part seen have a sum as large as that.
    fn beyond(&self, least: u32) -> bool {
        u32::from(self.beyond) >= least
    }

    /// Those of some columns that lie before the part seen, in it, and after it.
    fn split(&self, columns: &Range<usize>) -> [Range<usize>; 3] {
        let place = |n: usize| n.clamp(columns.start, columns.end.max(columns.start));
        let [from, to] = [place(self.columns.start), place(self.columns.end)];
        [columns.start..from, from..to, to..columns.end]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A view of 40 by 200 cells of which 12 by 186 were seen, too many for one byte; something stands in some of those.
    fn summed(part: Part) -> Summed {
        let first = part.columns.start;
        Summed::new(part, 4, true, move |row, cells| {
            for (column, cell) in (first..).zip(cells) {
                let seen = (14..26).contains(&column) && (7..193).contains(&row);
                *cell = if seen { [0, 1, 0x33][(5 * column + row) % 3] } else { 4 };
            }
        })
    }

    #[test]
    fn what_is_kept_of_a_view_answers_as_the_whole_does() {
        let whole = summed(Part { columns: 0..40, rows: 0..200 });
        let mut kept = summed(Part { columns: 12..28, rows: 5..90 });
        kept.extend(summed(Part { columns: 12..28, rows: 90..195 }));
        for what in [What::Blocked, What::Occupied, What::Barred] {
            for (from, to) in [(0, 200), (0, 3), (2, 9), (6, 100), (8, 8), (80, 180), (196, 200)] {
                let [all, some] = [&whole, &kept].map(|summed| summed.rows(what, from, to));
                assert!((0..40).all(|column| all.at(column) == some.at(column)));
                for (start, end) in [(0, 40), (0, 5), (3, 20), (13, 14), (20, 35), (30, 40), (9, 9)] {
                    let columns = start..end;
                    assert_eq!(all.over(&columns), some.over(&columns));
                    for least in [0, 1, 5, 12, 24, 80, 200, 300, 100_000] {
                        let [all, some] = [&all, &some].map(|rows| rows.reached(&columns, least));
                        assert!((0..columns.len()).all(|n| all.get(n) == some.get(n)));
                    }
                    for least in [0, 1, 5, 12, 24, 80, 200, 300, 100_000] {
                        assert_eq!(all.first(columns.clone(), least), some.first(columns.clone(), least));
                        assert_eq!(all.last(columns.clone(), least), some.last(columns.clone(), least));
                    }
                }
            }
        }
    }
}
