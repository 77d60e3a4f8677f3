//! What lies on the lines of the map seen along one direction.

use super::turned::Turned;
use crate::bits::Bits;
use crate::gradients;
use crate::grid::Frame;
use crate::labels::Evidence;
use crate::labels::recall::Key;
use crate::on_line::{self, OnLine};
use crate::radiograms::weight;
use std::sync::Arc;

/// Lines with less structure than this, metres, and than this share of a strong line's, are no sides of corridors but
/// the faces of single goods.
const STRONG: (f64, f64) = (2.0, 0.08);

/// What the edge pixels tell of the lines of a view, whatever stands on legs there.
#[derive(Default)]
pub struct Lined {
    offsets: Vec<f64>,
    /// Which of them are no lines of the map, but sides of racks on legs.
    are_sides: Vec<bool>,
    /// In which columns something lies along each, and in which any touches it.
    on: Vec<[Bits; 2]>,
}

impl Turned {
    /// Its lines, and in which columns something lies along each or touches it; racks on legs have their sides as lines.
    pub fn line(&mut self, evidence: &Evidence) {
        let frame = &evidence.grid.frame;
        let lines = evidence.lines;
        let strong = STRONG.0.min(STRONG.1 * lines.typical_amplitude());
        let mut offsets: Vec<f64> = (0..lines.len())
            .filter(|&n| lines.directions[n] as usize == self.direction && lines.amplitudes[n] >= strong)
            .map(|n| lines.offsets[n])
            .collect();
        offsets.sort_by(f64::total_cmp);
        let near = on_line::near(frame);
        let mut are_sides = vec![false; offsets.len()];
        for (offset, _) in self.grounds.sides() {
            let at = offsets.partition_point(|&other| other < offset);
            let others = &offsets[at.saturating_sub(1)..offsets.len().min(at + 1)];
            if others.iter().all(|other| (other - offset).abs() > near) {
                offsets.insert(at, offset);
                are_sides.insert(at, true);
            }
        }
        let key = |n: usize| self.key_on_line(evidence, offsets[n]);
        let on = evidence.recall.lined.or_find_some(offsets.len(), key, |some| {
            self.on_lines(evidence, &some.iter().map(|&n| offsets[n]).collect::<Vec<_>>())
        });
        let lined = Lined { offsets, are_sides, on };
        self.lie(frame, &lined);
        if !self.grounds.is_empty() {
            self.lined = Arc::new(lined);
        }
    }

    /// Takes over what is known of its lines, but for those that are sides of racks which do not stand there.
    pub fn lie(&mut self, frame: &Frame, lined: &Lined) {
        let near = on_line::near(frame);
        let sides = self.grounds.sides();
        let mut is_there: Vec<bool> = lined.are_sides.iter().map(|is_side| !is_side).collect();
        let known = OnLine::new(&lined.offsets, near);
        for (side, _) in &sides {
            is_there[known.at(*side)].fill(true);
        }
        let there: Vec<usize> = (0..is_there.len()).filter(|&n| is_there[n]).collect();
        let offsets: Vec<f64> = there.iter().map(|&n| lined.offsets[n]).collect();
        let [mut covered, mut touched] =
            [0, 1].map(|what| there.iter().map(|&n| lined.on[n][what].clone()).collect::<Vec<_>>());
        let lines = OnLine::new(&offsets, near);
        for (offset, along) in sides {
            for line in lines.at(offset) {
                for bits in [&mut covered[line], &mut touched[line]] {
                    bits.fill(self.columns(along));
                }
            }
        }
        self.offsets = Arc::new(offsets);
        (self.covered, self.touched) = (Arc::new(covered), Arc::new(touched));
    }

    /// The key of all edge pixels on a line, where what is found is kept.
    pub fn key_on_line(&self, evidence: &Evidence, offset: f64) -> Key {
        let Some(patches) = evidence.recall.patches(evidence.grid, evidence.threads) else { return Key::default() };
        let frame = &evidence.grid.frame;
        // And the pixels around that bear on them.
        let beside = on_line::near(frame) + gradients::reach_across(frame.resolution, evidence.parameters);
        let at = |u: f64, v: f64| frame.to_pixels(self.to_map([self.start[0] + u, v]));
        let lanes = [offset - beside, offset + beside].map(|v| at(0.0, v));
        let next = at(self.cell, offset - beside);
        let step = [0, 1].map(|axis| next[axis] - lanes[0][axis]);
        let numbers = [self.angle, self.cell, self.start[0], offset];
        numbers.into_iter().fold(patches.under(lanes, step, self.size[0]), Key::number)
    }

    /// In which columns edge pixels on some lines lie along them, and in which any do.
    fn on_lines(&self, evidence: &Evidence, offsets: &[f64]) -> Vec<[Bits; 2]> {
        let frame = &evidence.grid.frame;
        let lines = OnLine::new(offsets, on_line::near(frame));
        let mut found = vec![[Bits::new(self.size[0]), Bits::new(self.size[0])]; offsets.len()];
        let tolerance = evidence.parameters.radiograms_tolerance_deg.to_radians();
        let on_grid = frame.angle_to_grid(self.angle);
        evidence.gradients.iter().for_each(|(pixel, along, magnitude)| {
            let [u, v] = self.place(frame.to_metres(pixel.map(|p| f64::from(p) + 0.5)));
            let on = lines.at(v);
            if on.is_empty() {
                return;
            }
            let lies = weight(f64::from(along), magnitude, on_grid, tolerance) > 0;
            let column = self.column(u);
            for [covered, touched] in &mut found[on] {
                touched.insert(column);
                if lies {
                    covered.insert(column);
                }
            }
        });
        found
    }
}
