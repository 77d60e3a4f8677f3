//! II-E: regions, the pieces of free space that a person calls a room, a hall or a corridor, and the doors between.
//!
//! Walls have gaps. Every gap in a line's structure ([`gaps`]) and every narrow of the free space ([`narrows`]) may be
//! a door, and most are not: the free space is cut along all of them, and pieces are joined again across each cut that
//! is about as wide as the space on one of its sides, the most open first ([`cells`]). A cut that stays is narrower
//! than what lies on both its sides: a door.

mod blocks;
mod cells;
mod clearance;
mod corridors;
mod fill;
mod fine;
mod gaps;
mod islands;
mod leaves;
mod narrows;
mod outlines;
mod raster;
mod runs;

use super::near::Near;
use super::places::{Placed, Squares};
use super::recall::Recall;
use super::{Division, Evidence, Label, Purpose, outline};
use crate::grid::{Grid, State, tidy};
use crate::subdivision::distance;
use cells::Rules;
use clearance::Clearance;
pub use clearance::Width;
pub use corridors::Corridor;
use fill::fill_runs;
use fine::Fine;
pub use gaps::Bar;
pub use raster::Raster;
use runs::{Run, Runs};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// What stands apart from all else is a region when it holds so much, square metres, and has room for a circle of such
/// a radius, metres: less is a ray through a window.
const ALONE: (f64, f64) = (0.5, 0.15);
/// A region is long when its area is so many times the square of its mean width.
const LONG: f64 = 4.2;
/// And a corridor when it has two doors, and one at least for so many metres of its length.
const DOOR_EVERY: f64 = 15.0;
/// Other regions at least so large are halls, square metres.
const HALL: f64 = 150.0;
/// Regions are in one row when no gap wider than this parts them across, metres.
const ROW: f64 = 1.0;
/// The regions beside a door lie within so many pixels of it; the nearest pixel may be under the cut itself.
const BESIDE: i32 = 8;
/// Openings between the same two regions are one when they are nearer than this share of their width.
const SAME: f64 = 0.75;
/// A gap and a narrow whose ends are this near are one opening; so are pieces of openings that come this near, metres.
const TOGETHER: f64 = 0.35;
/// Of a region's extent so much at each end does not count, and it is measured by about so many pixels.
const STICKS_OUT: f64 = 0.03;
const SAMPLES: usize = 2_000;
/// What lies for the most part within a rack, by so many looks, is a gap between its goods.
const LOOKS: usize = 200;

/// A region while its label is made.
struct Region {
    number: u32,
    pixels: usize,
    /// The pixel farthest from all walls.
    at: usize,
    /// Sum of all pixels' distances to the nearest wall.
    distances: f64,
    /// Its middle in the squares that give names.
    place: [f64; 2],
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
    /// Sum of all pixels' distances.
    distances: f64,
}

impl Piece {
    /// And a run more.
    fn add(&mut self, run: &Run, seen: usize, width: Width) {
        if self.pixels == 0 {
            self.first = run.pixels().start;
        }
        if self.pixels == 0 || width.most > self.widest {
            self.widest = width.most;
            self.at = run.pixels().start + width.at as usize;
        }
        self.region = run.number;
        self.pixels += run.len();
        self.seen += seen;
        self.distances += width.sum;
    }
}

/// Doors in the raster's places, and the two regions' numbers.
struct Doorway {
    between: [u32; 2],
    ends: [[f64; 2]; 2],
}

impl Doorway {
    fn middle(&self) -> [f64; 2] {
        [0, 1].map(|axis| f64::midpoint(self.ends[0][axis], self.ends[1][axis]))
    }

    fn width(&self) -> f64 {
        distance(self.ends[0], self.ends[1])
    }

    /// Another closure of the same opening, or another piece of it.
    fn is_same(&self, other: &Self, near: f64) -> bool {
        let touch = || self.ends.iter().any(|&p| other.ends.iter().any(|&q| distance(p, q) <= near));
        let overlap = distance(self.middle(), other.middle()) <= SAME * self.width().max(other.width());
        self.between == other.between && (overlap || touch())
    }

    /// Takes in another: from the one's end to the other's that lie farthest apart.
    fn extend(&mut self, other: &Self) {
        let all = [self.ends[0], self.ends[1], other.ends[0], other.ends[1]];
        for p in all {
            for q in all {
                if distance(p, q) > self.width() {
                    self.ends = [p, q];
                }
            }
        }
    }
}

/// Where there are racks: convex polygons in the map frame.
#[derive(Default)]
pub struct Racked {
    /// Ways along racks: no doors are within them.
    pub ways: Vec<Vec<[f64; 2]>>,
    /// What the racks stand on: what is free of it is no region.
    pub grounds: Vec<Vec<[f64; 2]>>,
}

/// The free space of a map.
pub struct Space {
    pub raster: Raster,
    clearance: Clearance,
    narrows: Vec<Bar>,
}

impl Space {
    /// Nothing when nothing is free.
    pub fn new(grid: &Grid, threads: usize, recall: &Recall) -> Option<Self> {
        let raster = Raster::new(grid, threads)?;
        let clearance = Clearance::new(&raster, threads);
        let mut narrows = narrows::find(&raster, &clearance, threads, recall);
        narrows.retain(|narrow| !narrow.is_at_solid(&raster));
        Some(Self { raster, clearance, narrows })
    }

    /// Everything that may be a door: gaps in walls, and narrows where there is no such gap.
    pub fn bars(&self, evidence: &Evidence) -> Vec<Bar> {
        let mut bars = gaps::along_lines(evidence, &self.raster);
        bars.retain(|bar| !bar.is_at_solid(&self.raster));
        let together = self.raster.pixels(TOGETHER);
        let ends: Vec<_> = (0..).zip(&bars).flat_map(|(n, gap)| gap.ends.map(|end| (n, end))).collect();
        let near = Near::points(&ends);
        let fresh = |narrow: &&Bar| {
            let about = near.about(narrow.ends[0], together);
            !about.into_iter().any(|gap| bars[gap as usize].is_near(narrow, together))
        };
        let narrows: Vec<Bar> = self.narrows.iter().filter(fresh).copied().collect();
        bars.extend(narrows);
        bars
    }
}

/// Regions, then the doors between them; `first` is the id of the first of these labels. What runs across one of the
/// corridors is no door.
#[expect(clippy::too_many_arguments, reason = "what the labels before are found from, and what they are")]
pub fn find(
    evidence: &Evidence,
    division: &Division,
    space: &Space,
    mut bars: Vec<Bar>,
    first: usize,
    racked: &Racked,
    corridors: &[Corridor],
    squares: &Squares,
) -> Vec<Label> {
    let Space { raster, clearance, .. } = space;
    let longest = bars.iter().map(Bar::length).fold(0.0, f64::max) * raster.resolution;
    let ways = Near::polygons(&racked.ways);
    let crossed = Near::polygons(&corridors.iter().map(|corridor| corridor.around(longest)).collect::<Vec<_>>());
    bars.retain(|bar| {
        let ends = bar.ends.map(|end| evidence.grid.frame.to_metres(raster.to_grid(end)));
        let middle = [0, 1].map(|axis| f64::midpoint(ends[0][axis], ends[1][axis]));
        !ways.at(middle).iter().any(|&way| outline::holds(&racked.ways[way as usize], middle))
            && !crossed.at(middle).iter().any(|&corridor| corridors[corridor as usize].is_crossed(ends))
    });
    let parameters = evidence.parameters;
    let rules = Rules { openness: parameters.rooms_openness, least_area: parameters.rooms_min_area };
    let cells = cells::find(raster, &bars, &rules);
    let (mut regions, numbers) = regions(evidence, raster, clearance, cells.regions, racked, squares);
    sort_by_rows(&mut regions);
    let mut order = vec![0; regions.len() + 1];
    for (n, region) in regions.iter().enumerate() {
        order[region.number as usize] = n;
    }
    let doorways = doorways(raster, &numbers, cells.openings);
    let fine = Fine::new(evidence.grid, raster, numbers, regions.len());
    let faces = faces(evidence, division, &fine, regions.len());
    let mut outlines = outlines::find(&fine, regions.len(), evidence.threads);
    let square = evidence.grid.frame.resolution.powi(2);
    let placed = |region: &Region| {
        let area = fine.areas[region.number as usize] as f64 * square;
        Placed { place: region.place, weight: area, size: area.sqrt() }
    };
    let places: Vec<Placed> = regions.iter().map(placed).collect();
    let mut doors_of = vec![0; regions.len() + 1];
    doorways.iter().flat_map(|door| door.between).for_each(|number| doors_of[number as usize] += 1);
    let mut labels: Vec<Label> = Vec::new();
    for (region, name) in regions.iter().zip(squares.names("R", &places)) {
        let number = region.number as usize;
        let to_map = |place| evidence.grid.frame.to_metres(place).map(tidy);
        let rings = std::mem::take(&mut outlines[number]);
        let mut rings = rings.into_iter().map(|ring| ring.into_iter().map(to_map).collect());
        let area = tidy(fine.areas[number] as f64 * square);
        labels.push(Label::Region {
            purpose: purpose(raster, region, doors_of[number], area),
            faces: faces[number].clone(),
            polygon: rings.next().unwrap_or_default(),
            holes: rings.collect(),
            at: to_map(raster.to_grid(raster.place(region.at))),
            area,
            name,
        });
    }
    let mut doors: Vec<([u32; 2], &Doorway)> = doorways
        .iter()
        .map(|door| {
            let mut between = door.between.map(|number| (first + order[number as usize]) as u32);
            between.sort_unstable();
            (between, door)
        })
        .collect();
    doors.sort_by_key(|(between, _)| *between);
    labels.extend(doors.into_iter().map(|(between, door)| {
        let to_map = |place| evidence.grid.frame.to_metres(raster.to_grid(place)).map(tidy);
        Label::Door {
            at: to_map(door.middle()),
            axis: door.ends.map(to_map),
            width: tidy(door.width() * raster.resolution),
            between,
        }
    }));
    labels
}

/// Makes every region one connected piece, leaves out what nobody could stand in, and numbers them from 1.
fn regions(
    evidence: &Evidence,
    raster: &Raster,
    clearance: &Clearance,
    mut numbers: Runs,
    racked: &Racked,
    squares: &Squares,
) -> (Vec<Region>, Runs) {
    let (pieces, count) = numbers.pieces();
    let mut all = vec![Piece::default(); count + 1];
    clearance.along(raster, &numbers, evidence.threads, evidence.recall, |n, width| {
        let seen = numbers.all[n].len() - raster.islands.filled.within(&numbers.all[n]);
        all[pieces[n] as usize].add(&numbers.all[n], seen, width);
    });
    let mut largest = BTreeMap::new();
    for (n, piece) in all.iter().enumerate().skip(1) {
        let best = largest.entry(piece.region).or_insert(n);
        if piece.pixels > all[*best].pixels {
            *best = n;
        }
    }
    let radius = raster.pixels(ALONE.1);
    let looks = if racked.grounds.is_empty() {
        Vec::new()
    } else {
        samples(&numbers, |n| pieces[n], &all.iter().map(|piece| piece.pixels).collect::<Vec<_>>(), LOOKS)
    };
    let grounds = Near::polygons(&racked.grounds);
    let within_rack = |n: usize| {
        let on_rack = |pixel: &usize| {
            let at = evidence.grid.frame.to_metres(raster.to_grid(raster.place(*pixel)));
            grounds.at(at).iter().any(|&ground| outline::holds(&racked.grounds[ground as usize], at))
        };
        looks.get(n).is_some_and(|looks| 2 * looks.iter().filter(|pixel| on_rack(pixel)).count() > looks.len())
    };
    let mut count = 0;
    let names: Vec<u32> = (0..all.len())
        .map(|n| {
            let piece = all[n];
            let least =
                if largest.get(&piece.region) == Some(&n) { ALONE.0 } else { evidence.parameters.rooms_min_area };
            let area = piece.seen as f64 * raster.resolution.powi(2);
            let stands = n > 0 && area >= least && f64::from(piece.widest) >= radius * radius && !within_rack(n);
            count += u32::from(stands);
            if stands { count } else { 0 }
        })
        .collect();
    numbers.all.iter_mut().zip(&pieces).for_each(|(run, &piece)| run.number = names[piece as usize]);
    drop(pieces);
    let numbers = fill_runs(raster, numbers);
    let mut regions: Vec<Region> =
        (1..=count).map(|number| Region { number, pixels: 0, at: 0, distances: 0.0, place: [0.0; 2] }).collect();
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
        if piece.widest > widest[place] || piece.widest == widest[place] && piece.at < region.at {
            (widest[place], region.at) = (piece.widest, piece.at);
        }
    }
    let counts: Vec<usize> = std::iter::once(0).chain(regions.iter().map(|region| region.pixels)).collect();
    for (region, pixels) in
        regions.iter_mut().zip(samples(&numbers, |n| numbers.all[n].number, &counts, SAMPLES).into_iter().skip(1))
    {
        region.place = middle(evidence, raster, &pixels, squares);
    }
    (regions, numbers)
}

/// Of the pixels of each number so many at most, evenly spaced; `number` is that of each run, `counts` says how many
/// pixels there are of each.
fn samples(runs: &Runs, number: impl Fn(usize) -> u32, counts: &[usize], most: usize) -> Vec<Vec<usize>> {
    let steps: Vec<usize> = counts.iter().map(|count| count.div_ceil(most).max(1)).collect();
    let mut next = vec![0; counts.len()];
    let mut samples = vec![Vec::new(); counts.len()];
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
fn middle(evidence: &Evidence, raster: &Raster, pixels: &[usize], squares: &Squares) -> [f64; 2] {
    let places =
        pixels.iter().map(|&pixel| squares.place(evidence.grid.frame.to_metres(raster.to_grid(raster.place(pixel)))));
    let places: Vec<[f64; 2]> = places.collect();
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

/// What is left between two different regions, each doorway once.
fn doorways(raster: &Raster, numbers: &Runs, openings: Vec<[[f64; 2]; 2]>) -> Vec<Doorway> {
    let mut found: Vec<Doorway> = Vec::new();
    // Between each pair of regions.
    let mut known: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for ends in openings {
        let [ux, uy] = Bar { ends }.heading();
        let door = Doorway { between: [0; 2], ends };
        let [x, y] = door.middle();
        let beside = |side: f64| {
            (2..=BESIDE)
                .map(|n| side * f64::from(n))
                .filter_map(|n| raster.at([x - uy * n, y + ux * n]))
                .map(|pixel| numbers.at(pixel))
                .find(|&number| number != 0)
                .unwrap_or(0)
        };
        let (left, right) = (beside(1.0), beside(-1.0));
        if left == 0 || right == 0 || left == right {
            continue;
        }
        let door = Doorway { between: [left.min(right), left.max(right)], ..door };
        let between = known.entry(door.between).or_default();
        if let Some(&n) = between.iter().find(|&&n| found[n].is_same(&door, raster.pixels(TOGETHER))) {
            found[n].extend(&door);
        } else {
            between.push(found.len());
            found.push(door);
        }
    }
    found
}

/// The free faces whose centres lie in each region, by its number.
fn faces(evidence: &Evidence, division: &Division, fine: &Fine, count: usize) -> Vec<Vec<u32>> {
    let mut faces = vec![Vec::new(); count + 1];
    for (face, &centre) in division.subdivision.centres.iter().enumerate() {
        if division.occupancy.states[face] == State::Free {
            faces[fine.at(evidence.grid.frame.to_pixels(centre)) as usize].push(face as u32);
        }
    }
    faces
}

/// By its shape, its doors and its square metres.
fn purpose(raster: &Raster, region: &Region, doors: usize, area: f64) -> Purpose {
    // The mean distance to the walls of a long strip is a quarter of its width.
    let width = 4.0 * region.distances / region.pixels as f64;
    let length = region.pixels as f64 / width;
    let is_long = length >= LONG * width && doors as f64 * raster.pixels(DOOR_EVERY) >= length;
    if doors >= 2 && is_long {
        Purpose::Corridor
    } else if area >= HALL {
        Purpose::Hall
    } else {
        Purpose::Room
    }
}
