//! How far every pixel of the free space is from the nearest that is not free, squared, in pixels (Meijster, Roerdink
//! and Hesselink 2000).

use super::raster::Raster;
use super::runs::{Run, Runs};
use crate::bands::map_bands;
use std::ops::Range;

/// Rasters of more pixels than this are looked at piece by piece.
const WHOLE: usize = 1 << 24;
/// So many rows at a time.
const ROWS: usize = 128;

/// The clearances of a raster: kept where they are few, else made again whenever they are asked for.
pub struct Clearance(Option<Vec<u32>>);

impl Clearance {
    pub fn new(raster: &Raster, threads: usize) -> Self {
        let is_whole = raster.len() <= WHOLE;
        Self(is_whole.then(|| within(raster, [0..raster.width, 0..raster.height], threads)))
    }

    /// All of them, where they are kept.
    pub fn whole(&self) -> Option<&[u32]> {
        self.0.as_deref()
    }

    /// Those within some columns and rows; what is on their border counts as not free.
    pub fn within(&self, raster: &Raster, window: [Range<usize>; 2]) -> Vec<u32> {
        let Some(all) = &self.0 else { return within(raster, window, 1) };
        let [columns, rows] = window;
        let width = columns.len();
        let mut part = vec![0; width * rows.len()];
        for (to, y) in part.chunks_mut(width).zip(rows.clone()).skip(1).take(rows.len().saturating_sub(2)) {
            let from = y * raster.width + columns.start;
            to[1..width - 1].copy_from_slice(&all[from + 1..from + width - 1]);
        }
        part
    }

    /// Calls `visit` with each run and the clearances of its pixels.
    pub fn over(&self, raster: &Raster, runs: &Runs, threads: usize, mut visit: impl FnMut(usize, &[u32])) {
        if let Some(all) = &self.0 {
            runs.all.iter().enumerate().for_each(|(n, run)| visit(n, &all[run.pixels()]));
            return;
        }
        let width = raster.width;
        let mut next = 0;
        band_by_band(raster, threads, |rows, part| {
            let (start, end) = (rows.start * width, rows.end * width);
            while let Some(pixels) = runs.all.get(next).map(Run::pixels).filter(|pixels| pixels.start < end) {
                visit(next, &part[pixels.start - start..pixels.end - start]);
                next += 1;
            }
        });
    }
}

/// The clearances within some columns and rows of the raster; what is on their border or beyond counts as not free.
fn within(raster: &Raster, [columns, rows]: [Range<usize>; 2], threads: usize) -> Vec<u32> {
    let width = columns.len();
    let border = vec![0; width];
    let inner = rows.start + 1..rows.end - 1;
    let heights = heights(raster, &columns, inner, &mut border.clone(), &border);
    let mut parts = squared(&heights, width, threads);
    parts.insert(0, border.clone());
    parts.push(border);
    parts.concat()
}

/// Calls `visit` with some rows after another and their clearances.
fn band_by_band(raster: &Raster, threads: usize, mut visit: impl FnMut(Range<usize>, &[u32])) {
    let (width, columns) = (raster.width, 0..raster.width);
    let bands: Vec<Range<usize>> = (0..raster.height).step_by(ROWS).map(|y| y..(y + ROWS).min(raster.height)).collect();
    // From above first: how far it is to what is not free in the row that follows each band.
    let mut above = vec![vec![0; width]; bands.len()];
    let mut row = vec![0; width];
    for (band, above) in bands.iter().zip(&mut above).rev() {
        above.clone_from(&row);
        for y in band.clone().rev() {
            step(raster, &columns, y, &mut row);
        }
    }
    let mut below = vec![0; width];
    for (band, above) in bands.into_iter().zip(&above) {
        let heights = heights(raster, &columns, band.clone(), &mut below, above);
        visit(band, &squared(&heights, width, threads).concat());
    }
}

/// From how far it is to what is not free in the row before to how far it is in this one.
fn step(raster: &Raster, columns: &Range<usize>, y: usize, row: &mut [u32]) {
    let from = y * raster.width + columns.start;
    for height in row.iter_mut() {
        *height += 1;
    }
    for run in raster.free.runs(from..from + columns.len(), false) {
        row[run.start - from..run.end - from].fill(0);
    }
    row[0] = 0;
    row[columns.len() - 1] = 0;
}

/// How far it is to what is not free within each column; `below` says so of the row before and then of the last one,
/// `above` of the one that follows.
fn heights(raster: &Raster, columns: &Range<usize>, rows: Range<usize>, below: &mut [u32], above: &[u32]) -> Vec<u32> {
    let width = columns.len();
    let mut heights = Vec::with_capacity(rows.len() * width);
    for y in rows.clone() {
        step(raster, columns, y, below);
        heights.extend_from_slice(below);
    }
    for n in (0..rows.len()).rev() {
        let (row, next) = heights[n * width..].split_at_mut(width);
        let above = if n + 1 < rows.len() { &next[..width] } else { above };
        row.iter_mut().zip(above).for_each(|(to, above)| *to = (*to).min(*above + 1));
    }
    heights
}

fn squared(heights: &[u32], width: usize, threads: usize) -> Vec<Vec<u32>> {
    map_bands(heights.len() / width, threads, |band| {
        let mut squared = vec![0u32; band.len() * width];
        let mut seats = Vec::new();
        for (row, to) in heights[band.start * width..].chunks(width).zip(squared.chunks_mut(width)) {
            // Within a run of free pixels only the run and its two ends count.
            let mut next = 1;
            while let Some(from) = (next..width).find(|&x| row[x] != 0) {
                let end = (from..width).find(|&x| row[x] == 0).unwrap_or(width - 1);
                envelope(&row[from - 1..=end], &mut to[from - 1..=end], &mut seats);
                next = end + 1;
            }
        }
        squared
    })
}

/// The lower envelope of the parabolas over some heights; `seats` is room for the places of those that are in it, and
/// what each is at zero.
fn envelope(heights: &[u32], squared: &mut [u32], seats: &mut Vec<(i64, i64)>) {
    seats.clear();
    for (x, &height) in heights.iter().enumerate() {
        let (x, height) = (x as i64, i64::from(height));
        let own = (x, x * x + height * height);
        // One is in it as long as it is below both its neighbours where they meet.
        while let [.., before, last] = seats[..]
            && (last.1 - before.1) * (own.0 - last.0) >= (own.1 - last.1) * (last.0 - before.0)
        {
            seats.pop();
        }
        seats.push(own);
    }
    let mut seats = seats.iter();
    let at = |&(seat, zero): &(i64, i64), x: i64| zero - 2 * seat * x;
    let Some(mut own) = seats.next() else { return };
    let mut next = seats.next();
    for (x, to) in squared.iter_mut().enumerate() {
        let x = x as i64;
        while let Some(after) = next.filter(|after| at(after, x) < at(own, x)) {
            (own, next) = (after, seats.next());
        }
        *to = (at(own, x) + x * x) as u32;
    }
}
