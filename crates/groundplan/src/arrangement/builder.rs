//! From lattice lines to vertices and the edges along each line; lines through one point share one vertex.

use super::lattice::{End, LatticeLine, Point, TIE_PIXELS, around, clip};
use super::{Arrangement, NONE};
use crate::bands::each;
use std::cmp::Ordering;

/// So many crossings are worth a thread's while.
const SHARE: usize = 1 << 14;

/// Lines of one normal, in the order of their offsets.
struct Family {
    a: i64,
    b: i64,
    /// Ids of the lines, ascending in c, no two the same line.
    members: Vec<u32>,
    offsets: Vec<i64>,
}

/// Crossings of one line with one family: a run of its members.
#[derive(Clone, Default)]
struct Run {
    first: u32,
    count: u32,
    /// Id of the vertex with member `first`; the others follow.
    vertex: u32,
}

pub struct Builder {
    /// Of the map, pixels.
    size: [i64; 2],
    lines: Vec<LatticeLine>,
    families: Vec<Family>,
    /// Ends of each line on the map's border, in the order it runs; none when it misses the interior.
    ends: Vec<Option<[End; 2]>>,
    vertices: Vec<[f64; 2]>,
    rows_below: Vec<u32>,
    /// Union-find over vertices: three lines through a point are one vertex. Empty until any two were found to be one.
    same: Vec<u32>,
}

impl Builder {
    pub fn new(size: [i64; 2], lines: Vec<LatticeLine>) -> Self {
        let mut order: Vec<u32> = (0..lines.len() as u32).collect();
        let key = |&n: &u32| {
            let line = lines[n as usize];
            (line.a, line.b, line.c, n)
        };
        order.sort_unstable_by_key(key);
        let mut families: Vec<Family> = Vec::new();
        for n in order {
            let line = lines[n as usize];
            if families.last().is_none_or(|f| (f.a, f.b) != (line.a, line.b)) {
                families.push(Family { a: line.a, b: line.b, members: Vec::new(), offsets: Vec::new() });
            }
            let Some(family) = families.last_mut() else { continue };
            if family.offsets.last() != Some(&line.c) {
                family.members.push(n);
                family.offsets.push(line.c);
            }
        }
        let mut builder = Self {
            size,
            lines,
            families,
            ends: Vec::new(),
            vertices: Vec::new(),
            rows_below: Vec::new(),
            same: Vec::new(),
        };
        // A family keeps only the members that cross the map, each once.
        builder.ends = vec![None; builder.lines.len()];
        for f in 0..builder.families.len() {
            let members = std::mem::take(&mut builder.families[f].members);
            for &n in &members {
                builder.ends[n as usize] = clip(builder.lines[n as usize], size);
            }
            let kept: Vec<u32> = members.into_iter().filter(|&n| builder.ends[n as usize].is_some()).collect();
            builder.families[f].offsets = kept.iter().map(|&n| builder.lines[n as usize].c).collect();
            builder.families[f].members = kept;
        }
        builder
    }

    fn add_vertex(&mut self, point: Point) -> u32 {
        let floats = point.to_floats();
        self.vertices.push(floats);
        self.rows_below.push(point.rows_below(floats[1], self.size[1] as usize));
        self.vertices.len() as u32 - 1
    }

    fn root(&mut self, mut n: u32) -> u32 {
        while self.same[n as usize] != n {
            self.same[n as usize] = self.same[self.same[n as usize] as usize];
            n = self.same[n as usize];
        }
        n
    }

    fn merge(&mut self, a: u32, b: u32) {
        if self.same.is_empty() {
            self.same = (0..self.vertices.len() as u32).collect();
        }
        let (a, b) = (self.root(a), self.root(b));
        self.same[a.max(b) as usize] = a.min(b);
    }

    /// Where two lines cross.
    fn crossing(&self, one: u32, two: u32) -> Point {
        let (p, q) = (self.lines[one as usize], self.lines[two as usize]);
        let wide = |a: i64, b: i64, c: i64, d: i64| i128::from(a) * i128::from(b) - i128::from(c) * i128::from(d);
        Point::new(wide(p.c, q.b, q.c, p.b), wide(p.a, q.c, q.a, p.c), wide(p.a, q.b, q.a, p.b))
    }

    /// Members of `family` that cross the open piece between the ends of a line.
    fn run(ends: &[End; 2], family: &Family) -> Run {
        let value =
            |end: &End| (i128::from(family.a) * end.point.x + i128::from(family.b) * end.point.y, end.point.over);
        let (p, q) = (value(&ends[0]), value(&ends[1]));
        let (low, high) = if p.0 * q.1 <= q.0 * p.1 { (p, q) } else { (q, p) };
        let first = family.offsets.partition_point(|&c| i128::from(c) * low.1 <= low.0);
        let last = family.offsets.partition_point(|&c| i128::from(c) * high.1 < high.0);
        Run { first: first as u32, count: last.saturating_sub(first) as u32, vertex: 0 }
    }

    pub fn build(mut self, threads: usize) -> Arrangement {
        let families = std::mem::take(&mut self.families);
        let (runs, crossings) = self.runs(&families);
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

    /// For each line and family, line after line, which members it crosses; and how many crossings there are: one vertex for
    /// each pair of lines, made from the earlier family's side.
    fn runs(&self, families: &[Family]) -> (Vec<Run>, usize) {
        let mut runs = vec![Run::default(); self.lines.len() * families.len()];
        let mut crossings = 0;
        for (f, family) in families.iter().enumerate() {
            for &n in &family.members {
                let Some(ends) = self.ends[n as usize] else { continue };
                for (g, other) in families.iter().enumerate().filter(|(g, _)| *g != f) {
                    let mut run = Self::run(&ends, other);
                    if f < g {
                        run.vertex = crossings;
                        crossings += run.count;
                    }
                    runs[n as usize * families.len() + g] = run;
                }
            }
        }
        (runs, crossings as usize)
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

    /// The edges along each line: its vertices with each family, merged in the order the line meets them. There is `room`
    /// for so many edges.
    fn edges_along(&mut self, families: &[Family], runs: &[Run], ends: &[[u32; 2]], room: usize) -> Arrangement {
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
        let mut ids = vec![0u32; self.same.len()];
        let mut kept = 0;
        for n in 0..ids.len() {
            let root = self.root(n as u32) as usize;
            ids[n] = if root == n { kept } else { ids[root] };
            if root == n {
                self.vertices[kept as usize] = self.vertices[n];
                self.rows_below[kept as usize] = self.rows_below[n];
                kept += 1;
            }
        }
        if !ids.is_empty() {
            self.vertices.truncate(kept as usize);
            self.rows_below.truncate(kept as usize);
        }
        ids
    }
}
