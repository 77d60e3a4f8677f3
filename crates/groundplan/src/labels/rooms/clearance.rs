//! How far pixels of the free space are from the nearest that is not free, squared, in pixels (Meijster, Roerdink and
//! Hesselink 2000), in the rows that are looked at.

use super::super::recall::{Key, Recall};
use super::heights::Window;
use super::raster::Raster;
use super::runs::{Run, Runs};
use super::squared::Squared;
use crate::bands::{map_each, map_each_in, worth};
use crate::bits::{WORD, lowest};
use std::ops::Range;

/// Rasters of more pixels than this are looked at piece by piece.
const WHOLE: usize = 1 << 24;
/// So many rows at a time, but without threads all where there are no more pixels than this.
const ROWS: usize = 64;
const AT_ONCE: usize = 1 << 20;
/// So many bands of rows are begun together, where they are not kept.
const SIDE_BY_SIDE: usize = 16;
/// So many runs of a row are worth a thread's while.
const TOGETHER: usize = 1 << 11;

/// The clearances of a raster: kept where they are few, else made again whenever they are asked for.
pub struct Clearance(Option<Rows>);

/// Squared distances of the pixels of the rows that are looked at, in bands of these.
pub struct Rows {
    pub window: Window,
    /// Rows of a band.
    band: usize,
    bands: Vec<Vec<u32>>,
}

impl Rows {
    /// The room of those that lie in one band.
    pub fn into_room(self) -> Vec<u32> {
        self.bands.into_iter().next().unwrap_or_default()
    }

    /// One row, from the lowest.
    pub fn row(&self, n: usize) -> &[u32] {
        let width = self.window.columns.len();
        &self.bands[n / self.band][n % self.band * width..][..width]
    }
}

impl Clearance {
    pub fn new(raster: &Raster, threads: usize) -> Self {
        Self((raster.len() <= WHOLE).then(|| whole(raster, threads)))
    }

    /// All of them, where they are kept.
    pub fn whole(&self) -> Option<&Rows> {
        self.0.as_ref()
    }

    /// Calls `visit` with the number of each run in a row that is looked at and how wide the free space is along it.
    pub fn along(
        &self,
        raster: &Raster,
        runs: &Runs,
        threads: usize,
        recall: &Recall,
        mut visit: impl FnMut(usize, Width),
    ) {
        if let Some(rows) = &self.0 {
            let (width, roots) = (raster.width, Roots::new());
            let along = |(n, run): (usize, &Run)| {
                let start = run.pixels().start;
                let row = rows.row(rows.window.looked_at(start / width)?);
                Some((n, Width::new(&row[start % width..][..run.len()], &roots)))
            };
            let parts: Vec<&[Run]> = runs.all.chunks(TOGETHER).collect();
            let widths = map_each(parts.len(), threads, |n| {
                (n * TOGETHER..).zip(parts[n]).filter_map(along).collect::<Vec<_>>()
            });
            widths.into_iter().flatten().for_each(|(n, width)| visit(n, width));
            return;
        }
        band_by_band(raster, &runs.all, threads, recall, visit);
    }
}

/// How wide the free space is along a run of its pixels.
#[derive(Clone, Copy, Debug)]
pub struct Width {
    /// The greatest squared clearance, in pixels, and the first pixel of the run that has it.
    pub most: u32,
    pub at: u32,
    /// Sum of all pixels' clearances.
    pub sum: f64,
}

impl Width {
    fn new(squared: &[u32], roots: &Roots) -> Self {
        let most = squared.iter().copied().max().unwrap_or(0);
        let at = squared.iter().position(|&squared| squared == most).unwrap_or(0) as u32;
        Self { most, at, sum: roots.sum(squared, most) }
    }
}

/// The roots of small numbers, which most squared clearances are: to look one up takes less than to find it.
struct Roots(Box<[f64; ROOTS]>);

const ROOTS: usize = 1 << 12;

impl Roots {
    fn new() -> Self {
        Self(Box::new(std::array::from_fn(|squared| (squared as f64).sqrt())))
    }

    /// The sum of the roots, several side by side, of what is no greater than the most.
    fn sum(&self, squared: &[u32], most: u32) -> f64 {
        if (most as usize) < ROOTS {
            sum(squared, |squared| self.0[squared as usize % ROOTS])
        } else {
            sum(squared, |squared| f64::from(squared as i32).sqrt())
        }
    }
}

fn sum(squared: &[u32], root: impl Fn(u32) -> f64) -> f64 {
    let parts = squared.chunks_exact(4);
    let rest: f64 = parts.remainder().iter().map(|&squared| root(squared)).sum();
    let add = |mut sums: [f64; 4], part: &[u32]| {
        sums.iter_mut().zip(part).for_each(|(sum, &squared)| *sum += root(squared));
        sums
    };
    parts.fold([0.0; 4], add).iter().sum::<f64>() + rest
}

/// Those of a whole raster, whose border is not free.
fn whole(raster: &Raster, threads: usize) -> Rows {
    let window = Window::whole(raster);
    let threads = worth(raster.len(), threads);
    // What bears on a band from beyond takes a pass of its own; but a band stays in the processor's cache.
    let band = if threads <= 1 && raster.len() <= AT_ONCE { window.count().max(1) } else { ROWS };
    let bands = window.in_bands(band);
    let above = window.above(raster, &bands);
    let mut first = vec![0; raster.width];
    let below = if bands.len() == 1 { vec![first] } else { window.below(raster, &bands, &mut first) };
    let made = map_each_in(bands.len(), threads, |upwards: &mut Vec<u16>, n| {
        let mut band = Vec::with_capacity(bands[n].len() * raster.width);
        clearances(raster, &window, bands[n].clone(), [&mut below[n].clone(), upwards], &above[n], &mut band);
        band
    });
    Rows { window, band, bands: made }
}

/// Those within some columns and rows of a raster; what is on their border or beyond counts as not free. They take the
/// room of others.
pub fn within(raster: &Raster, window: Window, mut room: Vec<u32>) -> Rows {
    let width = window.columns.len();
    room.clear();
    room.reserve_exact(window.count() * width);
    let bands = window.in_bands(ROWS);
    let (mut below, mut upwards) = (vec![0; width], Vec::new());
    for (band, above) in bands.iter().zip(window.above(raster, &bands)) {
        clearances(raster, &window, band.clone(), [&mut below, &mut upwards], &above, &mut room);
    }
    Rows { band: window.count().max(1), window, bands: vec![room] }
}

/// The same where none are kept. Several bands of rows are looked at side by side.
fn band_by_band(raster: &Raster, runs: &[Run], threads: usize, recall: &Recall, mut visit: impl FnMut(usize, Width)) {
    let (width, window) = (raster.width, Window::whole(raster));
    let bands = window.in_bands(ROWS);
    let above = window.above(raster, &bands);
    let (mut row, roots) = (vec![0; width], Roots::new());
    let place = |pixel: usize| runs.partition_point(|run| run.pixels().start < pixel);
    for (bands, above) in bands.chunks(SIDE_BY_SIDE).zip(above.chunks(SIDE_BY_SIDE)) {
        let below = window.below(raster, bands, &mut row);
        // The runs of each row, the first of them and how many.
        let own: Vec<Vec<Range<usize>>> = bands
            .iter()
            .map(|band| {
                let pixels = |n: usize| window.row(n) * width..(window.row(n) + 1) * width;
                band.clone().map(pixels).map(|pixels| place(pixels.start)..place(pixels.end)).collect()
            })
            .collect();
        let made = map_each_in(bands.len(), threads, |(squared, upwards): &mut (Vec<u32>, Vec<u16>), n| {
            let all =
                || own[n].iter().zip(bands[n].clone()).flat_map(|(own, row)| own.clone().map(move |run| (row, run)));
            let within = |(row, run): (usize, usize)| {
                let start = runs[run].pixels().start - window.row(row) * width;
                (row - bands[n].start) * width + start..(row - bands[n].start) * width + start + runs[run].len()
            };
            // What is free in the rows and how far it is beyond them, and the runs.
            let key = || {
                let rows = window.between(&bands[n]);
                let pixels = rows.start * width..rows.end * width;
                let free = pixels.clone().step_by(WORD).map(|n| raster.free.word(n) & lowest(pixels.end - n));
                let beyond = below[n].iter().zip(&above[n]);
                let beyond = beyond.map(|(below, above)| u64::from(*below) << 32 | u64::from(*above));
                let runs = all().map(within).map(|pixels| (pixels.start << 32 | pixels.len()) as u64);
                free.chain(beyond).chain(runs).fold(Key::default().with(width as u64), Key::with)
            };
            recall.widths.or_find(key, || {
                squared.clear();
                squared.reserve_exact(bands[n].len() * width);
                clearances(raster, &window, bands[n].clone(), [&mut below[n].clone(), upwards], &above[n], squared);
                all().map(within).map(|pixels| Width::new(&squared[pixels], &roots)).collect()
            })
        });
        for (own, widths) in own.into_iter().zip(made) {
            own.into_iter().flatten().zip(widths).for_each(|(run, width)| visit(run, width));
        }
    }
}

/// The squared clearances of rows, put to what is there. How far it is to what is not free within each column `below` says
/// of the row before and then of the last one, `above` of the one that follows; `upwards` is room.
fn clearances(
    raster: &Raster,
    window: &Window,
    rows: Range<usize>,
    [below, upwards]: [&mut Vec<u16>; 2],
    above: &[u16],
    all: &mut Vec<u32>,
) {
    let width = window.columns.len();
    // From the last row to the first how far it is upwards, and then back again.
    upwards.clear();
    upwards.reserve_exact(rows.len() * width);
    let mut row = above.to_vec();
    for n in rows.clone().rev() {
        window.step_down(raster, n, &mut row);
        upwards.extend_from_slice(&row);
    }
    let mut squared = Squared::new(width);
    for (n, upwards) in rows.zip(upwards.chunks(width).rev()) {
        window.step_up(raster, n, below);
        for (below, above) in below.iter_mut().zip(upwards) {
            *below = (*below).min(*above);
        }
        squared.row(below, all);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Frame, Grid, Table};

    #[test]
    fn rows_that_are_looked_at_know_what_lies_between_them() {
        let (width, height) = (90, 301);
        // Of so many rows one is looked at, by the side of a pixel.
        for (resolution, step) in [(0.05, 2), (0.04, 3), (0.03, 3), (0.1, 1)] {
            let mut random = 5u32;
            let pixels: Vec<u8> = std::iter::repeat_with(|| {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                if random >> 8 < 1 << 15 { 0 } else { 254 }
            })
            .take(width * height)
            .collect();
            let (table, frame) = (Table::trinary(), Frame::new(width, height, resolution, [0.0; 3]));
            let raster = Raster::new(&Grid::new(&pixels, true, &table, frame), 1, &Recall::new(None)).unwrap();
            let part = Window::new(&raster, [7..61, 30..222]);
            for made in [whole(&raster, 1), whole(&raster, 3), within(&raster, part, Vec::new())] {
                let Window { columns, rows, .. } = made.window.clone();
                assert_eq!(made.window.step, step);
                let is_taken = |x: usize, y: usize| {
                    let is_inside = columns.start < x && x + 1 < columns.end && rows.start < y && y + 1 < rows.end;
                    !is_inside || !raster.free.get(y * raster.width + x)
                };
                let squared = |x: usize, y: usize| {
                    let taken = rows.clone().flat_map(|b| columns.clone().map(move |a| [a, b]));
                    let taken = taken.filter(|&[a, b]| a.abs_diff(x) < 9 && b.abs_diff(y) < 9 && is_taken(a, b));
                    taken.map(|[a, b]| a.abs_diff(x).pow(2) + b.abs_diff(y).pow(2)).min()
                };
                for n in (0..made.window.count()).step_by(7) {
                    for (x, own) in columns.clone().zip(made.row(n)).step_by(5) {
                        // What is farther has not been looked for here.
                        let least = squared(x, made.window.row(n)).filter(|least| *least < 81);
                        assert!(least.map_or(*own >= 81, |least| least == *own as usize), "{step} {x} {n}");
                    }
                }
            }
        }
    }
}
