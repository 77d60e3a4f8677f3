//! Gaps in walls: where a line of the map is free between structure that lies along it.

use super::super::Evidence;
use super::super::recall::Key;
use super::super::view::patches::Patches;
use super::islands::Spans;
use super::raster::Raster;
use crate::bands::map_each;
use crate::ends::around;
use crate::gradients;
use crate::grid::{Frame, angle_between};
use crate::on_line::{self, OnLine};
use crate::subdivision::distance;
use std::ops::Range;

/// A straight closure of a gap, jamb to jamb, in the raster's places; both ends lie in free space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    pub ends: [[f64; 2]; 2],
    /// Of one found as a gap in a wall that goes on along its line on both sides, on which of these it is long.
    pub gate: Option<[bool; 2]>,
}

impl Bar {
    pub fn new(ends: [[f64; 2]; 2]) -> Self {
        Self { ends, gate: None }
    }

    /// Pixels.
    pub fn length(&self) -> f64 {
        distance(self.ends[0], self.ends[1])
    }

    /// True when one of its jambs belongs to something solid that stands by itself.
    pub fn is_at_solid(&self, raster: &Raster) -> bool {
        self.has_jamb_in(raster, &raster.islands.solid)
    }

    /// True when one of its jambs is of some pixels.
    pub fn has_jamb_in(&self, raster: &Raster, spans: &Spans) -> bool {
        let [ux, uy] = self.heading();
        let jamb = |[x, y]: [f64; 2], way: f64| {
            (1..=JAMB_PIXELS)
                .filter_map(|n| raster.at([x + way * ux * f64::from(n), y + way * uy * f64::from(n)]))
                .any(|pixel| spans.contains(pixel))
        };
        jamb(self.ends[0], -1.0) || jamb(self.ends[1], 1.0)
    }

    /// True where it was found as a gap in a wall that goes on on both sides.
    pub fn is_gate(&self) -> bool {
        self.gate.is_some()
    }

    /// True when both ends are within a distance of the other's.
    pub fn is_near(&self, other: &Self, distance: f64) -> bool {
        let near = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2) <= distance * distance;
        let ([a, b], [c, d]) = (self.ends, other.ends);
        (near(a, c) && near(b, d)) || (near(a, d) && near(b, c))
    }

    /// Points of the wall beyond its ends, as far from these as half of what must be wall there.
    pub fn flanks(&self, raster: &Raster) -> [[f64; 2]; 2] {
        let ([ux, uy], far) = (self.heading(), raster.pixels(FLANK / 2.0));
        let [p, q] = self.ends;
        [[p[0] - far * ux, p[1] - far * uy], [q[0] + far * ux, q[1] + far * uy]]
    }

    /// Unit vector from the first end to the second.
    pub fn heading(&self) -> [f64; 2] {
        let [p, q] = self.ends;
        let length = self.length().max(1e-9);
        [(q[0] - p[0]) / length, (q[1] - p[1]) / length]
    }
}

/// A line is blocked where something not free lies within so many metres of it, a pixel at least.
const NEAR: f64 = 0.1;
/// Narrower gaps are cracks, metres.
const CRACK: f64 = 0.4;
/// A wall goes on for at least so long, metres, on one side of the gap,
const WALL: f64 = 0.5;
/// and over so much of it, metres, from the gap on, edge pixels lie along the line for at least this share.
const JAMB: f64 = 0.6;
const LINED: f64 = 0.6;
/// A wall that goes on for so long, metres, on both sides of a gap, edge pixels along it for that share, parts what lies before
/// it from what lies behind, and its gap may be so many times as wide as others.
const FLANK: f64 = 1.0;
const WIDER: f64 = 2.0;
/// On one side at least it goes on for so many times the gap's width, edge pixels along it for this share of that: rows' ends
/// are as wide as the aisles between.
const LONG: f64 = 2.0;
const LINED_LONG: f64 = 0.5;
/// What is free over this share is a gap, be something small there.
const FREE: f64 = 0.9;

/// A jamb lies within so many pixels of a bar's end.
const JAMB_PIXELS: i32 = 4;

/// Gaps along every line of every direction, in the lines' order.
pub fn along_lines(evidence: &Evidence, raster: &Raster) -> Vec<Bar> {
    let frame = &evidence.grid.frame;
    let angles = &evidence.directions.angles;
    let keyed = evidence.recall.patches(evidence.grid, evidence.threads).map(|seen| Keyed {
        seen,
        free: Patches::of_bits(&raster.free, [raster.width, raster.height], evidence.threads),
        beside: near_line(frame) / raster.side as f64
            + raster.pixels(gradients::reach_across(frame.resolution, evidence.parameters)),
    });
    let along = |direction: usize| {
        let angle = angles[direction];
        let angle_on_grid = frame.angle_to_grid(angle);
        let mut members: Vec<(f64, usize)> = (0..evidence.lines.len())
            .filter(|&n| evidence.lines.directions[n] as usize == direction)
            .map(|n| (frame.offset_to_grid(angle, evidence.lines.offsets[n]), n))
            .collect();
        members.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let offsets: Vec<f64> = members.into_iter().map(|(offset, _)| offset).collect();
        let line = |offset: f64| Line::new(raster, angle_on_grid, offset);
        let key = |n: usize| keyed.as_ref().map_or(Key::default(), |keyed| keyed.key(&line(offsets[n]), offsets[n]));
        let gaps = evidence.recall.gaps.or_find_some(offsets.len(), key, |some| {
            let offsets: Vec<f64> = some.iter().map(|&n| offsets[n]).collect();
            let lined = lined(evidence, raster, angle_on_grid, &offsets);
            let widest = evidence.parameters.rooms_max_opening;
            let gaps = |(&offset, lined): (&f64, &Vec<i64>)| {
                let line = line(offset);
                let mut gaps = line.gaps(lined, widest);
                gaps.extend(line.gates(lined, WIDER * widest));
                gaps
            };
            offsets.iter().zip(&lined).map(gaps).collect()
        });
        gaps.concat()
    };
    map_each(angles.len(), evidence.threads, along).concat()
}

/// For each line, the steps along it where edge pixels lie along it, ascending.
fn lined(evidence: &Evidence, raster: &Raster, angle: f64, offsets: &[f64]) -> Vec<Vec<i64>> {
    let (cos, sin) = (libm::cos(angle), libm::sin(angle));
    let tolerance = evidence.parameters.radiograms_tolerance_deg.to_radians();
    let lines = OnLine::new(offsets, near_line(&evidence.grid.frame));
    let mut steps: Vec<Vec<i64>> = vec![Vec::new(); offsets.len()];
    evidence.gradients.iter().for_each(|(pixel, along, _)| {
        if angle_between(f64::from(along), angle) > tolerance {
            return;
        }
        let [x, y] = pixel.map(|p| f64::from(p) + 0.5);
        let (u, v) = (x * cos + y * sin, y * cos - x * sin);
        // Rounded down, without the call that it is on machines that may lack the instruction.
        let place = u / raster.side as f64;
        let step = place as i64 - i64::from(place < place as i64 as f64);
        for line in lines.at(v) {
            steps[line].push(step);
        }
    });
    for list in &mut steps {
        list.sort_unstable();
        list.dedup();
    }
    steps
}

/// Edge pixels this near to a line lie on it, pixels.
fn near_line(frame: &Frame) -> f64 {
    on_line::near(frame) / frame.resolution
}

/// Keys of what gaps are found from: of the map, and of what is free on the raster.
struct Keyed<'a> {
    seen: &'a Patches,
    free: Patches,
    /// So far beside a line lies what bears on edge pixels on it, pixels of the raster.
    beside: f64,
}

impl Keyed<'_> {
    /// The key of what gaps in a line are found from.
    fn key(&self, line: &Line, offset: f64) -> Key {
        let Line { raster, origin, step } = *line;
        let (from, to) = line.span();
        // In the raster's pixels: the lanes so far to both sides, from so far before its first step to so far beyond its last.
        let lanes = |along: f64, across: f64| {
            let start = [0, 1].map(|axis| origin[axis] + step[axis] * (from as f64 - along));
            let lane = |by: f64| [start[0] - step[1] * by, start[1] + step[0] * by];
            ([-across, across].map(lane), (to - from + 2 * along.ceil() as i64).max(0) as usize)
        };
        let (free, count) = lanes(0.0, line.near() as f64 + 1.0);
        let free = self.free.under(free, step, count);
        let (seen, count) = lanes(raster.pixels(JAMB) + self.beside, self.beside);
        let seen = self.seen.under(seen.map(|place| raster.to_grid(place)), step, count * raster.side);
        seen.key(free).number(offset).number(raster.resolution)
    }
}

/// One line, walked in steps of a pixel.
struct Line<'a> {
    raster: &'a Raster,
    /// The raster's place at step 0, and a step.
    origin: [f64; 2],
    step: [f64; 2],
}

impl<'a> Line<'a> {
    /// The line n.p = offset on the grid, in pixels, n normal to the angle.
    fn new(raster: &'a Raster, angle: f64, offset: f64) -> Self {
        let step = [libm::cos(angle), libm::sin(angle)];
        let origin = raster.of_grid([-step[1] * offset, step[0] * offset]);
        Self { raster, origin, step }
    }

    /// The middle of a step: where a line runs along the pixels, the ends of a step lie between them.
    fn place(&self, step: i64) -> [f64; 2] {
        [0, 1].map(|axis| self.origin[axis] + self.step[axis] * (step as f64 + 0.5))
    }

    /// The steps that lie on the raster: from, to.
    fn span(&self) -> (i64, i64) {
        let size = [self.raster.width as f64, self.raster.height as f64];
        let corners = [[0.0, 0.0], [size[0], 0.0], [0.0, size[1]], size];
        let along = corners.map(|c| (c[0] - self.origin[0]) * self.step[0] + (c[1] - self.origin[1]) * self.step[1]);
        let [low, high] = around(along.into_iter());
        (low.floor() as i64, high.ceil() as i64 + 1)
    }

    /// So many pixels to either side are of its band.
    fn near(&self) -> i64 {
        self.raster.pixels(NEAR).round().max(1.0) as i64
    }

    /// Free all across the line's band; outside the raster nothing is.
    fn is_free(&self, step: i64, near: i64) -> bool {
        let [x, y] = self.place(step);
        let is_free = |n: i64| {
            let place = [x - self.step[1] * n as f64, y + self.step[0] * n as f64];
            self.raster.at(place).is_some_and(|pixel| self.raster.free.get(pixel))
        };
        // What stands mostly stands on the line.
        (0..=near).all(|n| is_free(n) && (n == 0 || is_free(-n)))
    }

    /// The gaps beside which edge pixels lie along the line, at some steps in ascending order.
    fn gaps(&self, lined: &[i64], widest: f64) -> Vec<Bar> {
        let [crack, widest, wall] = [CRACK, widest, WALL].map(|metres| self.raster.pixels(metres));
        let near = self.near();
        let jamb = self.raster.pixels(JAMB).max(1.0) as i64;
        let least = (LINED * jamb as f64).ceil() as usize;
        let span = self.span();
        // Farther from such a pixel no step bears on a gap beside it.
        let reach = jamb + widest.ceil() as i64 + wall.ceil() as i64 + 2;
        let mut bars = Vec::new();
        for together in lined.chunk_by(|one, next| next - one <= 2 * reach) {
            let (first, last) = (together[0] - reach, together[together.len() - 1] + reach);
            let (from, to) = (span.0.max(first), span.1.min(last + 1));
            // A step is only looked at where a gap may begin or end there, or may lie there.
            let mut known: Vec<Option<bool>> = vec![None; (to - from).max(0) as usize];
            let mut is_free =
                |step: i64| *known[(step - from) as usize].get_or_insert_with(|| self.is_free(step, near));
            let mut gaps: Vec<[i64; 2]> = Vec::new();
            let (mut starts, mut ends) = (from + 1, from + 1);
            for pixels in together.windows(least).filter(|pixels| pixels[least - 1] - pixels[0] < jamb) {
                // Behind so many pixels one begins, and before them one ends.
                let (low, high) = (pixels[0], pixels[least - 1]);
                for start in starts.max(high + 1)..to.min(low + jamb + 1) {
                    if is_free(start) && !is_free(start - 1) {
                        let end = (start + 1..to.min(start + 1 + widest as i64)).find(|&step| !is_free(step));
                        gaps.extend(end.map(|end| [start, end]));
                    }
                }
                for end in ends.max(high + 1 - jamb)..to.min(low + 1) {
                    if !is_free(end) && is_free(end - 1) {
                        let before = (from.max(end - 1 - widest as i64)..end - 1).rev().find(|&step| !is_free(step));
                        gaps.extend(before.map(|before| [before + 1, end]));
                    }
                }
                (starts, ends) = (starts.max(low + jamb + 1), ends.max(low + 1));
            }
            gaps.sort_unstable();
            gaps.dedup();
            gaps.retain(|&[start, end]| {
                let most = wall.ceil() as usize;
                let before = (from..start).rev().take(most).take_while(|&step| !is_free(step)).count();
                let mut after = || (end..to).take(most).take_while(|&step| !is_free(step)).count();
                (end - start) as f64 >= crack && (before == most || after() == most)
            });
            bars.extend(gaps.into_iter().map(|gap| self.bar(gap, None)));
        }
        bars
    }

    /// The gaps in a wall that goes on along the line on both sides, edge pixels along it at some steps in ascending order.
    fn gates(&self, lined: &[i64], widest: f64) -> Vec<Bar> {
        let [crack, widest, flank] = [CRACK, widest, FLANK].map(|metres| self.raster.pixels(metres));
        let (near, span) = (self.near(), self.span());
        let least = (LINED * flank).ceil() as usize;
        // What lies beyond the raster is in no key.
        let on_raster = [span.0, span.1].map(|end| lined.partition_point(|step| *step < end));
        let lined = &lined[on_raster[0]..on_raster[1]];
        let is_long = |steps: Range<i64>| {
            let [from, to] = [steps.start, steps.end].map(|end| lined.partition_point(|step| *step < end));
            (to - from) as f64 >= LINED_LONG * (steps.end - steps.start) as f64
        };
        // Pieces of the wall: the first and the last of enough steps close together.
        let pieces = lined.windows(least).map(|some| [some[0], some[least - 1]]);
        let pieces = pieces.filter(|[first, last]| ((last - first) as f64) < flank);
        let (mut gates, mut wall_up_to) = (Vec::new(), None);
        for [first, last] in pieces {
            let between = wall_up_to.replace(last).map(|before: i64| before + 1..first);
            let may_be_gap = |between: &Range<i64>| {
                let length = (between.end - between.start) as f64;
                length >= crack && length <= widest + 2.0 * flank
            };
            let Some(between) = between.filter(may_be_gap) else { continue };
            let is_free = |step: &i64| self.is_free(*step, near);
            let Some((start, end)) = between.clone().find(is_free).zip(between.rev().find(is_free)) else { continue };
            let (end, width) = (end + 1, (end + 1 - start) as f64);
            let long = (LONG * width) as i64;
            let gate = [is_long(start - long..start), is_long(end..end + long)];
            if (crack..=widest).contains(&width)
                && gate.contains(&true)
                && (start..end).filter(is_free).count() as f64 >= FREE * width
            {
                gates.push(self.bar([start, end], Some(gate)));
            }
        }
        gates
    }

    fn bar(&self, [start, end]: [i64; 2], gate: Option<[bool; 2]>) -> Bar {
        Bar { ends: [self.place(start), self.place(end - 1)], gate }
    }
}
