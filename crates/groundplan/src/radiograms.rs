//! II-B: projection of the edge pixels along a direction, filtered by their gradients.

use crate::directions::Directions;
use crate::gradients::Gradients;
use crate::grid::{Frame, angle_between, tidy};
use crate::parameters::Parameters;

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
const UNIT: i64 = 16;
/// Below this magnitude a pixel has no direction of its own and counts a little in every one.
const SPECK_MAGNITUDE: i64 = 128;
/// A speck's share of a pixel's weight.
const SPECK_SHARE: i64 = 4;
/// Fixed-point bits of a normal vector.
const BITS: u32 = 20;
/// Fixed-point bits of the place between two bins.
const FRACTION_BITS: u32 = 4;
/// Sharpness is measured with 2^this many bins to the pixel, smoothed twice over so many bins.
const SHARP_BITS: u32 = 2;
const SMOOTHING: usize = 7;

/// Which pixels to project, and how much each weighs.
pub(crate) struct Selection {
    /// Column and row, doubled plus one: the pixel's centre in half pixels.
    centres: Vec<[i64; 2]>,
    weights: Vec<i64>,
    /// Their places among the gradients.
    pub indices: Vec<u32>,
}

impl Selection {
    /// The pixels that lie along `angle` (on the grid), within `tolerance`; with `specks` those without a direction
    /// count a little too, as the posts of a rack do.
    pub fn along(gradients: &Gradients, angle: f64, tolerance: f64, specks: bool) -> Self {
        let mut chosen = Self { centres: Vec::new(), weights: Vec::new(), indices: Vec::new() };
        let all = gradients.pixels.iter().zip(&gradients.angles).zip(&gradients.magnitudes);
        for (index, ((pixel, &along), &magnitude)) in all.enumerate() {
            let weight = weight(f64::from(along), magnitude, angle, tolerance, specks);
            if weight > 0 {
                chosen.indices.push(index as u32);
                chosen.centres.push(pixel.map(|p| 2 * i64::from(p) + 1));
                chosen.weights.push(weight);
            }
        }
        chosen
    }

    /// Sums of weights over offset, split between the two nearest bins, and the offset of the first bin in pixels.
    pub fn project(&self, frame: &Frame, angle: f64) -> (i64, Vec<i64>) {
        self.project_fine(frame, angle, 0)
    }

    /// The same with 2^`fine` bins to the pixel; the offset of the first is in bins.
    fn project_fine(&self, frame: &Frame, angle: f64, fine: u32) -> (i64, Vec<i64>) {
        let [nx, ny] = normal(angle);
        let (width, height) = (frame.width as i64, frame.height as i64);
        let corners = [0, nx * width, ny * height, nx * width + ny * height].map(|c| c >> (BITS - fine));
        let first = corners.into_iter().min().unwrap_or(0) - 2;
        let last = corners.into_iter().max().unwrap_or(0) + 2;
        let mut bins = vec![0i64; (last - first + 1) as usize];
        // Half pixels times 2^BITS to fractions of a bin, rounded; bins sit at whole pixels and between.
        let shift = BITS + 1 - fine - FRACTION_BITS;
        let half = 1 << (shift - 1);
        for ([x, y], weight) in self.centres.iter().zip(&self.weights) {
            let place = (nx * x + ny * y + half) >> shift;
            let bin = (place >> FRACTION_BITS) - first;
            let part = place & ((1 << FRACTION_BITS) - 1);
            bins[bin as usize] += weight * ((1 << FRACTION_BITS) - part);
            bins[bin as usize + 1] += weight * part;
        }
        (first, bins)
    }

    /// The bin that each pixel lies nearest to.
    pub fn bins(&self, angle: f64) -> impl Iterator<Item = i64> + '_ {
        let [nx, ny] = normal(angle);
        self.centres.iter().map(move |[x, y]| (nx * x + ny * y + (1 << BITS)) >> (BITS + 1))
    }

    /// Sum of squares of the projection: it is greatest where walls fall on single bins. The projection is finer than
    /// a pixel and smoothed over one, so that it does not matter where between the bins a wall falls: else an angle
    /// slightly off, at which the walls happen to fall upon bins, would look sharper than the right one.
    pub fn sharpness(&self, frame: &Frame, angle: f64) -> f64 {
        let (_, bins) = self.project_fine(frame, angle, SHARP_BITS);
        smooth(&smooth(&bins)).into_iter().map(|value| (value as f64).powi(2)).sum()
    }
}

/// Sums over [`SMOOTHING`] neighbouring bins; the ends where fewer are left are not missed, nothing lies there.
fn smooth(bins: &[i64]) -> Vec<i64> {
    let mut sum = 0;
    (0..bins.len() + SMOOTHING - 1)
        .map(|n| {
            sum += bins.get(n).unwrap_or(&0);
            sum -= n.checked_sub(SMOOTHING).map_or(0, |gone| bins[gone]);
            sum
        })
        .collect()
}

/// Normal of a direction in fixed point.
fn normal(angle: f64) -> [i64; 2] {
    let scale = f64::from(1u32 << BITS);
    [(-libm::sin(angle) * scale).round() as i64, (libm::cos(angle) * scale).round() as i64]
}

/// A pixel's weight along `angle`, from 0 to [`UNIT`].
pub(crate) fn weight(along: f64, magnitude: u8, angle: f64, tolerance: f64, specks: bool) -> i64 {
    let magnitude = i64::from(magnitude);
    if angle_between(along, angle) <= tolerance && (specks || magnitude >= SPECK_MAGNITUDE / 2) {
        UNIT
    } else if specks {
        UNIT * (SPECK_MAGNITUDE - magnitude).max(0) / (SPECK_MAGNITUDE * SPECK_SHARE)
    } else {
        0
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
) -> Vec<Radiogram> {
    let tolerance = parameters.radiograms_tolerance_deg.to_radians();
    let project = |(direction, &angle): (usize, &f64)| {
        let angle = frame.angle_to_grid(angle);
        let (first, bins) = Selection::along(gradients, angle, tolerance, true).project(frame, angle);
        let unit = metres_per_unit(frame, angle);
        // Turning by pi flips the normal, so the map frame's offsets may run the other way.
        let ends = [first, first + bins.len() as i64 - 1].map(|bin| frame.offset_to_map(angle, bin as f64));
        let mut values: Vec<f64> = bins.iter().map(|&bin| tidy(bin as f64 * unit)).collect();
        if ends[0] > ends[1] {
            values.reverse();
        }
        Radiogram { direction, start: tidy(ends[0].min(ends[1])), step: frame.resolution, values }
    };
    directions.angles.iter().enumerate().map(project).collect()
}
