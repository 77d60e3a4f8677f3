//! II-C: Vertices, Edges, Faces and N of the paper; and every invariant in one place.

use crate::arrangement::{Arrangement, NONE};
use crate::bands::each;
use crate::grid::{Frame, tidy};

/// The subdivision: what the lines cut the map into. Ragged lists are values with offsets.
#[derive(Clone, Debug, Default)]
pub struct Subdivision {
    /// Vertices, metres in the map frame.
    pub vertices: Vec<[f64; 2]>,
    /// First and last vertex of each edge.
    pub edge_vertices: Vec<[u32; 2]>,
    /// Line of each edge; [`NONE`] on the border.
    pub edge_lines: Vec<u32>,
    /// N: the faces on the left and on the right of each edge; [`NONE`] outside.
    pub edge_faces: Vec<[u32; 2]>,
    /// Vertices of the faces, counter-clockwise; face f has those from `face_offsets[f]` to `face_offsets[f + 1]`.
    pub face_vertices: Vec<u32>,
    /// Edges of the faces: the n-th joins the n-th vertex and the next.
    pub face_edges: Vec<u32>,
    /// Where each face's vertices and edges start; one more than there are faces.
    pub face_offsets: Vec<u32>,
    /// Centroid of each face, metres.
    pub centres: Vec<[f64; 2]>,
    /// Area of each face, square metres.
    pub areas: Vec<f64>,
    /// Area of the map, square metres.
    pub map_area: f64,
}

/// So many faces or vertices are worth a thread's while.
const SHARE: usize = 1 << 14;

/// Vertices from pixels to the map frame.
fn in_metres(frame: &Frame, mut vertices: Vec<[f64; 2]>, threads: usize) -> Vec<[f64; 2]> {
    each(vertices.chunks_mut(SHARE).collect(), threads, |part| {
        for vertex in part {
            *vertex = frame.to_metres(*vertex).map(tidy);
        }
    });
    vertices
}

impl Subdivision {
    /// From an arrangement, with coordinates in the map frame. Takes its lists over: they are most of the memory.
    #[must_use]
    pub fn new(frame: &Frame, arrangement: Arrangement, threads: usize) -> Self {
        let faces = arrangement.face_count();
        let mut face_vertices = vec![0; arrangement.face_halves.len()];
        let (mut centres, mut areas) = (vec![[0.0; 2]; faces], vec![0.0; faces]);
        // Ragged: each part's vertices are cut off what is left of them.
        let (mut left, mut parts) = (face_vertices.as_mut_slice(), Vec::with_capacity(faces / SHARE + 1));
        for (n, (centres, areas)) in centres.chunks_mut(SHARE).zip(areas.chunks_mut(SHARE)).enumerate() {
            let offsets = &arrangement.face_offsets[n * SHARE..=n * SHARE + areas.len()];
            let count = (offsets[offsets.len() - 1] - offsets[0]) as usize;
            let (vertices, rest) = left.split_at_mut(count);
            left = rest;
            parts.push((offsets, vertices, centres, areas));
        }
        each(parts, threads, |(offsets, vertices, centres, areas)| {
            let first = offsets[0] as usize;
            let halves = &arrangement.face_halves[first..first + vertices.len()];
            vertices.iter_mut().zip(halves).for_each(|(vertex, &half)| *vertex = arrangement.start(half));
            for ((ends, centre), area) in offsets.windows(2).zip(centres).zip(areas) {
                let around = &vertices[ends[0] as usize - first..ends[1] as usize - first];
                // From the vertices before they are rounded: a sliver's centre is lost with the rounding.
                let (pixels, middle) = area_and_centroid(&arrangement.vertices, around);
                *area = tidy(pixels * frame.resolution.powi(2));
                *centre = frame.to_metres(middle).map(tidy);
            }
        });
        Self {
            vertices: in_metres(frame, arrangement.vertices, threads),
            edge_vertices: arrangement.edges,
            edge_lines: arrangement.edge_lines,
            edge_faces: arrangement.edge_faces,
            face_vertices,
            face_edges: arrangement.face_halves.into_iter().map(|half| half >> 1).collect(),
            face_offsets: arrangement.face_offsets,
            centres,
            areas,
            map_area: frame.width as f64 * frame.height as f64 * frame.resolution.powi(2),
        }
    }

    /// Without the lists of the faces and the edges' lines: what walls are traced from.
    pub(crate) fn of_edges(frame: &Frame, arrangement: Arrangement, threads: usize) -> Self {
        let Arrangement { vertices, edges, edge_faces, .. } = arrangement;
        Self { vertices: in_metres(frame, vertices, threads), edge_vertices: edges, edge_faces, ..Self::default() }
    }

    /// Number of faces.
    #[must_use]
    pub fn faces(&self) -> usize {
        self.areas.len()
    }

    /// Places of a face's vertices and edges in the ragged lists.
    #[must_use]
    pub fn face(&self, face: usize) -> std::ops::Range<usize> {
        self.face_offsets[face] as usize..self.face_offsets[face + 1] as usize
    }

    /// Length of an edge, metres.
    #[must_use]
    pub fn length(&self, edge: usize) -> f64 {
        let [p, q] = self.edge_vertices[edge].map(|v| self.vertices[v as usize]);
        distance(p, q)
    }

    /// Every broken invariant, as sentences; none when all hold. Tests, fuzzers and debug builds run it.
    #[must_use]
    pub fn problems(&self) -> Vec<String> {
        let mut found = Vec::new();
        if self.ids_out_of_range() {
            return vec!["an id lies outside its list".to_owned()];
        }
        self.check_euler(&mut found);
        self.check_faces(&mut found);
        self.check_edges(&mut found);
        found
    }

    fn ids_out_of_range(&self) -> bool {
        let (v, e, f) = (self.vertices.len() as u32, self.edge_vertices.len() as u32, self.faces() as u32);
        let lists = self.edge_lines.len() != self.edge_vertices.len()
            || self.edge_faces.len() != self.edge_vertices.len()
            || self.face_vertices.len() != self.face_edges.len()
            || self.face_offsets.len() != self.faces() + 1
            || self.face_offsets.first() != Some(&0)
            || self.face_offsets.last() != Some(&(self.face_vertices.len() as u32))
            || self.face_offsets.windows(2).any(|w| w[0] > w[1])
            || self.centres.len() != self.faces();
        lists
            || self.edge_vertices.iter().flatten().chain(&self.face_vertices).any(|&n| n >= v)
            || self.face_edges.iter().any(|&n| n >= e)
            || self.edge_faces.iter().flatten().any(|&n| n >= f && n != NONE)
    }

    /// V - E + F = 1 + C, with the outside as a face.
    fn check_euler(&self, found: &mut Vec<String>) {
        fn root(parent: &mut [u32], mut n: u32) -> u32 {
            while parent[n as usize] != n {
                parent[n as usize] = parent[parent[n as usize] as usize];
                n = parent[n as usize];
            }
            n
        }
        let mut parent: Vec<u32> = (0..self.vertices.len() as u32).collect();
        for [p, q] in &self.edge_vertices {
            let (p, q) = (root(&mut parent, *p), root(&mut parent, *q));
            parent[p.max(q) as usize] = p.min(q);
        }
        let pieces = (0..parent.len()).filter(|&n| parent[n] == n as u32).count();
        let (v, e, f) = (self.vertices.len(), self.edge_vertices.len(), self.faces() + 1);
        if v + f != 1 + pieces + e {
            found.push(format!("V - E + F = {} and not 1 + C = {}", v as i64 - e as i64 + f as i64, 1 + pieces));
        }
    }

    fn check_faces(&self, found: &mut Vec<String>) {
        let mut sum = 0.0;
        for f in 0..self.faces() {
            let range = self.face(f);
            let (vertices, edges) = (&self.face_vertices[range.clone()], &self.face_edges[range]);
            if vertices.len() < 3 {
                found.push(format!("face {f} has {} vertices", vertices.len()));
            }
            let (area, _) = area_and_centroid(&self.vertices, vertices);
            let around: f64 = edges.iter().map(|&e| self.length(e as usize)).sum();
            // Vertices are rounded to micrometres, so a face thinner than that may turn over by as much.
            if area < -2e-6 * around {
                found.push(format!("face {f} runs clockwise"));
            }
            if (area - self.areas[f]).abs() > 1e-5 * (1.0 + around) {
                found.push(format!("face {f} has the area {area} and says {}", self.areas[f]));
            }
            for (n, &e) in edges.iter().enumerate() {
                let ends = self.edge_vertices[e as usize];
                let (p, q) = (vertices[n], vertices[(n + 1) % vertices.len()]);
                let sides = self.edge_faces[e as usize];
                let side = usize::from(ends != [p, q]);
                if ends != [p, q] && ends != [q, p] {
                    found.push(format!("edge {e} of face {f} does not join its vertices"));
                } else if sides[side] != f as u32 {
                    found.push(format!("edge {e} does not have face {f} on that side"));
                }
            }
            sum += self.areas[f];
        }
        // Every area is rounded, and many small faces may all be rounded the same way.
        if (sum - self.map_area).abs() > 1e-5 * (1.0 + self.map_area) + 5e-7 * self.faces() as f64 {
            found.push(format!("the faces have {sum} m2 and the map {}", self.map_area));
        }
    }

    fn check_edges(&self, found: &mut Vec<String>) {
        let mut uses = vec![0u8; self.edge_vertices.len()];
        for &e in &self.face_edges {
            uses[e as usize] = uses[e as usize].saturating_add(1);
        }
        for (e, sides) in self.edge_faces.iter().enumerate() {
            let inner = sides.iter().filter(|&&f| f != NONE).count();
            if usize::from(uses[e]) != inner {
                found.push(format!("edge {e} has {inner} faces and bounds {}", uses[e]));
            }
            if (self.edge_lines[e] == NONE) != (inner == 1) {
                found.push(format!(
                    "edge {e} has {inner} faces but is {} the border",
                    if self.edge_lines[e] == NONE { "on" } else { "not on" }
                ));
            }
        }
    }
}

/// Distance between two points.
#[must_use]
pub fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    ((p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)).sqrt()
}

/// A polygon thinner than this is as good as a line, pixels: its vertices say no more.
const THINNEST_PIXELS: f64 = 1e-9;

/// Signed area and centroid of a polygon.
fn area_and_centroid(points: &[[f64; 2]], polygon: &[u32]) -> (f64, [f64; 2]) {
    // Relative to the first vertex: far from the map frame's origin, differences of large products say little.
    let [ox, oy] = points[polygon[0] as usize];
    let (mut twice, mut cx, mut cy) = (0.0, 0.0, 0.0);
    let (mut mx, mut my, mut reach) = (0.0, 0.0, 0.0f64);
    let (mut x1, mut y1) = (0.0, 0.0);
    for n in 1..=polygon.len() {
        let (x0, y0) = (x1, y1);
        let [x, y] = points[polygon[if n < polygon.len() { n } else { 0 }] as usize];
        (x1, y1) = (x - ox, y - oy);
        let cross = x0 * y1 - x1 * y0;
        twice += cross;
        cx += (x0 + x1) * cross;
        cy += (y0 + y1) * cross;
        mx += x0;
        my += y0;
        reach = reach.max(x0.abs()).max(y0.abs());
    }
    let count = polygon.len() as f64;
    let centre = if twice.abs() > THINNEST_PIXELS * reach {
        [ox + cx / (3.0 * twice), oy + cy / (3.0 * twice)]
    } else {
        [ox + mx / count, oy + my / count]
    };
    (twice / 2.0, centre)
}
