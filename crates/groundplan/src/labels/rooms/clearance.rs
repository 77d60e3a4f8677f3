//! How far every pixel of the free space is from the nearest that is not free, squared, in pixels (Meijster, Roerdink
//! and Hesselink 2000).

use super::super::recall::{Key, Recall};
use super::raster::Raster;
use super::runs::{Run, Runs};
use super::squared::Squared;
use crate::bands::{map_each, map_each_in, worth};
use crate::bits::{WORD, lowest};
use std::ops::Range;

/// Rasters of more pixels than this are looked at piece by piece.
const WHOLE: usize = 1 << 24;
/// So many rows at a time, but without threads all where there are no more pixels than this.
const ROWS: usize = 128;
const AT_ONCE: usize = 1 << 20;
/// So many bands of rows are begun together, where they are not kept.
const SIDE_BY_SIDE: usize = 16;
/// So many runs of a row are worth a thread's while.
const TOGETHER: usize = 1 << 11;

/// The clearances of a raster: kept where they are few, else made again whenever they are asked for.
pub struct Clearance(Option<Rows>);

/// Squared distances of the pixels of some rows, in bands of rows.
pub struct Rows {
    pub width: usize,
    pub height: usize,
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
    pub fn row(&self, y: usize) -> &[u32] {
        &self.bands[y / self.band][y % self.band * self.width..][..self.width]
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

    /// Calls `visit` with the number of each run and how wide the free space is along it.
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
            let along = |run: &Run| {
                let start = run.pixels().start;
                Width::new(&rows.row(start / width)[start % width..][..run.len()], &roots)
            };
            let parts: Vec<&[Run]> = runs.all.chunks(TOGETHER).collect();
            let widths = map_each(parts.len(), threads, |n| parts[n].iter().map(along).collect::<Vec<_>>());
            (0..).zip(widths.into_iter().flatten()).for_each(|(n, width)| visit(n, width));
            return;
        }
        let mut next = 0;
        band_by_band(raster, &runs.all, threads, recall, |widths| {
            for width in widths {
                visit(next, width);
                next += 1;
            }
        });
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
    let (width, height, columns) = (raster.width, raster.height, 0..raster.width);
    let threads = worth(raster.len(), threads);
    // What bears on a band from beyond takes a pass of its own; but a band stays in the processor's cache.
    let band = if threads <= 1 && raster.len() <= AT_ONCE { height } else { ROWS };
    let bands = in_bands(0..height, band);
    let above = above(raster, &columns, &bands);
    let below = if bands.len() == 1 { vec![vec![0; width]] } else { below(raster, &bands, &mut vec![0; width]) };
    let made = map_each(bands.len(), threads, |n| {
        let mut band = Vec::with_capacity(bands[n].len() * width);
        clearances(raster, &columns, bands[n].clone(), &mut below[n].clone(), &above[n], &mut band);
        band
    });
    Rows { width, height, band, bands: made }
}

/// Those within some columns and rows of a raster; what is on their border or beyond counts as not free. They take the
/// room of others.
pub fn within(raster: &Raster, [columns, rows]: [Range<usize>; 2], mut room: Vec<u32>) -> Rows {
    let (width, height) = (columns.len(), rows.len());
    room.clear();
    room.reserve_exact(height * width);
    room.resize(width, 0);
    let bands = in_bands(rows.start + 1..rows.end - 1, ROWS);
    let mut below = vec![0; width];
    for (band, above) in bands.iter().zip(above(raster, &columns, &bands)) {
        clearances(raster, &columns, band.clone(), &mut below, &above, &mut room);
    }
    room.resize(height * width, 0);
    Rows { width, height, band: height, bands: vec![room] }
}

fn in_bands(rows: Range<usize>, band: usize) -> Vec<Range<usize>> {
    rows.clone().step_by(band).map(|y| y..(y + band).min(rows.end)).collect()
}

/// How far it is to what is not free within columns, in the row that follows each band.
fn above(raster: &Raster, columns: &Range<usize>, bands: &[Range<usize>]) -> Vec<Vec<u16>> {
    let mut row = vec![0; columns.len()];
    let mut above = vec![row.clone(); bands.len()];
    for (n, band) in bands.iter().enumerate().skip(1).rev() {
        for y in band.clone().rev() {
            step(raster, columns, y, &mut row);
        }
        above[n - 1].clone_from(&row);
    }
    above
}

/// How far it is to what is not free in the row before each band; `row` says so of the row before all of them, and then
/// of the last one.
fn below(raster: &Raster, bands: &[Range<usize>], row: &mut [u16]) -> Vec<Vec<u16>> {
    let before = |band: &Range<usize>| {
        let before = row.to_vec();
        band.clone().for_each(|y| step(raster, &(0..raster.width), y, row));
        before
    };
    bands.iter().map(before).collect()
}

/// Calls `visit` with what is told of the runs of some rows, and then of the rows that follow. Several bands of rows are
/// looked at side by side.
fn band_by_band(raster: &Raster, runs: &[Run], threads: usize, recall: &Recall, mut visit: impl FnMut(Vec<Width>)) {
    let (width, columns) = (raster.width, 0..raster.width);
    let bands = in_bands(0..raster.height, ROWS);
    let above = above(raster, &columns, &bands);
    let (mut row, roots) = (vec![0; width], Roots::new());
    for (bands, above) in bands.chunks(SIDE_BY_SIDE).zip(above.chunks(SIDE_BY_SIDE)) {
        let below = below(raster, bands, &mut row);
        let made = map_each_in(bands.len(), threads, |squared: &mut Vec<u32>, n| {
            let pixels = bands[n].start * width..bands[n].end * width;
            let place = |pixel: usize| runs.partition_point(|run| run.pixels().start < pixel);
            let own = &runs[place(pixels.start)..place(pixels.end)];
            // What is free in the rows and how far it is beyond them, and the runs.
            let key = || {
                let free = pixels.clone().step_by(WORD).map(|n| raster.free.word(n) & lowest(pixels.end - n));
                let beyond = below[n].iter().zip(&above[n]);
                let beyond = beyond.map(|(below, above)| u64::from(*below) << 32 | u64::from(*above));
                let runs = own.iter().map(|run| ((run.pixels().start - pixels.start) << 32 | run.len()) as u64);
                free.chain(beyond).chain(runs).fold(Key::default().with(width as u64), Key::with)
            };
            recall.widths.or_find(key, || {
                squared.clear();
                squared.reserve_exact(pixels.len());
                clearances(raster, &columns, bands[n].clone(), &mut below[n].clone(), &above[n], squared);
                let of = |run: &Run| Width::new(&squared[run.pixels().start - pixels.start..][..run.len()], &roots);
                own.iter().map(of).collect()
            })
        });
        made.into_iter().for_each(&mut visit);
    }
}

/// From how far it is to what is not free in the row before to how far it is in this one: in 16 bits, of which many are
/// looked at together, and where nothing is nearer than these hold, it is as far as they do.
fn step(raster: &Raster, columns: &Range<usize>, y: usize, row: &mut [u16]) {
    let from = y * raster.width + columns.start;
    for height in row.iter_mut() {
        *height = height.saturating_add(1);
    }
    for run in raster.free.runs(from..from + columns.len(), false) {
        row[run.start - from..run.end - from].fill(0);
    }
    row[0] = 0;
    row[columns.len() - 1] = 0;
}

/// The squared clearances of rows, put to what is there. How far it is to what is not free within each column `below` says
/// of the row before and then of the last one, `above` of the one that follows.
fn clearances(
    raster: &Raster,
    columns: &Range<usize>,
    rows: Range<usize>,
    below: &mut [u16],
    above: &[u16],
    all: &mut Vec<u32>,
) {
    let width = columns.len();
    // From the last row to the first how far it is upwards, and then back again.
    let mut upwards = Vec::with_capacity(rows.len() * width);
    let mut row = above.to_vec();
    for y in rows.rev() {
        step(raster, columns, y, &mut row);
        upwards.extend_from_slice(&row);
    }
    let mut squared = Squared::new(width);
    for upwards in upwards.chunks(width).rev() {
        for (below, above) in below.iter_mut().zip(upwards) {
            *below = below.saturating_add(1).min(*above);
        }
        squared.row(below, all);
    }
}
