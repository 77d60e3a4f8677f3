//! Which strips lead somewhere: those that meet others, those that are long enough by themselves, and those that are one of
//! many; all others are niches.

use super::sided;
use crate::bands::flat_map_each;
use crate::ends::{overlap, shared, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::{ALIKE, ALONE, Strip};
use crate::labels::junctions;
use crate::labels::junctions::meeting::{Meeting, of_each};
use crate::labels::junctions::shut;
use crate::labels::rows::sections::WIDTH;
use crate::labels::rows::{self, DEPTH};
use crate::labels::view::turned::Turned;

/// A corridor that meets no other and is shorter than one alone is so long, metres, and so many others that are alike run
/// beside it, no more than a rack away.
const RECURS: f64 = 3.5;
const OTHERS: usize = 2;
/// One that is shut at both its ends, be it with a door, is so many times as long as wide: else it is a room. And where
/// no such others run beside it something stands along both its sides: else it is what furniture leaves of a room.
const SHUT: f64 = 4.5;
/// A corridor that meets one other goes on beyond it, on one side for so many times its width and so far, metres, or on
/// both together for as many times and so far: or it is a niche at the other's side. Half of what the junction takes of it
/// does not count where something stands at one of its ends. Of what has no lines for its sides and leads into the unseen
/// less is enough on the one.
const NICHE: (f64, f64) = (1.5, 2.5);
const UNSEEN: (f64, f64) = (0.5, 2.0);
const NICHES: (f64, f64) = (2.2, 4.0);
/// Two niches face each other across a corridor where both together are less than this share of its length, the one is no
/// less than that share of the other, neither goes on as far as both must, and both are shut.
const FACING: f64 = 0.5;

/// A strip that leads nowhere is a niche: it goes, and what met it is judged again. When none is left, so do two niches
/// that face each other across the only corridor that they meet.
pub fn of(views: &[Turned], mut strips: Vec<Strip>, threads: usize) -> (Vec<Strip>, Vec<Meeting>) {
    loop {
        let placed = placed(views, strips.iter().map(Strip::place));
        let meetings = junctions::find(views, &strips, threads);
        let met = of_each(&meetings, strips.len());
        let view = |n: usize| &views[strips[n].direction];
        let is_shut = |n: usize| (0..2).all(|side| shut::is_shut(view(n), &strips[n], side));
        let goes_on =
            |n: usize, metres: f64, (widths, least): (f64, f64)| metres >= least.max(widths * strips[n].width());
        let leads = |n: usize| {
            let is_niche = |&m: &usize| {
                let [one, two] = arms(views, &strips, &meetings[m], n);
                let free_end = usize::from(two > one);
                // It has been drawn as far as its sides were seen, which may be where the junction begins: what leads on
                // there is drawn on to its middle later, a room with jambs or a wall is not. A dead end has a wall too, at
                // its end alone: it is as wide as what it opens into.
                let is_parted = |side: usize| shut::is_parted(view(n), &strips[n], side);
                let is_alike = || {
                    strips[n].width() >= WIDTH.0
                        && meetings[m].corridors.iter().any(|&c| c != n && strips[n].is_as_wide(&strips[c]))
                };
                let parted = is_parted(1 - free_end) || is_parted(free_end) && !is_alike();
                let within = if parted { reach(&meetings[m], n) } else { 0.0 };
                let most = one.max(two).min(strips[n].length() - within);
                let ends_unseen = || strips[n].is_ragged && shut::is_unseen(view(n), &strips[n], free_end);
                let leads_on = goes_on(n, most, NICHE)
                    || goes_on(n, one + two, NICHES)
                    || goes_on(n, most, UNSEEN) && ends_unseen();
                !leads_on
            };
            let is_long = |widths: f64| strips[n].length() >= RECURS.max(widths * strips[n].width());
            let is_one_of_many = |beyond: Beyond| alike(&strips, &placed, n, beyond, |_| true) >= OTHERS;
            let is_one_of = |widths: f64, beyond: Beyond| is_long(widths) && is_one_of_many(beyond);
            // Beside a rack two do that open into the same way.
            let is_one_of_two = |m: usize| {
                let is_met = |way: &usize| *way != n && meetings[m].corridors.contains(way);
                let opens_there = |other: usize| {
                    other == n
                        || met[other].iter().any(|&at| meetings[at].corridors.iter().any(|c| *c != other && is_met(c)))
                };
                is_long(NICHE.0) && alike(&strips, &placed, n, Beyond::Rack, opens_there) > 0
            };
            let is_aisle = || is_one_of(ALONE.0, Beyond::Near) || is_one_of(NICHE.0, Beyond::Rack);
            match met[n].len() {
                0 | 1 if rows::is_within_row(&strips, &placed, n) => false,
                0 if is_shut(n) && sided::is_within_outline(view(n), &strips, &placed, n) => false,
                0 if is_shut(n) => {
                    let is_sided = || sided::is_sided_but_for_bays(view(n), &strips[n]);
                    let is_at_row = || sided::is_at_row(view(n), &strips, &placed, n);
                    strips[n].length() >= SHUT * strips[n].width()
                        && (is_one_of_many(Beyond::Near) || is_sided() || is_at_row())
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
        let mut stays = flat_map_each(strips.len(), threads, |n| [leads(n)]);
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

/// Where strips that are alike lie beside one another.
#[derive(Clone, Copy)]
enum Beyond {
    /// No more than a rack is deep away.
    Near,
    /// With a rack between them.
    Rack,
}

impl Beyond {
    /// How far off that is, metres.
    fn apart(self) -> [f64; 2] {
        match self {
            Self::Near => [0.0, DEPTH.1],
            Self::Rack => [DEPTH.0, DEPTH.1],
        }
    }

    /// What two so long share most of: goods hide more of one aisle beside a rack than of the next.
    fn of_both(self, one: f64, two: f64) -> f64 {
        match self {
            Self::Near => one.max(two),
            Self::Rack => one.min(two),
        }
    }
}

/// True when others that are alike run beside a strip, with racks between them; of all it is known where they lie.
pub fn is_one_of_many(strips: &[Strip], placed: &[Beside], n: usize) -> bool {
    alike(strips, placed, n, Beyond::Rack, |_| true) >= OTHERS
}

/// How many others that are alike run beside a strip, one after another, of those that count and lie no farther off than
/// [`OTHERS`] of them take.
fn alike(strips: &[Strip], placed: &[Beside], n: usize, beyond: Beyond, counts: impl Fn(usize) -> bool) -> usize {
    let own = &strips[n];
    let is_like = |other: &&Strip| {
        other.direction == own.direction
            && own.is_as_wide(other)
            && overlap(own.along, other.along) >= (1.0 - ALIKE) * beyond.of_both(own.length(), other.length())
    };
    let [nearest, farthest] = beyond.apart();
    let reach = OTHERS as f64 * (own.width() + farthest);
    let around = placed[own.direction].touching(own.along, wider([own.middle(); 2], reach));
    let mut sides: Vec<[f64; 2]> =
        around.into_iter().filter(|&m| counts(m)).map(|m| &strips[m]).filter(is_like).map(|s| s.across).collect();
    sides.sort_by(|one, two| (one[0] + one[1]).total_cmp(&(two[0] + two[1])));
    let at = sides.partition_point(|side| side[0] + side[1] < own.across[0] + own.across[1]);
    let is_next = |pair: &&[[f64; 2]]| (nearest..=farthest).contains(&(pair[1][0] - pair[0][1]));
    let above = sides[at..].windows(2).take_while(is_next).count();
    let below = sides[..(at + 1).min(sides.len())].windows(2).rev().take_while(is_next).count();
    above + below
}

/// Half of a strip's piece within a junction, metres along the strip.
pub fn reach(meeting: &Meeting, n: usize) -> f64 {
    meeting.reach[usize::from(meeting.corridors[0] != n)]
}

/// How far a strip goes on beyond a junction on either side, metres.
fn arms(views: &[Turned], strips: &[Strip], meeting: &Meeting, n: usize) -> [f64; 2] {
    let (strip, reach) = (&strips[n], reach(meeting, n));
    let at = views[strip.direction].place(meeting.at)[0];
    [at - reach - strip.along[0], strip.along[1] - at - reach]
}
