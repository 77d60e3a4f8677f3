//! II-E: junctions, where corridors meet; their type is the number of ways out.

use super::beside::placed;
use super::corridors::{self, Strip};
use super::near::Near;
use super::turned::{Turned, least_sine};
use super::{JunctionKind, barriers};
use crate::bands::flat_map_each;
use crate::ends::{overlap, shared, sorted, wider};
use crate::grid::{angle_between, turned};
use crate::subdivision::distance;
use std::collections::BTreeMap;
use std::ops::Range;

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

/// A corridor goes on beyond a junction when it does so for this long, metres, and where a wall ends it, for this share
/// of its width: less is what is left of it at a corner.
const ARM: (f64, f64) = (1.6, 0.65);
/// What stands within this share of its width of a corridor's sides does not close it.
const MARGIN: f64 = 0.2;
/// A corridor that ends this far short of another still meets it, metres, when the way between is free.
const SHORT: f64 = 6.0;
/// But not where both lack sides for so long before they meet, metres, and no walls make a corner there.
const OPEN: f64 = 3.0;
/// Nothing stands in the way where no more than this share of a column is not free, without so much at the sides,
/// metres.
const CLUTTER: f64 = 0.33;
const SIDE: f64 = 0.2;
/// Corridors whose directions have an angle of a smaller sine do not meet.
const LEAST_SINE: f64 = 0.1;
/// Junctions nearer than this are one, metres.
const SAME: f64 = 1.5;
/// Ways out whose headings differ by less are one, and such that differ by so little from opposite are in line.
const SAME_WAY_DEG: f64 = 30.0;
/// Three ways that meet at less than this angle are a Y, degrees.
const SQUARE_DEG: f64 = 55.0;

/// Junctions of the corridors, in the order of the corridors.
pub fn find(views: &[Turned], strips: &[Strip], threads: usize) -> Vec<Meeting> {
    // Where two may meet both their centre lines lead, each from as far as it may.
    let widest = corridors::widest(strips);
    let near = SHORT + widest / 2.0 / least_sine(views, LEAST_SINE);
    let lines: Vec<_> = strips
        .iter()
        .map(|s| views[s.direction].rectangle([s.along[0] - near, s.along[1] + near], [s.middle(); 2]))
        .collect();
    let beside = Near::polygons(&lines);
    let met_by = |a: usize| {
        let others = beside.beside(&lines[a]).into_iter().map(|b| b as usize).filter(move |b| *b > a);
        let others = others.filter(move |b| strips[a].direction != strips[*b].direction);
        others.filter_map(move |b| meet(views, strips, [a, b]))
    };
    let mut met = flat_map_each(strips.len(), threads, met_by);
    let nearest = nearest(&met, strips.len());
    met.retain(|meeting| meeting.is_led_to(&nearest));
    let mut found: Vec<Meeting> = Vec::new();
    let mut places: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    for meeting in met {
        // A passage that goes on where an aisle ends is another corridor, but the junction is one.
        let [x, y] = meeting.at.map(|c| (c / SAME).floor() as i64);
        let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| [x + dx, y + dy]));
        let known = around.filter_map(|place| places.get(&place)).flatten();
        let is_same = |n: &&usize| {
            distance(found[**n].at, meeting.at) <= SAME
                && !are_beside(strips, &found[**n].corridors, &meeting.corridors)
        };
        if let Some(&other) = known.filter(is_same).min() {
            found[other].join(meeting);
        } else {
            places.entry([x, y]).or_default().push(found.len());
            found.push(meeting);
        }
    }
    lead_on(views, strips, &mut found);
    found.retain_mut(|meeting| match kind(&meeting.ways) {
        Some(kind) => {
            meeting.kind = kind;
            true
        }
        None => false,
    });
    found
}

/// True when of some corridors one runs beside one of others with something between them: these lead to two junctions, be
/// they as near as narrow aisles are.
fn are_beside(strips: &[Strip], some: &[usize], others: &[usize]) -> bool {
    let is_apart = |one: &Strip, two: &Strip| {
        one.direction == two.direction && overlap(one.across, two.across) < 0.0 && overlap(one.along, two.along) > SAME
    };
    some.iter().any(|&one| others.iter().any(|&two| is_apart(&strips[one], &strips[two])))
}

/// A corridor that leads from one junction to another is a way out of both, be what goes on there as wide as it is long.
fn lead_on(views: &[Turned], strips: &[Strip], found: &mut [Meeting]) {
    for (n, met) in of_each(found, strips.len()).into_iter().enumerate() {
        let view = &views[strips[n].direction];
        let mut along: Vec<(f64, usize)> = met.into_iter().map(|m| (view.place(found[m].at)[0], m)).collect();
        along.sort_by(|a, b| a.0.total_cmp(&b.0));
        for pair in along.windows(2) {
            let [(from, before), (to, after)] = [pair[0], pair[1]];
            if to - from > SAME || are_beside(strips, &found[before].corridors, &found[after].corridors) {
                found[before].lead(view.angle);
                found[after].lead(view.angle + std::f64::consts::PI);
            }
        }
    }
}

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
fn nearest(met: &[Meeting], corridors: usize) -> Vec<[f64; 2]> {
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
    /// True when neither corridor is led on past another junction to this one by way of what stands there.
    fn is_led_to(&self, nearest: &[[f64; 2]]) -> bool {
        self.corridors.iter().zip(&self.legs).all(|(&corridor, leg)| {
            leg.is_clear || (0..2).all(|side| leg.beyond[side] <= nearest[corridor][side] + SAME)
        })
    }

    /// There is a way out, if it is not known.
    fn lead(&mut self, way: f64) {
        if self.ways.iter().all(|own| turned(own - way).abs() > SAME_WAY_DEG.to_radians()) {
            self.ways.push(way);
        }
    }

    fn join(&mut self, other: Self) {
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

/// What a junction is by the headings of its ways out.
fn kind(ways: &[f64]) -> Option<JunctionKind> {
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

/// True when a corridor goes on beyond a junction by so much that it leads on.
pub fn goes_on(view: &Turned, strip: &Strip, side: usize, beyond: f64) -> bool {
    beyond >= ARM.0 && (beyond >= ARM.1 * strip.width() || closed(view, strip, side, LOOK).is_none())
}

fn meet(views: &[Turned], strips: &[Strip], pair: [usize; 2]) -> Option<Meeting> {
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
        let near = reach[n] + SHORT;
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
        let columns = view.column(from)..view.column(to) + 1;
        let [low, high] = inner(strip);
        if view.some_closed(columns.clone(), low, high).any() {
            return None;
        }
        let sides = [strip.across[0] + SIDE, strip.across[1] - SIDE];
        let blocked = view.some_blocked(columns.clone(), sides[0], sides[1]);
        // What was not seen before it leads to the first way only, as does what something stands in.
        let seen = !strip.unseen[usize::from(u > strip.along[1])];
        legs[n].is_clear = from == to || seen && blocked.into_iter().all(|blocked| blocked <= CLUTTER);
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

/// A corridor's end is looked for so far beyond its walls, metres.
const LOOK: f64 = 2.0;
/// It is shut when it is closed within so much, metres.
const SHUT: f64 = 1.0;
/// What closes it is this deep, metres, and lies across this share of its width.
const DEEP: f64 = 0.4;
const ACROSS: f64 = 0.5;
/// A thin wall stands in so many columns at most, where a border of cells parts it.
const THIN: i64 = 2;

/// Dead ends: the places along at which a corridor that meets no other there is closed by something seen. Where it
/// runs into the unknown, or opens into a hall, it has no end, nor where it goes on beside itself, as one that bends does.
/// Each with the corridor and which of its ends it is.
pub fn ends(views: &[Turned], strips: &[Strip], meetings: &[Meeting]) -> Vec<(usize, usize, f64)> {
    let mut found = Vec::new();
    let of_each = of_each(meetings, strips.len());
    let placed = placed(views, strips.iter().map(Strip::place));
    for (n, strip) in strips.iter().enumerate() {
        let view = &views[strip.direction];
        for side in [0, 1] {
            let met = of_each[n].iter().map(|&m| &meetings[m]).any(|meeting| {
                let place = meeting.corridors.iter().position(|c| *c == n);
                place.is_some_and(|p| {
                    let u = view.place(meeting.at)[0];
                    !goes_on(view, strip, side, (strip.along[side] - u) * sign(side) - meeting.reach[p.min(1)])
                })
            });
            if met {
                continue;
            }
            let Some(place) = closed(view, strip, side, LOOK) else { continue };
            let near = placed[strip.direction].touching(wider([place; 2], LOOK), strip.across);
            if !near.into_iter().any(|m| m != n && goes_on_beside(view, strip, side, place, &strips[m])) {
                found.push((n, side, place));
            }
        }
    }
    found
}

/// True when a strip that is closed at a place goes on past it as another of its direction, over floor that both share.
fn goes_on_beside(view: &Turned, strip: &Strip, side: usize, place: f64, other: &Strip) -> bool {
    let [low, high] = shared(strip.across, other.across);
    let [from, to] = sorted([place, other.along[1 - side]]);
    low < high
        && overlap(other.along, wider([place; 2], LOOK)) >= 0.0
        && (other.along[side] - place) * sign(side) >= strip.width()
        && view.mean_blocked(view.column(from)..view.column(to) + 1, low, high) <= CLUTTER
}

/// True when a wall closes a strip at one of its ends, be there a door in it.
pub fn is_shut(views: &[Turned], strip: &Strip, side: usize) -> bool {
    let view = &views[strip.direction];
    let end = strip.along[side];
    let [from, to] = [end - SHUT, end + SHUT].map(|u| view.column(u));
    closed(view, strip, side, SHUT).is_some() || barriers::across(view, strip.across, from..to + 1).any()
}

/// A strip without what stands at its sides, across.
fn inner(strip: &Strip) -> [f64; 2] {
    let margin = MARGIN * strip.width();
    [strip.across[0] + margin, strip.across[1] - margin]
}

/// Which way along a strip one of its ends lies.
fn sign(side: usize) -> f64 {
    if side == 0 { -1.0 } else { 1.0 }
}

/// Where what closes a strip so far beyond one of its ends begins.
pub fn closed(view: &Turned, strip: &Strip, side: usize, look: f64) -> Option<f64> {
    let sign = sign(side);
    let cells = |metres: f64| (metres / view.cell).ceil() as i64;
    let last = view.size[0] as i64 - 1;
    let start = view.column(strip.along[side] - 0.5 * sign * view.cell) as i64;
    let columns = (0..=cells(look)).map(|step| start + step * sign as i64).filter(|c| (0..=last).contains(c));
    let [low, high] = inner(strip);
    let first = columns.into_iter().find(|&c| view.is_closed(c as usize, low, high))?;
    // A wall that is not quite square to the corridor shows in several columns.
    let deep = (first - cells(DEEP)).max(0)..=(first + cells(DEEP)).min(last);
    let across: f64 = deep.clone().map(|c| view.occupied(c as usize, low, high)).sum();
    // Of one that is thinner than the samples are apart hardly any lies on a wall, and not all of a thin one may be hit.
    let is_wall = across >= ACROSS
        || deep.clone().any(|c| view.is_barred(c as usize, low, high))
        || deep.clone().any(|c| is_hit(view, c as usize..(c + THIN).min(last + 1) as usize, [low, high]));
    is_wall.then(|| view.along(first as usize) + if sign < 0.0 { view.cell } else { 0.0 })
}

/// True when something stands in some columns over as much of the way across as a wall does, be it ever so thin.
fn is_hit(view: &Turned, columns: Range<usize>, [low, high]: [f64; 2]) -> bool {
    let count = ((high - low) / view.cell).round().max(1.0);
    let place = |n: usize| low + (high - low) * n as f64 / count;
    let stands =
        |n: &usize| view.some_occupied(columns.clone(), place(*n), place(n + 1)).iter().any(|share| *share > 0.0);
    (0..count as usize).filter(stands).count() as f64 >= ACROSS * count
}
