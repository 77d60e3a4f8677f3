//! Which of the strips that lead across rows do so through their bays: the rows that a strip crosses say by what stands in
//! them, and by where else they are free.

use super::across::{crossing, leading_across};
use crate::bands::flat_map_each;
use crate::ends::{around, both, holds, overlap, shared, sorted, wider};
use crate::labels::Evidence;
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::connected;
use crate::labels::corridors::family;
use crate::labels::corridors::led;
use crate::labels::corridors::sided;
use crate::labels::corridors::{self, Strip};
use crate::labels::rows::sections::{self, Columns, Free, WIDTH};
use crate::labels::rows::{self, Row};
use crate::labels::view::look::Look;
use crate::labels::view::turned::Turned;
use crate::labels::ways::{walled, widths::Widths};
use std::collections::{BTreeMap, BTreeSet};
use std::iter;

/// What shares so much of a row's depth leads into it.
const ENTERS: f64 = 0.35;
/// A strip is a way through all the rows that it finds free when, by how seldom each of them is free elsewhere, fewer
/// such than this would be expected of all places; and one that is like bays only then.
const EXPECTED: (f64, f64) = (0.05, 0.005);
/// The same of one that is like bays and leads past the ends of all rows that it crosses, where most halls have a way.
const AT_ENDS: f64 = 0.03;
/// Past the ends of rows a way is held by these and by a wall, but for the mouths of aisles and passages, along so much of it.
const HELD: f64 = 0.65;
/// Where posts recur along the rows, and not across them too, what crosses them is no more than so many times as long as
/// the shorter of the two corridors beside a row: short ones between the goods of racks do not make bays of the aisles.
const LONGER: f64 = 4.0;
/// Bars seldom stand beside bays where they close no more than one in so many of these's ends.
const SELDOM: usize = 4;
/// Uprights leave so much of a strip that goes on between them.
const LEFT: f64 = 0.5;
/// A way through a row is no narrower than gates are, or than this share of the aisles beside it.
const NARROWER: f64 = family::LED_TO;
/// What posts leave of a strip is so much narrower, metres.
const NARROWED: f64 = 0.3;
/// What a row leaves open is as wide as a way where its ends are so near to its sides, metres.
const AS_WIDE: f64 = 0.35;
/// What goes on so far beyond the rows, metres, is a way there.
const BEYOND: f64 = 2.0;

/// The strips without what of them leads through bays.
pub fn without_bays(evidence: &Evidence, look: &Look, views: &[Turned], mut strips: Vec<Strip>) -> Vec<Strip> {
    let placed = placed(views, strips.iter().map(Strip::place));
    let deep: Vec<bool> = strips.iter().map(|strip| strip.bays && is_deep(views, strip, &strips, &placed)).collect();
    for (strip, is_deep) in strips.iter_mut().zip(deep) {
        strip.bays &= !is_deep;
    }
    let known = crossed(evidence, look, views, &strips, &[], &[]);
    let mut crossed = by_strip(&known, strips.len());
    let left: Vec<_> = strips.iter().zip(&crossed).map(|(strip, crossed)| left_between(strip, crossed)).collect();
    let is_narrower: Vec<bool> = left.iter().map(Option::is_some).collect();
    if is_narrower.contains(&true) {
        for (strip, left) in strips.iter_mut().zip(left) {
            strip.across = left.unwrap_or(strip.across);
        }
        let known = self::crossed(evidence, look, views, &strips, &known, &is_narrower);
        crossed = by_strip(&known, strips.len());
    }
    // What is long enough for a way by itself and crosses no row that is known is no bay of one.
    let is_alone = |strip: &Strip| {
        !strip.is_short()
            && (sided::is_sided(&views[strip.direction], strip) || led::is_before_wall(views, strip, &strips, &placed))
    };
    let past_ends: Vec<bool> = crossed.iter().map(|rows| !rows.is_empty() && lead_past_ends(rows)).collect();
    let left = |(strip, crossed): (&Strip, Vec<Crossed>)| {
        if crossed.is_empty() && is_alone(strip) { vec![strip.clone()] } else { ways(strip, crossed) }
    };
    let left: Vec<Vec<Strip>> = strips.iter().zip(crossed).map(left).collect();
    // What leads past rows' ends along a wall, as wide as what is told to lead past those of others, does so too.
    let told = (0..strips.len()).filter(|&n| past_ends[n] && !left[n].is_empty()).map(|n| &strips[n]);
    let told = Widths::of(views, told);
    let is_told = |n: usize| {
        let strip = &strips[n];
        let pitch = crossing(views, strip.direction).and_then(|view| view.pitch);
        past_ends[n]
            && walled::side(&views[strip.direction], strip).is_some()
            && told[strip.direction].have(strip.width(), pitch)
    };
    let or_told = |(n, left): (usize, Vec<Strip>)| {
        if left.is_empty() && is_told(n) { vec![strips[n].clone()] } else { left }
    };
    left.into_iter().enumerate().flat_map(or_told).collect()
}

/// True when a strip leads past the ends of all rows that it crosses, and may be a way there.
fn lead_past_ends(crossed: &[Crossed]) -> bool {
    crossed.iter().all(|row| row.at_end() && row.way)
}

/// True when a strip leads on between two sides for longer than a row is deep, without a way that crosses it: no bays do.
/// Of all it is known where they lie.
fn is_deep(views: &[Turned], strip: &Strip, strips: &[Strip], placed: &[Beside]) -> bool {
    let view = &views[strip.direction];
    let corners = view.rectangle(strip.along, strip.across);
    let mut pieces = vec![(strip.along[0], strip.along[1])];
    for other in views.iter().filter(|other| other.direction != strip.direction) {
        let [along, across] = [0, 1].map(|axis| around(corners.iter().map(|&corner| other.place(corner)[axis])));
        let crossing = placed[other.direction].touching(along, across).into_iter().map(|n| &strips[n]);
        for way in crossing.filter(|way| !way.bays) {
            if let Some([from, to]) = rows::crossed(view, other, way, way.along, strip.across) {
                pieces = rows::without(pieces, from, to);
            }
        }
    }
    let piece = |(from, to): (f64, f64)| Strip { along: [from, to], ..strip.clone() };
    pieces.into_iter().map(piece).any(|piece| piece.length() > rows::DEPTH.1 && sided::is_sided(view, &piece))
}

/// What uprights of the rows that a strip crosses leave of it, where they stand in it in most of them: a line along it was
/// no side of it, but that of what stands in other rows.
fn left_between(strip: &Strip, crossed: &[Crossed]) -> Option<[f64; 2]> {
    let within: Vec<_> = crossed.iter().filter(|row| !row.at_end()).collect();
    let open = within.iter().filter(|row| row.open).count();
    if within.len() < 2 || 2 * open >= within.len() {
        return None;
    }
    let common = within.iter().fold(vec![strip.across], |common, row| {
        let both = common.iter().flat_map(|&one| row.between.iter().map(move |&two| shared(one, two)));
        both.filter(is_wide).collect()
    });
    let width = |ends: &[f64; 2]| ends[1] - ends[0];
    let left = common.into_iter().max_by(|a, b| width(a).total_cmp(&width(b)))?;
    (width(&left) >= LEFT * strip.width()).then_some(left)
}

/// True when a way may lead through.
fn is_wide(ends: &[f64; 2]) -> bool {
    ends[1] - ends[0] >= WIDTH.0
}

/// A row between two of the strips, and which of them lead across it.
struct Across {
    row: Row,
    strips: Vec<(usize, Crossed)>,
}

/// The rows that each strip crosses, in their order.
fn by_strip(rows: &[Across], strips: usize) -> Vec<Vec<Crossed>> {
    let mut crossed: Vec<Vec<Crossed>> = vec![Vec::new(); strips];
    for (n, row) in rows.iter().flat_map(|row| &row.strips) {
        crossed[*n].push(row.clone());
    }
    crossed
}

/// The rows that strips cross. Those that are known from before some strips became narrower are as they were where none of
/// these has to do with them.
fn crossed(
    evidence: &Evidence,
    look: &Look,
    views: &[Turned],
    strips: &[Strip],
    known: &[Across],
    is_narrower: &[bool],
) -> Vec<Across> {
    let mut crossed = Vec::new();
    let place = |row: &Row| (row.between, row.along[0].to_bits());
    let known: BTreeMap<_, &Across> = known.iter().map(|across| (place(&across.row), across)).collect();
    // Where a direction does not tell its own bays, they are as those of the others.
    let common = views.iter().find_map(|view| view.pitch);
    let placed = placed(views, strips.iter().map(Strip::place));
    let widest = corridors::widest(strips);
    for view in views {
        let Some(other) = crossing(views, view.direction) else { continue };
        // The rows as they were if nothing led across them.
        let is_aisle = |n: &usize| {
            strips[*n].direction == view.direction && !strips[*n].bays && !rows::is_within_row(strips, &placed, *n)
        };
        let numbers: Vec<usize> = (0..strips.len()).filter(is_aisle).collect();
        let aisles: Vec<Strip> = numbers.iter().map(|&n| strips[n].clone()).collect();
        let extents: Vec<[f64; 2]> = aisles.iter().map(|strip| strip.along).collect();
        let mut rows = rows::between(views, &aisles, &extents);
        for row in &mut rows {
            row.between = row.between.map(|pair| pair.map(|n| numbers[n]));
        }
        let crossing = |row: &Row| -> Vec<(usize, Crossed)> {
            let Some(between) = row.between else { return Vec::new() };
            let near = leading_across([view, other], &placed, row, widest);
            let is_as_before = |before: &&&Across| {
                let of_before = before.strips.iter().map(|(n, _)| n);
                before.row == *row && !near.iter().chain(of_before).chain(&between).any(|&n| is_narrower[n])
            };
            if let Some(before) = known.get(&place(row)).filter(is_as_before) {
                return before.strips.clone();
            }
            let aisles = between.map(|n| &strips[n]);
            // Then the rows might as well be what lies between two ways across the rows.
            let shorter = between.map(|n| length_of(strips, &placed, n)).into_iter().fold(f64::INFINITY, f64::min);
            let times = if view.pitch.is_some() && other.pitch.is_none() { LONGER } else { 1.0 };
            let judged = near.into_iter().filter(|&n| strips[n].length() < times * shorter);
            // Where no bays are known, what is wider is no bay.
            let pitch = if view.pitch.is_some() { view.pitch_of(row) } else { common };
            let is_narrow = |n: usize| is_narrow(strips, &placed, n, aisles);
            let judged: Vec<usize> = judged.filter(|&n| pitch.is_some() || is_narrow(n)).collect();
            if judged.is_empty() {
                return Vec::new();
            }
            let columns = Columns::new(look, &evidence.grid.frame, [view, other], row, pitch);
            let least = sections::least_width(aisles.into_iter().map(Strip::width));
            let (ways, open) = (columns.ways(least), columns.open());
            let cross = |n: usize| {
                let found = cross([view, other], row, (&columns, &ways, &open), &strips[n], aisles)?;
                Some(if is_narrow(n) { found.closed() } else { found })
            };
            judged.into_iter().filter_map(|n| cross(n).map(|crossed| (n, crossed))).collect()
        };
        let found = flat_map_each(rows.len(), evidence.threads, |n| [crossing(&rows[n])]);
        crossed.extend(rows.into_iter().zip(found).map(|(row, strips)| Across { row, strips }));
    }
    crossed
}

/// How long a way is with those that lead on as it, metres; `placed` says where all of them lie.
fn length_of(strips: &[Strip], placed: &[Beside], way: usize) -> f64 {
    let (mut whole, mut known, mut next) = (strips[way].along, BTreeSet::from([way]), vec![way]);
    while let Some(n) = next.pop() {
        let own = &strips[n];
        whole = both(whole, own.along);
        let near = placed[own.direction].touching(wider(own.along, rows::SAME), own.across);
        next.extend(near.into_iter().filter(|&m| leads_on_as(own, &strips[m]) && known.insert(m)));
    }
    whole[1] - whole[0]
}

/// True when of two ways of a direction one begins where the other ends, in line. Their widths may differ, since each is as
/// wide as what was seen of its sides.
fn leads_on_as(one: &Strip, other: &Strip) -> bool {
    let is_at_end = |side: usize| (one.along[side] - other.along[1 - side]).abs() <= rows::SAME;
    (is_at_end(0) || is_at_end(1)) && overlap(one.across, other.across) > one.width().min(other.width()) / 2.0
}

/// True when a strip is too narrow for a way through a row between two aisles, and none of several alike side by side: a
/// pallet's place is empty there. Of all it is known where they lie.
fn is_narrow(strips: &[Strip], placed: &[Beside], n: usize, aisles: [&Strip; 2]) -> bool {
    let least = aisles.map(|aisle| NARROWER * aisle.width()).into_iter().fold(WIDTH.0, f64::min);
    strips[n].width() < least && !connected::is_one_of_many(strips, placed, n)
}

/// What a strip passes of a row: what lies between its ends, an end, or the end of one of which nothing lies in the strip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Passes {
    Within,
    End,
    Before,
}

/// What of a row tells whether there is a way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sign {
    Nothing,
    /// What is free about the strip's middle is no wider than a bay, and narrower than the strip.
    Bay,
    /// The row ends before the strip at a bar, and so many of the ends of what else is free in it are closed.
    Bar {
        closed: usize,
        ends: usize,
    },
}

/// A row that a strip leads across: in the strip's own places, and whether there is a way.
#[derive(Clone, Debug)]
struct Crossed {
    /// From the middle of the one corridor along the row to that of the other.
    along: [f64; 2],
    /// From that corridor's far side to the other's.
    outer: [f64; 2],
    /// There is a way of its own.
    way: bool,
    /// There may be one, if the strip is one elsewhere.
    open: bool,
    passes: Passes,
    /// Where nothing stands in the row between the strip's sides: where else it is so.
    free: Option<Free>,
    /// From where to where nothing stands in the row within the strip, across.
    between: Vec<[f64; 2]>,
    sign: Sign,
}

impl Crossed {
    fn at_end(&self) -> bool {
        self.passes != Passes::Within
    }

    /// Of a strip that is too narrow for a way: past the row's end one may lead still.
    fn closed(self) -> Self {
        if self.at_end() { self } else { Self { way: false, open: false, free: None, ..self } }
    }
}

/// What a strip finds where it crosses a row; nothing where it ends before.
fn cross(
    [view, other]: [&Turned; 2],
    row: &Row,
    (columns, ways, open): (&Columns, &[[f64; 2]], &[[f64; 2]]),
    strip: &Strip,
    between: [&Strip; 2],
) -> Option<Crossed> {
    let sin = libm::sin(other.angle - view.angle);
    let middle = f64::midpoint(row.across[0], row.across[1]);
    // The strip's middle where the row's is, and places of the row's direction along the strip.
    let [s, u] = view.crossing(other, middle, strip.middle());
    let along = |v: f64| s + (v - middle) / sin;
    let own = sorted(row.across.map(along));
    let reach = strip.width() / 2.0 / sin.abs();
    if overlap(own, strip.along) < ENTERS * (own[1] - own[0]) || u - reach >= row.along[1] || u + reach <= row.along[0]
    {
        return None;
    }
    let sides = [u - reach, u + reach];
    let leads_through = columns.lets_through(sides);
    let at_end = sides[0] <= row.along[0] + view.cell || sides[1] >= row.along[1] - view.cell;
    let passes = match at_end {
        true if columns.reaches(sides) => Passes::End,
        true => Passes::Before,
        false => Passes::Within,
    };
    let along_of = |places: [f64; 2]| sorted(places.map(along));
    let outer = along_of([between[0].across[0], between[1].across[1]]);
    // What is long enough for a way by itself before the row, or behind it, and finds it open as wide as it is goes on there.
    let goes_on = || {
        let is_long = |along: [f64; 2]| {
            !corridors::is_short(along[1] - along[0], strip.width())
                && sided::is_sided(other, &Strip { along, ..strip.clone() })
        };
        let is_as_wide = |gap: [f64; 2]| [0, 1].into_iter().all(|side| (gap[side] - sides[side]).abs() <= AS_WIDE);
        (is_long([strip.along[0], outer[0]]) || is_long([outer[1], strip.along[1]]))
            && columns.gap_about(u).is_some_and(is_as_wide)
    };
    let way =
        if at_end { columns.may_end_at(sides) } else { ways.iter().any(|way| way[0] < u && u < way[1]) || goes_on() };
    let free = columns.is_free(sides).then(|| columns.free_elsewhere(sides));
    let across = |u: f64| other.place(view.to_map([u, middle]))[1];
    let is_narrower = |ends: &[f64; 2]| ends[1] - ends[0] <= sides[1] - sides[0] - NARROWED;
    let bar = || {
        let closed = columns.closed_elsewhere(sides);
        Sign::Bar { closed: closed.iter().filter(|closed| **closed).count(), ends: closed.len() }
    };
    let is_closed = || strip.bays && way && columns.is_closed_at(row.inner(sides));
    let leaves_a_bay = |ends: &[f64; 2]| holds(*ends, u) && columns.is_as_a_bay(*ends) && is_narrower(ends);
    let sign = match at_end {
        true if is_closed() => bar(),
        false if open.iter().any(leaves_a_bay) => Sign::Bay,
        _ => Sign::Nothing,
    };
    Some(Crossed {
        along: along_of(between.map(Strip::middle)),
        outer,
        way,
        open: way || leads_through,
        passes,
        free,
        between: open.iter().map(|&ends| shared(sorted(ends.map(across)), strip.across)).filter(is_wide).collect(),
        sign,
    })
}

/// A strip's pieces between the rows that it has no way through.
fn ways(strip: &Strip, mut crossed: Vec<Crossed>) -> Vec<Strip> {
    let expected = by_chance(&crossed);
    let are_ends = lead_past_ends(&crossed);
    let least = if are_ends { AT_ENDS } else { EXPECTED.1 };
    let is_told = || are_ends && is_long_before(strip, &crossed) || are_barred(&crossed);
    if strip.bays && expected >= least && !is_told() {
        return Vec::new();
    }
    if expected >= EXPECTED.1 && lies_over_bays(&crossed) {
        for row in crossed.iter_mut().filter(|row| !row.at_end()) {
            *row = row.clone().closed();
        }
    }
    for row in crossed.iter_mut().filter(|row| expected < EXPECTED.0 && row.free.is_some()) {
        (row.way, row.open) = (true, true);
    }
    if crossed.iter().any(|c| c.at_end() && c.way) {
        crossed.retain(|c| !c.at_end());
    }
    if crossed.is_empty() {
        return vec![strip.clone()];
    }
    crossed.sort_by(|a, b| a.along[0].total_cmp(&b.along[0]));
    let is_way = crossed.iter().any(|c| c.way);
    let is_open = |c: &Crossed| is_way && c.open;
    let open = crossed.iter().position(is_open).zip(crossed.iter().rposition(is_open));
    // What goes on to the next row that it crosses, or to its own end, may lead through what is no row.
    let through = open.map(|(first, last)| {
        let from = first.checked_sub(1).map_or(strip.along[0], |before| crossed[before].along[1]);
        [from, crossed.get(last + 1).map_or(strip.along[1], |after| after.along[0])]
    });
    let starts = iter::once(strip.along[0]).chain(crossed.iter().map(|c| c.outer[1]));
    let ends = crossed.iter().map(|c| c.outer[0]).chain(iter::once(strip.along[1]));
    let is_beyond = |&[from, to]: &[f64; 2]| {
        to - from >= BEYOND && through.is_none_or(|through| overlap(through, [from, to]) <= 0.0)
    };
    let beyond = starts.zip(ends).map(|(from, to)| [from, to]).filter(is_beyond);
    through.into_iter().chain(beyond).map(|along| Strip { along, ..strip.clone() }).collect()
}

/// True when posts stand within a strip's sides and leave no more of it than a bay in each of several rows that are open there,
/// as where goods that stand back from their posts have lines. One row alone does not tell a gap between frames from a bay.
fn lies_over_bays(crossed: &[Crossed]) -> bool {
    let open: Vec<_> = crossed.iter().filter(|row| !row.at_end() && row.open).collect();
    open.len() > 1 && open.iter().all(|row| row.sign == Sign::Bay)
}

/// True when a strip past the ends of rows is long enough for a way by itself without what leads through those that reach into
/// it: before the others nothing of them lies in it that could be bays.
fn is_long_before(strip: &Strip, crossed: &[Crossed]) -> bool {
    let (before, reaching): (Vec<_>, Vec<_>) = crossed.iter().partition(|row| row.passes == Passes::Before);
    let through: f64 = reaching.iter().map(|row| row.along[1] - row.along[0]).sum();
    !before.is_empty()
        && !corridors::is_short(strip.length() - through, strip.width())
        && strip.score >= HELD * strip.length()
}

/// True when several rows end at bars before a strip, no other reaches into it, and seldom stands one beside a bay.
fn are_barred(crossed: &[Crossed]) -> bool {
    let before: Vec<_> = crossed.iter().filter(|row| row.at_end()).collect();
    let bars = before
        .iter()
        .filter_map(|row| if let Sign::Bar { closed, ends } = row.sign { Some([closed, ends]) } else { None });
    let bars: Vec<[usize; 2]> = bars.collect();
    let [closed, ends] = [0, 1].map(|n| bars.iter().map(|bar| bar[n]).sum::<usize>());
    before.len() > 1 && bars.len() == before.len() && SELDOM * closed <= ends
}

/// How many places would be expected at which as many rows are free by chance (as of alignments, Desolneux, Moisan and
/// Morel 2000).
fn by_chance(crossed: &[Crossed]) -> f64 {
    let rows = || crossed.iter().filter_map(|row| row.free.map(|free| (row.at_end(), free)));
    if rows().count() < 2 {
        return f64::INFINITY;
    }
    // Rows of a place are filled alike: as if of all their places one more were free and one were not.
    let sum = |of: fn(Free) -> f64| rows().map(|(_, free)| of(free)).sum::<f64>();
    let common = (sum(|free| free.free) + 1.0) / (sum(|free| free.places) + 2.0);
    let chance: f64 = rows().map(|(_, row)| common.max(row.free / row.places.max(1.0))).product();
    // A row has many places, but two ends.
    chance * rows().map(|(at_end, row)| if at_end { 2.0 } else { row.places }).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::corridors::UNTOLD;

    /// A row between two aisles of 3 m, from one's middle to the other's.
    fn row(along: [f64; 2], is_open: bool) -> Crossed {
        let outer = [along[0] - 1.5, along[1] + 1.5];
        Crossed {
            along,
            outer,
            way: is_open,
            open: is_open,
            passes: Passes::Within,
            free: None,
            between: Vec::new(),
            sign: Sign::Nothing,
        }
    }

    /// From 0 to 40 m.
    fn strip() -> Strip {
        Strip {
            direction: 0,
            along: [0.0, 40.0],
            across: [0.0, 3.0],
            score: 0.0,
            bays: false,
            is_ragged: false,
            stops: [false; 2],
            held: UNTOLD,
            found: UNTOLD,
        }
    }

    /// The pieces of a strip that crosses rows.
    fn pieces(rows: &[Crossed]) -> Vec<[f64; 2]> {
        ways(&strip(), rows.to_vec()).into_iter().map(|piece| piece.along).collect()
    }

    #[test]
    fn what_is_as_bays_may_lead_past_two_rows_that_are_seldom_free() {
        let is_way = |passes: Passes, free: f64| {
            let free = Some(Free { free, places: 20.0 });
            let crossed = [[1.5, 6.5], [6.5, 11.5]].map(|along| Crossed { passes, free, ..row(along, true) });
            !ways(&Strip { bays: true, ..strip() }, crossed.to_vec()).is_empty()
        };
        assert!(is_way(Passes::End, 1.0) && !is_way(Passes::Within, 1.0));
        assert!(!is_way(Passes::End, 4.0));
    }

    #[test]
    fn what_is_as_bays_is_a_way_where_it_is_held_and_rows_end_before_it() {
        let is_way = |score: f64, passes: Passes| {
            let one = Crossed { passes: Passes::End, ..row([1.5, 6.5], true) };
            let two = Crossed { passes, ..row([6.5, 39.0], true) };
            !ways(&Strip { bays: true, score, ..strip() }, vec![one, two]).is_empty()
        };
        // Through a passage in the wall one does not lie at a side.
        assert!(is_way(40.0, Passes::Before) && is_way(29.0, Passes::Before));
        assert!(!is_way(20.0, Passes::Before) && !is_way(40.0, Passes::End));
    }

    #[test]
    fn what_is_as_bays_is_a_way_where_several_rows_end_before_it_at_bars() {
        let is_way = |signs: [Sign; 2]| {
            let [one, two] = [([1.5, 6.5], signs[0]), ([6.5, 11.5], signs[1])].map(|(along, sign)| Crossed {
                passes: Passes::End,
                sign,
                ..row(along, true)
            });
            !ways(&Strip { bays: true, ..strip() }, vec![one, two, row([11.5, 16.5], false)]).is_empty()
        };
        let [alone, seldom, often] = [0, 1, 2].map(|closed| Sign::Bar { closed, ends: 4 * closed.min(1) });
        assert!(is_way([alone; 2]) && is_way([alone, seldom]));
        assert!(!is_way([alone, often]) && !is_way([alone, Sign::Nothing]) && !is_way([Sign::Nothing; 2]));
    }

    #[test]
    fn what_posts_leave_no_more_of_than_a_bay_is_none_though_its_sides_are_wider_apart() {
        let bay = |along| Crossed { sign: Sign::Bay, ..row(along, true) };
        assert_eq!(pieces(&[bay([1.5, 20.0]), bay([20.0, 38.5])]), [] as [[f64; 2]; 0]);
        // What is wider than bays in one row is a way there, and through others.
        assert_eq!(pieces(&[bay([1.5, 20.0]), row([20.0, 38.5], true)]), [[0.0, 40.0]]);
        assert_eq!(pieces(&[bay([1.5, 38.5])]), [[0.0, 40.0]]);
    }

    #[test]
    fn an_aisle_leads_on_as_the_passage_in_line_that_begins_where_it_ends() {
        let on = |along: [f64; 2], across: [f64; 2]| leads_on_as(&strip(), &Strip { along, across, ..strip() });
        assert!(on([40.0, 55.0], [-0.5, 3.5]) && on([-20.0, 0.2], [0.4, 2.8]));
        assert!(!on([42.0, 55.0], [0.0, 3.0]) && !on([40.0, 55.0], [2.0, 5.0]) && !on([0.0, 40.0], [0.0, 3.0]));
    }

    #[test]
    fn what_leads_through_the_rows_of_one_hall_leads_on_to_those_of_the_next() {
        let [one, two] = [row([1.5, 6.5], true), row([6.5, 11.5], true)];
        // The next row is of another hall, behind what is no row.
        assert_eq!(pieces(&[one.clone(), two.clone(), row([20.0, 25.0], false)]), [[0.0, 20.0], [26.5, 40.0]]);
        // It lies behind the aisle where these end.
        assert_eq!(pieces(&[one, two, row([11.5, 16.5], false)]), [[0.0, 11.5], [18.0, 40.0]]);
    }

    #[test]
    fn what_leads_between_two_halls_is_none_through_their_rows() {
        let [one, two] = [row([1.5, 6.5], false), row([25.0, 30.0], false)];
        assert_eq!(pieces(&[one, two]), [[8.0, 23.5], [31.5, 40.0]]);
        assert_eq!(pieces(&[]), [[0.0, 40.0]]);
    }
}
