//! What others tell of ways whose sides are no lines, or that may be bays: pieces between lines that they lie over, and ways
//! that lead there.

use super::sided;
use crate::ends::{around, holds, overlap, sorted, wider};
use crate::labels::beside::Beside;
use crate::labels::corridors::{self, Strip};
use crate::labels::view::turned::Turned;

/// A way opens into another when its end is so near to the other's side, metres.
const MOUTH: f64 = 3.0;
/// A way lies over a piece when it shares more than this of its own length and width.
const OVER: f64 = 0.5;
/// So many ways that end at a strip tell that it is one, and none that goes on past it by so much, metres.
const SEVERAL: usize = 2;
const SIDE: f64 = 0.6;
/// A little more than rounding may move a place, metres.
const SLACK: f64 = 1e-3;
/// It goes on beyond one over floor that is free but for this share.
const CLUTTER: f64 = 0.1;

/// A way that lies over a piece between lines, too short by itself, has that one's sides where floor shows between them up
/// to the way's ends: what stands on the floor narrows it no more than it does the piece.
pub fn sided_by(views: &[Turned], way: Strip, pieces: &[Strip], placed: &[Beside]) -> Strip {
    let view = &views[way.direction];
    let is_under = |piece: &&Strip| {
        !piece.is_ragged
            && overlap(piece.along, way.along) > OVER * way.length()
            && overlap(piece.across, way.across) > OVER * way.width()
    };
    let near = placed[way.direction].touching(way.along, way.across).into_iter().map(|n| &pieces[n]);
    let Some(piece) = near.filter(is_under).max_by(|a, b| a.length().total_cmp(&b.length())) else { return way };
    let is_floor = |[from, to]: [f64; 2]| {
        let [low, high] = piece.across;
        from >= to || view.mean_blocked(view.columns([from, to]), low, high) <= CLUTTER
    };
    if !is_floor([way.along[0], piece.along[0]]) || !is_floor([piece.along[1], way.along[1]]) {
        return way;
    }
    let along = around(way.along.into_iter().chain(piece.along));
    Strip { along, across: piece.across, ..way }
}

/// True when another ends at a way's side, or so near that it opens into it.
pub fn is_opened_into(views: &[Turned], way: &Strip, strips: &[Strip], placed: &[Beside]) -> bool {
    let own = &views[way.direction];
    let opens = |its: &Turned, strip: &Strip| {
        strip.along.into_iter().any(|end| {
            let [u, v] = own.place(its.to_map([end, strip.middle()]));
            holds(way.along, u) && (v - way.middle()).abs() <= way.width() / 2.0 + MOUTH
        })
    };
    leading(views, way, placed).any(|(its, n)| opens(its, &strips[n]))
}

/// The ways of other directions that reach a way or what lies a mouth beside it, by their numbers.
fn leading<'a>(
    views: &'a [Turned],
    way: &Strip,
    placed: &'a [Beside],
) -> impl Iterator<Item = (&'a Turned, usize)> + use<'a> {
    let own = &views[way.direction];
    let reached = own.rectangle(way.along, wider(way.across, MOUTH));
    views.iter().filter(|its| own.sine(its) > corridors::ASKEW).flat_map(move |its| {
        let [along, across] = [0, 1].map(|axis| around(reached.iter().map(|&corner| its.place(corner)[axis])));
        let near = placed[its.direction].touching(wider(along, SLACK), wider(across, SLACK));
        near.into_iter().map(move |n| (its, n))
    })
}

/// True when several long ways end at a strip, all on one side of it, and something stands along the other.
pub fn is_before_wall(views: &[Turned], strip: &Strip, strips: &[Strip], placed: &[Beside]) -> bool {
    let own = &views[strip.direction];
    let mut ending = [0, 0];
    let long =
        leading(views, strip, placed).map(|(its, n)| (its, &strips[n])).filter(|(_, way)| !way.bays && !way.is_short());
    for (its, way) in long {
        let ends = way.along.map(|end| own.place(its.to_map([end, way.middle()])));
        let [from, to] = sorted(ends.map(|end| end[1]));
        let reaches = overlap([from, to], wider(strip.across, MOUTH)) >= 0.0;
        if !reaches || !holds(strip.along, own.crossing(its, strip.middle(), way.middle())[1]) {
            continue;
        }
        let goes_past = from < strip.across[0] - SIDE && to > strip.across[1] + SIDE;
        if goes_past {
            return false;
        }
        ending[usize::from(f64::midpoint(from, to) > strip.middle())] += 1;
    }
    let sided = sided::are_sided(own, strip, strip.along);
    (0..2).any(|side| ending[side] >= SEVERAL && ending[1 - side] == 0 && sided[1 - side])
}

/// True when another of its direction ends in a way, as where both are one that bends: no farther from the way's end than
/// that is wide, and on its other side goes on beyond it for as long at least.
pub fn goes_on_as(way: &Strip, strips: &[Strip], placed: &[Beside]) -> bool {
    let width = way.width();
    let follows = |strip: &Strip| {
        let within = [strip.along[1] - way.along[0], way.along[1] - strip.along[0]];
        let beyond = [way.along[0] - strip.along[0], strip.along[1] - way.along[1]];
        overlap(strip.across, way.across) > 0.0
            && (0..2).any(|side| (0.0..=width).contains(&within[side]) && beyond[side] >= width)
    };
    let near = placed[way.direction].touching(wider(way.along, width), way.across);
    near.into_iter().any(|n| follows(&strips[n]))
}
