//! Ways that are known, and such as others lead to: these are put in place of what is known of them.

use super::ragged;
use crate::ends::{around, overlap};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::Strip;
use crate::labels::view::turned::Turned;

/// A way that is known to lead nearly as far, but for this, metres, is no less.
const SHORT: f64 = 0.5;

/// A way, and from the middle of the first one that leads there to that of the last, along.
pub struct Led {
    pub way: Strip,
    pub middles: [f64; 2],
}

/// The ways that are known, to which more are put in place of what was known of them.
pub struct Known {
    /// Without those that are part of another.
    ways: Vec<Option<Strip>>,
    placed: Vec<Beside>,
    is_more: bool,
}

impl Known {
    pub fn new(views: &[Turned], strips: &[Strip]) -> Self {
        let placed = placed(views, strips.iter().map(Strip::place));
        Self { ways: strips.iter().cloned().map(Some).collect(), placed, is_more: false }
    }

    /// With one more, unless it is known to lead as far, from middle to middle.
    pub fn add(&mut self, Led { mut way, middles }: Led) {
        let near = self.placed[way.direction].touching(way.along, way.across).into_iter();
        let is_part = |n: &usize| self.ways[*n].as_ref().is_some_and(|known| ragged::is_beside(known, &way));
        let parts: Vec<usize> = near.filter(is_part).collect();
        let leads = parts.iter().flat_map(|&n| &self.ways[n]).map(|part| overlap(part.along, middles));
        if leads.fold(0.0, f64::max) >= middles[1] - middles[0] - SHORT {
            return;
        }
        for part in parts.into_iter().filter_map(|n| self.ways[n].take()) {
            way.along = around(way.along.into_iter().chain(part.along));
        }
        self.placed[way.direction].add(self.ways.len(), way.along, way.across);
        self.ways.push(Some(way));
        self.is_more = true;
    }

    /// With the sides of a way for those of what is known beside it, where that is too wide; where it leads stays as it was.
    pub fn narrow(&mut self, way: &Strip, is_too_wide: impl Fn(&Strip) -> bool) {
        for n in self.placed[way.direction].touching(way.along, way.across) {
            let known = self.ways[n].as_mut().filter(|known| ragged::is_beside(known, way));
            if let Some(known) = known.filter(|known| is_too_wide(known)) {
                known.across = way.across;
                self.is_more = true;
            }
        }
    }

    /// All, if there are more than there were, or other ones.
    pub fn with_more(self) -> Option<Vec<Strip>> {
        self.is_more.then(|| self.ways.into_iter().flatten().collect())
    }
}
