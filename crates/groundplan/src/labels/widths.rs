//! Ways across rows are of one width: what leads through all rows of a place tells what leads through some of them.

use super::beside::{Beside, placed};
use super::corridors::{self, Strip};
use super::gates::{crossing, leading_across};
use super::rows::{self, Row};
use super::sections::is_as_bays;
use super::turned::Turned;
use super::whole;
use crate::ends::{overlap, sorted, wider};
use std::collections::BTreeMap;

/// Ways across a place are of one width but for this share.
const ALIKE: f64 = 0.15;
/// What leads through rows and on for so long, metres, is known by more than those.
const REST: f64 = 6.0;
/// A bay that is so much wider or narrower than a way, as a share of it, can be told from one.
const APART: f64 = 0.1;

/// A wall runs along a side where over this share of it so much of what lies so far beyond it, metres, is not free.
const WALL: f64 = 0.9;
const TAKEN: f64 = 0.5;
const BEYOND: f64 = 0.4;

/// How wide the ways of a direction are that are no bays, metres.
#[derive(Default)]
pub struct Widths(Vec<f64>);

impl Widths {
    /// Of some ways, for each direction.
    pub fn of<'a>(views: &[Turned], strips: impl Iterator<Item = &'a Strip>) -> Vec<Self> {
        let mut all: Vec<Self> = views.iter().map(|_| Self::default()).collect();
        strips.for_each(|strip| all[strip.direction].0.push(strip.width()));
        all
    }

    /// With one more.
    pub fn add(&mut self, width: f64) {
        self.0.push(width);
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// True when one is as wide, and a bay is not nearer to that.
    pub fn have(&self, width: f64, pitch: Option<f64>) -> bool {
        let is_like = |&own: &f64| {
            let off = (own - width).abs();
            let is_bay = pitch.is_some_and(|bay| (bay - own).abs() > APART * own && (bay - width).abs() < off);
            off <= ALIKE * width && !is_bay
        };
        self.0.iter().any(is_like)
    }
}

/// The strips without those that lead through some rows of a place and have no width of what leads through all: bays; nor
/// those at a wall that the rows beside go on to. Where nothing leads through all but past their ends, what has no bays'
/// width is none.
pub fn alike(views: &[Turned], strips: Vec<Strip>) -> Vec<Strip> {
    let placed = placed(views, strips.iter().map(Strip::place));
    let mut stays = vec![true; strips.len()];
    let places = Place::of_each(views, &strips, &placed);
    let along = longest(&places, strips.len());
    for (view, place) in views.iter().zip(&places) {
        let Some(other) = crossing(views, view.direction) else { continue };
        let through = Crossed::of_each([view, other], &strips, &placed, place, &along);
        let whole = |n: &usize| through[*n].rows >= 2 && through[*n].next.is_empty();
        let is_told_within = (0..strips.len()).filter(whole).any(|n| through[n].is_within);
        let known = Widths((0..strips.len()).filter(whole).map(|n| strips[n].width()).collect());
        for (n, crossed) in through.iter().enumerate() {
            let is_some = crossed.rows > 0 && !crossed.next.is_empty() && crossed.rest <= REST && !known.is_empty();
            // Where the rows beside it go on to the wall, one that does not is empty there.
            let is_bay = || crossed.rows == 1 && !crossed.is_led_on && is_at_wall(other, &strips[n]);
            let width = strips[n].width();
            // Ways past the rows' ends are as wide as the hall leaves, and tell nothing of what leads through the rows.
            let is_no_bay = || !is_told_within && view.pitch.is_some_and(|pitch| !is_as_bays(width, pitch));
            stays[n] &= !is_some || ((known.have(width, view.pitch) || is_no_bay()) && !is_bay());
        }
    }
    let mut flags = stays.into_iter();
    strips.into_iter().filter(|_| flags.next().unwrap_or(true)).collect()
}

/// How long the longest row is that each strip runs along, metres.
pub fn longest(places: &[Place], strips: usize) -> Vec<f64> {
    let mut along = vec![0.0_f64; strips];
    for Place { aisles, rows, .. } in places {
        for (row, n) in rows.iter().flat_map(|(row, between)| between.map(|n| (row, aisles[n]))) {
            along[n] = along[n].max(row.length());
        }
    }
    along
}

/// True when a wall runs all along one side of a strip.
fn is_at_wall(view: &Turned, strip: &Strip) -> bool {
    let columns = view.column(strip.along[0])..view.column(strip.along[1]) + 1;
    strip.across.into_iter().zip([-BEYOND, BEYOND]).any(|(side, beyond)| {
        let ends = sorted([side, side + beyond]);
        let taken = view.some_blocked(columns.clone(), ends[0], ends[1]);
        taken.iter().filter(|share| **share >= TAKEN).count() as f64 >= WALL * taken.len() as f64
    })
}

/// Between which strips there is nothing but walls between halls, where no other crosses them.
fn between_halls(views: &[Turned], strips: &[Strip]) -> BTreeMap<[usize; 2], bool> {
    let extents: Vec<[f64; 2]> = strips.iter().map(|strip| strip.along).collect();
    let rows = rows::between(views, strips, &extents);
    let are_walls = whole::are_between_halls(views, &rows.iter().collect::<Vec<_>>());
    let mut halls = BTreeMap::new();
    for (row, is_wall) in rows.iter().zip(are_walls) {
        row.between.into_iter().for_each(|between| *halls.entry(between).or_insert(true) &= is_wall);
    }
    halls
}

/// The aisles along a direction, and the rows between them, each with the two beside it.
pub struct Place {
    pub aisles: Vec<usize>,
    pub rows: Vec<(Row, [usize; 2])>,
    /// Which of the rows are walls between halls.
    walls: Vec<bool>,
}

impl Place {
    /// Of each direction.
    pub fn of_each(views: &[Turned], strips: &[Strip], placed: &[Beside]) -> Vec<Self> {
        let walls = between_halls(views, strips);
        views.iter().map(|view| Self::new(views, strips, placed, &walls, view.direction)).collect()
    }

    fn new(
        views: &[Turned],
        strips: &[Strip],
        placed: &[Beside],
        halls: &BTreeMap<[usize; 2], bool>,
        direction: usize,
    ) -> Self {
        let is_aisle = |n: &usize| strips[*n].direction == direction && !rows::is_within_row(strips, placed, *n);
        let aisles: Vec<usize> = (0..strips.len()).filter(is_aisle).collect();
        let own: Vec<Strip> = aisles.iter().map(|&n| strips[n].clone()).collect();
        let extents: Vec<[f64; 2]> = own.iter().map(|strip| strip.along).collect();
        let rows = rows::between(views, &own, &extents).into_iter();
        let rows: Vec<_> = rows.filter_map(|row| row.between.map(|between| (row, between))).collect();
        let is_wall = |between: [usize; 2]| halls.get(&between.map(|n| aisles[n])).is_some_and(|is_wall| *is_wall);
        let walls = rows.iter().map(|(_, between)| is_wall(*between)).collect();
        Self { aisles, rows, walls }
    }
}

/// What a strip crosses of the rows of a place.
#[derive(Clone, Default)]
pub struct Crossed {
    pub rows: usize,
    /// How long it is without what leads through them, from aisle to aisle, metres.
    rest: f64,
    /// Those beside them that it would lead through, were it longer.
    pub next: Vec<usize>,
    /// Another leads on through the next one, in line.
    is_led_on: bool,
    /// One of them goes on beyond both its sides.
    is_within: bool,
}

impl Crossed {
    /// Of each strip, where the rows lie between aisles, along which it is not.
    pub fn of_each(
        [view, other]: [&Turned; 2],
        strips: &[Strip],
        placed: &[Beside],
        Place { aisles, rows, walls }: &Place,
        along: &[f64],
    ) -> Vec<Self> {
        let widest = corridors::widest(strips);
        // Where a strip would cross a row if it were as long: along the strip, if it is none of the aisles' own kind.
        let place = |n: usize, row: &Row, between: [usize; 2]| {
            let strip = &strips[n];
            let shorter = between.map(|n| strips[aisles[n]].length()).into_iter().fold(f64::INFINITY, f64::min);
            let is_aisle = strip.length() >= shorter && along[n] >= row.length();
            if strip.direction != other.direction || is_aisle {
                return None;
            }
            let [s, u] = view.crossing(other, f64::midpoint(row.across[0], row.across[1]), strip.middle());
            // Past a row's end it leads where one of its sides does: further off the next hall may lie.
            let [from, to] = wider(row.along, strip.width() / 2.0);
            (from..=to).contains(&u).then_some((s, u))
        };
        let crosses_at = |n: usize, m: usize| place(n, &rows[m].0, rows[m].1);
        let crosses = |n: usize, s: f64| (strips[n].along[0]..=strips[n].along[1]).contains(&s);
        // The rows above and below each aisle.
        let mut beside: Vec<[Vec<usize>; 2]> = vec![Default::default(); aisles.len()];
        let mut crossed: Vec<Vec<usize>> = vec![Vec::new(); strips.len()];
        // And what leads through each row.
        let mut through: Vec<Vec<usize>> = vec![Vec::new(); rows.len()];
        for (m, (row, between)) in rows.iter().enumerate() {
            beside[between[0]][0].push(m);
            beside[between[1]][1].push(m);
            for n in leading_across([view, other], placed, row, widest) {
                if crosses_at(n, m).is_some_and(|(s, _)| crosses(n, s)) {
                    crossed[n].push(m);
                    through[m].push(n);
                }
            }
        }
        let of_strip = |(n, own): (usize, &Vec<usize>)| {
            let middle = |n: usize| strips[aisles[n]].middle();
            let led = |&m: &usize| middle(rows[m].1[1]) - middle(rows[m].1[0]);
            let rest = own.iter().map(led).fold(strips[n].length(), |rest, led| rest - led);
            let is_wall = |m: &usize| walls[*m] || own.iter().any(|&n| rows[*m].0.is_wall_beside(&rows[n].0));
            let beside = |m: usize| beside[rows[m].1[1]][0].iter().chain(&beside[rows[m].1[0]][1]);
            let next = || own.iter().flat_map(|&m| beside(m)).filter(|m| !is_wall(m));
            let ends_before = |m: &&usize| crosses_at(n, **m).is_some_and(|(s, _)| !crosses(n, s));
            let is_in_line = |&other: &usize| other != n && overlap(strips[n].across, strips[other].across) > 0.0;
            let is_led_on = next().any(|&m| through[m].iter().any(is_in_line));
            let is_within = own.iter().any(|&m| {
                let ([from, to], width) = (rows[m].0.along, strips[n].width());
                crosses_at(n, m).is_some_and(|(_, u)| from + width < u && u < to - width)
            });
            let next = next().filter(ends_before).copied().collect();
            Self { rows: own.len(), rest, next, is_led_on, is_within }
        };
        crossed.iter().enumerate().map(of_strip).collect()
    }
}
