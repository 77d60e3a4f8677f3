//! Ways across rows are told from empty bays: by their widths, by where they lie, by what chance would open, and by bars.

pub(super) mod across;
pub(super) mod alone;
pub(super) mod backed;
pub(super) mod bars;
pub(super) mod carried;
pub(super) mod chance;
pub(super) mod closed;
pub(super) mod crossed;
pub(super) mod empties;
pub(super) mod gates;
pub(super) mod hollow;
pub(super) mod lead;
pub(super) mod narrowed;
pub(super) mod passing;
pub(super) mod seldom;
pub(super) mod slots;
pub(super) mod step;
pub(super) mod thin;
pub(super) mod through;
pub(super) mod turns;
pub(super) mod unposted;
pub(super) mod walled;
pub(super) mod widths;

use super::Evidence;
use super::beside::{Beside, placed};
use super::corridors::Strip;
use super::posts::lags::LONGEST;
use super::rows::sections::{BAY, is_as_bays};
use super::rows::{DEPTH, SHORTEST};
use super::view::look::Look;
use super::view::turned::Turned;
use crate::ends::{overlap, shared, wider};
use alone::Alone;
use bars::Bars;
use passing::{Passing, Place};
use std::cell::OnceCell;
use std::collections::BTreeSet;
use widths::Widths;

/// What leads through rows and on for so long, metres, is known by more than those.
const REST: f64 = 6.0;
/// A row that goes on farther than others does so for this much, metres.
const FARTHER: f64 = 1.0;
/// Chance does not open so many rows in line where hardly a place of them is.
const IN_LINE: usize = 3;
/// What leads through several rows is a way where fewer such places would be expected by chance.
const SELDOM: f64 = 0.06;
/// The same along a wall, where rows end and others go on to it.
const AT_WALL: f64 = 0.001;
/// What of a bay a frame in the wall behind it would hide, metres.
const HIDDEN: f64 = 0.15;
/// What leads past a row's end before a wall is so far from any number of bays, as a share of one: posts and goods stand off.
const OFF_BAYS: f64 = 0.25;
/// What is as wide as a bay is an empty one where more would be.
const ANYWHERE: f64 = 0.4;
/// The same of what leads through one row alone: what else is as wide there may be ways.
const OF_ONE_ROW: f64 = 3.0;
/// Posts leave so much of a bay, in pitches, or more; and of several bays in line no goods all leave a part as small.
const ONE_BAY: f64 = 0.92;
const PART_OF_BAY: f64 = 0.8;
/// What leads through a row at one place has so much of its width in common.
const SHARED: f64 = 0.5;
/// Drift that turns a wall moves the ends of the rows before it against each other by so much, metres.
const TURNED: f64 = 1.0;

/// The strips without those that are empty bays of the rows that they lead through, and without the bays that ways lead on over.
///
/// What leads through all rows of a part of a place is a way, and what leads through some is asked about (`Asked`), unless it leads
/// on for long. Two that lie side by side are asked about together (`Context::is_last_bay`). Strips from `first` on are known by the
/// rows that they lead through: narrow ones are ways where these are closed but for several.
pub fn among(evidence: &Evidence, look: &Look, views: &[Turned], strips: &[Strip], first: usize) -> Vec<Strip> {
    let mut stays = vec![true; strips.len()];
    let mut pieces: Vec<Vec<Strip>> = strips.iter().map(|strip| vec![strip.clone()]).collect();
    let placed = placed(views, strips.iter().map(Strip::place));
    for place in Place::of_each(views, strips) {
        let context = Context::new(evidence, look, &place, strips, &placed);
        for (n, own) in place.passing.iter().enumerate().filter(|(_, own)| !own.rows.is_empty() && own.rest <= REST) {
            let asked = Asked::new(&context, n);
            let is_narrow = n >= first && asked.width < asked.least() && !own.is_whole();
            stays[n] &= asked.is_way()
                && (!is_narrow || asked.is_closed())
                && !context.bars.are_parted(n)
                && !context.bars.is_beside_flues(n);
            if let Some(cut) = stays[n].then(|| context.bars.cut(n)).flatten() {
                pieces[n] = cut;
            }
            stays[n] &= !context.is_beside_longer(n);
        }
        let left = stays.clone();
        for (n, stays) in stays.iter_mut().enumerate() {
            *stays &= !context.is_last_bay(n, &left);
        }
    }
    pieces.into_iter().zip(stays).filter(|(_, stays)| *stays).flat_map(|(pieces, _)| pieces).collect()
}

/// What is known of a place, of all strips that pass through its rows.
struct Context<'a> {
    place: &'a Place<'a>,
    strips: &'a [Strip],
    /// Where the strips of each direction lie.
    placed: &'a [Beside],
    bars: Bars<'a>,
    /// What leads through each row within it, once it is asked.
    alone: OnceCell<Alone>,
    /// Of each row the part of the place, and for each part how wide what leads through all its rows is: past their ends, and
    /// between them.
    parts: Vec<usize>,
    widths: Vec<[Widths; 2]>,
}

impl<'a> Context<'a> {
    fn new(
        evidence: &'a Evidence,
        look: &'a Look,
        place: &'a Place,
        strips: &'a [Strip],
        placed: &'a [Beside],
    ) -> Self {
        let parts = place.parts();
        let mut widths = vec![[Widths::default(), Widths::default()]; parts.len()];
        for (strip, own) in strips.iter().zip(&place.passing).filter(|(_, own)| own.is_whole()) {
            for part in own.rows.iter().map(|&row| parts[row]).collect::<BTreeSet<_>>() {
                widths[part][usize::from(own.is_within)].add(strip.width());
            }
        }
        let bars = Bars::new(evidence, look, place, strips);
        Self { place, strips, placed, bars, alone: OnceCell::new(), parts, widths }
    }

    fn alone(&self) -> &Alone {
        self.alone.get_or_init(|| Alone::new(self.place, self.strips))
    }

    /// What lies so near to a strip across, metres, of what is about where it lies along.
    fn beside(&self, n: usize, apart: f64) -> impl Iterator<Item = usize> {
        let own = &self.strips[n];
        let near = self.placed[self.place.views[1].direction].touching(own.along, wider(own.across, apart));
        near.into_iter().filter(move |&m| {
            let [low, high] = shared(own.across, self.strips[m].across);
            m != n && low - high < apart
        })
    }

    /// True when with no rack between, one beside a strip leads through more rows: it leads through their last bays, which are
    /// empty.
    fn is_beside_longer(&self, n: usize) -> bool {
        let passing = &self.place.passing;
        self.beside(n, SHORTEST).any(|m| passing[m].holds_more_than(&passing[n]))
    }

    /// True when a strip is no wider than a bay, or as wide as some, and beside it, nearer than racks are deep, one that is left
    /// leads through the same single row, or past the ends of the same rows. What leads through it at the same place is the same way.
    fn is_last_bay(&self, n: usize, left: &[bool]) -> bool {
        let own = &self.place.passing[n];
        let is_same = |m: usize| {
            let [one, other] = [n, m].map(|n| &self.strips[n]);
            overlap(one.across, other.across) > SHARED * one.width().min(other.width())
        };
        let is_beside = |m: usize| {
            let other = &self.place.passing[m];
            left[m]
                && !is_same(m)
                && own.rows.iter().all(|row| other.rows.contains(row))
                && (own.racks == 1 || !other.is_within)
        };
        own.is_within
            && !own.is_led_on
            && self.place.is_as_bays(own, self.strips[n].width())
            && self.beside(n, DEPTH.0).any(is_beside)
    }
}

/// A strip that leads through rows, and may be a way or an empty bay of them. What costs least is asked first.
struct Asked<'a> {
    context: &'a Context<'a>,
    n: usize,
    strip: &'a Strip,
    own: &'a Passing,
    width: f64,
    /// How wide what leads past the ends of all rows of its part of the place is, and between them.
    past_ends: &'a Widths,
    within: &'a Widths,
    expected: OnceCell<Option<f64>>,
    is_without_bays: OnceCell<bool>,
    is_closed: OnceCell<bool>,
}

impl<'a> Asked<'a> {
    fn new(context: &'a Context<'a>, n: usize) -> Self {
        let (own, strip) = (&context.place.passing[n], &context.strips[n]);
        let row = context.place.first_of(own).unwrap_or(own.rows[0]);
        let [past_ends, within] = &context.widths[context.parts[row]];
        Self {
            context,
            n,
            strip,
            own,
            width: strip.width(),
            past_ends,
            within,
            expected: OnceCell::new(),
            is_without_bays: OnceCell::new(),
            is_closed: OnceCell::new(),
        }
    }

    /// The least width of what leads through its rows, metres.
    fn least(&self) -> f64 {
        self.context.place.least(self.context.strips, self.own)
    }

    /// True when it need not be asked, or its width and where it lies tell that it is a way; bars tell where these disagree or
    /// neither does.
    fn is_way(&self) -> bool {
        let bars = &self.context.bars;
        if !self.is_open_to_question() {
            return !self.is_likely_through_all();
        }
        match (self.is_as_ways_are(), self.lies_as_bays()) {
            (true, false) => !bars.are_missed(self.n),
            (false, true) => false,
            (true, true) => bars.are_beside(self.n) || self.is_past_end_before_wall(),
            (false, false) => {
                self.is_between_bars_of_two_racks() || !self.is_told_within() && bars.are_beside_all(self.n)
            }
        }
    }

    /// True when it leads through all rows of its part between their ends, or through one that is a wall beside the others, and is just
    /// as wide as one bay, chance would open as many at some place, and bars do not tell otherwise. Where something stands along their
    /// faces, as beams do, bays are closed.
    fn is_likely_through_all(&self) -> bool {
        let place = self.context.place;
        // Of a row by itself one gate is not told from another by that.
        let is_one_of_several = || self.own.racks == 1 && place.rows_with(self.own.rows[0]).len() > 1;
        let most = if self.own.is_whole() { ANYWHERE } else { OF_ONE_ROW };
        let expected = || empties::expected_bare(place, self.context.strips, self.n);
        self.own.is_within
            && self.is_just_one_bay()
            && (self.own.is_whole() || self.own.next.is_empty() && is_one_of_several())
            && expected().is_some_and(|expected| expected > most)
            && !self.context.bars.tell(self.n)
    }

    /// True when it is just as wide as one bay.
    fn is_just_one_bay(&self) -> bool {
        self.pitch().is_some_and(|pitch| (ONE_BAY * pitch..=pitch).contains(&self.width))
    }

    /// True when it leads through some rows alone of those beside one another, and something tells of these: what leads past the
    /// ends of several rows is as wide as the hall leaves.
    fn is_open_to_question(&self) -> bool {
        !self.own.next.is_empty()
            && (!self.widths().is_empty() || self.is_anywhere())
            && !self.is_as_the_hall_leaves()
            && !self.is_past_ends()
    }

    /// True when it is as wide as ways are, or its width is no bay's, or nothing is known of bays and it lies as none can.
    fn is_as_ways_are(&self) -> bool {
        self.is_as_wide() || self.is_no_bay() || self.is_without_bays()
    }

    /// True when a wall runs along it, past a single row.
    fn is_before_wall(&self) -> bool {
        self.own.rows.len() == 1
            && !self.own.is_led_on
            && walled::sides(self.context.place.views[1], self.strip).contains(&true)
    }

    /// True when it leads past a row's end before a wall, where a bar stands, is as wide as other ways and as no number of bays, even if
    /// that row keeps as clear of the wall as those beside it do.
    fn is_past_end_before_wall(&self) -> bool {
        let bars = &self.context.bars;
        let is_no_number = |width: f64, pitch: f64| {
            let bays = width / pitch;
            bays > 1.0 && (bays - bays.round()).abs() >= OFF_BAYS
        };
        let clear = || self.own.next.iter().filter_map(|&row| bars.clear_of_side(self.n, row));
        self.is_before_wall()
            && self.is_as_wide()
            && self.pitch().is_some_and(|pitch| {
                is_no_number(self.width, pitch) && clear().all(|clear| is_no_number(self.width - clear, pitch))
            })
            && bars.are_before_bars(self.n, 0.0)
    }

    /// True when it lies where an empty bay would: before a wall to which the rows beside it go on, or as bays of single rows lie.
    fn lies_as_bays(&self) -> bool {
        let may_lie = || self.pitch().is_none() || self.may_be_bay();
        let is_as_bays_lie = || {
            may_lie()
                && self.context.alone().is_as_bays_lie(self.context.place, self.context.strips, self.own, self.width)
        };
        self.is_before_wall() || is_as_bays_lie() && !self.is_without_bays()
    }

    /// True when all its rows are of two racks, and bars stand beside it: what fills a rack's depth is as a bar, but of two racks
    /// back to back goods seldom line up so.
    fn is_between_bars_of_two_racks(&self) -> bool {
        let place = self.context.place;
        self.pitch().is_some()
            && place.are_double(self.own)
            && (self.own.racks > 1 || !self.is_told_within())
            && self.context.bars.are_beside(self.n)
    }

    /// True when what leads through all rows is known between their ends, and not only past these.
    fn is_told_within(&self) -> bool {
        !self.within.is_empty()
    }

    /// How wide the ways are that tell: those between the rows' ends, if there are any.
    fn widths(&self) -> &Widths {
        if self.is_told_within() { self.within } else { self.past_ends }
    }

    fn pitch(&self) -> Option<f64> {
        self.context.place.pitch_of(self.own)
    }

    fn may_be_bay(&self) -> bool {
        self.context.place.is_as_bays(self.own, self.width)
    }

    /// True when it may be a bay of which one frame stands against the wall, and is not seen.
    fn may_be_bay_at_wall(&self) -> bool {
        self.may_be_bay() || self.context.place.is_as_bays(self.own, self.width - HIDDEN)
    }

    /// How many as wide chance would open through as many rows, if it can be told.
    fn expected(&self) -> Option<f64> {
        *self.expected.get_or_init(|| empties::expected(self.context.place, self.context.strips, self.n))
    }

    /// True when it is as wide as one bay, and chance would open rows so anyhow, whatever else is as wide.
    fn is_anywhere(&self) -> bool {
        let is_one_bay = || self.pitch().is_some_and(|pitch| self.width <= BAY * pitch);
        self.own.is_within && is_one_bay() && self.expected().is_some_and(|expected| expected > ANYWHERE)
    }

    /// True when it is as wide as what leads through all rows; of what is longer than beams the ways past their ends tell too.
    fn is_as_wide(&self) -> bool {
        let is_known = self.widths().have(self.width, self.pitch())
            || self.width > LONGEST && self.past_ends.have(self.width, self.pitch());
        is_known && !self.is_anywhere()
    }

    /// True when it leads past the ends of several rows, up to one that goes on farther beside them, or up to the wall along it: it
    /// is as wide as the hall leaves there. Between two that go on it would as well be empty bays of the rows between these, if chance
    /// makes such.
    fn is_as_the_hall_leaves(&self) -> bool {
        let &[next] = &self.own.next[..] else { return false };
        let place = self.context.place;
        let is_at_wall = || {
            let goes_past = place.sides_passed(next, self.strip, FARTHER);
            let is_walled = walled::sides(place.views[1], self.strip);
            (0..2).any(|side| is_walled[side] && goes_past[1 - side])
                && (!self.may_be_bay_at_wall() || self.expected().is_some_and(|expected| expected < AT_WALL))
                && self.context.bars.are_bare(self.n)
        };
        let is_of_bays =
            || self.is_told_within() && self.may_be_bay() && self.expected().is_none_or(|expected| expected >= SELDOM);
        self.own.rows.len() > 1
            && !self.own.is_within
            && (is_at_wall() || place.goes_past(next, self.strip, FARTHER) && !is_of_bays())
    }

    /// True when it leads past the ends of several rows, and nothing of those beside reaches into it, or those before it end at
    /// bars: of a row that goes on past it the bays are empty where they end, and it goes on no farther than the way. Along a wall
    /// that drift has turned the ends of rows beside reach into it, but not to its middle.
    fn is_past_ends(&self) -> bool {
        let bars = &self.context.bars;
        let goes_past = |&row: &usize| self.context.place.goes_past(row, self.strip, FARTHER);
        let is_barred = || bars.end_rows_before(self.n) && self.own.next.iter().all(goes_past);
        let is_narrower_than_bays =
            || self.width >= self.least() && self.pitch().is_some_and(|pitch| self.width <= PART_OF_BAY * pitch);
        let is_along_turned_wall = || {
            self.own.rows.len() >= IN_LINE
                && is_narrower_than_bays()
                && walled::side(self.context.place.views[1], self.strip)
                    .is_some_and(|side| !bars.reach_into_half(self.n, side))
                && bars.are_before_bars(self.n, TURNED)
        };
        self.own.rows.len() > 1
            && !self.own.is_within
            && (!bars.reach_into(self.n) || is_barred() || is_along_turned_wall())
    }

    /// True when its width is no bay's, or chance would hardly open its rows so. Ways past the rows' ends are as wide as the hall
    /// leaves, and tell nothing of what leads through the rows.
    fn is_no_bay(&self) -> bool {
        let is_open_through = || self.context.place.is_open_through(self.context.strips, self.own, self.width);
        !self.is_told_within() && (self.is_way_of_its_row() || is_open_through()) || self.is_in_line()
    }

    /// True when what leads through its rows alone is no bay: its width is none's, or each row has as many and bars tell.
    fn is_way_of_its_row(&self) -> bool {
        let alone = || self.context.alone();
        let is_in_every_row = || alone().is_in_every_row(self.context.place, self.own, self.width);
        match self.pitch() {
            Some(pitch) => {
                !is_as_bays(self.width, pitch) || is_in_every_row() && self.context.bars.stand_beside_no_bays(self.n)
            }
            None => alone().is_longer_than_bays(self.own, self.width) || is_in_every_row(),
        }
    }

    /// True when it leads through several rows in line that chance would hardly open so.
    fn is_in_line(&self) -> bool {
        let Context { place, strips, .. } = self.context;
        let is_open_nowhere_else =
            || self.own.racks >= IN_LINE && !empties::are_about(place, strips, self.own, self.width);
        let is_seldom = || self.expected().is_some_and(|expected| expected < SELDOM) || is_open_nowhere_else();
        self.own.is_within && self.own.racks > 1 && self.width >= self.least() && is_seldom()
    }

    /// True when no bays recur along its rows, and each row has as many as wide, or it lies as none can: it is no gap between
    /// goods, however wide.
    fn is_without_bays(&self) -> bool {
        let is_so =
            || self.pitch().is_none() && (alone::is_one_of_each(self.context.place, self.own) || self.is_closed());
        *self.is_without_bays.get_or_init(is_so)
    }

    /// True when its rows are closed but for several ways.
    fn is_closed(&self) -> bool {
        *self.is_closed.get_or_init(|| closed::is_way(self.context.place, self.context.strips, self.own, self.width))
    }
}
