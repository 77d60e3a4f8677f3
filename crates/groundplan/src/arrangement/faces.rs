//! From edges to the half-edges around each vertex, and the faces that they go around.

use super::lattice::LatticeLine;
use super::{Arrangement, NONE};
use std::cmp::Ordering;

/// The place of every way out of a vertex, counter-clockwise: of each line forwards and backwards, and of the border's
/// four sides as they run.
fn rank(lines: &[LatticeLine]) -> (Vec<[u32; 2]>, [u32; 4]) {
    let border = [[1, 0], [0, 1], [-1, 0], [0, -1]].map(|v: [i64; 2]| v.map(i128::from));
    let ways = |line: &LatticeLine| {
        let (x, y) = (i128::from(line.b), -i128::from(line.a));
        [[x, y], [-x, -y]]
    };
    let half = |v: &[i128; 2]| u8::from(v[1] < 0 || (v[1] == 0 && v[0] < 0));
    let turn = |v: &[i128; 2], w: &[i128; 2]| half(v).cmp(&half(w)).then_with(|| 0.cmp(&(v[0] * w[1] - v[1] * w[0])));
    let mut all: Vec<[i128; 2]> = border.to_vec();
    let mut last: Option<(i64, i64)> = None;
    for line in lines {
        if last != Some((line.a, line.b)) {
            all.extend(ways(line));
            last = Some((line.a, line.b));
        }
    }
    all.sort_by(turn);
    all.dedup_by(|v, w| turn(v, w) == Ordering::Equal);
    let place = |v: &[i128; 2]| all.partition_point(|w| turn(w, v) == Ordering::Less) as u32;
    (lines.iter().map(|line| ways(line).map(|v| place(&v))).collect(), border.map(|v| place(&v)))
}

impl Arrangement {
    /// The next half-edge around the face on the left of each. `sides` are those that the border's edges lie on.
    pub(super) fn link(&self, sides: &[u8]) -> Vec<u32> {
        let (line_ranks, border_ranks) = rank(&self.lines);
        let first_border = self.edges.len() - sides.len();
        // Handed out in the order of their ranks, the ways out of every vertex come sorted.
        let mut groups: Vec<(u32, std::ops::Range<u32>, u32)> = Vec::new();
        for (ranks, edges) in line_ranks.iter().zip(&self.line_edges).filter(|(_, edges)| !edges.is_empty()) {
            groups.extend([(ranks[0], edges.clone(), 0), (ranks[1], edges.clone(), 1)]);
        }
        for (edge, &side) in (first_border as u32..).zip(sides) {
            let side = usize::from(side);
            groups.push((border_ranks[side], edge..edge + 1, 0));
            groups.push((border_ranks[(side + 2) % 4], edge..edge + 1, 1));
        }
        groups.sort_by_key(|group| group.0);

        // Arriving against a way out, the face on the left goes on along the next way clockwise: the one before.
        let mut next = vec![0; self.edges.len() * 2];
        let mut ways = vec![[NONE; 2]; self.vertices.len()];
        for (_, edges, way) in groups {
            for edge in edges {
                let half = 2 * edge + way;
                let [first, last] = &mut ways[self.start(half) as usize];
                if *first == NONE {
                    *first = half;
                } else {
                    next[Self::twin(half) as usize] = *last;
                }
                *last = half;
            }
        }
        for [first, last] in ways.into_iter().filter(|ways| ways[0] != NONE) {
            next[Self::twin(first) as usize] = last;
        }
        next
    }

    /// Numbers the faces, in the order of their first half-edges; the last `border` edges are the border's.
    pub(super) fn find_faces(&mut self, next: &[u32], border: usize) {
        let halves = next.len() as u32;
        let first_border = halves - 2 * border as u32;
        // Euler: all hangs together by the border.
        self.face_offsets.reserve_exact((self.edges.len() + 2).saturating_sub(self.vertices.len()));
        self.face_offsets.push(0);
        self.face_halves.reserve_exact(next.len() - border);
        self.edge_faces = vec![[0; 2]; self.edges.len()];
        let mut seen = vec![0u64; next.len().div_ceil(64)];
        for start in 0..halves {
            // The outside runs along the border's twins only.
            if start >= first_border && start & 1 == 1 {
                self.edge_faces[(start >> 1) as usize][1] = NONE;
                continue;
            }
            if seen[(start >> 6) as usize] >> (start & 63) & 1 == 1 {
                continue;
            }
            let face = self.face_offsets.len() as u32 - 1;
            let mut half = start;
            loop {
                seen[(half >> 6) as usize] |= 1 << (half & 63);
                self.edge_faces[(half >> 1) as usize][(half & 1) as usize] = face;
                self.face_halves.push(half);
                half = next[half as usize];
                if half == start {
                    break;
                }
            }
            self.face_offsets.push(self.face_halves.len() as u32);
        }
    }
}
