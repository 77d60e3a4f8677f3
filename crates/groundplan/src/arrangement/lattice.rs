//! Lines with whole-number coefficients and points as fractions: every question (which side, which comes first, do three
//! meet in one point) has an exact answer. Floats are asked first and trusted only where they are far from a tie.

use std::cmp::Ordering;

/// Bits after the point of the lattice.
pub const BITS: u32 = 26;
/// Floats closer than this many pixels are asked again exactly.
pub const TIE_PIXELS: f64 = 1e-6;

/// A line `a x + b y = c` over the grid in pixels; (a, b) is the direction's normal, all times 2^26.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatticeLine {
    /// Coefficient of x.
    pub a: i64,
    /// Coefficient of y.
    pub b: i64,
    /// Offset along the normal.
    pub c: i64,
}

/// A point as fractions over one denominator, in pixels.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub x: i128,
    pub y: i128,
    pub over: i128,
}

impl Point {
    pub fn new(x: i128, y: i128, over: i128) -> Self {
        if over < 0 { Self { x: -x, y: -y, over: -over } } else { Self { x, y, over } }
    }

    pub fn to_floats(self) -> [f64; 2] {
        [self.x as f64 / self.over as f64, self.y as f64 / self.over as f64]
    }

    /// Rows of pixels whose centres lie below: ceil(y - 1/2).
    pub fn rows_below(self, y: f64, height: usize) -> u32 {
        let whole = (y + 0.5) as i64;
        let part = (y + 0.5) - whole as f64;
        let rows = if part > TIE_PIXELS && part < 1.0 - TIE_PIXELS {
            whole
        } else {
            let (n, d) = (2 * self.y - self.over, 2 * self.over);
            -((-n).div_euclid(d)) as i64
        };
        rows.clamp(0, height as i64) as u32
    }
}

/// Where a line meets the border: side (0 bottom, 1 right, 2 top, 3 left) and the point.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub side: u8,
    pub point: Point,
}

/// The ends of a line's piece within a map of so many pixels, unless it misses the interior. It runs with growing x, or
/// with falling y when it is vertical: along (b, -a), as all lines do.
pub fn clip(line: LatticeLine, size: [i64; 2]) -> Option<[End; 2]> {
    let LatticeLine { a, b, c } = line;
    let (a, b, c) = (i128::from(a), i128::from(b), i128::from(c));
    let [width, height] = size.map(i128::from);
    let at_x = |x: i128, side: u8| End { side, point: Point::new(x * b, c - a * x, b) };
    let at_y = |y: i128, side: u8| End { side, point: Point::new(c - b * y, y * a, a) };
    if a == 0 {
        let inside = 0 < c * b.signum() && c.abs() < height * b.abs();
        return inside.then(|| [at_x(0, 3), at_x(width, 1)]);
    }
    let rising = a < 0;
    if b == 0 {
        let inside = 0 < c * a.signum() && c.abs() < width * a.abs();
        let (low, high) = (at_y(0, 0), at_y(height, 2));
        return inside.then_some(if rising { [low, high] } else { [high, low] });
    }
    let (enter_y, leave_y) = if rising { (at_y(0, 0), at_y(height, 2)) } else { (at_y(height, 2), at_y(0, 0)) };
    // A corner belongs to the side that starts there, going round counter-clockwise.
    let x_cmp = |end: &End, x: i128| end.point.x.cmp(&(x * end.point.over));
    let by_left_side = match x_cmp(&enter_y, 0) {
        Ordering::Less => true,
        Ordering::Equal => !rising,
        Ordering::Greater => false,
    };
    let by_right_side = match x_cmp(&leave_y, width) {
        Ordering::Greater => true,
        Ordering::Equal => !rising,
        Ordering::Less => false,
    };
    let enter = if by_left_side { at_x(0, 3) } else { enter_y };
    let leave = if by_right_side { at_x(width, 1) } else { leave_y };
    let (p, q) = (enter.point, leave.point);
    (p.x * q.over < q.x * p.over).then_some([enter, leave])
}

/// Order of border points going round counter-clockwise from the lower left corner.
pub fn around(p: &End, q: &End) -> Ordering {
    p.side.cmp(&q.side).then_with(|| {
        let axis = |e: &End| if e.side % 2 == 0 { e.point.x } else { e.point.y };
        let along = (axis(p) * q.point.over).cmp(&(axis(q) * p.point.over));
        if p.side < 2 { along } else { along.reverse() }
    })
}
