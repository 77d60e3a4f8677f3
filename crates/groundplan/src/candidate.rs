//! II-A: which of the angles that structure lines up along are directions of one ground plan.

use crate::aligned::ALIGNED_DEG;
use crate::grid::angle_between;
use crate::parameters::Parameters;
use std::f64::consts::FRAC_PI_2;

/// Where to look for what lines up by chance, degrees from a candidate.
pub const CONTROLS_DEG: [f64; 6] = [-26.0, -19.0, -13.0, 13.0, 19.0, 26.0];
pub const NONE_QUIET: [bool; CONTROLS_DEG.len()] = [false; CONTROLS_DEG.len()];
/// So many of the controls may lie on other directions.
const OTHERS_AMONG_CONTROLS: usize = 4;
/// Where there would be one direction only, a second one needs this share of its structure.
const SECOND: f64 = 0.04;
/// And one that is square to the first, to so many degrees, this share.
pub const SQUARE: (f64, f64) = (0.3, 0.015);
/// Two weak ones that are square to one another, to so many degrees, are a wing's when each has this share: what is no
/// wall lines up along one angle, if at all.
pub const WING: (f64, f64) = (1.0, 0.03);
/// Or one of them has this share, and the other this one, be it by chance.
const LONG_WING: (f64, f64) = (0.1, 0.015);
/// And a wall of so many metres: what is beveled has shorter ones along two such angles.
const WALL: f64 = 3.5;

/// Drift bends halls, so that the two directions of one are square to so many degrees only: then a weak one needs this share of
/// the other.
const BENT: (f64, f64) = (2.0, 0.1);

/// A direction that may be one.
#[derive(Clone, Copy)]
pub struct Candidate {
    pub angle: f64,
    /// The mean of what lies along it where the map is bent.
    pub mean: Option<f64>,
    /// Metres of structure that line up along it.
    pub metres: f64,
    /// And along one line of it at most.
    pub longest: f64,
    /// At which of the controls clearly less lines up: scattered pixels line up there as well as they do here.
    pub quiet: [bool; CONTROLS_DEG.len()],
}

impl Candidate {
    /// Clearly more lines up here than beside.
    pub fn exceeds_chance(&self) -> bool {
        self.quiet.iter().filter(|quiet| !**quiet).count() <= OTHERS_AMONG_CONTROLS
    }

    /// The same of a weak one: what lines up along strong ones and square to them tells nothing, of the rest one may.
    fn exceeds_chance_beside(&self, strong: &[Candidate]) -> bool {
        let near = ALIGNED_DEG.to_radians();
        let is_known = |turn: f64| strong.iter().any(|f| is_of(f, self.angle + turn.to_radians(), near));
        CONTROLS_DEG.iter().zip(self.quiet).filter(|&(turn, quiet)| !quiet && !is_known(*turn)).count() <= 1
    }
}

/// A ground plan has two directions, be it only by the ends of its racks, and so has each wing of it: of the weak ones
/// those square to a strong one that has no such other, or nearly so if they are longer. Beside a single one the second need
/// not be square. Where no two strong ones are square to one another the plan may be skewed, and goods square to its racks are
/// no second wing's ends: then each has such a weak one, or none has.
pub fn seconds(weak: &[Candidate], strong: &[Candidate]) -> Vec<Candidate> {
    let share = |f: &Candidate, to: &Candidate| match (is_square(f.angle, to, SQUARE.0), strong.len()) {
        (true, _) => SQUARE.1,
        (false, 1) => SECOND,
        (false, _) if is_square(f.angle, to, BENT.0) => BENT.1,
        (false, _) => f64::INFINITY,
    };
    let is_its =
        |f: &Candidate, to: &Candidate| f.metres >= share(f, to) * to.metres && f.exceeds_chance_beside(strong);
    let found: Vec<Candidate> = alone(strong).filter_map(|to| weak.iter().copied().find(|f| is_its(f, to))).collect();
    let is_skewed = alone(strong).count() == strong.len() && found.len() < strong.len();
    if is_skewed { Vec::new() } else { found }
}

/// Those of a wing that is small beside the whole: they are not known by strong ones, but by one another, two that are square
/// of which both are more than chance makes, or one that is long. What is so near to a strong one that its pixels speak for that
/// one too is a part of its hall that the map has turned.
pub fn wings(weak: &[Candidate], strong: &[Candidate], strongest: f64, parameters: &Parameters) -> Vec<Candidate> {
    let tolerance = parameters.radiograms_tolerance_deg.to_radians();
    let has = |f: &Candidate, share: f64| f.metres >= share * strongest && f.longest >= WALL;
    let is_known = |f: &Candidate| strong.iter().any(|to| is_of(to, f.angle, tolerance));
    let is_more = |f: &Candidate, share: f64| has(f, share) && f.exceeds_chance_beside(strong) && !is_known(f);
    let is_long_of = |f: &Candidate, short: &Candidate| is_more(f, LONG_WING.0) && has(short, LONG_WING.1);
    let is_of_wing = |f: &Candidate, other: &Candidate| {
        is_square(other.angle, f, WING.0)
            && (is_more(f, WING.1) && is_more(other, WING.1) || is_long_of(f, other) || is_long_of(other, f))
    };
    weak.iter().filter(|f| weak.iter().any(|other| is_of_wing(f, other))).copied().collect()
}

/// Those that have no other square to them, be the map bent a little.
pub fn alone(strong: &[Candidate]) -> impl Iterator<Item = &Candidate> {
    strong.iter().filter(|f| !strong.iter().any(|other| is_square(other.angle, f, BENT.0)))
}

/// True when an angle is within so much of a direction, or of what is square to it.
fn is_of(direction: &Candidate, angle: f64, within: f64) -> bool {
    let by = angle_between(direction.angle, angle);
    by <= within || FRAC_PI_2 - by <= within
}

/// True when an angle is square to a direction, to so many degrees.
pub fn is_square(angle: f64, to: &Candidate, within_deg: f64) -> bool {
    FRAC_PI_2 - angle_between(angle, to.angle) <= within_deg.to_radians()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(degrees: f64, metres: f64) -> Candidate {
        Candidate {
            angle: degrees.to_radians(),
            mean: None,
            metres,
            longest: metres,
            quiet: [true; CONTROLS_DEG.len()],
        }
    }

    #[test]
    fn the_ends_of_a_wing_count_beside_a_hall_that_drift_has_bent_and_not_beside_a_skewed_one() {
        let ends = candidate(-67.5, 60.0);
        for (second, count) in [(73.0, 1), (73.4, 1), (80.0, 0)] {
            let strong = [candidate(-17.1, 540.0), candidate(second, 510.0), candidate(22.4, 175.0)];
            assert_eq!(seconds(&[ends], &strong).len(), count, "{second}");
        }
    }

    #[test]
    fn drift_bends_the_ends_of_a_wing_too_and_then_they_are_longer() {
        let strong = [candidate(46.4, 540.0), candidate(-43.7, 245.0), candidate(-70.05, 103.0)];
        let count = |degrees: f64, metres: f64| seconds(&[candidate(degrees, metres)], &strong).len();
        assert_eq!([count(20.0, 5.0), count(20.3, 5.0), count(22.2, 71.0)], [1, 0, 0]);
        assert_eq!([count(20.3, 71.0), count(21.5, 71.0)], [1; 2]);
    }

    #[test]
    fn two_weak_directions_without_a_wall_are_no_wing() {
        let strong = [candidate(0.0, 370.0), candidate(90.0, 220.0)];
        let count = |longest: f64| {
            let weak = [-45.0, 45.0].map(|degrees| Candidate { longest, ..candidate(degrees, 21.0) });
            wings(&weak, &strong, 370.0, &Parameters::default()).len()
        };
        assert_eq!([count(2.9), count(8.0)], [0, 2]);
    }
}
