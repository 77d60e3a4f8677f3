//! II-A: what lines up along an angle, and what is left without it.

use crate::grid::Frame;
use crate::oriented::Oriented;
use crate::parameters::Parameters;
use crate::projection::{Across, Sum};
use crate::radiograms::{UNIT, metres_per_unit};

/// A pixel speaks for a direction when it lies within this angle of it, degrees.
pub const ALIGNED_DEG: f64 = 6.0;
/// A line shorter than this many pixels says nothing of a direction.
const SHORTEST_PIXELS: f64 = 20.0;
/// Half the window of the background that a line must stand out of, pixels.
const BACKGROUND_PIXELS: usize = 20;

/// Structure that lines up along an angle.
pub struct Aligned {
    /// Metres that stand out of the background as lines.
    pub metres: f64,
    /// And of one of them at most.
    pub longest: f64,
    /// How it was projected, and for each bin whether a line lies there.
    across: Across,
    on_line: Vec<bool>,
}

/// What lines up along an angle (radians, on the grid), of the pixels that are left.
pub fn aligned(frame: &Frame, rest: &Oriented, angle: f64, threads: usize) -> Aligned {
    let points = rest.along(angle, ALIGNED_DEG.to_radians());
    let across = points.across(angle, 1, 1);
    let mut sums = Vec::new();
    points.sums(&across, &mut sums, threads);
    let unit = metres_per_unit(frame, angle) / frame.resolution * UNIT as f64;
    let mut before = 0u64;
    let part = |&sum: &u64| u64::from(u64::on_bin(std::mem::replace(&mut before, sum), sum));
    let values: Vec<u64> = sums.iter().map(part).collect();
    let mut sum = 0;
    let add = |value: &u64| {
        sum += value;
        sum
    };
    let sums: Vec<u64> = std::iter::once(0).chain(values.iter().map(add)).collect();
    let over = |from: usize, to: usize| (sums[to.min(values.len())] - sums[from]) as f64 * unit;
    let mut on_line = vec![false; values.len()];
    let (mut metres, mut longest) = (0.0, 0.0_f64);
    let mut n = 1;
    while n + 1 < values.len() {
        let peak = over(n - 1, n + 2);
        n += 1;
        // Hardly any is as high.
        if peak <= SHORTEST_PIXELS || values[n - 1] < values[n - 2] || values[n - 1] <= values[n] {
            continue;
        }
        let (from, to) = ((n - 1).saturating_sub(BACKGROUND_PIXELS), (n + BACKGROUND_PIXELS).min(values.len()));
        let around = (over(from, to) - peak) / (to - from) as f64 * 3.0;
        if peak > 2.0 * around {
            let own = (peak - around) * frame.resolution;
            metres += own;
            longest = longest.max(own);
            on_line[n.saturating_sub(3)..(n + 2).min(values.len())].fill(true);
            n += 1;
        }
    }
    Aligned { metres, longest, across, on_line }
}

/// Takes out the pixels that lie on its lines.
pub fn take(rest: &mut Oriented, angle: f64, lines: &Aligned, parameters: &Parameters) {
    let tolerance = parameters.radiograms_tolerance_deg.to_radians();
    let is_on_line =
        |centre: [f32; 2]| lines.across.nearest(centre).and_then(|bin| lines.on_line.get(bin)).is_some_and(|on| *on);
    rest.remove(angle, tolerance, is_on_line);
}
