//! Regular patterns: the spatial frequency with which posts recur along the lines of one direction, which the paper
//! leaves as future work.

use super::lags::{CONTRAST, COUNTED, Counts, FIRST, LAST, Parts, STEP, all_below, clear, pairs};
use super::period;
use crate::bands::{fold, worth};
use crate::ends::{sorted, wider};
use crate::gradients::SPECK;
use crate::labels::Evidence;
use crate::labels::rows::Row;
use crate::labels::view::turned::Turned;
use crate::on_line::OnLine;
use std::ops::Range;
use std::sync::Arc;

/// Specks this near to a line stand on it, metres.
const NEAR: f64 = 0.12;
/// Lines with fewer specks say nothing.
const FEWEST: usize = 8;
/// What lies beside a line from so far to so far off it, metres, is floor where this share or less of it is not free,
/// and a row where that share or more is not: posts that recur across the rows have both on both sides.
const BESIDE: (f64, f64) = (0.15, 0.55);
const FACE: (f64, f64) = (0.1, 0.5);
/// Of what recurs along faces at least this share of the pairs has a row beside it from one to the other, and of those twice
/// as far apart: fewer where most bays are empty, and next to none of what recurs across the rows.
const ALONG: [f64; 2] = [0.15, 0.025];
/// What lies in parts of the view no further from a row, metres, is about it.
const ABOUT: f64 = 4.0;
/// A pitch recurs about a row where more than chance are so far apart by so many of its deviations; that of one place alone
/// by so many.
const RECURS: f64 = 2.0;
const RECURS_ELSEWHERE: f64 = 6.0;
/// What recurs in some part of the view and not in all of it stands out there by this factor.
const LOCAL: f64 = 12.0;
/// A pitch is of so many goods at most, which recur so many times as clearly, in pieces of lines of so many pitches, and by more
/// than so many deviations of what chance makes in as many.
const MOST_GOODS: usize = 4;
const CLEARER: f64 = 3.0;
const PIECE: f64 = 6.0;
const CHANCE: f64 = 4.0;
/// Two of one pitch are another to so many steps.
const HALVES: f64 = 2.0;

/// From post to post along the rows of a direction.
pub struct Pitch {
    /// Of all together, metres, or where these have none of those of one place.
    told: f64,
    is_common: bool,
    /// Which lags recur along faces.
    along: Vec<bool>,
    /// Where the view, and with it the first part, begins, metres.
    start: [f64; 2],
    parts: Parts,
    /// From one of the goods to the next, metres, where the pitch is some of these.
    pub goods: Option<f64>,
}

impl Pitch {
    /// Of all together, metres, where these have one.
    pub fn common(&self) -> Option<f64> {
        self.is_common.then_some(self.told)
    }

    /// The same, or else of those of one place.
    pub fn told(&self) -> f64 {
        self.told
    }

    /// Of the rows about one, metres: halls have bays of their own. Where neither this pitch recurs nor any other, no posts
    /// tell bays there.
    pub fn about(&self, row: &Row) -> Option<f64> {
        let steps = |ends: [f64; 2], axis: usize| wider(ends, ABOUT).map(|place| step(place - self.start[axis]));
        let counts = self.parts.within(steps(row.along, 0), steps(row.across, 1));
        let own = counts.pitch(&self.along);
        let lag = (self.told / STEP).round() as usize;
        let least = if self.is_common { RECURS } else { RECURS_ELSEWHERE };
        if !(FIRST..=LAST).contains(&lag) || counts.excess(1, lag).1 >= least {
            // What is told may be two bays where posts of another hall say so.
            return own.filter(|own| (self.told - 2.0 * own).abs() <= HALVES * STEP).or(Some(self.told));
        }
        own
    }
}

/// The columns of a speck on a line, and what is not free on either side of the line before its column and up to its end.
struct Speck {
    column: usize,
    sums: [[f64; 2]; 2],
}

/// How far it is from post to post along the lines of the view's direction, where there is a pattern: the first strong peak
/// of the specks' autocorrelation, summed over the lines.
pub fn find(evidence: &Evidence, view: &Turned) -> Option<Pitch> {
    let mut lines = specks(evidence, view);
    lines.retain(|(_, places)| places.len() >= FEWEST);
    let mut parts = Parts::default();
    for (offset, places) in &lines {
        parts.add(step(offset - view.start[1]), places);
    }
    let all = parts.all();
    let found = of_all(evidence, view, &lines, &parts, &all).or_else(|| of_one_place(view, &lines, &parts, &all));
    let Found { told, is_common, along } = found?;
    Some(Pitch { told, is_common, along, start: view.start, parts, goods: goods(&lines, told) })
}

/// Specks on lines: where each lies, and the steps along it at which they stand.
type Lines = [(f64, Vec<i32>)];

/// A pitch, whether it is that of all lines together, and which lags recur along faces.
struct Found {
    told: f64,
    is_common: bool,
    along: Vec<bool>,
}

/// The pitch of all lines together, or where halls whose bays differ have none in common the clearest one of a place.
fn of_all(evidence: &Evidence, view: &Turned, lines: &Lines, parts: &Parts, counts: &Counts) -> Option<Found> {
    // Where nothing recurs it need not be asked whether it is along faces.
    if !recurs(counts, CONTRAST) {
        return None;
    }
    let of_line = |n: usize| {
        let (offset, places) = &lines[n];
        let beside = [offset - BESIDE.1, offset + BESIDE.1];
        let key = || view.key_of_cells(view.key_on_line(evidence, *offset), beside);
        evidence.recall.faced.or_find(key, || Arc::new(along_faces(view, *offset, places, places.len())))
    };
    let threads = worth(view.size[0] * view.size[1], evidence.threads);
    let empty = || vec![0; COUNTED.end];
    let faces = fold(lines.len(), threads, empty, |sums, n| add(sums, &of_line(n)), |sums, more| add(sums, &more));
    let along = recur_along(counts, faces);
    let clearest = || {
        let of_each = parts.about_each().filter_map(|(_, counts)| counts.clear_pitch(&along, LOCAL));
        of_each.max_by(|one, two| one.1.total_cmp(&two.1)).map(|(pitch, _)| (pitch, false))
    };
    let (told, is_common) = counts.pitch(&along).map(|pitch| (pitch, true)).or_else(clearest)?;
    Some(Found { told, is_common, along })
}

/// The same of the place where it is clearest, with what recurs along faces there.
fn of_one_place(view: &Turned, lines: &Lines, parts: &Parts, counts: &Counts) -> Option<Found> {
    // A place has no more pairs than all have.
    if !counts.may_recur(LOCAL) {
        return None;
    }
    let of_place = |([steps, across], counts): ([Range<i32>; 2], Counts)| {
        let mut faces = vec![0; COUNTED.end];
        for (offset, places) in lines.iter().filter(|(offset, _)| across.contains(&step(offset - view.start[1]))) {
            let reached = steps.end + COUNTED.end as i32;
            let [from, to, last] =
                [steps.start, steps.end, reached].map(|end| places.partition_point(|place| *place < end));
            add(&mut faces, &along_faces(view, *offset, &places[from..last], to - from));
        }
        let along = recur_along(&counts, faces);
        let (told, clear) = counts.clear_pitch(&along, LOCAL)?;
        Some((clear, Found { told, is_common: false, along }))
    };
    let found = parts.about_each().filter(|(_, counts)| recurs(counts, LOCAL)).filter_map(of_place);
    found.max_by(|one, two| one.0.total_cmp(&two.0)).map(|(_, found)| found)
}

/// True when some lag, and twice that, stands out by a factor.
fn recurs(counts: &Counts, contrast: f64) -> bool {
    counts.all().iter().any(|lag| clear(*lag) >= contrast)
}

/// Which lags recur along faces, by how many pairs are so far apart in all and with a row beside them.
fn recur_along(counts: &Counts, faces: Vec<u32>) -> Vec<bool> {
    let faces = Counts::new(faces.into_iter().map(f64::from).collect());
    let is_along = |(n, all): (usize, [(f64, f64); 2])| {
        (0..2).all(|twice| faces.excess(twice + 1, FIRST + n).0 >= ALONG[twice] * all[twice].0)
    };
    counts.all().into_iter().enumerate().map(is_along).collect()
}

fn add(sums: &mut [u32], more: &[u32]) {
    sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
}

/// In which step from where a view begins a place lies.
fn step(place: f64) -> i32 {
    (place / STEP).floor() as i32
}

/// From one of the goods to the next where a pitch is some of these, metres: what recurs at a whole part of it hardly does so at the
/// whole, as posts would.
fn goods(lines: &Lines, pitch: f64) -> Option<f64> {
    let steps = pitch / STEP;
    let (mut powers, mut pieces) = ([0.0; MOST_GOODS], 0.0);
    for (_, places) in lines {
        // Racks beyond a way have a beginning of their own.
        for own in places.chunk_by(|one, two| piece(*one, steps) == piece(*two, steps)) {
            let own: Vec<f64> = own.iter().map(|&place| f64::from(place)).collect();
            if own.len() >= FEWEST {
                pieces += 1.0;
                for (power, number) in powers.iter_mut().zip(1..) {
                    let strength = period::measure(&own, steps / f64::from(number)).strength;
                    *power += own.len() as f64 * strength.powi(2) - 1.0;
                }
            }
        }
    }
    let (number, best) = powers.into_iter().enumerate().skip(1).max_by(|one, two| one.1.total_cmp(&two.1))?;
    (best > CHANCE * f64::sqrt(pieces) && best >= CLEARER * powers[0]).then(|| pitch / (number + 1) as f64)
}

/// Which piece of a line, so many pitches long, a place is of.
fn piece(place: i32, steps: f64) -> i64 {
    (f64::from(place) / (PIECE * steps)).floor() as i64
}

/// How many pairs of specks on a line, of those so far apart, are as many steps apart with a row beside them; the one is of so
/// many of the first.
fn along_faces(view: &Turned, offset: f64, places: &[i32], first: usize) -> Vec<u32> {
    let beside = [-1.0, 1.0].map(|side| taken(view, offset, side));
    let speck = |&place: &i32| {
        let column = view.column(view.start[0] + f64::from(place) * STEP);
        Speck { column, sums: [column, column + 1].map(|n| beside.each_ref().map(|sums| sums[n])) }
    };
    let specks: Vec<Speck> = places.iter().map(speck).collect();
    let mut faces = vec![0; COUNTED.end];
    pairs(places, first, |lag, [one, other]| {
        if is_face(&specks[one], &specks[other]) {
            faces[lag] += 1;
        }
    });
    faces
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

    /// Places at so many steps from one to the next, of rows in two pieces.
    fn line(step: f64) -> (f64, Vec<i32>) {
        let piece = |from: f64| (0..20).map(move |n| (from + step * f64::from(n)).round() as i32);
        (0.0, piece(3.0).chain(piece(20.3 * step + 17.0)).collect())
    }

    #[test]
    fn a_pitch_at_which_nothing_recurs_but_at_its_half_is_two_goods() {
        // 2.7 m, 54 steps.
        assert_eq!(goods(&[line(54.0)], 2.7), None);
        assert_eq!(goods(&[line(27.0)], 2.7), Some(1.35));
        assert_eq!(goods(&[line(18.0)], 2.7), Some(2.7 / 3.0));
        assert_eq!(goods(&[(0.0, vec![3, 30, 57])], 2.7), None);
    }
}
