//! Slots, which are no ways, be they as long as some: in racks of several pallets' depth, where places are empty from one face on,
//! and between machines.

use super::across::crossing;
use crate::ends::{around, holds, overlap, sorted, wider};
use crate::labels::beside::{self, placed};
use crate::labels::corridors::Strip;
use crate::labels::corridors::connected;
use crate::labels::corridors::family;
use crate::labels::junctions;
use crate::labels::junctions::meeting::{CLUTTER, Meeting, of_each};
use crate::labels::junctions::shut::sign;
use crate::labels::rows::sections::WIDTH;
use crate::labels::rows::{DEPTH, Row, SAME};
use crate::labels::view::turned::Turned;
use std::collections::BTreeSet;

/// Two aisles that a rack lies between are so far apart at most, metres: one that is filled from both its faces.
const DEEPEST: f64 = 2.0 * DEPTH.1;
/// What ends so near to an aisle opens into it, metres.
const MOUTH: f64 = 0.6;
/// The aisles beside a slot go on past it by so many times its width.
const PAST: f64 = 2.0;
/// A slot is narrower than this share of an aisle that it opens into.
const NARROWER: f64 = family::LED_TO;
/// One between machines is narrower than a corridor that people pass through (DIN 18040-1), metres, and than this share of ways.
const CORRIDOR: f64 = 1.2;
const HALF: f64 = 0.5;
/// A rack is so many times as long as deep, or it may be a machine.
const LONG: f64 = 4.0;

/// The strips without slots. One leads from an aisle, is narrower than that, and something stands between its end and the next
/// aisle, no farther off than a rack is deep. Or it leads through to that, is too narrow for a way, and few are alike.
pub fn without(views: &[Turned], strips: Vec<Strip>) -> Vec<Strip> {
    let placed = placed(views, strips.iter().map(Strip::place));
    let is_slot = |n: usize| {
        let own = &strips[n];
        let (view, Some(other)) = (&views[own.direction], crossing(views, own.direction)) else { return false };
        let corners = view.rectangle(wider(own.along, DEEPEST), own.across);
        let [along, across] = [0, 1].map(|axis| around(corners.iter().map(|&corner| other.place(corner)[axis])));
        // From where to where along the strip each of the others lies, and how wide it is.
        let lies = |aisle: &Strip| {
            let [s, u] = view.crossing(other, own.middle(), aisle.middle());
            let reach = aisle.width() / 2.0 / other.sine(view);
            // At a rack's end it leads past that.
            let goes_on = holds(wider(aisle.along, -PAST * own.width()), s);
            (goes_on && aisle.length() > own.length()).then_some(([u - reach, u + reach], aisle.width()))
        };
        let near = placed[other.direction].touching(along, across).into_iter();
        let aisles: Vec<_> = near.filter_map(|m| lies(&strips[m])).collect();
        let middle = f64::midpoint(own.along[0], own.along[1]);
        let (before, behind): (Vec<_>, Vec<_>) =
            aisles.into_iter().partition(|([from, to], _)| from + to < 2.0 * middle);
        let before = before.into_iter().max_by(|a, b| a.0[1].total_cmp(&b.0[1]));
        let behind = behind.into_iter().min_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        let (Some((before, one)), Some((behind, two))) = (before, behind) else { return false };
        // What crosses an aisle leads on from there.
        if own.along[0] < before[0] - MOUTH || own.along[1] > behind[1] + MOUTH {
            return false;
        }
        let is_closed = |ends: [f64; 2]| view.mean_blocked(view.columns(ends), own.across[0], own.across[1]) > CLUTTER;
        let opens = [own.along[0] - before[1] <= MOUTH, behind[0] - own.along[1] <= MOUTH];
        // Where nothing stands between its end and an aisle it leads on to that.
        let between = [[before[1], own.along[0]], [own.along[1], behind[0]]];
        let leads = [0, 1].map(|side| opens[side] || !is_closed(between[side]));
        let is_narrower = |width: f64| own.width() < NARROWER * width;
        behind[0] - before[1] <= DEEPEST
            && match leads {
                [true, false] => is_narrower(one),
                [false, true] => is_narrower(two),
                [true, true] => {
                    own.width() < WIDTH.0
                        && is_narrower(one.min(two))
                        && !connected::is_one_of_many(&strips, &placed, n)
                }
                [false, false] => false,
            }
    };
    let stays: Vec<bool> = (0..strips.len()).map(|n| !is_slot(n)).collect();
    strips.into_iter().zip(stays).filter_map(|(strip, stays)| stays.then_some(strip)).collect()
}

/// Which ways are slots between machines by what they meet: narrower than corridors, less than half as wide as ways commonly are and
/// as each that they meet, at which they end and which goes on past them, no racks stand along both their sides and few are alike. What is no
/// longer than rows are deep, or leads into the open, is none.
pub fn by_meetings(views: &[Turned], strips: &[Strip], meetings: &[Meeting], racks: &[Row]) -> BTreeSet<usize> {
    let most = CORRIDOR.min(HALF * common_width(strips));
    if strips.iter().all(|strip| strip.width() >= most) {
        return BTreeSet::new();
    }
    let placed = placed(views, strips.iter().map(Strip::place));
    let stands = beside::placed(views, racks.iter().map(Row::place));
    let met = of_each(meetings, strips.len());
    let place = |n: usize, at: [f64; 2]| views[strips[n].direction].place(at)[0];
    let leads_into_open = |n: usize, side: usize| {
        let (own, view) = (&strips[n], &views[strips[n].direction]);
        let end = own.along[side];
        let beyond = view.columns(sorted([end, end + sign(side) * CORRIDOR]));
        let [low, high] = wider(own.across, own.width() / 2.0);
        !junctions::is_met(view, own, n, side, met[n].iter().map(|&m| &meetings[m]))
            && view.mean_blocked(beyond, low, high) <= CLUTTER
    };
    let is_between_racks = |own: &Strip| {
        let near = stands[own.direction].touching(own.along, wider(own.across, SAME));
        let long = near.into_iter().map(|n| &racks[n]).filter(|rack| {
            rack.length() >= LONG * rack.depth() && overlap(rack.along, own.along) > HALF * own.length()
        });
        let mut sides = [false; 2];
        long.for_each(|rack| sides[usize::from(rack.across[0] + rack.across[1] > 2.0 * own.middle())] = true);
        sides == [true; 2]
    };
    let may_be = |&n: &usize| {
        let within = met[n].iter().map(|&m| connected::reach(&meetings[m], n)).sum::<f64>();
        strips[n].width() < most
            && strips[n].length() - within > DEPTH.1
            && !(0..2).any(|side| leads_into_open(n, side))
            && !is_between_racks(&strips[n])
            && !connected::is_one_of_many(strips, &placed, n)
    };
    let is_beside = |n: usize, meeting: &Meeting, other: usize| {
        let (own, aisle) = (&strips[n], &strips[other]);
        let ends = own.along.map(|end| (place(n, meeting.at) - end).abs() - connected::reach(meeting, n));
        own.width() < HALF * aisle.width()
            && ends[0].min(ends[1]) <= MOUTH
            && holds(wider(aisle.along, -PAST * own.width()), place(other, meeting.at))
    };
    let mut left: Vec<usize> = (0..strips.len()).filter(|&n| !met[n].is_empty()).filter(may_be).collect();
    let mut slots = BTreeSet::new();
    loop {
        // What meets slots besides what is wide is one as well.
        let is_slot = |n: usize| {
            let all = met[n].iter().flat_map(|&m| meetings[m].corridors.iter().map(move |&c| (&meetings[m], c)));
            let mut others = all.filter(|(_, c)| *c != n && !slots.contains(c));
            others.all(|(meeting, c)| is_beside(n, meeting, c))
        };
        let (more, others): (Vec<usize>, Vec<usize>) = left.into_iter().partition(|&n| is_slot(n));
        if more.is_empty() {
            return slots;
        }
        slots.extend(more);
        left = others;
    }
}

/// How wide ways are for the greater part of their length, metres.
fn common_width(strips: &[Strip]) -> f64 {
    let mut widths: Vec<[f64; 2]> = strips.iter().map(|strip| [strip.width(), strip.length()]).collect();
    widths.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let half = widths.iter().map(|way| way[1]).sum::<f64>() / 2.0;
    let mut length = 0.0;
    let is_past = |[_, own]: &&[f64; 2]| {
        length += own;
        length >= half
    };
    widths.iter().find(is_past).map_or(0.0, |way| way[0])
}
