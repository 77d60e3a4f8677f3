//! II-D, II-E: the dual. A node for each face, at its centre; a link for each edge between two faces.

use crate::arrangement::NONE;

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

/// The dual of a subdivision, from the two faces of each of its edges and whether the edge is cogent.
#[must_use]
pub fn find_adjacency(edge_faces: &[[u32; 2]], cogent: &[bool]) -> Adjacency {
    let mut made = Adjacency::default();
    for (edge, (&faces, cogent)) in edge_faces.iter().zip(cogent).enumerate() {
        if !faces.contains(&NONE) {
            made.faces.push(faces);
            made.edges.push(edge as u32);
            made.connected.push(!cogent);
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
