//! Outlines of sets of faces.

use crate::subdivision::Subdivision;
use std::collections::BTreeMap;

/// The rings around a set of faces: outer ones run counter-clockwise, holes clockwise. Vertices in the middle of a
/// straight piece are left out.
pub fn rings(subdivision: &Subdivision, faces: &[u32]) -> Vec<Vec<[f64; 2]>> {
    let mut inside = faces.to_vec();
    inside.sort_unstable();
    let is_inside = |face: u32| inside.binary_search(&face).is_ok();
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &face in &inside {
        let range = subdivision.face(face as usize);
        let vertices = &subdivision.face_vertices[range.clone()];
        for (n, &edge) in subdivision.face_edges[range].iter().enumerate() {
            let [l, r] = subdivision.edge_faces[edge as usize];
            if !is_inside(if l == face { r } else { l }) {
                next.entry(vertices[n]).or_default().push(vertices[(n + 1) % vertices.len()]);
            }
        }
    }
    let mut rings = Vec::new();
    while let Some((&start, _)) = next.iter().next() {
        let mut ring = vec![start];
        let mut at = start;
        while let Some(ways) = next.get_mut(&at) {
            // Where the set touches itself in a vertex, the sharpest turn left keeps the rings simple.
            let before = ring.len().checked_sub(2).map(|n| ring[n]);
            let choice = before.map_or(0, |from| leftmost(subdivision, from, at, ways));
            let to = ways.swap_remove(choice);
            if ways.is_empty() {
                next.remove(&at);
            }
            if to == start {
                break;
            }
            ring.push(to);
            at = to;
        }
        rings.push(straight(ring.iter().map(|&v| subdivision.vertices[v as usize]).collect()));
    }
    rings
}

/// The outer ring with the largest area.
pub fn polygon(subdivision: &Subdivision, faces: &[u32]) -> Vec<[f64; 2]> {
    rings(subdivision, faces).into_iter().max_by(|a, b| area(a).total_cmp(&area(b))).unwrap_or_default()
}

/// Signed area of a ring.
pub fn area(ring: &[[f64; 2]]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(p, q)| p[0] * q[1] - q[0] * p[1]).sum::<f64>() / 2.0
}

fn leftmost(subdivision: &Subdivision, from: u32, at: u32, ways: &[u32]) -> usize {
    let point = |v: u32| subdivision.vertices[v as usize];
    let towards = |p: [f64; 2], q: [f64; 2]| libm::atan2(q[1] - p[1], q[0] - p[0]);
    let heading = towards(point(from), point(at));
    let turn = |way: &u32| crate::grid::turned(towards(point(at), point(*way)) - heading);
    (0..ways.len()).max_by(|&a, &b| turn(&ways[a]).total_cmp(&turn(&ways[b]))).unwrap_or(0)
}

/// Leaves out points between neighbours that lie on one straight line with them.
fn straight(ring: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let count = ring.len();
    let kept = (0..count).filter(|&n| {
        let (p, q, r) = (ring[(n + count - 1) % count], ring[n], ring[(n + 1) % count]);
        let cross = (q[0] - p[0]) * (r[1] - q[1]) - (q[1] - p[1]) * (r[0] - q[0]);
        cross.abs() > 1e-5 * (1.0 + crate::subdivision::distance(p, r))
    });
    let kept: Vec<[f64; 2]> = kept.map(|n| ring[n]).collect();
    if kept.len() < 3 { ring } else { kept }
}

/// True when a counter-clockwise convex polygon holds the point.
pub fn holds(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).all(|(p, q)| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) >= 0.0)
}
