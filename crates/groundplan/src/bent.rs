//! II-A, where drift has bent the map: what lies along one direction of the site lies along another angle in each part of
//! the map. The sharpest angle is that of the part with the longest walls; the direction is the mean over all parts.

use crate::projection::Points;
use crate::sharpness::{Sharpness, parabola, sample};
use std::collections::BTreeMap;

/// Blocks are squares of so many metres, or so many of them along the longer side of all pixels.
const BLOCK: f64 = 8.0;
const BLOCKS: f64 = 8.0;
/// So many pixels are asked, of a block at least so many, and before that fewer.
const FIRST_SAMPLE: usize = 1024;
const SAMPLE: usize = 4096;
const FEWEST: usize = 25;
/// Blocks that so much beside the angle are sharper than there, degrees, have this share of all pixels where a map is bent.
const ASIDE_DEG: f64 = 0.4;
const ASIDE: f64 = 0.33;
/// The angles that a block is asked at lie so far to both sides, in such steps, degrees.
const REACH_DEG: f64 = 5.0;
const STEP_DEG: f64 = 0.5;
/// Two angles explain this share of how the blocks are turned where a wing is: on a bent map three quarters.
const TWO: f64 = 0.9;
/// Angles of blocks side by side differ by this share of what those of any two do, or it is noise. Of so many pairs.
const ALIKE: f64 = 0.55;
const PAIRS: usize = 6;
/// Each at its own angle the blocks stand out of what lies at any by this share more than all at one.
const GAIN: f64 = 0.08;
/// The mean is taken about the last one, so often, or until it has moved by no more than this, degrees.
const ROUNDS: usize = 3;
const STILL_DEG: f64 = 0.05;

/// A block's place in columns and rows of blocks, and its pixels.
type Block = ([usize; 2], Points);

/// The mean angle of what lies about the sharpest one, radians, where that differs from block to block as on a bent map: by
/// little from one to the next, by more across the map. Else nothing. Of a map that is known to be bent it is enough that
/// each block is sharper at its own angle.
pub(crate) fn mean(pixels: &Points, angle: f64, resolution: f64, is_known: bool) -> Option<f64> {
    let side = (BLOCK / resolution).max(pixels.extent() / BLOCKS);
    if pixels.len() == 0 || !are_aside(&sample(pixels, FIRST_SAMPLE), angle, side) {
        return None;
    }
    let blocks: Vec<Block> = sample(pixels, SAMPLE).blocks(side).filter(|(_, block)| block.len() >= FEWEST).collect();
    let turns = Turns::about(angle, &blocks);
    if !turns.are_sharper() || !is_known && (!turns.are_alike() || turns.are_two()) {
        return None;
    }
    let mut mean = angle + turns.mean();
    for _ in 1..ROUNDS {
        let turn = Turns::about(mean, &blocks).mean();
        mean += turn;
        if turn.abs() <= STILL_DEG.to_radians() {
            break;
        }
    }
    Some(mean)
}

/// True when many of some pixels are in blocks that are sharper a little beside an angle than there.
fn are_aside(pixels: &Points, angle: f64, side: f64) -> bool {
    let aside = ASIDE_DEG.to_radians();
    let is_aside = |block: &Points| {
        let mut own = Sharpness::new(block, 1);
        let here = own.roughly_at(angle);
        [angle - aside, angle + aside].into_iter().any(|angle| own.roughly_at(angle) > here)
    };
    let count: usize = pixels.blocks(side).filter(|(_, block)| is_aside(block)).map(|(_, block)| block.len()).sum();
    count as f64 >= ASIDE * pixels.len() as f64
}

/// By how much blocks are turned against an angle.
struct Turns {
    /// By place: the turn, and how far the block stands out there of what it is at any angle.
    own: BTreeMap<[usize; 2], (f64, f64)>,
    /// How far all stand out, each at its own angle, and all at the one.
    out: [f64; 2],
}

impl Turns {
    fn about(angle: f64, blocks: &[Block]) -> Self {
        let (mut own, mut out) = (BTreeMap::new(), [0.0; 2]);
        let step = STEP_DEG.to_radians();
        let steps = (REACH_DEG / STEP_DEG).round() as i32;
        for (place, block) in blocks {
            let mut sharpness = Sharpness::new(block, 1);
            let values: Vec<f64> = (-steps..=steps).map(|n| sharpness.finely_at(angle + f64::from(n) * step)).collect();
            let best = (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or(0);
            // What goes on beyond lies along another direction.
            if best == 0 || best + 1 == values.len() {
                continue;
            }
            let top = values[best];
            let usual = *values.clone().select_nth_unstable_by(values.len() / 2, f64::total_cmp).1;
            let turn = (best as f64 - f64::from(steps)) * step;
            let [left, middle, right] = [-0.5, 0.0, 0.5].map(|part| sharpness.finely_at(angle + turn + part * step));
            let turn = turn + parabola(left, middle, right) * step / 2.0;
            own.insert(*place, (turn, top - usual));
            out[0] += top - usual;
            out[1] += values[steps as usize] - usual;
        }
        Self { own, out }
    }

    fn mean(&self) -> f64 {
        let [sum, weight] =
            self.own.values().fold([0.0; 2], |[sum, all], (turn, weight)| [sum + turn * weight, all + weight]);
        if weight > 0.0 { sum / weight } else { 0.0 }
    }

    /// True where two angles explain nearly all: those of a hall and of a wing, both straight.
    fn are_two(&self) -> bool {
        let mean = self.mean();
        let mut turns: Vec<(f64, f64)> = self.own.values().map(|(turn, weight)| (turn - mean, *weight)).collect();
        turns.sort_by(|a, b| a.0.total_cmp(&b.0));
        let sum = |some: &[(f64, f64)]| some.iter().map(|(turn, weight)| turn * weight).sum::<f64>();
        let weight = |some: &[(f64, f64)]| some.iter().map(|(_, weight)| weight).sum::<f64>();
        let spread: f64 = turns.iter().map(|(turn, weight)| weight * turn.powi(2)).sum();
        let explained = |n: usize| {
            let (low, high) = turns.split_at(n);
            [low, high].map(|some| sum(some).powi(2) / weight(some)).into_iter().sum::<f64>()
        };
        (1..turns.len()).any(|n| explained(n) >= TWO * spread)
    }

    /// True where each block stands out more at its own angle than all at one.
    fn are_sharper(&self) -> bool {
        self.out[0] >= (1.0 + GAIN) * self.out[1]
    }

    /// True where blocks side by side are turned alike, and those farther apart are not.
    fn are_alike(&self) -> bool {
        let mean = self.mean();
        let (mut spread, mut all) = (0.0, 0.0);
        let (mut beside, mut both, mut pairs) = (0.0, 0.0, 0);
        for ([x, y], (turn, weight)) in &self.own {
            spread += weight * (turn - mean).powi(2);
            all += weight;
            for next in [[x + 1, *y], [*x, y + 1], [x + 1, y + 1], [x + 1, y.wrapping_sub(1)]] {
                if let Some((other, its)) = self.own.get(&next) {
                    beside += weight.min(*its) * (turn - other).powi(2);
                    both += weight.min(*its);
                    pairs += 1;
                }
            }
        }
        // Of two that have nothing to do with one another the difference has twice the spread.
        pairs >= PAIRS && beside * all <= ALIKE * 2.0 * spread * both
    }
}
