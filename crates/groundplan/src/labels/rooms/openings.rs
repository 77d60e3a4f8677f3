//! Where the free space is cut: the pixels of bars, and the stretches of them that have a piece on either side.

use super::gaps::Bar;
use super::raster::Raster;
use super::runs::Runs;
use crate::ends::around;

/// Bars go on into their jambs for so many pixels, so that nothing slips past their ends.
const INTO_JAMBS: f64 = 4.0;
/// What lies beside a bar is looked for within so many pixels: bars may lie close together.
const BESIDE: i32 = 12;

/// A stretch of a bar, with a piece of free space on either side.
pub struct Stretch {
    pub pieces: [u32; 2],
    pub bar: usize,
    /// Pixels of the bar.
    pub pixels: Vec<usize>,
}

/// The free pixels under a bar, from its first end to its second.
pub fn pixels_of(raster: &Raster, bar: &Bar) -> Vec<usize> {
    let [ux, uy] = bar.heading();
    let [p, q] = bar.ends;
    let from = [p[0] - INTO_JAMBS * ux, p[1] - INTO_JAMBS * uy];
    let to = [q[0] + INTO_JAMBS * ux, q[1] + INTO_JAMBS * uy];
    // One pixel a step along the longer axis: pieces are joined by sides only, so a corner-to-corner line parts them.
    let steps = (to[0] - from[0]).abs().max((to[1] - from[1]).abs()).ceil().max(1.0);
    (0..=steps as usize)
        .map(|n| [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * n as f64 / steps))
        .filter_map(|place| raster.at(place).filter(|&pixel| raster.free.get(pixel)))
        .collect()
}

/// Each bar's stretches, in the bars' order.
pub fn stretches(raster: &Raster, bars: &[Bar], lines: &[Vec<usize>], pieces: &Runs) -> Vec<Stretch> {
    let mut found: Vec<Stretch> = Vec::new();
    for (bar, line) in lines.iter().enumerate() {
        let [ux, uy] = bars[bar].heading();
        let first = found.len();
        for &pixel in line {
            let [x, y] = raster.place(pixel);
            let piece = |side: f64| {
                (1..=BESIDE)
                    .map(|n| side * f64::from(n))
                    .map_while(|n| raster.at([x - uy * n, y + ux * n]).filter(|&beside| raster.free.get(beside)))
                    .map(|beside| pieces.at(beside))
                    .find(|&number| number != 0)
                    .unwrap_or(0)
            };
            let pieces = [piece(1.0), piece(-1.0)];
            if pieces.contains(&0) || pieces[0] == pieces[1] {
                continue;
            }
            match found[first..].iter_mut().find(|stretch| stretch.pieces == pieces) {
                Some(stretch) => stretch.pixels.push(pixel),
                None => found.push(Stretch { pieces, bar, pixels: vec![pixel] }),
            }
        }
    }
    found
}

/// Where a stretch begins and ends on its bar; at a jamb, when it comes near to one.
pub fn ends(raster: &Raster, bar: &Bar, pixels: &[usize]) -> [[f64; 2]; 2] {
    let [ux, uy] = bar.heading();
    let along = |&pixel: &usize| {
        let [x, y] = raster.place(pixel);
        (x - bar.ends[0][0]) * ux + (y - bar.ends[0][1]) * uy
    };
    let [low, high] = around(pixels.iter().map(along));
    let length = bar.length();
    // The bar's ends are centres of free pixels: the jambs are half a pixel farther.
    let low = if low <= INTO_JAMBS { -0.5 } else { low };
    let high = if high >= length - INTO_JAMBS { length + 0.5 } else { high };
    [low, high].map(|t| [bar.ends[0][0] + t * ux, bar.ends[0][1] + t * uy])
}
