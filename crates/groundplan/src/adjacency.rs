//! II-D, II-E: the dual. A node for each face, at its centre; a link for each edge between two faces.

use crate::arrangement::NONE;
use crate::subdivision::Subdivision;
use crate::walls::Walls;

/// The adjacency graph: D(face) = node, D(edge) = link.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Adjacency {
    /// The two faces of each link.
    pub faces: Vec<[u32; 2]>,
    /// The edge that each link crosses.
    pub edges: Vec<u32>,
    /// C(link) = not C(edge).
    pub connected: Vec<bool>,
}

/// The dual of the subdivision.
#[must_use]
pub fn find_adjacency(subdivision: &Subdivision, walls: &Walls) -> Adjacency {
    let mut made = Adjacency::default();
    for (edge, &faces) in subdivision.edge_faces.iter().enumerate() {
        if !faces.contains(&NONE) {
            made.faces.push(faces);
            made.edges.push(edge as u32);
            made.connected.push(!walls.cogent[edge]);
        }
    }
    made
}

impl Adjacency {
    /// N(node) over connected links: the neighbouring faces of each face and the links to them.
    #[must_use]
    pub fn neighbours(&self, faces: usize) -> Vec<Vec<(u32, u32)>> {
        let mut lists = vec![Vec::new(); faces];
        for (link, &[a, b]) in self.faces.iter().enumerate().filter(|(link, _)| self.connected[*link]) {
            lists[a as usize].push((b, link as u32));
            lists[b as usize].push((a, link as u32));
        }
        lists
    }
}
