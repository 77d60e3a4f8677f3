//! The pieces of free space that stay regions: each made one connected piece, with its place, its order and its purpose.

use super::super::near::Polygons;
use super::super::places::Squares;
use super::super::{Evidence, Purpose};
use super::fill::fill_runs;
use super::raster::Raster;
use super::rays;
use super::runs::{Run, Runs};
use super::{Space, Width};
use crate::bands::map_each;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// What stands apart from all else is a region when it holds so much, square metres, and has room for a circle of such
/// a radius, metres: less is a ray through a window.
const ALONE: (f64, f64) = (0.5, 0.15);
/// A region is long when its area is so many times the square of its mean width.
const LONG: f64 = 4.2;
/// And a corridor when it has two doors, and one at least for so many metres of its length.
const DOOR_EVERY: f64 = 15.0;
/// So is a passage: what a single way, without a little at its sides, fills to such a part, between two doors.
const FILLED: f64 = 0.6;
/// Other regions at least so large are halls, square metres.
const HALL: f64 = 150.0;
/// Regions are in one row when no gap wider than this parts them across, metres.
const ROW: f64 = 1.0;
/// Of a region's extent so much at each end does not count, and it is measured by about so many pixels.
const STICKS_OUT: f64 = 0.03;
const SAMPLES: usize = 500;
/// So many regions are worth a thread's while.
const SOME: usize = 8;
/// What lies for the most part within a rack, by so many looks, is a gap between its goods.
const LOOKS: usize = 200;

/// A region, while its label is made.
pub struct Region {
    pub number: u32,
    pixels: usize,
    /// The pixel farthest from all walls.
    pub at: usize,
    /// Sum of distances to the nearest wall, and of how many pixels.
    distances: f64,
    measured: usize,
    /// Its middle in the squares that give names.
    pub place: [f64; 2],
    /// Does a single way fill it?
    is_way: bool,
}

impl Region {
    /// By its shape, its doors and its square metres.
    pub fn purpose(&self, raster: &Raster, doors: usize, area: f64) -> Purpose {
        let width = mean_width(self.distances, self.measured);
        let length = self.pixels as f64 / width;
        let is_long = length >= LONG * width && doors as f64 * raster.pixels(DOOR_EVERY) >= length;
        if doors >= 2 && (is_long || self.is_way) {
            Purpose::Corridor
        } else if area >= HALL {
            Purpose::Hall
        } else {
            Purpose::Room
        }
    }
}

/// Pixels of one region that hang together, before the region is made one piece.
#[derive(Clone, Copy, Default)]
struct Piece {
    region: u32,
    pixels: usize,
    /// Those that were seen free.
    seen: usize,
    first: usize,
    /// The greatest squared distance to what is not free, and the first pixel that has it.
    widest: u32,
    at: usize,
    /// Sum of distances, and of how many pixels.
    distances: f64,
    measured: usize,
}

impl Piece {
    /// And a run more.
    fn add(&mut self, run: &Run, seen: usize) {
        if self.pixels == 0 {
            (self.first, self.at) = (run.pixels().start, run.pixels().start);
        }
        self.region = run.number;
        self.pixels += run.len();
        self.seen += seen;
    }

    /// And how wide it is along one.
    fn measure(&mut self, run: &Run, width: Width) {
        if width.most > self.widest {
            self.widest = width.most;
            self.at = run.pixels().start + width.at as usize;
        }
        self.measured += run.len();
        self.distances += width.sum;
    }

    fn width(&self) -> f64 {
        mean_width(self.distances, self.measured)
    }
}

/// The mean distance to the walls of a long strip is a quarter of its width.
fn mean_width(distances: f64, measured: usize) -> f64 {
    4.0 * distances / measured.max(1) as f64
}

/// Row by row from the top: every region one connected piece, without what nobody could stand in, numbered from 1.
pub fn find(
    evidence: &Evidence,
    Space { raster, clearance, .. }: &Space,
    mut numbers: Runs,
    [ways, grounds]: [&Polygons; 2],
    squares: &Squares,
) -> (Vec<Region>, Runs) {
    let (pieces, count) = numbers.pieces();
    let mut all = vec![Piece::default(); count + 1];
    for (run, &piece) in numbers.all.iter().zip(&pieces) {
        all[piece as usize].add(run, run.len() - raster.islands.filled.within(run));
    }
    clearance.along(raster, &numbers, evidence.threads, evidence.recall, |n, width| {
        all[pieces[n] as usize].measure(&numbers.all[n], width);
    });
    let narrow: Vec<bool> = all.iter().map(|piece| piece.width() < raster.pixels(rays::NARROW)).collect();
    let rays = rays::find(evidence, raster, &numbers, &pieces, &narrow);
    let mut largest = BTreeMap::new();
    for (n, piece) in all.iter().enumerate().skip(1) {
        let best = largest.entry(piece.region).or_insert(n);
        if piece.pixels > all[*best].pixels {
            *best = n;
        }
    }
    let radius = raster.pixels(ALONE.1);
    let looks = if grounds.all.is_empty() {
        Vec::new()
    } else {
        samples(&numbers, |n| pieces[n], &all.iter().map(|piece| piece.pixels).collect::<Vec<_>>(), LOOKS)
    };
    let to_map = |pixel: usize| evidence.grid.frame.to_metres(raster.to_grid(raster.place(pixel)));
    let within_rack = |n: usize| {
        looks
            .get(n)
            .is_some_and(|looks| 2 * looks.iter().filter(|&&pixel| grounds.hold(to_map(pixel))).count() > looks.len())
    };
    let mut count = 0;
    let names: Vec<u32> = (0..all.len())
        .map(|n| {
            let piece = all[n];
            let least =
                if largest.get(&piece.region) == Some(&n) { ALONE.0 } else { evidence.parameters.rooms_min_area };
            let area = piece.seen as f64 * raster.resolution.powi(2);
            let has_room = area >= least && f64::from(piece.widest) >= radius * radius;
            let stands = n > 0 && has_room && !rays[n] && !within_rack(n);
            count += u32::from(stands);
            if stands { count } else { 0 }
        })
        .collect();
    numbers.all.iter_mut().zip(&pieces).for_each(|(run, &piece)| run.number = names[piece as usize]);
    drop((pieces, looks));
    let numbers = fill_runs(raster, numbers);
    let mut regions: Vec<Region> = (1..=count)
        .map(|number| Region { number, pixels: 0, at: 0, distances: 0.0, measured: 0, place: [0.0; 2], is_way: false })
        .collect();
    for run in &numbers.all {
        regions[run.number as usize - 1].pixels += run.len();
    }
    // A piece that is no region of its own is of the one that its first pixel was given to.
    let mut widest = vec![0; regions.len()];
    for (piece, name) in all.iter().zip(names).skip(1) {
        let number = if name == 0 { numbers.at(piece.first) } else { name };
        let Some(place) = (number as usize).checked_sub(1) else { continue };
        let region = &mut regions[place];
        region.distances += piece.distances;
        region.measured += piece.measured;
        if piece.widest > widest[place] || piece.widest == widest[place] && piece.at < region.at {
            (widest[place], region.at) = (piece.widest, piece.at);
        }
    }
    let counts: Vec<usize> = std::iter::once(0).chain(regions.iter().map(|region| region.pixels)).collect();
    let pixels = samples(&numbers, |n| numbers.all[n].number, &counts, SAMPLES);
    let threads = evidence.threads.min(regions.len() / SOME + 1);
    let told = map_each(regions.len(), threads, |n| {
        let points: Vec<[f64; 2]> = pixels[n + 1].iter().map(|&pixel| to_map(pixel)).collect();
        (middle(&points, squares), ways.shares(&points).any(|share| share >= FILLED))
    });
    regions.iter_mut().zip(told).for_each(|(region, told)| (region.place, region.is_way) = told);
    sort_by_rows(&mut regions);
    (regions, numbers)
}

/// Of the pixels of each number so many at most, evenly spaced; `number` is that of each run, `counts` says how many
/// pixels there are of each.
fn samples(runs: &Runs, number: impl Fn(usize) -> u32, counts: &[usize], most: usize) -> Vec<Vec<usize>> {
    let steps: Vec<usize> = counts.iter().map(|count| count.div_ceil(most).max(1)).collect();
    let mut next = vec![0; counts.len()];
    let mut samples: Vec<Vec<usize>> =
        counts.iter().zip(&steps).map(|(count, step)| Vec::with_capacity(count.div_ceil(*step))).collect();
    for (n, run) in runs.all.iter().enumerate() {
        let number = number(n) as usize;
        let pixels = run.pixels();
        let mut pixel = pixels.start + next[number];
        while pixel < pixels.end {
            samples[number].push(pixel);
            pixel += steps[number];
        }
        next[number] = pixel - pixels.end;
    }
    samples
}

/// Where a region's middle lies in the squares: between its ends along and across, without what sticks out. What
/// stands in a hall moves its mean, but not its ends.
fn middle(points: &[[f64; 2]], squares: &Squares) -> [f64; 2] {
    let places: Vec<[f64; 2]> = points.iter().map(|&point| squares.place(point)).collect();
    let ends = (STICKS_OUT * places.len() as f64) as usize;
    [0, 1].map(|axis| {
        let mut values: Vec<f64> = places.iter().map(|place| place[axis]).collect();
        // None of them is no number.
        let order = |a: &f64, b: &f64| a.partial_cmp(b).unwrap_or(Ordering::Equal);
        let mut ranked = |rank: usize| *values.select_nth_unstable_by(rank, order).1;
        f64::midpoint(ranked(ends), ranked(places.len() - 1 - ends))
    })
}

/// Row by row from the top, each row from the left.
fn sort_by_rows(regions: &mut [Region]) {
    regions.sort_by(|a, b| b.place[1].total_cmp(&a.place[1]));
    for row in regions.chunk_by_mut(|a, b| a.place[1] - b.place[1] <= ROW) {
        row.sort_by(|a, b| a.place[0].total_cmp(&b.place[0]));
    }
}
