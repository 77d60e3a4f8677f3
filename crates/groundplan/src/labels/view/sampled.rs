//! The cells of the map seen along one direction: how many of each one's samples are blocked or occupied.

use super::look::{Ahead, BLOCKED, LANES, Look, OCCUPIED, between_rays};
use super::patches::Patches;
use super::summed::Part;
use super::sums::{Cells, Source, Told};
use super::turned::Turned;
use crate::grid::Frame;
use crate::labels::Scene;
use crate::labels::recall::Key;
use std::ops::Range;

/// Cells that are kept around what was seen: what stands in one bars those beside it.
const SPARE: usize = 2;
/// So many cells of one row after another are looked at together: across the map's rows these take many times the room
/// that the processor has at hand.
const TOGETHER: usize = 512;

impl Turned {
    /// The samples that are blocked or occupied in each cell; all cells may be known, row after row, but for the racks on
    /// legs.
    pub(super) fn look_at(&self, scene: &Scene, look: &Look, known: Option<&[u8]>) -> (Cells, Vec<Told>) {
        let samples = self.samples as usize;
        let frame = &scene.grid.frame;
        let is_fine = self.is_fine(frame);
        let (origin, steps) = self.samples_on(frame);
        let place = |a: f64, b: f64| [0, 1].map(|axis| origin[axis] + a * steps[0][axis] + b * steps[1][axis]);
        // Where samples are pixels apart, the staircase of a wall one pixel thick has no gap in lanes of two pixels, and no
        // pixel lies between so many looks along and across a cell.
        let pixels = (self.cell / frame.resolution).round() as usize;
        let thin = pixels.div_ceil(2).clamp(samples, u32::BITS as usize);
        let looks = pixels.next_multiple_of(thin);
        let ahead = if known.is_none() || is_fine { self.ahead(frame, look) } else { Ahead::default() };
        let make = |rows: Range<usize>, first: usize, cells: &mut [u8]| {
            let width = cells.len() / rows.len();
            if known.is_none() {
                self.look_along(frame, look, &ahead, rows.clone(), first, cells);
            }
            for (n, row) in rows.zip(cells.chunks_mut(width.max(1))) {
                if let Some(cells) = known {
                    row.copy_from_slice(&cells[n * self.size[0] + first..][..width]);
                }
                if is_fine {
                    let each = f64::from(self.samples) / looks as f64;
                    let step = steps[0].map(|step| step * each);
                    add_thin(row, [thin, looks], |k, stands, bit| {
                        let lane = place(0.5 * each, (n * samples) as f64 + (k as f64 + 0.5) * each);
                        look.mark(lane, step, &ahead, [looks, first], bit, stands);
                    });
                    between_rays(row, self.samples.pow(2) as u8);
                }
                self.take(n, first, row);
            }
        };
        let patches = scene.recall.patches(scene.grid, scene.threads);
        let key = |rows: Range<usize>| {
            let lanes = [rows.start, rows.end].map(|n| place(0.0, (n * samples) as f64));
            let under = |patches: &Patches| patches.under(lanes, steps[0], self.size[0] * samples);
            let key = patches.map_or(Key::default(), under).with(rows.len() as u64).with(samples as u64);
            self.key_of_grounds(key, &rows)
        };
        let (seen, recall) = (self.seen(frame, look), scene.recall);
        Cells::new(
            self.size,
            self.samples.pow(2) as u16,
            seen,
            Source { make, key, known: &self.known },
            recall,
            scene.threads,
        )
    }

    /// The samples that are blocked or occupied in the cells of some rows, from some column on.
    pub(super) fn look_along(
        &self,
        frame: &Frame,
        look: &Look,
        ahead: &Ahead,
        rows: Range<usize>,
        first: usize,
        cells: &mut [u8],
    ) {
        let (samples, width) = (self.samples as usize, cells.len() / rows.len());
        let (origin, steps) = self.samples_on(frame);
        let place = |b: f64| [0, 1].map(|axis| origin[axis] + 0.5 * steps[0][axis] + b * steps[1][axis]);
        for from in (0..width).step_by(TOGETHER) {
            for (n, row) in rows.clone().zip(cells.chunks_mut(width)) {
                let lanes: [[f64; 2]; LANES] = std::array::from_fn(|j| place((n * samples + j) as f64 + 0.5));
                let to = width.min(from + TOGETHER);
                look.cells(&lanes[..samples], steps[0], ahead, first + from, &mut row[from..to]);
            }
        }
    }

    /// How far the map is alike along the view.
    pub(super) fn ahead(&self, frame: &Frame, look: &Look) -> Ahead {
        look.ahead(self.samples_on(frame).1[0])
    }

    /// Whether some pixels lie between samples.
    pub(super) fn is_fine(&self, frame: &Frame) -> bool {
        self.cell / f64::from(self.samples) > 1.1 * frame.resolution
    }

    /// On the grid, in pixels: the lower corner of the first sample, and the steps to the next one along and across.
    fn samples_on(&self, frame: &Frame) -> ([f64; 2], [[f64; 2]; 2]) {
        let sample = self.cell / f64::from(self.samples);
        let at = |u: f64, v: f64| frame.to_pixels(self.to_map([self.start[0] + u, self.start[1] + v]));
        let (origin, along, across) = (at(0.0, 0.0), at(sample, 0.0), at(0.0, sample));
        (origin, [along, across].map(|p| [0, 1].map(|axis| p[axis] - origin[axis])))
    }

    /// The part of the view in which something was seen of the map, and a few cells more.
    fn seen(&self, frame: &Frame, look: &Look) -> Part {
        let mut ends = [[usize::MAX, 0]; 2];
        for &corner in look.seen() {
            let place = self.place(frame.to_metres(corner));
            for axis in [0, 1] {
                let cell = ((place[axis] - self.start[axis]) / self.cell).max(0.0) as usize;
                let [from, to] = &mut ends[axis];
                (*from, *to) = ((*from).min(cell), (*to).max(cell));
            }
        }
        let part = |axis: usize| {
            let [from, to] = ends[axis];
            from.saturating_sub(SPARE).min(self.size[axis])..(to + SPARE + 1).min(self.size[axis])
        };
        Part { columns: part(0), rows: part(1) }
    }

    /// In a row of cells, from some column on, takes those whose middles lie in a rack that stands on legs.
    fn take(&self, n: usize, first: usize, row: &mut [u8]) {
        let v = self.start[1] + (n as f64 + 0.5) * self.cell;
        for [from, to] in self.grounds.at(n, v) {
            let column = |u: f64| ((u - self.start[0]) / self.cell + 0.5).max(0.0) as usize;
            let within = column(from).max(first)..column(to).min(first + row.len());
            let taken = self.samples.pow(2) as u8;
            within.for_each(|column| row[column - first] = row[column - first] & 0xf0 | taken);
        }
    }
}

/// In a row of cells, what stands across a cell, or across it and the next, and is so thin that no sample lies on it: it
/// shows in all of so many lanes, along each of which is looked so often. Single specks do not.
fn add_thin(row: &mut [u8], [lanes, looks]: [usize; 2], look_along: impl Fn(usize, &mut [u32], u32)) {
    let mut stands = vec![0; row.len() + 1];
    (0..looks).for_each(|k| look_along(k, &mut stands[..row.len()], 1 << (k * lanes / looks)));
    for (cell, near) in row.iter_mut().zip(stands.windows(2)) {
        let is_across = (near[0] | near[1]).count_ones() as usize == lanes;
        if is_across && near[0] != 0 && *cell < OCCUPIED {
            *cell = (*cell).max(BLOCKED) + OCCUPIED - BLOCKED;
        }
    }
}
