//! The edges along each line: what it crosses of each family comes in order, and is merged to one.

use super::Arrangement;
use super::builder::Builder;
use super::families::{Family, Run};
use super::lattice::TIE_PIXELS;
use std::cmp::Ordering;

impl Builder {
    /// The edges along each line: its vertices with each family, merged in the order the line meets them. There is `room`
    /// for so many edges.
    pub(super) fn edges_along(
        &mut self,
        families: &[Family],
        runs: &[Run],
        ends: &[[u32; 2]],
        room: usize,
    ) -> Arrangement {
        let count = families.len();
        let mut made = Arrangement {
            edges: Vec::with_capacity(room),
            edge_lines: Vec::with_capacity(room),
            line_edges: Vec::with_capacity(self.lines.len()),
            ..Arrangement::default()
        };
        let mut chain = Vec::new();
        let mut sequences: Vec<Vec<(u32, u32)>> = vec![Vec::new(); count.saturating_sub(1)];
        let mut family_of = vec![None; self.lines.len()];
        for (f, family) in families.iter().enumerate() {
            for (place, &n) in family.members.iter().enumerate() {
                family_of[n as usize] = Some((f, place as u32));
            }
        }
        for (n, of) in family_of.iter().enumerate() {
            let start = made.edges.len() as u32;
            if let &Some((f, place)) = of {
                let others = families.iter().enumerate().filter(|(g, _)| *g != f);
                for (sequence, (g, other)) in sequences.iter_mut().zip(others) {
                    let run = &runs[n * count + g];
                    let vertex = |m: u32| {
                        if f < g {
                            run.vertex + (m - run.first)
                        } else {
                            let back = &runs[other.members[m as usize] as usize * count + f];
                            back.vertex + (place - back.first)
                        }
                    };
                    let members = run.first..run.first + run.count;
                    sequence.clear();
                    sequence.extend(members.map(|m| (vertex(m), other.members[m as usize])));
                    // Along (b, -a) the other's offset grows when its normal has a part that way.
                    let family = &families[f];
                    if i128::from(other.a) * i128::from(family.b) < i128::from(other.b) * i128::from(family.a) {
                        sequence.reverse();
                    }
                }
                let [first, last] = ends[n];
                chain.clear();
                chain.push(first);
                self.merge_sequences(n as u32, &sequences, &mut chain);
                chain.push(last);
                made.edges.extend(chain.windows(2).map(|pair| [pair[0], pair[1]]));
            }
            made.edge_lines.resize(made.edges.len(), n as u32);
            made.line_edges.push(start..made.edges.len() as u32);
        }
        made
    }

    /// Merges sequences of (vertex, crossing line) along line `n`; crossings in one place become one vertex.
    fn merge_sequences(&mut self, n: u32, sequences: &[Vec<(u32, u32)>], chain: &mut Vec<u32>) {
        let line = self.lines[n as usize];
        let by_x = line.b.abs() >= line.a.abs();
        let forwards = if by_x { line.b > 0 } else { line.a < 0 };
        if let [sequence] = sequences {
            chain.extend(sequence.iter().map(|(vertex, _)| vertex));
            return;
        }
        // What is left of each sequence, and where the first of it lies along the line.
        let place = |(vertex, _): (u32, u32)| {
            let place = self.vertices[vertex as usize][usize::from(!by_x)];
            if forwards { place } else { -place }
        };
        let mut heads: Vec<_> = sequences.iter().filter_map(|s| Some((place(*s.first()?), s.as_slice()))).collect();
        let mut last: Option<(u32, u32)> = None;
        let mut same = Vec::new();
        while !heads.is_empty() {
            let mut best = 0;
            for s in 1..heads.len() {
                let (one, held) = (heads[s], heads[best]);
                let is_sooner = if (one.0 - held.0).abs() > TIE_PIXELS {
                    one.0 < held.0
                } else {
                    self.order(n, by_x, forwards, one.1[0], held.1[0]) == Ordering::Less
                };
                if is_sooner {
                    best = s;
                }
            }
            let taken = heads[best].1[0];
            match &heads[best].1[1..] {
                [] => drop(heads.remove(best)),
                rest => heads[best] = (place(rest[0]), rest),
            }
            if let Some(before) = last
                && self.order(n, by_x, forwards, before, taken) == Ordering::Equal
            {
                same.push((before.0, taken.0));
            } else {
                chain.push(taken.0);
            }
            last = Some(taken);
        }
        for (before, taken) in same {
            self.merge(before, taken);
        }
    }

    /// Which of two crossings line `n` meets first.
    fn order(&self, n: u32, by_x: bool, forwards: bool, p: (u32, u32), q: (u32, u32)) -> Ordering {
        let axis = usize::from(!by_x);
        let (fp, fq) = (self.vertices[p.0 as usize][axis], self.vertices[q.0 as usize][axis]);
        let along = if (fp - fq).abs() > TIE_PIXELS {
            fp.total_cmp(&fq)
        } else {
            let (p, q) = (self.crossing(n, p.1), self.crossing(n, q.1));
            if by_x { (p.x * q.over).cmp(&(q.x * p.over)) } else { (p.y * q.over).cmp(&(q.y * p.over)) }
        };
        if forwards { along } else { along.reverse() }
    }
}
