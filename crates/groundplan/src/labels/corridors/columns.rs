//! What the columns of a strip hold: of its sides, and between them.

use crate::bits::Bits;
use crate::labels::recall::Key;
use crate::labels::view::turned::Turned;
use std::ops::Range;

/// A side's gap up to this long is an empty bay, metres.
pub const BAY: f64 = 2.9;
/// Pieces of side shorter than this are specks, metres.
const SHORTEST_SIDE: f64 = 0.25;
/// Structure on a line within a strip blocks it when it is so long, with gaps of so much, metres.
const FACE: f64 = 0.6;
const FACE_GAP: f64 = 0.3;
/// What speaks against a corridor, in columns that speak for it: an opening at a side, and a strip that is blocked.
pub const OPEN: f64 = 0.15;
const BLOCKED: f64 = 6.0;
/// Structure along the strip between its sides: another wall, or the face of a pallet.
const PARTED: f64 = 1.0;
/// No wall along a corridor makes up for one across it.
const CLOSED: f64 = 1e6;
/// A side begins so near to the mouth of a way beside it, metres.
const JAMB: f64 = 0.6;
/// Up to this share, what stands in the strip is clutter that one passes by.
pub const NARROWED: f64 = 0.5;

/// A line as the side of a strip, column by column.
pub struct Side {
    /// Structure, or the gap of an empty bay.
    pub walls: Bits,
    /// Of these.
    pub key: Key,
    /// Structure, or a gap too short for a bay.
    pub near: Bits,
    /// Structure of some length: more than posts.
    pub faces: Bits,
    /// The mouths of ways that open into it.
    pub mouths: Bits,
}

impl Side {
    /// A line of a view, with gaps as long as a bay, and the mouths of ways that open into it.
    pub fn new(view: &Turned, line: usize, bay: f64, racked: bool, mouths: &[Range<usize>]) -> Self {
        let cells = |metres: f64| (metres / view.cell) as usize;
        let joined = |from: &Bits, gap: f64, shortest: f64| {
            let mut joined = Bits::new(view.size[0]);
            let runs = from.joined(0..view.size[0], cells(gap)).into_iter();
            runs.filter(|run| run.len() >= cells(shortest)).for_each(|run| joined.fill(run));
            joined
        };
        // Where bays recur, their posts are the side of the way along them.
        let posts = if racked { &view.touched[line] } else { &view.covered[line] };
        let mut walls = joined(posts, bay, SHORTEST_SIDE);
        let mut open = Bits::new(view.size[0]);
        for mouth in mouths {
            open.fill(mouth.clone());
            walls.fill(mouth.clone());
        }
        if !mouths.is_empty() {
            walls = joined(&walls, JAMB, SHORTEST_SIDE);
        }
        let faces = joined(&view.covered[line], FACE_GAP, FACE);
        let key = Key::default().bits(&walls, 0..view.size[0]);
        Self { walls, key, near: joined(posts, BAY / 2.0, 0.0), faces, mouths: open }
    }
}

/// What one column of a strip holds.
#[allow(clippy::struct_excessive_bools)] // Each is a question that is asked of the column.
#[derive(Clone, Copy)]
pub struct Column {
    /// Share of it that is not free.
    pub blocked: f64,
    /// Nothing gets through.
    pub closed: bool,
    /// Structure lies along it between its sides.
    pub parted: bool,
    /// Structure lies on both sides, or a bay's gap in it.
    pub walled: bool,
    /// And not both sides are in the gap of a bay, or in the mouths of a way that crosses.
    pub near: bool,
    /// On which sides structure of some length lies.
    pub faces: [bool; 2],
    /// On which sides the ground beyond is not free, or a known way.
    pub held: [bool; 2],
}

impl Column {
    /// What a column says for a corridor or against it.
    pub fn score(self) -> f64 {
        let against = if self.closed {
            CLOSED
        } else if self.blocked > NARROWED {
            BLOCKED * self.blocked
        } else {
            2.0 * self.blocked
        };
        (if self.parted {
            -PARTED
        } else if self.walled {
            1.0
        } else {
            -OPEN
        }) - against
    }
}

/// Of a strip's columns so many hold.
pub fn count(columns: &[Column], is: impl Fn(&Column) -> bool) -> f64 {
    columns.iter().filter(|column| is(column)).count() as f64
}

/// How many of a strip's columns are walled.
pub struct Walled {
    /// Not merely by the gap of a bay on both sides.
    pub near: f64,
    /// With structure of some length on one side at least, and on both.
    pub once: f64,
    pub twice: f64,
    /// With such on the side that has less of it.
    pub weaker: f64,
}

impl Walled {
    pub fn new(columns: &[Column]) -> Self {
        let faced = |least: usize| count(columns, |c| c.walled && c.faces.iter().filter(|f| **f).count() >= least);
        let on = |side: usize| count(columns, |c| c.walled && c.faces[side]);
        Self { near: count(columns, |c| c.walled && c.near), once: faced(1), twice: faced(2), weaker: on(0).min(on(1)) }
    }
}
