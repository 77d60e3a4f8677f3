//! The map in patches of 64 x 64 pixels that have keys: what is seen over patches that are the same as before is the same.

use crate::bands::{BAND_ROWS, map_bands};
use crate::bits::{Bits, lowest};
use crate::ends::{around, wider};
use crate::grid::Grid;
use crate::labels::recall::Key;

/// Pixels along the side of a patch.
const SIDE: usize = BAND_ROWS;
/// What lies so many pixels beside the lanes is under them too: more than is rounded.
const BESIDE: f64 = 2.0;

/// Columns and rows of pixels of the map, from the first to the last one of each; none at first.
#[derive(Clone, Copy, Debug)]
pub struct Area([[usize; 2]; 2]);

impl Area {
    pub const NONE: Self = Self([[usize::MAX, 0]; 2]);

    /// With a pixel more.
    pub fn with(self, pixel: [usize; 2]) -> Self {
        Self([0, 1].map(|axis| {
            let ([from, to], pixel) = (self.0[axis], pixel[axis]);
            [from.min(pixel), to.max(pixel)]
        }))
    }
}

/// Keys of patches, row after row.
#[derive(Debug)]
pub struct Patches {
    /// Patches along each axis.
    size: [usize; 2],
    keys: Vec<Key>,
}

impl Patches {
    pub fn new(grid: &Grid, threads: usize) -> Self {
        let across = grid.frame.width.div_ceil(SIDE);
        let meanings = Key::default().bytes(&grid.table.states.map(|state| state as u8));
        let keys = map_bands([grid.frame.width, grid.frame.height], threads, |band| {
            let mut keys = vec![meanings; across];
            for row in band.map(|y| grid.row(y)) {
                keys.iter_mut().zip(row.chunks(SIDE)).for_each(|(key, pixels)| *key = key.bytes(pixels));
            }
            keys
        });
        Self { size: [across, keys.len()], keys: keys.concat() }
    }

    /// Those of a raster so many pixels wide and high.
    pub fn of_bits(bits: &Bits, [width, height]: [usize; 2], threads: usize) -> Self {
        let across = width.div_ceil(SIDE);
        let keys = map_bands([width, height], threads, |band| {
            let mut keys = vec![Key::default(); across];
            for y in band {
                for (key, x) in keys.iter_mut().zip((0..width).step_by(SIDE)) {
                    *key = key.with(bits.word(y * width + x) & lowest(width - x));
                }
            }
            keys
        });
        Self { size: [across, keys.len()], keys: keys.concat() }
    }

    /// The key of all patches that a part of the map lies in.
    pub fn over(&self, part: Area) -> Key {
        let [columns, rows] = [0, 1].map(|axis| {
            let [from, to] = part.0[axis];
            from / SIDE..(to / SIDE + 1).min(self.size[axis])
        });
        let row = |y: usize| &self.keys[y * self.size[0]..][..self.size[0]];
        rows.flat_map(|y| row(y).get(columns.clone()).unwrap_or_default()).copied().fold(Key::default(), Key::key)
    }

    /// The key of all that so many samples of lanes side by side lie on, each a `step` after the one before: of the first
    /// lane and the last one it is said where they begin, in pixels.
    pub fn under(&self, lanes: [[f64; 2]; 2], step: [f64; 2], count: usize) -> Key {
        let numbers = lanes.into_iter().chain([step]).flatten();
        let key = numbers.fold(Key::default().with(count as u64), Key::number);
        // Along the axis that the lanes are nearer to, patch after patch, and from lane to lane across it.
        let along = usize::from(step[1].abs() > step[0].abs());
        let across = 1 - along;
        let slope = if step[along] == 0.0 { 0.0 } else { step[across] / step[along] };
        let ends = lanes.map(|lane| [lane[along], lane[along] + count as f64 * step[along]]);
        let part = |ends: &[f64], axis: usize| {
            let [low, high] = wider(around(ends.iter().copied()), BESIDE);
            let place = |pixel: f64| ((pixel / SIDE as f64).floor() + 1.0).max(0.0) as usize;
            // Beyond the map there are no patches.
            place(low).saturating_sub(1)..place(high).min(self.size[axis])
        };
        part(ends.as_flattened(), along).fold(key, |key, n| {
            let borders = [n, n + 1].map(|n| (n * SIDE) as f64);
            let at = |lane: [f64; 2]| borders.map(|border| lane[across] + (border - lane[along]) * slope);
            part(lanes.map(at).as_flattened(), across).fold(key, |key, m| {
                let [x, y] = if along == 0 { [n, m] } else { [m, n] };
                key.key(self.keys[y * self.size[0] + x])
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Frame, Table};
    use crate::labels::view::look::Look;
    use crate::tiles::Tiles;

    #[test]
    fn lanes_that_see_a_changed_pixel_have_another_key() {
        let (width, height) = (300, 200);
        let (table, frame) = (Table::trinary(), Frame::new(width, height, 0.05, [0.0; 3]));
        let of = |pixels: &[u8], start: [f64; 2], step: [f64; 2]| {
            let grid = Grid::new(pixels, true, &table, frame);
            let lanes = [start, [start[0] - 9.0 * step[1], start[1] + 9.0 * step[0]]];
            let look = Look::new(&grid, &Tiles::new(&grid, 1));
            let seen: [_; 10] = std::array::from_fn(|n| {
                let n = n as f64;
                let mut cells = vec![0; 400];
                look.along([start[0] - n * step[1], start[1] + n * step[0]], step, &mut cells);
                cells
            });
            (Patches::new(&grid, 1).under(lanes, step, 400), seen)
        };
        let mut state = 1u64;
        let mut random = |most: f64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 * most
        };
        let (mut others, mut same) = (0, 0);
        for _ in 0..2000 {
            let angle = random(7.0);
            let (start, step) = ([random(360.0) - 30.0, random(260.0) - 30.0], [libm::cos(angle), libm::sin(angle)]);
            let mut pixels = vec![254; width * height];
            let (key, seen) = of(&pixels, start, step);
            pixels[random(height as f64) as usize * width + random(width as f64) as usize] = 0;
            let (other, now) = of(&pixels, start, step);
            assert!(seen == now || key != other);
            others += usize::from(seen != now);
            same += usize::from(key == other);
        }
        assert!(others > 20 && same > 1000);
    }
}
