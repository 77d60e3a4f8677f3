//! Leaves of doors: one that stands open looks like a short wall, and between its end and the wall across nothing is
//! parted.

use super::super::near::Near;
use super::gaps::Bar;
use super::raster::Raster;

/// A leaf is as long as its doorway is wide, or so much of it; and stands in a wall so thick, metres.
const AS_LONG: f64 = 0.85;
const WALL: f64 = 0.25;
/// The doorway of one leaf is no wider, metres; and what is left open beyond its end is so many times as wide.
const WIDEST: f64 = 1.3;
const WIDER: f64 = 1.3;
/// The cosine of a leaf that stands open with its doorway is less; and with what it leaves open more.
const OPEN: f64 = 0.7;
const ALONG: f64 = 0.8;
/// So much of a leaf at least is seen, looked for within a pixel of it on either side.
const SEEN: f64 = 0.7;

/// Which of some openings a leaf's end leaves open beside the doorway in which it hangs, another of them.
pub fn beyond(openings: &[Bar], raster: &Raster) -> Vec<bool> {
    let (widest, wall) = (raster.pixels(WIDEST), raster.pixels(WALL));
    let doorways: Vec<&Bar> = openings.iter().filter(|opening| opening.length() <= widest).collect();
    let near = Near::points((0..).zip(&doorways).flat_map(|(n, door)| door.ends.map(|end| (n, end))));
    let is_beyond = |opening: &Bar, [tip, across]: [[f64; 2]; 2]| {
        near.about(tip, widest + wall).into_iter().map(|n| doorways[n as usize]).any(|door| {
            opening.length() >= WIDER * door.length()
                && door.ends.into_iter().any(|hinge| is_leaf(raster, door, [hinge, tip], across))
        })
    };
    let of = |opening: &Bar| {
        let [from, to] = opening.ends;
        is_beyond(opening, [from, to]) || is_beyond(opening, [to, from])
    };
    openings.iter().map(of).collect()
}

/// True when something as long as a doorway is wide stands from its jamb to a tip, open by the half of a right angle at
/// least, and points at what lies across.
fn is_leaf(raster: &Raster, door: &Bar, [hinge, tip]: [[f64; 2]; 2], across: [f64; 2]) -> bool {
    let leaf = Bar::new([hinge, tip]);
    let (width, length) = (door.length(), leaf.length());
    let cosine = |one: &Bar, other: &Bar| {
        let ([ax, ay], [bx, by]) = (one.heading(), other.heading());
        ax * bx + ay * by
    };
    if !(AS_LONG * width..=width + raster.pixels(WALL)).contains(&length)
        || cosine(&leaf, door).abs() > OPEN
        || cosine(&leaf, &Bar::new([tip, across])) < ALONG
    {
        return false;
    }
    let [ux, uy] = leaf.heading();
    let is_taken = |n: &usize| {
        let [x, y] = [hinge[0] + ux * *n as f64, hinge[1] + uy * *n as f64];
        let beside = [-1.0, 0.0, 1.0].map(|off| raster.at([x - off * uy, y + off * ux]));
        beside.into_iter().flatten().any(|pixel| !raster.free.get(pixel))
    };
    let seen = (0..length as usize).filter(is_taken).count();
    seen as f64 >= SEEN * length.floor()
}
