//! II-E: corridors, Fig. 8c: closed on both long sides, open along the middle.
//!
//! A corridor lies between two lines of one direction, but neither holds across the whole map: each pair of lines is
//! asked column by column whether the strip between them is free there and whether structure lies on both its sides.
//! Gaps in a side shorter than a rack's bay are the bay; longer ones are where other ways open. Of strips that overlap
//! the one with the most wall along it is kept, and the others keep what is left of them.

use super::beside::{Beside, placed, wider};
use super::columns::{BAY, Column, NARROWED, Side, Walled, count};
use super::recall::{Key, Recall};
use super::runs::{best_pieces, runs};
use super::sums::What;
use super::sweep::Sweep;
use super::turned::{BARRED, IMPASSABLE, Turned};
use super::{Evidence, barriers, mouths, ragged};
use crate::bands::map_each;
use crate::parameters::Parameters;
use std::ops::Range;
use std::sync::Arc;

/// A strip of free space along one direction, in the direction's own places (metres along and across).
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// Index of the direction.
    pub direction: usize,
    /// Where its walled part begins and ends, along.
    pub along: [f64; 2],
    /// Its two sides, across.
    pub across: [f64; 2],
    /// What speaks for it less what speaks against it, metres.
    pub score: f64,
    /// It may be a row of empty bays, unless the rows that it crosses say otherwise.
    pub bays: bool,
    /// Its sides are no lines, and stand back from it.
    pub is_ragged: bool,
    /// Where it begins and ends without what lies beyond a gap longer than a bay and is no more than a speck, along.
    pub held: [f64; 2],
}

/// Of a strip of which it is not told what of it is held.
pub const UNTOLD: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

impl Strip {
    /// Free width, metres.
    pub fn width(&self) -> f64 {
        self.across[1] - self.across[0]
    }

    /// Walled length, end to end, metres.
    pub fn length(&self) -> f64 {
        self.along[1] - self.along[0]
    }

    /// Its direction and its places, as [`placed`] takes them.
    pub fn place(&self) -> (usize, [f64; 2], [f64; 2]) {
        (self.direction, self.along, self.across)
    }

    /// Place across of its centre line.
    pub fn middle(&self) -> f64 {
        f64::midpoint(self.across[0], self.across[1])
    }
}

/// The gap of a missing post, in pitches.
const MISSING: f64 = 2.1;
/// Lines this near to a strip's side belong to it, metres.
const INNER: f64 = 0.45;
/// Walls lie this far within the strip's sides, metres.
const MARGIN: f64 = 0.2;
/// Where the strip just beyond a side, from so far to so far, metres, is not free by this share, the side holds without
/// structure on it: a wall too faint to be occupied, or goods behind the posts.
const BESIDE: (f64, f64) = (0.1, 0.5);
const BEYOND: f64 = 0.8;
/// A side with less than this share of structure on it cannot part two corridors.
const DENSE: f64 = 0.6;
/// Least share of a corridor's length that is walled on both sides.
const LEAST_WALLED: f64 = 0.2;
/// What aisles open into side by side, so many at least, is so many times as wide as they are.
const LEAST_MOUTHS: usize = 2;
const LED_TO: f64 = 0.65;
/// And so much of its side between them has structure on it.
const BETWEEN: f64 = 0.5;
/// A corridor so many times as long as wide is a long one.
const LONG: f64 = 4.5;
const VERY_LONG: f64 = 6.5;
/// Least share of a long corridor's walls that is more than posts, on one side at least.
const FACED_LONG: f64 = 0.55;
/// The same for a short one, which may be a row of empty bays: so much on one side, and on the other so much too, or
/// nearly all on the one.
const FACED: f64 = 0.7;
const FACED_TWICE: f64 = 0.4;
const FACED_ONCE: f64 = 0.85;
/// A strip from so many to so many pitches wide may be a row of bays.
pub const BAY_WIDTH: (f64, f64) = (0.65, 1.17);
/// It is none when walls run along both its sides, with hardly a gap.
const WALLED: f64 = 0.8;
/// Nor when it is long, nearly all of it has structure on a side, and so much has it on the weaker one.
const WEAKER: f64 = 0.45;
/// And where no bays recur none when so much of its length has no more than posts on a side.
const BARE: f64 = 0.7;
/// Nor when a wall runs along nearly all of one side, and so much has structure on the other.
const WALL: f64 = 0.9;
const WEAKER_AT_WALL: f64 = 0.38;
/// Strips that overlap across by more than this share of the narrower one are rivals.
const RIVAL: f64 = 0.25;

/// Strips whose directions differ by an angle of a smaller sine run nearly the same way.
const ASKEW: f64 = 0.5;

/// Corridors along every direction, in the order of the directions: of each those between lines by their places, and
/// then the ragged ones, the best first.
pub fn find(evidence: &Evidence, views: &[Turned]) -> Vec<Strip> {
    // Each view shares its own work out among what threads are left.
    let threads = evidence.threads.div_ceil(views.len().max(1));
    let found = map_each(views.len(), evidence.threads, |n| {
        let family = Family::new(evidence, views, &views[n], &[]);
        let mut parts = family.candidates(threads, evidence.recall);
        let whole = parts.iter().filter(|c| c.is_corridor).copied().collect();
        parts.retain(|c| !c.is_corridor);
        let mut known = family.best(whole, &[]);
        let sure: Vec<Strip> = known.iter().filter(|strip| !strip.bays).cloned().collect();
        let ragged = ragged::find(evidence, views, &views[n], &sure, threads);
        // What is no corridor as a whole may be one without what others have of it.
        known.extend(family.best(parts, &[&known[..], &ragged].concat()));
        known.sort_by(|a, b| a.middle().total_cmp(&b.middle()).then(a.along[0].total_cmp(&b.along[0])));
        (known, ragged)
    });
    let (known, ragged): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    let mut strips = known.concat();
    let mut placed = placed(views, strips.iter().map(Strip::place));
    for mut ragged in ragged {
        ragged.retain(|way| !is_askew_in(views, way, &strips, &placed));
        for way in ragged {
            placed[way.direction].add(strips.len(), way.along, way.across);
            strips.push(way);
        }
    }
    // Now that the ways are known, what lies before them is known to be no gap.
    let more = map_each(views.len(), evidence.threads, |n| {
        let mouths = mouths::of(views, &views[n], &strips);
        if mouths.iter().all(Vec::is_empty) {
            return Vec::new();
        }
        let family = Family::new(evidence, views, &views[n], &mouths);
        let whole = family.before_mouths(&mouths, threads, evidence.recall);
        let known: Vec<Strip> = strips.iter().filter(|strip| strip.direction == n).cloned().collect();
        family.best(whole, &known)
    });
    strips.extend(more.into_iter().flatten());
    strips.sort_by_key(|strip| strip.direction);
    strips
}

/// True when a strip's middle lies in one of others, by their direction and place, that runs nearly the same way.
fn is_askew_in(views: &[Turned], one: &Strip, others: &[Strip], placed: &[Beside]) -> bool {
    let own = &views[one.direction];
    let middle = own.to_map([f64::midpoint(one.along[0], one.along[1]), one.middle()]);
    let askew = |its: &&Turned| its.direction != own.direction && libm::sin(own.angle - its.angle).abs() < ASKEW;
    views.iter().filter(askew).any(|its| {
        let [u, v] = its.place(middle);
        let holds = |other: &Strip| {
            (other.along[0]..=other.along[1]).contains(&u) && (other.across[0]..=other.across[1]).contains(&v)
        };
        placed[its.direction].touching([u; 2], [v; 2]).into_iter().any(|n| holds(&others[n]))
    })
}

/// Between the lines of posts of the rows that cross a direction, metres.
pub fn pitches(views: &[Turned], view: &Turned) -> Vec<f64> {
    let others = views.iter().filter(|other| other.direction != view.direction);
    let across = others.filter_map(|other| {
        let sine = libm::sin(other.angle - view.angle).abs();
        other.pitch.map(|pitch| pitch * sine)
    });
    across.collect()
}

/// The lines of one direction as sides of strips.
struct Family<'a> {
    view: &'a Turned,
    /// Between the lines of posts of the rows that cross, metres: a strip as wide may be a row of empty bays.
    pitches: Vec<f64>,
    /// True when racks stand in the place: somewhere bays recur.
    racked: bool,
    parameters: &'a Parameters,
    sides: Arc<Vec<Side>>,
}

/// A strip between two lines, in little room: of a large map there are millions, of which few stay.
#[derive(Clone, Copy)]
struct Candidate {
    /// The two lines.
    sides: [u32; 2],
    /// From column to column.
    columns: [u32; 2],
    score: f64,
    bays: bool,
    /// As a whole.
    is_corridor: bool,
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
            held: UNTOLD,
        }
    }
}

impl<'a> Family<'a> {
    /// With what is known of the mouths of others in each line, or nothing.
    fn new(evidence: &Evidence<'a>, views: &[Turned], view: &'a Turned, mouths: &[Vec<Range<usize>>]) -> Self {
        let racked = views.iter().any(|view| view.pitch.is_some());
        // Where the bays are known, one post may be missing.
        let bay = view.pitch.map_or(BAY, |pitch| BAY.max(MISSING * pitch));
        Self {
            pitches: pitches(views, view),
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

    /// The strips between every two lines that are a corridor's width apart.
    fn candidates(&self, threads: usize, recall: &Recall) -> Vec<Candidate> {
        let view = self.view;
        self.sweep().find(1, threads, |near, low, found| {
            for high in low + 1..view.offsets.len() {
                let across = [view.offsets[low], view.offsets[high]];
                let width = across[1] - across[0];
                if width > self.parameters.labels_max_width {
                    break;
                }
                if width >= self.parameters.labels_min_width {
                    let sides = [low, high];
                    let pieces = recall.strips.or_find(
                        || self.key(across),
                        || {
                            let own = self.seen_in(near.view());
                            let pieces = |open: Range<usize>| {
                                let columns = own.columns(sides, open.clone());
                                own.pieces(&columns, open.start, across)
                            };
                            own.open(across).into_iter().flat_map(pieces).collect()
                        },
                    );
                    found.extend(pieces.iter().map(|(strip, whole)| Candidate::new(view, sides, strip, *whole)));
                }
            }
        })
    }

    /// The key of all that strips between two lines are found from.
    fn key(&self, across: [f64; 2]) -> Key {
        let key = self.view.key(across, BESIDE.1).with(u64::from(self.racked));
        self.pitches.iter().copied().fold(key, Key::number)
    }

    /// The corridors into which others open side by side.
    fn before_mouths(&self, mouths: &[Vec<Range<usize>>], threads: usize, recall: &Recall) -> Vec<Candidate> {
        let view = self.view;
        self.sweep().find(1, threads, |near, low, found| {
            for high in low + 1..view.offsets.len() {
                let (across, sides) = ([view.offsets[low], view.offsets[high]], [low, high]);
                let width = across[1] - across[0];
                if width > self.parameters.labels_max_width {
                    break;
                }
                let led_to = |strip: &Strip| sides.iter().any(|&side| self.is_led_to(strip, side, &mouths[side]));
                let may_be = |columns: &Range<usize>| {
                    sides.iter().any(|&side| self.opening(&mouths[side], width, columns).count() >= LEAST_MOUTHS)
                };
                if width < self.parameters.labels_min_width || !may_be(&(0..view.size[0])) {
                    continue;
                }
                let key = || {
                    let mouths = sides.map(|side| &mouths[side]);
                    let key = self.key(across).with(mouths[0].len() as u64).with(mouths[1].len() as u64);
                    let ends = mouths.into_iter().flatten().flat_map(|mouth| [mouth.start, mouth.end]);
                    ends.fold(key, |key, end| key.with(end as u64))
                };
                let strips = recall.strips.or_find(key, || {
                    let own = self.seen_in(near.view());
                    let strips = |open: Range<usize>| {
                        let columns = own.columns(sides, open.clone());
                        own.strips(&columns, open.start, across)
                    };
                    let open = own.open(across).into_iter().filter(may_be);
                    open.flat_map(strips).filter(led_to).map(|strip| (strip, true)).collect()
                });
                found.extend(strips.iter().map(|(strip, whole)| Candidate::new(view, sides, strip, *whole)));
            }
        })
    }

    /// The mouths within some columns that may open into a strip so wide: beside wide aisles, what is narrow is in a row.
    fn opening<'m>(
        &self,
        mouths: &'m [Range<usize>],
        width: f64,
        columns: &Range<usize>,
    ) -> impl Iterator<Item = &'m Range<usize>> {
        let (cell, columns) = (self.view.cell, columns.clone());
        let within = move |mouth: &&Range<usize>| columns.start < mouth.end && mouth.start < columns.end;
        mouths.iter().filter(within).filter(move |mouth| width >= LED_TO * (mouth.len() as f64 * cell))
    }

    /// True when mouths of a side open into a strip side by side, with structure between them, and none is much wider.
    fn is_led_to(&self, strip: &Strip, side: usize, mouths: &[Range<usize>]) -> bool {
        let (from, to) = self.range(strip);
        let open: Vec<_> = mouths.iter().filter(|mouth| from < mouth.end && mouth.start < to).collect();
        let all_may = self.opening(mouths, strip.width(), &(from..to)).count() == open.len();
        let between: Vec<usize> = (from..to).filter(|c| !open.iter().any(|mouth| mouth.contains(c))).collect();
        let held = between.iter().filter(|&&c| self.sides[side].near.get(c)).count();
        open.len() >= LEAST_MOUTHS && all_may && held as f64 >= BETWEEN * between.len() as f64
    }

    /// The stretches of a strip that are not closed and are long enough for a corridor.
    fn open(&self, across: [f64; 2]) -> Vec<Range<usize>> {
        let (view, width) = (self.view, across[1] - across[0]);
        let margin = MARGIN.min(0.2 * width);
        let blocked = view.blocked_in(across[0] + margin, across[1] - margin);
        let closed = blocked.least(|share| share > IMPASSABLE);
        let least = (self.parameters.labels_min_aspect * width / view.cell) as usize;
        blocked.open(0..view.size[0], least.max(1), closed, &[])
    }

    /// Of rivals the best, and what they and those that are known leave of the others.
    fn best(&self, mut candidates: Vec<Candidate>, known: &[Strip]) -> Vec<Strip> {
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

    /// What some columns between two lines hold.
    fn columns(&self, [low, high]: [usize; 2], range: Range<usize>) -> Vec<Column> {
        let across = [self.view.offsets[low], self.view.offsets[high]];
        let width = across[1] - across[0];
        let inner = INNER.min(0.25 * width);
        let parts: Vec<&Side> = (low + 1..high)
            .filter(|&n| self.view.offsets[n] - across[0] > inner && across[1] - self.view.offsets[n] > inner)
            .map(|n| &self.sides[n])
            .collect();
        let sides = [&self.sides[low], &self.sides[high]];
        let margin = MARGIN.min(0.2 * width);
        let beyond = [[across[0] - BESIDE.1, across[0] - BESIDE.0], [across[1] + BESIDE.0, across[1] + BESIDE.1]];
        let view = self.view;
        let within = [across[0] + margin, across[1] - margin];
        let blocked = view.some_blocked(range.clone(), within[0], within[1]);
        let barred = view.barred_where(range.clone(), within[0], within[1], |barred| barred > BARRED);
        let beyond = beyond.map(|[low, high]| view.blocked_where(range.clone(), low, high, |share| share > BEYOND));
        let first = range.start;
        let holds = |n: usize, c: usize| sides[n].walls.get(c) || beyond[n][c - first];
        let barriers = barriers::among(view, across, range.clone());
        range
            .map(|c| Column {
                blocked: blocked[c - first],
                closed: blocked[c - first] > IMPASSABLE || barred[c - first] || barriers[c - first],
                parted: parts.iter().any(|part| part.faces.get(c)),
                walled: holds(0, c) && holds(1, c),
                near: sides.iter().any(|side| side.near.get(c)),
                faces: sides.map(|side| side.faces.get(c)),
                held: [0, 1].map(|n| beyond[n][c - first]),
            })
            .collect()
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
            let shared = strip.across[1].min(rival.across[1]) - strip.across[0].max(rival.across[0]);
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

    /// The corridors among a strip's columns, of which the first is given: the pieces in which what speaks for a
    /// corridor outweighs what speaks against it, each as long as that holds.
    fn strips(&self, columns: &[Column], first: usize, across: [f64; 2]) -> Vec<Strip> {
        let pieces = self.pieces(columns, first, across).into_iter();
        pieces.filter(|(_, is_corridor)| *is_corridor).map(|(strip, _)| strip).collect()
    }

    /// The same of all pieces that are long enough, and which of them are corridors.
    fn pieces(&self, columns: &[Column], first: usize, across: [f64; 2]) -> Vec<(Strip, bool)> {
        let scores: Vec<f64> = columns.iter().map(|c| c.score()).collect();
        let pieces = best_pieces(&scores).into_iter();
        let view = self.view;
        let width = across[1] - across[0];
        let strip = |(from, to): (usize, usize)| Strip {
            direction: view.direction,
            along: [view.along(first + from), view.along(first + to)],
            across,
            score: scores[from..to].iter().sum::<f64>() * view.cell,
            bays: self.is_like_bays(&columns[from..to], width),
            is_ragged: false,
            held: self.held(&columns[from..to]).map(|column| view.along(first + from + column)),
        };
        let long =
            |(from, to): &(usize, usize)| (to - from) as f64 * view.cell >= self.parameters.labels_min_aspect * width;
        let judged = |(from, to)| (strip((from, to)), self.is_corridor(&columns[from..to], width));
        pieces.filter(long).map(judged).collect()
    }

    /// The first column of a piece, and that after its last one, without what lies beyond gaps longer than a bay and is
    /// no more than a speck, or nothing: a wall at which a row ends that seems to go on as over a missing post.
    fn held(&self, columns: &[Column]) -> [usize; 2] {
        let cells = |metres: f64| (metres / self.view.cell) as usize;
        let near: Vec<bool> = columns.iter().map(|column| column.near).collect();
        let mut runs = &runs(&near, true)[..];
        let is_speck = |run: &(usize, usize)| run.1 - run.0 <= cells(BAY / 2.0);
        while let [first, next, ..] = runs
            && is_speck(first)
            && next.0 - first.1 > cells(BAY)
        {
            runs = &runs[1..];
        }
        while let [.., next, last] = runs
            && is_speck(last)
            && last.0 - next.1 > cells(BAY)
        {
            runs = &runs[..runs.len() - 1];
        }
        let count = columns.len();
        let from = runs.first().map_or(0, |first| first.0);
        let to = runs.last().map_or(count, |last| last.1);
        [if from > cells(BAY) { from } else { 0 }, if count - to > cells(BAY) { to } else { count }]
    }

    /// As wide as a bay, and walled no better than a row of empty ones.
    fn is_like_bays(&self, columns: &[Column], width: f64) -> bool {
        if !self.pitches.iter().any(|pitch| (BAY_WIDTH.0 * pitch..=BAY_WIDTH.1 * pitch).contains(&width)) {
            return false;
        }
        let all = columns.len() as f64;
        let Walled { near, once, twice, weaker } = Walled::new(columns);
        let length = all * self.view.cell;
        // Between frames that are closed on both sides and go on and on, it is a cross aisle as wide as a bay.
        let closed = near >= WALLED * all && twice >= WALLED * near;
        let long = length >= LONG * width && once >= FACED_ONCE * near && weaker >= WEAKER * near;
        // Nor does a wall go on along a row of bays past the ways between the rows.
        let wall = (0..2).any(|n| count(columns, |c| c.faces[n]) >= WALL * all) && weaker >= WEAKER_AT_WALL * all;
        !(length >= VERY_LONG * width || long || closed || wall)
    }

    /// Walled enough, and by more than posts.
    fn is_corridor(&self, columns: &[Column], width: f64) -> bool {
        let Walled { near, once, twice, .. } = Walled::new(columns);
        let length = columns.len() as f64 * self.view.cell;
        // Posts alone are a side where racks stand, and elsewhere pillars.
        let bare = (0..2).map(|n| count(columns, |c| c.walled && !c.faces[n] && !c.held[n])).fold(0.0, f64::max);
        if !self.racked && bare > BARE * columns.len() as f64 {
            return false;
        }
        let structured = if length >= LONG * width {
            once >= FACED_LONG * near
        } else {
            once >= FACED * near && (twice >= FACED_TWICE * near || once >= FACED_ONCE * near)
        };
        let walled = count(columns, |c| c.walled && c.blocked < NARROWED);
        structured && walled >= LEAST_WALLED * columns.len() as f64
    }
}
