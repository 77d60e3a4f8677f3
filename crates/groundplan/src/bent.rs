//! II-A, where drift has bent the map: what lies along one direction of the site lies along another angle in each part of
//! the map. The sharpest angle is that of the part with the longest walls; the direction is the mean over all parts.

use crate::candidate::Candidate;
use crate::grid::undirected;
use crate::projection::Points;
use crate::sharpness::{Sharpness, parabola, sample};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

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
/// The angles that a block is asked at, degrees.
const STEP_DEG: f64 = 0.5;
/// Angles of blocks side by side differ by this share of what those of any two do, or it is noise. Of so many pairs.
const ALIKE: f64 = 0.65;
const PAIRS: usize = 6;
/// Each at its own angle the blocks stand out of what lies at any by this share more than all at one.
const GAIN: f64 = 0.08;
/// What is of one direction lies so much farther off than blocks are turned at most, degrees.
const SLACK_DEG: f64 = 1.0;
/// The mean is taken about the last one, so often, or until it has moved by no more than this, degrees.
const ROUNDS: usize = 3;
const STILL_DEG: f64 = 0.05;

/// What lies along a direction of a bent map.
#[derive(Clone, Copy)]
pub(crate) struct Bent {
    /// The mean angle, radians.
    pub mean: f64,
    /// How far from that it lies in a block at most.
    pub reach: f64,
}

/// The directions, without those of which others that the map has bent are too: what lies along one of these in some block,
/// or square to it, is of one direction.
pub(crate) fn joined(mut found: Vec<Candidate>) -> Vec<Candidate> {
    let mut n = 0;
    while n < found.len() {
        if let Some(Bent { mean, reach }) = found[n].bent {
            let within = reach + SLACK_DEG.to_radians();
            for (turn, first) in [(0.0, Some(n)), (FRAC_PI_2, None)] {
                join(&mut found, mean + turn, within, first);
            }
        }
        n += 1;
    }
    found
}

/// Makes one direction of all within so much of an angle, the strongest or the one that is given.
fn join(found: &mut Vec<Candidate>, angle: f64, within: f64, first: Option<usize>) {
    let off = |f: &Candidate| undirected(f.mean() - angle);
    let own: Vec<usize> = (0..found.len()).filter(|&n| off(&found[n]).abs() <= within).collect();
    let Some(first) = first.or(own.first().copied()).filter(|_| own.len() > 1) else { return };
    let metres: f64 = own.iter().map(|&n| found[n].metres).sum();
    let mean =
        angle + own.iter().map(|&n| found[n].metres * off(&found[n])).sum::<f64>() / metres.max(f64::MIN_POSITIVE);
    let reach = own.iter().map(|&n| undirected(found[n].mean() - mean).abs()).fold(0.0, f64::max);
    found[first].bent = Some(Bent { mean, reach: found[first].bent.map_or(reach, |bent| bent.reach.max(reach)) });
    let mut n = 0;
    found.retain(|_| {
        n += 1;
        n - 1 == first || !own.contains(&(n - 1))
    });
}

/// A block's place in columns and rows of blocks, and its pixels.
type Block = ([usize; 2], Points);

/// The mean angle of what lies within `reach` of the sharpest one, radians, where that differs from block to block as on a
/// bent map: by little from one to the next, by more across the map. Else nothing. Of a map that is known to be bent it is enough
/// that each block is sharper at its own angle.
pub(crate) fn find(pixels: &Points, angle: f64, reach: f64, resolution: f64, is_known: bool) -> Option<Bent> {
    let side = (BLOCK / resolution).max(pixels.extent() / BLOCKS);
    if !are_aside(&sample(pixels, FIRST_SAMPLE), angle, side) {
        return None;
    }
    let blocks: Vec<Block> = sample(pixels, SAMPLE).blocks(side).filter(|(_, block)| block.len() >= FEWEST).collect();
    let mut turns = Turns::about(angle, reach, &blocks);
    if !turns.are_sharper() || !is_known && !turns.are_alike() {
        return None;
    }
    let mut mean = angle + turns.mean();
    for _ in 1..ROUNDS {
        turns = Turns::about(mean, reach, &blocks);
        let turn = turns.mean();
        mean += turn;
        if turn.abs() <= STILL_DEG.to_radians() {
            break;
        }
    }
    Some(Bent { mean, reach: turns.most() })
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
    fn about(angle: f64, reach: f64, blocks: &[Block]) -> Self {
        let (mut own, mut out) = (BTreeMap::new(), [0.0; 2]);
        let step = STEP_DEG.to_radians();
        let steps = (reach / step).round() as i32;
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

    /// By how much the block is turned that is most.
    fn most(&self) -> f64 {
        self.own.values().map(|(turn, _)| turn.abs()).fold(0.0, f64::max)
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
