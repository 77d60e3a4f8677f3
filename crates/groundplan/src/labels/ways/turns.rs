//! Ways that lead through every other row of a place at one place along these, and through the rows between at another: one
//! walks in turns from aisle to aisle. Chance does not open every other row in line, and the rest too.

use super::through::{Common, Through};
use super::widths::are_alike;
use crate::ends::{overlap, shared};
use crate::labels::rows::sections::WIDTH;
use std::collections::BTreeMap;

/// In fewer rows together there are no turns.
const ROWS: usize = 3;
/// No more such pairs would be expected of all places: few halls have such ways.
const EXPECTED: f64 = 0.001;

/// What leads through every other row of a place and what leads through the rest, where that is as wide and so many would
/// hardly be open so anywhere by chance.
pub fn find(through: &Through) -> Vec<Common> {
    let mut chains: Vec<Common> = Vec::new();
    for n in (0..through.rows().len()).filter(|&n| !through.is_wall(n)) {
        for &ends in through.open(n).iter().filter(|ends| ends[1] - ends[0] >= WIDTH.0) {
            follow(through, &mut vec![n], ends, &mut chains);
        }
    }
    let mut by_first: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (n, chain) in chains.iter().enumerate() {
        by_first.entry(chain.rows[0]).or_default().push(n);
    }
    let mut pairs = Vec::new();
    for (n, one) in chains.iter().enumerate() {
        let beside = through.next_to(one.rows[0]).filter_map(|row| by_first.get(&row)).flatten();
        let others = beside.filter(|&&m| m > n).map(|&m| &chains[m]);
        pairs.extend(others.filter(|other| are_turns(through, one, other)).map(|other| [one, other]));
    }
    let chance = |pair: &[&Common; 2]| pair[0].chance * pair[1].chance;
    pairs.sort_by(|a, b| chance(a).total_cmp(&chance(b)));
    let mut found: Vec<Common> = Vec::new();
    for pair in pairs {
        let is_known = |one: &Common| {
            let meets =
                |way: &Common| overlap(way.ends, one.ends) > 0.0 && way.rows.iter().any(|n| one.rows.contains(n));
            found.iter().any(meets)
        };
        if !pair.into_iter().any(is_known) {
            found.extend(pair.map(Clone::clone));
        }
    }
    found
}

/// True when two lead through all rows of a place by turns, as wide as each other, and chance would hardly open them so at any
/// two places.
fn are_turns(through: &Through, one: &Common, other: &Common) -> bool {
    let is_beside = |n: usize, m: usize| through.next_to(n).any(|next| next == m);
    let last = |common: &Common| common.rows[common.rows.len() - 1];
    let is_shut = |n: &usize, at: &Common| through.open(*n).iter().all(|open| overlap(*open, at.ends) < WIDTH.0);
    let (rows, width) = (one.rows.iter().chain(&other.rows), one.width().min(other.width()));
    let places = rows.map(|&n| through.rows()[n].row.length() / width).fold(0.0, f64::max);
    one.rows.len() + other.rows.len() >= ROWS
        && is_beside(last(one), last(other))
        && one.rows.iter().all(|n| is_shut(n, other))
        && other.rows.iter().all(|n| is_shut(n, one))
        && are_alike(one.width(), other.width())
        && one.chance * other.chance * places * places <= EXPECTED
}

/// What of a stretch that is open in some rows is so in all others two further on, up to the last ones.
fn follow(through: &Through, rows: &mut Vec<usize>, ends: [f64; 2], found: &mut Vec<Common>) {
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    let middle = f64::midpoint(ends[0], ends[1]);
    if rows.len() == 1 && through.two_on(first, false, middle).next().is_some() {
        return;
    }
    let next: Vec<usize> = through.two_on(last, true, middle).collect();
    if next.is_empty() {
        if ends[1] - ends[0] <= WIDTH.1 {
            let common = Common { ends, rows: rows.clone(), chance: through.chance(rows, ends) };
            if through.is_within(&common) {
                found.push(common);
            }
        }
        return;
    }
    for n in next {
        for open in through.open(n) {
            let both = shared(ends, *open);
            if both[1] - both[0] >= WIDTH.0 {
                rows.push(n);
                follow(through, rows, both, found);
                rows.pop();
            }
        }
    }
}
