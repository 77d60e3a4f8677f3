//! II-B: projection of the edge pixels along a direction, filtered by their gradients.

use crate::bands::map_each;
use crate::directions::Directions;
use crate::gradients::Gradients;
use crate::grid::{Frame, angle_between, tidy};
use crate::parameters::Parameters;
use crate::projection::SHARE;

/// How much structure lies at each offset across one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Radiogram {
    /// Index of the direction.
    pub direction: usize,
    /// Offset of the first bin's centre along the direction's normal, metres in the map frame.
    pub start: f64,
    /// Bins are this far apart, metres: one pixel.
    pub step: f64,
    /// Metres of structure in each bin.
    pub values: Vec<f64>,
}

/// A weight of one pixel, in the whole numbers that projections are summed in.
pub(crate) const UNIT: i64 = 16;
/// Below this magnitude a pixel has no direction of its own and counts a little in every one.
const SPECK_MAGNITUDE: i64 = 128;
/// A speck's share of a pixel's weight.
const SPECK_SHARE: i64 = 4;
/// Fixed-point bits of a normal vector.
const BITS: u32 = 20;
/// Fixed-point bits of the place between two bins.
const FRACTION_BITS: u32 = 4;
/// Bits of a sum of weighed parts: more than those of all pixels that one bin can hold.
const PARTS_BITS: u32 = 36;

/// Sums of pixels' weights over offset across `angle` (on the grid), split between the two nearest bins, and the offset
/// of the first bin in pixels.
pub(crate) fn project(frame: &Frame, angle: f64, pixels: impl Iterator<Item = ([u32; 2], u64)>) -> (i64, Vec<i64>) {
    let [nx, ny] = normal(angle);
    let (width, height) = (frame.width as i64, frame.height as i64);
    let corners = [0, nx * width, ny * height, nx * width + ny * height].map(|c| c >> BITS);
    let first = corners.into_iter().min().unwrap_or(0) - 2;
    let last = corners.into_iter().max().unwrap_or(0) + 2;
    // For each place between two bins the sum of the weights, and in the lower bits that of their parts.
    let mut sums = vec![0u64; (last - first + 1) as usize];
    // Half pixels times 2^BITS to fractions of a bin, rounded; bins sit at whole pixels.
    let shift = BITS + 1 - FRACTION_BITS;
    let half = (1 << (shift - 1)) - (first << (shift + FRACTION_BITS));
    pixels.for_each(|(pixel, weight)| {
        let [x, y] = centre(pixel);
        let place = (nx * x + ny * y + half) >> shift;
        let part = place as u64 & ((1 << FRACTION_BITS) - 1);
        let sum = &mut sums[(place >> FRACTION_BITS) as usize];
        *sum = sum.wrapping_add(weight * (1 << PARTS_BITS | part));
    });
    let mut before = 0;
    let value = |sum: u64| {
        let (weight, parts) = ((sum >> PARTS_BITS) as i64, (sum & ((1 << PARTS_BITS) - 1)) as i64);
        (weight << FRACTION_BITS) - parts + std::mem::replace(&mut before, parts)
    };
    (first, sums.into_iter().map(value).collect())
}

/// Column and row, doubled plus one: the pixel's centre in half pixels.
fn centre(pixel: [u32; 2]) -> [i64; 2] {
    pixel.map(|p| 2 * i64::from(p) + 1)
}

/// Normal of a direction in fixed point.
fn normal(angle: f64) -> [i64; 2] {
    let scale = f64::from(1u32 << BITS);
    [(-libm::sin(angle) * scale).round() as i64, (libm::cos(angle) * scale).round() as i64]
}

/// True when a pixel of this magnitude has a direction of its own, by which alone it is judged.
pub(crate) fn has_direction(magnitude: u8) -> bool {
    i64::from(magnitude) >= SPECK_MAGNITUDE / 2
}

/// A pixel's weight along `angle`, from 0 to [`UNIT`]; one without a direction has a little along every one.
pub(crate) fn weight(along: f64, magnitude: u8, angle: f64, tolerance: f64) -> i64 {
    if angle_between(along, angle) <= tolerance {
        UNIT
    } else {
        UNIT * (SPECK_MAGNITUDE - i64::from(magnitude)).max(0) / (SPECK_MAGNITUDE * SPECK_SHARE)
    }
}

/// Metres of wall that one projected unit stands for: on a slanted wall the pixels of a staircase lie further apart.
pub(crate) fn metres_per_unit(frame: &Frame, angle: f64) -> f64 {
    let slant = libm::cos(angle).abs().max(libm::sin(angle).abs());
    frame.resolution / slant / (UNIT << FRACTION_BITS) as f64
}

/// The radiogram of each direction.
#[must_use]
pub fn find_radiograms(
    frame: &Frame,
    gradients: &Gradients,
    directions: &Directions,
    parameters: &Parameters,
    threads: usize,
) -> Vec<Radiogram> {
    let tolerance = parameters.radiograms_tolerance_deg.to_radians();
    let threads = if gradients.pixels.len() < SHARE { 1 } else { threads };
    map_each(directions.angles.len(), threads, |direction| {
        let angle = frame.angle_to_grid(directions.angles[direction]);
        // The pixels that lie along it; those without a direction count a little too, as the posts of a rack do.
        let weighed = gradients
            .iter()
            .map(|(pixel, along, magnitude)| (pixel, weight(f64::from(along), magnitude, angle, tolerance) as u64));
        let (first, bins) = project(frame, angle, weighed.filter(|(_, weight)| *weight > 0));
        let unit = metres_per_unit(frame, angle);
        // Turning by pi flips the normal, so the map frame's offsets may run the other way.
        let ends = [first, first + bins.len() as i64 - 1].map(|bin| frame.offset_to_map(angle, bin as f64));
        let mut values: Vec<f64> = bins.iter().map(|&bin| tidy(bin as f64 * unit)).collect();
        if ends[0] > ends[1] {
            values.reverse();
        }
        Radiogram { direction, start: tidy(ends[0].min(ends[1])), step: frame.resolution, values }
    })
}
