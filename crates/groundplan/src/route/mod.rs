//! The shortest way between two points that keeps a clearance: over free pixels, pulled taut.
//!
//! What is known of the free space is either the map's own pixels or what a survey kept of them. Pixels that have an
//! occupied one within the clearance are taken out once; each way is then found over what is left.

mod jump;
mod sight;
mod space;

use crate::ends::around;
use crate::grid::{Frame, Grid, State, tidy};
use sight::pull;
use space::{Bits, Pixel, Space};

/// The ways through a map that keep a clearance.
#[derive(Clone, Debug)]
pub struct Ways {
    frame: Frame,
    space: Space,
}

/// What a survey knows of the free space, metres in the map frame.
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    /// Free within an odd number of these.
    pub rings: Vec<Vec<[f64; 2]>>,
    /// Something occupied lies along these.
    pub taken: Vec<[[f64; 2]; 2]>,
    /// What lies within any of these is as if it were occupied.
    pub closed: Vec<Vec<[f64; 2]>>,
}

/// One blank pixel on all sides.
const BORDER: usize = 1;

impl Ways {
    /// Over the free pixels of a map. Every point of a way is at least `clearance` metres from every occupied pixel,
    /// its corners included, and within free pixels; pixels within any of some rings (metres in the map frame) are taken
    /// as occupied.
    #[must_use]
    pub fn of_map(grid: &Grid, closed: &[Vec<[f64; 2]>], clearance: f64) -> Self {
        let (width, height) = (grid.frame.width, grid.frame.height);
        let mut free = Bits::new(width + 2 * BORDER, height + 2 * BORDER);
        let mut occupied = free.clone();
        let states =
            grid.table.states.map(|state| (u64::from(state == State::Free), u64::from(state == State::Occupied)));
        for y in 0..height {
            let words = free.stride;
            let start = (y + BORDER) * words;
            for (x, &value) in (BORDER..).zip(grid.row(y)) {
                let (is_free, is_occupied) = states[usize::from(value)];
                free.words[start + x / 64] |= is_free << (x % 64);
                occupied.words[start + x / 64] |= is_occupied << (x % 64);
            }
        }
        close(&grid.frame, closed, &mut free, &mut occupied);
        Self::new(grid.frame, free, occupied, clearance)
    }

    /// Over what a survey knows of the free space. The clearance is kept from what it has as taken and from what it
    /// does not have as free.
    #[must_use]
    pub fn of_survey(frame: &Frame, evidence: &Evidence, clearance: f64) -> Self {
        let (width, height) = (frame.width, frame.height);
        let mut free = Bits::new(width + 2 * BORDER, height + 2 * BORDER);
        fill(frame, &evidence.rings, &mut free);
        for ends in &evidence.taken {
            let [p, q] = ends.map(|p| frame.to_pixels(p));
            let steps = (2.0 * libm::hypot(q[0] - p[0], q[1] - p[1])).ceil().max(1.0);
            for n in 0..=steps as usize {
                let t = n as f64 / steps;
                let [x, y] = [0, 1].map(|axis| (p[axis] + t * (q[axis] - p[axis])).floor());
                if x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64 {
                    let (x, y) = (x as usize + BORDER, y as usize + BORDER);
                    free.row_mut(y)[x / 64] &= !(1 << (x % 64));
                }
            }
        }
        let mut occupied = Bits::new(free.width, free.height);
        for y in BORDER..=height {
            occupied.fill(y, BORDER, width + BORDER);
        }
        occupied.words.iter_mut().zip(&free.words).for_each(|(occupied, free)| *occupied &= !free);
        close(frame, &evidence.closed, &mut free, &mut occupied);
        Self::new(*frame, free, occupied, clearance)
    }

    fn new(frame: Frame, free: Bits, occupied: Bits, clearance: f64) -> Self {
        // No map has room for more.
        let most = (frame.width + frame.height) as f64;
        Self { frame, space: Space::new(free, occupied, (clearance / frame.resolution).min(most)) }
    }

    /// Whether a robot's middle may be at a point.
    #[must_use]
    pub fn is_open(&self, point: [f64; 2]) -> bool {
        self.pixel(point).is_some()
    }

    /// The middle of the pixel nearest to a point where a robot may be, no farther than `reach` metres.
    #[must_use]
    pub fn nearest(&self, point: [f64; 2], reach: f64) -> Option<[f64; 2]> {
        let [x, y] = self.space.tight.nearest(self.place(point), reach / self.frame.resolution)?;
        Some(self.point([x as f64 + 0.5, y as f64 + 0.5]))
    }

    /// The way between two points where a robot may be, both included; nothing when there is none.
    #[must_use]
    pub fn route(&self, from: [f64; 2], to: [f64; 2]) -> Option<Vec<[f64; 2]>> {
        let ends = [self.pixel(from)?, self.pixel(to)?];
        if ends[0] == ends[1] {
            return Some(vec![from, to]);
        }
        let space = &self.space;
        let roomy = match ends.map(|end| space.roomy_beside(end)) {
            [Some(start), Some(end)] => jump::find(&space.roomy, start, end),
            _ => None,
        };
        let steps = roomy.or_else(|| jump::find(&space.tight, ends[0], ends[1]))?;
        let centre = |&[x, y]: &Pixel| [x as f64 + 0.5, y as f64 + 0.5];
        let mut way = vec![self.place(from), centre(&ends[0])];
        way.extend(steps.iter().map(centre));
        way.extend([centre(&ends[1]), self.place(to)]);
        way.dedup();
        let mut points: Vec<[f64; 2]> = pull(&space.safe, &way).into_iter().map(|p| self.point(p)).collect();
        // As they were given, not as they come back from pixels.
        let last = points.len() - 1;
        (points[0], points[last]) = (from, to);
        Some(points)
    }

    /// Places are in pixels, counted from the corner of the blank border.
    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        self.frame.to_pixels(point).map(|p| p + BORDER as f64)
    }

    fn point(&self, place: [f64; 2]) -> [f64; 2] {
        self.frame.to_metres(place.map(|p| p - BORDER as f64)).map(tidy)
    }

    fn pixel(&self, point: [f64; 2]) -> Option<Pixel> {
        self.space.pixel(self.place(point))
    }
}

/// Sets the pixels whose middles lie within an odd number of rings.
fn fill(frame: &Frame, rings: &[Vec<[f64; 2]>], pixels: &mut Bits) {
    let (width, height) = (frame.width, frame.height);
    let rings: Vec<Vec<[f64; 2]>> =
        rings.iter().map(|ring| ring.iter().map(|&point| frame.to_pixels(point)).collect()).collect();
    let row = |y: f64| (y - 0.5).ceil().clamp(0.0, height as f64) as usize;
    let [first, end] = around(rings.iter().flatten().map(|point| point[1])).map(row);
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); end.saturating_sub(first)];
    for ring in &rings {
        for (&p, &q) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let (low, high) = if p[1] < q[1] { (p, q) } else { (q, p) };
            for y in row(low[1])..row(high[1]) {
                let part = (y as f64 + 0.5 - low[1]) / (high[1] - low[1]);
                crossings[y.saturating_sub(first)].push(low[0] + part * (high[0] - low[0]));
            }
        }
    }
    for (y, crossed) in (first + BORDER..).zip(&mut crossings) {
        crossed.sort_by(f64::total_cmp);
        for pair in crossed.chunks_exact(2) {
            let [from, to] = [pair[0], pair[1]].map(|x| (x - 0.5).ceil().clamp(0.0, width as f64) as usize);
            pixels.fill(y, from + BORDER, to + BORDER);
        }
    }
}

/// Takes what lies within any of some rings as occupied.
fn close(frame: &Frame, rings: &[Vec<[f64; 2]>], free: &mut Bits, occupied: &mut Bits) {
    for ring in rings {
        fill(frame, std::slice::from_ref(ring), occupied);
    }
    free.words.iter_mut().zip(&occupied.words).for_each(|(free, occupied)| *free &= !occupied);
}
