//! The map turned so that one direction lies along the columns: how much of any piece of a strip is not free, and
//! where structure lies on each line.

use super::Evidence;
use super::grounds::Grounds;
use super::look::{BLOCKED, LANES, Look, OCCUPIED, between_rays};
use super::patches::Patches;
use super::recall::Key;
use super::rows::Row;
use super::summed::{Part, Summed};
use super::sums::{Cells, Source, Told, What};
use crate::bits::Bits;
use crate::ends::wider;
use crate::gradients;
use crate::grid::{Frame, rounded};
use crate::on_line::OnLine;
use crate::radiograms::weight;
use std::ops::Range;
use std::sync::Arc;

/// Cells of the turned raster are about this large, metres.
const CELL: f64 = 0.1;
/// Cells that are kept around what was seen: what stands in one bars those beside it.
const SPARE: usize = 2;
/// Pixels this near to a line lie on it, metres, or at least so many pixels.
const NEAR: (f64, f64) = (0.12, 2.0);

/// Lines with less structure than this, metres, and than this share of a strong line's, are no sides of corridors but
/// the faces of single goods.
const STRONG: (f64, f64) = (2.0, 0.08);

/// One direction's view of the map. Places along it (u) and across it (v) are metres in the map frame turned by the
/// direction: u = p.t with t = (cos, sin), v = p.n with n = (-sin, cos).
pub struct Turned {
    /// Index of the direction.
    pub direction: usize,
    /// Its angle in the map frame.
    pub angle: f64,
    /// Its cosine and sine.
    heading: [f64; 2],
    /// Side of a cell, metres.
    pub cell: f64,
    /// Place of the first cell's lower corner.
    pub start: [f64; 2],
    /// Cells along and across.
    pub size: [usize; 2],
    pub(super) cells: Cells,
    /// Samples along a cell's side.
    pub(super) samples: u32,
    /// Distance from post to post along its lines, metres, where posts recur.
    pub pitch: Option<f64>,
    /// Offsets of the direction's lines, ascending.
    pub offsets: Arc<Vec<f64>>,
    /// For each of those lines, whether structure lies on it in each column.
    pub covered: Arc<Vec<Bits>>,
    /// The same for what only touches it: posts, and the ends of what lies across.
    pub touched: Arc<Vec<Bits>>,
    /// What is told of each row of cells.
    pub rows: Arc<Vec<Told>>,
    /// Racks that stand on legs, whose ground is taken.
    grounds: Grounds,
    /// Keys of the view without its rows and lines, and of its lines.
    keys: (Key, Arc<Vec<Key>>),
}

impl Turned {
    /// The map seen along one direction.
    pub fn new(evidence: &Evidence, look: &Look, direction: usize, on_legs: &[Row]) -> Self {
        let mut made = Self::lined(evidence, direction, on_legs);
        made.see(evidence, look);
        made
    }

    /// What lies on a direction's lines, and nothing between them yet.
    pub fn lined(evidence: &Evidence, direction: usize, on_legs: &[Row]) -> Self {
        let frame = &evidence.grid.frame;
        let angle = evidence.directions.angles[direction];
        let (cos, sin) = (libm::cos(angle), libm::sin(angle));
        let turn = |[x, y]: [f64; 2]| [x * cos + y * sin, y * cos - x * sin];
        let (w, h) = (frame.width as f64, frame.height as f64);
        let corners = [[0.0, 0.0], [w, 0.0], [0.0, h], [w, h]].map(|p| turn(frame.to_metres(p)));
        let low = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::INFINITY, f64::min);
        let high = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::NEG_INFINITY, f64::max);
        let side = (CELL / frame.resolution).round().max(1.0);
        let cell = side * frame.resolution;
        let start = [low(0), low(1)];
        let size: [usize; 2] = [0, 1].map(|axis| ((high(axis) - start[axis]) / cell).ceil().max(1.0) as usize);
        let samples = (side as u32).clamp(1, LANES as u32);
        let mut made = Self {
            direction,
            angle,
            heading: [cos, sin],
            cell,
            start,
            size,
            cells: Cells::default(),
            samples,
            pitch: None,
            offsets: Arc::default(),
            covered: Arc::default(),
            touched: Arc::default(),
            rows: Arc::default(),
            grounds: Grounds::default(),
            keys: (Key::default(), Arc::default()),
        };
        made.grounds = Grounds::new(evidence, &made, on_legs);
        made.cover_lines(evidence);
        made
    }

    /// And all that lies between them; of the gradients the specks are asked.
    pub fn see(&mut self, evidence: &Evidence, look: &Look) {
        let (cells, rows) = self.look_at(evidence, look);
        (self.cells, self.rows) = (cells, Arc::new(rows));
        self.pitch = super::pitch::find(evidence, self);
        if evidence.recall.keeps() {
            self.keys = self.find_keys();
        }
    }

    /// Lets go of all that is seen: what is left says where places are.
    pub fn let_go(&mut self) {
        self.cells = Cells::default();
        (self.rows, self.offsets, self.keys.1) = (Arc::default(), Arc::default(), Arc::default());
        (self.covered, self.touched) = (Arc::default(), Arc::default());
    }

    /// True when the cells are too many for sums of all rows.
    pub fn is_large(&self) -> bool {
        matches!(self.cells, Cells::Squared { .. })
    }

    /// A large view with the sums of what lies between two places across, for what will be asked of it.
    pub fn near(&self, what: &[What], low: f64, high: f64, room: Summed) -> Option<Self> {
        let (from, to) = self.cells(low, high);
        // What is rounded to cells may reach one farther.
        let rows = from.saturating_sub(1)..(to + 1).min(self.size[1]);
        Some(Self {
            cells: self.cells.near(what, rows, room)?,
            offsets: Arc::clone(&self.offsets),
            covered: Arc::clone(&self.covered),
            touched: Arc::clone(&self.touched),
            rows: Arc::clone(&self.rows),
            grounds: Grounds::default(),
            keys: (self.keys.0, Arc::clone(&self.keys.1)),
            ..*self
        })
    }

    /// The room of such sums.
    pub fn into_room(self) -> Summed {
        self.cells.into_near()
    }

    /// The samples that are blocked or occupied in each cell.
    fn look_at(&self, evidence: &Evidence, look: &Look) -> (Cells, Vec<Told>) {
        let samples = self.samples as usize;
        let frame = &evidence.grid.frame;
        let sample = self.cell / samples as f64;
        let is_fine = sample > 1.1 * frame.resolution;
        // On the grid, in pixels: the first sample, and the steps to the next one along and across.
        let at = |u: f64, v: f64| frame.to_pixels(self.to_map([self.start[0] + u, self.start[1] + v]));
        let (origin, along, across) = (at(0.0, 0.0), at(sample, 0.0), at(0.0, sample));
        let steps = [along, across].map(|p| [0, 1].map(|axis| p[axis] - origin[axis]));
        let place = |a: f64, b: f64| [0, 1].map(|axis| origin[axis] + a * steps[0][axis] + b * steps[1][axis]);
        // Where samples are pixels apart, the staircase of a wall one pixel thick has no gap in lanes of two pixels, and no
        // pixel lies between so many looks along and across a cell.
        let pixels = (self.cell / frame.resolution).round() as usize;
        let thin = pixels.div_ceil(2).clamp(samples, u32::BITS as usize);
        let looks = pixels.next_multiple_of(thin);
        let make = |n: usize, first: usize, row: &mut [u8]| {
            let lanes: [[f64; 2]; LANES] = std::array::from_fn(|j| place(0.5, (n * samples + j) as f64 + 0.5));
            look.cells(&lanes[..samples], steps[0], first, row);
            if is_fine {
                let each = f64::from(self.samples) / looks as f64;
                let step = steps[0].map(|step| step * each);
                add_thin(row, [thin, looks], |k, stands, bit| {
                    let lane = place(0.5 * each, (n * samples) as f64 + (k as f64 + 0.5) * each);
                    look.mark(lane, step, [looks, first], bit, stands);
                });
                between_rays(row, self.samples.pow(2) as u8);
            }
            self.take(n, first, row);
        };
        let patches = evidence.recall.patches(evidence.grid, evidence.threads);
        let key = |rows: Range<usize>| {
            let lanes = [rows.start, rows.end].map(|n| place(0.0, (n * samples) as f64));
            let under = |patches: &Patches| patches.under(lanes, steps[0], self.size[0] * samples);
            let key = patches.map_or(Key::default(), under).with(rows.len() as u64).with(samples as u64);
            let [low, high] = [rows.start, rows.end].map(|n| self.start[1] + n as f64 * self.cell);
            self.grounds.key(key, &rows, [low, high])
        };
        let (seen, recall) = (self.seen(evidence, look), evidence.recall);
        Cells::new(self.size, self.samples.pow(2) as u16, seen, Source { make, key }, recall, evidence.threads)
    }

    /// The part of the view in which something was seen of the map, and a few cells more.
    fn seen(&self, evidence: &Evidence, look: &Look) -> Part {
        let mut ends = [[usize::MAX, 0]; 2];
        for &corner in look.seen() {
            let place = self.place(evidence.grid.frame.to_metres(corner));
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

    fn cover_lines(&mut self, evidence: &Evidence) {
        let frame = &evidence.grid.frame;
        let lines = evidence.lines;
        let strong = STRONG.0.min(STRONG.1 * lines.typical_amplitude());
        let mut offsets: Vec<f64> = (0..lines.len())
            .filter(|&n| lines.directions[n] as usize == self.direction && lines.amplitudes[n] >= strong)
            .map(|n| lines.offsets[n])
            .collect();
        offsets.sort_by(f64::total_cmp);
        let near = Self::near_line(frame);
        let sides = self.grounds.sides();
        for &(offset, _) in &sides {
            let at = offsets.partition_point(|&other| other < offset);
            let others = &offsets[at.saturating_sub(1)..offsets.len().min(at + 1)];
            if others.iter().all(|other| (other - offset).abs() > near) {
                offsets.insert(at, offset);
            }
        }
        let key = |n: usize| self.key_on_line(evidence, offsets[n]);
        let on = evidence.recall.lined.or_find_some(offsets.len(), key, |some| {
            self.on_lines(evidence, &some.iter().map(|&n| offsets[n]).collect::<Vec<_>>())
        });
        let (mut covered, mut touched): (Vec<_>, Vec<_>) =
            on.into_iter().map(|[covered, touched]| (covered, touched)).unzip();
        let lines = OnLine::new(&offsets, near);
        for (offset, along) in sides {
            for line in lines.at(offset) {
                for bits in [&mut covered[line], &mut touched[line]] {
                    bits.fill(self.column(along[0])..self.column(along[1]) + 1);
                }
            }
        }
        self.offsets = Arc::new(offsets);
        (self.covered, self.touched) = (Arc::new(covered), Arc::new(touched));
    }

    /// Edge pixels this near to a line lie on it, metres.
    fn near_line(frame: &Frame) -> f64 {
        NEAR.0.max(NEAR.1 * frame.resolution)
    }

    /// The key of all edge pixels on a line, where what is found is kept.
    pub fn key_on_line(&self, evidence: &Evidence, offset: f64) -> Key {
        let Some(patches) = evidence.recall.patches(evidence.grid, evidence.threads) else { return Key::default() };
        let frame = &evidence.grid.frame;
        // And the pixels around that bear on them.
        let beside = Self::near_line(frame) + gradients::reach_across(frame.resolution, evidence.parameters);
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
        let lines = OnLine::new(offsets, Self::near_line(frame));
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

    /// Keys of the view and of its lines.
    fn find_keys(&self) -> (Key, Arc<Vec<Key>>) {
        let numbers = [self.angle, self.cell, self.start[0], self.start[1]];
        let lines = self.offsets.iter().zip(self.covered.iter()).zip(self.touched.iter());
        let key = |((offset, covered), touched): ((&f64, &Bits), &Bits)| {
            let columns = 0..self.size[0];
            Key::default().number(*offset).bits(covered, columns.clone()).bits(touched, columns)
        };
        (
            numbers.into_iter().fold(Key::default().with(self.direction as u64), Key::number),
            Arc::new(lines.map(key).collect()),
        )
    }

    /// The key of all that can be seen of a strip, and so far beyond its sides, metres.
    pub fn key(&self, [low, high]: [f64; 2], beyond: f64) -> Key {
        let ends = self.rounded_within([low - beyond, high + beyond]);
        let [first, last] = ends.map(|v| self.offsets.partition_point(|&offset| offset < v));
        let lines = self.keys.1[first..last].iter().copied();
        self.rows_at(ends).chain(lines).fold(self.keys.0.number(low).number(high), Key::key)
    }

    /// A key with that of all cells from one place across to another.
    pub fn key_of_cells(&self, key: Key, [low, high]: [f64; 2]) -> Key {
        self.rows_at(self.rounded_within([low, high])).fold(key.number(low).number(high), Key::key)
    }

    /// What is rounded to cells reaches a cell farther at most.
    fn rounded_within(&self, across: [f64; 2]) -> [f64; 2] {
        wider(across, 2.0 * self.cell)
    }

    /// The keys of the rows of cells from one place across to another.
    fn rows_at(&self, [low, high]: [f64; 2]) -> impl Iterator<Item = Key> {
        let (from, to) = self.cells(low, high);
        self.rows[from..to].iter().map(|row| row.key)
    }

    /// The lines from one place across to another, both included.
    pub fn lines(&self, low: f64, high: f64) -> Range<usize> {
        let first = self.offsets.partition_point(|&offset| offset < low);
        first..self.offsets.partition_point(|&offset| offset <= high).max(first)
    }

    /// Place along and across of a point of the map frame.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.heading;
        [x * cos + y * sin, y * cos - x * sin]
    }

    /// The point of the map frame at a place.
    pub fn to_map(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = self.heading;
        [u * cos - v * sin, u * sin + v * cos]
    }

    /// Where what lies at `t` across of another direction crosses what lies at `v` across of this one: the place along
    /// the other direction, and along this one.
    pub fn crossing(&self, other: &Self, v: f64, t: f64) -> [f64; 2] {
        let turn = other.angle - self.angle;
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        // A point at (s, t) of the other direction lies at u = s cos - t sin, v = s sin + t cos.
        let s = (v - t * cos) / sin;
        [s, s * cos - t * sin]
    }

    /// A rectangle of places, counter-clockwise, as a polygon in the map frame.
    pub fn rectangle(&self, along: [f64; 2], across: [f64; 2]) -> Vec<[f64; 2]> {
        rectangle(along, across).map(|corner| self.to_map(corner)).to_vec()
    }

    /// The column that holds place `u`, the first or last when it lies outside.
    pub fn column(&self, u: f64) -> usize {
        (((u - self.start[0]) / self.cell).max(0.0) as usize).min(self.size[0] - 1)
    }

    /// Place along of a column's lower border.
    pub fn along(&self, column: usize) -> f64 {
        self.start[0] + column as f64 * self.cell
    }

    /// The column whose lower border is the nearest to place `u`.
    pub fn border(&self, u: f64) -> usize {
        ((u - self.start[0]) / self.cell).round() as usize
    }

    /// The cells across between two places: from, to.
    pub(super) fn cells(&self, low: f64, high: f64) -> (usize, usize) {
        let at = |v: f64| rounded(((v - self.start[1]) / self.cell).clamp(0.0, self.size[1] as f64)) as usize;
        (at(low), at(high).max(at(low)))
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

/// The least sine of the angle between two directions, of those that are no less than that.
pub fn least_sine(views: &[Turned], least: f64) -> f64 {
    let sines = views.iter().flat_map(|one| views.iter().map(|other| libm::sin(one.angle - other.angle).abs()));
    sines.filter(|sine| *sine >= least).fold(1.0, f64::min)
}

/// The corners of a rectangle of places, counter-clockwise.
pub fn rectangle(along: [f64; 2], across: [f64; 2]) -> [[f64; 2]; 4] {
    [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| [along[u], across[v]])
}
