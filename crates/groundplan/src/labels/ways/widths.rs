//! Ways across rows are of one width: what leads through all rows of a place tells what leads through some of them.

use super::passing::{Passing, Place};
use crate::labels::corridors::Strip;
use crate::labels::view::turned::Turned;
use std::collections::BTreeSet;

/// Ways across a place are of one width but for this share.
const ALIKE: f64 = 0.15;
/// A bay that is so much wider or narrower than a way, as a share of it, can be told from one.
const APART: f64 = 0.1;

/// How wide the ways of a direction are that are no bays, metres.
#[derive(Clone, Default)]
pub struct Widths(Vec<f64>);

impl Widths {
    /// Of some ways, for each direction.
    pub fn of<'a>(views: &[Turned], strips: impl Iterator<Item = &'a Strip>) -> Vec<Self> {
        let mut all: Vec<Self> = views.iter().map(|_| Self::default()).collect();
        strips.for_each(|strip| all[strip.direction].0.push(strip.width()));
        all
    }

    /// Of those ways across rows, for each direction, that lead through some rows of a place between their ends and not
    /// through those beside.
    pub fn of_staggered(views: &[Turned], strips: &[Strip], places: &[Place]) -> Vec<Self> {
        let mut all: Vec<Self> = views.iter().map(|_| Self::default()).collect();
        for Place { views: [_, other], passing, .. } in places {
            let is_staggered = |own: &Passing| own.is_within && !own.next.is_empty() && !own.is_led_on;
            let ways = strips.iter().zip(passing).filter(|(_, own)| is_staggered(own));
            all[other.direction].0.extend(ways.map(|(way, _)| way.width()));
        }
        all
    }

    /// Of what leads through all of some rows one beside another, between their ends.
    pub fn of_whole(place: &Place, strips: &[Strip], rows: &BTreeSet<usize>) -> Self {
        Self(place.lead_through_all(rows).into_iter().map(|way| strips[way].width()).collect())
    }

    /// With one more.
    pub fn add(&mut self, width: f64) {
        self.0.push(width);
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// True when one is as wide, and a bay is not nearer to that.
    pub fn have(&self, width: f64, pitch: Option<f64>) -> bool {
        let is_like = |&own: &f64| {
            let off = (own - width).abs();
            let is_bay = pitch.is_some_and(|bay| (bay - own).abs() > APART * own && (bay - width).abs() < off);
            off <= ALIKE * width && !is_bay
        };
        self.0.iter().any(is_like)
    }
}

/// True when one width is another but for as little as those of ways differ by.
pub fn are_alike(one: f64, other: f64) -> bool {
    (one - other).abs() <= ALIKE * other
}
