//! Where the lines of an arrangement cross rows of pixels, from row to row without a division.

use crate::arrangement::{Arrangement, LatticeLine, NONE};
use std::ops::{AddAssign, Range};

/// An edge that crosses rows of a band.
pub struct Crossing {
    /// The half of it that runs upwards.
    pub half: u32,
    /// The row after its last one.
    end: usize,
}

/// The edges that cross the rows of a band, as they follow one another along lines.
pub struct Crossings {
    pub walks: Vec<Walk>,
    pub edges: Vec<Crossing>,
}

/// Along a line from row to row.
pub struct Walk {
    rows: Range<usize>,
    /// The edge that crosses the row at hand, or one before it.
    edge: usize,
    /// How many pixels of the row lie left of it, less than nothing beyond the map, and the rest of that division.
    column: i64,
    rest: i64,
    /// What is added to both from row to row, and what the rest is less than.
    by: [i64; 2],
    divisor: i64,
}

impl Walk {
    /// Of edges of which the first crosses the first of some rows.
    fn new(line: Option<LatticeLine>, edge: usize, crossing: &Crossing, rows: Range<usize>, width: usize) -> Self {
        let Some(line) = line else {
            // Upwards along the right side of the map, downwards (so its twin upwards) along the left.
            let column = if crossing.half & 1 == 0 { width as i64 } else { 0 };
            return Self { rows, edge, column, rest: 0, by: [0; 2], divisor: 1 };
        };
        // How many centres lie left of it: rounded up.
        let up = if line.a < 0 { -1 } else { 1 };
        let divisor = up * 2 * line.a;
        let first = up * (2 * line.c - line.b * (2 * rows.start as i64 + 1) - line.a);
        let step = up * -2 * line.b;
        let divided = |n: i64| [-(-n).div_euclid(divisor), (-n).rem_euclid(divisor)];
        let [column, rest] = divided(first);
        Self { rows, edge, column, rest, by: divided(step), divisor }
    }

    /// Through some rows, which come after those before: adds to the edge that crosses each what is given for the row and
    /// how many pixels of it lie left of the edge.
    pub fn add<T: Copy + Default + AddAssign>(
        &mut self,
        rows: &Range<usize>,
        edges: &[Crossing],
        width: usize,
        sums: &mut [T],
        given: impl Fn(usize, usize) -> T,
    ) {
        let &mut Self { mut edge, mut column, mut rest, by, divisor, .. } = self;
        let (mut y, end) = (self.rows.start.max(rows.start), self.rows.end.min(rows.end));
        while y < end {
            while edges[edge].end <= y {
                edge += 1;
            }
            let mut sum = T::default();
            for y in y..end.min(edges[edge].end) {
                sum += given(y, column.clamp(0, width as i64) as usize);
                column += by[0];
                rest += by[1];
                if rest >= divisor {
                    rest -= divisor;
                    column -= 1;
                }
            }
            sums[edge] += sum;
            y = edges[edge].end;
        }
        (self.edge, self.column, self.rest) = (edge, column, rest);
    }
}

impl Crossings {
    /// Of rows of a map so many pixels wide.
    pub fn new(arrangement: &Arrangement, width: usize, band: &Range<usize>) -> Self {
        let (mut walks, mut edges) = (Vec::new(), Vec::new());
        // Those of one line, which are crossed one after another.
        let mut add = |line: Option<LatticeLine>, crossing: &mut Vec<(u32, Range<usize>)>| {
            crossing.sort_unstable_by_key(|(_, rows)| rows.start);
            let (Some(first), Some(last)) = (crossing.first(), crossing.last()) else { return };
            let (edge, rows) = (edges.len(), first.1.start..last.1.end);
            edges.extend(crossing.drain(..).map(|(half, rows)| Crossing { half, end: rows.end }));
            walks.push(Walk::new(line, edge, &edges[edge], rows, width));
        };
        let crossed = |edge: u32| {
            let [p, q] = arrangement.edges[edge as usize].map(|v| arrangement.rows_below[v as usize] as usize);
            let rows = p.min(q).max(band.start)..p.max(q).min(band.end);
            (!rows.is_empty()).then_some((2 * edge + u32::from(p > q), rows))
        };
        let mut crossing = Vec::new();
        for (line, edges) in arrangement.lines.iter().zip(&arrangement.line_edges) {
            if line.a == 0 || edges.is_empty() {
                continue;
            }
            // Along a line the rows only rise or only fall: the first edge of the band is found by halving.
            let rising = line.a < 0;
            let before = |&edge: &u32| {
                let end = arrangement.rows_below[arrangement.edges[edge as usize][1] as usize] as usize;
                if rising { end <= band.start } else { end >= band.end }
            };
            let mut low = edges.start;
            let mut high = edges.end;
            while low < high {
                let middle = low + (high - low) / 2;
                if before(&middle) {
                    low = middle + 1;
                } else {
                    high = middle;
                }
            }
            for edge in low..edges.end {
                let start = arrangement.rows_below[arrangement.edges[edge as usize][0] as usize] as usize;
                let is_beyond = if rising { start >= band.end } else { start <= band.start };
                if is_beyond {
                    break;
                }
                crossing.extend(crossed(edge));
            }
            add(Some(*line), &mut crossing);
        }
        let border = arrangement.edge_lines.iter().rposition(|&line| line != NONE).map_or(0, |n| n + 1);
        for edge in border as u32..arrangement.edges.len() as u32 {
            crossing.extend(crossed(edge));
            add(None, &mut crossing);
        }
        Self { walks, edges }
    }
}
