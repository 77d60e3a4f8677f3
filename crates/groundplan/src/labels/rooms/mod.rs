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
mod doorways;
mod fill;
mod fine;
mod gaps;
mod heights;
mod islands;
mod joining;
mod leaves;
mod narrows;
mod openings;
mod outlines;
mod raster;
mod rays;
mod regions;
mod runs;
mod squared;

use super::near::{Near, Polygons};
use super::places::{Placed, Squares};
use super::recall::Recall;
use super::{Division, Evidence, Label};
use crate::grid::{Grid, State, tidy};
use cells::Rules;
use clearance::Clearance;
pub use clearance::Width;
pub use corridors::Corridor;
use doorways::Doorway;
use fine::Fine;
pub use gaps::Bar;
pub use raster::{Part, Raster};
use regions::Region;
pub use runs::{Run, touching};
use std::cell::LazyCell;

/// A gap and a narrow whose ends are this near are one opening; so are pieces of openings that come this near, metres.
const TOGETHER: f64 = 0.35;

/// Where there are racks: convex polygons in the map frame.
#[derive(Default)]
pub struct Racked {
    /// Ways along racks: all doors within them are gates, and what one fills between two doors is a passage.
    pub ways: Vec<Vec<[f64; 2]>>,
    /// Racks with a rim round them, and what these leave of their rows: no other doors are within them, either.
    pub rows: Vec<Vec<[f64; 2]>>,
    /// Racks that have others as deep across an aisle, with the rim: no gate's wall. What nobody saw between two halls may look
    /// like a rack, but has no such other.
    pub racks: Vec<Vec<[f64; 2]>>,
    /// What those leave of their rows: no gates lie there.
    pub left: Vec<Vec<[f64; 2]>>,
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
        let raster = Raster::new(grid, threads, recall)?;
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
        // Of gates most go again: they stand for no narrow.
        let near = Near::points(
            (0..).zip(&bars).filter(|(_, bar)| !bar.is_gate()).flat_map(|(n, gap)| gap.ends.map(|end| (n, end))),
        );
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
pub fn find<'d>(
    evidence: &Evidence,
    division: impl FnOnce() -> Division<'d>,
    space: &Space,
    mut bars: Vec<Bar>,
    first: usize,
    racked: &Racked,
    corridors: &[Corridor],
    squares: &Squares,
) -> Vec<Label> {
    let raster = &space.raster;
    let longest = bars.iter().map(Bar::length).fold(0.0, f64::max) * raster.resolution;
    let crossed = Near::polygons(&corridors.iter().map(|corridor| corridor.around(longest)).collect::<Vec<_>>());
    let [ways, rows, racks, left, grounds] =
        [&racked.ways, &racked.rows, &racked.racks, &racked.left, &racked.grounds].map(|all| Polygons::new(all));
    // The wall of a hall hangs together with what lies around the map.
    let border = LazyCell::new(|| islands::border(raster));
    let to_map = |place| evidence.grid.frame.to_metres(raster.to_grid(place));
    bars.retain(|bar| {
        let ends = bar.ends.map(to_map);
        let middle = [0, 1].map(|axis| f64::midpoint(ends[0][axis], ends[1][axis]));
        let Some(is_long) = bar.gate else {
            return !ways.hold(middle)
                && !rows.hold(middle)
                && !crossed.at(middle).iter().any(|&corridor| corridors[corridor as usize].is_crossed(ends));
        };
        let flanks = bar.flanks(raster).map(to_map);
        ways.hold(middle)
            && !racks.hold(middle)
            && !left.hold(middle)
            && (0..2).any(|side| is_long[side] && !racks.hold(flanks[side]))
            && bar.has_jamb_in(raster, &border)
    });
    let parameters = evidence.parameters;
    let rules = Rules { openness: parameters.rooms_openness, least_area: parameters.rooms_min_area };
    let cells = cells::find(raster, &bars, &rules, evidence.threads);
    let (regions, numbers) = regions::find(evidence, space, cells.regions, [&ways, &grounds], squares);
    let mut order = vec![0; regions.len() + 1];
    for (n, region) in regions.iter().enumerate() {
        order[region.number as usize] = n;
    }
    let doorways = doorways::find(raster, &numbers, cells.openings);
    let fine = Fine::new(evidence.grid, raster, numbers, regions.len());
    let mut outlines = outlines::find(&fine, regions.len(), evidence.recall, evidence.threads);
    let faces = faces(evidence, &division(), &fine, regions.len());
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
            purpose: region.purpose(raster, doors_of[number], area),
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
