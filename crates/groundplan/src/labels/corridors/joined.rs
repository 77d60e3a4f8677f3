//! Pieces of one way: in line, and with nothing in the way from one to the next.

use super::barriers;
use crate::ends::{around, holds, overlap, shared, sorted};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::{ASKEW, Strip};
use crate::labels::rows::SAME;
use crate::labels::view::turned::Turned;
use crate::labels::ways::across::crossing;
use crate::sets::Sets;
use std::cmp::Ordering;

/// Pieces share so much of the narrower one's width, which is so much of the wider one's, or where goods stand along one
/// of them at any depth, so much.
const SHARED: f64 = 0.7;
const ALIKE: f64 = 0.7;
const ALIKE_RAGGED: f64 = 0.5;
/// No two are further apart than so many times as they are wide, nor than the shorter one is long.
const APART: f64 = 3.0;
/// Between them the floor is free but for this share.
const CLUTTER: f64 = 0.1;
/// What lies between them for so much, metres, need not have been seen, where nothing stands in it.
const UNSEEN: f64 = 0.6;
/// A frame reaches so far into a way, metres, where a side may be off by as much.
const FRAME: f64 = 0.05;
/// A way lies within another when it shares more than this of its length, and of the narrower one's width.
const WITHIN: f64 = 0.5;
/// Ways touch that end so near to each other, metres.
const TOUCHING: f64 = 0.05;
/// What stands so near to the sides, in widths, does not bar the way.
const MARGIN: f64 = 0.1;

/// The ways, and in place of pieces of one the whole, no narrower than that.
pub fn join(views: &[Turned], mut strips: Vec<Strip>, least: f64) -> Vec<Strip> {
    let mut order: Vec<usize> = (0..strips.len()).collect();
    let place = |n: usize| (strips[n].direction, strips[n].across[0]);
    order.sort_by(|&a, &b| place(a).0.cmp(&place(b).0).then(place(a).1.total_cmp(&place(b).1)));
    let mut placed = placed(views, strips.iter().map(Strip::place));
    let mut pairs = Vec::new();
    for (n, &a) in order.iter().enumerate() {
        let (direction, high) = (strips[a].direction, strips[a].across[1]);
        let beside = order[n + 1..].iter().take_while(|&&b| place(b).0 == direction && place(b).1 < high);
        pairs.extend(
            beside.flat_map(|&b| [(a, b), (b, a)]).filter(|&(a, b)| is_one(views, &strips, &placed, least, [a, b])),
        );
    }
    let gap = |&(a, b): &(usize, usize)| strips[b].along[0] - strips[a].along[1];
    pairs.sort_by(|p, q| gap(p).total_cmp(&gap(q)).then(p.cmp(q)));
    let mut wholes = Sets::new(strips.len());
    for (a, b) in pairs {
        let [a, b] = [a, b].map(|n| wholes.of(n as u32) as usize);
        if is_one(views, &strips, &placed, least, [a, b]) {
            let across = shared(strips[a].across, strips[b].across);
            let (along, score) = ([strips[a].along[0], strips[b].along[1]], strips[a].score + strips[b].score);
            let bays = strips[a].bays && strips[b].bays;
            let is_ragged = strips[a].is_ragged || strips[b].is_ragged;
            let held = [strips[a].held[0], strips[b].held[1]];
            let stops = [strips[a].stops[0], strips[b].stops[1]];
            let found = [strips[a].found[0], strips[b].found[1]];
            let direction = strips[a].direction;
            strips[a] = Strip { direction, along, across, score, bays, is_ragged, stops, held, found };
            placed[direction].add(a, along, across);
            wholes.join(a as u32, b as u32);
        }
    }
    let kept: Vec<bool> = (0..strips.len()).map(|n| wholes.of(n as u32) as usize == n).collect();
    let mut kept = kept.into_iter();
    strips.retain(|_| kept.next().unwrap_or(false));
    strips
}

/// The ways without those that lie for the most part within longer ones: of their direction, which went on to what they
/// meet past a place that is wider or narrower, or larger ones that run nearly the same way.
pub fn apart(views: &[Turned], mut strips: Vec<Strip>) -> Vec<Strip> {
    let placed = placed(views, strips.iter().map(Strip::place));
    let lies_within = |n: usize, m: usize| {
        let (own, other) = (&strips[n], &strips[m]);
        let (length, longer) = (own.length(), other.length());
        (longer > length || longer == length && m < n)
            && overlap(own.along, other.along) > WITHIN * length
            && overlap(own.across, other.across) > WITHIN * own.width().min(other.width())
    };
    let kept: Vec<bool> = (0..strips.len())
        .map(|n| {
            let Strip { direction, along, across, .. } = strips[n];
            !placed[direction].touching(along, across).into_iter().any(|m| m != n && lies_within(n, m))
                && !lies_askew_on(views, &strips, &placed, n)
        })
        .collect();
    let mut kept = kept.into_iter();
    strips.retain(|_| kept.next().unwrap_or(false));
    strips
}

/// The ways, and of such as lie over one another from side to side, or touch end to end, all that they lead along.
pub fn once(views: &[Turned], strips: &[Strip]) -> Vec<Strip> {
    let placed = placed(views, strips.iter().map(Strip::place));
    let mut wholes = Sets::new(strips.len());
    for (n, own) in strips.iter().enumerate() {
        let over = placed[own.direction]
            .touching(own.along, own.across)
            .into_iter()
            .filter(|&m| m < n && strips[m].is_in_line(own, SAME) && overlap(strips[m].along, own.along) > -TOUCHING);
        over.for_each(|m| wholes.join_first(n as u32, m as u32));
    }
    let (numbers, count) = wholes.numbered();
    let mut left: Vec<Option<Strip>> = vec![None; count];
    for (strip, number) in strips.iter().zip(numbers) {
        match &mut left[number as usize - 1] {
            Some(way) => lengthen(way, strip),
            whole => *whole = Some(strip.clone()),
        }
    }
    left.into_iter().flatten().collect()
}

/// Leads a way on as far as another one over which it lies.
fn lengthen(way: &mut Strip, other: &Strip) {
    let is_farther = [other.along[0] < way.along[0], other.along[1] > way.along[1]];
    for end in (0..2).filter(|&end| is_farther[end]) {
        (way.along[end], way.stops[end]) = (other.along[end], other.stops[end]);
        (way.held[end], way.found[end]) = (other.held[end], other.found[end]);
    }
}

/// True when most of a way's middle, between its own sides, lies on another that runs nearly the same way: one more nearly
/// square to those that both cross, or as much so and larger. Of all it is known where they lie.
fn lies_askew_on(views: &[Turned], strips: &[Strip], placed: &[Beside], n: usize) -> bool {
    let strip = &strips[n];
    let own = &views[strip.direction];
    let sided = shared(strip.along, strip.held);
    let middle = sided.map(|u| own.to_map([u, strip.middle()]));
    let askew = |its: &&Turned| its.direction != own.direction && own.sine(its) < ASKEW;
    views.iter().filter(askew).any(|its| {
        let [from, to] = middle.map(|end| its.place(end));
        let [along, across] = [0, 1].map(|axis| sorted([from[axis], to[axis]]));
        let comes_first = |m: usize| {
            let [size, larger] = [strip, &strips[m]].map(|strip| strip.length() * strip.width());
            let is_larger = larger > size || larger == size && m < n;
            squarer(views, strips, placed, [n, m]).unwrap_or(if is_larger { m } else { n }) == m
        };
        let near = placed[its.direction].touching(along, across).into_iter();
        near.filter(|&m| comes_first(m)).any(|m| {
            // From which share of the middle to which the other holds it.
            let mut held: [f64; 2] = [0.0, 1.0];
            for (axis, sides) in [strips[m].along, strips[m].across].into_iter().enumerate() {
                let at = sides.map(|side| (side - from[axis]) / (to[axis] - from[axis]));
                held = shared(held, sorted(at));
            }
            held[1] - held[0] > WITHIN
        })
    })
}

/// Which of two ways is of the direction that is most nearly square to more of the ways that both cross; nothing where that
/// is as many.
fn squarer(views: &[Turned], strips: &[Strip], placed: &[Beside], pair: [usize; 2]) -> Option<usize> {
    let mut counts = [0; 2];
    for view in views {
        let square = crossing(views, view.direction);
        let Some(own) = pair.iter().position(|&n| square.is_some_and(|square| square.direction == strips[n].direction))
        else {
            continue;
        };
        let corners = views[strips[pair[0]].direction].rectangle(strips[pair[0]].along, strips[pair[0]].across);
        let [along, across] = [0, 1].map(|axis| around(corners.iter().map(|&corner| view.place(corner)[axis])));
        let is_crossed = |way: &Strip, n: usize| {
            let [s, u] = view.crossing(&views[strips[n].direction], way.middle(), strips[n].middle());
            holds(strips[n].along, s) && holds(way.along, u)
        };
        let near = placed[view.direction].touching(along, across).into_iter();
        counts[own] += near.filter(|&k| pair.iter().all(|&n| is_crossed(&strips[k], n))).count();
    }
    match counts[0].cmp(&counts[1]) {
        Ordering::Less => Some(pair[1]),
        Ordering::Equal => None,
        Ordering::Greater => Some(pair[0]),
    }
}

/// True when the way along one strip goes on as another, the next one; of all it is known where they lie, or lay.
fn is_one(views: &[Turned], strips: &[Strip], placed: &[Beside], least: f64, [a, b]: [usize; 2]) -> bool {
    let (one, two) = (&strips[a], &strips[b]);
    let between = [one.along[1], two.along[0]];
    let gap = between[1] - between[0];
    if a == b || one.direction != two.direction || gap < -1e-6 || gap > one.length().min(two.length()) {
        return false;
    }
    let [low, high] = shared(one.across, two.across);
    let (narrow, wide) = (one.width().min(two.width()), one.width().max(two.width()));
    let alike = if one.is_ragged || two.is_ragged { ALIKE_RAGGED } else { ALIKE };
    if high - low < least.max(SHARED * narrow) || narrow < alike * wide || gap > APART * f64::midpoint(narrow, wide) {
        return false;
    }
    let is_between = |other: &Strip| overlap(other.along, between) > 0.0 && overlap(other.across, [low, high]) > 0.0;
    if placed[one.direction].touching(between, [low, high]).into_iter().any(|n| is_between(&strips[n])) {
        return false;
    }
    let view = &views[one.direction];
    let margin = MARGIN * (high - low);
    let [from, to] = between.map(|u| view.column(u));
    let columns = from.saturating_sub(1)..to + 1;
    // A door's frame stands at the sides of what was not seen.
    let is_unseen = || gap <= UNSEEN && !view.stands_in(columns.clone(), [low + FRAME, high - FRAME]);
    let is_free = || {
        view.mean_blocked(columns.clone(), low + margin, high - margin) <= CLUTTER
            && !view.some_closed(columns.clone(), low + margin, high - margin).any()
    };
    (is_free() || is_unseen())
        && !barriers::among(view, [low, high], columns.clone()).any()
        && barriers::stops(view, [low, high], columns).is_empty()
}
