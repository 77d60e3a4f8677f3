//! Ways across rows are of one width: what leads through all rows of a place tells what leads through some of them.

use super::Evidence;
use super::alone::{self, Alone};
use super::bars::Bars;
use super::beside::placed;
use super::closed;
use super::corridors::Strip;
use super::empties;
use super::lags::LONGEST;
use super::look::Look;
use super::passing::{Passing, Place};
use super::rows::{DEPTH, SHORTEST};
use super::sections::{BAY, WIDTH, is_as_bays};
use super::seldom;
use super::turned::Turned;
use crate::ends::{shared, sorted, wider};
use std::cell::LazyCell;
use std::collections::BTreeSet;

/// Ways across a place are of one width but for this share.
const ALIKE: f64 = 0.15;
/// What leads through rows and on for so long, metres, is known by more than those.
const REST: f64 = 6.0;
/// A bay that is so much wider or narrower than a way, as a share of it, can be told from one.
const APART: f64 = 0.1;
/// A row that goes on farther than others does so for this much, metres.
const FARTHER: f64 = 1.0;
/// Chance does not open so many rows in line where hardly a place of them is.
const IN_LINE: usize = 3;
/// What leads through several rows is a way where fewer such places would be expected by chance.
const SELDOM: f64 = 0.06;
/// What is as wide as a bay is an empty one where more would be.
const ANYWHERE: f64 = 0.4;
/// A wall runs along a side where over this share of it so much of what lies so far beyond it, metres, is not free.
const WALL: f64 = 0.9;
const TAKEN: f64 = 0.2;
const BEYOND: f64 = 0.6;

/// How wide the ways of a direction are that are no bays, metres.
#[derive(Clone, Default)]
pub struct Widths(Vec<f64>);

impl Widths {
    /// Of some ways, for each direction.
    pub fn of<'a>(views: &[Turned], strips: impl Iterator<Item = &'a Strip>) -> Vec<Self> {
        let mut all: Vec<Self> = views.iter().map(|_| Self::default()).collect();
        strips.for_each(|strip| all[strip.direction].0.push(strip.width()));
        all
    }

    /// Of those ways across rows, for each direction, that lead through some rows of a place between their ends and not
    /// through those beside.
    pub fn of_staggered(views: &[Turned], strips: &[Strip], places: &[Place]) -> Vec<Self> {
        let mut all: Vec<Self> = views.iter().map(|_| Self::default()).collect();
        for Place { views: [_, other], passing, .. } in places {
            let is_staggered = |own: &Passing| own.is_within && !own.next.is_empty() && !own.is_led_on;
            let ways = strips.iter().zip(passing).filter(|(_, own)| is_staggered(own));
            all[other.direction].0.extend(ways.map(|(way, _)| way.width()));
        }
        all
    }

    /// Of what leads through all of some rows one beside another, between their ends.
    pub fn of_whole(place: &Place, strips: &[Strip], rows: &BTreeSet<usize>) -> Self {
        Self(place.lead_through_all(rows).into_iter().map(|way| strips[way].width()).collect())
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

/// True when one width is another but for as little as those of ways differ by.
pub fn are_alike(one: f64, other: f64) -> bool {
    (one - other).abs() <= ALIKE * other
}

/// The strips without those that lead through some rows of a place and have no width of what leads through all: bays; nor
/// those at a wall that the rows beside go on to. Where nothing leads through all but past their ends, what has no bays'
/// width is none, nor what each row has as many of, between bars that stand beside nothing else, nor what leads through rows
/// of two racks that are open more often than by chance. What is as wide as a bay is one, whatever ways are as wide, where so
/// many rows would be open somewhere by chance; and what leads through several rows is no bay where they hardly would, nor
/// what leads through rows of which nothing else is open and lies as none can. What leads
/// past rows' ends up to one that goes on farther is none, but where something leads through all and it is as wide as bays,
/// nor where nothing of the rows beside reaches into it, or those before it end at bars and that one goes on past it. Nor
/// those beside which, with no rack between, one leads through more rows, nor those no wider than a bay, or as wide as some, beside
/// which, nearer than racks are deep, one leads through the same single row or past the ends of the same rows, be these not all, or
/// ended by bars; nor those that posts part into bays in all their rows. Bars decide where that leaves it open, and cut what leads on
/// over bays.
/// Those from `first` on are known by the rows that they lead through: narrow ones are ways where these are closed but for
/// several.
pub fn alike(evidence: &Evidence, look: &Look, views: &[Turned], strips: &[Strip], first: usize) -> Vec<Strip> {
    let mut stays = vec![true; strips.len()];
    let mut pieces: Vec<Vec<Strip>> = strips.iter().map(|strip| vec![strip.clone()]).collect();
    let placed = placed(views, strips.iter().map(Strip::place));
    for place in Place::of_each(views, strips) {
        let Place { views: [view, other], passing, .. } = &place;
        // What leads through all rows of a part of the place tells of that part.
        let parts = place.parts();
        let mut told = vec![[Widths::default(), Widths::default()]; parts.len()];
        for (n, own) in passing.iter().enumerate().filter(|(_, own)| own.is_whole()) {
            for part in own.rows.iter().map(|&row| parts[row]).collect::<BTreeSet<_>>() {
                told[part][usize::from(own.is_within)].add(strips[n].width());
            }
        }
        // So near to a strip across, of those about where it lies along.
        let beside = |n: usize, apart: f64| {
            let near = placed[other.direction].touching(strips[n].along, wider(strips[n].across, apart));
            near.into_iter().filter(move |&m| {
                let [low, high] = shared(strips[n].across, strips[m].across);
                m != n && low - high < apart
            })
        };
        let alone = LazyCell::new(|| Alone::new(&place, strips));
        let bars = Bars::new(evidence, look, &place, strips);
        for (n, own) in passing.iter().enumerate() {
            if own.rows.is_empty() || own.rest > REST {
                continue;
            }
            let [past_ends, within] = &told[parts[place.first_of(own).unwrap_or(own.rows[0])]];
            let is_told_within = !within.is_empty();
            let known = if is_told_within { within } else { past_ends };
            let width = strips[n].width();
            let pitch = || place.pitch_of(own);
            let is_double = |&row: &usize| seldom::is_double(&place.rows[row].0);
            let may_be_bay = || place.is_as_bays(own, width);
            let is_as_the_hall_leaves =
                || leads_past_ends(&place, &strips[n], own) && !(is_told_within && may_be_bay());
            // A row beside those that end at bars, which has empty bays where they end, goes on no farther than the way.
            let goes_past = |&row: &usize| place.goes_past(row, &strips[n], FARTHER);
            let is_barred = || bars.end_rows_before(n) && own.next.iter().all(goes_past);
            let is_past_ends = || own.rows.len() > 1 && !own.is_within && (!bars.reach_into(n) || is_barred());
            // What is as wide as a bay is one where chance would open rows so anyhow, whatever else is as wide.
            let expected = LazyCell::new(|| empties::expected(&place, strips, n));
            let is_one_bay = || pitch().is_some_and(|pitch| width <= BAY * pitch);
            let is_anywhere = || own.is_within && is_one_bay() && expected.is_some_and(|expected| expected > ANYWHERE);
            // Of what is longer than beams the ways past the rows' ends tell too.
            let is_known = || known.have(width, pitch()) || width > LONGEST && past_ends.have(width, pitch());
            let is_as_wide = || is_known() && !is_anywhere();
            let is_some = !own.next.is_empty()
                && (!known.is_empty() || is_anywhere())
                && !is_as_the_hall_leaves()
                && !is_past_ends();
            // Where the rows beside it go on to the wall, one that does not is empty there.
            let is_bay = || own.rows.len() == 1 && !own.is_led_on && is_at_wall(other, &strips[n]);
            // Ways past the rows' ends are as wide as the hall leaves, and tell nothing of what leads through the rows.
            let is_in_every_row = || alone.is_in_every_row(&place, own, width);
            let is_way_of_its_row = || match pitch() {
                Some(pitch) => !is_as_bays(width, pitch) || is_in_every_row() && bars.stand_beside_no_bays(n),
                None => alone.is_longer_than_bays(own, width) || is_in_every_row(),
            };
            // Through several rows in line that chance would hardly open so leads a way.
            let is_in_line = || {
                let is_open_nowhere_else = || own.racks >= IN_LINE && !empties::are_about(&place, strips, own, width);
                let is_seldom = || expected.is_some_and(|expected| expected < SELDOM) || is_open_nowhere_else();
                own.is_within && own.racks > 1 && width >= WIDTH.0 && is_seldom()
            };
            let is_no_bay = || {
                (!is_told_within && (is_way_of_its_row() || place.is_open_through(strips, own, width))) || is_in_line()
            };
            let may_lie = || pitch().is_none() || may_be_bay();
            let is_as_bays_lie = || may_lie() && alone.is_as_bays_lie(&place, strips, own, width);
            // Where no bays recur, what each row has as many of is no gap between goods, however wide, nor what lies as none can.
            let is_closed = LazyCell::new(|| closed::is_way(&place, strips, own, width));
            let is_without_bays =
                LazyCell::new(|| pitch().is_none() && (alone::is_one_of_each(&place, own) || *is_closed));
            let is_way = || is_as_wide() || is_no_bay() || *is_without_bays;
            let lies_as_bays = || is_bay() || is_as_bays_lie() && !*is_without_bays;
            // Where width and place disagree, or neither tells, bars do; and where these are missed it is none.
            let is_told = || match (is_way(), lies_as_bays()) {
                (true, false) => !bars.are_missed(n),
                (false, true) => false,
                (true, true) => bars.are_beside(n),
                // What fills a rack's depth is as a bar, but of two racks back to back goods seldom line up so.
                (false, false) => {
                    let may_be = || own.racks > 1 || !is_told_within;
                    view.pitch.is_some() && own.rows.iter().all(is_double) && may_be() && bars.are_beside(n)
                }
            };
            let is_narrow = n >= first && width < WIDTH.0 && !own.is_whole();
            stays[n] &= (!is_some || is_told()) && (!is_narrow || *is_closed) && !bars.are_parted(n);
            if let Some(cut) = stays[n].then(|| bars.cut(n)).flatten() {
                pieces[n] = cut;
            }
            // With no rack between it and a way through more rows it leads through their last bays, which are empty.
            let is_beside = |m: usize| passing[m].holds_more_than(own);
            stays[n] &= !beside(n, SHORTEST).any(is_beside);
        }
        // What is no wider than a bay, or as wide as some, is one beside another through the same row, or beside what leads past
        // the ends of its rows; what leads through all rows is so where bars end these and not it.
        let left = stays.clone();
        let are_last = |n: usize| !passing[n].is_whole() || bars.stand_at_one_side(n);
        for (n, own) in passing.iter().enumerate().filter(|(_, own)| own.is_within && !own.is_led_on) {
            let is_parted = |m: usize| {
                let is_through = |row: &usize| passing[m].rows.contains(row);
                left[m] && own.rows.iter().all(is_through) && (own.racks == 1 || !passing[m].is_within)
            };
            let is_bay =
                || place.is_as_bays(own, strips[n].width()) && beside(n, DEPTH.0).any(is_parted) && are_last(n);
            stays[n] &= !is_bay();
        }
    }
    pieces.into_iter().zip(stays).filter(|(_, stays)| *stays).flat_map(|(pieces, _)| pieces).collect()
}

/// True when a strip leads past the ends of several rows, up to one that goes on farther beside them: it is as wide as the
/// hall leaves there. Between two that go on it would as well be empty bays of the rows between these.
fn leads_past_ends(place: &Place, strip: &Strip, own: &Passing) -> bool {
    let &[next] = &own.next[..] else { return false };
    own.rows.len() > 1 && !own.is_within && place.goes_past(next, strip, FARTHER)
}

/// True when a wall runs all along one side of a strip.
fn is_at_wall(view: &Turned, strip: &Strip) -> bool {
    let columns = view.columns(strip.along);
    strip.across.into_iter().zip([-BEYOND, BEYOND]).any(|(side, beyond)| {
        let ends = sorted([side, side + beyond]);
        let taken = view.some_blocked(columns.clone(), ends[0], ends[1]);
        taken.iter().filter(|share| **share >= TAKEN).count() as f64 >= WALL * taken.len() as f64
    })
}
