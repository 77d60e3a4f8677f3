//! II-E: regions, the pieces of free space that a person calls a room, a hall or a corridor, and the doors between.
//!
//! Walls have gaps. Every gap in a line's structure ([`gaps`]) and every narrow of the free space ([`narrows`]) may be a
//! door, and most are not: the free space is cut along all of them, and pieces are joined again across each cut that is
//! about as wide as the space on one of its sides, the most open first ([`cells`]). A cut that stays is narrower than
//! what lies on both its sides: a door.

mod cells;
mod corridors;
mod gaps;
mod narrows;
mod outlines;
mod raster;

use super::places::Squares;
use super::{Evidence, Label, Purpose, outline};
use crate::grid::{State, tidy};
use crate::subdivision::distance;
use cells::Rules;
pub use corridors::Corridor;
use gaps::Bar;
pub use raster::Raster;

/// What stands apart from all else is a region when it holds so much, square metres, and has room for a circle of such a
/// radius, metres: less is a ray through a window.
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
const SAMPLES: usize = 20_000;
/// What lies for the most part within a rack, by so many looks, is a gap between its goods.
const LOOKS: usize = 200;

/// A region while its label is made.
struct Region {
    number: u32,
    pixels: Vec<usize>,
    /// The pixel farthest from all walls.
    at: usize,
    /// Its middle in the squares that give names.
    place: [f64; 2],
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

/// Regions, then the doors between them; `first` is the id of the first of these labels. What runs across one of the
/// corridors is no door.
pub fn find(
    evidence: &Evidence,
    raster: &Raster,
    first: usize,
    racked: &Racked,
    corridors: &[Corridor],
    squares: &Squares,
) -> Vec<Label> {
    let clearance = raster.clearance();
    let mut bars = bars(evidence, raster, &clearance);
    bars.retain(|bar| {
        let ends = bar.ends.map(|end| evidence.grid.frame.to_metres(raster.to_grid(end)));
        let middle = [0, 1].map(|axis| f64::midpoint(ends[0][axis], ends[1][axis]));
        !racked.ways.iter().any(|way| outline::holds(way, middle))
            && !corridors.iter().any(|corridor| corridor.is_crossed(ends))
    });
    let parameters = evidence.parameters;
    let rules = Rules { openness: parameters.rooms_openness, least_area: parameters.rooms_min_area };
    let mut cells = cells::find(raster, &bars, &rules);
    let mut regions = regions(evidence, raster, &clearance, &mut cells.regions, racked, squares);
    sort_by_rows(&mut regions);
    let mut order = vec![0; regions.len() + 1];
    for (n, region) in regions.iter().enumerate() {
        order[region.number as usize] = n;
    }
    let doorways = doorways(raster, &cells.regions, cells.openings);
    let faces = faces(evidence, raster, &cells.regions, regions.len());
    let places: Vec<_> = regions.iter().map(|region| (region.place, region.pixels.len() as f64)).collect();
    let mut labels: Vec<Label> = Vec::new();
    for (region, name) in regions.iter().zip(squares.names("R", &places)) {
        let doors = doorways.iter().filter(|door| door.between.contains(&region.number)).count();
        let to_map = |place| evidence.grid.frame.to_metres(place).map(tidy);
        let rings = outlines::rings(raster, &cells.regions, region.number, &region.pixels);
        let mut rings = rings.into_iter().map(|ring| ring.into_iter().map(to_map).collect());
        labels.push(Label::Region {
            purpose: purpose(raster, &clearance, region, doors),
            faces: faces[region.number as usize].clone(),
            polygon: rings.next().unwrap_or_default(),
            holes: rings.collect(),
            at: to_map(raster.to_grid(raster.place(region.at))),
            area: tidy(area(raster, &region.pixels)),
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

/// Everything that may be a door: gaps in walls, and narrows where there is no such gap.
fn bars(evidence: &Evidence, raster: &Raster, clearance: &[u32]) -> Vec<Bar> {
    let mut bars = gaps::along_lines(evidence, raster);

    bars.retain(|bar| !bar.is_at_solid(raster));
    let gaps = bars.len();
    for narrow in narrows::find(raster, clearance) {
        let known = bars[..gaps].iter().any(|gap| gap.is_near(&narrow, raster.pixels(TOGETHER)));
        if !known && !narrow.is_at_solid(raster) {
            bars.push(narrow);
        }
    }
    bars
}

/// Square metres that were seen free.
fn area(raster: &Raster, pixels: &[usize]) -> f64 {
    pixels.iter().filter(|&&pixel| raster.seen[pixel]).count() as f64 * raster.resolution.powi(2)
}

/// Makes every region one connected piece, leaves out what nobody could stand in, and numbers them from 1.
fn regions(
    evidence: &Evidence,
    raster: &Raster,
    clearance: &[u32],
    numbers: &mut [u32],
    racked: &Racked,
    squares: &Squares,
) -> Vec<Region> {
    let pieces = raster.pieces(|pixel| numbers[pixel] != 0, |a, b| numbers[a] == numbers[b]);
    let mut largest = std::collections::BTreeMap::new();
    for (n, list) in pieces.lists.iter().enumerate() {
        let best = largest.entry(numbers[list[0]]).or_insert(n);
        if list.len() > pieces.lists[*best].len() {
            *best = n;
        }
    }
    let radius = raster.pixels(ALONE.1);
    let within_rack = |list: &Vec<usize>| {
        let looks = list.iter().step_by(list.len().div_ceil(LOOKS));
        let on_rack = |&&pixel: &&usize| {
            let at = evidence.grid.frame.to_metres(raster.to_grid(raster.place(pixel)));
            racked.grounds.iter().any(|ground| outline::holds(ground, at))
        };
        2 * looks.clone().filter(on_rack).count() > looks.count()
    };
    let stands = |n: usize, list: &Vec<usize>| {
        let widest = list.iter().map(|&pixel| clearance[pixel]).max().unwrap_or(0);
        let least = if largest[&numbers[list[0]]] == n { ALONE.0 } else { evidence.parameters.rooms_min_area };
        area(raster, list) >= least && f64::from(widest) >= radius * radius && !within_rack(list)
    };
    let stays: Vec<bool> = pieces.lists.iter().enumerate().map(|(n, list)| stands(n, list)).collect();
    let mut next = 0;
    for (list, stays) in pieces.lists.iter().zip(stays) {
        next += u32::from(stays);
        for &pixel in list {
            numbers[pixel] = if stays { next } else { 0 };
        }
    }
    cells::fill_cuts(raster, numbers);
    let mut lists = vec![Vec::new(); next as usize];
    for (pixel, &number) in numbers.iter().enumerate().filter(|(_, number)| **number != 0) {
        lists[number as usize - 1].push(pixel);
    }
    let region = |(n, pixels): (usize, Vec<usize>)| {
        let at = pixels.iter().copied().max_by_key(|&pixel| (clearance[pixel], usize::MAX - pixel)).unwrap_or(0);
        let place = middle(evidence, raster, &pixels, squares);
        Region { number: n as u32 + 1, pixels, at, place }
    };
    lists.into_iter().enumerate().map(region).collect()
}

/// Where a region's middle lies in the squares: between its ends along and across, without what sticks out. What
/// stands in a hall moves its mean, but not its ends.
fn middle(evidence: &Evidence, raster: &Raster, pixels: &[usize], squares: &Squares) -> [f64; 2] {
    let step = pixels.len().div_ceil(SAMPLES);
    let places = pixels
        .iter()
        .step_by(step)
        .map(|&pixel| squares.place(evidence.grid.frame.to_metres(raster.to_grid(raster.place(pixel)))));
    let places: Vec<[f64; 2]> = places.collect();
    let ends = (STICKS_OUT * places.len() as f64) as usize;
    [0, 1].map(|axis| {
        let mut values: Vec<f64> = places.iter().map(|place| place[axis]).collect();
        values.sort_by(f64::total_cmp);
        f64::midpoint(values[ends], values[values.len() - 1 - ends])
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
fn doorways(raster: &Raster, numbers: &[u32], openings: Vec<[[f64; 2]; 2]>) -> Vec<Doorway> {
    let mut found: Vec<Doorway> = Vec::new();
    for ends in openings {
        let [ux, uy] = Bar { ends }.heading();
        let door = Doorway { between: [0; 2], ends };
        let [x, y] = door.middle();
        let beside = |side: f64| {
            (2..=BESIDE)
                .map(|n| side * f64::from(n))
                .filter_map(|n| raster.at([x - uy * n, y + ux * n]))
                .map(|pixel| numbers[pixel])
                .find(|&number| number != 0)
                .unwrap_or(0)
        };
        let (left, right) = (beside(1.0), beside(-1.0));
        if left == 0 || right == 0 || left == right {
            continue;
        }
        let door = Doorway { between: [left.min(right), left.max(right)], ..door };
        match found.iter_mut().find(|other| other.is_same(&door, raster.pixels(TOGETHER))) {
            Some(other) => other.extend(&door),
            None => found.push(door),
        }
    }
    found
}

/// The free faces whose centres lie in each region, by its number.
fn faces(evidence: &Evidence, raster: &Raster, numbers: &[u32], count: usize) -> Vec<Vec<u32>> {
    let mut faces = vec![Vec::new(); count + 1];
    for (face, &centre) in evidence.subdivision.centres.iter().enumerate() {
        let place = raster.of_grid(evidence.grid.frame.to_pixels(centre));
        if let Some(pixel) = raster.at(place)
            && evidence.occupancy.states[face] == State::Free
        {
            faces[numbers[pixel] as usize].push(face as u32);
        }
    }
    faces
}

/// By its shape and its doors. The mean distance to the walls of a long strip is a quarter of its width.
fn purpose(raster: &Raster, clearance: &[u32], region: &Region, doors: usize) -> Purpose {
    let all: f64 = region.pixels.iter().map(|&pixel| f64::from(clearance[pixel]).sqrt()).sum();
    let width = 4.0 * all / region.pixels.len() as f64;
    let length = region.pixels.len() as f64 / width;
    if length >= LONG * width && doors >= 2 && doors as f64 * raster.pixels(DOOR_EVERY) >= length {
        Purpose::Corridor
    } else if area(raster, &region.pixels) >= HALL {
        Purpose::Hall
    } else {
        Purpose::Room
    }
}
