//! The shortest way from pixel to pixel over eight neighbours: A* with jump points (Harabor and Grastien 2011), found
//! along rows and columns 64 pixels at a time (Harabor and Grastien 2014). No corner is cut: a slanted step needs both
//! pixels beside it.

use super::space::{Bits, Layer, Pixel};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::SQRT_2;

type Step = [i64; 2];

/// The jump points of a shortest way, both ends included; none when there is no way.
pub fn find(space: &Layer, from: Pixel, to: Pixel) -> Option<Vec<Pixel>> {
    if space.piece(from)? != space.piece(to)? {
        return None;
    }
    let search = Search { space, goal: to };
    let width = space.rows.width;
    let id = |[x, y]: Pixel| (y * width + x) as u64;
    let pixel = |id: u64| [id as usize % width, id as usize / width];
    let mut nodes = Nodes::new();
    let mut open = BinaryHeap::new();
    nodes.reach(id(from), 0.0, id(from));
    open.push(Open { estimate: octile(from, to), id: id(from) });
    while let Some(Open { id: at, .. }) = open.pop() {
        let Some((gone, before)) = nodes.close(at) else { continue };
        let here = pixel(at);
        if here == to {
            let mut way = vec![here];
            let mut at = (at, before);
            while at.0 != at.1 {
                way.push(pixel(at.1));
                at = (at.1, nodes.before(at.1));
            }
            way.reverse();
            return Some(way);
        }
        search.successors(here, pixel(before), |next| {
            let length = gone + octile(here, next);
            if nodes.reach(id(next), length, at) {
                open.push(Open { estimate: length + octile(next, to), id: id(next) });
            }
        });
    }
    None
}

fn octile(p: Pixel, q: Pixel) -> f64 {
    let (x, y) = (p[0].abs_diff(q[0]) as f64, p[1].abs_diff(q[1]) as f64);
    x.max(y) + (SQRT_2 - 1.0) * x.min(y)
}

#[derive(PartialEq)]
struct Open {
    estimate: f64,
    id: u64,
}

impl Eq for Open {}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other.estimate.total_cmp(&self.estimate).then(other.id.cmp(&self.id))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// What is known of the pixels that were reached: few of many, so by hashing. Never more than half full.
struct Nodes {
    slots: Vec<Node>,
    count: usize,
}

#[derive(Clone, Copy)]
struct Node {
    id: u64,
    before: u64,
    gone: f64,
    closed: bool,
}

const EMPTY: Node = Node { id: u64::MAX, before: 0, gone: f64::INFINITY, closed: false };

impl Nodes {
    fn new() -> Self {
        Self { slots: vec![EMPTY; 1 << 12], count: 0 }
    }

    fn slot(&self, id: u64) -> usize {
        let mask = self.slots.len() - 1;
        let mut n = (id.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize & mask;
        while self.slots[n].id != id && self.slots[n].id != u64::MAX {
            n = (n + 1) & mask;
        }
        n
    }

    /// True when the pixel was not reached by as short a way before.
    fn reach(&mut self, id: u64, gone: f64, before: u64) -> bool {
        let mut n = self.slot(id);
        if self.slots[n].id == u64::MAX {
            self.count += 1;
            if 2 * self.count > self.slots.len() {
                let larger = vec![EMPTY; 2 * self.slots.len()];
                for node in std::mem::replace(&mut self.slots, larger) {
                    if node.id != u64::MAX {
                        let slot = self.slot(node.id);
                        self.slots[slot] = node;
                    }
                }
                n = self.slot(id);
            }
        }
        let node = &mut self.slots[n];
        let shorter = gone < node.gone && !node.closed;
        if shorter {
            *node = Node { id, before, gone, closed: false };
        }
        shorter
    }

    /// How far it is to a pixel and by which, the first time that this is asked.
    fn close(&mut self, id: u64) -> Option<(f64, u64)> {
        let n = self.slot(id);
        let node = &mut self.slots[n];
        (!std::mem::replace(&mut node.closed, true)).then_some((node.gone, node.before))
    }

    fn before(&self, id: u64) -> u64 {
        self.slots[self.slot(id)].before
    }
}

struct Search<'a> {
    space: &'a Layer,
    goal: Pixel,
}

impl Search<'_> {
    fn free(&self, x: i64, y: i64) -> bool {
        self.space.rows.has(x as usize, y as usize)
    }

    /// Jump points from a pixel that was reached from `before`; all around from the first.
    fn successors(&self, here: Pixel, before: Pixel, mut visit: impl FnMut(Pixel)) {
        let [x, y] = here.map(|n| n as i64);
        let [dx, dy] = [0, 1].map(|n| (here[n] as i64 - before[n] as i64).signum());
        let mut go = |step: Step| {
            let end = if step[0] != 0 && step[1] != 0 { self.slant(here, step) } else { self.straight(here, step) };
            if let Some(end) = end {
                visit(end);
            }
        };
        if dx == 0 && dy == 0 {
            for step in [[1, 0], [0, 1], [-1, 0], [0, -1], [1, 1], [-1, 1], [-1, -1], [1, -1]] {
                go(step);
            }
        } else if dx != 0 && dy != 0 {
            for step in [[dx, 0], [0, dy], [dx, dy]] {
                go(step);
            }
        } else {
            go([dx, dy]);
            // To the side only round what ended there: elsewhere an earlier turn was as short.
            for side in [1, -1] {
                let beside = if dx != 0 { [0, side] } else { [side, 0] };
                let (bx, by) = (x + beside[0], y + beside[1]);
                if self.free(bx, by) && !self.free(bx - dx, by - dy) {
                    go(beside);
                    go([dx + beside[0], dy + beside[1]]);
                }
            }
        }
    }

    fn straight(&self, [x, y]: Pixel, [dx, dy]: Step) -> Option<Pixel> {
        if dx != 0 {
            let goal = (self.goal[1] == y).then_some(self.goal[0]);
            scan(&self.space.rows, x, y, dx > 0, goal).map(|x| [x, y])
        } else {
            let goal = (self.goal[0] == x).then_some(self.goal[1]);
            scan(&self.space.columns, y, x, dy > 0, goal).map(|y| [x, y])
        }
    }

    fn slant(&self, from: Pixel, step: Step) -> Option<Pixel> {
        let [mut x, mut y] = from.map(|n| n as i64);
        let [dx, dy] = step;
        loop {
            if !(self.free(x + dx, y) && self.free(x, y + dy) && self.free(x + dx, y + dy)) {
                return None;
            }
            (x, y) = (x + dx, y + dy);
            let here = [x as usize, y as usize];
            if here == self.goal || self.straight(here, [dx, 0]).is_some() || self.straight(here, [0, dy]).is_some() {
                return Some(here);
            }
        }
    }
}

/// Along row `y` from `x`: the goal, or the first pixel beside which something has just ended; none when the way ends
/// before.
fn scan(bits: &Bits, x: usize, y: usize, forwards: bool, goal: Option<usize>) -> Option<usize> {
    let (row, below, above) = (bits.row(y), bits.row(y - 1), bits.row(y + 1));
    let mut n = x / 64;
    let at = x % 64;
    let end;
    if forwards {
        let mut mask = if at == 63 { 0 } else { u64::MAX << (at + 1) };
        loop {
            let carry = |side: &[u64]| side[n] << 1 | if n > 0 { side[n - 1] >> 63 } else { 0 };
            let opens = below[n] & !carry(below) | above[n] & !carry(above);
            let stop = (!row[n] | opens) & mask;
            if stop != 0 {
                end = n * 64 + stop.trailing_zeros() as usize;
                break;
            }
            n += 1;
            if n == bits.stride {
                return goal.filter(|&goal| goal > x);
            }
            mask = u64::MAX;
        }
        if let Some(goal) = goal
            && goal > x
            && goal <= end
            && bits.has(goal, y)
        {
            return Some(goal);
        }
    } else {
        let mut mask = (1u64 << at) - 1;
        loop {
            let carry = |side: &[u64]| side[n] >> 1 | if n + 1 < bits.stride { side[n + 1] << 63 } else { 0 };
            let opens = below[n] & !carry(below) | above[n] & !carry(above);
            let stop = (!row[n] | opens) & mask;
            if stop != 0 {
                end = n * 64 + 63 - stop.leading_zeros() as usize;
                break;
            }
            if n == 0 {
                return goal.filter(|&goal| goal < x);
            }
            n -= 1;
            mask = u64::MAX;
        }
        if let Some(goal) = goal
            && goal < x
            && goal >= end
            && bits.has(goal, y)
        {
            return Some(goal);
        }
    }
    bits.has(end, y).then_some(end)
}
