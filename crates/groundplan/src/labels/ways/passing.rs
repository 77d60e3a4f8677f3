//! What ways across rows pass through of the rows of a place, and beside which others they end.

use super::across::{crossing, leading_across};
use super::closed;
use super::seldom::{self, Rest};
use crate::ends::{holds, overlap, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::family;
use crate::labels::corridors::{self, Strip};
use crate::labels::rows::sections::{self, is_as_bays};
use crate::labels::rows::shelves::Shelves;
use crate::labels::rows::whole;
use crate::labels::rows::{self, Row};
use crate::labels::view::turned::Turned;
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

/// What leads through a row of two racks is no narrower than this share of the aisles beside it.
const NARROWER: f64 = family::LED_TO;

/// What is wider than what chance seldom makes so often, it makes less often still: places so many times as wide tell, where few of
/// them are as wide as bays.
const NARROWED: f64 = 0.9;

/// What some of the goods leave is as wide as they are but for so much, metres.
const BETWEEN_GOODS: f64 = 0.2;
/// Fewer such ways may be bays that are empty by a part.
const SEVERAL: usize = 3;

/// The aisles along a direction that another one crosses, and the rows between them.
pub struct Place<'a> {
    /// Of the direction that the rows run along, and of the one that crosses it.
    pub views: [&'a Turned; 2],
    pub aisles: Vec<usize>,
    /// Each with the two aisles beside it.
    pub rows: Vec<(Row, [usize; 2])>,
    /// Of each strip.
    pub passing: Vec<Passing>,
    /// Which strips lead through each row.
    pub through: Vec<Vec<usize>>,
    /// Above and below each aisle.
    beside: Vec<[Vec<usize>; 2]>,
    /// Which of the rows are walls between halls.
    walls: Vec<bool>,
    /// From post to post along each row, once it is asked.
    pitches: Vec<OnceCell<Option<f64>>>,
    /// What of each row is open, once it is asked.
    shelves: Vec<OnceCell<Shelves>>,
}

impl<'a> Place<'a> {
    /// Of each direction that another one crosses.
    pub fn of_each(views: &'a [Turned], strips: &[Strip]) -> Vec<Self> {
        let placed = placed(views, strips.iter().map(Strip::place));
        let halls = between_halls(views, strips);
        let all: Vec<Layout> = views.iter().map(|view| Layout::new(views, strips, &placed, &halls, view)).collect();
        let along = longest(&all, strips.len());
        let of = |layout: Layout<'a>| {
            let views = [layout.view, crossing(views, layout.view.direction)?];
            let (passing, through) = layout.passed_by(views, strips, &placed, &along);
            let Layout { aisles, rows, beside, walls, .. } = layout;
            let pitches = rows.iter().map(|_| OnceCell::new()).collect();
            let shelves = rows.iter().map(|_| OnceCell::new()).collect();
            Some(Self { views, aisles, rows, passing, through, beside, walls, pitches, shelves })
        };
        all.into_iter().filter_map(of).collect()
    }
}

impl Place<'_> {
    /// True when the rows that something passes through are with those side by side with them open more often than by chance:
    /// of two racks each, or hardly open elsewhere, or solid where it is as wide as no bay and nothing leads through them all, or no
    /// number of goods is as wide.
    pub fn is_open_through(&self, strips: &[Strip], own: &Passing, width: f64) -> bool {
        let Some(first) = self.first_of(own) else { return false };
        let part = self.rows_with(first);
        let rows = || part.iter().map(|&row| self.shelves(row));
        let may_be_bay = || self.is_as_bays(own, width) || !self.lead_through_all(&part).is_empty();
        let is_full = || {
            let rest = Rest::new(self.views[0], rows(), width);
            rest.is_full() || rest.is_solid() && !may_be_bay()
        };
        let is_as_no_goods = || {
            self.is_no_number_of_goods(own, width)
                && self.count_within(&part) >= SEVERAL
                && closed::is_way(self, strips, own, width)
        };
        let pitch = self.pitch_of(own);
        let are_open =
            |width: f64, are_no_bays: bool| seldom::are_open(self.views[0], rows(), width, pitch, are_no_bays);
        own.is_within && (is_full() || is_as_no_goods())
            || self.are_double(own)
                && self.is_as_aisles(strips, own, width)
                && (are_open(width, false) || are_open(NARROWED * width, true))
    }

    /// True when goods are told along the rows that something passes through, and no number of them leaves such a width.
    fn is_no_number_of_goods(&self, own: &Passing, width: f64) -> bool {
        let view = self.views[0];
        let is_common = || self.pitch_of(own) == view.pitch;
        view.goods().is_some_and(|goods| is_no_number_of(goods, width) && is_common())
    }

    /// How many lead through rows of a part of the place, between their ends.
    fn count_within(&self, part: &BTreeSet<usize>) -> usize {
        let ways = part.iter().flat_map(|&row| &self.through[row]).filter(|way| self.passing[**way].is_within);
        ways.collect::<BTreeSet<_>>().len()
    }

    /// True when all rows that something passes through may be of two racks.
    pub fn are_double(&self, own: &Passing) -> bool {
        own.rows.iter().all(|&row| seldom::is_double(&self.rows[row].0))
    }

    /// The least width of what leads through the rows that something passes through, metres.
    pub fn least(&self, strips: &[Strip], own: &Passing) -> f64 {
        let aisles = own.rows.iter().flat_map(|&row| self.rows[row].1);
        sections::least_width(aisles.map(|aisle| strips[self.aisles[aisle]].width()))
    }

    /// True when a width is not much less than that of the aisles beside the rows that something passes through.
    pub fn is_as_aisles(&self, strips: &[Strip], own: &Passing, width: f64) -> bool {
        let mut aisles = own.rows.iter().flat_map(|&row| self.rows[row].1);
        aisles.all(|aisle| width >= NARROWER * strips[self.aisles[aisle]].width())
    }

    /// What leads through all rows of a part of the place, between their ends.
    pub fn lead_through_all(&self, part: &BTreeSet<usize>) -> BTreeSet<usize> {
        let ways = part.iter().flat_map(|&row| &self.through[row]).copied();
        ways.filter(|&way| self.passing[way].is_within && self.passing[way].is_whole()).collect()
    }

    /// What of a row is open.
    pub fn shelves(&self, row: usize) -> &Shelves {
        self.shelves[row].get_or_init(|| Shelves::new(self.views[0], &self.rows[row].0))
    }

    /// From post to post along the rows that something passes through, metres, as about the first of them.
    pub fn pitch_of(&self, own: &Passing) -> Option<f64> {
        let row = self.first_of(own).or(own.rows.first().copied())?;
        *self.pitches[row].get_or_init(|| self.views[0].pitch_of(&self.rows[row].0))
    }

    /// True when bays are known along the rows that something passes through, and it is no wider than one, or as wide as some side
    /// by side.
    pub fn is_as_bays(&self, own: &Passing, width: f64) -> bool {
        self.pitch_of(own).is_some_and(|pitch| is_as_bays(width, pitch))
    }

    /// True when a row goes on past both sides of a strip that would cross it, by so much, metres.
    pub fn goes_past(&self, row: usize, strip: &Strip, by: f64) -> bool {
        self.sides_passed(row, strip, by) == [true; 2]
    }

    /// Past which of the two sides it does.
    pub fn sides_passed(&self, row: usize, strip: &Strip, by: f64) -> [bool; 2] {
        let ([view, other], (row, _)) = (self.views, &self.rows[row]);
        let middle = f64::midpoint(row.across[0], row.across[1]);
        strip.across.map(|side| holds(wider(row.along, -by), view.crossing(other, middle, side)[1]))
    }

    /// The first row that something passes through, but for walls between halls.
    pub fn first_of(&self, own: &Passing) -> Option<usize> {
        own.rows.iter().copied().find(|&row| !self.walls[row])
    }

    /// For each row the number of the part of the place that it is of, as `rows_with` has it; a wall is one by itself.
    pub fn parts(&self) -> Vec<usize> {
        let mut parts = vec![usize::MAX; self.rows.len()];
        for row in 0..self.rows.len() {
            if parts[row] == usize::MAX {
                let with = if self.walls[row] { BTreeSet::from([row]) } else { self.rows_with(row) };
                for other in with {
                    parts[other] = row;
                }
            }
        }
        parts
    }

    /// The rows of the part of the place that a row is of: those that face one another across an aisle, walls between halls left out.
    /// Along an aisle that leads from one hall into the next there are rows of both.
    pub fn rows_with(&self, row: usize) -> BTreeSet<usize> {
        let (mut found, mut next) = (BTreeSet::from([row]), vec![row]);
        while let Some(n) = next.pop() {
            let beside = self.rows[n].1.into_iter().flat_map(|aisle| self.beside[aisle].iter().flatten().copied());
            let face_one_another = |m: usize| overlap(self.rows[n].0.along, self.rows[m].0.along) > 0.0;
            next.extend(beside.filter(|&m| !self.walls[m] && face_one_another(m) && found.insert(m)));
        }
        found
    }
}

/// What a strip passes through of the rows of a place.
#[derive(Clone, Default)]
pub struct Passing {
    /// Which of the rows.
    pub rows: Vec<usize>,
    /// How many of these are no walls between halls.
    pub racks: usize,
    /// How long it is without what leads through them, from aisle to aisle, metres.
    pub rest: f64,
    /// Those beside them that it would lead through, were it longer.
    pub next: Vec<usize>,
    /// Another leads on through the next one, in line.
    pub is_led_on: bool,
    /// One of them goes on beyond both its sides.
    pub is_within: bool,
}

impl Passing {
    /// True when it leads through several rows, walls between halls not counted, and no more are beside them.
    pub fn is_whole(&self) -> bool {
        self.racks >= 2 && self.next.is_empty()
    }

    /// True when it is the same rows that another passes through, and more.
    pub fn holds_more_than(&self, other: &Self) -> bool {
        self.rows.len() > other.rows.len() && other.rows.iter().all(|row| self.rows.contains(row))
    }
}

/// True when a width is not about a whole number of goods, metres from one to the next.
fn is_no_number_of(goods: f64, width: f64) -> bool {
    (width - (width / goods).round() * goods).abs() > BETWEEN_GOODS
}

/// For each direction, whether some of its strips lead through rows of one of the places between their ends.
pub fn are_within(views: &[Turned], places: &[Place]) -> Vec<bool> {
    let mut are = vec![false; views.len()];
    for Place { views: [_, other], passing, .. } in places {
        are[other.direction] |= passing.iter().any(|own| own.is_within);
    }
    are
}

/// True when one of some strips leads past the ends of rows alone and is as wide as their bays: it is as wide as the hall
/// leaves.
pub fn is_past_ends_as_bays(strips: &[Strip], places: &[Place], n: usize) -> bool {
    let passed: Vec<&Place> = places.iter().filter(|place| !place.passing[n].rows.is_empty()).collect();
    let is_so = |place: &&Place| {
        let own = &place.passing[n];
        !own.is_within && place.is_as_bays(own, strips[n].width())
    };
    !passed.is_empty() && passed.iter().all(is_so)
}

/// Which of some strips lead through rows that are open more often than by chance, from one on; of all the places are known
/// that they lead through.
pub fn open_through(places: &[Place], strips: &[Strip], first: usize) -> Vec<bool> {
    let is_open =
        |n: usize| places.iter().any(|place| place.is_open_through(strips, &place.passing[n], strips[n].width()));
    (first..strips.len()).map(is_open).collect()
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

/// How long the longest row is that each strip runs along, metres.
fn longest(all: &[Layout], strips: usize) -> Vec<f64> {
    let mut along = vec![0.0_f64; strips];
    for Layout { aisles, rows, .. } in all {
        for (row, n) in rows.iter().flat_map(|(row, between)| between.map(|n| (row, aisles[n]))) {
            along[n] = along[n].max(row.length());
        }
    }
    along
}

/// The aisles along a direction, and the rows between them, each with the two beside it.
struct Layout<'a> {
    view: &'a Turned,
    aisles: Vec<usize>,
    rows: Vec<(Row, [usize; 2])>,
    /// Above and below each aisle.
    beside: Vec<[Vec<usize>; 2]>,
    /// Which of the rows are walls between halls.
    walls: Vec<bool>,
}

impl<'a> Layout<'a> {
    fn new(
        views: &[Turned],
        strips: &[Strip],
        placed: &[Beside],
        halls: &BTreeMap<[usize; 2], bool>,
        view: &'a Turned,
    ) -> Self {
        let is_aisle = |n: &usize| strips[*n].direction == view.direction && !rows::is_within_row(strips, placed, *n);
        let aisles: Vec<usize> = (0..strips.len()).filter(is_aisle).collect();
        let own: Vec<Strip> = aisles.iter().map(|&n| strips[n].clone()).collect();
        let extents: Vec<[f64; 2]> = own.iter().map(|strip| strip.along).collect();
        let rows = rows::between(views, &own, &extents).into_iter();
        let rows: Vec<_> = rows.filter_map(|row| row.between.map(|between| (row, between))).collect();
        let is_wall = |between: [usize; 2]| halls.get(&between.map(|n| aisles[n])).is_some_and(|is_wall| *is_wall);
        let walls = rows.iter().map(|(_, between)| is_wall(*between)).collect();
        let mut beside: Vec<[Vec<usize>; 2]> = vec![Default::default(); aisles.len()];
        for (n, (_, [below, above])) in rows.iter().enumerate() {
            beside[*below][0].push(n);
            beside[*above][1].push(n);
        }
        Self { view, aisles, rows, beside, walls }
    }

    /// What each strip passes through of the rows, which lie between aisles, along which it is not; and which strips do so of
    /// each row.
    fn passed_by(
        &self,
        [view, other]: [&Turned; 2],
        strips: &[Strip],
        placed: &[Beside],
        along: &[f64],
    ) -> (Vec<Passing>, Vec<Vec<usize>>) {
        let Self { aisles, rows, beside, walls, .. } = self;
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
        let crosses = |n: usize, s: f64| holds(strips[n].along, s);
        let mut crossed: Vec<Vec<usize>> = vec![Vec::new(); strips.len()];
        let mut through: Vec<Vec<usize>> = vec![Vec::new(); rows.len()];
        for (m, (row, _)) in rows.iter().enumerate() {
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
            // What leads through a wall alone tells nothing of the rows beside it, nor they of that.
            let is_wall = |m: &usize| {
                let is_beside = |one: usize, two: usize| rows[one].0.is_wall_beside(&rows[two].0);
                walls[*m] || own.iter().any(|&n| is_beside(*m, n)) || own.iter().all(|&n| is_beside(n, *m))
            };
            let beside = |m: usize| beside[rows[m].1[1]][0].iter().chain(&beside[rows[m].1[0]][1]);
            // Nor do the rows of a hall tell where a way leads on behind its wall.
            let next = || own.iter().filter(|&&m| !walls[m]).flat_map(|&m| beside(m)).filter(|m| !is_wall(m));
            let ends_before = |m: &&usize| crosses_at(n, **m).is_some_and(|(s, _)| !crosses(n, s));
            let is_in_line = |&other: &usize| other != n && overlap(strips[n].across, strips[other].across) > 0.0;
            let is_led_on = next().any(|&m| through[m].iter().any(is_in_line));
            let is_within = own.iter().any(|&m| {
                let ([from, to], width) = (rows[m].0.along, strips[n].width());
                crosses_at(n, m).is_some_and(|(_, u)| from + width < u && u < to - width)
            });
            let racks = own.iter().filter(|&&m| !walls[m]).count();
            let next = next().filter(ends_before).copied().collect();
            Passing { rows: own.clone(), racks, rest, next, is_led_on, is_within }
        };
        (crossed.iter().enumerate().map(of_strip).collect(), through)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_some_goods_leave_is_about_as_wide_as_they_are() {
        for (width, is_none) in [(1.3, false), (1.5, false), (2.0, true), (2.4, true), (2.65, false)] {
            assert_eq!(is_no_number_of(1.35, width), is_none, "{width}");
        }
    }
}
