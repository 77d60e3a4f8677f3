//! II-E, the successor of Algorithm 1: corridors first, junctions where they meet.

use super::bays;
use super::corridors::{self, Strip};
use super::gates;
use super::junctions::{self, Meeting};
use super::names::{Named, names};
use super::near::Near;
use super::period::Period;
use super::pillars;
use super::places::Squares;
use super::racks::{self, Row};
use super::rooms::{self, Racked, Raster};
use super::turned::Turned;
use super::{Evidence, Ground, JunctionKind, Label, outline};
use crate::bands::{both, map_each};
use crate::grid::{State, tidy};

/// A corridor that meets no other is at least so many times as long as wide, and so long, metres.
const ALONE: (f64, f64) = (2.0, 5.0);
/// And one that is shut at both its ends, be it with a door, so many times: less is a room.
const SHUT: f64 = 4.5;
/// A corridor that meets one other goes on beyond it, on one side for so many times its width and so far, metres, or on
/// both together for as many times and so far: or it is a niche at the other's side.
const NICHE: (f64, f64) = (1.5, 2.5);
const NICHES: (f64, f64) = (2.2, 4.0);

/// So far round a rack there are no doors, metres.
const RIM: f64 = 0.4;

pub fn find(evidence: &Evidence, ground: &Ground) -> Vec<Label> {
    let bars = || ground.space.as_ref().map(|space| space.bars(evidence));
    let (bars, (views, plan)) = both(evidence.threads, bars, || {
        let count = evidence.directions.angles.len();
        // Each view shares its own work out among what threads are left.
        let own = Evidence { threads: evidence.threads / count.max(1), ..*evidence };
        let views = map_each(count, evidence.threads, |d| Turned::new(&own, &ground.look, d));
        let found = gates::without_bays(evidence, &ground.look, &views, corridors::find(evidence, &views));
        let mut plan = Plan::new(&views, found);
        let gates = gates::find(evidence, &ground.look, &views, &plan.strips, &plan.rows);
        if !gates.is_empty() {
            plan.strips.extend(gates);
            plan = Plan::new(&views, plan.strips);
        }
        (views, plan)
    });
    let Plan { strips, meetings, ends, extents, rows } = plan;
    let rows = if racks::are_here(&rows, &extents) { rows } else { Vec::new() };

    // A face is of one junction at most, and of one corridor.
    let mut faces = Faces::new(evidence, |state| state == State::Free);
    let junctions: Vec<Label> = meetings
        .iter()
        .map(|meeting| (meeting.kind, square(&views, &strips, meeting), meeting.at, meeting.corridors.clone()))
        .chain(ends.iter().map(|&(n, side, place)| {
            let (strip, view) = (&strips[n], &views[strips[n].direction]);
            let inwards = if side == 0 { strip.width() } else { -strip.width() };
            let along = [place.min(place + inwards), place.max(place + inwards)];
            let at = view.to_map([place, strip.middle()]);
            (JunctionKind::End, rectangle(view, along, strip.across), at, vec![n])
        }))
        .map(|(kind, polygon, at, corridors)| Label::Junction {
            kind,
            faces: faces.take(&polygon),
            polygon,
            at: at.map(tidy),
            corridors: corridors.into_iter().map(|c| c as u32).collect(),
        })
        .collect();
    let named = strips.iter().zip(&extents).map(|(strip, along)| Named {
        direction: strip.direction,
        across: strip.middle(),
        along: f64::midpoint(along[0], along[1]),
        weight: along[1] - along[0],
    });
    let names = names(&views, &named.collect::<Vec<_>>(), "A", "C");
    let mut faces = Faces::new(evidence, |state| state == State::Free);
    let mut labels: Vec<Label> = strips
        .iter()
        .zip(&extents)
        .zip(names)
        .map(|((strip, along), name)| {
            let view = &views[strip.direction];
            let polygon = rectangle(view, *along, strip.across);
            let axis = along.map(|u| view.to_map([u, strip.middle()]).map(tidy));
            Label::Corridor { faces: faces.take(&polygon), polygon, axis, width: tidy(strip.width()), name }
        })
        .collect();
    let racked = racked(&views, &strips, &extents, &meetings, &rows);
    labels.extend(junctions);
    let squares = squares(evidence, &views, &strips);
    labels.extend(rack_labels(evidence, &views, &rows, &squares));
    let (Some(space), Some(bars)) = (&ground.space, bars) else { return labels };
    let corridors = rooms::Corridor::among(&labels);
    labels.extend(rooms::find(evidence, space, bars, labels.len(), &racked, &corridors, &squares));
    let wider = |[low, high]: [f64; 2]| [low - pillars::RIM, high + pillars::RIM];
    let rack = |row: &Row| rectangle(&views[row.direction], wider(row.along), wider(row.across));
    let racks: Vec<_> = rows.iter().map(rack).collect();
    labels.extend(pillar_labels(evidence, &space.raster, &racks, &squares));
    labels
}

/// The racks' own ground, and, with a rim round it, the corridors along racks and those that cross them.
fn racked(views: &[Turned], strips: &[Strip], extents: &[[f64; 2]], meetings: &[Meeting], rows: &[Row]) -> Racked {
    if rows.is_empty() {
        return Racked::default();
    }
    let mut along: Vec<usize> = rows.iter().filter_map(|row| row.between).flatten().collect();
    along.sort_unstable();
    along.dedup();
    let aisles = along.clone();
    for meeting in meetings.iter().filter(|meeting| meeting.corridors.iter().any(|c| aisles.contains(c))) {
        along.extend(&meeting.corridors);
    }
    along.sort_unstable();
    along.dedup();
    let corridors = along.into_iter().map(|n| {
        let strip = &strips[n];
        rectangle(&views[strip.direction], extents[n], strip.across)
    });
    let grounds = rows.iter().filter(|row| row.between.is_some()).map(|row| {
        let wider = |[low, high]: [f64; 2]| [low - RIM, high + RIM];
        rectangle(&views[row.direction], wider(row.along), wider(row.across))
    });
    Racked {
        ways: corridors.chain(grounds).collect(),
        grounds: rows.iter().map(|row| rectangle(&views[row.direction], row.along, row.across)).collect(),
    }
}

/// The ways, what they meet and where they end, and the rows between them.
struct Plan {
    strips: Vec<Strip>,
    meetings: Vec<Meeting>,
    /// Dead ends: the corridor, which end of it, and the place along.
    ends: Vec<(usize, usize, f64)>,
    /// Where each corridor begins and ends, along, with its junctions.
    extents: Vec<[f64; 2]>,
    rows: Vec<Row>,
}

impl Plan {
    fn new(views: &[Turned], strips: Vec<Strip>) -> Self {
        let (mut strips, meetings) = connected(views, strips);
        // A corridor goes on to what it meets, and there it may be what another one meets.
        let longer = extents(views, &strips, &meetings);
        for (strip, along) in strips.iter_mut().zip(longer) {
            strip.along = [strip.along[0].min(along[0]), strip.along[1].max(along[1])];
        }
        let (strips, meetings) = connected(views, strips);
        let mut extents = extents(views, &strips, &meetings);
        let ends = junctions::ends(views, &strips, &meetings);
        for &(n, side, place) in &ends {
            extents[n][side] = place;
        }
        let rows = racks::find(views, &strips, &extents);
        Self { strips, meetings, ends, extents, rows }
    }
}

/// Squares along the direction that has most corridor, or where there is none, most structure.
fn squares(evidence: &Evidence, views: &[Turned], strips: &[Strip]) -> Squares {
    let length =
        |view: &Turned| strips.iter().filter(|s| s.direction == view.direction).map(Strip::length).sum::<f64>();
    let main = views.iter().rev().max_by(|a, b| length(a).total_cmp(&length(b)));
    Squares::new(main, evidence)
}

fn pillar_labels(evidence: &Evidence, raster: &Raster, racks: &[Vec<[f64; 2]>], squares: &Squares) -> Vec<Label> {
    let pillars = pillars::find(evidence, raster, racks);
    let items: Vec<_> = pillars.iter().map(|pillar| (squares.place(pillar.at), pillar.width)).collect();
    let names = squares.names("P", &items);
    let label = |(pillar, name): (&pillars::Pillar, String)| Label::Pillar {
        at: pillar.at.map(tidy),
        width: tidy(pillar.width),
        pattern: pillar.pattern,
        name,
    };
    pillars.iter().zip(names).map(label).collect()
}

fn rack_labels(evidence: &Evidence, views: &[Turned], rows: &[Row], squares: &Squares) -> Vec<Label> {
    let mut faces = Faces::new(evidence, |_| true);
    let middle = |row: &Row| {
        let place = [row.along, row.across].map(|ends| f64::midpoint(ends[0], ends[1]));
        squares.place(views[row.direction].to_map(place))
    };
    let items: Vec<_> = rows.iter().map(|row| (middle(row), row.along[1] - row.along[0])).collect();
    let names = squares.names("S", &items);
    let periods = bays::find(evidence, views, rows);
    rows.iter()
        .zip(periods)
        .zip(names)
        .map(|((row, period), name)| {
            let phase = |period: Period| (period.phase - row.along[0]).rem_euclid(period.pitch);
            let view = &views[row.direction];
            let polygon = rectangle(view, row.along, row.across);
            let middle = f64::midpoint(row.across[0], row.across[1]);
            Label::Rack {
                faces: faces.take(&polygon),
                polygon,
                axis: row.along.map(|u| view.to_map([u, middle]).map(tidy)),
                width: tidy(row.across[1] - row.across[0]),
                pitch: period.map(|period| tidy(period.pitch)),
                phase: period.map(|period| tidy(phase(period))),
                name,
            }
        })
        .collect()
}

/// A strip that leads nowhere is a niche: it goes, and what met it is judged again.
fn connected(views: &[Turned], mut strips: Vec<Strip>) -> (Vec<Strip>, Vec<Meeting>) {
    loop {
        let meetings = junctions::find(views, &strips);
        let met = junctions::of_each(&meetings, strips.len());
        let leads = |n: usize| {
            let met = met[n].iter().map(|&m| &meetings[m]);
            let is_niche = |meeting: &Meeting| {
                let strip = &strips[n];
                let at = views[strip.direction].place(meeting.at)[0];
                let reach = meeting.reach[usize::from(meeting.corridors[0] != n)];
                let beyond = strip.length() - reach;
                let both = strip.length() - 2.0 * reach;
                let arm = (at - reach - strip.along[0]).max(strip.along[1] - at - reach).min(beyond);
                let goes_on = |metres: f64, (widths, least): (f64, f64)| metres >= least.max(widths * strip.width());
                !goes_on(arm, NICHE) && !goes_on(both, NICHES)
            };
            match met.clone().count() {
                0 | 1 if racks::is_within_row(&strips, n) => false,
                0 if junctions::is_shut(views, &strips[n], 0) && junctions::is_shut(views, &strips[n], 1) => {
                    strips[n].length() >= SHUT * strips[n].width()
                }
                0 => strips[n].length() >= ALONE.1.max(ALONE.0 * strips[n].width()),
                1 => !met.clone().any(is_niche),
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

/// Where each corridor begins and ends, along: its walled part, and the middle of the junction at each end that it has
/// no arm beyond.
fn extents(views: &[Turned], strips: &[Strip], meetings: &[Meeting]) -> Vec<[f64; 2]> {
    let mut extents: Vec<[f64; 2]> = strips.iter().map(|strip| strip.along).collect();
    let all = || {
        let each = |m: &Meeting, p: usize| (m.corridors[p], m.reach[p.min(1)], m.at);
        meetings.iter().flat_map(move |m| (0..m.corridors.len()).map(move |p| each(m, p)))
    };
    let place = |n: usize, at: [f64; 2]| views[strips[n].direction].place(at)[0];
    for (n, reach, at) in all() {
        let (u, [low, high]) = (place(n, at), strips[n].along);
        for (side, beyond) in [(0, u - low), (1, high - u)] {
            if !junctions::goes_on(&views[strips[n].direction], &strips[n], side, beyond - reach) {
                extents[n][side] = u;
            }
        }
    }
    for (n, _, at) in all() {
        let u = place(n, at);
        extents[n] = [extents[n][0].min(u), extents[n][1].max(u)];
    }
    extents
}

/// The piece that two corridors share, counter-clockwise.
fn square(views: &[Turned], strips: &[Strip], meeting: &Meeting) -> Vec<[f64; 2]> {
    let [one, two] = [0, 1].map(|n| &strips[meeting.corridors[n]]);
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
    view.rectangle(along, across).into_iter().map(|corner| corner.map(tidy)).collect()
}

/// Faces that no label of a kind has yet.
struct Faces<'a> {
    centres: &'a [[f64; 2]],
    near: Near,
    left: Vec<bool>,
}

impl<'a> Faces<'a> {
    fn new(evidence: &Evidence<'a>, of: impl Fn(State) -> bool) -> Self {
        let centres = &evidence.subdivision.centres;
        let left: Vec<bool> = evidence.occupancy.states.iter().map(|state| of(*state)).collect();
        let points: Vec<_> =
            (0u32..).zip(centres).filter(|(face, _)| left[*face as usize]).map(|(face, at)| (face, *at)).collect();
        Self { centres, near: Near::points(&points), left }
    }

    /// Takes the faces whose centres lie in a convex polygon.
    fn take(&mut self, polygon: &[[f64; 2]]) -> Vec<u32> {
        let mut inside = self.near.within(polygon);
        inside.retain(|&face| self.left[face as usize] && outline::holds(polygon, self.centres[face as usize]));
        inside.sort_unstable();
        for &face in &inside {
            self.left[face as usize] = false;
        }
        inside
    }
}
