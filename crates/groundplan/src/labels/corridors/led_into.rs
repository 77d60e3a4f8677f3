//! Ways that are led on into an aisle of a wing that runs nearly as they do: past the first way that crosses both, with nothing along
//! them. Where walls part at a small angle both ways have their own.

use super::sided;
use crate::ends::{holds, sorted};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::{ASKEW, Strip};
use crate::labels::junctions::shut::{inner, sign};
use crate::labels::view::turned::Turned;

/// An aisle runs nearly as a way does at an angle of such a sine; ways cross both at more.
const ALONG: [f64; 2] = [0.1, ASKEW];
/// Where a way comes into an aisle is told to so much, metres.
const STEP: f64 = 0.25;

/// The strips, each up to the last that crosses it where it only is led on into an aisle beyond; none where none is.
pub fn cut(views: &[Turned], strips: &[Strip]) -> Option<Vec<Strip>> {
    let are_nearly = |one: &Turned| views.iter().any(|two| holds(ALONG, one.sine(two)));
    if !views.iter().any(are_nearly) {
        return None;
    }
    let placed = placed(views, strips.iter().map(Strip::place));
    let left = |strip: &Strip| {
        let mut left = strip.clone();
        for side in [0, 1] {
            if let Some(end) = (LedOn { views, strips, placed: &placed, strip, side }).ends() {
                (left.along[side], left.stops[side]) = (end, true);
            }
        }
        if left.length() >= strip.width() { left } else { strip.clone() }
    };
    let cut: Vec<Strip> = strips.iter().map(left).collect();
    (cut != strips).then_some(cut)
}

/// A strip at one of its ends.
struct LedOn<'a> {
    views: &'a [Turned],
    strips: &'a [Strip],
    placed: &'a [Beside],
    strip: &'a Strip,
    side: usize,
}

impl LedOn<'_> {
    fn own(&self) -> &Turned {
        &self.views[self.strip.direction]
    }

    fn end(&self) -> f64 {
        self.strip.along[self.side]
    }

    /// The middle of what it ends at, along, if it is led on past that: the farthest out.
    fn ends(&self) -> Option<f64> {
        let nearly = self.views.iter().filter(|its| holds(ALONG, self.own().sine(its)));
        let outwards = |place: &f64| place * sign(self.side);
        nearly.filter_map(|its| self.before(its)).max_by(|a, b| outwards(a).total_cmp(&outwards(b)))
    }

    /// The same before an aisle of another direction.
    fn before(&self, its: &Turned) -> Option<f64> {
        let aisle = self.ended_in(its)?;
        let [middle, beyond] = self.last_crossing(its)?;
        let led_on = (self.end() - beyond) * sign(self.side);
        let is_led_on = led_on > self.strip.width() && led_on < aisle.length() && !self.is_walled(its, aisle, beyond);
        is_led_on.then_some(middle)
    }

    /// The longest strip of another direction in which it ends.
    fn ended_in(&self, its: &Turned) -> Option<&Strip> {
        let [u, v] = its.place(self.own().to_map([self.end(), self.strip.middle()]));
        let near = self.placed[its.direction].touching([u; 2], [v; 2]).into_iter().map(|n| &self.strips[n]);
        let holding = near.filter(|other| holds(other.along, u) && holds(other.across, v));
        holding.max_by(|a, b| a.length().total_cmp(&b.length()))
    }

    /// Where the last that crosses it and another direction does so before its end, along: its middle, and its far side.
    fn last_crossing(&self, its: &Turned) -> Option<[f64; 2]> {
        let (own, strip) = (self.own(), self.strip);
        let crosses = |view: &&Turned| view.sine(own) > ASKEW && view.sine(its) > ASKEW;
        let crossings = self.views.iter().filter(crosses).flat_map(|view| {
            let ends = strip.along.map(|u| view.place(own.to_map([u, strip.middle()])));
            let [u, v] = [0, 1].map(|axis| sorted(ends.map(|end| end[axis])));
            self.placed[view.direction].touching(u, v).into_iter().filter_map(move |n| {
                let other = &self.strips[n];
                let [there, here] = own.crossing(view, strip.middle(), other.middle());
                let beyond = here + sign(self.side) * other.width() / 2.0 / view.sine(own);
                (holds(other.along, there) && holds(strip.along, here)).then_some([here, beyond])
            })
        });
        let outwards = |place: &[f64; 2]| place[0] * sign(self.side);
        crossings.max_by(|a, b| outwards(a).total_cmp(&outwards(b)))
    }

    /// True when something stands along its outer side from a place on, as far as that lies outside an aisle, and farther than it is
    /// wide.
    fn is_walled(&self, its: &Turned, aisle: &Strip, from: f64) -> bool {
        let (own, strip) = (self.own(), self.strip);
        let is_in = |u: f64, v: f64| {
            let [there, across] = its.place(own.to_map([u, v]));
            holds(aisle.along, there) && holds(aisle.across, across)
        };
        // Seen from the end, in which its middle lies.
        let enters = |v: f64| {
            let places = (0..=((self.end() - from).abs() / STEP) as usize).map(|n| n as f64 * STEP);
            let places = places.map(|off| self.end() - sign(self.side) * off);
            places.take_while(|u| is_in(*u, v)).last().unwrap_or(self.end())
        };
        let outside = inner(strip).map(|v| (enters(v) - from) * sign(self.side));
        let outer = usize::from(outside[1] > outside[0]);
        let along = sorted([from, from + sign(self.side) * outside[outer]]);
        outside[outer] > strip.width() && sided::are_sided(own, strip, along)[outer]
    }
}
