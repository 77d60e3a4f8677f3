//! II-E: Algorithm 1 and Fig. 8 as printed.

use super::outline;
use super::{Division, Evidence, JunctionKind, Label};
use crate::grid::{State, tidy};
use crate::subdivision::distance;

/// Nodes of free faces with their neighbours over connected links.
fn nodes(division: &Division) -> Vec<Vec<(u32, u32)>> {
    let states = &division.occupancy.states;
    let free = |face: u32| states[face as usize] == State::Free;
    let mut lists = division.adjacency.neighbours(division.subdivision.faces());
    for (face, list) in lists.iter_mut().enumerate() {
        list.retain(|(other, _)| free(face as u32) && free(*other));
    }
    lists
}

pub fn find(evidence: &Evidence, division: &Division) -> Vec<Label> {
    let nodes = nodes(division);
    let mut labels = corridors(evidence, division, &nodes);
    labels.extend(junctions(division, &nodes));
    labels
}

/// Algorithm 1: a node is a junction if no two of its neighbours share any neighbour but itself; T with three
/// neighbours, X with four.
fn junctions(division: &Division, nodes: &[Vec<(u32, u32)>]) -> Vec<Label> {
    let shares = |i: u32, l: u32, k: u32| {
        nodes[l as usize].iter().any(|(n, _)| *n != i && nodes[k as usize].iter().any(|(m, _)| m == n))
    };
    let mut found = Vec::new();
    for (i, neighbours) in nodes.iter().enumerate() {
        let kind = match neighbours.len() {
            3 => JunctionKind::T,
            4 => JunctionKind::X,
            _ => continue,
        };
        let valid = neighbours
            .iter()
            .enumerate()
            .all(|(n, (l, _))| neighbours[n + 1..].iter().all(|(k, _)| !shares(i as u32, *l, *k)));
        if valid {
            found.push(Label::Junction {
                kind,
                faces: vec![i as u32],
                polygon: outline::polygon(division.subdivision, &[i as u32]),
                at: division.subdivision.centres[i],
                corridors: Vec::new(),
            });
        }
    }
    found
}

/// Fig. 8c: cogent on both long sides, connected at both ends; those that follow one another are one corridor.
fn corridors(evidence: &Evidence, division: &Division, nodes: &[Vec<(u32, u32)>]) -> Vec<Label> {
    // The direction of a corridor's face, when it is one: its two open edges lie on lines of one direction.
    let subdivision = division.subdivision;
    let edge_of = |link: u32| division.adjacency.edges[link as usize] as usize;
    let matches = |face: usize| {
        let [(_, one), (_, two)] = nodes[face][..] else {
            return None;
        };
        let (one, two) = (edge_of(one), edge_of(two));
        let heading = |e: usize| evidence.lines.directions.get(subdivision.edge_lines[e] as usize).copied();
        (heading(two)? == heading(one)?).then_some([one, two])
    };
    let ends: Vec<Option<[usize; 2]>> = (0..nodes.len()).map(matches).collect();
    let mut taken = vec![false; nodes.len()];
    let mut labels = Vec::new();
    for start in 0..nodes.len() {
        if ends[start].is_none() || taken[start] {
            continue;
        }
        let mut faces = vec![start as u32];
        taken[start] = true;
        let mut n = 0;
        while n < faces.len() {
            for (other, _) in &nodes[faces[n] as usize] {
                if ends[*other as usize].is_some() && !taken[*other as usize] {
                    taken[*other as usize] = true;
                    faces.push(*other);
                }
            }
            n += 1;
        }
        faces.sort_unstable();
        let edges: Vec<usize> = faces.iter().filter_map(|&f| ends[f as usize]).flatten().collect();
        let outer: Vec<usize> =
            edges.iter().copied().filter(|e| edges.iter().filter(|o| *o == e).count() == 1).collect();
        let [first, last] = outer[..] else { continue };
        let axis = [middle(subdivision, first), middle(subdivision, last)].map(|p| p.map(tidy));
        let area: f64 = faces.iter().map(|&f| subdivision.areas[f as usize]).sum();
        let length = distance(axis[0], axis[1]);
        // "Long sides": the lines of the other directions may cut a corridor into faces that are wider than long, so
        // it is judged whole.
        if length * length < area {
            continue;
        }
        labels.push(Label::Corridor {
            polygon: outline::polygon(subdivision, &faces),
            faces,
            axis,
            width: tidy(area / length),
            name: format!("A{:02}", labels.len() + 1),
        });
    }
    labels
}

fn middle(subdivision: &crate::subdivision::Subdivision, edge: usize) -> [f64; 2] {
    let [p, q] = subdivision.edge_vertices[edge].map(|v| subdivision.vertices[v as usize]);
    [0, 1].map(|n| f64::midpoint(p[n], q[n]))
}
