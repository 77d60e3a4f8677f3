//! Where corridors of other directions open into a line side by side: what lies there is no gap in a side, but the
//! mouths of ways that are known.

use crate::ends::{sorted, wider};
use crate::labels::corridors::Strip;
use crate::labels::view::turned::Turned;
use std::ops::Range;

/// What ends so near to a line reaches it, metres.
const NEAR: f64 = 0.5;
/// The least sine of the angle at which a corridor opens into a line.
const SQUARE: f64 = 0.5;
/// Aisles side by side are of one width but for this share.
const ALIKE: f64 = 0.1;

/// For each line of a view the columns of such mouths, by where they begin.
pub fn of(views: &[Turned], view: &Turned, strips: &[Strip]) -> Vec<Vec<Range<usize>>> {
    let square = |strip: &&Strip| views[strip.direction].sine(view) >= SQUARE;
    let others: Vec<&Strip> = strips.iter().filter(square).filter(|strip| !strip.bays).collect();
    // Of each line the strips that reach it.
    let mut reaching: Vec<Vec<(&Strip, Range<usize>)>> = vec![Vec::new(); view.offsets.len()];
    for strip in others {
        let other = &views[strip.direction];
        let ends = wider(strip.along, NEAR + view.cell).map(|s| view.place(other.to_map([s, strip.middle()]))[1]);
        let [low, high] = sorted(ends);
        for line in view.lines(low, high) {
            if let Some(mouth) = mouth(views, view, view.offsets[line], strip) {
                reaching[line].push((strip, mouth));
            }
        }
    }
    let is_alike = |one: &Strip, two: &Strip| {
        let wider = one.width().max(two.width());
        one.direction == two.direction && (one.width() - two.width()).abs() <= ALIKE * wider
    };
    let side_by_side = |reaching: Vec<(&Strip, Range<usize>)>| {
        let beside = |n: usize| (0..reaching.len()).any(|m| m != n && is_alike(reaching[n].0, reaching[m].0));
        let mut mouths: Vec<_> = (0..reaching.len()).filter(|&n| beside(n)).map(|n| reaching[n].1.clone()).collect();
        mouths.sort_unstable_by_key(|mouth| (mouth.start, mouth.end));
        mouths
    };
    reaching.into_iter().map(side_by_side).collect()
}

/// Where a corridor opens into a line, if it reaches it.
fn mouth(views: &[Turned], view: &Turned, offset: f64, strip: &Strip) -> Option<Range<usize>> {
    let other = &views[strip.direction];
    let [one, two] = strip.across.map(|t| view.crossing(other, offset, t));
    let s = f64::midpoint(one[0], two[0]);
    let reaches = strip.along[0] - NEAR <= s && s <= strip.along[1] + NEAR;
    reaches.then(|| view.columns(sorted([one[1], two[1]])))
}
