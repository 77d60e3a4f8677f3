//! II-D: O(edge), and where on the edges it lies, by the edge pixels that cover them.

use crate::arrangement::Arrangement;
use crate::bands::each;
use crate::bits::{self, WORD, lowest};
use crate::directions::Directions;
use crate::ends::{around, sorted};
use crate::gradients::Gradients;
use crate::grid::{Frame, nearest, tidy, whole};
use crate::lines::Lines;
use crate::on_line::OnLine;
use crate::parameters::Parameters;
use crate::radiograms::weight;
use std::ops::Range;

/// Pixels this near to a line lie on it even when the line is sharper.
const NEAREST_PIXELS: f64 = 1.5;
/// Pixels further than this from a line do not lie on it even when the line is wider.
const FARTHEST_PIXELS: f64 = 3.0;
/// A pixel covers this much of a line to both sides, so that the steps of a staircase leave no gaps.
const COVER_PIXELS: f64 = 0.75;
/// Of the line beyond the map's border no more than this is covered.
const BEYOND: f64 = 2.0;

/// How much of each edge is covered, and where.
pub struct Covered {
    pub shares: Vec<f64>,
    pub runs: Vec<[f64; 2]>,
    pub offsets: Vec<u32>,
}

impl Covered {
    /// What all edge pixels cover.
    pub fn new(
        frame: &Frame,
        arrangement: &Arrangement,
        directions: &Directions,
        lines: &Lines,
        gradients: &Gradients,
        parameters: &Parameters,
        threads: usize,
    ) -> Self {
        let mut coverage = Coverage::new(frame, arrangement, directions, lines, parameters);
        coverage.add(gradients, threads);
        coverage.of_edges(arrangement)
    }
}

/// The parts of each line's length that edge pixels cover which lie on it.
pub struct Coverage<'a> {
    frame: &'a Frame,
    /// Places along a line are counted from so far before its middle, pixels.
    diagonal: f64,
    tolerance: f64,
    families: Vec<Family>,
}

/// The lines of one direction, by their offsets.
struct Family {
    angle: f64,
    heading: [f64; 2],
    /// Places of the map along them, in whole words of bits.
    words: Range<usize>,
    members: Vec<Member>,
}

struct Member {
    offset: f64,
    reach: f64,
    line: usize,
    /// What is covered, bit by bit along the map; nothing until something is.
    covered: Vec<u64>,
}

impl<'a> Coverage<'a> {
    /// Of nothing yet.
    pub fn new(
        frame: &'a Frame,
        arrangement: &Arrangement,
        directions: &Directions,
        lines: &Lines,
        parameters: &Parameters,
    ) -> Self {
        let diagonal = (frame.width + frame.height) as f64;
        let family = |(direction, &angle): (usize, &f64)| {
            let angle = frame.angle_to_grid(angle);
            let mut members: Vec<Member> = (0..lines.len())
                .filter(|&n| lines.directions[n] as usize == direction && !arrangement.line_edges[n].is_empty())
                .map(|n| {
                    let line = arrangement.lines[n];
                    let scale = (((line.a as f64).powi(2)) + (line.b as f64).powi(2)).sqrt();
                    let reach = (lines.widths[n] / frame.resolution).clamp(NEAREST_PIXELS, FARTHEST_PIXELS);
                    Member { offset: line.c as f64 / scale, reach, line: n, covered: Vec::new() }
                })
                .collect();
            members.sort_by(|p, q| p.offset.total_cmp(&q.offset));
            let heading = [libm::cos(angle), libm::sin(angle)];
            let ends = [frame.width, frame.height].map(|side| [0.0, side as f64]);
            let places = ends[0].into_iter().flat_map(|x| ends[1].map(|y| x * heading[0] + y * heading[1] + diagonal));
            let [low, high] = around(places);
            // What a pixel on the border covers, and what rounding may add.
            let words = (low - BEYOND).max(0.0) as usize / WORD..(high + BEYOND) as usize / WORD + 1;
            Family { angle, heading, words, members }
        };
        Self {
            frame,
            diagonal,
            tolerance: parameters.radiograms_tolerance_deg.to_radians(),
            families: directions.angles.iter().enumerate().map(family).collect(),
        }
    }

    /// With what some edge pixels cover.
    pub fn add(&mut self, gradients: &Gradients, threads: usize) {
        let Self { diagonal, tolerance, families, .. } = self;
        each(families.iter_mut().collect(), threads, |Family { angle, heading: [cos, sin], words, members }| {
            let bins = words.start * WORD..words.end * WORD;
            let offsets: Vec<f64> = members.iter().map(|member| member.offset).collect();
            let lines = OnLine::new(&offsets, FARTHEST_PIXELS);
            gradients.iter().for_each(|(pixel, along, magnitude)| {
                if weight(f64::from(along), magnitude, *angle, *tolerance) == 0 {
                    return;
                }
                let (x, y) = (f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
                let offset = y * *cos - x * *sin;
                let place = x * *cos + y * *sin + *diagonal;
                for member in &mut members[lines.at(offset)] {
                    if (member.offset - offset).abs() <= member.reach {
                        let bits = &mut member.covered;
                        if bits.is_empty() {
                            bits.resize(words.len(), 0);
                        }
                        for bin in [place - COVER_PIXELS, place, place + COVER_PIXELS] {
                            // All pixels of the map lie within.
                            let bin = whole(bin).clamp(bins.start, bins.end - 1) - bins.start;
                            bits[bin / WORD] |= 1 << (bin % WORD);
                        }
                    }
                }
            });
        });
    }

    /// O(edge), and where on each edge it lies.
    pub fn of_edges(self, arrangement: &Arrangement) -> Covered {
        let Self { frame, diagonal, families, .. } = self;
        let mut shares = vec![0.0; arrangement.edges.len()];
        let mut runs: Vec<[f64; 2]> = Vec::new();
        let mut offsets = vec![0; arrangement.edges.len() + 1];
        // The edges are numbered line after line.
        let members =
            families.into_iter().flat_map(|f| f.members.into_iter().map(move |m| (f.heading, f.words.start * WORD, m)));
        let mut members: Vec<_> = members.filter(|(.., member)| !member.covered.is_empty()).collect();
        members.sort_by_key(|(.., member)| member.line);
        for ([cos, sin], start, member) in members {
            let bits = member.covered;
            let sums = counts(&bits);
            for edge in arrangement.line_edges[member.line].clone() {
                let ends = arrangement.edges[edge as usize].map(|v| {
                    let [x, y] = arrangement.vertices[v as usize];
                    x * cos + y * sin + diagonal
                });
                let [from, to] = sorted(ends);
                // Whole bins within; a shorter edge is judged by the bin that its middle lies in.
                let (mut first, mut last) = (nearest(from), nearest(to));
                if first == last {
                    first = f64::midpoint(from, to) as usize;
                    last = first + 1;
                }
                let count = count_below(&bits, &sums, last - start) - count_below(&bits, &sums, first - start);
                if count == 0 {
                    continue;
                }
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
                let before = runs.len();
                runs.extend(
                    bits::runs(&bits, first - start..last - start, true)
                        .map(|run| sorted([metres(start + run.start), metres(start + run.end)])),
                );
                if ends[0] > ends[1] {
                    runs[before..].reverse();
                }
                offsets[edge as usize + 1] = (runs.len() - before) as u32;
            }
        }
        for edge in 1..offsets.len() {
            offsets[edge] += offsets[edge - 1];
        }
        runs.shrink_to_fit();
        Covered { shares, runs, offsets }
    }
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
    let word = (n / WORD).min(bits.len() - 1);
    let rest = if n / WORD >= bits.len() { u64::MAX } else { lowest(n % WORD) };
    sums[word] + (bits[word] & rest).count_ones()
}
