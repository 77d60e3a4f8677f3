//! The cells of a view as sums of all rows before: of any rows the sums are one row less another.

use super::sums::{Told, What, barred};
use crate::bits::{Bits, WORD, word_where};
use std::ops::Range;

/// So many sums are compared together.
const TOGETHER: usize = 32;

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
    sums: [Vec<u16>; 3],
    pub told: Vec<Told>,
}

impl Summed {
    /// From what makes the cells of any row of a part, a byte each; of so many samples to a cell.
    pub fn new(part: Part, samples: u16, keyed: bool, make: impl Fn(usize, &mut [u8])) -> Self {
        let width = part.columns.len();
        let room = || {
            let mut sums = Vec::with_capacity((part.rows.len() + 1) * width);
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
        made
    }

    /// Of so many columns and some rows, without what is told of them; `add` puts in all sums, a row of nothing first, in
    /// place of what is there.
    pub fn of_rows(
        width: usize,
        rows: Range<usize>,
        what: &[What],
        room: Self,
        add: impl Fn(What, &mut [u16]),
    ) -> Self {
        let mut sums = room.sums;
        for (n, of) in sums.iter_mut().enumerate() {
            let Some(&what) = what.iter().find(|what| **what as usize == n) else {
                of.clear();
                continue;
            };
            of.resize((rows.len() + 1) * width, 0);
            add(what, of);
        }
        Self { part: Part { columns: 0..width, rows }, samples: 0, sums, told: Vec::new() }
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
            let before = sums[sums.len() - width..].to_vec();
            for row in more[width..].chunks(width) {
                sums.extend(row.iter().zip(&before).map(|(own, before)| own + before));
            }
        }
        self.part.rows.end = more.part.rows.end;
        self.told.extend(more.told);
    }

    /// The rows from one to before another.
    pub fn rows(&self, what: What, from: usize, to: usize) -> SummedRows<'_> {
        let Part { columns, rows } = &self.part;
        let row = |n: usize| &self.sums[what as usize][(n - rows.start) * columns.len()..][..columns.len()];
        let inside = from.clamp(rows.start, rows.end)..to.clamp(rows.start, rows.end);
        // Beyond the part seen each cell has this.
        let each = if matches!(what, What::Blocked) { self.samples } else { 0 };
        SummedRows {
            below: row(inside.start),
            above: row(inside.end),
            columns: columns.clone(),
            besides: (to - from - inside.len()) as u16 * each,
            beyond: (to - from) as u16 * each,
        }
    }
}

/// Adds a part of each cell of a row.
fn add(sums: &mut [u16], row: &[u8], part: impl Fn(u8) -> u8) {
    sums.iter_mut().zip(row).for_each(|(sum, &cell)| *sum += u16::from(part(cell)));
}

/// Some rows of them.
pub struct SummedRows<'a> {
    below: &'a [u16],
    above: &'a [u16],
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
        u32::from(self.above[n] - self.below[n] + self.besides)
    }

    /// The first of some columns whose sum is as large as that.
    pub fn first(&self, columns: Range<usize>, least: u32) -> Option<usize> {
        let least = u16::try_from(least).ok()?;
        let [before, seen, after] = self.split(&columns);
        let beyond = |columns: &Range<usize>| (self.beyond >= least && !columns.is_empty()).then_some(columns.start);
        let within = || {
            seen.clone().step_by(TOGETHER).find_map(|from| {
                let some = from..seen.end.min(from + TOGETHER);
                let sums = self.sums(&some);
                (sums.clone().fold(0, u16::max) >= least)
                    .then(|| sums.clone().position(|sum| sum >= least).map_or(from, |n| from + n))
            })
        };
        beyond(&before).or_else(within).or_else(|| beyond(&after))
    }

    /// The last of some columns whose sum is as large as that.
    pub fn last(&self, columns: Range<usize>, least: u32) -> Option<usize> {
        let least = u16::try_from(least).ok()?;
        let [before, seen, after] = self.split(&columns);
        let beyond = |columns: &Range<usize>| (self.beyond >= least && !columns.is_empty()).then(|| columns.end - 1);
        let within = || {
            // From the far end, many at a time.
            let mut end = seen.end;
            while end > seen.start {
                let some = seen.start.max(end.saturating_sub(TOGETHER))..end;
                let sums = self.sums(&some);
                if sums.clone().fold(0, u16::max) >= least {
                    return sums.clone().rposition(|sum| sum >= least).map(|n| some.start + n);
                }
                end = some.start;
            }
            None
        };
        beyond(&after).or_else(within).or_else(|| beyond(&before))
    }

    /// Which of some columns have a sum as large as that.
    pub fn reached(&self, columns: &Range<usize>, least: u32) -> Bits {
        let mut reached = Bits::new(columns.len());
        let Ok(least) = u16::try_from(least) else { return reached };
        let [before, seen, after] = self.split(columns);
        let place = |column: usize| column - columns.start;
        if self.beyond >= least {
            for beside in [before, after] {
                reached.fill(place(beside.start)..place(beside.end));
            }
        }
        for from in seen.clone().step_by(WORD) {
            let some = from..seen.end.min(from + WORD);
            reached.add(place(from), word_where(self.sums(&some).map(|sum| sum >= least)));
        }
        reached
    }

    /// The sums over them of some columns.
    pub fn over(&self, columns: &Range<usize>) -> Vec<u32> {
        let [before, seen, after] = self.split(columns);
        let mut all = Vec::with_capacity(columns.len());
        all.resize(before.len(), self.beyond.into());
        all.extend(self.sums(&seen).map(u32::from));
        all.resize(all.len() + after.len(), self.beyond.into());
        all
    }

    /// Of columns of the part seen.
    fn sums(&self, seen: &Range<usize>) -> impl ExactSizeIterator<Item = u16> + DoubleEndedIterator + Clone {
        // None of them may be in it, and then they are anywhere.
        let first = self.columns.start;
        let part = if seen.is_empty() { 0..0 } else { seen.start - first..seen.end - first };
        let besides = self.besides;
        let sums = self.above[part.clone()].iter().zip(&self.below[part]);
        sums.map(move |(above, below)| above - below + besides)
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

    /// A view of 40 by 20 cells of which 12 by 6 were seen; something stands in some of those.
    fn summed(part: Part) -> Summed {
        let first = part.columns.start;
        Summed::new(part, 4, true, move |row, cells| {
            for (column, cell) in (first..).zip(cells) {
                let seen = (14..26).contains(&column) && (7..13).contains(&row);
                *cell = if seen { [0, 1, 0x33][(5 * column + row) % 3] } else { 4 };
            }
        })
    }

    #[test]
    fn what_is_kept_of_a_view_answers_as_the_whole_does() {
        let whole = summed(Part { columns: 0..40, rows: 0..20 });
        let mut kept = summed(Part { columns: 12..28, rows: 5..9 });
        kept.extend(summed(Part { columns: 12..28, rows: 9..15 }));
        for what in [What::Blocked, What::Occupied, What::Barred] {
            for (from, to) in [(0, 20), (0, 3), (2, 9), (6, 10), (8, 8), (12, 19), (16, 20)] {
                let [all, some] = [&whole, &kept].map(|summed| summed.rows(what, from, to));
                assert!((0..40).all(|column| all.at(column) == some.at(column)));
                for (start, end) in [(0, 40), (0, 5), (3, 20), (13, 14), (20, 35), (30, 40), (9, 9)] {
                    let columns = start..end;
                    assert_eq!(all.over(&columns), some.over(&columns));
                    for least in [0, 1, 5, 12, 24, 80, 100_000] {
                        let [all, some] = [&all, &some].map(|rows| rows.reached(&columns, least));
                        assert!((0..columns.len()).all(|n| all.get(n) == some.get(n)));
                    }
                    for least in [0, 1, 5, 12, 24, 80, 100_000] {
                        assert_eq!(all.first(columns.clone(), least), some.first(columns.clone(), least));
                        assert_eq!(all.last(columns.clone(), least), some.last(columns.clone(), least));
                    }
                }
            }
        }
    }
}
