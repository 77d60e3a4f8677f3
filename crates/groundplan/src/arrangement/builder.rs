//! From lattice lines to vertices, edges and faces; lines through one point share one vertex.

use super::families::{Family, Run, families, runs};
use super::lattice::{End, LatticeLine, Point, around};
use super::{Arrangement, NONE};
use crate::bands::each;
use crate::sets::Sets;
use std::cmp::Ordering;

/// So many crossings are worth a thread's while.
const SHARE: usize = 1 << 14;

pub struct Builder {
    /// Of the map, pixels.
    size: [i64; 2],
    pub(super) lines: Vec<LatticeLine>,
    families: Vec<Family>,
    /// Ends of each line on the map's border, in the order it runs; none when it misses the interior.
    ends: Vec<Option<[End; 2]>>,
    pub(super) vertices: Vec<[f64; 2]>,
    rows_below: Vec<u32>,
    /// Vertices that are one, such as where three lines go through a point; nothing until any two were found to be.
    same: Option<Sets>,
}

impl Builder {
    pub fn new(size: [i64; 2], lines: Vec<LatticeLine>) -> Self {
        let (families, ends) = families(&lines, size);
        Self { size, lines, families, ends, vertices: Vec::new(), rows_below: Vec::new(), same: None }
    }

    fn add_vertex(&mut self, point: Point) -> u32 {
        let floats = point.to_floats();
        self.vertices.push(floats);
        self.rows_below.push(point.rows_below(floats[1], self.size[1] as usize));
        self.vertices.len() as u32 - 1
    }

    /// Two vertices are one, under the id that comes first.
    pub(super) fn merge(&mut self, a: u32, b: u32) {
        let count = self.vertices.len();
        self.same.get_or_insert_with(|| Sets::new(count)).join_first(a, b);
    }

    /// Where two lines cross.
    pub(super) fn crossing(&self, one: u32, two: u32) -> Point {
        let (p, q) = (self.lines[one as usize], self.lines[two as usize]);
        let wide = |a: i64, b: i64, c: i64, d: i64| i128::from(a) * i128::from(b) - i128::from(c) * i128::from(d);
        Point::new(wide(p.c, q.b, q.c, p.b), wide(p.a, q.c, q.a, p.c), wide(p.a, q.b, q.a, p.b))
    }

    pub fn build(mut self, threads: usize) -> Arrangement {
        let families = std::mem::take(&mut self.families);
        let (runs, crossings) = runs(&families, &self.ends);
        // Room for all of them at once: growing would copy what is many, and touch twice the memory.
        let room = crossings + 2 * self.lines.len() + 4;
        self.vertices.reserve_exact(room);
        self.rows_below.reserve_exact(room);
        self.add_crossings(&families, &runs, crossings, threads);
        let (border, ends) = self.add_border();
        let room = 2 * crossings + self.lines.len() + border.len();
        let made = self.edges_along(&families, &runs, &ends, room);
        self.assemble(made, &border)
    }

    /// Ends on the border, going round, and the vertices at each line's ends; ends in one place are one vertex, corners
    /// among them.
    fn add_border(&mut self) -> (Vec<(End, u32)>, Vec<[u32; 2]>) {
        let mut border: Vec<(End, u32)> = Vec::new();
        let [w, h] = self.size.map(i128::from);
        let corners =
            [(0, 0, 0), (1, w, 0), (2, w, h), (3, 0, h)].map(|(side, x, y)| End { side, point: Point::new(x, y, 1) });
        for corner in corners {
            let id = self.add_vertex(corner.point);
            border.push((corner, id));
        }
        let mut end_vertices = vec![[NONE; 2]; self.lines.len()];
        for (n, vertices) in end_vertices.iter_mut().enumerate() {
            let Some(ends) = self.ends[n] else { continue };
            for (vertex, end) in vertices.iter_mut().zip(ends) {
                *vertex = self.add_vertex(end.point);
                border.push((end, *vertex));
            }
        }
        border.sort_by(|(p, _), (q, _)| around(p, q));
        for pair in border.windows(2) {
            if around(&pair[0].0, &pair[1].0) == Ordering::Equal {
                self.merge(pair[0].1, pair[1].1);
            }
        }
        (border, end_vertices)
    }

    /// The vertices where lines cross, `crossings` of them: runs of an earlier family's lines with later families.
    fn add_crossings(&mut self, families: &[Family], runs: &[Run], crossings: usize, threads: usize) {
        self.vertices.resize(crossings, [0.0; 2]);
        self.rows_below.resize(crossings, 0);
        let (mut vertices, mut rows) = (std::mem::take(&mut self.vertices), std::mem::take(&mut self.rows_below));
        let (mut vertices_left, mut rows_left) = (vertices.as_mut_slice(), rows.as_mut_slice());
        let mut parts = Vec::new();
        for (f, family) in families.iter().enumerate() {
            let runs_of = |n: u32| &runs[n as usize * families.len()..][f + 1..families.len()];
            let count = |n: u32| runs_of(n).iter().map(|run| run.count as usize).sum::<usize>();
            let mut first = 0;
            while first < family.members.len() {
                // As many lines as are worth a thread's while.
                let (mut last, mut room) = (first, 0);
                while last < family.members.len() && room < SHARE {
                    room += count(family.members[last]);
                    last += 1;
                }
                let (to, of_rows);
                (to, vertices_left) = vertices_left.split_at_mut(room);
                (of_rows, rows_left) = rows_left.split_at_mut(room);
                parts.push((f, first..last, to, of_rows));
                first = last;
            }
        }
        each(parts, threads.min(crossings / SHARE + 1), |(f, members, vertices, rows)| {
            let mut places = vertices.iter_mut().zip(rows);
            for &n in &families[f].members[members] {
                for (g, other) in families.iter().enumerate().skip(f + 1) {
                    let run = &runs[n as usize * families.len() + g];
                    let crossed = &other.members[run.first as usize..(run.first + run.count) as usize];
                    for (&m, (vertex, rows)) in crossed.iter().zip(&mut places) {
                        let point = self.crossing(n, m);
                        *vertex = point.to_floats();
                        *rows = point.rows_below(vertex[1], self.size[1] as usize);
                    }
                }
            }
        });
        (self.vertices, self.rows_below) = (vertices, rows);
    }

    /// Edges along the lines -> those of the border too, half-edges around the vertices, faces.
    fn assemble(mut self, mut made: Arrangement, border: &[(End, u32)]) -> Arrangement {
        let ids = self.drop_merged();
        let id = |n: u32| if ids.is_empty() { n } else { ids[n as usize] };
        if !ids.is_empty() {
            let mut kept = 0;
            for edges in &mut made.line_edges {
                let start = kept as u32;
                for n in edges.start as usize..edges.end as usize {
                    let [p, q] = made.edges[n].map(id);
                    if p != q {
                        (made.edges[kept], made.edge_lines[kept]) = ([p, q], made.edge_lines[n]);
                        kept += 1;
                    }
                }
                *edges = start..kept as u32;
            }
            made.edges.truncate(kept);
            made.edge_lines.truncate(kept);
        }
        let mut sides = Vec::with_capacity(border.len());
        for (n, (end, p)) in border.iter().enumerate() {
            let [p, q] = [id(*p), id(border[(n + 1) % border.len()].1)];
            if p != q {
                made.edges.push([p, q]);
                made.edge_lines.push(NONE);
                sides.push(end.side);
            }
        }
        made.lines = self.lines;
        made.vertices = self.vertices;
        made.rows_below = self.rows_below;
        let next = made.link(&sides);
        made.find_faces(&next, sides.len());
        made
    }

    /// Takes merged vertices out, the others keep their order; the new id of each, nothing when all stay.
    fn drop_merged(&mut self) -> Vec<u32> {
        let Some(same) = self.same.take() else { return Vec::new() };
        let (mut ids, count) = same.numbered();
        let mut kept = 0;
        for (n, id) in ids.iter_mut().enumerate() {
            *id -= 1;
            // Of those that are one the first has its number first.
            if *id == kept {
                self.vertices[kept as usize] = self.vertices[n];
                self.rows_below[kept as usize] = self.rows_below[n];
                kept += 1;
            }
        }
        self.vertices.truncate(count);
        self.rows_below.truncate(count);
        ids
    }
}
