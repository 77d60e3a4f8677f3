//! What closes a row of racks at a place: something that stands in one straight line across it, as a rack's end does.

use crate::grid::Frame;
use crate::labels::view::look::{BLOCKED, Look};
use crate::labels::view::runs::{close, runs};
use crate::labels::view::turned::Turned;

/// An end is closed by what stands along a straight line so near to it, metres, over so much of the row's depth: goods
/// beside one another do not line up so well.
const FRAME: (f64, f64) = (0.35, 0.9);
/// What stands so near to a line lies on it, metres; what stands so near to the row's faces is not asked.
const ON_LINE: f64 = 0.06;
const ON_FACE: f64 = 0.1;
/// Along a frame or the end of a rack so much, metres, and so many pixels were not hit at times; and so much where no beam
/// went through either, metres.
const HOLE: (f64, f64) = (0.1, 2.0);
const UNSEEN: f64 = 0.3;
/// Racks that stand back to back are so far apart at most, metres.
const FLUE: f64 = 0.3;
/// Places along such a line are so far apart, metres.
const STEP: f64 = 0.05;

/// How a row is closed at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Closing {
    Open,
    /// From one face to its middle, as one of two racks that stand back to back does.
    Half,
    Whole,
    /// Whole, and nothing parts it about its middle, as a flue parts what stands in two racks.
    Sheet,
}

impl Closing {
    /// From one face to the other, be there a flue or not.
    pub fn is_whole(self) -> bool {
        self >= Self::Whole
    }
}

/// The lines across a row along which something may close it: they lean as the direction does that crosses it.
pub struct LinesAcross<'a> {
    pub look: &'a Look<'a>,
    pub frame: &'a Frame,
    pub view: &'a Turned,
    /// The row's faces, and half way between them.
    pub across: [f64; 2],
    pub middle: f64,
    /// Metres along for a metre across.
    pub lean: f64,
}

impl LinesAcross<'_> {
    /// How far the row is closed along the straight line near a place on which most stands.
    pub fn closing(&self, along: f64) -> Closing {
        let step = self.frame.resolution;
        let near = (ON_LINE / step).round().max(1.0) as usize;
        let reach = (FRAME.0 / step).ceil() as usize + near;
        let low = (self.across[0] + ON_FACE).min(self.middle);
        let (count, down) = self.steps(low);
        let lines: Vec<Vec<u8>> = (0..=2 * reach)
            .map(|n| {
                let u = along + (n as f64 - reach as f64) * step + (low - self.middle) * self.lean;
                let mut samples = vec![0; count];
                self.look.along(self.frame.to_pixels(self.view.to_map([u, low])), down, &mut samples);
                samples
            })
            .collect();
        let holes = (HOLE.0.max(HOLE.1 * step) / STEP).round() as usize;
        let is_closed =
            |stands: &[bool]| stands.iter().filter(|stands| **stands).count() as f64 >= FRAME.1 * stands.len() as f64;
        let mut closing = Closing::Open;
        for lines in lines.windows(2 * near + 1) {
            let (stands, is_parted) = standing(lines, count, holes);
            let half = (count / 2).max(1);
            closing = closing.max(if is_closed(&stands) {
                if is_parted { Closing::Whole } else { Closing::Sheet }
            } else if is_closed(&stands[..half]) || is_closed(&stands[count - half..]) {
                Closing::Half
            } else {
                Closing::Open
            });
            if closing == Closing::Sheet {
                break;
            }
        }
        closing
    }

    /// How many steps there are across the row from a place on, and one of them on the grid, pixels.
    fn steps(&self, low: f64) -> (usize, [f64; 2]) {
        let depth = 2.0 * (self.middle - low);
        let count = (depth / STEP).round().max(1.0);
        let at = |v: f64| self.frame.to_pixels(self.view.to_map([v * self.lean, v]));
        let (from, to) = (at(low), at(low + depth));
        (count as usize, [0, 1].map(|axis| (to[axis] - from[axis]) / count))
    }
}

/// At which of the samples across something stands on one of some lines, but for holes of so many; and whether a flue parts it.
fn standing(lines: &[Vec<u8>], count: usize, holes: usize) -> (Vec<bool>, bool) {
    // What stands at the faces holds the ends.
    let mut stands = vec![true; count + 2];
    (0..count).for_each(|k| stands[k + 1] = lines.iter().any(|line| line[k] > BLOCKED));
    // Where two racks stand back to back, each is a third of both at least.
    let middle = count / 3..count - count / 3;
    let is_parted = stands[1..][middle.clone()].contains(&false);
    close(&mut stands, holes);
    let is_unseen = |k: usize| lines.iter().any(|line| line[k - 1] == BLOCKED);
    for (from, to) in runs(&stands, false) {
        if to - from <= (UNSEEN / STEP).round() as usize && (from..to).all(is_unseen) {
            stands[from..to].fill(true);
        }
    }
    let mut stands = stands[1..=count].to_vec();
    close(&mut stands[middle], (FLUE / STEP).round() as usize);
    (stands, is_parted)
}
