//! Bays: the pitch of the posts along each row of racks, and where they begin.
//!
//! Rows of one hall have one pitch, and each has its own beginning: the powers of their spectra add up whatever their
//! phases, and what goods do to one row they do not do to all. Where it is goods that recur most, several to a bay, the
//! rows' ends tell how many: posts stand there.

use super::lags;
use super::period::{self, Period};
use super::pitch;
use crate::bands::map_each;
use crate::ends::{holds, wider};
use crate::labels::Evidence;
use crate::labels::near::Near;
use crate::labels::recall::Key;
use crate::labels::rows::Row;
use crate::labels::view::turned::Turned;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The shortest pitch that is looked for, and the longest, metres.
const PITCHES: [f64; 2] = [1.0, 6.5];
/// Posts stand this near to a row's faces, metres.
const NEAR: f64 = 0.15;
/// Places along are told apart in steps of this, metres; a post is about two and a half of them wide.
const STEP: f64 = 0.05;
const POST: f64 = 2.5;
/// A row's own pitch lies within this share of the common one, to each side so many steps are tried.
const OWN: f64 = 0.08;
const STEPS: i32 = 60;
/// Multiples of its frequency that count.
const HARMONICS: usize = 4;
/// So many frequencies are worth a thread's while.
const TOGETHER: usize = 64;
/// A row recurs when chance gives such a power less often than once in exp of this (Rayleigh).
const CLEAR: f64 = 1.5;
/// What recurs at half a pitch does so at the whole one too, with this share of the power.
const AS_GOOD: f64 = 0.5;
/// The common power stands out of the median by this factor.
const CONTRAST: f64 = 1.8;
/// Goods recur at a whole part of a bay, but for this share of how many stand in one.
const PART: f64 = 0.08;
/// A row is so many goods long, but for this share of one.
const WHOLE: f64 = 0.3;
/// That all rows are as many bays long comes of chance no more often than this.
const CHANCE: f64 = 0.25;

/// For each row its period along its direction's places, where there is one.
pub fn find(evidence: &Evidence, views: &[Turned], rows: &[Row]) -> Vec<Option<Period>> {
    let mut found = vec![None; rows.len()];
    for view in views {
        let own: Vec<usize> = (0..rows.len()).filter(|&n| rows[n].direction == view.direction).collect();
        if own.is_empty() {
            continue;
        }
        let places = posts(pitch::specks_of(evidence, view), &own.iter().map(|&n| &rows[n]).collect::<Vec<_>>());
        let Some(common) = common(&places, evidence) else { continue };
        let lengths: Vec<usize> = own.iter().filter_map(|&n| nearly_whole(rows[n].length() / common)).collect();
        let Some(times) = in_a_bay(common, &lengths, view.pitch) else { continue };
        let periods = map_each(own.len(), evidence.threads, |m| {
            let (places, along) = (&places[m], rows[own[m]].along);
            let key = || Key::default().numbers(places).number(common).with(times as u64).numbers(&along);
            evidence.recall.periods.or_find(key, || of_row(places, common, times, along))
        });
        for (n, period) in own.into_iter().zip(periods) {
            found[n] = period;
        }
    }
    found
}

/// Where specks, which have places along and across, stand on the faces of some rows, along, row by row.
fn posts(specks: impl Iterator<Item = [f64; 2]>, rows: &[&Row]) -> Vec<Vec<f64>> {
    let ground = |row: &&Row| row.across.map(|face| [row.along, wider([face; 2], NEAR)]);
    let faces: Vec<[[f64; 2]; 2]> = rows.iter().flat_map(ground).collect();
    let corners =
        |&[[left, right], [low, high]]: &[[f64; 2]; 2]| vec![[left, low], [right, low], [right, high], [left, high]];
    let near = Near::polygons(&faces.iter().map(corners).collect::<Vec<_>>());
    // A row is short, and may lie far from the places' zero.
    let step = |u: f64| (u / STEP).round() as i64;
    let mut steps: Vec<Vec<i32>> = vec![Vec::new(); faces.len()];
    specks.for_each(|[u, v]| {
        for &n in near.at([u, v]) {
            let [along, across] = faces[n as usize];
            if holds(along, u) && holds(across, v) {
                steps[n as usize].push((step(u) - step(along[0])) as i32);
            }
        }
    });
    let of_row = |(row, steps): (&&Row, &mut [Vec<i32>])| {
        for face in &mut *steps {
            face.sort_unstable();
            face.dedup();
        }
        steps.iter().flatten().map(|&n| (step(row.along[0]) + i64::from(n)) as f64 * STEP).collect()
    };
    rows.iter().zip(steps.chunks_mut(2)).map(of_row).collect()
}

/// The pitch at which the rows have most power together; the longest of those that are about as good.
fn common(rows: &[Vec<f64>], evidence: &Evidence) -> Option<f64> {
    let Evidence { threads, recall, .. } = *evidence;
    let frequencies = period::frequencies(rows.iter().map(Vec::as_slice), PITCHES)?;
    let power = |frequencies: &[f64]| {
        let mut powers = vec![0.0; frequencies.len()];
        for places in rows {
            let key = || Key::default().numbers(places).numbers(frequencies);
            let strengths = recall.strengths.or_find(key, || Arc::new(period::strengths(places, frequencies)));
            powers.iter_mut().zip(&*strengths).for_each(|(sum, own)| *sum += places.len() as f64 * own * own);
        }
        powers
    };
    let parts: Vec<&[f64]> = frequencies.chunks(TOGETHER).collect();
    let powers = map_each(parts.len(), threads, |n| power(parts[n])).concat();
    let mut sorted = powers.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted[sorted.len() / 2];
    let best = sorted[sorted.len() - 1];
    if best < CONTRAST * usual {
        return None;
    }
    let good = powers.iter().position(|power| power - usual >= AS_GOOD * (best - usual))?;
    let top = (good..powers.len()).take_while(|&n| n == good || powers[n] > powers[n - 1]).last()?;
    let step = frequencies.get(1).map_or(0.0, |second| second - frequencies[0]);
    let near: Vec<f64> = (-20..=20).map(|n| frequencies[top] + f64::from(n) * step / 20.0).collect();
    power(&near)
        .into_iter()
        .zip(near.iter().map(|f| 1.0 / f))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, pitch)| pitch)
}

/// How many of what recurs most stand in a bay, by the lengths of the rows in these and by the posts' pitch, if any; none where
/// it recurs by chance.
fn in_a_bay(common: f64, lengths: &[usize], posts: Option<f64>) -> Option<usize> {
    let told = posts.and_then(|bay| whole(bay / common));
    // What is longer than most beams are recurs by chance as a rule, unless posts tell it.
    if common > lags::LONGEST && told.is_none() {
        return None;
    }
    // A bay shorter than any that is looked for among posts is told as some of them: then rows are of any number.
    let fit = |times: &usize| 2 * lengths.iter().filter(|length| *length % times == 0).count() >= lengths.len();
    let most = (lags::LONGEST / common + WHOLE) as usize;
    by_lengths(lengths, most).or(told.filter(fit)).or(Some(1))
}

/// The whole number nearest to a number, if that is off by no more than its part.
fn whole(number: f64) -> Option<usize> {
    let whole = number.round();
    (whole >= 1.0 && (number - whole).abs() <= PART * whole).then_some(whole as usize)
}

/// How many goods a row is long, if it ends where they do.
fn nearly_whole(length: f64) -> Option<usize> {
    ((length - length.round()).abs() <= WHOLE).then(|| length.round() as usize)
}

/// How many goods stand in a bay, some at most, told by how many of them the rows are long: racks begin and end at posts, so
/// that all are whole bays long, be it that one was seen in part.
fn by_lengths(lengths: &[usize], most: usize) -> Option<usize> {
    let lengths: BTreeSet<usize> = lengths.iter().copied().collect();
    let chance = |times: usize| {
        let fitting = lengths.iter().filter(|length| *length % times == 0).count();
        let others = lengths.len() - fitting;
        let ways = if others == 0 { 1.0 } else { lengths.len() as f64 };
        (fitting > 1 && others <= 1).then(|| (times, ways * (times as f64).powi(-(fitting as i32))))
    };
    let told = (2..=most).filter_map(chance).filter(|told| told.1 <= CHANCE);
    told.min_by(|one, two| one.1.total_cmp(&two.1)).map(|told| told.0)
}

/// A row's own pitch near the common one. Posts are narrow: their harmonics tell it more finely than they do
/// themselves.
///
/// What recurs, so many times in a bay, says how clearly it does. Posts stand at the first place of each bay: a row ends at
/// these.
fn of_row(places: &[f64], common: f64, times: usize, along: [f64; 2]) -> Option<Period> {
    // Two bays at least, and posts enough for them.
    let (common, length) = (times as f64 * common, along[1] - along[0]);
    let least = common * (1.0 - OWN);
    let posts = places.len() as f64 / POST;
    if length <= 1.5 * least || posts < CLEAR {
        return None;
    }
    let pitches = (-STEPS..=STEPS).map(|n| common * (1.0 + OWN * f64::from(n) / f64::from(STEPS)));
    let harmonics = HARMONICS * times;
    let own =
        pitches.map(|pitch| (period::power(places, pitch, harmonics), pitch)).max_by(|a, b| a.0.total_cmp(&b.0))?.1;
    let goods = period::measure(places, own / times as f64);
    let phases = (0..times).map(|n| (goods.phase + n as f64 * goods.pitch).rem_euclid(own));
    // How far the row's ends lie from posts, in bays.
    let off = |phase: f64| {
        let bays = along.iter().map(|end| (end - phase) / own);
        bays.map(|bay| (bay - bay.round()).abs()).sum::<f64>()
    };
    let phase = phases.min_by(|one, two| off(*one).total_cmp(&off(*two)))?;
    let period = Period { pitch: own, phase, ..goods };
    (posts * period.strength.powi(2) >= CLEAR && length > 1.5 * own).then_some(period)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_whole_bays_tell_how_often_goods_stand_in_one() {
        let times = |lengths: &[f64]| {
            by_lengths(&lengths.iter().filter_map(|&length| nearly_whole(length)).collect::<Vec<_>>(), 3)
        };
        // Of rows of one length nothing is told.
        assert_eq!(times(&[12.1; 8]), None);
        assert_eq!(times(&[12.1, 12.0, 8.1, 6.2, 3.9]), Some(2));
        assert_eq!(times(&[18.1, 15.0, 15.1]), Some(3));
        assert_eq!(times(&[10.1, 9.1, 7.0]), None);
        // One was seen in part, or ends nowhere near.
        assert_eq!(times(&[18.1, 15.0, 27.1, 10.0]), Some(3));
        assert_eq!(times(&[18.1, 15.0, 27.1, 10.5, 11.5]), Some(3));
        // As many times as most are.
        assert_eq!(times(&[24.0, 12.0, 18.0, 36.0]), Some(3));
    }
}
