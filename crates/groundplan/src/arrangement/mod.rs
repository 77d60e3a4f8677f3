//! II-C: lines -> half-edges, for any number of directions.
//!
//! Lines live on a lattice (`lattice.rs`), so no input is degenerate. Lines of one direction are parallel, so they cross
//! any other line in the order of their offsets (`families.rs`): nothing is sorted that comes sorted (`along.rs`), and the
//! cost grows with what is made (`builder.rs`). The faces are what the half-edges go around (`faces.rs`).

mod along;
mod builder;
mod faces;
mod families;
mod lattice;

use crate::grid::Frame;
use crate::lines::Lines;
use builder::Builder;
use lattice::BITS;
pub use lattice::LatticeLine;

/// No id: a border edge's line, the outside's face.
pub const NONE: u32 = u32::MAX;

/// A planar arrangement of lines within the map's rectangle, as half-edges. Half-edge 2e runs along edge e as its line
/// does, 2e + 1 is its twin; the edges of the border run counter-clockwise and come last.
#[derive(Clone, Debug, Default)]
pub struct Arrangement {
    /// The lines on the lattice, as given.
    pub lines: Vec<LatticeLine>,
    /// Vertices in pixels.
    pub vertices: Vec<[f64; 2]>,
    /// Rows of pixels with their centres below each vertex.
    pub rows_below: Vec<u32>,
    /// First and last vertex of each edge.
    pub edges: Vec<[u32; 2]>,
    /// Line of each edge, [`NONE`] on the border.
    pub edge_lines: Vec<u32>,
    /// Edges of each line: a range into `edges`.
    pub line_edges: Vec<std::ops::Range<u32>>,
    /// Faces on the left and on the right of each edge, [`NONE`] outside.
    pub edge_faces: Vec<[u32; 2]>,
    /// Half-edges of the faces, counter-clockwise; face f has those from `face_offsets[f]` to `face_offsets[f + 1]`.
    pub face_halves: Vec<u32>,
    /// Where each face's half-edges start; one more than there are faces.
    pub face_offsets: Vec<u32>,
}

impl Arrangement {
    /// The other half of a half-edge.
    #[must_use]
    pub fn twin(half: u32) -> u32 {
        half ^ 1
    }

    /// Vertex that a half-edge starts from.
    #[must_use]
    pub fn start(&self, half: u32) -> u32 {
        self.edges[(half >> 1) as usize][(half & 1) as usize]
    }

    /// Face on the left of a half-edge, [`NONE`] outside.
    #[must_use]
    pub fn face(&self, half: u32) -> u32 {
        self.edge_faces[(half >> 1) as usize][(half & 1) as usize]
    }

    /// Number of faces, without the outside.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.face_offsets.len().saturating_sub(1)
    }

    /// Half-edges of a face, counter-clockwise.
    #[must_use]
    pub fn around(&self, face: usize) -> &[u32] {
        &self.face_halves[self.face_offsets[face] as usize..self.face_offsets[face + 1] as usize]
    }
}

/// Arranges the lines; those that do not cross the map's interior get no edges.
#[must_use]
pub fn arrange(frame: &Frame, angles: &[f64], lines: &Lines, threads: usize) -> Arrangement {
    let normals: Vec<[i64; 2]> = angles.iter().map(|&angle| normal(frame.angle_to_grid(angle))).collect();
    let scale = (1u64 << BITS) as f64;
    let lattice = |(&direction, &offset): (&u32, &f64)| {
        let [a, b] = normals[direction as usize];
        let c = frame.offset_to_grid(angles[direction as usize], offset) * scale;
        LatticeLine { a, b, c: c.round() as i64 }
    };
    let lattice: Vec<LatticeLine> = lines.directions.iter().zip(&lines.offsets).map(lattice).collect();
    Builder::new([frame.width as i64, frame.height as i64], lattice).build(threads)
}

/// Normal of a direction on the lattice. The y part is never negative, nor are both zero.
fn normal(angle: f64) -> [i64; 2] {
    let scale = (1u64 << BITS) as f64;
    [(-libm::sin(angle) * scale).round() as i64, (libm::cos(angle) * scale).round() as i64]
}
