//! II-D: O(edge), and where on the edges it lies, by the edge pixels that cover them.

use crate::arrangement::Arrangement;
use crate::bits::runs;
use crate::directions::Directions;
use crate::gradients::Gradients;
use crate::grid::{Frame, tidy};
use crate::lines::Lines;
use crate::parameters::Parameters;
use crate::radiograms::weight;

/// Pixels this near to a line lie on it even when the line is sharper.
const NEAREST_PIXELS: f64 = 1.5;
/// Pixels further than this from a line do not lie on it even when the line is wider.
const FARTHEST_PIXELS: f64 = 3.0;
/// A pixel covers this much of a line to both sides, so that the steps of a staircase leave no gaps.
const COVER_PIXELS: f64 = 0.75;

/// How much of each edge is covered, and where.
pub struct Covered {
    pub shares: Vec<f64>,
    pub runs: Vec<[f64; 2]>,
    pub offsets: Vec<u32>,
}

/// O(edge): the edge pixels that lie on each line mark the parts of its length that they cover.
pub fn cover_edges(
    frame: &Frame,
    arrangement: &Arrangement,
    directions: &Directions,
    lines: &Lines,
    gradients: &Gradients,
    parameters: &Parameters,
) -> Covered {
    let tolerance = parameters.radiograms_tolerance_deg.to_radians();
    let mut shares = vec![0.0; arrangement.edges.len()];
    let mut by_line: Vec<Vec<(u32, [f64; 2])>> = vec![Vec::new(); lines.len()];
    for (direction, &angle) in directions.angles.iter().enumerate() {
        let angle = frame.angle_to_grid(angle);
        let (cos, sin) = (libm::cos(angle), libm::sin(angle));
        let mut members: Vec<(f64, f64, usize)> = (0..lines.len())
            .filter(|&n| lines.directions[n] as usize == direction && !arrangement.line_edges[n].is_empty())
            .map(|n| {
                let line = arrangement.lines[n];
                let scale = (((line.a as f64).powi(2)) + (line.b as f64).powi(2)).sqrt();
                let reach = (lines.widths[n] / frame.resolution).clamp(NEAREST_PIXELS, FARTHEST_PIXELS);
                (line.c as f64 / scale, reach, n)
            })
            .collect();
        members.sort_by(|p, q| p.0.total_cmp(&q.0));
        let diagonal = (frame.width + frame.height) as f64;
        let span = 2 * diagonal.ceil() as usize + 4;
        let mut covered: Vec<Vec<u64>> = vec![Vec::new(); members.len()];
        for ((pixel, &along), &magnitude) in gradients.pixels.iter().zip(&gradients.angles).zip(&gradients.magnitudes) {
            if weight(f64::from(along), magnitude, angle, tolerance) == 0 {
                continue;
            }
            let (x, y) = (f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
            let offset = y * cos - x * sin;
            let place = x * cos + y * sin + diagonal;
            let first = members.partition_point(|m| m.0 < offset - FARTHEST_PIXELS);
            for (m, member) in members.iter().enumerate().skip(first) {
                if member.0 > offset + FARTHEST_PIXELS {
                    break;
                }
                if (member.0 - offset).abs() <= member.1 {
                    let bits = &mut covered[m];
                    if bits.is_empty() {
                        bits.resize(span.div_ceil(64), 0);
                    }
                    for bin in [place - COVER_PIXELS, place, place + COVER_PIXELS] {
                        let bin = bin.max(0.0) as usize;
                        bits[bin / 64] |= 1 << (bin % 64);
                    }
                }
            }
        }
        for (bits, member) in covered.iter().zip(&members) {
            if bits.is_empty() {
                continue;
            }
            let sums = counts(bits);
            for edge in arrangement.line_edges[member.2].clone() {
                let ends = arrangement.edges[edge as usize].map(|v| {
                    let [x, y] = arrangement.vertices[v as usize];
                    x * cos + y * sin + diagonal
                });
                let (from, to) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                // Whole bins within; a shorter edge is judged by the bin that its middle lies in.
                let (mut first, mut last) = (from.round() as usize, to.round() as usize);
                if first == last {
                    first = f64::midpoint(from, to) as usize;
                    last = first + 1;
                }
                let count = count_below(bits, &sums, last) - count_below(bits, &sums, first);
                shares[edge as usize] = tidy(f64::from(count) / (last - first) as f64);
                let metres = |bin: usize| {
                    let place = if bin == first {
                        from
                    } else if bin == last {
                        to
                    } else {
                        bin as f64
                    };
                    tidy((place - ends[0]).abs() * frame.resolution)
                };
                let found = &mut by_line[member.2];
                let before = found.len();
                found.extend(runs(bits, first..last, true).map(|run| {
                    let (a, b) = (metres(run.start), metres(run.end));
                    (edge, [a.min(b), a.max(b)])
                }));
                if ends[0] > ends[1] {
                    found[before..].reverse();
                }
            }
        }
    }
    // The edges are numbered line after line.
    let mut offsets = vec![0; arrangement.edges.len() + 1];
    by_line.iter().flatten().for_each(|&(edge, _)| offsets[edge as usize + 1] += 1);
    for edge in 1..offsets.len() {
        offsets[edge] += offsets[edge - 1];
    }
    Covered { shares, runs: by_line.into_iter().flatten().map(|(_, run)| run).collect(), offsets }
}

/// Set bits before each word.
fn counts(bits: &[u64]) -> Vec<u32> {
    let mut sum = 0;
    bits.iter()
        .map(|word| {
            let before = sum;
            sum += word.count_ones();
            before
        })
        .collect()
}

/// Set bits before bit `n`.
fn count_below(bits: &[u64], sums: &[u32], n: usize) -> u32 {
    let word = (n / 64).min(bits.len() - 1);
    let rest = if n / 64 >= bits.len() { u64::MAX } else { (1u64 << (n % 64)) - 1 };
    sums[word] + (bits[word] & rest).count_ones()
}
