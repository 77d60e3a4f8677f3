//! Regular patterns: the spatial frequency with which posts recur along the lines of one direction, which the paper
//! leaves as future work.

use super::Evidence;
use super::turned::Turned;

/// Lags are counted in steps of this many metres, between the shortest and the longest that are looked at.
const STEP: f64 = 0.05;
pub const LAGS: (f64, f64) = (1.0, 6.5);
/// Gradients of this magnitude or less are specks: posts, and the corners of goods.
const SPECK: u8 = 100;
/// Specks this near to a line stand on it, metres.
const NEAR: f64 = 0.12;
/// Lines with fewer specks say nothing.
const FEWEST: usize = 8;
/// A pattern stands out of the other lags by this factor.
const CONTRAST: f64 = 2.2;
/// Of several lags the shortest that is this much of the strongest is the pitch: the others are its multiples.
const FUNDAMENTAL: f64 = 0.5;

/// Distance from post to post along the lines of the view's direction, metres, where there is a pattern: the first
/// strong peak of the specks' autocorrelation, summed over the lines.
pub fn find(evidence: &Evidence, view: &Turned) -> Option<f64> {
    let last = (LAGS.1 / STEP) as usize;
    let first = (LAGS.0 / STEP) as usize;
    let mut sums = vec![0.0; last + 3];
    for places in specks(evidence, view) {
        if places.len() < FEWEST {
            continue;
        }
        let count = places.len() as f64;
        let span = f64::from(places[places.len() - 1] - places[0] + 1);
        for (n, &place) in places.iter().enumerate() {
            for other in &places[n + 1..] {
                match sums.get_mut((other - place) as usize) {
                    Some(sum) => *sum += 1.0,
                    None => break,
                }
            }
        }
        for (lag, sum) in sums.iter_mut().enumerate() {
            *sum -= count * count / span * (1.0 - lag as f64 / span).max(0.0);
        }
    }
    // A post is two or three steps wide.
    let smooth: Vec<f64> = (0..sums.len())
        .map(|n| (-2isize..=2).map(|d| sums.get(n.saturating_add_signed(d)).copied().unwrap_or(0.0)).sum())
        .collect();
    let range = first..=last;
    let strongest = smooth[range.clone()].iter().copied().fold(0.0, f64::max);
    let mut levels: Vec<f64> = smooth[range.clone()].iter().map(|s| s.abs()).collect();
    levels.sort_by(f64::total_cmp);
    if strongest <= CONTRAST * levels[levels.len() / 2] {
        return None;
    }
    let top =
        |lag: usize| (1..=4).all(|d| smooth[lag] >= smooth[lag - d] && smooth[lag] >= smooth[(lag + d).min(last)]);
    range.into_iter().find(|&lag| top(lag) && smooth[lag] >= FUNDAMENTAL * strongest).map(|lag| lag as f64 * STEP)
}

/// Places of all specks along and across the view's direction, metres.
pub fn specks_of<'a>(evidence: &'a Evidence, view: &'a Turned) -> impl Iterator<Item = [f64; 2]> + 'a {
    let frame = &evidence.grid.frame;
    let all = evidence.gradients.pixels.iter().zip(&evidence.gradients.magnitudes);
    let specks = all.filter(|(_, magnitude)| **magnitude <= SPECK);
    specks.map(|(pixel, _)| view.place(frame.to_metres(pixel.map(|p| f64::from(p) + 0.5))))
}

/// For each line of the direction, the steps along it at which specks stand, ascending.
fn specks(evidence: &Evidence, view: &Turned) -> Vec<Vec<i32>> {
    let lines = evidence.lines;
    let mut offsets: Vec<f64> = (0..lines.len())
        .filter(|&n| lines.directions[n] as usize == view.direction)
        .map(|n| lines.offsets[n])
        .collect();
    offsets.sort_by(f64::total_cmp);
    let mut places = vec![Vec::new(); offsets.len()];
    for [u, v] in specks_of(evidence, view) {
        let (from, to) = (offsets.partition_point(|&o| o < v - NEAR), offsets.partition_point(|&o| o <= v + NEAR));
        for line in &mut places[from..to] {
            line.push(((u - view.start[0]) / STEP) as i32);
        }
    }
    for line in &mut places {
        line.sort_unstable();
        line.dedup();
    }
    places
}
