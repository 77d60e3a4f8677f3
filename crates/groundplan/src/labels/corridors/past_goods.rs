//! Aisles that goods on the floor narrow: racks go on along both sides, and past the goods one comes to the next way.

use super::barriers;
use super::columns::BAY;
use super::joined;
use super::pieces::BESIDE;
use super::stretches::beyond;
use crate::bits::Bits;
use crate::ends::{around, holds, overlap, sorted, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::{ASKEW, Strip, UNTOLD};
use crate::labels::junctions::shut;
use crate::labels::rows::{Row, SAME};
use crate::labels::view::turned::Turned;
use std::collections::BTreeSet;
use std::ops::Range;

/// It leads on for so many widths at least, and where less than this share of its own sides is held, which are those of the
/// rows that it crosses, for so long, metres: less is a bay of the next one.
const LONG: f64 = 1.0;
const RACKED: f64 = 0.7;
const CROSSING: f64 = 4.0;
/// Where more than this share of what lies just beyond a side is not free, something stands along it.
const BEYOND: f64 = 0.8;
/// Goods narrow it where so much of a column is not free.
const GOODS: f64 = 0.1;
/// A pile of them leaves less than half of it free for so far along, metres, and over so much of that: what is thinner may be a wall,
/// as what is askew to it, and what is longer no goods. Past it there is a lane that is so wide, metres, and free but for this share.
const HALF: f64 = 0.4;
const PILE: [f64; 2] = [0.8, 4.0];
const ALONG: f64 = 0.6;
const LANE: (f64, f64) = (0.3, 0.02);
/// A way leads past such goods to the next way where it ends so near to them, metres, or to another piece of it, no farther off than so
/// many times as it is wide; they have one side in line, and the narrower one is so many times as wide as the other.
const NEAR: f64 = 1.0;
const APART: f64 = 3.0;
const ALIKE: f64 = 0.6;
/// It is led on no farther than this, metres.
const FARTHEST: f64 = 60.0;
/// So near to where racks end beside it, metres, lies the way that it leads to, over floor that is free but for this share.
const MOUTH: f64 = 6.0;
const CLUTTER: f64 = 0.1;

/// The strips, each as far on as racks stand along both its sides and one gets past what stands between, up to another way;
/// pieces that come to meet are one, no narrower than the least that a corridor is.
pub fn led_on(views: &[Turned], strips: Vec<Strip>, least: f64) -> Vec<Strip> {
    longer(views, strips, least, None)
}

/// Of aisles, where these are given, each past goods at its end alone.
fn longer(views: &[Turned], mut strips: Vec<Strip>, least: f64, aisles: Option<&BTreeSet<usize>>) -> Vec<Strip> {
    let mut placed = placed(views, strips.iter().map(Strip::place));
    let mut is_longer = false;
    for n in (0..strips.len()).filter(|&n| !strips[n].bays && !strips[n].is_short()).collect::<Vec<_>>() {
        for side in [0, 1] {
            let ahead = Ahead { views, strips: &strips, placed: &placed, n, side };
            let end = match aisles {
                None => ahead.end(),
                Some(aisles) => aisles.get(&n).and_then(|_| ahead.past_goods_at_end()),
            };
            let Some(end) = end else { continue };
            (strips[n].along[side], strips[n].held[side]) = (end, UNTOLD[side]);
            placed[strips[n].direction].add(n, strips[n].along, strips[n].across);
            is_longer = true;
        }
    }
    if is_longer { joined::join(views, strips, least) } else { strips }
}

/// Columns over which half of a strip is not free: goods, past which one gets, or not; and whether it is closed in one of them.
struct Narrow {
    on: Range<usize>,
    is_pile: bool,
    closes: bool,
}

/// The strips, each that runs along a row past a pile of goods at its end to what lies beyond; nothing where none is longer. What
/// narrows a way across rows may be what is left of the next one.
pub fn past_piles(views: &[Turned], strips: &[Strip], rows: &[Row], least: f64) -> Option<Vec<Strip>> {
    let aisles: BTreeSet<usize> = rows.iter().filter_map(|row| row.between).flatten().collect();
    let longer = longer(views, strips.to_vec(), least, Some(&aisles));
    (longer != strips).then_some(longer)
}

/// What lies beyond one end of a strip.
struct Ahead<'a> {
    views: &'a [Turned],
    strips: &'a [Strip],
    /// Where all of these lie.
    placed: &'a [Beside],
    n: usize,
    side: usize,
}

impl Ahead<'_> {
    fn strip(&self) -> &Strip {
        &self.strips[self.n]
    }

    fn view(&self) -> &Turned {
        &self.views[self.strip().direction]
    }

    /// Up to where it leads on.
    fn end(&self) -> Option<f64> {
        let (strip, view) = (self.strip(), self.view());
        // What closes a way across rows may be what is left of the next row.
        let columns = self.open(false);
        let own = view.columns(strip.along);
        let is_racked = self.racked(&own).count(0..own.len()) as f64 >= RACKED * own.len() as f64;
        let least = if is_racked { LONG * strip.width() } else { CROSSING.max(LONG * strip.width()) };
        let mut ends = self.racked_up_to(&columns, (least / view.cell) as usize).into_iter().rev();
        ends.find_map(|count| {
            let on =
                if self.side == 0 { columns.end - count..columns.end } else { columns.start..columns.start + count };
            let end = view.along(if self.side == 0 { on.start } else { on.end });
            if self.gets_past_goods(&on, false) { self.next_way(end) } else { None }
        })
    }

    /// Where beyond goods at its end it leads on.
    fn past_goods_at_end(&self) -> Option<f64> {
        let columns = self.open(true);
        self.other_piece(&columns).or_else(|| self.past_pile(&columns))
    }

    /// Where another piece of it begins beyond goods, over some columns, be racks beside these empty.
    fn other_piece(&self, columns: &Range<usize>) -> Option<f64> {
        let (strip, view) = (self.strip(), self.view());
        let end = view.along(if self.side == 0 { columns.start } else { columns.end });
        let begins = |other: &Strip| (other.along[1 - self.side] - end).abs() <= view.cell;
        let is_in_line = |other: &Strip| {
            let widths = [strip.width(), other.width()];
            (0..2).any(|side| (strip.across[side] - other.across[side]).abs() <= SAME)
                && widths[0].min(widths[1]) >= ALIKE * widths[0].max(widths[1])
        };
        let is_piece = |other: &Strip| begins(other) && is_in_line(other) && !other.bays && !other.is_short();
        let there = self.placed[strip.direction].touching(wider([end; 2], view.cell), strip.across);
        let is_near = columns.len() as f64 * view.cell <= APART * strip.width();
        let is_there = is_near && there.into_iter().any(|m| m != self.n && is_piece(&self.strips[m]));
        (is_there && self.gets_past_goods(columns, true)).then_some(end)
    }

    /// Where the next way begins beyond goods that narrow it where it ends.
    fn past_pile(&self, columns: &Range<usize>) -> Option<f64> {
        let view = self.view();
        let mut piles = self.narrows(columns).into_iter().filter(|narrow| narrow.is_pile).map(|narrow| narrow.on);
        let pile = if self.side == 0 { piles.next_back() } else { piles.next() }?;
        let (on, off) = if self.side == 0 {
            (pile.start..columns.end, columns.end - pile.end)
        } else {
            (columns.start..pile.end, pile.start - columns.start)
        };
        let end = view.along(if self.side == 0 { on.start } else { on.end });
        // It ends before the goods, and not at a way: what narrows it beyond one may be the next row.
        let inwards = self.strip().along[self.side] - shut::sign(self.side) * NEAR;
        let before = sorted([inwards, view.along(if self.side == 0 { pile.end } else { pile.start })]);
        let is_there = off as f64 * view.cell <= NEAR
            && self.ways_across(before, 0.0).is_empty()
            && self.gets_past_goods(&on, true);
        if is_there { self.next_way(end) } else { None }
    }

    /// So many columns beyond its end, along at least so many of which racks stand, with no gap in these that is longer than a
    /// bay, but for ways that cross it: before each of those, and in all.
    fn racked_up_to(&self, columns: &Range<usize>, least: usize) -> Vec<usize> {
        let (racked, crossed) = (self.racked(columns), self.crossed(columns));
        let gap = (BAY / self.view().cell) as usize;
        let (mut counts, mut count, mut held, mut bare) = (Vec::new(), 0, 0, 0);
        for n in 0..columns.len() {
            let outwards = if self.side == 0 { columns.len() - 1 - n } else { n };
            if racked.get(outwards) {
                (count, held, bare) = (n + 1, held + 1, 0);
            } else if crossed.get(outwards) {
                bare = 0;
                counts.extend((held >= least).then_some(count));
            } else if bare < gap {
                bare += 1;
            } else {
                break;
            }
        }
        counts.extend((held >= least).then_some(count));
        counts.dedup();
        counts
    }

    /// True when goods narrow it in some columns, and one gets past them.
    fn gets_past_goods(&self, on: &Range<usize>, past_piles: bool) -> bool {
        let (strip, view) = (self.strip(), self.view());
        let [low, high] = wider(strip.across, -SAME);
        if !view.blocked_where(on.clone(), low, high, |share| share > GOODS).any() {
            return false;
        }
        // One gets past what leaves a lane.
        let narrows = if past_piles { self.narrows(on) } else { Vec::new() };
        let piles: Vec<Range<usize>> =
            narrows.into_iter().filter(|narrow| narrow.is_pile).map(|narrow| narrow.on).collect();
        let is_beside = |at: usize| !piles.iter().any(|pile| (pile.start..=pile.end).contains(&at));
        // A face of racks may be in line with one of goods.
        let walls = || barriers::beyond_a_side(view, strip.across, beyond(strip.across), on.clone());
        !barriers::stops(view, strip.across, on.clone()).into_iter().any(is_beside)
            && !walls().runs(0..on.len(), true).any(|wall| is_beside(on.start + wall.start))
            && !barriers::doors(view, beyond(strip.across), on.clone()).any()
    }

    /// Over which of some columns half of it is not free.
    fn narrows(&self, columns: &Range<usize>) -> Vec<Narrow> {
        let (strip, view) = (self.strip(), self.view());
        let [low, high] = shut::inner(strip);
        let closed = view.some_closed(columns.clone(), low, high);
        let [narrowed, half] = [GOODS, HALF].map(|least| {
            let mut taken = view.blocked_where(columns.clone(), low, high, |share| share > least);
            taken |= &closed;
            taken
        });
        let lanes = ((strip.width() - LANE.0) / view.cell).max(0.0) as usize;
        let narrow = |run: Range<usize>| {
            let at = |n: usize| columns.start + n;
            let most = half
                .runs(run.clone(), true)
                .fold(run.end..run.start, |most, half| most.start.min(half.start)..most.end.max(half.end));
            let on = at(most.start)..at(most.end);
            let is_free = |n: usize| {
                let low = strip.across[0] + n as f64 * view.cell;
                view.mean_blocked(on.clone(), low, low + LANE.0) <= LANE.1
            };
            let is_pile = holds(PILE, on.len() as f64 * view.cell)
                && (0..=lanes).any(is_free)
                && half.count(most.clone()) as f64 >= ALONG * most.len() as f64;
            Narrow { on: at(run.start)..at(run.end), is_pile, closes: closed.count(run) > 0 }
        };
        narrowed.runs(0..columns.len(), true).filter(|run| half.count(run.clone()) > 0).map(narrow).collect()
    }

    /// In which of some columns ways of other directions cross it.
    fn crossed(&self, columns: &Range<usize>) -> Bits {
        let view = self.view();
        let mut crossed = Bits::new(columns.len());
        let along = [view.along(columns.start), view.along(columns.end)];
        for [from, to] in self.ways_across(along, 0.0) {
            let [from, to] = [from, to].map(|u| view.border(u).clamp(columns.start, columns.end) - columns.start);
            crossed.fill(from..to);
        }
        crossed
    }

    /// From where to where, along, ways of other directions lead over it, or would if they were so much longer, metres.
    fn ways_across(&self, along: [f64; 2], longer: f64) -> Vec<[f64; 2]> {
        let (strip, view) = (self.strip(), self.view());
        let corners = view.rectangle(along, strip.across);
        let mut found = Vec::new();
        for other in self.views.iter().filter(|other| other.sine(view) > ASKEW) {
            let [s, t] = [0, 1].map(|axis| around(corners.iter().map(|&corner| other.place(corner)[axis])));
            let near = self.placed[other.direction].touching(wider(s, longer), t);
            for way in near.into_iter().map(|m| &self.strips[m]) {
                let [s, u] = view.crossing(other, strip.middle(), way.middle());
                let over = wider([u; 2], way.width() / 2.0 / other.sine(view));
                if holds(wider(way.along, longer), s) && overlap(over, along) > 0.0 {
                    found.push(over);
                }
            }
        }
        found
    }

    /// The columns beyond its end up to where it is closed, be it by goods that one gets past or not, or another strip of its direction
    /// lies there.
    fn open(&self, past_piles: bool) -> Range<usize> {
        let (strip, view) = (self.strip(), self.view());
        let end = strip.along[self.side];
        let mut beyond = sorted([end, end + shut::sign(self.side) * FARTHEST]);
        for m in self.placed[strip.direction].touching(beyond, strip.across) {
            let other = &self.strips[m];
            // What goods leave of it is no other.
            let is_lane = past_piles && other.width() < ALIKE * strip.width() && other.is_short();
            let is_there = overlap(other.across, strip.across) > 0.0 && overlap(other.along, beyond) > 0.0;
            if m != self.n && is_there && !is_lane {
                let begins = other.along[1 - self.side];
                beyond[self.side] = if self.side == 0 { begins.min(end) } else { begins.max(end) };
            }
        }
        let [from, to] = beyond.map(|u| view.border(u).min(view.size[0]));
        if past_piles {
            let narrows = self.narrows(&(from..to)).into_iter();
            let mut walls = narrows.filter(|narrow| narrow.closes && !narrow.is_pile).map(|narrow| narrow.on);
            return if self.side == 0 {
                walls.next_back().map_or(from, |wall| wall.end)..to
            } else {
                from..walls.next().map_or(to, |wall| wall.start)
            };
        }
        let [low, high] = shut::inner(strip);
        let is_closed = |c: &usize| view.is_closed(*c, low, high);
        if self.side == 0 {
            (from..to).rev().find(is_closed).map_or(from, |c| c + 1)..to
        } else {
            from..(from..to).find(is_closed).unwrap_or(to)
        }
    }

    /// At which of some columns something stands along both sides.
    fn racked(&self, columns: &Range<usize>) -> Bits {
        let (strip, view) = (self.strip(), self.view());
        let [low, high] = strip.across;
        let beyond = [[low - BESIDE.1, low - BESIDE.0], [high + BESIDE.0, high + BESIDE.1]];
        let [one, two] = [0, 1].map(|side| {
            let [from, to] = wider([strip.across[side]; 2], SAME);
            let mut held =
                view.blocked_where(columns.clone(), beyond[side][0], beyond[side][1], |share| share > BEYOND);
            for line in &view.covered[view.lines(from, to)] {
                held |= &line.part(columns.clone());
            }
            held
        });
        &one & &two
    }

    /// Where the first way of another direction begins that it comes to over free floor from a place along it on.
    fn next_way(&self, from: f64) -> Option<f64> {
        let (strip, view) = (self.strip(), self.view());
        let sign = shut::sign(self.side);
        let reach = sorted([from, from + sign * MOUTH]);
        let begins = self.ways_across(reach, MOUTH).into_iter().map(|over| (over[1 - self.side] - from) * sign);
        let by = begins.min_by(f64::total_cmp)?.max(0.0);
        let floor = sorted([from, from + sign * by]);
        let [low, high] = shut::inner(strip);
        (view.mean_blocked(view.columns(floor), low, high) <= CLUTTER).then_some(from + sign * by)
    }
}
