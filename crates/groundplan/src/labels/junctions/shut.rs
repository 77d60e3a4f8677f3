//! Whether something shuts a corridor at one of its ends, or it goes on.

use crate::ends::{sorted, wider};
use crate::labels::corridors::Strip;
use crate::labels::corridors::barriers;
use crate::labels::corridors::sided;
use crate::labels::posts::lags::LONGEST;
use crate::labels::rows::racks::WAY_IN;
use crate::labels::view::panes;
use crate::labels::view::turned::Turned;
use std::ops::Range;

/// A corridor goes on beyond a junction when it does so for this long, metres, and where a wall ends it, for this share
/// of its width: less is what is left of it at a corner.
pub const ARM: (f64, f64) = (1.6, 0.65);
/// And where nothing was seen beyond, for this long.
const FRONTIER: f64 = 1.2;
/// A side goes on to a wall where over this share of the way something stands on it.
const SIDED: f64 = 0.7;
/// What stands within this share of its width of a corridor's sides does not close it.
const MARGIN: f64 = 0.2;
/// A corridor's end is looked for so far beyond its walls, metres.
pub const LOOK: f64 = 2.0;
/// It is shut when it is closed within so much, metres.
const SHUT: f64 = 1.0;
/// What closes it is this deep, metres, and lies across this share of its width.
const DEEP: f64 = 0.4;
const ACROSS: f64 = 0.5;
/// Where the middle was not seen so much of what lies at each of its sides is wall, without what belongs to these, metres.
const SEEN: f64 = 0.7;
const CORNER: f64 = 0.15;
const BEFORE: (f64, f64) = (0.1, 0.3);
/// Jambs stand within its sides by more than so much, metres, across so much of the rest.
const JAMBS: (f64, f64) = (0.1, 0.25);
/// Where it goes on over what was not seen, from so far beyond its end to so far, metres, more than this share is no floor.
const BEYOND: (f64, f64) = (0.2, 1.2);
const FLOOR: f64 = 0.5;
/// A thin wall stands in so many columns at most, where a border of cells parts it.
const THIN: i64 = 2;

/// True when a corridor goes on beyond a junction by so much that it leads on: as far as its sides were seen, which is less where it
/// ends at a frontier, or to the wall that ends it where one of them goes on to that over more than a slit through which no robot
/// comes.
pub fn goes_on(view: &Turned, strip: &Strip, side: usize, beyond: f64) -> bool {
    let least = ARM.1 * strip.width();
    let reaches = |wall: f64| {
        let more = (wall - strip.along[side]) * sign(side);
        let columns = view.columns(sorted([strip.along[side], wall]));
        let is_sided = |at: f64| view.share_touched(columns.clone(), at - CORNER, at + CORNER) >= SIDED;
        beyond + more >= least && more > WAY_IN && strip.across.into_iter().any(is_sided)
    };
    let is_long = beyond >= ARM.0 || beyond >= FRONTIER && is_unseen(view, strip, side);
    is_long && (beyond >= least || closed(view, strip, side, LOOK).is_none_or(reaches))
}

/// True when a wall closes a strip at one of its ends, be there a door in it.
pub fn is_shut(view: &Turned, strip: &Strip, side: usize) -> bool {
    let end = strip.along[side];
    let [from, to] = [end - SHUT, end + SHUT].map(|u| view.column(u));
    closed(view, strip, side, SHUT).is_some() || barriers::across(view, strip.across, from..to + 1).any()
}

/// True when at one of a strip's ends it is shut, or jambs stand, or what else stands across a part of it.
pub fn is_parted(view: &Turned, strip: &Strip, side: usize) -> bool {
    let [from, to] = wider([strip.along[side]; 2], DEEP).map(|u| view.column(u));
    let [low, high] = wider(strip.across, -JAMBS.0);
    let stands = (from..to).map(|n| view.occupied(n, low, high)).sum::<f64>();
    stands >= JAMBS.1 || is_shut(view, strip, side)
}

/// True when nothing was seen beyond one of a strip's ends: neither what shuts it nor floor.
pub fn is_unseen(view: &Turned, strip: &Strip, side: usize) -> bool {
    let beyond = sorted([BEYOND.0, BEYOND.1].map(|metres| strip.along[side] + sign(side) * metres));
    let [low, high] = inner(strip);
    view.mean_blocked(view.columns(beyond), low, high) > FLOOR && !is_shut(view, strip, side)
}

/// True when something stands across a strip in a column, or in one beside it.
pub fn is_shut_at(view: &Turned, strip: &Strip, column: usize) -> bool {
    let last = view.size[0] - 1;
    is_hit(
        view,
        column.saturating_sub(THIN as usize).min(last)..(column + THIN as usize).min(last) + 1,
        inner(strip),
        ACROSS,
    )
}

/// Where a strip ends: at what closes it near one of its ends, or no further off than bays are long, where one of its sides
/// goes on to that; the last bay on the other side is empty, before what another strip beside it lies behind. If the last bays on
/// both sides are it is no further off than two of them.
pub fn end(view: &Turned, strip: &Strip, side: usize, beside: impl Fn() -> [f64; 2]) -> Option<f64> {
    let along = |place: f64| sorted([strip.along[side], place]);
    let is_sided_to = |place: &f64| sided::is_sided_by_bays(view, strip, along(*place), beside());
    let is_between_bays = |place: &f64| sided::is_between_bays(view, strip, along(*place), *place, beside());
    closed(view, strip, side, LOOK)
        .or_else(|| closed(view, strip, side, LONGEST).filter(is_sided_to))
        .or_else(|| closed(view, strip, side, 2.0 * LONGEST).filter(is_between_bays))
}

/// A strip without what stands at its sides, across.
pub fn inner(strip: &Strip) -> [f64; 2] {
    let margin = MARGIN * strip.width();
    [strip.across[0] + margin, strip.across[1] - margin]
}

/// Which way along a strip one of its ends lies.
pub fn sign(side: usize) -> f64 {
    if side == 0 { -1.0 } else { 1.0 }
}

/// Where what closes a strip so far beyond one of its ends begins.
pub fn closed(view: &Turned, strip: &Strip, side: usize, look: f64) -> Option<f64> {
    if let Some(pane) = panes::beyond(view, strip, side, look) {
        return Some(pane);
    }
    let sign = sign(side);
    let cells = |metres: f64| (metres / view.cell).ceil() as i64;
    let last = view.size[0] as i64 - 1;
    let start = view.column(strip.along[side] - 0.5 * sign * view.cell) as i64;
    let columns = (0..=cells(look)).map(|step| start + step * sign as i64).filter(|c| (0..=last).contains(c));
    let [low, high] = inner(strip);
    let first = columns.into_iter().find(|&c| view.is_closed(c as usize, low, high))?;
    // A wall that is not quite square to the corridor shows in several columns.
    let deep = (first - cells(DEEP)).max(0)..=(first + cells(DEEP)).min(last);
    let across: f64 = deep.clone().map(|c| view.occupied(c as usize, low, high)).sum();
    // Of one that is thinner than the samples are apart hardly any lies on a wall, and not all of a thin one may be hit.
    let is_wall = across >= ACROSS
        || deep.clone().any(|c| view.is_barred(c as usize, low, high))
        || deep.clone().any(|c| is_hit(view, c as usize..(c + THIN).min(last + 1) as usize, [low, high], ACROSS));
    let wall = if is_wall { first } else { hidden(view, strip, side, first)? };
    Some(view.along(wall as usize) + if sign < 0.0 { view.cell } else { 0.0 })
}

/// Where a wall stands that comes from both sides of a strip near where it is closed, if what lies before its middle was not
/// seen: between jambs floor does.
fn hidden(view: &Turned, strip: &Strip, side: usize, closed: i64) -> Option<i64> {
    let ([low, high], [from, to]) = (wider(strip.across, -CORNER), inner(strip));
    let (sign, cells) = (sign(side), |metres: f64| (metres / view.cell).ceil() as i64);
    let last = view.size[0] as i64 - 1;
    // Not quite square to the strip it shows in several columns.
    let begins = (closed - cells(DEEP) * sign as i64).clamp(0, last);
    let columns = (0..=cells(DEEP) + cells(SHUT)).map(|step| begins + step * sign as i64);
    let columns = columns.filter(|c| (0..=last).contains(c)).map(|c| c as usize);
    let first = |across: [f64; 2]| hit(view, columns.clone(), across, SEEN).map(|c| c as i64);
    let (one, two) = (first([low, from])?, first([to, high])?);
    let wall = if sign < 0.0 { one.max(two) } else { one.min(two) };
    let before = sorted([BEFORE.0, BEFORE.1].map(|metres| view.along(wall as usize) - sign * metres));
    let third = wider([strip.middle(); 2], strip.width() / 6.0);
    ((one - two).abs() <= cells(DEEP) && view.mean_blocked(view.columns(before), third[0], third[1]) > FLOOR)
        .then_some(wall)
}

/// True when something stands in some columns over so much of the way across, be it ever so thin.
fn is_hit(view: &Turned, columns: Range<usize>, across: [f64; 2], share: f64) -> bool {
    hit(view, columns, across, share).is_some()
}

/// The column with which something stands in it or those before over so much of the way across.
fn hit(view: &Turned, mut columns: impl Iterator<Item = usize>, [low, high]: [f64; 2], share: f64) -> Option<usize> {
    let count = ((high - low) / view.cell).round().max(1.0);
    let place = |n: usize| low + (high - low) * n as f64 / count;
    let mut missed: Vec<usize> = (0..count as usize).collect();
    columns.find(|&c| {
        missed.retain(|&n| view.occupied(c, place(n), place(n + 1)) <= 0.0);
        count - missed.len() as f64 >= share * count
    })
}
