//! The grid: pixels as they lie, what each value means, and the one place where a pixel becomes metres.

use std::ops::Range;

/// What a pixel is known to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum State {
    /// Seen and empty.
    Free = 0,
    /// Seen and taken.
    Occupied = 1,
    /// Not seen, or not decided.
    Unknown = 2,
}

/// Occupancy that an unknown pixel counts with, in percent: the prior of an occupancy grid.
pub const PRIOR_PERCENT: u8 = 50;

/// What each of the 256 values of a pixel means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// Percent occupied, 0 to 100; unknown counts [`PRIOR_PERCENT`].
    pub occupancy: [u8; 256],
    /// Free, occupied or unknown.
    pub states: [State; 256],
}

impl Table {
    /// From `nav_msgs/OccupancyGrid` values (0..=100, anything else unknown) and states (0 free, 1 occupied, else
    /// unknown), one for each value of a pixel.
    #[must_use]
    pub fn new(values: &[i8; 256], states: &[u8; 256]) -> Self {
        let occupancy = values.map(|v| if (0..=100).contains(&v) { v.unsigned_abs() } else { PRIOR_PERCENT });
        let states = states.map(|s| match s {
            0 => State::Free,
            1 => State::Occupied,
            _ => State::Unknown,
        });
        Self { occupancy, states }
    }

    /// The usual picture: 254 and 255 free, 0 occupied, everything else unknown.
    #[must_use]
    pub fn trinary() -> Self {
        let mut values = [-1; 256];
        let mut states = [2; 256];
        (values[0], states[0]) = (100, 1);
        for white in [254, 255] {
            (values[white], states[white]) = (0, 0);
        }
        Self::new(&values, &states)
    }
}

/// Where the grid lies in the map frame of the ROS `map_server` YAML.
///
/// Inside the method a point of the grid is (column, row) in pixels from the lower left corner, x right, y up; the
/// centre of the lower left pixel is (0.5, 0.5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Metres per pixel.
    pub resolution: f64,
    /// Pose of the lower left corner: metres, metres, radians.
    pub origin: [f64; 3],
    cos: f64,
    sin: f64,
}

impl Frame {
    /// A frame; resolution must be positive and everything finite, which the door has checked.
    #[must_use]
    pub fn new(width: usize, height: usize, resolution: f64, origin: [f64; 3]) -> Self {
        Self { width, height, resolution, origin, cos: libm::cos(origin[2]), sin: libm::sin(origin[2]) }
    }

    /// Pixels to metres.
    #[must_use]
    pub fn to_metres(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (u, v) = (x * self.resolution, y * self.resolution);
        [self.origin[0] + u * self.cos - v * self.sin, self.origin[1] + u * self.sin + v * self.cos]
    }

    /// Metres to pixels.
    #[must_use]
    pub fn to_pixels(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (u, v) = (x - self.origin[0], y - self.origin[1]);
        [(u * self.cos + v * self.sin) / self.resolution, (v * self.cos - u * self.sin) / self.resolution]
    }

    /// Angle of a direction on the grid to the map frame, in [-pi/2, pi/2).
    #[must_use]
    pub fn angle_to_map(&self, angle: f64) -> f64 {
        undirected(angle + self.origin[2])
    }

    /// Angle of a direction in the map frame to the grid, in [-pi/2, pi/2).
    #[must_use]
    pub fn angle_to_grid(&self, angle: f64) -> f64 {
        undirected(angle - self.origin[2])
    }

    /// Offset along the map frame's normal of `angle`, in metres, of the line that has `offset` in pixels along the
    /// grid's normal of the same direction.
    #[must_use]
    pub fn offset_to_map(&self, angle_in_grid: f64, offset: f64) -> f64 {
        let point = [-libm::sin(angle_in_grid) * offset, libm::cos(angle_in_grid) * offset];
        let [x, y] = self.to_metres(point);
        let angle = self.angle_to_map(angle_in_grid);
        -libm::sin(angle) * x + libm::cos(angle) * y
    }

    /// The inverse of [`Frame::offset_to_map`]: pixels along the grid's normal of the direction.
    #[must_use]
    pub fn offset_to_grid(&self, angle_in_map: f64, offset: f64) -> f64 {
        let point = [-libm::sin(angle_in_map) * offset, libm::cos(angle_in_map) * offset];
        let [x, y] = self.to_pixels(point);
        let angle = self.angle_to_grid(angle_in_map);
        -libm::sin(angle) * x + libm::cos(angle) * y
    }
}

/// An undirected angle, in [-pi/2, pi/2).
#[must_use]
pub fn undirected(angle: f64) -> f64 {
    use std::f64::consts::{FRAC_PI_2, PI};
    let turned = angle + FRAC_PI_2;
    // Mostly it is one already.
    let turned = if (0.0..PI).contains(&turned) { turned } else { turned.rem_euclid(PI) } - FRAC_PI_2;
    if turned >= FRAC_PI_2 { -FRAC_PI_2 } else { turned }
}

/// The angle between two undirected directions, in [0, pi/2].
#[must_use]
pub fn angle_between(a: f64, b: f64) -> f64 {
    use std::f64::consts::PI;
    let between = (a - b).abs();
    // Almost always both are in [-pi/2, pi/2), or so near to it as rounding brings them.
    if between < 1.5 * PI { between.min((PI - between).abs()) } else { undirected(between).abs() }
}

/// An occupancy grid, borrowed: nothing is copied or converted.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    pixels: &'a [u8],
    bottom_up: bool,
    /// The lowest row that is at hand, and how many are.
    first: usize,
    count: usize,
    /// What each value means.
    pub table: &'a Table,
    /// Where it lies.
    pub frame: Frame,
}

impl<'a> Grid<'a> {
    /// A grid over `pixels`, row after row without gaps; `bottom_up` when the first row is the lowest, as in a
    /// `nav_msgs/OccupancyGrid`, else the first row is the top one, as in a picture.
    ///
    /// # Panics
    /// When the number of pixels is not `width * height`: the caller's bug.
    #[must_use]
    pub fn new(pixels: &'a [u8], bottom_up: bool, table: &'a Table, frame: Frame) -> Self {
        Self::part(pixels, bottom_up, table, frame, 0..frame.height)
    }

    /// A grid of which only some rows are at hand, counted from the bottom: of the others nothing may be asked. The
    /// frame is that of the whole map.
    ///
    /// # Panics
    /// When the number of pixels is not that of these rows: the caller's bug.
    #[must_use]
    pub fn part(pixels: &'a [u8], bottom_up: bool, table: &'a Table, frame: Frame, rows: Range<usize>) -> Self {
        assert_eq!(pixels.len(), frame.width * rows.len(), "pixels of the grid");
        Self { pixels, bottom_up, first: rows.start, count: rows.len(), table, frame }
    }

    /// Row `y` counted from the bottom, left to right.
    #[must_use]
    pub fn row(&self, y: usize) -> &'a [u8] {
        let width = self.frame.width;
        let lies = if self.bottom_up { y - self.first } else { self.first + self.count - 1 - y };
        &self.pixels[lies * width..(lies + 1) * width]
    }

    /// All pixels as they lie, where the first of the lowest row does among them, and how far from there the next row is.
    pub(crate) fn lying(&self) -> (&'a [u8], usize, isize) {
        let width = self.frame.width;
        let lowest = if self.bottom_up { 0 } else { self.pixels.len().saturating_sub(width) };
        (self.pixels, lowest, if self.bottom_up { width as isize } else { -(width as isize) })
    }

    /// What is at a point of the map frame; nothing is known beyond the map.
    pub(crate) fn state_at(&self, point: [f64; 2]) -> State {
        self.pixel_at(point).map_or(State::Unknown, |pixel| self.state_of(pixel))
    }

    /// Column and row of the pixel that a point of the map frame lies in.
    pub(crate) fn pixel_at(&self, point: [f64; 2]) -> Option<[usize; 2]> {
        let [x, y] = self.frame.to_pixels(point);
        let is_inside = (0.0..self.frame.width as f64).contains(&x) && (0.0..self.frame.height as f64).contains(&y);
        is_inside.then_some([whole(x), whole(y)])
    }

    pub(crate) fn state_of(&self, [x, y]: [usize; 2]) -> State {
        self.table.states[usize::from(self.row(y)[x])]
    }
}

/// A directed angle, in [-pi, pi).
#[must_use]
pub fn turned(angle: f64) -> f64 {
    use std::f64::consts::PI;
    (angle + PI).rem_euclid(2.0 * PI) - PI
}

/// Rounded to micrometres (or millionths): finer than any map means, and short to write.
#[must_use]
pub fn tidy(value: f64) -> f64 {
    rounded(value * 1e6) / 1e6 + 0.0
}

/// As `f64::round` does, without the call that it is on machines that may lack the instruction, and without a branch that
/// nobody can foretell: this is asked of every coordinate of millions. What is rounded to zero has no sign.
pub(crate) fn rounded(value: f64) -> f64 {
    let whole = value as i64 as f64;
    let rest = value - whole;
    let rounded = whole + f64::from(u8::from(rest >= 0.5)) - f64::from(u8::from(rest <= -0.5));
    // From 2^52 on every float is whole.
    if value.abs() < 4_503_599_627_370_496.0 { rounded } else { value }
}

/// The whole part of a number as an index: of what is below zero nothing, and 2^32 - 1 at most. By way of 32 bits, which is a
/// step less for most machines than 64 are.
pub(crate) fn whole(value: f64) -> usize {
    value as u32 as usize
}

/// The nearest whole number as an index, of what is not below zero: as [`rounded`] has it.
pub(crate) fn nearest(value: f64) -> usize {
    let whole = value as u32;
    whole as usize + usize::from(value - f64::from(whole) >= 0.5)
}

/// An angle rounded to a billionth of a radian: a micrometre at a kilometre.
#[must_use]
pub fn tidy_angle(angle: f64) -> f64 {
    undirected((angle * 1e9).round() / 1e9) + 0.0
}
