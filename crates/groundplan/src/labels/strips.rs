//! II-E, the successor of Algorithm 1: corridors first, junctions where they meet.

use super::corridors::{self, Strip};
use super::junctions::{self, Meeting};
use super::turned::Turned;
use super::{Evidence, JunctionKind, Label, rooms};
use crate::grid::{State, tidy};

/// A corridor that meets no other is at least so many times as long as wide.
const ALONE: f64 = 4.0;
/// A corridor that meets one other goes on beyond it for so many times its width, or it is a niche at its side.
const NICHE: f64 = 1.5;

pub fn find(evidence: &Evidence) -> Vec<Label> {
    let views: Vec<Turned> = (0..evidence.directions.angles.len()).map(|d| Turned::new(evidence, d)).collect();
    let (strips, meetings) = connected(&views, corridors::find(evidence, &views));
    let mut extents = extents(&views, &strips, &meetings);
    let ends = junctions::ends(&views, &strips, &meetings);
    for &(n, side, place) in &ends {
        extents[n][side] = place;
    }
    let mut free: Vec<u32> = (0..evidence.subdivision.faces() as u32)
        .filter(|&face| evidence.occupancy.states[face as usize] == State::Free)
        .collect();
    let mut labels = Vec::new();
    let mut junctions: Vec<Label> = meetings
        .iter()
        .map(|meeting| {
            let polygon = square(&views, &strips, meeting);
            Label::Junction {
                kind: meeting.kind,
                faces: take(evidence, &mut free, &polygon),
                polygon,
                at: meeting.at.map(tidy),
                corridors: meeting.corridors.map(|c| c as u32).to_vec(),
            }
        })
        .collect();
    for &(n, side, place) in &ends {
        let strip = &strips[n];
        let view = &views[strip.direction];
        let inwards = if side == 0 { strip.width() } else { -strip.width() };
        let polygon = rectangle(view, [place.min(place + inwards), place.max(place + inwards)], strip.across);
        junctions.push(Label::Junction {
            kind: JunctionKind::End,
            faces: take(evidence, &mut free, &polygon),
            polygon,
            at: view.to_map([place, strip.middle()]).map(tidy),
            corridors: vec![n as u32],
        });
    }
    for (n, (strip, along)) in strips.iter().zip(&extents).enumerate() {
        let view = &views[strip.direction];
        let polygon = rectangle(view, *along, strip.across);
        labels.push(Label::Corridor {
            faces: take(evidence, &mut free, &polygon),
            polygon,
            axis: along.map(|u| view.to_map([u, strip.middle()]).map(tidy)),
            width: tidy(strip.width()),
            name: format!("A{:02}", n + 1),
        });
    }
    labels.extend(junctions);
    labels.extend(rooms::find(evidence, labels.len()));
    labels
}

/// A strip that leads nowhere is a niche: it goes, and what met it is judged again.
fn connected(views: &[Turned], mut strips: Vec<Strip>) -> (Vec<Strip>, Vec<Meeting>) {
    loop {
        let meetings = junctions::find(views, &strips);
        let leads = |n: usize| {
            let met = meetings.iter().filter(|m| m.corridors.contains(&n));
            let reach = met.clone().map(|m| m.reach[usize::from(m.corridors[1] == n)]).sum::<f64>();
            let beyond = strips[n].length() - reach;
            match met.count() {
                0 => strips[n].length() >= ALONE * strips[n].width(),
                1 => beyond >= NICHE * strips[n].width(),
                _ => true,
            }
        };
        let stays: Vec<bool> = (0..strips.len()).map(leads).collect();
        if stays.iter().all(|&s| s) {
            return (strips, meetings);
        }
        let mut flags = stays.into_iter();
        strips.retain(|_| flags.next().unwrap_or(false));
    }
}

/// Where each corridor begins and ends, along: its walled part, and on to the middle of the junctions at its ends.
fn extents(views: &[Turned], strips: &[Strip], meetings: &[Meeting]) -> Vec<[f64; 2]> {
    let mut extents: Vec<[f64; 2]> = strips.iter().map(|strip| strip.along).collect();
    for meeting in meetings {
        for corridor in meeting.corridors {
            let u = views[strips[corridor].direction].place(meeting.at)[0];
            extents[corridor][0] = extents[corridor][0].min(u);
            extents[corridor][1] = extents[corridor][1].max(u);
        }
    }
    extents
}

/// The piece that two corridors share, counter-clockwise.
fn square(views: &[Turned], strips: &[Strip], meeting: &Meeting) -> Vec<[f64; 2]> {
    let [one, two] = meeting.corridors.map(|c| &strips[c]);
    let heading = |strip: &Strip| {
        let angle = views[strip.direction].angle;
        [libm::cos(angle), libm::sin(angle)]
    };
    let (p, q) = (heading(one), heading(two));
    let [a, b] = meeting.reach;
    let mut corners: Vec<[f64; 2]> = [[-a, -b], [a, -b], [a, b], [-a, b]]
        .iter()
        .map(|[s, t]| [0, 1].map(|n| tidy(meeting.at[n] + s * p[n] + t * q[n])))
        .collect();
    if p[0] * q[1] - p[1] * q[0] < 0.0 {
        corners.reverse();
    }
    corners
}

/// A rectangle in a direction's own places, as a polygon in the map frame.
fn rectangle(view: &Turned, along: [f64; 2], across: [f64; 2]) -> Vec<[f64; 2]> {
    [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| view.to_map([along[u], across[v]]).map(tidy)).to_vec()
}

/// Takes the faces whose centres lie in a convex polygon out of those that are free.
fn take(evidence: &Evidence, free: &mut Vec<u32>, polygon: &[[f64; 2]]) -> Vec<u32> {
    let centres = &evidence.subdivision.centres;
    let (inside, outside) = free.iter().partition(|&&face| holds(polygon, centres[face as usize]));
    *free = outside;
    inside
}

/// True when a counter-clockwise convex polygon holds the point.
fn holds(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).all(|(p, q)| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) >= 0.0)
}
