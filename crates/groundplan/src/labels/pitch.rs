//! Regular patterns: the spatial frequency with which posts recur along the lines of one direction, which the paper
//! leaves as future work.

use super::Evidence;
use super::turned::Turned;
use crate::bands::{fold, worth};
use crate::ends::sorted;
use crate::gradients::SPECK;
use crate::on_line::OnLine;
use std::ops::Range;
use std::sync::Arc;

/// Lags are counted in steps of this many metres, between the shortest and the longest that are looked at.
const STEP: f64 = 0.05;
pub const LAGS: (f64, f64) = (1.6, 6.0);
/// Specks this near to a line stand on it, metres.
const NEAR: f64 = 0.12;
/// Lines with fewer specks say nothing.
const FEWEST: usize = 8;
/// What lies beside a line from so far to so far off it, metres, is floor where this share or less of it is not free,
/// and a row where that share or more is not: posts that recur across the rows have both on both sides.
const BESIDE: (f64, f64) = (0.15, 0.55);
const FACE: (f64, f64) = (0.1, 0.5);
/// Steps to either side of a lag that are of one post, and such that show what is chance.
const POST: usize = 2;
const BASE: usize = 12;
/// A pattern stands out of the other lags by this factor.
const CONTRAST: f64 = 8.0;
/// A pitch is a whole number of so many parts of a step.
const PARTS: f64 = 2.0;
/// Of several lags the shortest that is this much of the strongest is the pitch: the others are its multiples. Of such as bays
/// may have it is nearly as strong, or goods recur there, of which several stand in a bay.
const FUNDAMENTAL: f64 = 0.7;
const GOODS: f64 = 0.9;
/// No bay is longer than beams are, metres: what is told to be longer is two of them, or one and a half with a leg in each
/// one's middle. Where most are full few posts are seen from one to the next: the one stands out by the other factor.
pub const LONGEST: f64 = 3.9;
const BAYS: [f64; 2] = [2.0, 1.5];
const PARTIAL: f64 = 6.0;
/// Of what recurs along faces at least this share of the pairs has a row beside it from one to the other, and of those twice
/// as far apart: fewer where most bays are empty, and next to none of what recurs across the rows.
const ALONG: [f64; 2] = [0.15, 0.025];
/// Steps to either side of a lag over which it is the strongest.
const TOP: usize = 4;

/// The columns of a speck on a line, and what is not free on either side of the line before its column and up to its end.
struct Speck {
    column: usize,
    sums: [[f64; 2]; 2],
}

/// Distance from post to post along the lines of the view's direction, metres, where there is a pattern: the first
/// strong peak of the specks' autocorrelation, summed over the lines.
pub fn find(evidence: &Evidence, view: &Turned) -> Option<f64> {
    let last = (LAGS.1 / STEP) as usize;
    let first = (LAGS.0 / STEP) as usize;
    let lags = 2 * (last + BASE) + 1;
    let mut lines = specks(evidence, view);
    lines.retain(|(_, places)| places.len() >= FEWEST);
    let mut sums = vec![0.0; lags];
    for (_, places) in &lines {
        pairs(places, first - BASE..lags, |lag, _| sums[lag] += 1.0);
    }
    // What lies around a lag is chance. How many pairs are more than that, and in its deviations.
    let excess = |below: &[f64], times: usize, lag: usize| {
        let total = |reach: usize| {
            let [from, to] = [times * (lag - reach), times * (lag + reach) + 1];
            (below[to] - below[from], (to - from) as f64)
        };
        let ((near, few), (all, many)) = (total(POST), total(BASE));
        let chance = (all - near) / (many - few) * few;
        (near - chance, (near - chance) / libm::sqrt(chance + 1.0))
    };
    // What recurs does so twice as far off too; where nothing does it need not be asked whether it is along faces.
    // Of whole numbers what one sum is less another is exact.
    let below = all_below(&sums);
    let all: Vec<[(f64, f64); 2]> = (first..=last).map(|lag| [1, 2].map(|times| excess(&below, times, lag))).collect();
    if all.iter().all(|[once, twice]| once.1.min(twice.1) < CONTRAST) {
        return None;
    }
    let of_line = |n: usize| {
        let (offset, places) = &lines[n];
        let beside = [offset - BESIDE.1, offset + BESIDE.1];
        let key = || view.key_of_cells(view.key_on_line(evidence, *offset), beside);
        evidence.recall.faced.or_find(key, || Arc::new(along_faces(view, *offset, places, first - BASE..lags)))
    };
    let add = |sums: &mut Vec<u32>, more: &[u32]| sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
    let threads = worth(view.size[0] * view.size[1], evidence.threads);
    let empty = || vec![0; lags];
    let faces = fold(lines.len(), threads, empty, |sums, n| add(sums, &of_line(n)), |sums, more| add(sums, &more));
    let faces = all_below(&faces.into_iter().map(f64::from).collect::<Vec<_>>());
    let found: Vec<(f64, f64)> = (first..=last)
        .zip(&all)
        .map(|(lag, all)| {
            let is_along = (0..2).all(|n| excess(&faces, n + 1, lag).0 >= ALONG[n] * all[n].0);
            let [once, twice] = all;
            (once.0, if is_along { once.1.min(twice.1) } else { 0.0 })
        })
        .collect();
    let top = |n: usize| found[n.saturating_sub(TOP)..].iter().take(2 * TOP + 1).all(|other| other.1 <= found[n].1);
    let tops: Vec<usize> = (0..found.len()).filter(|&n| found[n].1 >= CONTRAST && top(n)).collect();
    let tops: Vec<(usize, f64)> = tops.into_iter().map(|n| (first + n, found[n].0)).collect();
    let pitch = shortest(&tops)?;
    let clear = |lag: usize| {
        let [once, twice] = all[lag - first];
        once.1.min(twice.1)
    };
    Some(between_steps(&sums, one_bay(pitch, clear)) * STEP)
}

/// The sums of all values before each, and of all.
fn all_below(values: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let sums = values.iter().map(|value| {
        sum += value;
        sum
    });
    std::iter::once(0.0).chain(sums).collect()
}

/// Of lags and how many pairs are so far apart the one from post to post, or some whole times that.
fn shortest(tops: &[(usize, f64)]) -> Option<usize> {
    let strong = |tops: &[(usize, f64)], least: f64| {
        let most = tops.iter().map(|top| top.1).fold(0.0, f64::max);
        tops.iter().copied().filter(|top| top.1 >= least * most).collect::<Vec<_>>()
    };
    let all = strong(tops, FUNDAMENTAL);
    let bays: Vec<_> = all.iter().copied().filter(|top| top.0 as f64 * STEP <= LONGEST).collect();
    strong(&bays, GOODS).first().or(all.first()).map(|top| top.0)
}

/// The lag of one bay, where that of some is longer than any; by how clearly each lag stands out.
fn one_bay(lag: usize, clear: impl Fn(usize) -> f64) -> usize {
    if lag as f64 * STEP <= LONGEST {
        return lag;
    }
    let clearest = |bays: f64| {
        let middle = (lag as f64 / bays).round() as usize;
        (middle - POST..=middle + POST).max_by(|one, two| clear(*one).total_cmp(&clear(*two)))
    };
    BAYS.into_iter().filter_map(clearest).find(|&bay| clear(bay) >= PARTIAL).unwrap_or(lag)
}

/// A length in whole parts of a step, metres.
pub fn in_parts(length: f64) -> f64 {
    (length / STEP * PARTS).round() / PARTS * STEP
}

/// How many pairs of specks on a line, of those so far apart, are as many steps apart with a row beside them.
fn along_faces(view: &Turned, offset: f64, places: &[i32], lags: Range<usize>) -> Vec<u32> {
    let beside = [-1.0, 1.0].map(|side| taken(view, offset, side));
    let speck = |&place: &i32| {
        let column = view.column(view.start[0] + f64::from(place) * STEP);
        Speck { column, sums: [column, column + 1].map(|n| beside.each_ref().map(|sums| sums[n])) }
    };
    let specks: Vec<Speck> = places.iter().map(speck).collect();
    let mut faces = vec![0; lags.end];
    pairs(places, lags, |lag, [one, other]| {
        if is_face(&specks[one], &specks[other]) {
            faces[lag] += 1;
        }
    });
    faces
}

/// Calls `visit` with the lag of each pair of some places that lie so far apart, ascending, and which two they are.
fn pairs(places: &[i32], lags: Range<usize>, mut visit: impl FnMut(usize, [usize; 2])) {
    let mut next = 0;
    for (n, one) in places.iter().enumerate() {
        let lag = |other: usize| places.get(other).map(|other| (other - one) as usize);
        while lag(next).is_some_and(|lag| lag < lags.start) {
            next += 1;
        }
        let mut other = next;
        while let Some(lag) = lag(other).filter(|lag| *lag < lags.end) {
            visit(lag, [n, other]);
            other += 1;
        }
    }
}

/// Where the pairs about a lag lie in the middle, in steps; in parts of a step, so that what changes in a corner of a map
/// as a rule changes no bay elsewhere.
fn between_steps(sums: &[f64], lag: usize) -> f64 {
    let around = &sums[lag - TOP..=lag + TOP];
    let chance = around.iter().copied().fold(f64::INFINITY, f64::min);
    let weight: f64 = around.iter().map(|count| count - chance).sum();
    let first = (lag - TOP) as f64;
    let middle = around.iter().enumerate().map(|(n, count)| (first + n as f64) * (count - chance)).sum::<f64>();
    if weight >= 1.0 { (middle / weight * PARTS).round() / PARTS } else { lag as f64 }
}

/// Places of all specks along and across the view's direction, metres.
pub fn specks_of<'a>(evidence: &'a Evidence, view: &'a Turned) -> impl Iterator<Item = [f64; 2]> + 'a {
    let frame = &evidence.grid.frame;
    let specks = evidence.gradients.iter().filter(|(_, _, magnitude)| *magnitude <= SPECK);
    specks.map(|(pixel, ..)| view.place(frame.to_metres(pixel.map(|p| f64::from(p) + 0.5))))
}

/// For each line of the direction, the steps along it at which specks stand, ascending.
fn specks(evidence: &Evidence, view: &Turned) -> Vec<(f64, Vec<i32>)> {
    let lines = evidence.lines;
    let mut offsets: Vec<f64> = (0..lines.len())
        .filter(|&n| lines.directions[n] as usize == view.direction)
        .map(|n| lines.offsets[n])
        .collect();
    offsets.sort_by(f64::total_cmp);
    let mut places = vec![Vec::new(); offsets.len()];
    let near = OnLine::new(&offsets, NEAR);
    specks_of(evidence, view).for_each(|[u, v]| {
        for line in &mut places[near.at(v)] {
            line.push(((u - view.start[0]) / STEP) as i32);
        }
    });
    for line in &mut places {
        line.sort_unstable();
        line.dedup();
    }
    offsets.into_iter().zip(places).collect()
}

/// What is not free on one side of a line: the columns' shares, summed up from the first.
fn taken(view: &Turned, offset: f64, side: f64) -> Vec<f64> {
    let [low, high] = sorted([offset + side * BESIDE.0, offset + side * BESIDE.1]);
    all_below(&view.all_blocked(low, high))
}

/// True when a row lies on one side of the line from one speck to another, and free floor on the other.
fn is_face(one: &Speck, other: &Speck) -> bool {
    let columns = (other.column + 1 - one.column) as f64;
    let [left, right] = [0, 1].map(|side| (other.sums[1][side] - one.sums[0][side]) / columns);
    left <= FACE.0 && right >= FACE.1 || right <= FACE.0 && left >= FACE.1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pitch of some lags, metres, with as many pairs.
    fn pitch(tops: &[(f64, f64)]) -> f64 {
        let lags: Vec<_> = tops.iter().map(|&(lag, pairs)| ((lag / STEP).round() as usize, pairs)).collect();
        shortest(&lags).unwrap() as f64 * STEP
    }

    #[test]
    fn posts_recur_at_one_bay_and_goods_at_a_part_of_it() {
        for (tops, bay) in [
            // Two, three, four and five pallets of 1.2 m, three of which stand in a bay.
            (&[(2.4, 645.0), (3.55, 841.0), (4.7, 563.0), (5.9, 628.0)][..], 3.55),
            // Half a bay, one, and one and a half.
            (&[(1.7, 1367.0), (3.45, 1635.0), (5.2, 968.0)], 3.45),
            // One and two.
            (&[(2.8, 415.0), (5.6, 318.0)], 2.8),
            (&[(1.8, 400.0), (3.6, 430.0)], 1.8),
            // Of most bays every second post alone was seen.
            (&[(2.7, 340.0), (5.55, 938.0)], 5.55),
        ] {
            assert!((pitch(tops) - bay).abs() < 1e-9, "{tops:?}");
        }
        assert_eq!(shortest(&[]), None);
    }
}
