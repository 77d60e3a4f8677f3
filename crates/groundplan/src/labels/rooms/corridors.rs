//! Corridors as the regions see them: what runs across one at its full width is no door in it.

use super::super::Label;
use super::gaps::Bar;
use crate::subdivision::distance;

/// What is open over so much of a corridor's width is no door across it,
const FULL: f64 = 0.75;
/// but within so many times its width of its ends and of what it meets, where a mouth may be one, over so much.
const NEAR: f64 = 1.0;
const FULL_NEAR: f64 = 0.95;

/// A corridor's centre line, its free width, and where it ends and meets others, metres from the line's first end.
pub struct Corridor {
    axis: [[f64; 2]; 2],
    width: f64,
    stops: Vec<f64>,
}

impl Corridor {
    /// The corridors among the labels.
    pub fn among(labels: &[Label]) -> Vec<Self> {
        let mut met_by = vec![Vec::new(); labels.len()];
        for label in labels {
            if let Label::Junction { at, corridors, .. } = label {
                for &id in corridors {
                    met_by[id as usize].push(*at);
                }
            }
        }
        let corridor = |(id, label): (usize, &Label)| match label {
            Label::Corridor { axis, width, .. } => {
                let bare = Self { axis: *axis, width: *width, stops: Vec::new() };
                let stops = met_by[id].iter().chain(axis).map(|point| bare.place(*point)[0]).collect();
                Some(Self { stops, ..bare })
            }
            _ => None,
        };
        labels.iter().enumerate().filter_map(corridor).collect()
    }

    /// True when a closure with these ends, metres in the map frame, runs across at about the full width.
    pub fn is_crossed(&self, ends: [[f64; 2]; 2]) -> bool {
        let [p, q] = ends.map(|end| self.place(end));
        let along = f64::midpoint(p[0], q[0]);
        let stop = self.stops.iter().map(|stop| (along - stop).abs()).fold(f64::INFINITY, f64::min);
        let full = if stop < NEAR * self.width { FULL_NEAR } else { FULL };
        let across = (q[1] - p[1]).abs();
        let within = (0.0..=distance(self.axis[0], self.axis[1])).contains(&along);
        within && p[1] * q[1] < 0.0 && across >= full * self.width && across >= (q[0] - p[0]).abs()
    }

    /// A rectangle that holds the middle of every closure that runs across, none of which is longer than so much,
    /// metres.
    pub fn around(&self, longest: f64) -> Vec<[f64; 2]> {
        let [from, to] = self.axis;
        let length = distance(from, to).max(1e-9);
        let [tx, ty] = Bar::new(self.axis).heading();
        let corner = |s: f64, t: f64| [from[0] + s * tx - t * ty, from[1] + s * ty + t * tx];
        let half = longest / 2.0;
        vec![corner(0.0, -half), corner(length, -half), corner(length, half), corner(0.0, half)]
    }

    /// A point's place along the centre line, from its first end, and across it.
    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        let [tx, ty] = Bar::new(self.axis).heading();
        let [x, y] = [0, 1].map(|n| point[n] - self.axis[0][n]);
        [x * tx + y * ty, y * tx - x * ty]
    }
}
