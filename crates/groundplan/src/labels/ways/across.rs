//! Which direction lies across another, and what of it may lead across a row.

use crate::ends::{around, wider};
use crate::labels::beside::Beside;
use crate::labels::rows::Row;
use crate::labels::view::axes::SQUARE;
use crate::labels::view::turned::Turned;

/// Of strips by their directions and places those along another direction that may lead across a row; none is wider than
/// the widest.
pub fn leading_across([view, other]: [&Turned; 2], placed: &[Beside], row: &Row, widest: f64) -> Vec<usize> {
    // So far beyond a row's ends the middle of what meets its corner may cross it, at a sine of a half or more.
    let reach = widest + row.depth();
    let corners = view.rectangle(wider(row.along, reach), row.across);
    let [along, across] = [0, 1].map(|axis| around(corners.iter().map(|&corner| other.place(corner)[axis])));
    placed[other.direction].touching(along, across)
}

/// The direction that is most nearly square to another.
pub fn crossing(views: &[Turned], direction: usize) -> Option<&Turned> {
    let sine = |view: &&Turned| view.sine(&views[direction]);
    views.iter().max_by(|a, b| sine(a).total_cmp(&sine(b))).filter(|view| sine(view) > 0.5)
}

/// The same if it is square to it, or places along lean with it.
pub fn square_to(views: &[Turned], direction: usize) -> Option<&Turned> {
    crossing(views, direction).filter(|other| views[direction].lean(other).abs() <= SQUARE)
}
