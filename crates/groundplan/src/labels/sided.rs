//! Ways between sides: where one leads nowhere, what stands along it alone tells it from what is free of a room, or a row
//! between it and another.

use super::beside::Beside;
use super::connected::ALIKE;
use super::corridors::Strip;
use super::racks::{self, DEPTH, SAME};
use super::runs::{close, runs};
use super::sections::{self, WIDTH};
use super::turned::Turned;
use crate::ends::{overlap, shared, wider};

/// Over so much of a way's length something stands at a side.
const SIDED: f64 = 0.6;
/// It does so from so far within the side to so far beyond, in widths.
const SIDE: (f64, f64) = (0.1, 0.25);
/// An outline is closed where something of it stands so near, metres, over so much of a side.
const OUTLINE: f64 = 0.15;
const CLOSED: f64 = 0.95;
/// Things are parted by more than so many metres.
const PARTED: f64 = 0.3;

/// True when something that is not free stands along both sides of a strip.
pub fn is_sided(view: &Turned, strip: &Strip) -> bool {
    let columns = view.column(strip.along[0])..view.column(strip.along[1]);
    let [low, high] = strip.across;
    let (within, beyond) = (SIDE.0 * strip.width(), SIDE.1 * strip.width());
    [[low - beyond, low + within], [high - within, high + beyond]].into_iter().all(|[low, high]| {
        let held = view.blocked_where(columns.clone(), low, high, |share| share > 0.0);
        held.count(0..columns.len()) as f64 >= SIDED * columns.len() as f64
    })
}

/// True when a strip that is shut at both its ends is so all along its sides too, and another runs along it behind one of
/// them: nothing leads into it, and it is the inside of a row that is drawn by its outline. Of all it is known where they
/// lie.
pub fn is_within_outline(view: &Turned, strips: &[Strip], placed: &[Beside], n: usize) -> bool {
    let own = &strips[n];
    let columns = view.column(own.along[0])..view.column(own.along[1]);
    let is_closed = |side: f64| view.share_touched(columns.clone(), side - OUTLINE, side + OUTLINE) >= CLOSED;
    let is_behind = |other: &Strip| {
        (-SAME..=DEPTH.0).contains(&-overlap(own.across, other.across))
            && overlap(own.along, other.along) >= (1.0 - ALIKE) * own.length()
    };
    let near = placed[own.direction].touching(own.along, wider(own.across, DEPTH.0));
    own.across.into_iter().all(is_closed) && near.into_iter().any(|m| m != n && is_behind(&strips[m]))
}

/// True when another that is like it runs beside a strip, as far as goods do not hide the shorter of the two, with a row between them of which several pieces stand, and ways
/// lead between these from the one to the other: be there walls at all ends, rooms are not so. Of all it is known where they
/// lie.
pub fn is_at_row(view: &Turned, strips: &[Strip], placed: &[Beside], n: usize) -> bool {
    let own = &strips[n];
    let is_like = |other: &&Strip| {
        own.is_as_wide(other, ALIKE)
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
    stand.retain(|(from, to)| to - from >= cells(racks::SHORTEST));
    let free: Vec<bool> = blocked.iter().map(|share| *share <= sections::LEFT).collect();
    let is_way = |from: usize, to: usize| runs(&free[from..to], true).iter().any(|(a, b)| b - a >= cells(WIDTH.0));
    stand.windows(2).any(|pair| is_way(pair[0].1, pair[1].0))
}
