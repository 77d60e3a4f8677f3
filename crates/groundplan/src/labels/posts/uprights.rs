//! Uprights: small things that stand by themselves, such as the legs of a rack, the plates that join two of them and guards.

use crate::grid::Frame;
use crate::pixels::Pixels;
use crate::sets::Sets;

/// What is longer than this is no upright, metres; guards before two racks back to back are not.
const LONGEST: f64 = 3.3;
/// Edge pixels no further apart than this along either axis are of one thing.
const GAP: u32 = 2;
/// So many things at once are few.
const MANY: usize = 1 << 12;

/// Something small that stands by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Upright {
    /// Its middle in the map frame.
    pub at: [f64; 2],
    /// Variances of its pixels' places, of x, of both and of y, square metres.
    spread: [f64; 3],
}

impl Upright {
    /// At a point.
    #[cfg(test)]
    pub fn point(at: [f64; 2]) -> Self {
        Self { at, spread: [0.0; 3] }
    }

    /// How long it is along and across a heading, metres: as a box of the same spread.
    pub fn extents(&self, [cos, sin]: [f64; 2]) -> [f64; 2] {
        let [xx, xy, yy] = self.spread;
        let both = 2.0 * xy * cos * sin;
        [xx * cos * cos + both + yy * sin * sin, xx * sin * sin - both + yy * cos * cos]
            .map(|variance| (12.0 * variance.max(0.0)).sqrt())
    }
}

/// The uprights of a map, from its lowest row up, by its edge pixels.
pub fn find(frame: &Frame, edges: &Pixels) -> Vec<Upright> {
    let mut things = Things {
        sets: Sets::new(0),
        sums: Vec::new(),
        rows: Default::default(),
        row: (0, Vec::new()),
        longest: (LONGEST / frame.resolution) as u32,
        small: Vec::new(),
        many: MANY,
    };
    edges.iter().for_each(|pixel| things.add(pixel));
    things.end_row(0);
    things.rows = Default::default();
    things.let_go();
    things.small.sort_by_key(|sums| sums.first_run);
    things.small.iter().map(|sums| sums.upright(frame)).collect()
}

/// Edge pixels of a row one after another.
#[derive(Clone, Copy)]
struct Run {
    from: u32,
    to: u32,
    /// Which of the things it is of.
    thing: u32,
}

/// What the edge pixels of a map are of, row after row.
struct Things {
    sets: Sets,
    /// Of each thing, under its name.
    sums: Vec<Sums>,
    /// The last rows, the nearest first.
    rows: [(u32, Vec<Run>); GAP as usize],
    /// The row that is being read.
    row: (u32, Vec<Run>),
    /// What is as long along an axis, pixels, is not small.
    longest: u32,
    /// Those that are small, of all that have ended.
    small: Vec<Sums>,
    /// When there are so many, those that have ended are let go of.
    many: usize,
}

impl Things {
    fn add(&mut self, [x, y]: [u32; 2]) {
        if y != self.row.0 {
            self.end_row(y);
        }
        let run = match self.row.1.last_mut() {
            Some(run) if x.wrapping_sub(run.to) <= GAP => {
                run.to = x;
                run.thing
            }
            _ => {
                let thing = self.sets.add();
                self.sums.push(Sums { low: [x, y], first_run: [y, x], ..Sums::default() });
                self.row.1.push(Run { from: x, to: x, thing });
                thing
            }
        };
        self.sums[run as usize].add([x, y]);
    }

    /// Joins a row to those below it, and begins another one.
    fn end_row(&mut self, next: u32) {
        let Self { sets, sums, rows, row, .. } = self;
        for (_, below) in rows.iter().filter(|(y, _)| row.0.wrapping_sub(*y) <= GAP) {
            let mut first = 0;
            for run in &row.1 {
                while below.get(first).is_some_and(|other| other.to + GAP < run.from) {
                    first += 1;
                }
                for other in below[first..].iter().take_while(|other| other.from <= run.to + GAP) {
                    let [one, two] = [run.thing, other.thing].map(|thing| sets.of(thing));
                    if one != two {
                        let (one, two) = (one.min(two), one.max(two));
                        sets.join(one, two);
                        let more = std::mem::take(&mut sums[two as usize]);
                        sums[one as usize].join(&more);
                    }
                }
            }
        }
        rows.rotate_right(1);
        std::mem::swap(&mut rows[0], row);
        row.0 = next;
        row.1.clear();
        if self.sums.len() > self.many {
            self.let_go();
            self.many = MANY.max(2 * self.sums.len());
        }
    }

    /// Lets go of all things that have ended below the last rows, but for the small ones; the others keep their order.
    fn let_go(&mut self) {
        let Self { sets, sums, rows, longest, small, .. } = self;
        let mut goes_on = vec![false; sums.len()];
        let runs = || rows.iter().flat_map(|(_, runs)| runs);
        runs().for_each(|run| goes_on[sets.of(run.thing) as usize] = true);
        let is_small = |sums: &Sums| sums.count > 0 && (0..2).all(|axis| sums.high[axis] - sums.low[axis] < *longest);
        small.extend(sums.iter().zip(&goes_on).filter(|(sums, goes_on)| !**goes_on && is_small(sums)).map(|(s, _)| *s));
        let mut others = Sets::new(0);
        let names: Vec<u32> = goes_on.iter().map(|goes_on| if *goes_on { others.add() } else { 0 }).collect();
        for run in rows.iter_mut().flat_map(|(_, runs)| runs) {
            run.thing = names[sets.of(run.thing) as usize];
        }
        let mut goes_on = goes_on.into_iter();
        sums.retain(|_| goes_on.next().unwrap_or(false));
        *sets = others;
    }
}

/// Sums over pixels.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: u32,
    /// Row and column where its first run begins.
    first_run: [u32; 2],
    low: [u32; 2],
    high: [u32; 2],
    /// Of columns and rows.
    first: [u64; 2],
    /// Of the squares of columns, of columns times rows, and of the squares of rows.
    second: [u64; 3],
}

impl Sums {
    fn add(&mut self, pixel: [u32; 2]) {
        self.count += 1;
        let [x, y] = pixel.map(u64::from);
        for (axis, at) in pixel.into_iter().enumerate() {
            self.high[axis] = self.high[axis].max(at);
            self.first[axis] += u64::from(at);
        }
        self.second = [self.second[0] + x * x, self.second[1] + x * y, self.second[2] + y * y];
    }

    fn join(&mut self, more: &Self) {
        self.count += more.count;
        for axis in 0..2 {
            self.low[axis] = self.low[axis].min(more.low[axis]);
            self.high[axis] = self.high[axis].max(more.high[axis]);
            self.first[axis] += more.first[axis];
        }
        for (sum, more) in self.second.iter_mut().zip(more.second) {
            *sum += more;
        }
    }

    fn upright(&self, frame: &Frame) -> Upright {
        let count = f64::from(self.count);
        let mean = self.first.map(|sum| sum as f64 / count);
        let spread = |n: usize, [a, b]: [usize; 2]| self.second[n] as f64 / count - mean[a] * mean[b];
        // A pixel is as wide as it is; the spread of the pixels turns with the map.
        let own = 1.0 / 12.0;
        let [xx, xy, yy] = [spread(0, [0, 0]) + own, spread(1, [0, 1]), spread(2, [1, 1]) + own];
        let (sin, cos) = (libm::sin(frame.origin[2]), libm::cos(frame.origin[2]));
        let both = 2.0 * xy * cos * sin;
        let turned = [
            xx * cos * cos - both + yy * sin * sin,
            (xx - yy) * cos * sin + xy * (cos * cos - sin * sin),
            xx * sin * sin + both + yy * cos * cos,
        ];
        let scale = frame.resolution.powi(2);
        Upright { at: frame.to_metres(mean.map(|at| at + 0.5)), spread: turned.map(|variance| variance * scale) }
    }
}
