//! Outlines of regions: along the borders of their pixels, the same on both sides of a border, and simplified by less
//! than what lies between two borders, so that no two outlines cross.

use super::super::recall::{Key, Recall};
use super::fine::Fine;
use crate::bands::map_each;
use crate::bits::Bits;
use crate::labels::outline::area;
use std::sync::Arc;

/// A point of an outline, in half pixels of the regions' raster ([`Fine`]).
type Point = [i64; 2];

/// Outlines are simplified by at most the root of this many squared half pixels, over the second number: 0.35 pixels.
/// The middles of the sides of pixels that two borders run along are 0.7 pixels apart at least.
const TOLERANCE: (i128, i128) = (49, 100);

/// So many stretches of lower sides are worth a thread's while.
const MANY: usize = 1 << 10;

/// Rings in the grid's pixels.
type Rings = Vec<Vec<[f64; 2]>>;

/// The rings around each region by its number, the outer one first, counter-clockwise, then its holes.
pub fn find(fine: &Fine, count: usize, recall: &Recall, threads: usize) -> Vec<Rings> {
    let starts = starts(fine);
    // Each thread goes round regions of its own.
    let parts = threads.min(starts.len() / MANY + 1).max(1);
    let of_part = |part| rings(fine, count, &starts, recall, |number| number as usize % parts == part);
    let mut made = map_each(parts, threads, of_part);
    (0..=count).map(|number| std::mem::take(&mut made[number % parts][number])).collect()
}

/// Those of some regions.
fn rings(fine: &Fine, count: usize, starts: &[u32], recall: &Recall, is_own: impl Fn(u32) -> bool) -> Vec<Rings> {
    let mut rings: Vec<Rings> = vec![Vec::new(); count + 1];
    // Every ring has a lower side on it, and of each such stretch all that lies side by side.
    let mut seen = Seen { starts, passed: Bits::new(starts.len()) };
    fine.numbers.lower_sides(|run, pixels| {
        if is_own(run.number) && !seen.contains(pixels.start) {
            let ring = Tracer { fine, region: run.number }.trace((pixels.start, 0), &mut seen);
            let simple = recall.rings.or_find(|| key(&ring), || Arc::new(simplify(&ring)));
            let ring: Vec<[f64; 2]> =
                simple.iter().map(|&[x, y]| fine.to_grid([x as f64 / 2.0, y as f64 / 2.0])).collect();
            if ring.len() >= 3 {
                rings[run.number as usize].push(ring);
            }
        }
    });
    for rings in &mut rings {
        let outer = (0..rings.len()).max_by(|&a, &b| area(&rings[a]).total_cmp(&area(&rings[b])).then(b.cmp(&a)));
        if let Some(outer) = outer {
            rings.swap(0, outer);
        }
    }
    rings
}

/// Which lower sides were passed: they are few against the pixels, and a ring that has one pixel's has its neighbours'.
struct Seen<'a> {
    /// The first pixel of each stretch.
    starts: &'a [u32],
    passed: Bits,
}

/// The first pixel of each stretch of lower sides.
fn starts(fine: &Fine) -> Vec<u32> {
    let mut count = 0;
    fine.numbers.lower_sides(|_, _| count += 1);
    let mut starts = Vec::with_capacity(count);
    fine.numbers.lower_sides(|_, pixels| starts.push(pixels.start as u32));
    starts
}

impl Seen<'_> {
    fn stretch(&self, first: usize) -> usize {
        self.starts.partition_point(|&start| (start as usize) < first)
    }

    fn contains(&self, first: usize) -> bool {
        self.passed.get(self.stretch(first))
    }

    fn pass(&mut self, first: usize) {
        self.passed.insert(self.stretch(first));
    }
}

/// One region's border. A side of a pixel is (pixel, side), sides counted from below, counter-clockwise; it runs with
/// the pixel on its left.
struct Tracer<'a> {
    fine: &'a Fine,
    region: u32,
}

/// No side.
const NOWHERE: u8 = 4;

/// A point of a ring, and whether three regions or more meet there.
type Node = (Point, bool);

impl Tracer<'_> {
    fn beside(&self, pixel: usize, side: u8) -> usize {
        match side {
            0 => pixel - self.fine.width,
            1 => pixel + 1,
            2 => pixel + self.fine.width,
            _ => pixel - 1,
        }
    }

    /// The middle of a side, and the point where it ends.
    fn points(&self, (pixel, side): (usize, u8)) -> [Point; 2] {
        let (x, y) = (2 * (pixel % self.fine.width) as i64, 2 * (pixel / self.fine.width) as i64);
        match side {
            0 => [[x, y - 1], [x + 1, y - 1]],
            1 => [[x + 1, y], [x + 1, y + 1]],
            2 => [[x, y + 1], [x - 1, y + 1]],
            _ => [[x - 1, y], [x - 1, y - 1]],
        }
    }

    fn trace(&self, start: (usize, u8), seen: &mut Seen) -> Vec<Node> {
        let mut ring = Vec::new();
        let mut at = start;
        let mut before = NOWHERE;
        // Of sides in a straight row the first and the last are enough: none between is ever the farthest, or the least.
        let mut sides = 0;
        let number = |pixel: usize| self.fine.numbers.at(pixel);
        let mut o = number(self.beside(start.0, start.1));
        loop {
            if at.1 == 0 && before != 0 {
                seen.pass(at.0);
            }
            if at.1 != before {
                sides = 0;
            }
            before = at.1;
            let [middle, end] = self.points(at);
            if sides >= 2 {
                ring.pop();
            }
            sides += 1;
            ring.push((middle, false));
            let (pixel, side) = at;
            // The pixels ahead: on the region's side, and on the other.
            let turn = (side + 1) % 4;
            let left = self.beside(pixel, turn);
            let right = self.beside(self.beside(pixel, side), turn);
            let [l, r] = [left, right].map(number);
            let here = self.region;
            let (straight, turn_left, turn_right) = ((left, side), (pixel, turn), (right, (side + 3) % 4));
            // The next side, whether three regions meet on the way to it, and what lies beyond it.
            let (next, is_node, beyond) = match (l == here, r == here) {
                (true, false) => (straight, o != r, r),
                // Where two labels touch corner to corner the lesser is joined and the greater parted; where one label
                // touches itself between two others it is joined. So no ring comes to one point twice.
                (false, true) if o == l && here > o => (turn_left, false, l),
                (_, true) => (turn_right, false, o),
                (false, false) => (turn_left, o != l, l),
            };
            if is_node {
                ring.push((end, true));
                sides = 0;
            }
            (at, o) = (next, beyond);
            if at == start {
                return ring;
            }
        }
    }
}

/// The key of a ring.
fn key(ring: &[Node]) -> Key {
    let node = |key: Key, &([x, y], is_node): &Node| key.with((x << 33 | y << 1) as u64 | u64::from(is_node));
    ring.iter().fold(Key::default().with(ring.len() as u64), node)
}

/// Between points where three regions meet, a border is simplified the same from both its sides.
fn simplify(ring: &[Node]) -> Vec<Point> {
    let count = ring.len();
    let mut fixed: Vec<usize> = (0..count).filter(|&n| ring[n].1).collect();
    if fixed.is_empty() {
        let first = (0..count).min_by_key(|&n| ring[n].0).unwrap_or(0);
        let from = ring[first].0;
        let farthest = (0..count).max_by_key(|&n| (squared(from, ring[n].0), ring[n].0)).unwrap_or(0);
        fixed = vec![first.min(farthest), first.max(farthest)];
        fixed.dedup();
    }
    let all: Vec<Point> = ring.iter().map(|node| node.0).collect();
    let mut kept = Vec::new();
    for (n, &from) in fixed.iter().enumerate() {
        let to = fixed[(n + 1) % fixed.len()];
        let length = (to + count - from - 1) % count + 1;
        let chain: Vec<Point> = (0..=length).map(|k| all[(from + k) % count]).collect();
        let mut keep = vec![false; chain.len()];
        if chain[0] == chain[length] {
            // A whole ring that hangs on one point.
            let far = (0..=length).max_by_key(|&k| (squared(chain[0], chain[k]), chain[k])).unwrap_or(0);
            keep[far] = true;
            mark(&chain, 0, far, &mut keep);
            mark(&chain, far, length, &mut keep);
        } else {
            mark(&chain, 0, length, &mut keep);
        }
        kept.push(chain[0]);
        kept.extend((1..length).filter(|&k| keep[k]).map(|k| chain[k]));
    }
    kept.shrink_to_fit();
    kept
}

fn squared(p: Point, q: Point) -> i64 {
    (p[0] - q[0]).pow(2) + (p[1] - q[1]).pow(2)
}

/// Douglas and Peucker (1973), in whole numbers; of points equally far the least is taken, so that the way along the
/// chain does not matter.
fn mark(chain: &[Point], from: usize, to: usize, keep: &mut [bool]) {
    let mut stack = vec![(from, to)];
    while let Some((from, to)) = stack.pop() {
        if to < from + 2 {
            continue;
        }
        let (p, q) = (chain[from], chain[to]);
        let off = |n: usize| {
            let r = chain[n];
            ((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])).unsigned_abs()
        };
        let Some(far) = (from + 1..to).max_by_key(|&n| (off(n), std::cmp::Reverse(chain[n]))) else { continue };
        let (off, length) = (i128::from(off(far)), i128::from(squared(p, q)));
        if off * off * TOLERANCE.1 > TOLERANCE.0 * length {
            keep[far] = true;
            stack.push((from, far));
            stack.push((far, to));
        }
    }
}
