//! II-E: junctions, where corridors meet; their type is the number of ways out.

pub(super) mod meeting;
pub(super) mod shut;

use super::beside::placed;
use super::corridors::{self, Strip};
use super::near::Near;
use super::rows::stacked::STACKED;
use super::rows::{self, DEPTH};
use super::view::turned::{Turned, least_sine};
use crate::bands::flat_map_each;
use crate::ends::{overlap, shared, sorted, wider};
use crate::subdivision::distance;
use meeting::{CLUTTER, FAR, LEAST_SINE, Meeting, SAME, meet, nearest, of_each};
use shut::{LOOK, goes_on, sign};
use std::collections::BTreeMap;

/// Junctions of the corridors, in the order of the corridors.
pub fn find(views: &[Turned], strips: &[Strip], threads: usize) -> Vec<Meeting> {
    // Where two may meet both their centre lines lead, each from as far as it may.
    let widest = corridors::widest(strips);
    let near = FAR + widest / 2.0 / least_sine(views, LEAST_SINE);
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
    let met = flat_map_each(strips.len(), threads, met_by);
    let mut met = led_from_afar(strips, met);
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
    found.retain_mut(|meeting| match meeting.kind_by_ways() {
        Some(kind) => {
            meeting.kind = kind;
            true
        }
        None => false,
    });
    found
}

/// Where corridors meet, but from afar only what is the first that one meets, over open floor, and another beside it, over a row,
/// meets too, from the same side: one from near, or from afar as this does.
fn led_from_afar(strips: &[Strip], met: Vec<Meeting>) -> Vec<Meeting> {
    let led = |meeting: &Meeting, n: usize| {
        let own = &strips[meeting.corridors[n]];
        meeting.led(n).map(move |(to, side)| ((to, own.direction, side), own)).collect::<Vec<_>>()
    };
    let nearest = nearest(&met, strips.len());
    let is_first = |meeting: &Meeting| {
        let mut from_afar = (0..2).filter(|&n| meeting.are_far()[n]);
        from_afar.all(|n| meeting.is_first(n, &nearest))
    };
    let (mut kept, mut far): (Vec<_>, Vec<_>) =
        met.into_iter().filter(is_first).partition(|meeting| meeting.are_far() == [false; 2]);
    // With a row between, be it as deep as any.
    let is_beside = |own: &Strip, other: &Strip| (-STACKED..=0.0).contains(&overlap(own.across, other.across));
    let mut known: BTreeMap<_, Vec<&Strip>> = BTreeMap::new();
    let mut next = 0;
    while next < kept.len() {
        for meeting in &kept[next..] {
            for (led, own) in [0, 1].map(|n| led(meeting, n)).into_iter().flatten() {
                known.entry(led).or_default().push(own);
            }
        }
        next = kept.len();
        let is_led = |(led, own): &(_, &Strip)| {
            known.get(led).is_some_and(|others| others.iter().any(|other| is_beside(own, other)))
        };
        let stays =
            |meeting: &Meeting| (0..2).filter(|&n| meeting.are_far()[n]).all(|n| led(meeting, n).iter().any(is_led));
        let (more, rest): (Vec<_>, Vec<_>) = far.into_iter().partition(stays);
        kept.extend(more);
        far = rest;
    }
    kept.sort_by(|one, two| one.corridors.cmp(&two.corridors));
    kept
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
            if is_met(view, strip, n, side, of_each[n].iter().map(|&m| &meetings[m])) {
                continue;
            }
            let beside = || {
                let near = placed[strip.direction].touching(strip.along, wider(strip.across, DEPTH.1)).into_iter();
                let others = near.filter(|m| *m != n).map(|m| &strips[m]);
                rows::facing(strip, others.filter(|other| overlap(other.along, strip.along) > 0.0))
            };
            let Some(place) = shut::end(view, strip, side, beside) else { continue };
            let near = placed[strip.direction].touching(wider([place; 2], LOOK), strip.across);
            if !near.into_iter().any(|m| m != n && goes_on_beside(view, strip, side, place, &strips[m])) {
                found.push((n, side, place));
            }
        }
    }
    found
}

/// True when a strip, by its number, meets another at one of its ends, of all that it meets.
pub fn is_met<'a>(
    view: &Turned,
    strip: &Strip,
    n: usize,
    side: usize,
    mut met: impl Iterator<Item = &'a Meeting>,
) -> bool {
    met.any(|meeting| {
        let place = meeting.corridors.iter().position(|c| *c == n);
        place.is_some_and(|p| {
            let u = view.place(meeting.at)[0];
            !goes_on(view, strip, side, (strip.along[side] - u) * sign(side) - meeting.reach[p.min(1)])
        })
    })
}

/// True when a strip that is closed at a place goes on past it as another of its direction, over floor that both share.
fn goes_on_beside(view: &Turned, strip: &Strip, side: usize, place: f64, other: &Strip) -> bool {
    let [low, high] = shared(strip.across, other.across);
    let between = sorted([place, other.along[1 - side]]);
    low < high
        && overlap(other.along, wider([place; 2], LOOK)) >= 0.0
        && (other.along[side] - place) * sign(side) >= strip.width()
        && view.mean_blocked(view.columns(between), low, high) <= CLUTTER
}
