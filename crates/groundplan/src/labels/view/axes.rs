//! The places of one direction: along it, and across. Where another direction crosses it askew, as in a hall that is no
//! rectangle, places along lean with that one: what runs along the other then lies at one place, and what is asked of columns
//! of a view holds there as it does in a rectangle.

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
        [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| self.to_map([along[u], across[v]]))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(angles: &[f64]) -> Vec<Axes> {
        let directions = Directions { angles: angles.to_vec(), ..Directions::default() };
        (0..angles.len()).map(|direction| Axes::of(&directions, direction)).collect()
    }

    #[test]
    fn what_runs_along_the_one_direction_lies_at_one_place_along_the_other() {
        for askew in [1.3_f64, 1.5, 1.64, 1.85] {
            let [one, two] = axes(&[0.2, 0.2 + askew])[..] else { unreachable!() };
            for (one, two) in [(one, two), (two, one)] {
                let [from, to] = [-7.0, 12.0].map(|u| one.place(two.to_map([u, 3.0]))[0]);
                assert!((from - to).abs() < 1e-9, "{askew}");
                let [u, v] = one.place(one.to_map([5.0, -2.0]));
                assert!((u - 5.0).abs() < 1e-9 && (v + 2.0).abs() < 1e-9, "{askew}");
            }
        }
    }

    #[test]
    fn nothing_leans_with_what_is_square_or_crossed_more_squarely_or_far_from_square() {
        for angles in [&[0.0, 1.57][..], &[0.0, 1.3, 1.57], &[0.0, 0.7]] {
            assert!(axes(angles).iter().all(|axes| axes.lean == 0.0), "{angles:?}");
        }
    }
}
