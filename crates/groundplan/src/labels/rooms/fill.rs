//! Free pixels that are of no region yet are given to the regions beside them, those that are the nearest to walk to
//! first.

use super::raster::Raster;
use super::runs::Runs;
use crate::sets::Sets;

/// The numbers that some free pixels get, in ascending order as they are; none what no region is beside.
pub fn fill(raster: &Raster, regions: &Runs, pixels: &[usize]) -> Vec<(usize, u32)> {
    let mut numbers = vec![0u32; pixels.len()];
    // Step by step: what each takes is what lay beside it before the step.
    let mut edge: Vec<usize> = (0..pixels.len()).collect();
    loop {
        let beside = |&place: &usize| {
            let number = |pixel: usize| match regions.at(pixel) {
                0 => pixels.binary_search(&pixel).map_or(0, |other| numbers[other]),
                number => number,
            };
            let found = raster.sides(pixels[place]).into_iter().map(number).find(|&number| number != 0);
            found.map(|number| (place, number))
        };
        let found: Vec<(usize, u32)> = edge.iter().filter_map(beside).collect();
        for &(place, number) in &found {
            numbers[place] = number;
        }
        let next = found.iter().flat_map(|&(place, _)| raster.sides(pixels[place]));
        edge = next.filter_map(|pixel| pixels.binary_search(&pixel).ok()).filter(|&n| numbers[n] == 0).collect();
        edge.sort_unstable();
        edge.dedup();
        if edge.is_empty() {
            return pixels.iter().copied().zip(numbers).filter(|(_, number)| *number != 0).collect();
        }
    }
}

/// Gives runs that have no number, 0 for now, to the regions beside them.
pub fn fill_runs(raster: &Raster, mut regions: Runs) -> Runs {
    // What hangs together without a number is of the one region that it touches, or walked through. Few runs have none.
    let loose: Vec<u32> = (0..).zip(&regions.all).filter(|(_, run)| run.number == 0).map(|(n, _)| n).collect();
    let index = |run: usize| loose.binary_search(&(run as u32)).ok();
    let mut sets = Sets::new(loose.len());
    regions.beside(|one, other| {
        // Most have one, and none of these is looked up.
        if regions.all[one].number == 0
            && regions.all[other].number == 0
            && let (Some(one), Some(other)) = (index(one), index(other))
        {
            sets.join_first(one as u32, other as u32);
        }
    });
    let (sets, count) = sets.numbered();
    let mut touched = vec![Touched::None; count + 1];
    let mut touch = |run: usize, by: u32| {
        let Some(index) = index(run) else { return };
        let set = &mut touched[sets[index] as usize];
        *set = match *set {
            Touched::None => Touched::One(by),
            Touched::One(number) if number == by => Touched::One(number),
            _ => Touched::Many,
        };
    };
    regions.beside(|one, other| {
        let (a, b) = (regions.all[one].number, regions.all[other].number);
        match (a, b) {
            (0, 0) => {}
            (0, b) => touch(one, b),
            (a, 0) => touch(other, a),
            _ => {}
        }
    });
    let mut todo = Vec::new();
    for (&run, &set) in loose.iter().zip(&sets) {
        let run = &mut regions.all[run as usize];
        match touched[set as usize] {
            Touched::None => {}
            Touched::One(number) => run.number = number,
            Touched::Many => todo.extend(run.pixels()),
        }
    }
    let (width, pixels) = (regions.width, raster.len());
    regions.all.retain(|run| run.number != 0);
    let regions = Runs::new(width, pixels, regions.all);
    let filled = fill(raster, &regions, &todo);
    regions.with(&filled)
}

/// The regions that something without a number touches.
#[derive(Clone, Copy)]
enum Touched {
    None,
    One(u32),
    Many,
}
