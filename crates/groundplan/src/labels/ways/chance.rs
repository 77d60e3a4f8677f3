//! How likely it is that chance opens several rows at one place: by how much of each, and of all, is open elsewhere.

use crate::ends::shared;
use crate::labels::rows::Row;
use crate::labels::rows::sections::WIDTH;
use crate::labels::rows::seen::Seen;

/// An opening so much shorter than another is as long, metres.
pub const SLACK: f64 = 0.25;
/// Widths are counted in such steps, metres.
const STEP: f64 = 0.1;

/// Where the rows of a place are open.
pub struct Openings<'a> {
    rows: Vec<&'a Row>,
    /// For each row, across the direction that crosses it.
    open: Vec<Vec<[f64; 2]>>,
    /// For each direction and each width in steps, how many places of its rows are open, and of how many.
    all: Vec<Vec<[f64; 2]>>,
}

impl<'a> Openings<'a> {
    /// Of rows along so many directions.
    pub fn new(directions: usize, rows: &[Seen<'a>]) -> Self {
        let open = rows.iter().map(Seen::open).collect();
        let rows = rows.iter().map(|seen| seen.row).collect();
        let mut made = Self { rows, open, all: vec![Vec::new(); directions] };
        made.count();
        made
    }

    /// Where a row is open, across the direction that crosses it.
    pub fn of(&self, row: usize) -> &[[f64; 2]] {
        &self.open[row]
    }

    /// Takes a way from what is open in its rows.
    pub fn take(&mut self, rows: &[usize], [from, to]: [f64; 2]) {
        for &n in rows {
            let cut = self.open[n].iter().flat_map(|&[a, b]| [[a, b.min(from)], [a.max(to), b]]);
            self.open[n] = cut.filter(|[a, b]| a < b).collect();
        }
    }

    /// Counts the places of all rows anew.
    pub fn count(&mut self) {
        self.all = (0..self.all.len()).map(|direction| self.counts_of_all(direction)).collect();
    }

    /// How likely it is that some rows are open at one place, by how much of each, and of all, is so elsewhere: of each
    /// where not all others are open, for of several ways none speaks against another.
    pub fn chance(&self, rows: &[usize], ends: [f64; 2]) -> f64 {
        let width = ends[1] - ends[0];
        let [free, places] = self.all[self.rows[rows[0]].direction][(width / STEP) as usize];
        let all = self.open_in_all(rows, width);
        let others = rows.iter().map(|n| {
            let others: Vec<usize> = rows.iter().copied().filter(|m| m != n).collect();
            self.open_in_all(&others, width)
        });
        let others: Vec<f64> = others.collect();
        let (own, left) = (rows.len() as f64 * all, others.iter().sum::<f64>());
        let common = ((free - own).max(0.0) + 0.5) / ((places - left).max(0.0) + 1.0);
        let chance = |(&n, others): (&usize, &f64)| {
            let [free, places] = self.counts(n, width);
            common.max(((free - all).max(0.0) / (places - others).max(1.0)).min(1.0))
        };
        rows.iter().zip(&others).map(chance).product()
    }

    /// How many places as wide are open in each of some rows: one at least, which is being asked of.
    fn open_in_all(&self, rows: &[usize], width: f64) -> f64 {
        let first = rows.first().map(|&n| self.open[n].clone()).unwrap_or_default();
        let common = rows.iter().skip(1).fold(first, |common, &n| {
            let both = common.iter().flat_map(|&one| self.open[n].iter().map(move |&two| shared(one, two)));
            both.filter(|[from, to]| from < to).collect()
        });
        as_wide(&common, width).max(1.0)
    }

    /// How many places as wide of a row are open, and how many it has.
    fn counts(&self, n: usize, width: f64) -> [f64; 2] {
        [as_wide(&self.open[n], width), self.rows[n].length() / width]
    }

    fn counts_of_all(&self, direction: usize) -> Vec<[f64; 2]> {
        let rows: Vec<_> = (0..self.rows.len()).filter(|&n| self.rows[n].direction == direction).collect();
        let of_width = |step: usize| {
            let counts = rows.iter().map(|&n| self.counts(n, (step as f64 * STEP).max(WIDTH.0)));
            counts.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]])
        };
        (0..=(WIDTH.1 / STEP) as usize).map(of_width).collect()
    }
}

/// How many places of a width there are in some stretches.
fn as_wide(open: &[[f64; 2]], width: f64) -> f64 {
    open.iter().map(|[from, to]| ((to - from) / (width - SLACK)).floor()).sum()
}
