//! What stands by itself in free space: furniture and posts, which part nothing, and solid things, which have no jambs.

use super::raster::Raster;
use super::runs::{Run, touching};
use crate::sets::Sets;

/// Something small in free space, pixels.
#[derive(Clone, Copy, Debug)]
pub struct Island {
    pub middle: [f64; 2],
    pub length: f64,
    pub thickness: f64,
}

/// What stands by itself in free space and is no longer than this, metres, is a chair's or a table's leg, no wall.
const LEG: f64 = 0.8;
/// The same for what is not slim: bins, pillars; a wall is less thick than this share of its length.
const BLOB: f64 = 1.5;
const SLIM: f64 = 0.4;
/// What stands by itself, is so thick (from, to), metres, and fills its rectangle by this share, is no wall: no door
/// has a jamb there.
const SOLID: (f64, f64) = (0.7, 4.0);
const FILLED: f64 = 0.97;

/// Runs of pixels in ascending order.
#[derive(Default)]
pub struct Spans(Vec<Run>);

impl Spans {
    pub fn contains(&self, pixel: usize) -> bool {
        let after = self.0.partition_point(|run| run.pixels().end <= pixel);
        self.0.get(after).is_some_and(|run| run.pixels().start <= pixel)
    }

    /// How many of them lie within a run.
    pub fn within(&self, run: &Run) -> usize {
        let pixels = run.pixels();
        let first = self.0.partition_point(|span| span.pixels().end <= pixels.start);
        let spans = self.0[first..].iter().map(Run::pixels).take_while(|span| span.start < pixels.end);
        spans.map(|span| span.end.min(pixels.end) - span.start.max(pixels.start)).sum()
    }

    pub fn runs(&self) -> &[Run] {
        &self.0
    }
}

/// What was found of the islands.
#[derive(Default)]
pub struct Islands {
    /// The small ones, in the order of their first pixels.
    pub small: Vec<Island>,
    /// Pixels of those that are too small or too stout for a wall.
    pub filled: Spans,
    /// Pixels of those that are too thick for one.
    pub solid: Spans,
}

/// Sums over the pixels of an island, from its first one.
#[derive(Clone, Copy, Default)]
struct Sums {
    first: [f64; 2],
    count: f64,
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Sums {
    fn add(&mut self, [x, y]: [f64; 2], length: f64) {
        if self.count == 0.0 {
            self.first = [x, y];
        }
        let (x, y) = (x - self.first[0], y - self.first[1]);
        // x, x + 1, and so on, and their squares.
        let steps = length * (length - 1.0) / 2.0;
        let squares = steps * (2.0 * length - 1.0) / 3.0;
        let sum = length * x + steps;
        self.count += length;
        self.x += sum;
        self.y += length * y;
        self.xx += length * x * x + 2.0 * x * steps + squares;
        self.xy += sum * y;
        self.yy += length * y * y;
    }

    /// The middle, and length and thickness of the rectangle with the same second moments.
    fn extent(&self) -> ([f64; 2], [f64; 2]) {
        let n = self.count;
        let (xx, xy, yy) = (
            (self.xx - self.x * self.x / n) / n,
            (self.xy - self.x * self.y / n) / n,
            (self.yy - self.y * self.y / n) / n,
        );
        let (middle, half) = (f64::midpoint(xx, yy), ((0.5 * (xx - yy)).powi(2) + xy * xy).sqrt());
        let sides = [middle + half, middle - half].map(|m| (12.0 * m.max(0.0) + 1.0).sqrt());
        ([(n * self.first[0] + self.x) / n, (n * self.first[1] + self.y) / n], sides)
    }
}

/// All that is not seen free in runs, of which thing each is a part, and how many things there are. The first hangs together
/// with the raster's border, from which the first run is.
fn things(raster: &Raster) -> (Vec<Run>, Vec<u32>, usize) {
    let width = raster.width;
    let mut runs: Vec<Run> = Vec::new();
    for y in 0..raster.height {
        runs.extend(raster.free.runs(y * width..(y + 1) * width, false).map(|run| Run::new(&run, 0)));
    }
    let mut sets = Sets::new(runs.len());
    touching(&runs, width, 1, |own, below| sets.join_first(own as u32, below as u32));
    let (numbers, count) = sets.numbered();
    (runs, numbers, count)
}

/// Pixels of what hangs together with the raster's border: no island's. There are many, which is why they are not kept.
pub fn border(raster: &Raster) -> Spans {
    let (runs, numbers, _) = things(raster);
    Spans(runs.into_iter().zip(numbers).filter(|(_, number)| *number == 1).map(|(run, _)| run).collect())
}

/// Looks at all that is not seen free and does not hang together with the raster's border.
pub fn find(raster: &Raster) -> Islands {
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        None,
        Filled,
        Solid,
    }
    let (runs, numbers, count) = things(raster);
    let mut sums = vec![Sums::default(); count + 1];
    for (run, &number) in runs.iter().zip(&numbers) {
        sums[number as usize].add(raster.place(run.pixels().start), run.len() as f64);
    }
    let mut found = Islands::default();
    let mut marks = vec![Mark::None; count + 1];
    // The first is no island.
    for (mark, sums) in marks.iter_mut().zip(&sums).skip(2) {
        let (middle, [length, thickness]) = sums.extent();
        if length <= raster.pixels(BLOB) {
            found.small.push(Island { middle, length, thickness });
        }
        let longest = length.min(raster.pixels(BLOB));
        if length <= raster.pixels(LEG) || (length <= longest && thickness >= SLIM * length) {
            *mark = Mark::Filled;
        } else if (raster.pixels(SOLID.0)..=raster.pixels(SOLID.1)).contains(&thickness)
            && sums.count >= FILLED * length * thickness
        {
            *mark = Mark::Solid;
        }
    }
    let marked = |wanted: Mark| {
        let runs = runs.iter().zip(&numbers).filter(|(_, number)| marks[**number as usize] == wanted);
        Spans(runs.map(|(run, _)| *run).collect())
    };
    found.filled = marked(Mark::Filled);
    found.solid = marked(Mark::Solid);
    found
}
