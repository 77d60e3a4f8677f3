//! Ways along a wall before the heads of rows: where rows end each at its own place, what lies between them and the wall
//! has no line for its other side, and yet the aisles between the rows lead there.

use super::corridors::{Strip, UNTOLD};
use super::gates::crossing;
use super::junctions;
use super::racks::Row;
use super::ragged;
use super::turned::Turned;
use crate::parameters::Parameters;
use std::collections::BTreeMap;

/// An aisle is looked along so far beyond its end for the wall, beside the widest way, metres.
const SHORT: f64 = 6.0;
/// The wall is one where aisles side by side meet it this near to each other, metres.
const IN_LINE: f64 = 0.5;
/// So many rows side by side end before it, at least.
const ROWS: usize = 2;
/// The way is square to them but for an angle of this sine.
const SQUARE: f64 = 0.05;
/// A row stands where over this share of its depth it is not free, without so much of it at its faces.
const STANDS: f64 = 0.33;
const FACES: f64 = 0.2;
/// What is no more than this from the wall is the wall, metres.
const WALL: f64 = 0.3;
/// What is wider than the widest of the aisles by so many times is open floor.
const OPEN: f64 = 2.0;
/// What is no more than so many pitches of the rows may be their last bays, which are empty.
const BAY: f64 = 1.15;
/// No more than this share of the way is not free.
const CLEAR: f64 = 0.1;

/// The ways with those before the heads of rows that are not known, or are so in part; none where there are no such.
pub fn with(views: &[Turned], strips: &[Strip], rows: &[Row], parameters: &Parameters) -> Option<Vec<Strip>> {
    let mut all = strips.to_vec();
    let mut is_more = false;
    for view in views {
        let Some(other) = crossing(views, view.direction) else { continue };
        if libm::cos(other.angle - view.angle).abs() > SQUARE {
            continue;
        }
        for chain in chains(strips, rows, view.direction) {
            for side in [0, 1] {
                let heads = Heads { view, other, strips, side, parameters };
                for way in heads.ways(&chain) {
                    is_more |= add(&mut all, way);
                }
            }
        }
    }
    is_more.then_some(all)
}

/// Two aisles and the faces of the row between them.
#[derive(Clone, Copy)]
struct Between {
    aisles: [usize; 2],
    faces: [f64; 2],
}

/// The rows of a direction, of those between the same aisles one; such as follow one another together.
fn chains(strips: &[Strip], rows: &[Row], direction: usize) -> Vec<Vec<Between>> {
    let own = rows.iter().filter(|row| row.direction == direction);
    let pairs: BTreeMap<_, _> = own.filter_map(|row| row.between.map(|aisles| (aisles, row.across))).collect();
    let mut sorted: Vec<Between> = pairs.into_iter().map(|(aisles, faces)| Between { aisles, faces }).collect();
    sorted.sort_by(|a, b| strips[a.aisles[0]].middle().total_cmp(&strips[b.aisles[0]].middle()));
    let mut chains: Vec<Vec<Between>> = Vec::new();
    for row in sorted {
        let before = chains.iter_mut().find(|chain| chain.last().is_some_and(|last| last.aisles[1] == row.aisles[0]));
        match before {
            Some(chain) => chain.push(row),
            None => chains.push(vec![row]),
        }
    }
    chains
}

/// One side of the aisles of a direction.
struct Heads<'a> {
    view: &'a Turned,
    other: &'a Turned,
    strips: &'a [Strip],
    side: usize,
    parameters: &'a Parameters,
}

impl Heads<'_> {
    /// The ways between a wall and the rows of a chain that end before it.
    fn ways(&self, chain: &[Between]) -> Vec<Strip> {
        let least = self.parameters.labels_min_width;
        let before = |row: &Between| {
            let [one, two] = row.aisles.map(|n| self.wall(n));
            let (one, two) = (one?, two?);
            let free = self.free(row, f64::midpoint(one, two));
            ((one - two).abs() <= IN_LINE && free >= least).then_some((f64::midpoint(one, two), free))
        };
        let ends: Vec<Option<(f64, f64)>> = chain.iter().map(before).collect();
        let mut found = Vec::new();
        let mut from = 0;
        while from < chain.len() {
            let goes_on = |n: &usize| {
                let wall = |n: usize| ends[n].map(|(wall, _)| wall);
                wall(*n).zip(wall(from)).is_some_and(|(one, two)| (one - two).abs() <= IN_LINE)
            };
            let to = (from..chain.len()).find(|n| !goes_on(n)).unwrap_or(chain.len());
            if to - from >= ROWS {
                let of = |value: fn((f64, f64)) -> f64| ends[from..to].iter().flatten().map(move |&end| value(end));
                let wall = of(|(wall, _)| wall).sum::<f64>() / (to - from) as f64;
                let width = of(|(_, free)| free).fold(f64::INFINITY, f64::min);
                found.extend(self.way(&chain[from..to], wall, width));
            }
            from = to.max(from + 1);
        }
        found
    }

    /// Where what closes an aisle beyond its end begins.
    fn wall(&self, aisle: usize) -> Option<f64> {
        junctions::closed(self.view, &self.strips[aisle], self.side, SHORT + self.parameters.labels_max_width)
    }

    /// How far a row ends before a wall, metres; as far as is looked where it stands nowhere.
    fn free(&self, row: &Between, wall: f64) -> f64 {
        let most = SHORT + self.parameters.labels_max_width;
        let margin = FACES * (row.faces[1] - row.faces[0]);
        let away = if self.side == 0 { 1.0 } else { -1.0 };
        let ends = [wall + away * WALL, wall + away * most].map(|u| self.view.column(u));
        let columns = ends[0].min(ends[1])..ends[0].max(ends[1]);
        let blocked = self.view.some_blocked(columns, row.faces[0] + margin, row.faces[1] - margin);
        let stands = |share: &f64| *share > STANDS;
        let free = if self.side == 0 { blocked.iter().position(stands) } else { blocked.iter().rev().position(stands) };
        free.map_or(most, |free| WALL + free as f64 * self.view.cell)
    }

    /// The way past some rows, if it is free.
    fn way(&self, rows: &[Between], wall: f64, width: f64) -> Option<Strip> {
        let is_bay = self.view.pitch.is_some_and(|pitch| width <= BAY * pitch);
        let aisles = rows.iter().flat_map(|row| row.aisles).map(|n| self.strips[n].width()).fold(0.0, f64::max);
        if is_bay || width > self.parameters.labels_max_width.min(OPEN * aisles) {
            return None;
        }
        let (first, last) = (&self.strips[rows.first()?.aisles[0]], &self.strips[rows.last()?.aisles[1]]);
        let inner = if self.side == 0 { wall + width } else { wall - width };
        let corners = [[wall, first.across[0]], [inner, last.across[1]]];
        let [one, two] = corners.map(|place| self.other.place(self.view.to_map(place)));
        let [along, across] = [0, 1].map(|axis| [one[axis].min(two[axis]), one[axis].max(two[axis])]);
        let columns = self.other.column(along[0] + WALL)..self.other.column(along[1] - WALL);
        let margin = FACES * width;
        let [low, high] = [across[0] + margin, across[1] - margin];
        let is_clear = !self.other.some_closed(columns.clone(), low, high).any()
            && self.other.mean_blocked(columns, low, high) <= CLEAR;
        is_clear.then(|| Strip {
            direction: self.other.direction,
            along,
            across,
            score: along[1] - along[0],
            bays: false,
            is_ragged: true,
            held: UNTOLD,
        })
    }
}

/// Adds a way in place of what is known of it; false where all of it is.
fn add(all: &mut Vec<Strip>, mut way: Strip) -> bool {
    let own = way.along;
    let is_part = |strip: &Strip| strip.direction == way.direction && ragged::is_beside(strip, &way);
    let known = |strip: &Strip| strip.along[1].min(own[1]) - strip.along[0].max(own[0]);
    let parts: Vec<usize> = (0..all.len()).filter(|&n| is_part(&all[n])).collect();
    let longest = parts.iter().map(|&n| known(&all[n])).fold(0.0, f64::max);
    if longest > own[1] - own[0] - way.width() {
        return false;
    }
    for n in parts.into_iter().rev() {
        let part = all.remove(n);
        way.along = [way.along[0].min(part.along[0]), way.along[1].max(part.along[1])];
    }
    all.push(way);
    true
}
