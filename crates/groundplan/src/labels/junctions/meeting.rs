//! Where two corridors meet, and what each of them does there.

use super::shut::{LOOK, closed, goes_on, inner};
use crate::grid::{angle_between, turned};
use crate::labels::JunctionKind;
use crate::labels::corridors::barriers;
use crate::labels::corridors::{self, Strip};
use crate::labels::view::turned::Turned;

/// Where corridors meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Meeting {
    /// By its ways out.
    pub kind: JunctionKind,
    /// Its middle, metres in the map frame.
    pub at: [f64; 2],
    /// The two corridors that cross, and any others that lead here.
    pub corridors: Vec<usize>,
    /// Half of each of the first two corridors' piece within the junction, metres along that corridor.
    pub reach: [f64; 2],
    /// Headings of the ways out, radians in the map frame.
    ways: Vec<f64>,
    /// What each of the first two corridors does here.
    legs: [Leg; 2],
}

/// What a corridor does at a junction.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Leg {
    /// How far beyond each of its ends the middle lies, metres; less than nothing within.
    beyond: [f64; 2],
    /// It ends here, on which sides.
    ends: [bool; 2],
    /// Nothing stands in the way from its end to here.
    is_clear: bool,
}

/// A corridor that ends this far short of another still meets it, metres, when the way between is free.
const SHORT: f64 = 6.0;
/// And so far where it is the first that it meets, and others beside it meet it too.
pub const FAR: f64 = 13.0;
/// But not where both lack sides for so long before they meet, metres, and no walls make a corner there.
const OPEN: f64 = 3.0;
/// Nothing stands in the way where no more than this share of a column is not free, without so much at the sides,
/// metres.
pub const CLUTTER: f64 = 0.33;
const SIDE: f64 = 0.2;
/// Corridors whose directions have an angle of a smaller sine do not meet.
pub const LEAST_SINE: f64 = 0.1;
/// Junctions nearer than this are one, metres.
pub const SAME: f64 = 1.5;
/// Ways out whose headings differ by less are one, and such that differ by so little from opposite are in line.
const SAME_WAY_DEG: f64 = 30.0;
/// Three ways that meet at less than this angle are a Y, degrees.
const SQUARE_DEG: f64 = 65.0;

/// For each of so many corridors the junctions that it leads to, in their order.
pub fn of_each(meetings: &[Meeting], corridors: usize) -> Vec<Vec<usize>> {
    let mut found = vec![Vec::new(); corridors];
    for (n, meeting) in meetings.iter().enumerate() {
        meeting.corridors.iter().for_each(|&corridor| found[corridor].push(n));
    }
    found
}

/// How far beyond each of its ends each of so many corridors is led on, metres, to the first junction there: nowhere
/// where it ends in one already.
pub fn nearest(met: &[Meeting], corridors: usize) -> Vec<[f64; 2]> {
    let mut nearest = vec![[f64::INFINITY; 2]; corridors];
    for meeting in met {
        for (&corridor, leg) in meeting.corridors.iter().zip(&meeting.legs) {
            for (to, (ends, beyond)) in nearest[corridor].iter_mut().zip(leg.ends.iter().zip(leg.beyond)) {
                if *ends {
                    *to = to.min(beyond.max(0.0));
                }
            }
        }
    }
    nearest
}

impl Meeting {
    /// What it is by the headings of its ways out.
    pub fn kind_by_ways(&self) -> Option<JunctionKind> {
        let ways = &self.ways;
        let opposite = |a: f64, b: f64| turned(a - b).abs() > (180.0 - SAME_WAY_DEG).to_radians();
        let pairs = || (0..ways.len()).flat_map(|a| (a + 1..ways.len()).map(move |b| (ways[a], ways[b])));
        let square = pairs().all(|(a, b)| opposite(a, b) || angle_between(a, b).to_degrees() >= SQUARE_DEG);
        match ways.len() {
            0 | 1 => None,
            2 => (!opposite(ways[0], ways[1])).then_some(JunctionKind::L),
            3 if square && pairs().any(|(a, b)| opposite(a, b)) => Some(JunctionKind::T),
            3 => Some(JunctionKind::Y),
            _ => Some(JunctionKind::X),
        }
    }

    /// True when neither corridor is led on past another junction to this one by way of what stands there.
    pub fn is_led_to(&self, nearest: &[[f64; 2]]) -> bool {
        (0..2).all(|n| self.legs[n].is_clear || self.is_next(n, nearest))
    }

    /// True when one of its first two corridors leads here over open floor, and to no other before.
    pub fn is_first(&self, n: usize, nearest: &[[f64; 2]]) -> bool {
        self.legs[n].is_clear && self.is_next(n, nearest)
    }

    fn is_next(&self, n: usize, nearest: &[[f64; 2]]) -> bool {
        let nearest = nearest[self.corridors[n]];
        (0..2).all(|side| self.legs[n].beyond[side] <= nearest[side] + SAME)
    }

    /// Which of its first two corridors lead here from afar.
    pub fn are_far(&self) -> [bool; 2] {
        [0, 1].map(|n| self.legs[n].beyond.iter().any(|beyond| *beyond > SHORT + self.reach[n]))
    }

    /// To which corridor one of the first two leads here, and from which of its ends, or both.
    pub fn led(&self, n: usize) -> impl Iterator<Item = (usize, usize)> {
        let leads = (0..2).filter(move |side| !self.legs[n].ends[*side]);
        leads.map(move |side| (self.corridors[1 - n], side))
    }

    /// There is a way out, if it is not known.
    pub fn lead(&mut self, way: f64) {
        if self.ways.iter().all(|own| turned(own - way).abs() > SAME_WAY_DEG.to_radians()) {
            self.ways.push(way);
        }
    }

    /// Takes in another at the same place.
    pub fn join(&mut self, other: Self) {
        for way in other.ways {
            self.lead(way);
        }
        for corridor in other.corridors {
            if !self.corridors.contains(&corridor) {
                self.corridors.push(corridor);
            }
        }
    }
}

/// How two corridors meet, where they do.
pub fn meet(views: &[Turned], strips: &[Strip], pair: [usize; 2]) -> Option<Meeting> {
    let one = &strips[pair[0]];
    let two = &strips[pair[1]];
    let (first, second) = (&views[one.direction], &views[two.direction]);
    // The centre lines' crossing: n1.p = m1, n2.p = m2.
    let [(s1, c1), (s2, c2)] = [first, second].map(|v| (libm::sin(v.angle), libm::cos(v.angle)));
    let sine = s2 * c1 - s1 * c2;
    if sine.abs() < LEAST_SINE {
        return None;
    }
    let (m1, m2) = (one.middle(), two.middle());
    let at = [(m1 * c2 - m2 * c1) / sine, (m1 * s2 - m2 * s1) / sine];
    // Of most pairs one does not lead there: nothing else is asked of them.
    let places = [first, second].map(|view| view.place(at)[0]);
    let reach = [two, one].map(|other| other.width() / 2.0 / sine.abs());
    for (n, strip) in [one, two].into_iter().enumerate() {
        let near = reach[n] + FAR;
        if places[n] < strip.along[0] - near || places[n] > strip.along[1] + near {
            return None;
        }
        // Of two that run nearly the same way, one that is shorter than what they share does not cross the other.
        if sine.abs() < corridors::ASKEW && strip.length() < reach[n] {
            return None;
        }
    }
    let mut ways = Vec::new();
    let (mut led_on, mut shut) = ([false; 2], [false; 2]);
    let mut legs = [Leg { beyond: [0.0; 2], ends: [false; 2], is_clear: true }; 2];
    for (n, (strip, view)) in [(one, first), (two, second)].into_iter().enumerate() {
        let u = places[n];
        // The way from the corridor's end to the middle.
        let (from, to) = if u < strip.along[0] {
            (u, strip.along[0])
        } else if u > strip.along[1] {
            (strip.along[1], u)
        } else {
            (u, u)
        };
        let columns = view.columns([from, to]);
        let [low, high] = inner(strip);
        if view.some_closed(columns.clone(), low, high).any() {
            return None;
        }
        let sides = [strip.across[0] + SIDE, strip.across[1] - SIDE];
        let blocked = view.some_blocked(columns.clone(), sides[0], sides[1]);
        // Where it stops it leads to the first way only, as does what something stands in.
        let leads_on = !strip.stops[usize::from(u > strip.along[1])];
        legs[n].is_clear = from == to || leads_on && blocked.into_iter().all(|blocked| blocked <= CLUTTER);
        let has_door = barriers::across(view, strip.across, columns.clone()).any();
        if has_door || !barriers::stops(view, strip.across, columns).is_empty() {
            return None;
        }
        legs[n].beyond = [strip.along[0] - u, u - strip.along[1]];
        let short = [strip.held[0] - u, u - strip.held[1]];
        let side = usize::from(short[1] > short[0]);
        led_on[n] = short[side] - reach[n] > OPEN;
        let there = Strip { along: [u, u], ..strip.clone() };
        shut[n] = led_on[n] && closed(view, &there, side, reach[n] + LOOK).is_some();
        for (side, heading) in [(0, view.angle + std::f64::consts::PI), (1, view.angle)] {
            if goes_on(view, strip, side, -legs[n].beyond[side] - reach[n]) {
                ways.push(heading);
            } else {
                legs[n].ends[side] = true;
            }
        }
    }
    // Where neither has sides there, walls make the corner, or it is a place in a hall.
    if led_on == [true; 2] && shut != [true; 2] {
        return None;
    }
    Some(Meeting { kind: JunctionKind::X, at, corridors: pair.to_vec(), reach, ways, legs })
}
