//! The map turned so that one direction lies along the columns: where its places are, and by which keys what is found in
//! it is kept. What its cells hold is in `sampled.rs`, what lies on its lines in `lined.rs`.

use super::axes::{Axes, cotangent};
use super::lined::Lined;
use super::look::{LANES, Look};
use super::panes::{Across, Pane};
use super::quarter::Quarter;
use super::runs::Run;
use super::summed::Summed;
use super::sums::{Cells, Known, Told, What, are_many};
use crate::bits::Bits;
use crate::ends::wider;
use crate::grid::{nearest, whole};
use crate::labels::posts::framed;
use crate::labels::posts::grounds::Grounds;
use crate::labels::posts::pitch::{self, Pitch};
use crate::labels::posts::rack::{Pitches, Rack};
use crate::labels::posts::uprights::Upright;
use crate::labels::recall::Key;
use crate::labels::rows::Row;
use crate::labels::{Evidence, Scene};
use std::ops::Range;
use std::sync::Arc;

/// Cells of the turned raster are about this large, metres.
const CELL: f64 = 0.1;

/// One direction's view of the map. Places along it (u) and across it (v) are those of its [`Axes`].
pub struct Turned {
    /// Index of the direction.
    pub direction: usize,
    /// Its angle in the map frame.
    pub angle: f64,
    axes: Axes,
    /// Side of a cell, metres.
    pub cell: f64,
    /// Place of the first cell's lower corner.
    pub start: [f64; 2],
    /// Cells along and across.
    pub size: [usize; 2],
    pub(super) cells: Cells,
    /// Of a large view, what another has seen as it will.
    pub(super) known: Known,
    /// Samples along a cell's side.
    pub(super) samples: u32,
    /// Distance from post to post along its lines, metres, where posts recur.
    pub pitch: Option<f64>,
    /// The same by frames that stand alone, which counts where too few posts recur.
    framed: Option<f64>,
    /// That of its racks on legs.
    on_legs: Arc<Pitches>,
    /// By what recurs along its lines, about each row.
    by_rows: Option<Arc<Pitch>>,
    /// Offsets of the direction's lines, ascending.
    pub offsets: Arc<Vec<f64>>,
    /// For each of those lines, whether structure lies on it in each column.
    pub covered: Arc<Vec<Bits>>,
    /// The same for what only touches it: posts, and the ends of what lies across.
    pub touched: Arc<Vec<Bits>>,
    /// The same by the edge pixels alone, where racks stand on legs.
    pub(super) lined: Arc<Lined>,
    /// Where walls along its lines are of glass.
    pub panes: Arc<Vec<Pane>>,
    /// And those of others that cross it.
    pub across: Arc<Vec<Across>>,
    /// What is told of each row of cells.
    pub rows: Arc<Vec<Told>>,
    /// Racks that stand on legs, whose ground is taken.
    pub(super) grounds: Grounds,
    /// The view that it is seen with.
    pub(super) quarter: Option<Quarter>,
    /// Keys of the view without its rows and lines, and of its lines.
    keys: (Key, Arc<Vec<Key>>),
}

impl Turned {
    /// Along one direction; nothing is seen yet.
    pub fn new(scene: &Scene, direction: usize, on_legs: &[Row]) -> Self {
        let mut made = Self::by_itself(scene, direction).turned_from_another(scene);
        made.grounds = Grounds::new(scene.directions, &made, on_legs);
        made
    }

    /// The same where other racks stand on legs; nothing is seen yet between its lines. Of a large view it knows all rows
    /// in which the same racks stand.
    pub fn with(&self, scene: &Scene, on_legs: &[Row]) -> Self {
        let mut made = Self::new(scene, self.direction, on_legs);
        made.known = Known::of(&self.cells, &self.rows, |rows| {
            let [own, other] = [self, &made].map(|view| view.key_of_grounds(Key::default(), &rows));
            own == other
        });
        made.lie(&scene.grid.frame, &self.lined);
        made.lined = Arc::clone(&self.lined);
        made.framed = self.framed;
        made.on_legs = Arc::clone(&self.on_legs);
        made
    }

    fn by_itself(scene: &Scene, direction: usize) -> Self {
        let frame = &scene.grid.frame;
        let angle = scene.directions.angles[direction];
        let axes = Axes::of(scene.directions, direction);
        let (w, h) = (frame.width as f64, frame.height as f64);
        let corners = [[0.0, 0.0], [w, 0.0], [0.0, h], [w, h]].map(|p| axes.place(frame.to_metres(p)));
        let low = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::INFINITY, f64::min);
        let high = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::NEG_INFINITY, f64::max);
        let side = (CELL / frame.resolution).round().max(1.0);
        let cell = side * frame.resolution;
        let start = [low(0), low(1)];
        let size: [usize; 2] = [0, 1].map(|axis| ((high(axis) - start[axis]) / cell).ceil().max(1.0) as usize);
        let samples = (side as u32).clamp(1, LANES as u32);
        Self {
            direction,
            angle,
            axes,
            cell,
            start,
            size,
            cells: Cells::default(),
            known: Known::default(),
            samples,
            pitch: None,
            framed: None,
            on_legs: Arc::default(),
            by_rows: None,
            offsets: Arc::default(),
            covered: Arc::default(),
            touched: Arc::default(),
            lined: Arc::default(),
            panes: Arc::default(),
            across: Arc::default(),
            rows: Arc::default(),
            grounds: Grounds::default(),
            quarter: None,
            keys: (Key::default(), Arc::default()),
        }
    }

    /// The same as another sees it, turned by a quarter, where their directions are at right angles: cells of the one are
    /// cells of the other. Not where pixels lie between samples, nor where there are too many cells.
    fn turned_from_another(mut self, scene: &Scene) -> Self {
        let frame = &scene.grid.frame;
        let sample = self.cell / f64::from(self.samples);
        let is_whole = self.axes.lean == 0.0
            && !self.is_fine(frame)
            && !are_many(self.size)
            && !are_many([self.size[1], self.size[0]]);
        let Some(quarter) = Quarter::of(scene.directions, frame, sample, self.direction).filter(|_| is_whole) else {
            return self;
        };
        let other = Self::by_itself(scene, quarter.other);
        // What is off is off least in the middle of the map.
        let middle = frame.to_metres([0.5 * frame.width as f64, 0.5 * frame.height as f64]);
        let from = |view: &Self| [0, 1].map(|axis| view.place(middle)[axis] - view.start[axis]);
        let size = other.size.map(|cells| cells as f64 * other.cell);
        let place = quarter.place(from(&other), size);
        self.start = [0, 1].map(|axis| self.place(middle)[axis] - place[axis]);
        self.size = [other.size[1], other.size[0]];
        self.quarter = Some(quarter);
        self
    }

    /// Sees all of the map, for which no lines are needed; its cells may be known.
    pub fn see(&mut self, scene: &Scene, look: &Look, known: Option<&[u8]>) {
        let (cells, rows) = self.look_at(scene, look, known);
        (self.cells, self.rows, self.known) = (cells, Arc::new(rows), Known::default());
    }

    /// Takes what frames among some uprights tell.
    pub fn take_frames(&mut self, uprights: &[Upright]) {
        self.framed = framed::pitch(uprights, self.axes.heading);
    }

    /// Takes the pitches of its own of some racks on legs.
    pub fn take_pitches(&mut self, racks: &[Rack]) {
        self.on_legs = Arc::new(Pitches::of(self.direction, racks));
    }

    /// Finds what recurs along the lines of what is seen; of the gradients the specks are asked.
    pub fn recur(&mut self, evidence: &Evidence) {
        let found = pitch::find(evidence, self);
        let told = || found.as_ref().map(Pitch::told);
        self.pitch = found.as_ref().and_then(Pitch::common).or(self.framed).or_else(told);
        self.by_rows = found.map(Arc::new);
        if evidence.recall.keeps() {
            self.keys = self.find_keys();
        }
    }

    /// From one of the goods to the next, metres, where the pitch along its lines is some of these.
    pub fn goods(&self) -> Option<f64> {
        self.by_rows.as_ref().and_then(|pitch| pitch.goods)
    }

    /// From post to post along a row, metres: as of the racks on legs in it, and where posts recur in some rows of the view, as
    /// about that one.
    pub fn pitch_of(&self, row: &Row) -> Option<f64> {
        // Where frames tell a pitch it is that of all rows about which posts tell none.
        let about = || match &self.by_rows {
            Some(pitch) if pitch.common().is_some() => pitch.about(row),
            Some(pitch) => pitch.about(row).or(self.framed),
            None => self.pitch,
        };
        self.on_legs.about(row).or_else(about)
    }

    /// Lets go of all that is seen: what is left says where places are.
    pub fn let_go(&mut self) {
        self.unsee();
        self.by_rows = None;
        (self.offsets, self.keys.1) = (Arc::default(), Arc::default());
        (self.covered, self.touched, self.lined) = (Arc::default(), Arc::default(), Arc::default());
        (self.panes, self.across) = (Arc::default(), Arc::default());
    }

    /// Lets go of what is seen between its lines.
    pub fn unsee(&mut self) {
        (self.cells, self.rows) = (Cells::default(), Arc::default());
    }

    /// A key with the racks on legs that reach into some rows of cells.
    pub(super) fn key_of_grounds(&self, key: Key, rows: &Range<usize>) -> Key {
        let [low, high] = [rows.start, rows.end].map(|n| self.start[1] + n as f64 * self.cell);
        self.grounds.key(key, rows, [low, high])
    }

    /// From which to which of some columns, counted from the first of them, the ground of racks on legs lies at a place across.
    pub fn on_legs_at(&self, v: f64, columns: Range<usize>) -> Vec<Run> {
        let row = ((v - self.start[1]) / self.cell).max(0.0) as usize;
        let within = |u: f64| self.column(u).clamp(columns.start, columns.end) - columns.start;
        let grounds = self.grounds.at(row, v).map(|[from, to]| (within(from), within(to)));
        grounds.filter(|(from, to)| from < to).collect()
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
            known: Known::default(),
            offsets: Arc::clone(&self.offsets),
            covered: Arc::clone(&self.covered),
            touched: Arc::clone(&self.touched),
            lined: Arc::default(),
            panes: Arc::clone(&self.panes),
            across: Arc::clone(&self.across),
            rows: Arc::clone(&self.rows),
            grounds: Grounds::default(),
            on_legs: Arc::clone(&self.on_legs),
            by_rows: self.by_rows.clone(),
            keys: (self.keys.0, Arc::clone(&self.keys.1)),
            ..*self
        })
    }

    /// The room of such sums.
    pub fn into_room(self) -> Summed {
        self.cells.into_near()
    }

    /// Keys of the view and of its lines.
    fn find_keys(&self) -> (Key, Arc<Vec<Key>>) {
        let numbers = [self.angle, self.axes.lean, self.cell, self.start[0], self.start[1]];
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
    pub fn place(&self, point: [f64; 2]) -> [f64; 2] {
        self.axes.place(point)
    }

    /// The point of the map frame at a place.
    pub fn to_map(&self, place: [f64; 2]) -> [f64; 2] {
        self.axes.to_map(place)
    }

    /// Where what lies at `t` across of another direction crosses what lies at `v` across of this one: the place along
    /// the other direction, and along this one.
    pub fn crossing(&self, other: &Self, v: f64, t: f64) -> [f64; 2] {
        let turn = other.angle - self.angle;
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        // But for what either leans a point at (s, t) of the other direction lies at u = s cos - t sin, v = s sin + t cos.
        let s = (v - t * cos) / sin;
        [s - t * other.axes.lean, s * cos - t * sin - v * self.axes.lean]
    }

    /// How far along it what runs along another direction comes for each metre across.
    pub fn lean(&self, other: &Self) -> f64 {
        cotangent(other.angle - self.angle) - self.axes.lean
    }

    /// The sine of the angle to another direction, whichever way either runs.
    pub fn sine(&self, other: &Self) -> f64 {
        libm::sin(self.angle - other.angle).abs()
    }

    /// A rectangle of places, counter-clockwise, as a polygon in the map frame.
    pub fn rectangle(&self, along: [f64; 2], across: [f64; 2]) -> Vec<[f64; 2]> {
        self.axes.rectangle(along, across).to_vec()
    }

    /// The column that holds place `u`, the first or last when it lies outside.
    pub fn column(&self, u: f64) -> usize {
        whole((u - self.start[0]) / self.cell).min(self.size[0] - 1)
    }

    /// The columns from the one that holds a place to the one that holds another, both included; the lower place first.
    pub fn columns(&self, [from, to]: [f64; 2]) -> Range<usize> {
        self.column(from)..self.column(to) + 1
    }

    /// Place along of a column's lower border.
    pub fn along(&self, column: usize) -> f64 {
        self.start[0] + column as f64 * self.cell
    }

    /// From where to where it reaches across.
    pub fn reach_across(&self) -> [f64; 2] {
        [self.start[1], self.start[1] + self.size[1] as f64 * self.cell]
    }

    /// The column whose lower border is the nearest to place `u`.
    pub fn border(&self, u: f64) -> usize {
        ((u - self.start[0]) / self.cell).round() as usize
    }

    /// The cells across between two places: from, to.
    pub(super) fn cells(&self, low: f64, high: f64) -> (usize, usize) {
        let [from, to] = [low, high].map(|v| self.border_across(v));
        (from, to.max(from))
    }

    /// The border between rows of cells that is the nearest to place `v`.
    pub fn border_across(&self, v: f64) -> usize {
        nearest(((v - self.start[1]) / self.cell).clamp(0.0, self.size[1] as f64))
    }
}

/// The least sine of the angle between two directions, of those that are no less than that.
pub fn least_sine(views: &[Turned], least: f64) -> f64 {
    let sines = views.iter().flat_map(|one| views.iter().map(|other| one.sine(other)));
    sines.filter(|sine| *sine >= least).fold(1.0, f64::min)
}
