//! The free space cut along all bars, and the pieces joined again where the way between them is no narrower than they
//! are: what stays apart are regions, and what parts them are their openings.

use super::fill::fill;
use super::gaps::Bar;
use super::joining::Joining;
use super::openings::{ends, pixels_of, stretches};
use super::raster::Raster;
use super::runs::{Runs, runs_of};

/// Regions by pixel, and the jambs of what parts them, in the raster's places.
pub struct Cells {
    pub regions: Runs,
    pub openings: Vec<[[f64; 2]; 2]>,
}

/// How openings are judged.
pub struct Rules {
    /// An opening wider than this share of the space on its tighter side parts nothing.
    pub openness: f64,
    /// Square metres; less is no region.
    pub least_area: f64,
}

/// Cuts the free space along all bars and joins what belongs together.
pub fn find(raster: &Raster, bars: &[Bar], rules: &Rules, threads: usize) -> Cells {
    let lines: Vec<Vec<usize>> = bars.iter().map(|bar| pixels_of(raster, bar)).collect();
    let mut cut: Vec<usize> = lines.iter().flatten().copied().collect();
    cut.sort_unstable();
    cut.dedup();
    let mut pieces = Runs::new(raster.width, raster.len(), runs_of(&raster.free, raster.len(), &cut));
    let (numbers, count) = pieces.pieces();
    pieces.all.iter_mut().zip(&numbers).for_each(|(run, &number)| run.number = number);
    drop(numbers);
    let stretches = stretches(raster, bars, &lines, &pieces);
    let (mut regions, names) = Joining::new(raster, bars, rules, &stretches, pieces, count).join_all(threads);
    regions.all.iter_mut().for_each(|run| run.number = names[run.number as usize]);
    let filled = fill(raster, &regions, &cut);
    let regions = regions.with(&filled);
    let openings = stretches
        .iter()
        .filter(|stretch| names[stretch.pieces[0] as usize] != names[stretch.pieces[1] as usize])
        .map(|stretch| ends(raster, &bars[stretch.bar], &stretch.pixels))
        .collect();
    Cells { regions, openings }
}
