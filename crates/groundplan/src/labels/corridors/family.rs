//! The lines of one direction as sides of strips, and the best of the strips between them.

use super::columns::{BAY, Side};
use super::pieces::{BESIDE, INNER};
use crate::ends::{overlap, wider};
use crate::labels::Evidence;
use crate::labels::beside::Beside;
use crate::labels::corridors::{Strip, UNTOLD, pitches};
use crate::labels::recall::{Key, Recall};
use crate::labels::view::sums::What;
use crate::labels::view::sweep::Sweep;
use crate::labels::view::turned::Turned;
use crate::parameters::Parameters;
use std::cell::LazyCell;
use std::ops::Range;
use std::sync::Arc;

/// The gap of a missing post, in pitches.
const MISSING: f64 = 2.1;
/// A side with less than this share of structure on it cannot part two corridors.
const DENSE: f64 = 0.6;
/// What aisles open into side by side, so many at least, is so many times as wide as they are.
const LEAST_MOUTHS: usize = 2;
pub const LED_TO: f64 = 0.65;
/// And so much of its side between them has structure on it.
const BETWEEN: f64 = 0.5;
/// So many columns of the strips above lines are worth a thread's while.
const TOGETHER: usize = 1 << 13;
/// Strips that overlap across by more than this share of the narrower one are rivals.
const RIVAL: f64 = 0.25;

/// The lines of one direction as sides of strips.
pub struct Family<'a> {
    pub view: &'a Turned,
    /// Between the lines of posts of the rows that cross, metres: a strip as wide may be a row of empty bays.
    pub pitches: Vec<f64>,
    /// The most columns that a mouth of others has in a line.
    longest: usize,
    /// True when racks stand in the place: somewhere bays recur.
    pub racked: bool,
    pub parameters: &'a Parameters,
    pub sides: Arc<Vec<Side>>,
}

/// A strip between two lines, in little room: of a large map there are millions, of which few stay.
#[derive(Clone, Copy)]
pub struct Candidate {
    /// The two lines.
    sides: [u32; 2],
    /// From column to column.
    columns: [u32; 2],
    score: f64,
    bays: bool,
    /// As a whole.
    pub is_corridor: bool,
}

impl Candidate {
    fn new(view: &Turned, sides: [usize; 2], strip: &Strip, is_corridor: bool) -> Self {
        let columns = strip.along.map(|u| view.border(u) as u32);
        Self { sides: sides.map(|n| n as u32), columns, score: strip.score, bays: strip.bays, is_corridor }
    }

    fn strip(&self, view: &Turned) -> Strip {
        let along = self.columns.map(|column| view.along(column as usize));
        Strip {
            direction: view.direction,
            along,
            across: self.sides.map(|n| view.offsets[n as usize]),
            score: self.score,
            bays: self.bays,
            is_ragged: false,
            stops: [false; 2],
            held: UNTOLD,
            found: UNTOLD,
        }
    }
}

impl<'a> Family<'a> {
    /// With what is known of the mouths of others in each line, or nothing.
    pub fn new(evidence: &Evidence<'a>, views: &[Turned], view: &'a Turned, mouths: &[Vec<Range<usize>>]) -> Self {
        let racked = views.iter().any(|view| view.pitch.is_some());
        // Where the bays are known, one post may be missing.
        let bay = view.pitch.map_or(BAY, |pitch| BAY.max(MISSING * pitch));
        Self {
            pitches: pitches(views, view),
            longest: mouths.iter().flatten().map(ExactSizeIterator::len).max().unwrap_or(0),
            racked,
            view,
            parameters: evidence.parameters,
            sides: Arc::new(
                (0..view.offsets.len())
                    .map(|n| Side::new(view, n, bay, racked, mouths.get(n).map_or(&[], Vec::as_slice)))
                    .collect(),
            ),
        }
    }

    /// The same in a view that has some rows at hand.
    fn seen_in<'v>(&self, view: &'v Turned) -> Family<'v>
    where
        'a: 'v,
    {
        Family { view, pitches: self.pitches.clone(), sides: Arc::clone(&self.sides), ..*self }
    }

    /// Over the lower lines of strips.
    fn sweep(&self) -> Sweep<'_> {
        let around = [BESIDE.1, self.parameters.labels_max_width + BESIDE.1];
        Sweep { view: self.view, places: &self.view.offsets, around, what: &[What::Blocked, What::Barred] }
    }

    /// A line with each of those above it that are a corridor's width off, and the places across of both.
    fn facing(&self, low: usize) -> impl Iterator<Item = ([usize; 2], [f64; 2])> {
        let (view, parameters) = (self.view, self.parameters);
        let width = |across: &[f64; 2]| across[1] - across[0];
        let all = (low + 1..view.offsets.len()).map(move |high| ([low, high], [low, high].map(|n| view.offsets[n])));
        all.take_while(move |(_, across)| width(across) <= parameters.labels_max_width)
            .filter(move |(_, across)| width(across) >= parameters.labels_min_width)
    }

    /// The strips between every two lines that are a corridor's width apart.
    pub fn candidates(&self, threads: usize, recall: &Recall) -> Vec<Candidate> {
        let view = self.view;
        self.sweep().find(TOGETHER, threads, |near, low, found| {
            for (sides, across) in self.facing(low) {
                let pieces = recall.strips.or_find(
                    || sides.iter().fold(self.key(across), |key, &side| key.key(self.sides[side].key)),
                    || {
                        let own = self.seen_in(near.view());
                        own.open(across).into_iter().flat_map(|open| own.pieces_in(sides, open)).collect()
                    },
                );
                found.extend(pieces.iter().map(|(strip, whole)| Candidate::new(view, sides, strip, *whole)));
            }
        })
    }

    /// The key of all that strips between two lines are found from but for the gaps in these: of how far it is from post
    /// to post no more counts than what it does to them, so that where bays turn out to be others little is sought again.
    fn key(&self, [low, high]: [f64; 2]) -> Key {
        let key = self.view.key([low, high], BESIDE.1);
        key.with(u64::from(self.racked)).with(u64::from(self.is_wide_as_bays(high - low)))
    }

    /// The corridors into which others open side by side.
    pub fn before_mouths(&self, mouths: &[Vec<Range<usize>>], threads: usize, recall: &Recall) -> Vec<Candidate> {
        let view = self.view;
        self.sweep().find(TOGETHER, threads, |near, low, found| {
            for (sides, across) in self.facing(low) {
                let width = across[1] - across[0];
                let led_to = |strip: &Strip| sides.iter().any(|&side| self.is_led_to(strip, side, &mouths[side]));
                let may_be = |columns: &Range<usize>| {
                    sides
                        .iter()
                        .any(|&side| self.opening(&mouths[side], width, columns).nth(LEAST_MOUTHS - 1).is_some())
                };
                if !may_be(&(0..view.size[0])) {
                    continue;
                }
                let key = LazyCell::new(|| self.key(across));
                let open = recall.open.or_find(|| *key, || self.seen_in(near.view()).open(across));
                // Stretch by stretch: a mouth that has changed bears on no other.
                for open in open.into_iter().filter(may_be) {
                    let key = || sides.iter().fold(*key, |key, &side| self.key_in(key, side, &mouths[side], &open));
                    let strips = recall.strips.or_find(key, || {
                        let pieces = self.seen_in(near.view()).pieces_in(sides, open.clone());
                        pieces.into_iter().filter(|(strip, is_corridor)| *is_corridor && led_to(strip)).collect()
                    });
                    found.extend(strips.iter().map(|(strip, whole)| Candidate::new(view, sides, strip, *whole)));
                }
            }
        })
    }

    /// A key with all that mouths do to a side within some columns.
    fn key_in(&self, key: Key, side: usize, mouths: &[Range<usize>], columns: &Range<usize>) -> Key {
        let key = key.bits(&self.sides[side].walls, columns.clone());
        self.within(mouths, columns).fold(key, |key, mouth| key.with(mouth.start as u64).with(mouth.end as u64))
    }

    /// The mouths within some columns that may open into a strip so wide: beside wide aisles, what is narrow is in a row.
    fn opening<'m>(
        &self,
        mouths: &'m [Range<usize>],
        width: f64,
        columns: &Range<usize>,
    ) -> impl Iterator<Item = &'m Range<usize>> {
        let cell = self.view.cell;
        self.within(mouths, columns).filter(move |mouth| width >= LED_TO * (mouth.len() as f64 * cell))
    }

    /// The mouths of a line that lie within some columns.
    fn within<'m>(&self, mouths: &'m [Range<usize>], columns: &Range<usize>) -> impl Iterator<Item = &'m Range<usize>> {
        let Range { start, end } = *columns;
        // None is longer than the longest of all.
        let from = mouths.partition_point(|mouth| mouth.start + self.longest <= start);
        mouths[from..].iter().take_while(move |mouth| mouth.start < end).filter(move |mouth| start < mouth.end)
    }

    /// True when mouths of a side open into a strip side by side, with structure between them, and none is much wider.
    fn is_led_to(&self, strip: &Strip, side: usize, mouths: &[Range<usize>]) -> bool {
        let (from, to) = self.range(strip);
        let open: Vec<_> = self.within(mouths, &(from..to)).collect();
        let all_may = self.opening(mouths, strip.width(), &(from..to)).count() == open.len();
        let between: Vec<usize> = (from..to).filter(|c| !open.iter().any(|mouth| mouth.contains(c))).collect();
        let held = between.iter().filter(|&&c| self.sides[side].near.get(c)).count();
        open.len() >= LEAST_MOUTHS && all_may && held as f64 >= BETWEEN * between.len() as f64
    }

    /// Of rivals the best, and what they and those that are known leave of the others.
    pub fn best(&self, mut candidates: Vec<Candidate>, known: &[Strip]) -> Vec<Strip> {
        candidates.sort_by(|a, b| a.bays.cmp(&b.bays).then(b.score.total_cmp(&a.score)));
        let mut kept = known.to_vec();
        let mut placed = Beside::of(self.view);
        let mut next = 0;
        for candidate in candidates {
            for strip in &kept[next..] {
                placed.add(next, strip.along, strip.across);
                next += 1;
            }
            let strip = candidate.strip(self.view);
            let (first, last) = self.range(&strip);
            let left = self.left(&strip, &kept, &placed);
            if !left.is_empty() {
                let columns = self.columns(candidate.sides.map(|n| n as usize), first..last);
                for range in left {
                    let own = &columns[range.start - first..range.end - first];
                    kept.extend(self.strips(own, range.start, strip.across));
                }
            }
        }
        kept.split_off(known.len())
    }

    /// The columns of a strip.
    fn range(&self, strip: &Strip) -> (usize, usize) {
        let half = self.view.cell / 2.0;
        (self.view.column(strip.along[0] + half), self.view.column(strip.along[1] - half) + 1)
    }

    /// What stronger rivals, of which it is known where they lie, leave of a strip's columns.
    fn left(&self, strip: &Strip, kept: &[Strip], placed: &Beside) -> Vec<Range<usize>> {
        let (from, to) = self.range(strip);
        let mut left = vec![(from, to)];
        let near = placed.touching(wider(strip.along, self.view.cell), wider(strip.across, INNER));
        for rival in near.into_iter().map(|n| &kept[n]) {
            let cut = self.range(rival);
            if cut.1 <= from || to <= cut.0 {
                continue;
            }
            let shared = overlap(strip.across, rival.across);
            let beside = shared.abs() < INNER && !self.parts(strip, rival);
            if shared > RIVAL * strip.width().min(rival.width()) || beside {
                let pieces = left.into_iter().flat_map(|(a, b)| [(a, b.min(cut.0)), (a.max(cut.1), b)]);
                left = pieces.filter(|(a, b)| a < b).collect();
            }
        }
        left.into_iter().map(|(a, b)| a..b).collect()
    }

    /// True when enough structure lies between two strips side by side to part them.
    fn parts(&self, one: &Strip, two: &Strip) -> bool {
        let (below, above) = if one.middle() < two.middle() { (one, two) } else { (two, one) };
        let border = [below.across[1], above.across[0]];
        let (low, high) = (border[0].min(border[1]) - 1e-6, border[0].max(border[1]) + 1e-6);
        let lines = &self.sides[self.view.lines(low, high)];
        let (p, q) = (self.range(one), self.range(two));
        let (from, to) = (p.0.max(q.0), p.1.min(q.1));
        let structure = (from..to).filter(|&c| lines.iter().any(|line| line.faces.get(c))).count();
        from < to && structure as f64 >= DENSE * (to - from) as f64
    }
}
