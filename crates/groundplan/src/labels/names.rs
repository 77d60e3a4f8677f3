//! Names of corridors by place, as of everything else (`places.rs`): the letter of the direction and the row or column
//! of the site's squares in which the corridor runs. What appears or goes renames nothing else, as a count would.

use super::places::{Squares, told_apart};

/// A corridor to be named.
pub struct Named {
    /// The angle of its direction, which may be the main one.
    pub angle: f64,
    pub is_main: bool,
    /// Its middle in the map frame, metres.
    pub middle: [f64; 2],
    /// Metres.
    pub length: f64,
}

/// A name for each: `A` of the main direction, `C` of the others, and the row. Of several in one row the longest has the
/// plain name, and of those about as long (within the square root of two) the first along the row.
pub fn names(squares: &Squares, items: &[Named]) -> Vec<String> {
    let key = |item: &Named| (!item.is_main, squares.row(item.angle, item.middle));
    let keys: Vec<(bool, usize)> = items.iter().map(key).collect();
    let ahead = |item: &Named| squares.ahead(item.middle);
    let about = |item: &Named| (2.0 * libm::log2(item.length)).floor();
    let mut order: Vec<usize> = (0..items.len()).collect();
    order.sort_by(|&a, &b| {
        let longer = about(&items[b]).total_cmp(&about(&items[a]));
        keys[a].cmp(&keys[b]).then(longer).then_with(|| ahead(&items[a]).total_cmp(&ahead(&items[b])))
    });
    told_apart(&order, &keys, |(is_other, row)| format!("{}{:02}", if *is_other { "C" } else { "A" }, row + 1))
}
