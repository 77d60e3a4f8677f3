//! How far every pixel of the free space is from the nearest that is not free, squared, in pixels (Meijster, Roerdink
//! and Hesselink 2000).

use super::super::recall::{Key, Recall};
use super::raster::Raster;
use super::runs::{Run, Runs};
use crate::bands::{each, map_each, worth};
use crate::bits::{WORD, lowest};
use std::ops::Range;

/// Rasters of more pixels than this are looked at piece by piece.
const WHOLE: usize = 1 << 24;
/// So many rows at a time, but without threads all where there are no more pixels than this.
const ROWS: usize = 128;
const AT_ONCE: usize = 1 << 20;
/// So many runs of a row are worth a thread's while.
const TOGETHER: usize = 1 << 11;
/// Where squares fit in 16 bits so many pixels side by side are looked at together: what lies so many steps more to either
/// side, before it is asked whether something farther off may be nearer. Beyond the last of these numbers nothing is.
const LANES: usize = 32;
const STEPS: usize = 4;
const FARTHEST: usize = 46 * STEPS;

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
        let width = raster.width;
        if let Some(rows) = &self.0 {
            let along = |run: &Run| {
                let start = run.pixels().start;
                Width::new(&rows.row(start / width)[start % width..][..run.len()])
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
    fn new(squared: &[u32]) -> Self {
        let most = squared.iter().copied().max().unwrap_or(0);
        let at = squared.iter().position(|&squared| squared == most).unwrap_or(0) as u32;
        Self { most, at, sum: distances(squared) }
    }
}

/// The sum of the roots, several side by side.
fn distances(squared: &[u32]) -> f64 {
    let parts = squared.chunks_exact(4);
    let rest: f64 = parts.remainder().iter().map(|&squared| f64::from(squared).sqrt()).sum();
    let add = |mut sums: [f64; 4], part: &[u32]| {
        sums.iter_mut().zip(part).for_each(|(sum, &squared)| *sum += f64::from(squared as i32).sqrt());
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
    let bands: Vec<Range<usize>> = (0..height).step_by(band).map(|y| y..(y + band).min(height)).collect();
    let above = above(raster, &bands);
    let below = if bands.len() == 1 { vec![vec![0; width]] } else { below(raster, &bands) };
    let made = map_each(bands.len(), threads, |n| {
        let mut band = Vec::with_capacity(bands[n].len() * width);
        heights(raster, &columns, bands[n].clone(), &mut below[n].clone(), &above[n], &mut band);
        square(&mut band, width);
        band
    });
    Rows { width, height, band, bands: made }
}

/// Those within some columns and rows of a raster; what is on their border or beyond counts as not free. They take the
/// room of others.
pub fn within(raster: &Raster, [columns, rows]: [Range<usize>; 2], mut room: Vec<u32>) -> Rows {
    let (width, height) = (columns.len(), rows.len());
    let border = vec![0; width];
    room.clear();
    room.reserve_exact(height * width);
    room.extend_from_slice(&border);
    heights(raster, &columns, rows.start + 1..rows.end - 1, &mut border.clone(), &border, &mut room);
    square(&mut room[width..], width);
    room.extend_from_slice(&border);
    Rows { width, height, band: height, bands: vec![room] }
}

/// How far it is to what is not free in the row that follows each band.
fn above(raster: &Raster, bands: &[Range<usize>]) -> Vec<Vec<u32>> {
    let mut row = vec![0; raster.width];
    let mut above = vec![row.clone(); bands.len()];
    for (n, band) in bands.iter().enumerate().skip(1).rev() {
        for y in band.clone().rev() {
            step(raster, &(0..raster.width), y, &mut row);
        }
        above[n - 1].clone_from(&row);
    }
    above
}

/// How far it is to what is not free in the row before each band.
fn below(raster: &Raster, bands: &[Range<usize>]) -> Vec<Vec<u32>> {
    let mut row = vec![0; raster.width];
    let before = |band: &Range<usize>| {
        let before = row.clone();
        band.clone().for_each(|y| step(raster, &(0..raster.width), y, &mut row));
        before
    };
    bands.iter().map(before).collect()
}

/// Calls `visit` with what is told of the runs of some rows, and then of the rows that follow.
fn band_by_band(raster: &Raster, runs: &[Run], threads: usize, recall: &Recall, mut visit: impl FnMut(Vec<Width>)) {
    let (width, columns) = (raster.width, 0..raster.width);
    let bands: Vec<Range<usize>> = (0..raster.height).step_by(ROWS).map(|y| y..(y + ROWS).min(raster.height)).collect();
    let above = above(raster, &bands);
    let mut below = vec![0; width];
    let mut squared = Vec::with_capacity(ROWS * width);
    let mut rest = runs;
    for (band, above) in bands.into_iter().zip(&above) {
        let pixels = band.start * width..band.end * width;
        let (own, others) = rest.split_at(rest.partition_point(|run| run.pixels().start < pixels.end));
        rest = others;
        let mut after = None;
        // What is free in the rows and how far it is beyond them, and the runs.
        let key = || {
            let free = pixels.clone().step_by(WORD).map(|n| raster.free.word(n) & lowest(pixels.end - n));
            let beyond = below.iter().zip(above).map(|(below, above)| u64::from(*below) << 32 | u64::from(*above));
            let runs = own.iter().map(|run| ((run.pixels().start - pixels.start) << 32 | run.len()) as u64);
            free.chain(beyond).chain(runs).fold(Key::default().with(width as u64), Key::with)
        };
        let widths = recall.widths.or_find(key, || {
            squared.clear();
            let mut below = below.clone();
            heights(raster, &columns, band.clone(), &mut below, above, &mut squared);
            let parts = squared.chunks_mut(ROWS.div_ceil(threads.max(1)) * width).collect();
            each(parts, threads, |part| square(part, width));
            after = Some(below);
            let of = |run: &Run| Width::new(&squared[run.pixels().start - pixels.start..][..run.len()]);
            own.iter().map(of).collect()
        });
        match after {
            Some(after) => below = after,
            None => band.for_each(|y| step(raster, &columns, y, &mut below)),
        }
        visit(widths);
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
/// `above` of the one that follows. They are put to what is there.
fn heights(
    raster: &Raster,
    columns: &Range<usize>,
    rows: Range<usize>,
    below: &mut [u32],
    above: &[u32],
    all: &mut Vec<u32>,
) {
    let (width, first) = (columns.len(), all.len());
    for y in rows.clone() {
        step(raster, columns, y, below);
        all.extend_from_slice(below);
    }
    let heights = &mut all[first..];
    for n in (0..rows.len()).rev() {
        let (row, next) = heights[n * width..].split_at_mut(width);
        let above = if n + 1 < rows.len() { &next[..width] } else { above };
        row.iter_mut().zip(above).for_each(|(to, above)| *to = (*to).min(*above + 1));
    }
}

/// From the heights of rows to the squared distances.
fn square(rows: &mut [u32], width: usize) {
    let (mut seats, mut heights) = (Vec::new(), Vec::with_capacity(width));
    let mut squares = vec![0; FARTHEST + width + LANES + FARTHEST];
    for row in rows.chunks_mut(width) {
        if square_low(row, &mut squares) {
            continue;
        }
        heights.clear();
        heights.extend_from_slice(row);
        // Within a run of free pixels only the run and its two ends count.
        let mut next = 1;
        while let Some(before) = heights[next..].iter().position(|height| *height != 0) {
            let from = next + before;
            let end = heights[from..].iter().position(|height| *height == 0).map_or(width - 1, |n| from + n);
            envelope(&heights[from - 1..=end], &mut row[from - 1..=end], &mut seats);
            next = end + 1;
        }
    }
}

/// The same of a row whose squares fit in 16 bits, or false: of each pixel its own square, or what lies to either side, as
/// long as something so far off can be nearer. `squares` is room for theirs, with zeros at both ends: what is not free is
/// zero, and what lies beyond it never the nearest.
fn square_low(row: &mut [u32], squares: &mut [i16]) -> bool {
    if row.iter().fold(0, |bits, height| bits | height) > u8::MAX.into() {
        return false;
    }
    let mut least = 0;
    for (to, &height) in squares[FARTHEST..].iter_mut().zip(&*row) {
        *to = (height as i16).wrapping_mul(height as i16);
        least = least.min(*to);
    }
    if least < 0 {
        return false;
    }
    for (n, to) in row.chunks_mut(LANES).enumerate() {
        let at = FARTHEST + n * LANES;
        let mut least = [0; LANES];
        least.copy_from_slice(&squares[at..at + LANES]);
        let mut off = 1;
        while off * off < least.iter().fold(0, |most, &own| most.max(own)) as usize {
            let near = &squares[at + 1 - off - STEPS..at - 1 + off + STEPS + LANES];
            for step in 0..STEPS {
                let (left, right) = (&near[STEPS - 1 - step..][..LANES], &near[2 * off + STEPS - 1 + step..][..LANES]);
                let squared = i16::try_from((off + step).pow(2)).unwrap_or(i16::MAX);
                for ((own, left), right) in least.iter_mut().zip(left).zip(right) {
                    *own = (*left).min(*right).saturating_add(squared).min(*own);
                }
            }
            off += STEPS;
        }
        to.iter_mut().zip(least).for_each(|(to, own)| *to = own as u32);
    }
    true
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
    // Each is followed from pixel to pixel: its square, and how much the next one is more.
    let at = |&(seat, zero): &(i64, i64), x: i64| (zero - 2 * seat * x + x * x, 2 * (x - seat) + 1);
    let mut seats = seats.iter();
    let Some((mut own, mut more)) = seats.next().map(|seat| at(seat, 0)) else { return };
    let mut after = seats.next().map(|seat| at(seat, 0));
    for (x, to) in (0..).zip(squared) {
        while let Some((square, step)) = after.filter(|after| after.0 < own) {
            (own, more) = (square, step);
            after = seats.next().map(|seat| at(seat, x));
        }
        *to = own as u32;
        (own, more) = (own + more, more + 2);
        after = after.map(|(square, step)| (square + step, step + 2));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_squared_as_if_every_pixel_were_held_against_all_others() {
        let mut random = 7u32;
        let mut next = |below: u32| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 8) % below
        };
        // From low rows to those whose squares do not fit in 16 bits.
        for (width, top) in [(40, 4), (500, 40), (500, 182), (700, 183), (700, 256), (700, 400), (35, 1000)] {
            let mut row: Vec<u32> = (0..width).map(|_| if next(50) == 0 { 0 } else { 1 + next(top - 1) }).collect();
            (row[0], row[width - 1]) = (0, 0);
            // And one that is as high as it may be nearly everywhere.
            let mut even = vec![top - 1; width];
            (even[0], even[width - 1]) = (0, 0);
            let heights = [row, even];
            let mut squared = heights.concat();
            square(&mut squared, width);
            for (row, squared) in heights.iter().zip(squared.chunks(width)) {
                let places = || row.iter().enumerate().map(|(x, height)| (x, height.pow(2)));
                let least = |x: usize| places().map(|(other, square)| square + x.abs_diff(other).pow(2) as u32).min();
                assert!(squared.iter().enumerate().all(|(x, own)| least(x) == Some(*own)), "{width} {top}");
            }
        }
    }
}
