//! The map asked place by place: what is free, what stands about a face, and how far posts come back along one.

use super::view::patches::Area;
use super::view::runs::runs;
use crate::grid::{Grid, State};
use crate::subdivision::distance;
use std::cell::Cell;

/// Looks are this far apart, metres, and no nearer than this share of a pixel.
pub const STEP: f64 = 0.2;
const FINE: f64 = 0.125;
/// And so far where what is narrow is looked for, metres.
const LOOK: f64 = 0.05;
/// What stands so near to a face is of it, metres.
const ASTRIDE: f64 = 0.2;
/// A post is no longer than this, the next one no nearer than so far, and both so near to where they would be at one pitch,
/// metres.
const POST: f64 = 0.35;
const PITCH: f64 = 0.9;
const OFF: f64 = 0.15;

/// The map that is asked, of places in its frame.
pub struct Looks<'a> {
    grid: &'a Grid<'a>,
    /// What has been asked of it.
    asked: Cell<Area>,
}

impl<'a> Looks<'a> {
    /// At a map of which nothing has been asked yet.
    pub fn new(grid: &'a Grid<'a>) -> Self {
        Self { grid, asked: Cell::new(Area::NONE) }
    }

    /// All that has been asked lies in it.
    pub fn asked(&self) -> Area {
        self.asked.get()
    }

    /// Side of a pixel, metres.
    pub fn resolution(&self) -> f64 {
        self.grid.frame.resolution
    }

    /// How far looks are apart, metres.
    pub fn step(&self) -> f64 {
        STEP.max(FINE * self.resolution())
    }

    /// The same where a wall may be one pixel thick: each pixel on the way; of fine maps walls are more.
    pub fn step_through_walls(&self) -> f64 {
        self.resolution().clamp(STEP / 8.0, STEP / 2.0)
    }

    pub fn state(&self, point: [f64; 2]) -> State {
        let Some(pixel) = self.grid.pixel_at(point) else { return State::Unknown };
        self.asked.set(self.asked.get().with(pixel));
        self.grid.state_of(pixel)
    }

    pub fn is_free(&self, point: [f64; 2]) -> bool {
        self.state(point) == State::Free
    }

    /// Free share of a line across a way.
    pub fn open(&self, at: [f64; 2], across: [f64; 2], width: f64) -> f64 {
        let lanes = self.lanes(at, across, width);
        let count = lanes.len() as f64;
        lanes.filter(|place| self.is_free(*place)).count() as f64 / count
    }

    /// Places across a way, a step apart, one at least.
    pub fn lanes(&self, at: [f64; 2], across: [f64; 2], width: f64) -> impl ExactSizeIterator<Item = [f64; 2]> {
        let count = (width / self.step()).ceil().max(1.0) as usize;
        (0..count).map(move |n| {
            let v = ((n as f64 + 0.5) / count as f64 - 0.5) * width;
            [at[0] + v * across[0], at[1] + v * across[1]]
        })
    }

    /// True when something stands about a face so far across from a place.
    pub fn is_taken(&self, at: [f64; 2], across: [f64; 2], face: f64) -> bool {
        let steps = (ASTRIDE / LOOK) as i32;
        let mut near = (-steps..=steps).map(|n| face + f64::from(n) * LOOK);
        near.any(|v| self.state([at[0] + v * across[0], at[1] + v * across[1]]) == State::Occupied)
    }

    /// Share of a face's length over which posts follow one another at one pitch; a face lies so far across from an axis.
    pub fn posts(&self, axis: [[f64; 2]; 2], face: f64) -> f64 {
        let [_, across] = frame_of(axis);
        let places = along(axis, LOOK);
        let flags: Vec<bool> = places.iter().map(|&at| self.is_taken(at, across, face)).collect();
        let posts = runs(&flags, true).into_iter().filter(|(from, to)| (to - from) as f64 * LOOK <= POST);
        let middles: Vec<f64> = posts.map(|(from, to)| f64::midpoint(from as f64, to as f64) * LOOK).collect();
        let gaps: Vec<f64> = middles.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let mut sorted = gaps.clone();
        sorted.sort_by(f64::total_cmp);
        let Some(&pitch) = sorted.get(gaps.len() / 2).filter(|pitch| **pitch >= PITCH) else { return 0.0 };
        gaps.iter().filter(|gap| (*gap - pitch).abs() <= OFF).sum::<f64>() / distance(axis[0], axis[1]).max(LOOK)
    }
}

/// Unit vectors along a straight piece and to its left.
pub fn frame_of([from, to]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    let length = distance(from, to).max(1e-9);
    let [x, y] = [0, 1].map(|n| (to[n] - from[n]) / length);
    [[x, y], [-y, x]]
}

/// Places along a straight piece, in the middles of equal steps of about that length.
pub fn along([from, to]: [[f64; 2]; 2], step: f64) -> Vec<[f64; 2]> {
    let count = (distance(from, to) / step).round().max(1.0);
    (0..count as usize).map(|n| [0, 1].map(|k| from[k] + (to[k] - from[k]) * (n as f64 + 0.5) / count)).collect()
}
