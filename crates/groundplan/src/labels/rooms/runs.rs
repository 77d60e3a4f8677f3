//! Numbers of pixels as runs along rows: of a map far more is alike from pixel to pixel than is not.

use crate::bits::Bits;
use crate::sets::Sets;
use std::ops::Range;

/// Pixels of one row, from one to before another, and the number that they have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    from: u32,
    to: u32,
    pub number: u32,
}

impl Run {
    /// A raster has fewer pixels than fill 32 bits.
    pub fn new(pixels: &Range<usize>, number: u32) -> Self {
        Self { from: pixels.start as u32, to: pixels.end as u32, number }
    }

    pub fn pixels(&self) -> Range<usize> {
        self.from as usize..self.to as usize
    }

    pub fn len(&self) -> usize {
        (self.to - self.from) as usize
    }
}

/// Where runs are is noted for every so many pixels: for every 64 it took 75 MiB more at 1600 megapixels.
const STEP: usize = 256;

/// The runs of a raster in their order, none on its border. Pixels in no run have the number 0.
pub struct Runs {
    pub width: usize,
    pub all: Vec<Run>,
    /// For every so many pixels the first run that does not end before them.
    index: Vec<u32>,
}

impl Runs {
    /// From runs in their order; neighbours of one number are joined.
    pub fn new(width: usize, pixels: usize, mut runs: Vec<Run>) -> Self {
        runs.dedup_by(|next, run| {
            let joins = run.to == next.from && run.number == next.number;
            if joins {
                run.to = next.to;
            }
            joins
        });
        runs.shrink_to_fit();
        let mut index = Vec::with_capacity(pixels / STEP + 1);
        for (n, run) in runs.iter().enumerate() {
            // All pixels up to this run's last are in no earlier one.
            index.resize((run.to as usize - 1) / STEP + 1, n as u32);
        }
        index.resize(pixels / STEP + 1, runs.len() as u32);
        Self { width, all: runs, index }
    }

    /// A pixel's number.
    pub fn at(&self, pixel: usize) -> u32 {
        self.run_at(pixel).map_or(0, |run| run.number)
    }

    /// The run that holds a pixel.
    pub fn run_at(&self, pixel: usize) -> Option<&Run> {
        let first = self.index[pixel / STEP] as usize;
        let run = self.all[first..].iter().find(|run| run.to as usize > pixel);
        run.filter(|run| run.from as usize <= pixel)
    }

    /// Pieces of pixels of one number that are joined side by side: the number of each run's, from 1, in the order of
    /// their first pixels, and how many there are.
    pub fn pieces(&self) -> (Vec<u32>, usize) {
        let mut sets = Sets::new(self.all.len());
        self.touching(|own, below| {
            if self.all[own].number == self.all[below].number {
                sets.join_first(own as u32, below as u32);
            }
        });
        sets.numbered()
    }

    /// Calls `visit` with each run and every one that lies below it.
    pub fn touching(&self, visit: impl FnMut(usize, usize)) {
        touching(&self.all, self.width, 0, visit);
    }

    /// For each pair of runs side by side, in one row or above each other.
    pub fn beside(&self, mut visit: impl FnMut(usize, usize)) {
        for n in 1..self.all.len() {
            if self.all[n - 1].to == self.all[n].from {
                visit(n, n - 1);
            }
        }
        self.touching(visit);
    }

    /// Calls `visit` with the parts of each run below which another number lies, in their order.
    pub fn lower_sides(&self, mut visit: impl FnMut(&Run, Range<usize>)) {
        let width = self.width as u32;
        let mut below = 0;
        for run in &self.all {
            while self.all[below].to + width <= run.from {
                below += 1;
            }
            let mut from = run.from;
            for other in &self.all[below..] {
                if other.from + width >= run.to {
                    break;
                }
                if other.number == run.number {
                    if from < other.from + width {
                        visit(run, from as usize..(other.from + width) as usize);
                    }
                    from = other.to + width;
                }
            }
            if from < run.to {
                visit(run, from as usize..run.to as usize);
            }
        }
    }

    /// The same with a few pixels more; they are in ascending order and had no number.
    pub fn with(self, more: &[(usize, u32)]) -> Self {
        let (width, pixels) = (self.width, (self.index.len() - 1) * STEP);
        drop(self.index);
        let mut runs = self.all;
        // From the last on, so that no run is written over before it has its place.
        let (mut own, mut rest) = (runs.len(), more.len());
        runs.reserve_exact(more.len());
        runs.extend(more.iter().map(|&(pixel, number)| Run::new(&(pixel..pixel + 1), number)));
        while rest > 0 {
            let (pixel, number) = more[rest - 1];
            let place = own + rest - 1;
            if own > 0 && runs[own - 1].from as usize > pixel {
                own -= 1;
                runs[place] = runs[own];
            } else {
                rest -= 1;
                runs[place] = Run::new(&(pixel..pixel + 1), number);
            }
        }
        Self::new(width, pixels, runs)
    }
}

/// Calls `visit` with each of some runs and every one in the row below that it touches; `corners` is 1 where to touch
/// at a corner is enough.
pub fn touching(runs: &[Run], width: usize, corners: u32, mut visit: impl FnMut(usize, usize)) {
    let width = width as u32;
    let mut first = 0;
    for (n, run) in runs.iter().enumerate() {
        while runs[first].to + width + corners <= run.from {
            first += 1;
        }
        for (below, other) in runs.iter().enumerate().take(n).skip(first) {
            if other.from + width >= run.to + corners {
                break;
            }
            visit(n, below);
        }
    }
}

/// The runs of pixels in a set, without some pixels in ascending order, all with the number 1.
pub fn runs_of(bits: &Bits, pixels: usize, without: &[usize]) -> Vec<Run> {
    let mut runs = Vec::new();
    let mut gone = without.iter().copied().peekable();
    for run in bits.runs(0..pixels, true) {
        let mut from = run.start;
        while let Some(pixel) = gone.next_if(|&pixel| pixel < run.end) {
            if from < pixel {
                runs.push(Run::new(&(from..pixel), 1));
            }
            from = from.max(pixel + 1);
        }
        if from < run.end {
            runs.push(Run::new(&(from..run.end), 1));
        }
    }
    runs
}
