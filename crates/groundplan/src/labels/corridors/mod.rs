//! II-E: corridors, Fig. 8c: closed on both long sides, open along the middle.
//!
//! A corridor lies between two lines of one direction, but neither holds across the whole map: each pair of lines is
//! asked column by column whether the strip between them is free there and whether structure lies on both its sides.
//! Gaps in a side shorter than a rack's bay are the bay; longer ones are where other ways open. Of strips that overlap
//! the one with the most wall along it is kept, and the others keep what is left of them.

pub(super) mod along_walls;
pub(super) mod askew;
pub(super) mod barriers;
pub(super) mod before_walls;
pub(super) mod bends;
pub(super) mod columns;
pub(super) mod connected;
pub(super) mod cornered;
pub(super) mod family;
pub(super) mod frontiers;
pub(super) mod heads;
pub(super) mod joined;
pub(super) mod known;
pub(super) mod led;
pub(super) mod led_into;
pub(super) mod mouths;
pub(super) mod onward;
pub(super) mod openings;
pub(super) mod past_goods;
pub(super) mod past_last;
pub(super) mod pieces;
pub(super) mod pillared;
pub(super) mod ragged;
pub(super) mod sided;
pub(super) mod stretches;
pub(super) mod widening;

use super::Evidence;
use super::beside::{Beside, placed};
use super::view::panes;
use super::view::turned::Turned;
use crate::bands::map_each;
use crate::ends::{around, holds, shared};
use crate::sparing::is_large;
use family::Family;
use ragged::Ways;

/// A strip of free space along one direction, in the direction's own places (metres along and across).
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// Index of the direction.
    pub direction: usize,
    /// Where its walled part begins and ends, along.
    pub along: [f64; 2],
    /// Its two sides, across.
    pub across: [f64; 2],
    /// What speaks for it less what speaks against it, metres.
    pub score: f64,
    /// It may be a row of empty bays, unless the rows that it crosses say otherwise.
    pub bays: bool,
    /// Its sides are no lines, and stand back from it.
    pub is_ragged: bool,
    /// At which of its ends it leads to the first way only: it goes on over what was not seen there, or over empty bays.
    pub stops: [bool; 2],
    /// Where it begins and ends without what lies beyond a gap longer than a bay and is no more than a speck, along.
    pub held: [f64; 2],
    /// Between which ends it was found, before it was led on to what it meets, along.
    pub found: [f64; 2],
}

/// Of a strip of which it is not told what of it is held, or that was not led on.
pub const UNTOLD: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

impl Strip {
    /// Free width, metres.
    pub fn width(&self) -> f64 {
        self.across[1] - self.across[0]
    }

    /// Walled length, end to end, metres.
    pub fn length(&self) -> f64 {
        self.along[1] - self.along[0]
    }

    /// Too short to be a way by itself.
    pub fn is_short(&self) -> bool {
        is_short(self.length(), self.width())
    }

    /// True when another is as wide.
    pub fn is_as_wide(&self, other: &Self) -> bool {
        (self.width() - other.width()).abs() <= ALIKE * self.width().max(other.width())
    }

    /// From where to where of it was found, before it was led on to what it meets.
    pub fn found_along(&self) -> [f64; 2] {
        shared(self.along, self.found)
    }

    /// True when it is a wider one over another's middle, along the same direction.
    pub fn is_wider_over(&self, other: &Self) -> bool {
        let is_in_line = self.direction == other.direction && holds(self.across, other.middle());
        is_in_line && self.width() > other.width() && !self.is_as_wide(other)
    }

    /// True when each side of another along the same direction is no farther than so many metres from its own.
    pub fn is_in_line(&self, other: &Self, within: f64) -> bool {
        self.direction == other.direction && (0..2).all(|n| (self.across[n] - other.across[n]).abs() <= within)
    }

    /// Its direction and its places, as [`placed`] takes them.
    pub fn place(&self) -> (usize, [f64; 2], [f64; 2]) {
        (self.direction, self.along, self.across)
    }

    /// Place across of its centre line.
    pub fn middle(&self) -> f64 {
        f64::midpoint(self.across[0], self.across[1])
    }

    /// Half of it, at one of its sides.
    pub fn half(&self, side: usize) -> Self {
        let mut half = self.clone();
        half.across[1 - side] = self.middle();
        half
    }
}

/// A corridor that meets no other is at least so many times as long as wide, and so long, metres.
pub const ALONE: (f64, f64) = (2.0, 5.0);
/// Corridors are as wide, or as long, as one another but for this share.
pub const ALIKE: f64 = 0.2;
/// Strips whose directions differ by an angle of a smaller sine run nearly the same way.
pub const ASKEW: f64 = 0.5;

/// Those whose directions have an angle of a smaller sine are one way where a map is bent, and they are looked for at so many
/// places. Between wings that are turned by more ways may cross at one place.
const BENT: f64 = 0.14;
const LOOKS: usize = 16;

/// True when what is so long and so wide, metres, is too short to be a way by itself.
pub fn is_short(length: f64, width: f64) -> bool {
    length < ALONE.1.max(ALONE.0 * width)
}

/// The width of the widest, metres.
pub fn widest(strips: &[Strip]) -> f64 {
    strips.iter().map(Strip::width).fold(0.0, f64::max)
}

/// Corridors along every direction, in the order of the directions: the sure ones are of each those between lines by their
/// places, and then the ragged ones, the best first.
pub fn find(evidence: &Evidence, views: &[Turned]) -> Ways {
    // Of few views one may be done long before another, which then has all threads; but of a large map each thread lays out
    // rows, for which there is not room enough.
    let is_shared = views.len() >= evidence.threads || is_large(&evidence.grid.frame);
    let threads = if is_shared { evidence.threads.div_ceil(views.len().max(1)) } else { evidence.threads };
    let found = map_each(views.len(), evidence.threads, |n| {
        let family = Family::new(evidence, views, &views[n], &[]);
        let mut parts = family.candidates(threads, evidence.recall);
        let whole = parts.iter().filter(|c| c.is_corridor).copied().collect();
        parts.retain(|c| !c.is_corridor);
        let mut known = family.best(whole, &[]);
        let sure: Vec<Strip> = known.iter().filter(|strip| !strip.bays).cloned().collect();
        let ragged = ragged::find(evidence, views, &views[n], &sure, threads);
        // What is no corridor as a whole may be one without what others have of it.
        known.extend(family.best(parts, &[&known[..], &ragged.sure].concat()));
        known.sort_by(|a, b| a.middle().total_cmp(&b.middle()).then(a.along[0].total_cmp(&b.along[0])));
        (known, ragged)
    });
    let (known, ragged): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let mut strips = known.concat();
    let mut placed = placed(views, strips.iter().map(Strip::place));
    let mut others = Ways::default();
    for Ways { mut sure, over, cut, on } in ragged {
        others.over.extend(over);
        others.cut.extend(cut);
        others.on.extend(on);
        sure.retain(|way| !is_askew_in(views, way, &strips, &placed));
        for way in sure {
            placed[way.direction].add(strips.len(), way.along, way.across);
            strips.push(way);
        }
    }
    // Now that the ways are known, what lies before them is known to be no gap.
    let more = map_each(views.len(), evidence.threads, |n| {
        let mouths = mouths::of(views, &views[n], &strips);
        if mouths.iter().all(Vec::is_empty) {
            return Vec::new();
        }
        let family = Family::new(evidence, views, &views[n], &mouths);
        let whole = family.before_mouths(&mouths, threads, evidence.recall);
        let known: Vec<Strip> = strips.iter().filter(|strip| strip.direction == n).cloned().collect();
        family.best(whole, &known)
    });
    strips.extend(more.into_iter().flatten());
    strips.sort_by_key(|strip| strip.direction);
    for ways in [&mut others.over, &mut others.cut, &mut others.on] {
        ways.retain(|way| !is_askew_in(views, way, &strips, &placed));
    }
    for ways in [&mut strips, &mut others.over, &mut others.cut, &mut others.on] {
        panes::cut(views, ways);
    }
    Ways { sure: strips, ..others }
}

/// True when a strip's middle lies in one of others, by their direction and place, that runs nearly the same way.
fn is_askew_in(views: &[Turned], one: &Strip, others: &[Strip], placed: &[Beside]) -> bool {
    let own = &views[one.direction];
    let middle = own.to_map([f64::midpoint(one.along[0], one.along[1]), one.middle()]);
    let askew = |its: &&Turned| its.direction != own.direction && own.sine(its) < ASKEW;
    views.iter().filter(askew).any(|its| {
        let [u, v] = its.place(middle);
        let holds = |other: &Strip| holds(other.along, u) && holds(other.across, v);
        placed[its.direction].touching([u; 2], [v; 2]).into_iter().any(|n| holds(&others[n]))
    })
}

/// The strips without those that lie for the most part within a longer one that runs nearly the same way: of what is bent each
/// direction finds its own piece.
pub fn without_bent(views: &[Turned], mut strips: Vec<Strip>) -> Vec<Strip> {
    let is_near = |one: &Turned, two: &Turned| one.direction != two.direction && one.sine(two) < BENT;
    if !views.iter().any(|one| views.iter().any(|two| is_near(one, two))) {
        return strips;
    }
    let placed = placed(views, strips.iter().map(Strip::place));
    let is_within = |strip: &Strip| {
        let own = &views[strip.direction];
        let share = |n: usize| strip.along[0] + strip.length() * (n as f64 + 0.5) / LOOKS as f64;
        let looks: Vec<[f64; 2]> = (0..LOOKS).map(|n| own.to_map([share(n), strip.middle()])).collect();
        views.iter().filter(|its| is_near(own, its)).any(|its| {
            let looks: Vec<[f64; 2]> = looks.iter().map(|&look| its.place(look)).collect();
            let [u, v] = [0, 1].map(|axis| around(looks.iter().map(|look| look[axis])));
            let near = placed[its.direction].touching(u, v).into_iter().map(|n| &strips[n]);
            near.filter(|other| other.length() > strip.length()).any(|other| {
                let within = looks.iter().filter(|[u, v]| holds(other.along, *u) && holds(other.across, *v));
                2 * within.count() > LOOKS
            })
        })
    };
    let within: Vec<bool> = strips.iter().map(is_within).collect();
    let mut within = within.into_iter();
    strips.retain(|_| !within.next().unwrap_or(false));
    strips
}

/// Between the lines of posts of the rows that cross a direction, metres.
pub fn pitches(views: &[Turned], view: &Turned) -> Vec<f64> {
    let others = views.iter().filter(|other| other.direction != view.direction);
    others.filter_map(|other| other.pitch.map(|pitch| pitch * other.sine(view))).collect()
}
