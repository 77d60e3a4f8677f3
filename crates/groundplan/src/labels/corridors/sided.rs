//! Ways between sides: where one leads nowhere, what stands along it alone tells it from what is free of a room, or a row
//! between it and another.

use super::family::LED_TO;
use crate::ends::{overlap, shared, wider};
use crate::labels::beside::Beside;
use crate::labels::corridors::{ALIKE, Strip};
use crate::labels::rows::racks::WAY_IN;
use crate::labels::rows::sections::{self, WIDTH};
use crate::labels::rows::{self, DEPTH, SAME};
use crate::labels::view::runs::{close, runs};
use crate::labels::view::turned::Turned;

/// Over so much of a way's length something stands at a side.
const SIDED: f64 = 0.6;
/// It does so from so far within the side to so far beyond, in widths.
const SIDE: (f64, f64) = (0.1, 0.25);
/// Empty bays are no longer than this, in pitches: these may be of their halves.
const BAYS: f64 = 2.0;
/// An outline is closed where something of it stands so near, metres, but for gaps through which no robot comes.
const OUTLINE: f64 = 0.15;
/// So far beyond an end of it, metres, is floor where less than that share is not free.
const BEYOND: (f64, f64) = (0.3, 1.3);
const FLOOR: f64 = 0.5;
/// Things are parted by more than so many metres.
const PARTED: f64 = 0.3;
/// Between bays a way is free but for this share, and the wall before it goes on beside it for so long, metres, and stands across
/// so much of that.
const CLEAR: f64 = 0.1;
const BESIDE: f64 = 0.8;
const WALL: f64 = 0.5;
/// What bays are empty before stands so near to the strip behind them, metres.
const FACE: f64 = 0.3;

/// True when something that is not free stands along both sides of a strip.
pub fn is_sided(view: &Turned, strip: &Strip) -> bool {
    are_sided(view, strip, strip.along).into_iter().all(|is_sided| is_sided)
}

/// True when something that is not free stands along both sides of a strip but for empty bays, where it is known from post to
/// post.
pub fn is_sided_but_for_bays(view: &Turned, strip: &Strip) -> bool {
    let bays = view.pitch.map_or(0.0, |pitch| BAYS * pitch);
    are_sided_but_for(view, strip, strip.along, bays).into_iter().all(|is_sided| is_sided)
}

/// True when something does along one of them between two places, and before the nearest strip on the other side something
/// stands there, no further off than a row is deep: behind bays, of which the last are empty.
pub fn is_sided_by_bays(view: &Turned, strip: &Strip, along: [f64; 2], beside: [f64; 2]) -> bool {
    let sided = are_sided(view, strip, along);
    let behind = stand_behind(view, strip, along, beside);
    // Racks stand beside one aisle alone in few places, and things that are none in many.
    beside.iter().any(|place| place.is_finite()) && (0..2).any(|side| sided[side] && behind[1 - side])
}

/// True when something stands so behind both its sides, before other strips, and nothing between them, up to a wall that goes on
/// beside one of them.
pub fn is_between_bays(view: &Turned, strip: &Strip, along: [f64; 2], wall: f64, beside: [f64; 2]) -> bool {
    let [low, high] = strip.across;
    let columns = view.column(along[0])..view.column(along[1]);
    let at_wall = view.columns(wider([wall; 2], PARTED));
    let goes_on = |[low, high]: [f64; 2]| at_wall.clone().any(|column| view.occupied(column, low, high) >= WALL);
    beside.iter().all(|place| place.is_finite())
        && view.mean_blocked(columns, low, high) <= CLEAR
        && stand_behind(view, strip, along, beside) == [true; 2]
        && [[low - BESIDE, low], [high, high + BESIDE]].into_iter().any(goes_on)
}

/// Behind which of a strip's sides something stands, before the nearest strip there and no further off than a row is deep.
fn stand_behind(view: &Turned, strip: &Strip, along: [f64; 2], beside: [f64; 2]) -> [bool; 2] {
    let columns = view.column(along[0])..view.column(along[1]);
    let [low, high] = strip.across;
    let behind = [[(low - DEPTH.1).max(beside[0] - FACE), low], [high, (high + DEPTH.1).min(beside[1] + FACE)]];
    behind.map(|[low, high]| {
        let stands = view.some_occupied(columns.clone(), low, high);
        stands.iter().filter(|share| **share > 0.0).count() as f64 >= SIDED * columns.len() as f64
    })
}

/// Along which of a strip's sides something that is not free stands between two places.
pub fn are_sided(view: &Turned, strip: &Strip, along: [f64; 2]) -> [bool; 2] {
    are_sided_but_for(view, strip, along, 0.0)
}

/// The same but for gaps that are no longer than that, metres.
fn are_sided_but_for(view: &Turned, strip: &Strip, along: [f64; 2], gap: f64) -> [bool; 2] {
    let columns = view.column(along[0])..view.column(along[1]);
    sides(strip).map(|[low, high]| {
        let held = view.blocked_where(columns.clone(), low, high, |share| share > 0.0);
        let mut held: Vec<bool> = (0..columns.len()).map(|n| held.get(n)).collect();
        close(&mut held, (gap / view.cell) as usize);
        held.into_iter().filter(|held| *held).count() as f64 >= SIDED * columns.len() as f64
    })
}

/// From where to where across what stands at a strip's sides does so.
pub fn sides(strip: &Strip) -> [[f64; 2]; 2] {
    let [low, high] = strip.across;
    let (within, beyond) = (SIDE.0 * strip.width(), SIDE.1 * strip.width());
    [[low - beyond, low + within], [high - within, high + beyond]]
}

/// True when a strip that is shut at both its ends is so all along its sides too, is no wider than a row is deep, ends
/// before floor, and another runs along it behind a side: nothing leads into it, and it is the inside of a row that is drawn
/// by its outline. Of a corridor with all doors shut both ends are outer walls. Of all it is known where they lie.
pub fn is_within_outline(view: &Turned, strips: &[Strip], placed: &[Beside], n: usize) -> bool {
    let own = &strips[n];
    let columns = view.column(own.along[0])..view.column(own.along[1]);
    let is_closed = |side: f64| {
        // What of it was not hit is as little floor as what was.
        let blocked = view.some_blocked(columns.clone(), side - OUTLINE, side + OUTLINE);
        let open: Vec<bool> = blocked.iter().map(|share| *share == 0.0).collect();
        runs(&open, true).iter().all(|(from, to)| ((to - from) as f64) * view.cell < WAY_IN)
    };
    let is_before_floor = |end: [f64; 2]| view.mean_blocked(view.columns(end), own.across[0], own.across[1]) < FLOOR;
    let [low, high] = own.along;
    let ends = [[low - BEYOND.1, low - BEYOND.0], [high + BEYOND.0, high + BEYOND.1]];
    let is_behind = |other: &Strip| {
        (-SAME..=DEPTH.0).contains(&-overlap(own.across, other.across))
            && overlap(own.along, other.along) >= (1.0 - ALIKE) * own.length()
    };
    let near = placed[own.direction].touching(own.along, wider(own.across, DEPTH.0));
    own.width() <= DEPTH.1
        && own.across.into_iter().all(is_closed)
        && ends.into_iter().any(is_before_floor)
        && near.into_iter().any(|m| m != n && is_behind(&strips[m]))
}

/// True when another that is as long runs beside a strip, as far as goods do not hide the shorter of the two, with a row
/// between them of which several pieces stand, and ways lead between these from the one to the other: be there walls at all
/// ends, rooms are not so. Of all it is known where they lie.
pub fn is_at_row(view: &Turned, strips: &[Strip], placed: &[Beside], n: usize) -> bool {
    let own = &strips[n];
    let is_like = |other: &&Strip| {
        own.width().min(other.width()) >= LED_TO * own.width().max(other.width())
            && overlap(own.along, other.along) >= (1.0 - ALIKE) * own.length().min(other.length())
    };
    let near = placed[own.direction].touching(own.along, wider(own.across, DEPTH.1));
    near.into_iter().map(|m| &strips[m]).filter(is_like).any(|other| {
        let [below, above] = if own.middle() < other.middle() { [own, other] } else { [other, own] };
        let faces = [below.across[1], above.across[0]];
        (DEPTH.0..=DEPTH.1).contains(&(faces[1] - faces[0])) && is_row(view, shared(own.along, other.along), faces)
    })
}

/// True when several things stand in line between two faces, and between two of them a way leads through.
fn is_row(view: &Turned, along: [f64; 2], [low, high]: [f64; 2]) -> bool {
    let cells = |metres: f64| (metres / view.cell) as usize;
    let blocked = view.some_blocked(view.column(along[0])..view.column(along[1]), low, high);
    let mut taken: Vec<bool> = blocked.iter().map(|share| *share >= sections::TAKEN).collect();
    close(&mut taken, cells(PARTED));
    let mut stand = runs(&taken, true);
    stand.retain(|(from, to)| to - from >= cells(rows::SHORTEST));
    let free: Vec<bool> = blocked.iter().map(|share| *share <= sections::LEFT).collect();
    let is_way = |from: usize, to: usize| runs(&free[from..to], true).iter().any(|(a, b)| b - a >= cells(WIDTH.0));
    stand.windows(2).any(|pair| is_way(pair[0].1, pair[1].0))
}
