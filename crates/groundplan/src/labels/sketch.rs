//! II-E before the map is divided into faces: corridors first, junctions where they meet, rows between them, and all
//! that may be a door.

use super::beside::{Beside, placed};
use super::blocks::Standing;
use super::corridors::{self, ALONE, Strip};
use super::crossed;
use super::faced;
use super::gates;
use super::heads;
use super::joined;
use super::junctions::{self, Meeting};
use super::led;
use super::legs;
use super::look::Look;
use super::narrowed;
use super::racks::{self, Row};
use super::ragged::{self, Ways};
use super::rooms::{Bar, Space};
use super::sided;
use super::turned::Turned;
use super::whole;
use super::widths;
use super::{Evidence, Ground};
use crate::bands::{Later, Side, each, map_each};
use crate::ends::{overlap, shared};

/// A corridor that meets no other and is shorter than one alone is so long, metres, and so many others run beside it, no
/// more than a rack away, that are as wide and as long but for this share.
const RECURS: f64 = 3.5;
const OTHERS: usize = 2;
const ALIKE: f64 = 0.2;
/// One that is shut at both its ends, be it with a door, is so many times as long as wide: else it is a room. And where
/// no such others run beside it something stands along both its sides: else it is what furniture leaves of a room.
const SHUT: f64 = 4.5;
/// A corridor that meets one other goes on beyond it, on one side for so many times its width and so far, metres, or on
/// both together for as many times and so far: or it is a niche at the other's side.
const NICHE: (f64, f64) = (1.5, 2.5);
const NICHES: (f64, f64) = (2.2, 4.0);
/// Two niches face each other across a corridor where both together are less than this share of its length, the one is no
/// less than that share of the other, neither goes on as far as both must, and both are shut.
const FACING: f64 = 0.5;

/// What the map shows without its faces.
pub struct Sketch {
    pub views: Vec<Turned>,
    pub plan: Plan,
    pub free: Free,
}

/// What is seen before anything is made of it: all that needs gradients but for racks, which need the specks.
pub struct Sight<'a, F> {
    look: Look<'a>,
    views: Vec<Turned>,
    on_legs: Vec<Row>,
    free: F,
}

/// The free space, if there is some, and all that may be a door in it.
type Free = Option<(Space, Vec<Bar>)>;

impl<'s, 'a> Sight<'a, Later<'s, Free>> {
    /// From the lines, and what was begun before there were any.
    pub fn new(side: Side<'s, '_>, evidence: &'s Evidence, Ground { look, space }: Ground<'s, 'a>) -> Self {
        let free = side.start(move || space.get().map(|space| with_bars(evidence, space)));
        let look = look.get();
        let count = evidence.directions.angles.len();
        let on_legs = legs::find(evidence);
        let views = map_each(count, evidence.threads, |d| Turned::new(&shared_out(evidence), &look, d, &on_legs));
        Self { look, views, on_legs, free }
    }
}

impl<'a> Sight<'a, Free> {
    /// What needs gradients, one after another; nothing is seen between the lines yet.
    pub fn lined(evidence: &Evidence, Ground { look, space }: Ground<'_, 'a>) -> Self {
        let free = space.get().map(|space| with_bars(evidence, space));
        let count = evidence.directions.angles.len();
        let on_legs = legs::find(evidence);
        let views = map_each(count, evidence.threads, |d| Turned::lined(evidence, d, &on_legs));
        Self { look: look.get(), views, on_legs, free }
    }

    /// And what lies between the lines, for which of the gradients the specks are enough.
    pub fn seen(mut self, evidence: &Evidence) -> Self {
        let Self { look, views, .. } = &mut self;
        each(views.iter_mut().collect(), evidence.threads, |view: &mut Turned| view.see(&shared_out(evidence), look));
        self
    }
}

/// A space and what may be a door in it.
fn with_bars(evidence: &Evidence, space: Space) -> (Space, Vec<Bar>) {
    let bars = space.bars(evidence);
    (space, bars)
}

/// For each view: it shares its own work out among what threads are left.
fn shared_out<'a>(evidence: &Evidence<'a>) -> Evidence<'a> {
    Evidence { threads: evidence.threads / evidence.directions.angles.len().max(1), ..*evidence }
}

impl Sketch {
    /// Beside what is still being made of it.
    pub fn beside(evidence: &Evidence, sight: Sight<Later<Free>>) -> Self {
        let Sight { look, views, on_legs, free } = sight;
        let plan = Plan::of(evidence, &look, &views, &on_legs);
        Self { views, plan, free: free.get() }
    }

    /// From what is seen.
    pub fn new(evidence: &Evidence, sight: Sight<Free>) -> Self {
        let Sight { look, views, on_legs, free } = sight;
        let plan = Plan::of(evidence, &look, &views, &on_legs);
        Self { views, plan, free }
    }
}

/// The ways, what they meet and where they end, and the rows between them.
pub struct Plan {
    pub strips: Vec<Strip>,
    pub meetings: Vec<Meeting>,
    /// Dead ends: the corridor, which end of it, and the place along.
    pub ends: Vec<(usize, usize, f64)>,
    /// Where each corridor begins and ends, along, with its junctions.
    pub extents: Vec<[f64; 2]>,
    pub rows: Vec<Row>,
    /// The racks, of which not all are such rows.
    pub racks: Vec<Row>,
}

impl Plan {
    fn of(evidence: &Evidence, look: &Look, views: &[Turned], on_legs: &[Row]) -> Self {
        let least = evidence.parameters.labels_min_width;
        let Ways { sure, over, cut, on } = corridors::find(evidence, views);
        let mut found = joined::join(views, [sure, on.clone()].concat(), least);
        // What goes on beyond a way is none by itself.
        let beyond = placed(views, on.iter().map(Strip::place));
        let is_on =
            |way: &Strip| beyond[way.direction].touching(way.along, way.across).into_iter().any(|n| on[n] == *way);
        found.retain(|way| !is_on(way));
        let found = crossed::without_bays(evidence, look, views, found);
        let threads = evidence.threads;
        let standing = Standing::new(views, threads);
        // What was too short to stay bars no way whose sides are no lines, but tells how wide that is.
        let pieces = placed(views, found.iter().map(Strip::place));
        let over: Vec<Strip> = over.into_iter().map(|way| led::sided_by(views, way, &found, &pieces)).collect();
        let mut plan = Self::new(views, found, threads);
        plan = plan.with(views, &over, least, threads);
        // A way that ends at walls is no part of a room where others open into it and it goes on as one of them, or
        // racks stand.
        let known = placed(views, plan.strips.iter().map(Strip::place));
        let (led, cut): (Vec<_>, Vec<_>) = cut
            .into_iter()
            .filter(|way| led::is_opened_into(views, way, &plan.strips, &known))
            .partition(|way| led::goes_on_as(way, &plan.strips, &known));
        plan = plan.with(views, &led, least, threads);
        if !cut.is_empty() && !plan.find_racks(views, on_legs, &standing, threads).is_empty() {
            plan = plan.with(views, &cut, least, threads);
        }
        let gates = gates::find(evidence, look, views, &plan.strips, &plan.rows);
        let (known, more) = (plan.strips.len(), gates.len());
        plan.strips.extend(gates);
        plan.strips = joined::apart(views, widths::alike(views, plan.strips));
        if more > 0 || plan.strips.len() < known {
            plan = Self::new(views, plan.strips, threads);
        }
        if let Some(more) = heads::with(evidence, look, views, &plan.strips, &plan.rows) {
            plan = Self::new(views, more, threads);
        }
        plan.racks = plan.find_racks(views, on_legs, &standing, threads);
        let faced = faced::whole(views, &plan.strips, &plan.racks);
        if faced != plan.strips {
            plan = Self::new(views, faced, threads);
            plan.racks = plan.find_racks(views, on_legs, &standing, threads);
        }
        let narrow = narrowed::past(views, &plan.strips, &plan.racks, &plan.reached(views), least);
        if narrow != plan.strips {
            plan = Self::new(views, narrow, threads);
            plan.racks = plan.find_racks(views, on_legs, &standing, threads);
        }
        plan
    }

    /// From where to where each way leads, along: to what it meets, and to walls at its ends.
    fn reached(&self, views: &[Turned]) -> Vec<[f64; 2]> {
        let mut reached = vec![[f64::INFINITY, f64::NEG_INFINITY]; self.strips.len()];
        let mut add = |n: usize, from: f64, to: f64| {
            let [low, high] = reached[n];
            reached[n] = [low.min(from), high.max(to)];
        };
        for meeting in &self.meetings {
            for &n in &meeting.corridors {
                let (u, reach) = (views[self.strips[n].direction].place(meeting.at)[0], reach(meeting, n));
                add(n, u - reach, u + reach);
            }
        }
        self.ends.iter().for_each(|&(n, _, place)| add(n, place, place));
        reached
    }

    /// With what its ways leave of others.
    fn with(self, views: &[Turned], others: &[Strip], least: f64, threads: usize) -> Self {
        let more: Vec<Strip> = others.iter().filter_map(|way| ragged::clear_of(way, &self.strips)).collect();
        if more.is_empty() {
            return self;
        }
        Self::new(views, joined::join(views, [self.strips, more].concat(), least), threads)
    }

    fn find_racks(&self, views: &[Turned], on_legs: &[Row], standing: &Standing, threads: usize) -> Vec<Row> {
        whole::find(views, &self.strips, &self.extents, [&self.rows, on_legs], standing, threads)
    }

    fn new(views: &[Turned], strips: Vec<Strip>, threads: usize) -> Self {
        let (mut strips, meetings) = connected(views, strips, threads);
        // A corridor goes on to what it meets, and there it may be what another one meets.
        let longer = extents(views, &strips, &meetings);
        for (strip, along) in strips.iter_mut().zip(longer) {
            strip.along = [strip.along[0].min(along[0]), strip.along[1].max(along[1])];
        }
        let (strips, meetings) = connected(views, strips, threads);
        let mut extents = extents(views, &strips, &meetings);
        let ends = junctions::ends(views, &strips, &meetings);
        for &(n, side, place) in &ends {
            extents[n][side] = place;
        }
        let rows = racks::find(views, &strips, &extents);
        Self { strips, meetings, ends, extents, rows, racks: Vec::new() }
    }
}

/// A strip that leads nowhere is a niche: it goes, and what met it is judged again. When none is left, so do two niches
/// that face each other across the only corridor that they meet.
fn connected(views: &[Turned], mut strips: Vec<Strip>, threads: usize) -> (Vec<Strip>, Vec<Meeting>) {
    loop {
        let placed = placed(views, strips.iter().map(Strip::place));
        let meetings = junctions::find(views, &strips, threads);
        let met = junctions::of_each(&meetings, strips.len());
        let is_shut = |n: usize| (0..2).all(|side| junctions::is_shut(views, &strips[n], side));
        let goes_on =
            |n: usize, metres: f64, (widths, least): (f64, f64)| metres >= least.max(widths * strips[n].width());
        let leads = |n: usize| {
            let is_niche = |&m: &usize| {
                let [one, two] = arms(views, &strips, &meetings[m], n);
                !goes_on(n, one.max(two).min(one + two + reach(&meetings[m], n)), NICHE)
                    && !goes_on(n, one + two, NICHES)
            };
            let is_long = |widths: f64| strips[n].length() >= RECURS.max(widths * strips[n].width());
            let is_one_of_many = |apart: (f64, f64)| alike(&strips, &placed, n, apart, |_| true) >= OTHERS;
            let is_one_of = |widths: f64, apart: (f64, f64)| is_long(widths) && is_one_of_many(apart);
            // Beside a rack two do that open into the same way.
            let is_one_of_two = |m: usize| {
                let is_met = |way: &usize| *way != n && meetings[m].corridors.contains(way);
                let opens_there = |other: usize| {
                    other == n
                        || met[other].iter().any(|&at| meetings[at].corridors.iter().any(|c| *c != other && is_met(c)))
                };
                is_long(NICHE.0) && alike(&strips, &placed, n, racks::DEPTH, opens_there) > 0
            };
            let is_aisle = || is_one_of(ALONE.0, (0.0, racks::DEPTH.1)) || is_one_of(NICHE.0, racks::DEPTH);
            match met[n].len() {
                0 | 1 if racks::is_within_row(&strips, &placed, n) => false,
                0 if is_shut(n) => {
                    let is_one_of_many = || is_one_of_many((0.0, racks::DEPTH.1));
                    let is_sided = || sided::is_sided(&views[strips[n].direction], &strips[n]);
                    let is_at_row = || sided::is_at_row(&views[strips[n].direction], &strips, &placed, n);
                    strips[n].length() >= SHUT * strips[n].width() && (is_one_of_many() || is_sided() || is_at_row())
                }
                0 if strips[n].length() >= ALONE.1.max(ALONE.0 * strips[n].width()) => true,
                0 => is_aisle(),
                1 => !met[n].iter().any(is_niche) || is_aisle() || is_one_of_two(met[n][0]),
                _ => true,
            }
        };
        let faces = |n: usize| {
            let &[m] = &met[n][..] else { return false };
            let [one, two] = arms(views, &strips, &meetings[m], n);
            let others = meetings[m].corridors.iter().filter(|&&other| other != n);
            let longest = others.map(|&other| strips[other].length()).fold(0.0, f64::max);
            strips[n].length() < FACING * longest
                && one.min(two) >= FACING * one.max(two)
                && one.max(two) < NICHES.1
                && is_shut(n)
        };
        let mut stays: Vec<bool> = (0..strips.len()).map(leads).collect();
        if !stays.contains(&false) {
            stays = (0..strips.len()).map(|n| !faces(n)).collect();
        }
        if !stays.contains(&false) {
            return (strips, meetings);
        }
        // What is shut may be so by walls that its sides do not reach: then it is judged anew without the way to them.
        let shorter = |n: usize| {
            let Strip { along, held, .. } = strips[n];
            let short = shared(along, held);
            let is_so = !stays[n] && met[n].is_empty() && short != along && short[0] < short[1] && is_shut(n);
            is_so.then_some((n, short))
        };
        let shorter: Vec<_> = (0..strips.len()).filter_map(shorter).collect();
        for (n, short) in shorter {
            strips[n].along = short;
            stays[n] = true;
        }
        let mut flags = stays.into_iter();
        strips.retain(|_| flags.next().unwrap_or(false));
    }
}

/// How many others that are alike run beside a strip, one after another, so far apart, metres, of those that count and lie
/// no farther off than [`OTHERS`] of them take. Where they may not touch there are racks between them.
fn alike(strips: &[Strip], placed: &[Beside], n: usize, apart: (f64, f64), counts: impl Fn(usize) -> bool) -> usize {
    let own = &strips[n];
    let alike = |one: f64, two: f64| (one - two).abs() <= ALIKE * one.max(two);
    // Goods hide more of one aisle beside a rack than of the next.
    let whole = if apart.0 > 0.0 { f64::min } else { f64::max };
    let is_like = |other: &&Strip| {
        other.direction == own.direction
            && alike(own.width(), other.width())
            && overlap(own.along, other.along) >= (1.0 - ALIKE) * whole(own.length(), other.length())
    };
    let reach = OTHERS as f64 * (own.width() + apart.1);
    let around = placed[own.direction].touching(own.along, [own.middle() - reach, own.middle() + reach]);
    let mut sides: Vec<[f64; 2]> =
        around.into_iter().filter(|&m| counts(m)).map(|m| &strips[m]).filter(is_like).map(|s| s.across).collect();
    sides.sort_by(|one, two| (one[0] + one[1]).total_cmp(&(two[0] + two[1])));
    let at = sides.partition_point(|side| side[0] + side[1] < own.across[0] + own.across[1]);
    let is_next = |pair: &&[[f64; 2]]| (apart.0..=apart.1).contains(&(pair[1][0] - pair[0][1]));
    let above = sides[at..].windows(2).take_while(is_next).count();
    let below = sides[..(at + 1).min(sides.len())].windows(2).rev().take_while(is_next).count();
    above + below
}

/// Half of a strip's piece within a junction, metres along the strip.
fn reach(meeting: &Meeting, n: usize) -> f64 {
    meeting.reach[usize::from(meeting.corridors[0] != n)]
}

/// How far a strip goes on beyond a junction on either side, metres.
fn arms(views: &[Turned], strips: &[Strip], meeting: &Meeting, n: usize) -> [f64; 2] {
    let (strip, reach) = (&strips[n], reach(meeting, n));
    let at = views[strip.direction].place(meeting.at)[0];
    [at - reach - strip.along[0], strip.along[1] - at - reach]
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
