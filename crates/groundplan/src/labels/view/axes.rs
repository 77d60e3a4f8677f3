//! The places of one direction: along it, and across. Where another direction crosses it askew, as in a hall that is no
//! rectangle, places along lean with that one: what runs along the other then lies at one place, and what is asked of columns
//! of a view holds there as it does in a rectangle.

use super::turned::rectangle;
use crate::directions::Directions;

/// Two directions are square to each other but for an angle of this cosine: what drift has bent by less is a rectangle still.
pub const SQUARE: f64 = 0.06;
/// One leans with the other up to this cosine.
const ASKEW: f64 = 0.45;

/// A place p of the map frame lies at u = p.t - lean v along the direction and at v = p.n across it, metres, with t = (cos, sin)
/// and n = (-sin, cos).
#[derive(Clone, Copy)]
pub struct Axes {
    /// The direction's cosine and sine.
    pub heading: [f64; 2],
    /// How far along the direction what lies at one place along comes for each metre across.
    pub lean: f64,
}

impl Axes {
    /// Of one of some directions.
    pub fn of(directions: &Directions, direction: usize) -> Self {
        let angles = &directions.angles;
        let cos = |other: usize| libm::cos(angles[other] - angles[direction]);
        let partner = crossing(angles, direction).filter(|&other| {
            let by = cos(other).abs();
            (SQUARE..=ASKEW).contains(&by) && crossing(angles, other) == Some(direction)
        });
        let angle = angles[direction];
        let lean = partner.map_or(0.0, |other| cotangent(angles[other] - angle));
        Self { heading: [libm::cos(angle), libm::sin(angle)], lean }
    }

    /// Place along and across of a point of the map frame.
    pub fn place(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.heading;
        let v = y * cos - x * sin;
        [x * cos + y * sin - v * self.lean, v]
    }

    /// The point of the map frame at a place.
    pub fn to_map(self, [u, v]: [f64; 2]) -> [f64; 2] {
        let ([cos, sin], u) = (self.heading, u + v * self.lean);
        [u * cos - v * sin, u * sin + v * cos]
    }

    /// The corners in the map frame of what lies between places, counter-clockwise.
    pub fn rectangle(self, along: [f64; 2], across: [f64; 2]) -> [[f64; 2]; 4] {
        rectangle(along, across).map(|corner| self.to_map(corner))
    }
}

/// Of some directions the one that is most nearly square to one of them.
fn crossing(angles: &[f64], direction: usize) -> Option<usize> {
    let cos = |other: &usize| libm::cos(angles[*other] - angles[direction]).abs();
    (0..angles.len()).filter(|&other| other != direction).min_by(|a, b| cos(a).total_cmp(&cos(b)))
}

/// Of an angle.
pub fn cotangent(angle: f64) -> f64 {
    libm::cos(angle) / libm::sin(angle)
}
