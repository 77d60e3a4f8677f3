//! How far apart places on lines are, counted for all pairs of them, and how many of these are more than chance makes.

use std::collections::BTreeMap;
use std::ops::Range;

/// Lags are counted in steps of this many metres, between the shortest and the longest that are looked at, and twice that.
pub const STEP: f64 = 0.05;
pub const LAGS: (f64, f64) = (1.6, 6.0);
pub const FIRST: usize = (LAGS.0 / STEP) as usize;
pub const LAST: usize = (LAGS.1 / STEP) as usize;
pub const COUNTED: Range<usize> = FIRST - BASE..2 * (LAST + BASE) + 1;
/// Steps to either side of a lag that are of one post, and such that show what is chance.
const POST: usize = 2;
const BASE: usize = 12;
/// A pattern stands out of the other lags by this factor.
pub const CONTRAST: f64 = 8.0;
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
/// Steps to either side of a lag over which it is the strongest.
const TOP: usize = 4;
/// Parts of a view have sides of so many steps: a few rows. Smaller ones of a map of 1600 megapixels take too much memory.
const PART: i32 = 320;

/// How many pairs are so many steps apart, and how many less than that.
pub struct Counts {
    pairs: Vec<f64>,
    below: Vec<f64>,
}

impl Counts {
    pub fn new(pairs: Vec<f64>) -> Self {
        // Of whole numbers what one sum is less another is exact.
        let below = all_below(&pairs);
        Self { pairs, below }
    }

    /// How many pairs are some times a lag apart beyond what chance makes, which is what lies around it, and how many of its
    /// deviations that is.
    pub fn excess(&self, times: usize, lag: usize) -> (f64, f64) {
        let [(near, few), (all, many)] = [POST, BASE].map(|reach| self.total(times, lag, reach));
        let chance = (all - near) / (many - few) * few;
        (near - chance, (near - chance) / libm::sqrt(chance + 1.0))
    }

    /// How many pairs are some times a lag apart, or some times so many steps more or less, and of how many lags these are.
    fn total(&self, times: usize, lag: usize, reach: usize) -> (f64, f64) {
        let [from, to] = [times * (lag - reach), times * (lag + reach) + 1];
        (self.below[to] - self.below[from], (to - from) as f64)
    }

    /// The same of each lag that is looked at, and of twice that: what recurs does so twice as far off too.
    pub fn all(&self) -> Vec<[(f64, f64); 2]> {
        (FIRST..=LAST).map(|lag| [1, 2].map(|times| self.excess(times, lag))).collect()
    }

    /// True when at some lag, and at twice that, there are as many pairs as it takes to stand out by a factor of nothing but them.
    pub fn may_recur(&self, contrast: f64) -> bool {
        (FIRST..=LAST).any(|lag| [1, 2].into_iter().all(|times| self.total(times, lag, POST).0 >= contrast))
    }

    /// The pitch, metres, of those of the lags that are looked at that may be one.
    pub fn pitch(&self, may_be: &[bool]) -> Option<f64> {
        self.lag(may_be, CONTRAST).map(|lag| self.about(lag))
    }

    /// The same if it stands out of the other lags by a factor, and not only two of it do; and by which one it does.
    pub fn clear_pitch(&self, may_be: &[bool], contrast: f64) -> Option<(f64, f64)> {
        let lag = self.lag(may_be, contrast)?;
        let clear = clear([1, 2].map(|times| self.excess(times, lag)));
        (clear >= contrast).then(|| (self.about(lag), clear))
    }

    /// The lag of one bay among those that may be one and stand out of the others by a factor.
    fn lag(&self, may_be: &[bool], contrast: f64) -> Option<usize> {
        let all = self.all();
        let clear = |n: usize| clear(all[n]);
        let found: Vec<f64> = (0..all.len()).map(|n| if may_be[n] { clear(n) } else { 0.0 }).collect();
        let top = |n: usize| found[n.saturating_sub(TOP)..].iter().take(2 * TOP + 1).all(|other| *other <= found[n]);
        let tops = (0..found.len()).filter(|&n| found[n] >= contrast && top(n));
        let tops: Vec<(usize, f64)> = tops.map(|n| (FIRST + n, all[n][0].0)).collect();
        Some(one_bay(shortest(&tops)?, |lag| clear(lag - FIRST)))
    }

    /// Where the pairs about a lag lie, metres.
    fn about(&self, lag: usize) -> f64 {
        between_steps(&self.pairs, lag) * STEP
    }
}

/// How clearly a lag stands out of what lies around it, as does twice that.
pub fn clear([once, twice]: [(f64, f64); 2]) -> f64 {
    once.1.min(twice.1)
}

/// The pairs of places on lines by the part of a view that the first of them is in. Lines are too far apart for more pairs at
/// one lag than 16 bits hold.
#[derive(Default)]
pub struct Parts(BTreeMap<[i32; 2], Vec<u16>>);

impl Parts {
    /// Counts the pairs on a line so many steps across; its places are steps along it, ascending.
    pub fn add(&mut self, across: i32, places: &[i32]) {
        let part = |place: i32| [place, across].map(|steps| steps.div_euclid(PART));
        let mut from = 0;
        for some in places.chunk_by(|one, other| part(*one) == part(*other)) {
            let reach =
                places[from..].partition_point(|place| ((place - some[0]) as usize) < PART as usize + COUNTED.end);
            let counts = self.0.entry(part(some[0])).or_insert_with(|| vec![0; COUNTED.end]);
            pairs(&places[from..from + reach], some.len(), |lag, _| counts[lag] = counts[lag].saturating_add(1));
            from += some.len();
        }
    }

    /// All pairs of the parts that some places along and across are in, steps.
    pub fn within(&self, along: [i32; 2], across: [i32; 2]) -> Counts {
        let [[first, last], [low, high]] = [along, across].map(|ends| ends.map(|steps| steps.div_euclid(PART)));
        let parts = (first..=last).flat_map(|u| self.0.range([u, low]..=[u, high]));
        Counts::new(sum(parts.map(|(_, counts)| counts)))
    }

    pub fn all(&self) -> Counts {
        Counts::new(sum(self.0.values()))
    }

    /// All pairs of each part and of those beside it, with the steps along and across that these hold.
    pub fn about_each(&self) -> impl Iterator<Item = ([Range<i32>; 2], Counts)> {
        self.0.keys().map(|part| {
            let around = part.map(|n| (n - 1) * PART..(n + 2) * PART);
            let [along, across] = around.each_ref().map(|steps| [steps.start, steps.end - 1]);
            (around, self.within(along, across))
        })
    }
}

fn sum<'a>(all: impl Iterator<Item = &'a Vec<u16>>) -> Vec<f64> {
    let mut sums = vec![0.0; COUNTED.end];
    all.for_each(|counts| sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += f64::from(*count)));
    sums
}

/// The sums of all values before each, and of all.
pub fn all_below(values: &[f64]) -> Vec<f64> {
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

/// Calls `visit` with the lag of each pair of some places, which ascend, and which two they are; the one is of so many of the
/// lowest.
pub fn pairs(places: &[i32], first: usize, mut visit: impl FnMut(usize, [usize; 2])) {
    let mut next = 0;
    for (n, one) in places.iter().enumerate().take(first) {
        let lag = |other: usize| places.get(other).map(|other| (other - one) as usize);
        while lag(next).is_some_and(|lag| lag < COUNTED.start) {
            next += 1;
        }
        let mut other = next;
        while let Some(lag) = lag(other).filter(|lag| *lag < COUNTED.end) {
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

    #[test]
    fn parts_count_each_pair_once_where_its_first_place_is() {
        let places: Vec<i32> = (0..2000).filter(|n| n % 7 == 0 || n % 11 == 3).collect();
        let mut all = vec![0.0; COUNTED.end];
        pairs(&places, places.len(), |lag, _| all[lag] += 1.0);
        let mut parts = Parts::default();
        parts.add(-5, &places);
        parts.add(700, &places);
        assert_eq!(parts.within([0, 1999], [-5, -5]).pairs, all);
        assert_eq!(parts.all().pairs, all.iter().map(|count| 2.0 * count).collect::<Vec<_>>());
        // In the first part are the pairs of its places with all others.
        let first = places.iter().filter(|place| **place < PART).count();
        let mut own = vec![0.0; COUNTED.end];
        pairs(&places, first, |lag, _| own[lag] += 1.0);
        assert_eq!(parts.within([10, 10], [701, 702]).pairs, own);
    }
}
