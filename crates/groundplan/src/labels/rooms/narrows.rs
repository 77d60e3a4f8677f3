//! Narrows: where the free space is tighter than on both sides, whether or not a line leads there.

use super::super::recall::{Key, Recall};
use super::blocks::Blocks;
use super::clearance::{Clearance, Rows, within};
use super::gaps::Bar;
use super::heights::Window;
use super::raster::Raster;
use crate::bands::map_each_in;
use crate::ends::holds;
use crate::sets::Sets;
use std::ops::Range;

/// A narrow is at most this share as wide as the tighter of the two places that it joins.
const NARROW: f64 = 0.85;
/// Narrower than this, metres, is a crack, wider is no opening.
const WIDTHS: (f64, f64) = (0.3, 4.0);
/// The pixels that a narrow lies between are within so many pixels of its clearance,
const TOUCH: f64 = 1.6;
/// and so far from side by side, as the cosine of the angle between them.
const OPPOSITE: f64 = -0.3;
/// Rasters of more pixels than this are looked at square by square,
const AT_ONCE: usize = 1 << 22;
/// by squares of so many pixels, each with so much around it, metres, as a narrow and the
/// places that it joins may take.
const SQUARE: usize = 2048;
const AROUND: f64 = 8.0;
/// So many blocks are compared with their neighbours together.
const TOGETHER: usize = 16;

/// Straight closures of all narrows, in the order of the places that they part; on a large raster, square by square.
pub fn find(raster: &Raster, clearance: &Clearance, threads: usize, recall: &Recall) -> Vec<Bar> {
    let around = raster.pixels(AROUND).ceil() as usize;
    let square = if raster.len() <= AT_ONCE { raster.len() } else { SQUARE };
    let parts = |size: usize| (0..size).step_by(square).map(move |from| from..size.min(from + square));
    let squares: Vec<[Range<usize>; 2]> =
        parts(raster.height).flat_map(|rows| parts(raster.width).map(move |columns| [columns, rows.clone()])).collect();
    let wider = |range: &Range<usize>, size: usize| range.start.saturating_sub(around)..(range.end + around).min(size);
    map_each_in(squares.len(), threads, |(clearances, room): &mut (Vec<u32>, Room), n| {
        let [columns, rows] = &squares[n];
        let window = Window::new(raster, [wider(columns, raster.width), wider(rows, raster.height)]);
        let mut find = || {
            let found = if let Some(pixels) = clearance.whole() {
                Part::new(raster, pixels, &window, room).narrows()
            } else {
                let pixels = within(raster, window.clone(), std::mem::take(clearances));
                let found = Part::new(raster, &pixels, &window, room).narrows();
                *clearances = pixels.into_room();
                found
            };
            let own = found.into_iter().filter(|([x, y], _)| columns.contains(x) && rows.contains(y));
            own.map(|(_, bar)| bar).collect::<Vec<_>>()
        };
        // Clearances that are kept know what lies beyond the window.
        if clearance.whole().is_some() { find() } else { recall.narrows.or_find(|| seen(raster, &window), find) }
    })
    .concat()
}

/// What is free within a window.
fn seen(raster: &Raster, Window { columns, rows, .. }: &Window) -> Key {
    let start = Key::default().number(raster.resolution).with(raster.width as u64);
    let row = |y: usize| y * raster.width + columns.start..y * raster.width + columns.end;
    rows.clone().map(row).fold(start, |key, row| key.bits(&raster.free, row))
}

/// Room for what is made of one part after another.
#[derive(Default)]
struct Room {
    clearance: Vec<u32>,
    order: Vec<u32>,
    basins: Vec<u32>,
}

/// Part of the free space.
struct Part<'a> {
    raster: &'a Raster,
    pixels: &'a Rows,
    /// Squared clearances of narrows in pixels: from, to.
    narrows: [f64; 2],
    blocks: Blocks<'a>,
    /// For each block its basin, or none.
    basins: &'a [u32],
}

impl<'a> Part<'a> {
    fn new(raster: &'a Raster, pixels: &'a Rows, window: &Window, room: &'a mut Room) -> Self {
        let narrows = [WIDTHS.0, WIDTHS.1].map(|metres| (raster.pixels(metres) / 2.0).powi(2));
        let Room { clearance, order, basins } = room;
        let blocks = Blocks::new(raster, pixels, window, clearance);
        let least = (NARROW * NARROW * narrows[0]).ceil().max(1.0) as u32;
        find_basins(&blocks, blocks.by_clearance(least, order), basins);
        Self { raster, pixels, narrows, blocks, basins }
    }

    /// The pixel in the middle of each narrow and its closure.
    fn narrows(&self) -> Vec<([usize; 2], Bar)> {
        let basins = self.basins;
        let mut borders: Vec<(u32, u32, usize)> = Vec::new();
        for step in [1, self.blocks.width] {
            // Mostly many one after another are of one basin, or of none.
            let pairs = basins.chunks(TOGETHER).zip(basins[step..].chunks(TOGETHER)).enumerate();
            for (n, (some, others)) in pairs.filter(|(_, (some, others))| some != others) {
                for (block, (&a, &b)) in (n * TOGETHER..).zip(some.iter().zip(others)) {
                    if a != b && a != 0 && b != 0 {
                        borders.push((a.min(b), a.max(b), if a < b { block } else { block + step }));
                    }
                }
            }
        }
        borders.sort_unstable();
        borders.dedup();
        borders
            .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
            .flat_map(|border| self.openings(border))
            .filter_map(|block| self.narrowest(block))
            .collect()
    }

    /// The shortest closure through a block or one beside it, and the pixel in its middle.
    fn narrowest(&self, block: usize) -> Option<([usize; 2], Bar)> {
        let beside = std::iter::once(block).chain(self.blocks.beside(block));
        let free = beside.filter(|&block| self.blocks.clearance[block] != 0);
        let narrow = free.filter(|&block| holds(self.narrows, f64::from(self.blocks.clearance[block])));
        let closures = narrow.filter_map(|block| {
            let pixel = self.blocks.widest(block, self.pixels);
            self.closure(pixel, self.blocks.clearance[block]).map(|bar| (pixel, bar))
        });
        closures.min_by(|a, b| a.1.length().total_cmp(&b.1.length()))
    }

    /// The widest block of each connected piece of the border between two basins.
    fn openings(&self, border: &[(u32, u32, usize)]) -> Vec<usize> {
        let Blocks { clearance, width, .. } = &self.blocks;
        let mut seen = vec![false; border.len()];
        let mut found = Vec::new();
        for first in 0..border.len() {
            if seen[first] {
                continue;
            }
            seen[first] = true;
            let mut stack = vec![first];
            let mut best = border[first].2;
            while let Some(n) = stack.pop() {
                let pixel = border[n].2;
                if (clearance[pixel], usize::MAX - pixel) > (clearance[best], usize::MAX - best) {
                    best = pixel;
                }
                // A border may skip a pixel where it changes sides.
                for dy in 0..5 {
                    let row = (pixel + dy * width).wrapping_sub(2 * width + 2);
                    let from = border.partition_point(|entry| entry.2 < row);
                    for (m, _) in border.iter().enumerate().skip(from).take_while(|(_, entry)| entry.2 < row + 5) {
                        if !seen[m] {
                            seen[m] = true;
                            stack.push(m);
                        }
                    }
                }
            }
            found.push(best);
        }
        found
    }

    /// From the nearest pixel that is not free to the nearest one across.
    fn closure(&self, [x, y]: [usize; 2], clearance: u32) -> Option<Bar> {
        let Raster { width, height, ref free, .. } = *self.raster;
        let clearance = f64::from(clearance);
        let reach = clearance.sqrt() + TOUCH + (self.pixels.window.step / 2) as f64;
        let (cx, cy) = (x as i64, y as i64);
        let span = reach.ceil() as i64;
        let mut touched: Vec<(i64, i64, i64)> = Vec::with_capacity(8 * span as usize);
        for y in (cy - span).max(0)..=(cy + span).min(height as i64 - 1) {
            // What is nearer than its clearance is free.
            let across = |squared: f64| (squared - ((y - cy) * (y - cy)) as f64).max(0.0).sqrt();
            // Rounded up and down, without the calls that these are on machines that may lack the instructions.
            let (nearest, to) = (across(clearance), across(reach * reach) as i64);
            let from = nearest as i64 + i64::from(nearest > (nearest as i64) as f64);
            let row = y as usize * width;
            for (from, to) in [(cx - to, cx - from), (cx + from.max(1), cx + to)] {
                let pixels = row + from.max(0) as usize..row + (to + 1).clamp(0, width as i64) as usize;
                for pixel in free.runs(pixels, false).flatten() {
                    let x = (pixel - row) as i64;
                    let squared = (x - cx) * (x - cx) + (y - cy) * (y - cy);
                    if squared as f64 <= reach * reach {
                        touched.push((squared, x, y));
                    }
                }
            }
        }
        let &(squared, ax, ay) = touched.iter().min()?;
        let nearest = (squared as f64).sqrt();
        // What costs least, and of several the nearest.
        let mut best: Option<(f64, (i64, i64, i64))> = None;
        for &(squared, x, y) in &touched {
            // Not even on the other side.
            let product = (ax - cx) * (x - cx) + (ay - cy) * (y - cy);
            if product >= 0 {
                continue;
            }
            let distance = (squared as f64).sqrt();
            let cosine = product as f64 / (nearest * distance).max(1e-9);
            let cost = cosine + 0.3 * (distance - nearest) / nearest.max(1.0);
            if cosine < OPPOSITE && best.is_none_or(|best| (cost, (squared, x, y)) < best) {
                best = Some((cost, (squared, x, y)));
            }
        }
        let (_, (_, x, y)) = best?;
        let (p, q) = ([ax as f64, ay as f64], [x as f64, y as f64]);
        let [ux, uy] = Bar::new([p, q]).heading();
        Some(Bar::new([[p[0] + ux, p[1] + uy], [q[0] - ux, q[1] - uy]]))
    }
}

/// The basins of the clearance: places that a narrow parts from all others (watershed, with basins joined where the way
/// between them is hardly tighter than the tighter of the two). Of blocks from the widest to the tightest.
fn find_basins(blocks: &Blocks, order: &[u32], basins: &mut Vec<u32>) {
    let mut sets = Sets::new(1);
    let mut tops = vec![0u32];
    // Written, and not room that is known to hold zeros: of such each page would be made twice, when it is first read and
    // when it is first written, and all threads told so.
    basins.clear();
    basins.resize(blocks.clearance.len(), 0);
    for &block in order {
        let block = block as usize;
        let around = blocks.around(block, basins);
        // Mostly all are of one.
        let most = around.into_iter().fold(0, u32::max);
        // One less, so that none is the greatest.
        let least = around.into_iter().map(|basin| basin.wrapping_sub(1)).fold(u32::MAX, u32::min);
        if most != 0 && least == most - 1 {
            basins[block] = sets.of(most);
            continue;
        }
        let mut here = 0;
        for basin in around {
            if basin == 0 || basin == here {
                continue;
            }
            let other = sets.of(basin);
            if here == 0 || here == other {
                here = other;
                continue;
            }
            let rank = |set: u32| (tops[set as usize], u32::MAX - set);
            let (wide, tight) = if rank(here) > rank(other) { (here, other) } else { (other, here) };
            if f64::from(blocks.clearance[block]) >= NARROW * NARROW * f64::from(tops[tight as usize]) {
                sets.join(wide, tight);
            }
            here = wide;
        }
        if here == 0 {
            here = sets.add();
            tops.push(blocks.clearance[block]);
        }
        basins[block] = here;
    }
    let roots: Vec<u32> = (0..tops.len() as u32).map(|basin| sets.of(basin)).collect();
    for basin in basins {
        *basin = roots[*basin as usize];
    }
}
