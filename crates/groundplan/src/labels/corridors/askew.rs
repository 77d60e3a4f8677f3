//! Ways that seem to lead on through a hall whose rows run askew to them: from one of its aisles to the next between racks that
//! reach into the way from both sides, with nothing along it.

use super::sided;
use crate::ends::{holds, sorted, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::Strip;
use crate::labels::corridors::pieces::BESIDE;
use crate::labels::view::turned::Turned;

/// Aisles that a way crosses at an angle of such a sine run neither along it nor square to it.
const ASKEW: [f64; 2] = [0.2, 0.97];
/// Somewhere between two of them so much of its width is taken, but for its very sides.
const TAKEN: f64 = 0.02;
/// The shares of it along which the ground ends at its one side and at the other are less than this together.
const EDGED: f64 = 0.25;
/// Ground ends where this share of what lies beyond a side is not free, and of what lies within no more than the rest.
const ENDS: f64 = 0.8;
/// Of a way that is cut there what has nothing along both its sides is dropped when it is shorter than this share of the longest
/// piece.
const LEAST: f64 = 0.5;

/// The strips without what leads between two neighbouring ones of one direction through what stands askew to it. Of the pieces
/// that are left short ones between no sides go too.
pub fn cut(views: &[Turned], strips: Vec<Strip>) -> Vec<Strip> {
    let are_askew = |one: &Turned, two: &Turned| holds(ASKEW, one.sine(two));
    if !views.iter().any(|one| views.iter().any(|two| are_askew(one, two))) {
        return strips;
    }
    let placed = placed(views, strips.iter().map(Strip::place));
    let pieces = |strip: &Strip| {
        let own = &views[strip.direction];
        let askew = views.iter().filter(|its| are_askew(own, its));
        let mut without: Vec<[f64; 2]> = askew.flat_map(|its| through(own, its, strip, &strips, &placed)).collect();
        without.sort_by(|a, b| a[0].total_cmp(&b[0]));
        left(own, strip, &without)
    };
    strips.iter().flat_map(pieces).collect()
}

/// From where to where, along, a strip leads from one of another direction's to the next through what stands there.
fn through(own: &Turned, its: &Turned, strip: &Strip, strips: &[Strip], placed: &[Beside]) -> Vec<[f64; 2]> {
    let ends = strip.along.map(|u| its.place(own.to_map([u, strip.middle()])));
    let [u, v] = [0, 1].map(|axis| sorted(ends.map(|end| end[axis])));
    let along = |v: f64, t: f64| own.crossing(its, v, t)[1];
    let mut crossed: Vec<(f64, &Strip)> = Vec::new();
    for n in placed[its.direction].touching(u, v) {
        let [there, here] = own.crossing(its, strip.middle(), strips[n].middle());
        if holds(strips[n].along, there) && holds(strip.along, here) {
            crossed.push((here, &strips[n]));
        }
    }
    crossed.sort_by(|a, b| a.0.total_cmp(&b.0));
    let between = |pair: &[(f64, &Strip)]| {
        // The sides of both that face each other: what stands between them lies farther on at one of the strip's than at the other.
        let [one, two] = [pair[0].1, pair[1].1];
        let is_up = one.middle() < two.middle();
        let facing = if is_up { [one.across[1], two.across[0]] } else { [one.across[0], two.across[1]] };
        let is_apart = if is_up { facing[0] < facing[1] } else { facing[1] < facing[0] };
        let at_sides = strip.across.map(|side| sorted(facing.map(|t| along(side, t))));
        let stretch = facing.map(|t| along(strip.middle(), t));
        (is_apart && is_through_rows(own, strip, stretch, at_sides)).then_some(stretch)
    };
    crossed.windows(2).filter_map(between).collect()
}

/// True when what stands between two places reaches into a strip there, and does not stand along its sides between those two of
/// each.
fn is_through_rows(view: &Turned, strip: &Strip, along: [f64; 2], at_sides: [[f64; 2]; 2]) -> bool {
    let [low, high] = strip.across;
    let (near, far) = BESIDE;
    let [from, to] = wider([low, high], -near);
    if view.some_blocked(view.columns(along), from, to).into_iter().all(|blocked| blocked < TAKEN) {
        return false;
    }
    let edges = [[low + near, low + far, low - far, low - near], [high - far, high - near, high + near, high + far]];
    let edged = edges.into_iter().zip(at_sides).map(|([a, b, c, d], along)| {
        let within = view.some_blocked(view.columns(along), a, b);
        let beyond = view.some_blocked(view.columns(along), c, d);
        let is_edged = within.iter().zip(&beyond).filter(|(within, beyond)| **within < 1.0 - ENDS && **beyond > ENDS);
        is_edged.count() as f64 / within.len() as f64
    });
    edged.sum::<f64>() < EDGED
}

/// What is left of a strip without some stretches of it, each up to where the next begins.
fn left(view: &Turned, strip: &Strip, without: &[[f64; 2]]) -> Vec<Strip> {
    if without.is_empty() {
        return vec![strip.clone()];
    }
    let from = [strip.along[0]].into_iter().chain(without.iter().map(|stretch| stretch[1]));
    let to = without.iter().map(|stretch| stretch[0]).chain([strip.along[1]]);
    let pieces: Vec<Strip> = from
        .zip(to)
        .filter(|(from, to)| from < to)
        .map(|(from, to)| {
            let stops = [strip.stops[0] || from > strip.along[0], strip.stops[1] || to < strip.along[1]];
            Strip { along: [from, to], stops, ..strip.clone() }
        })
        .collect();
    let longest = pieces.iter().map(Strip::length).fold(0.0, f64::max);
    let stays = |piece: &Strip| piece.length() >= LEAST * longest || sided::is_sided(view, piece);
    pieces.into_iter().filter(stays).collect()
}
