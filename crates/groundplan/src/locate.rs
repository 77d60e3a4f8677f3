//! Which face holds a point; exact on the lattice, so that every point of the map is in one face.
//!
//! Two families of lines, those with the most lines, say by halving in which cell of theirs the point lies; from a face
//! of that cell on, lines are crossed that part the face from the point. Each crossing leaves one less of them.

use crate::arrangement::{Arrangement, NONE, arrange};
use crate::ends::{around, sorted};
use crate::grid::Frame;
use crate::lines::Lines;
use std::collections::BTreeSet;

/// Lattice steps of a pixel.
const STEPS: f64 = (1u64 << 26) as f64;

/// An index over the faces of an arrangement.
#[derive(Clone, Debug)]
pub struct Locator {
    frame: Frame,
    arrangement: Arrangement,
    families: [Family; 2],
    /// Faces by their places between the lines of the two families, ascending.
    keys: Vec<(u64, u32)>,
}

/// Parallel lines `a x + b y = c` with ascending offsets.
#[derive(Clone, Debug, Default)]
struct Family {
    a: i64,
    b: i64,
    offsets: Vec<i64>,
}

/// A point in lattice steps.
type Step = [i64; 2];

impl Family {
    /// a x + b y of a point; an offset is to be taken times 2^26 beside it.
    fn value(&self, [x, y]: Step) -> i128 {
        i128::from(self.a) * i128::from(x) + i128::from(self.b) * i128::from(y)
    }

    /// How many of the lines have the point on them or on the side of their normal.
    fn place(&self, point: Step) -> u64 {
        let value = self.value(point);
        self.offsets.partition_point(|&c| i128::from(c) << 26 <= value) as u64
    }
}

impl Locator {
    /// Of the faces that the lines make, numbered as in their subdivision.
    #[must_use]
    pub fn new(frame: &Frame, angles: &[f64], lines: &Lines) -> Self {
        let arrangement = arrange(frame, angles, lines, 1);
        let used = |n: &usize| !arrangement.line_edges[*n].is_empty();
        let mut crossing: Vec<usize> = (0..arrangement.lines.len()).filter(used).collect();
        crossing.sort_by_key(|&n| (arrangement.lines[n].a, arrangement.lines[n].b, arrangement.lines[n].c));
        let mut groups: Vec<&[usize]> = crossing
            .chunk_by(|&p, &q| {
                let (p, q) = (arrangement.lines[p], arrangement.lines[q]);
                (p.a, p.b) == (q.a, q.b)
            })
            .collect();
        groups.sort_by_key(|group| std::cmp::Reverse(group.len()));
        let family = |n: usize| {
            let group = *groups.get(n)?;
            let first = arrangement.lines[*group.first()?];
            let offsets = group.iter().map(|&n| arrangement.lines[n].c).collect();
            Some(Family { a: first.a, b: first.b, offsets })
        };
        let families = [family(0).unwrap_or_default(), family(1).unwrap_or_default()];
        let mut made = Self { frame: *frame, arrangement, families, keys: Vec::new() };
        let mut keys: Vec<(u64, u32)> = (0..).zip(made.places()).map(|(face, key)| (key, face)).collect();
        keys.sort_unstable();
        made.keys = keys;
        made
    }

    /// The arrangement that the faces are of.
    #[must_use]
    pub fn arrangement(&self) -> &Arrangement {
        &self.arrangement
    }

    /// The key of each face, by walking from face to face: across a line of a family the place there changes by one.
    fn places(&self) -> Vec<u64> {
        let arrangement = &self.arrangement;
        let step = |half: u32| {
            let line = arrangement.lines[arrangement.edge_lines[(half >> 1) as usize] as usize];
            let shift = self.families.iter().zip([32, 0]).find(|(f, _)| (f.a, f.b) == (line.a, line.b));
            shift.map_or(0u64, |(_, shift)| 1 << shift)
        };
        let mut keys = vec![u64::MAX; arrangement.face_count()];
        let Some(first) = keys.first_mut() else { return keys };
        // Face 0 is as good as any; its place follows from a point within it.
        *first = self.key(self.middle(0));
        let mut stack = vec![0usize];
        while let Some(face) = stack.pop() {
            for &half in arrangement.around(face) {
                let beside = arrangement.face(Arrangement::twin(half));
                if beside != NONE && keys[beside as usize] == u64::MAX {
                    // An even half-edge runs as its line does and has the normal's side on its left.
                    let step = step(half);
                    keys[beside as usize] =
                        if half & 1 == 0 { keys[face].wrapping_sub(step) } else { keys[face].wrapping_add(step) };
                    stack.push(beside as usize);
                }
            }
        }
        keys
    }

    fn key(&self, point: Step) -> u64 {
        self.families[0].place(point) << 32 | self.families[1].place(point)
    }

    /// The middle of a face's vertices.
    fn middle(&self, face: usize) -> Step {
        let around = self.arrangement.around(face);
        let (mut x, mut y) = (0.0, 0.0);
        for &half in around {
            let [vx, vy] = self.arrangement.vertices[self.arrangement.start(half) as usize];
            (x, y) = (x + vx, y + vy);
        }
        [x, y].map(|sum| (sum / around.len() as f64 * STEPS).round() as i64)
    }

    /// The face that holds a point, metres in the map frame; none outside the map or for what is no number. The point
    /// is rounded to 2^-26 of a pixel. One on a line belongs to the side of the line's normal, one on the map's border
    /// to the map.
    #[must_use]
    pub fn locate(&self, point: [f64; 2]) -> Option<u32> {
        let pixels = self.frame.to_pixels(point);
        let inside = (0.0..=self.frame.width as f64).contains(&pixels[0])
            && (0.0..=self.frame.height as f64).contains(&pixels[1]);
        inside.then(|| self.locate_step(pixels.map(|p| (p * STEPS).round() as i64)))
    }

    fn locate_step(&self, point: Step) -> u32 {
        let key = self.key(point);
        let found = self.keys.partition_point(|entry| entry.0 < key).min(self.keys.len() - 1);
        let mut face = self.keys[found].1;
        // A line that is crossed is never crossed again, so there are no more crossings than lines.
        for _ in 0..=self.arrangement.lines.len() {
            let beyond = self.arrangement.around(face as usize).iter().find_map(|&half| {
                let line = self.arrangement.edge_lines[(half >> 1) as usize];
                let line = self.arrangement.lines.get(line as usize)?;
                let value = i128::from(line.a) * i128::from(point[0]) + i128::from(line.b) * i128::from(point[1]);
                let left = value >= i128::from(line.c) << 26;
                let beside = self.arrangement.face(Arrangement::twin(half));
                (left != (half & 1 == 0) && beside != NONE).then_some(beside)
            });
            match beyond {
                Some(beside) => face = beside,
                None => break,
            }
        }
        face
    }

    /// The faces that a straight line between two points of the map passes through, in order; metres.
    #[must_use]
    pub fn between(&self, from: [f64; 2], to: [f64; 2]) -> Vec<u32> {
        let (p, q) = (self.frame.to_pixels(from), self.frame.to_pixels(to));
        let mut cuts = vec![0.0, 1.0];
        for (line, edges) in self.arrangement.lines.iter().zip(&self.arrangement.line_edges) {
            if edges.is_empty() {
                continue;
            }
            let side = |v: [f64; 2]| (line.a as f64 * v[0] + line.b as f64 * v[1]) - line.c as f64;
            let (a, b) = (side(p), side(q));
            if (a < 0.0) != (b < 0.0) {
                cuts.push(a / (a - b));
            }
        }
        cuts.sort_by(f64::total_cmp);
        let middle = |pair: &[f64]| {
            let t = f64::midpoint(pair[0], pair[1]);
            self.locate([from[0] + (to[0] - from[0]) * t, from[1] + (to[1] - from[1]) * t])
        };
        let mut faces: Vec<u32> = cuts.windows(2).filter(|pair| pair[1] - pair[0] > 1e-12).filter_map(middle).collect();
        faces.dedup();
        faces
    }
}

/// A side of a polygon: its number, from, to.
type Side = (u32, [f64; 2], [f64; 2]);

/// Which polygons hold a point.
#[derive(Clone, Debug, Default)]
pub struct Polygons {
    /// By the bands of y that they touch, in the polygons' order.
    sides: Vec<Side>,
    offsets: Vec<u32>,
    low: f64,
    bands_per_metre: f64,
}

impl Polygons {
    /// Of rings, each with the number of its polygon; a ring within another of the same polygon is a hole.
    #[must_use]
    pub fn new(rings: &[(u32, Vec<[f64; 2]>)]) -> Self {
        let mut rings: Vec<&(u32, Vec<[f64; 2]>)> = rings.iter().filter(|ring| !ring.1.is_empty()).collect();
        rings.sort_by_key(|ring| ring.0);
        let sides = || {
            rings.iter().flat_map(|(polygon, ring)| {
                ring.iter().zip(ring.iter().cycle().skip(1)).map(move |(&p, &q)| (*polygon, p, q))
            })
        };
        let [low, high] = around(sides().map(|s| s.1[1]));
        let bands = sides().count().clamp(1, 1 << 12);
        let bands_per_metre = if high > low { bands as f64 / (high - low) } else { 0.0 };
        let mut made = Self { sides: Vec::new(), offsets: Vec::new(), low, bands_per_metre };
        let mut lists: Vec<Vec<Side>> = vec![Vec::new(); bands + 1];
        for side in sides() {
            let [from, to] = sorted([side.1[1], side.2[1]]).map(|y| made.band(y));
            lists[from.min(bands)..=to.min(bands)].iter_mut().for_each(|list| list.push(side));
        }
        made.offsets.push(0);
        for list in lists {
            made.sides.extend(list);
            made.offsets.push(made.sides.len() as u32);
        }
        made
    }

    fn band(&self, y: f64) -> usize {
        ((y - self.low) * self.bands_per_metre).max(0.0) as usize
    }

    /// The numbers of the polygons that hold a point, ascending.
    #[must_use]
    pub fn holding(&self, [x, y]: [f64; 2]) -> Vec<u32> {
        let mut held: Vec<u32> = Vec::new();
        let band = self.band(y);
        if y.is_nan() || y < self.low || band + 1 >= self.offsets.len() {
            return held;
        }
        let sides = &self.sides[self.offsets[band] as usize..self.offsets[band + 1] as usize];
        for sides in sides.chunk_by(|a, b| a.0 == b.0) {
            let crossed =
                |(_, p, q): &&Side| (p[1] <= y) != (q[1] <= y) && x < p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
            if sides.iter().filter(crossed).count() % 2 == 1 {
                held.push(sides[0].0);
            }
        }
        held
    }
    /// The numbers of the polygons that hold a point of a way, of which one is asked every `step` metres, more than 0, and
    /// each bend; ascending.
    #[must_use]
    pub fn along(&self, way: &[[f64; 2]], step: f64) -> Vec<u32> {
        let held = way.windows(2).flat_map(|ends| {
            let [from, to] = [ends[0], ends[1]];
            let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
            let steps = (libm::hypot(dx, dy) / step).ceil().max(1.0) as usize;
            (0..=steps).flat_map(move |n| {
                let t = n as f64 / steps as f64;
                self.holding([from[0] + t * dx, from[1] + t * dy])
            })
        });
        held.collect::<BTreeSet<u32>>().into_iter().collect()
    }
}
