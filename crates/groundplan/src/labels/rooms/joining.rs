//! Pieces of free space are joined where the way between them is no narrower than they are.

use super::cells::Rules;
use super::gaps::Bar;
use super::leaves;
use super::openings::{Stretch, ends};
use super::raster::Raster;
use super::runs::{Run, Runs};
use crate::bands::flat_map_each;
use crate::bits::{WORD, lowest};
use crate::sets::Sets;
use std::collections::BinaryHeap;

/// How far beyond an opening the space is measured, metres, and in what steps, pixels.
const DEPTH: f64 = 2.0;
const STEP: f64 = 2.0;
/// Of two openings as wide as what they open into, the wider one goes first: so much for a metre.
const PER_METRE: f64 = 0.001;
/// Pieces this small beside others are the thickness of a wall in a doorway, and widen no space: square metres.
const DOORWAY: f64 = 1.0;
/// A piece whose outline is open for more than this share is part of what it opens into.
const OPEN: f64 = 0.6;
/// What the leaf of a door leaves open is a way of its own when it is narrower than this share of the space.
const BESIDE_LEAF: f64 = 0.5;
/// What a gate alone leads into is an aisle that ends there when it is as wide and up to so many times as long.
const LONGEST: f64 = 20.0;

/// Pieces while they are joined.
pub struct Joining<'a> {
    raster: &'a Raster,
    bars: &'a [Bar],
    rules: &'a Rules,
    stretches: &'a [Stretch],
    pieces: Runs,
    /// Pieces that are small, before they were joined.
    small: Vec<bool>,
    sets: Sets,
    /// Of each set: pixels, pixels that touch something not free, and how often it has grown.
    area: Vec<usize>,
    wall: Vec<usize>,
    age: Vec<u32>,
}

/// How open a stretch is, in the order of the most open first; ties go to the first.
#[derive(PartialEq)]
struct Openness {
    value: f64,
    stretch: usize,
    /// The ages of its two sides when it was measured.
    ages: [u32; 2],
}

impl Eq for Openness {}

impl PartialOrd for Openness {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Openness {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.value.total_cmp(&other.value).then(other.stretch.cmp(&self.stretch))
    }
}

impl<'a> Joining<'a> {
    pub fn new(
        raster: &'a Raster,
        bars: &'a [Bar],
        rules: &'a Rules,
        stretches: &'a [Stretch],
        pieces: Runs,
        count: usize,
    ) -> Self {
        let (mut area, mut wall) = (vec![0; count + 1], vec![0; count + 1]);
        for run in &pieces.all {
            area[run.number as usize] += run.len();
            wall[run.number as usize] += touching_wall(raster, run);
        }
        let least = DOORWAY / raster.resolution.powi(2);
        Self {
            raster,
            bars,
            rules,
            stretches,
            small: area.iter().enumerate().map(|(n, &count)| n > 0 && count as f64 <= least).collect(),
            area,
            wall,
            sets: Sets::new(count + 1),
            age: vec![0; count + 1],
            pieces,
        }
    }

    /// Joins all that belong together: the pieces, and for each number the name of what it is part of.
    pub fn join_all(mut self, threads: usize) -> (Runs, Vec<u32>) {
        self.join_open(threads);
        self.join_dead_ends();
        self.join_unwalled();
        self.join_beyond_leaves();
        (self.pieces, (0..self.wall.len() as u32).map(|n| self.sets.of(n)).collect())
    }

    /// The sets on both sides of a stretch.
    fn sides(&mut self, stretch: usize) -> [u32; 2] {
        self.stretches[stretch].pieces.map(|piece| self.sets.of(piece))
    }

    fn join(&mut self, [a, b]: [u32; 2]) {
        let (to, other) = if self.area[a as usize] >= self.area[b as usize] { (a, b) } else { (b, a) };
        self.sets.join(to, other);
        let (to, other) = (to as usize, other as usize);
        self.area[to] += self.area[other];
        self.wall[to] += self.wall[other];
        self.age[to] = self.age[to].max(self.age[other]) + 1;
    }

    /// Joins across the most open stretch, again and again, while there is one that parts nothing. A set that grows
    /// only makes its openings less open, so that each is measured anew only when its turn comes.
    fn join_open(&mut self, threads: usize) {
        let least = self.rules.openness;
        let all = flat_map_each(self.stretches.len(), threads, |n| [self.measure(n, least)]);
        let mut queue = BinaryHeap::from(all);
        while let Some(most) = queue.pop().filter(|most| most.value >= least) {
            let sides = self.sides(most.stretch);
            if sides[0] == sides[1] {
                continue;
            }
            if sides.map(|side| self.age[side as usize]) == most.ages {
                self.join(sides);
            } else {
                queue.push(self.measure(most.stretch, least));
            }
        }
    }

    /// Joins what only the leaf of a door, standing open, parts.
    fn join_beyond_leaves(&mut self) {
        let parting: Vec<usize> = (0..self.stretches.len())
            .filter(|&n| {
                let [one, other] = self.sides(n);
                one != other
            })
            .collect();
        let opening = |n: &usize| {
            let Stretch { bar, pixels, .. } = &self.stretches[*n];
            Bar::new(ends(self.raster, &self.bars[*bar], pixels))
        };
        let openings: Vec<Bar> = parting.iter().map(opening).collect();
        for (n, is_beyond) in parting.into_iter().zip(leaves::beyond(&openings, self.raster)) {
            let sides = self.sides(n);
            if is_beyond && sides[0] != sides[1] && self.measure(n, BESIDE_LEAF).value >= BESIDE_LEAF {
                self.join(sides);
            }
        }
    }

    /// Joins what has more openings than walls to what it opens into most, the most open first.
    fn join_unwalled(&mut self) {
        // Of each set its stretches, and how many of their pixels part it from others.
        let mut own: Vec<Vec<u32>> = vec![Vec::new(); self.wall.len()];
        let mut open = vec![0usize; self.wall.len()];
        for n in 0..self.stretches.len() {
            let sides = self.sides(n);
            if sides[0] != sides[1] {
                for side in sides {
                    own[side as usize].push(n as u32);
                    open[side as usize] += self.stretches[n].pixels.len();
                }
            }
        }
        let is_unwalled = |open: usize, wall: usize| open as f64 / (open + wall).max(1) as f64 > OPEN;
        let mut unwalled: Vec<bool> =
            open.iter().zip(&self.wall).map(|(open, wall)| is_unwalled(*open, *wall)).collect();
        let mut queue = BinaryHeap::new();
        for n in 0..self.stretches.len() {
            let sides = self.sides(n);
            if sides[0] != sides[1] && sides.iter().any(|&side| unwalled[side as usize]) {
                queue.push(self.measure(n, 0.0));
            }
        }
        while let Some(most) = queue.pop() {
            let sides = self.sides(most.stretch);
            if sides[0] == sides[1] || !sides.iter().any(|&side| unwalled[side as usize]) {
                continue;
            }
            if sides.map(|side| self.age[side as usize]) != most.ages {
                queue.push(self.measure(most.stretch, 0.0));
                continue;
            }
            let [mut few, mut many] = sides.map(|side| std::mem::take(&mut own[side as usize]));
            if few.len() > many.len() {
                std::mem::swap(&mut few, &mut many);
            }
            let mut between = 0;
            for &n in &few {
                let mut pair = self.sides(n as usize);
                pair.sort_unstable();
                if pair == [sides[0].min(sides[1]), sides[0].max(sides[1])] {
                    between += self.stretches[n as usize].pixels.len();
                }
            }
            self.join(sides);
            let to = self.sets.of(sides[0]) as usize;
            let [a, b] = sides.map(|side| side as usize);
            open[to] = open[a] + open[b] - 2 * between;
            let grown = is_unwalled(open[to], self.wall[to]);
            let before = [unwalled[a], unwalled[b]];
            many.extend(few);
            if grown && before != [true; 2] {
                many.retain(|&n| self.sides(n as usize)[0] != self.sides(n as usize)[1]);
                for &n in &many {
                    queue.push(self.measure(n as usize, 0.0));
                }
            }
            unwalled[to] = grown;
            own[to] = many;
        }
    }

    /// Joins what a gate alone leads into and is no wider than it: no passage, which leads on.
    fn join_dead_ends(&mut self) {
        // What each set opens into; itself where that is several.
        let mut into: Vec<Option<u32>> = vec![None; self.wall.len()];
        let parting: Vec<(usize, [u32; 2])> =
            (0..self.stretches.len()).map(|n| (n, self.sides(n))).filter(|(_, [one, other])| one != other).collect();
        for &(_, [one, other]) in &parting {
            for [own, other] in [[one, other], [other, one]] {
                let known = &mut into[own as usize];
                *known = Some(if known.is_none_or(|known| known == other) { other } else { own });
            }
        }
        let is_dead_end = |&(n, sides): &(usize, [u32; 2])| {
            let [one, other] = self.beyond_both(n, sides, f64::INFINITY);
            let tighter = usize::from(other < one);
            let [own, next] = [sides[tighter], sides[1 - tighter]];
            let width = self.width(n);
            into[own as usize] == Some(next)
                && self.area[own as usize] as f64 <= LONGEST * width * width
                && width >= self.rules.openness * one.min(other)
        };
        let is_gate = |(n, _): &(usize, [u32; 2])| self.bars[self.stretches[*n].bar].is_gate();
        let dead_ends: Vec<_> = parting.into_iter().filter(is_gate).filter(is_dead_end).collect();
        for (n, _) in dead_ends {
            let sides = self.sides(n);
            if sides[0] != sides[1] {
                self.join(sides);
            }
        }
    }

    /// How wide a stretch is, pixels: of a slanted bar it has fewer than it is long.
    fn width(&self, stretch: usize) -> f64 {
        let Stretch { bar, pixels, .. } = &self.stretches[stretch];
        self.bars[*bar].length().min(std::f64::consts::SQRT_2 * pixels.len() as f64)
    }

    /// The width of a stretch over the width of the space on its tighter side; what is less than `least` only so far that
    /// this is known.
    fn measure(&self, stretch: usize, least: f64) -> Openness {
        let sides = self.stretches[stretch].pieces.map(|piece| self.sets.name(piece));
        let ages = sides.map(|side| self.age[side as usize]);
        let width = self.width(stretch);
        let tie = PER_METRE * width * self.raster.resolution;
        let area = sides.map(|side| self.area[side as usize]).into_iter().min().unwrap_or(0) as f64;
        // What is too small for a region goes first of all.
        let small = area * self.raster.resolution.powi(2) <= self.rules.least_area;
        // A pixel more than it takes, for what floats round.
        let enough = if small || least <= tie { f64::INFINITY } else { width / (least - tie) + 1.0 };
        let [one, other] = self.beyond_both(stretch, sides, enough);
        // What leads on from a gate as wide as it is a passage, and another region than the hall.
        let is_passage = self.bars[self.stretches[stretch].bar].is_gate()
            && self.goes_on(stretch, if one <= other { (sides[0], 1.0) } else { (sides[1], -1.0) }, width);
        let beyond = if is_passage { one.max(other) } else { one.min(other) };
        let share = if beyond > 0.0 { (width / beyond).min(1.0) } else { 1.0 };
        Openness { value: share + tie + if small { 10.0 } else { 0.0 }, stretch, ages }
    }

    /// How wide the sets on both sides are beyond a stretch, pixels, or as much as is enough; beside what is no gate the one of
    /// more pixels only as far as it may be the tighter.
    fn beyond_both(&self, stretch: usize, sides: [u32; 2], enough: f64) -> [f64; 2] {
        let both = [(sides[0], 1.0), (sides[1], -1.0)];
        // The smaller one first: of the other it is enough to know that it is as wide.
        let first = usize::from(self.area[sides[1] as usize] < self.area[sides[0] as usize]);
        let one = self.beyond(stretch, both[first], enough);
        let is_gate = self.bars[self.stretches[stretch].bar].is_gate();
        let other = self.beyond(stretch, both[1 - first], if is_gate { enough } else { one });
        if first == 0 { [one, other] } else { [other, one] }
    }

    /// True when a set goes on so far straight beyond a stretch, pixels.
    fn goes_on(&self, stretch: usize, (set, side): (u32, f64), depth: f64) -> bool {
        let Stretch { bar, pixels, .. } = &self.stretches[stretch];
        let [ux, uy] = self.bars[*bar].heading();
        let [x, y] = self.raster.place(pixels[pixels.len() / 2]);
        let is_in = |n: usize| {
            let pixel = self.raster.at([x - uy * side * n as f64, y + ux * side * n as f64]);
            pixel.is_some_and(|pixel| {
                let run = self.pieces.run_at(pixel);
                run.map_or(self.raster.free.get(pixel), |run| self.sets.name(run.number) == set)
            })
        };
        (STEP as usize..=depth as usize).all(is_in)
    }

    /// How wide a set is beyond a stretch, at its widest within [`DEPTH`], measured along the bar, pixels; or as much
    /// as is enough.
    fn beyond(&self, stretch: usize, (set, side): (u32, f64), enough: f64) -> f64 {
        let Stretch { bar, pixels, .. } = &self.stretches[stretch];
        let [ux, uy] = self.bars[*bar].heading();
        let [x, y] = self.raster.place(pixels[pixels.len() / 2]);
        let deepest = self.raster.pixels(DEPTH);
        // Mostly the piece is the one that was asked for last, and along a row the run too.
        let mut run = Run::new(&(0..0), 0);
        let mut last = (0, false);
        // Walls' thickness in a doorway counts only for the doorway's own piece, `own`.
        let mut is_in = |place: [f64; 2], own: Option<u32>| {
            let pixel = self.raster.at(place)?;
            if !run.pixels().contains(&pixel) {
                let Some(&own) = self.pieces.run_at(pixel) else {
                    return self.raster.free.get(pixel).then_some(0);
                };
                run = own;
            }
            let number = run.number;
            if number != last.0 {
                last = (number, self.sets.name(number) == set);
            }
            let counts = || own.is_none_or(|own| own == number) || !self.small[number as usize];
            (last.1 && counts()).then_some(number)
        };
        let mut widest = 0.0_f64;
        let mut depth = STEP;
        while depth <= deepest.max(STEP) && widest < enough {
            let [px, py] = [x - uy * side * depth, y + ux * side * depth];
            if let Some(own) = is_in([px, py], None) {
                // How far it goes on, or less where that is not so far that it counts.
                let mut reach = |way: f64, counts: f64| -> f64 {
                    let mut goes_on = |n: f64| is_in([px + way * ux * n, py + way * uy * n], Some(own)).is_some();
                    let mut n = 1.0;
                    if counts < 1.0 || goes_on(counts) {
                        while n <= enough && goes_on(n) {
                            n += 1.0;
                        }
                    }
                    n
                };
                let ahead = reach(1.0, 0.0);
                widest = widest.max(ahead + reach(-1.0, widest + 1.0 - ahead) - 1.0);
            } else if depth > 2.0 * STEP {
                break;
            }
            depth += STEP;
        }
        widest
    }
}

/// How many pixels of a run have a side on what is not free.
fn touching_wall(raster: &Raster, run: &Run) -> usize {
    let (free, pixels) = (&raster.free, run.pixels());
    let part = |at: usize| {
        let around = raster.sides(at).map(|beside| free.word(beside));
        (!(around[0] & around[1] & around[2] & around[3]) & lowest(pixels.end - at)).count_ones() as usize
    };
    pixels.clone().step_by(WORD).map(part).sum()
}
