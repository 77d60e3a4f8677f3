//! Which of a direction's lines a place lies on: asked of every edge pixel, most of which are on none.

use crate::grid::{Frame, whole};
use std::ops::Range;

/// In metres, or at least so many pixels.
const NEAR: (f64, f64) = (0.12, 2.0);

/// How near to a line edge pixels lie on it, metres.
pub fn near(frame: &Frame) -> f64 {
    NEAR.0.max(NEAR.1 * frame.resolution)
}

/// Lines of one direction, and how near to one a place lies on it.
pub struct OnLine<'a> {
    offsets: &'a [f64],
    near: f64,
    /// Places across are told apart in steps as long as that, so many to a metre or a pixel, from here on.
    per: f64,
    start: f64,
    /// For each step the lines that a place in it may lie on: from, to.
    steps: Vec<[u32; 2]>,
}

/// Steps overlap by so much of their length: more than what floats round.
const OVERLAP: f64 = 0.01;

impl<'a> OnLine<'a> {
    /// From offsets in ascending order.
    pub fn new(offsets: &'a [f64], near: f64) -> Self {
        let start = offsets.first().map_or(0.0, |first| first - 2.0 * near);
        let mut made = Self { offsets, near, per: 1.0 / near, start, steps: Vec::new() };
        for (n, offset) in (0..).zip(offsets) {
            let from = made.step(offset - near) - OVERLAP;
            let to = made.step(offset + near) + OVERLAP;
            made.steps.resize(made.steps.len().max(to as usize + 1), [n, n]);
            made.steps[from as usize..=to as usize].iter_mut().for_each(|lines| lines[1] = n + 1);
        }
        made
    }

    fn step(&self, place: f64) -> f64 {
        (place - self.start) * self.per
    }

    /// The lines that a place across lies on.
    pub fn at(&self, place: f64) -> Range<usize> {
        let step = self.step(place);
        let lines = if step >= 0.0 { self.steps.get(whole(step)).copied() } else { None };
        let [mut from, mut to] = lines.unwrap_or_default().map(|n| n as usize);
        while from < to && self.offsets[from] < place - self.near {
            from += 1;
        }
        while from < to && self.offsets[to - 1] > place + self.near {
            to -= 1;
        }
        from..to
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_lies_on_the_lines_that_are_near() {
        let offsets = [-3.0, -2.9, -2.9, -2.65, 0.0, 4.1, 4.2, 4.35];
        for near in [0.05, 0.1, 0.12, 1.0] {
            let lines = OnLine::new(&offsets, near);
            for place in (-500..700).map(|n| f64::from(n) / 100.0) {
                let is_on = |n: &usize| offsets[*n] >= place - near && offsets[*n] <= place + near;
                assert_eq!(lines.at(place).collect::<Vec<_>>(), (0..8).filter(is_on).collect::<Vec<_>>(), "{place}");
            }
        }
        assert!(OnLine::new(&[], 0.1).at(0.0).is_empty());
    }
}
