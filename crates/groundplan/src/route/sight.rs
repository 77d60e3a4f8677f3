//! A way pulled taut: straight from point to point where every pixel between is of the space.

use super::space::Bits;

type Place = [f64; 2];

/// Corners of pixels nearer than this to a line of sight are touched by it.
const TOUCH: f64 = 1e-9;
/// Bends are cut shorter so many times.
const ROUNDS: usize = 4;
/// And each by halving so many times.
const HALVINGS: usize = 7;

/// Whether all pixels that the straight line between two places touches are set.
pub fn is_clear(space: &Bits, p: Place, q: Place) -> bool {
    let (mut x, mut y) = (p[0].floor() as i64, p[1].floor() as i64);
    let (end_x, end_y) = (q[0].floor() as i64, q[1].floor() as i64);
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let step = |d: f64| if d > 0.0 { 1 } else { -1 };
    let (step_x, step_y) = (step(dx), step(dy));
    // Where along the line the next column and the next row begin, and how far it is from one to the next.
    let first = |p: f64, cell: i64, d: f64| {
        if d == 0.0 { f64::INFINITY } else { (cell as f64 + f64::from(u8::from(d > 0.0)) - p) / d }
    };
    let (mut at_x, mut at_y) = (first(p[0], x, dx), first(p[1], y, dy));
    let (each_x, each_y) = (1.0 / dx.abs(), 1.0 / dy.abs());
    let has = |x: i64, y: i64| space.has(x as usize, y as usize);
    let mut left = (x - end_x).abs() + (y - end_y).abs();
    if !has(x, y) {
        return false;
    }
    while left > 0 {
        if (at_x - at_y).abs() < TOUCH && x != end_x && y != end_y {
            if !(has(x + step_x, y) && has(x, y + step_y)) {
                return false;
            }
            (x, y, at_x, at_y, left) = (x + step_x, y + step_y, at_x + each_x, at_y + each_y, left - 2);
        } else if (at_x < at_y && x != end_x) || y == end_y {
            (x, at_x, left) = (x + step_x, at_x + each_x, left - 1);
        } else {
            (y, at_y, left) = (y + step_y, at_y + each_y, left - 1);
        }
        if !has(x, y) {
            return false;
        }
    }
    true
}

/// Length of a way.
pub fn length(way: &[Place]) -> f64 {
    way.windows(2).map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1])).sum()
}

/// A shorter way with fewer bends. Steps of the way itself are never questioned, so that it may lead through where not
/// all of a pixel is of the space.
pub fn pull(space: &Bits, way: &[Place]) -> Vec<Place> {
    let forwards = skip(space, way);
    let reversed: Vec<Place> = way.iter().rev().copied().collect();
    let mut backwards = skip(space, &reversed);
    backwards.reverse();
    let mut way = if length(&backwards) < length(&forwards) { backwards } else { forwards };
    for _ in 0..ROUNDS {
        let before = length(&way);
        way = skip(space, &cut(space, &way));
        if length(&way) > before - 1e-3 {
            break;
        }
    }
    way
}

/// Leaves out what can be seen past.
fn skip(space: &Bits, way: &[Place]) -> Vec<Place> {
    let mut kept = vec![way[0]];
    let mut at = 0;
    while at + 1 < way.len() {
        let mut next = at + 1;
        while next + 1 < way.len() && is_clear(space, way[at], way[next + 1]) {
            next += 1;
        }
        kept.push(way[next]);
        at = next;
    }
    kept
}

/// Cuts every bend as short as can be seen across it.
fn cut(space: &Bits, way: &[Place]) -> Vec<Place> {
    let mut made = vec![way[0]];
    for n in 1..way.len().saturating_sub(1) {
        let (before, bend, after) = (made[made.len() - 1], way[n], way[n + 1]);
        let on = |to: Place, t: f64| [bend[0] + (to[0] - bend[0]) * t, bend[1] + (to[1] - bend[1]) * t];
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let t = f64::midpoint(low, high);
            if is_clear(space, on(before, t), on(after, t)) { low = t } else { high = t }
        }
        if low == 0.0 {
            made.push(bend);
        } else {
            // The next bend is cut from half of its side.
            made.push(on(before, low));
            made.push(on(after, low.min(0.5)));
        }
    }
    made.extend(way.last().filter(|_| way.len() > 1));
    made
}
