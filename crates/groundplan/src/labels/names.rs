//! Names that a person can use and that hold when the map is made again: numbers run along the dominant directions,
//! from the lower left, and do not depend on which direction happened to be the stronger.

use super::turned::Turned;

/// Rows whose middles are this near to one line across are numbered as one, metres.
const SAME_ROW: f64 = 1.0;
/// The way in which numbers run across a direction turns over where its normal is perpendicular to this: an angle at
/// which nobody builds, so that a map made again numbers the same way.
const FORWARDS: [f64; 2] = [0.927, 0.375];

/// Something to be named, in the places of its direction.
pub struct Named {
    /// Index of the direction.
    pub direction: usize,
    /// Its middle across.
    pub across: f64,
    /// Its middle along.
    pub along: f64,
    /// How much it says for its direction being the main one, metres.
    pub weight: f64,
}

/// A name for each: the letter of the main direction or of the others, and a number.
pub fn names(views: &[Turned], items: &[Named], main: &str, other: &str) -> Vec<String> {
    let weight = |d: usize| items.iter().filter(|i| i.direction == d).map(|i| i.weight).sum::<f64>();
    let first = (0..views.len()).max_by(|&a, &b| weight(a).total_cmp(&weight(b)).then(b.cmp(&a))).unwrap_or(0);
    let sign = |x: f64, y: f64| if x * FORWARDS[0] + y * FORWARDS[1] < 0.0 { -1.0 } else { 1.0 };
    let key = |item: &Named| {
        let angle = views[item.direction].angle;
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        (item.across * sign(-sin, cos), item.along * sign(cos, sin))
    };
    let mut names = vec![String::new(); items.len()];
    for is_main in [true, false] {
        let mut order: Vec<usize> = (0..items.len()).filter(|&n| (items[n].direction == first) == is_main).collect();
        order.sort_by(|&a, &b| {
            let angle = |n: usize| views[items[n].direction].angle;
            angle(a).total_cmp(&angle(b)).then(key(&items[a]).0.total_cmp(&key(&items[b]).0))
        });
        // Along one line across, by the place along.
        let mut start = 0;
        while start < order.len() {
            let same = |n: usize| {
                items[n].direction == items[order[start]].direction
                    && key(&items[n]).0 - key(&items[order[start]]).0 < SAME_ROW
            };
            let end = (start..order.len()).find(|&n| !same(order[n])).unwrap_or(order.len());
            order[start..end].sort_by(|&a, &b| key(&items[a]).1.total_cmp(&key(&items[b]).1));
            start = end;
        }
        let letter = if is_main { main } else { other };
        for (n, &item) in order.iter().enumerate() {
            names[item] = format!("{letter}{:02}", n + 1);
        }
    }
    names
}
