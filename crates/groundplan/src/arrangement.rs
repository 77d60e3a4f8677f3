//! II-C: lines -> half-edges, for any number of directions.
//!
//! Lines live on a lattice: whole-number coefficients, so that every question (which side, which comes first, do three
//! meet in one point) has an exact answer, and no input is degenerate. Floats are asked first and trusted only where
//! they are far from a tie. Lines of one direction are parallel, so they cross any other line in the order of their
//! offsets: nothing is sorted that comes sorted, and the cost grows with what is made.

use crate::bands::each;
use crate::grid::Frame;
use crate::lines::Lines;
use std::cmp::Ordering;

/// Bits after the point of the lattice.
const BITS: u32 = 26;
/// Floats closer than this many pixels are asked again exactly.
const TIE_PIXELS: f64 = 1e-6;
/// So many crossings are worth a thread's while.
const SHARE: usize = 1 << 14;
/// No id: a border edge's line, the outside's face.
pub const NONE: u32 = u32::MAX;

/// A line `a x + b y = c` over the grid in pixels; (a, b) is the direction's normal, all times 2^26.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LatticeLine {
    /// Coefficient of x.
    pub a: i64,
    /// Coefficient of y.
    pub b: i64,
    /// Offset along the normal.
    pub c: i64,
}

/// A point as fractions over one denominator, in pixels.
#[derive(Clone, Copy, Debug)]
struct Point {
    x: i128,
    y: i128,
    over: i128,
}

impl Point {
    fn new(x: i128, y: i128, over: i128) -> Self {
        if over < 0 { Self { x: -x, y: -y, over: -over } } else { Self { x, y, over } }
    }

    fn to_floats(self) -> [f64; 2] {
        [self.x as f64 / self.over as f64, self.y as f64 / self.over as f64]
    }

    /// Rows of pixels whose centres lie below: ceil(y - 1/2).
    fn rows_below(self, y: f64, height: usize) -> u32 {
        let whole = (y + 0.5) as i64;
        let part = (y + 0.5) - whole as f64;
        let rows = if part > TIE_PIXELS && part < 1.0 - TIE_PIXELS {
            whole
        } else {
            let (n, d) = (2 * self.y - self.over, 2 * self.over);
            -((-n).div_euclid(d)) as i64
        };
        rows.clamp(0, height as i64) as u32
    }
}

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
    Builder::new(frame.width as i64, frame.height as i64, lattice).build(threads)
}

/// Normal of a direction on the lattice. The y part is never negative, nor are both zero.
fn normal(angle: f64) -> [i64; 2] {
    let scale = (1u64 << BITS) as f64;
    [(-libm::sin(angle) * scale).round() as i64, (libm::cos(angle) * scale).round() as i64]
}

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

struct Builder {
    width: i64,
    height: i64,
    lines: Vec<LatticeLine>,
    families: Vec<Family>,
    /// Ends of each line on the map's border, in the order it runs; none when it misses the interior.
    ends: Vec<Option<[End; 2]>>,
    vertices: Vec<[f64; 2]>,
    rows_below: Vec<u32>,
    /// Union-find over vertices: three lines through a point are one vertex. Empty until any two were found to be one.
    same: Vec<u32>,
}

/// Where a line meets the border: side (0 bottom, 1 right, 2 top, 3 left) and the point.
#[derive(Clone, Copy, Debug)]
struct End {
    side: u8,
    point: Point,
}

impl Builder {
    fn new(width: i64, height: i64, lines: Vec<LatticeLine>) -> Self {
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
            width,
            height,
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
                builder.ends[n as usize] = builder.clip(builder.lines[n as usize]);
            }
            let kept: Vec<u32> = members.into_iter().filter(|&n| builder.ends[n as usize].is_some()).collect();
            builder.families[f].offsets = kept.iter().map(|&n| builder.lines[n as usize].c).collect();
            builder.families[f].members = kept;
        }
        builder
    }

    /// The ends of the line's piece within the map, unless it misses the interior. It runs with growing x, or with
    /// falling y when it is vertical: along (b, -a), as all lines do.
    fn clip(&self, line: LatticeLine) -> Option<[End; 2]> {
        let LatticeLine { a, b, c } = line;
        let (a, b, c) = (i128::from(a), i128::from(b), i128::from(c));
        let (width, height) = (i128::from(self.width), i128::from(self.height));
        let at_x = |x: i128, side: u8| End { side, point: Point::new(x * b, c - a * x, b) };
        let at_y = |y: i128, side: u8| End { side, point: Point::new(c - b * y, y * a, a) };
        if a == 0 {
            let inside = 0 < c * b.signum() && c.abs() < height * b.abs();
            return inside.then(|| [at_x(0, 3), at_x(width, 1)]);
        }
        let rising = a < 0;
        if b == 0 {
            let inside = 0 < c * a.signum() && c.abs() < width * a.abs();
            let (low, high) = (at_y(0, 0), at_y(height, 2));
            return inside.then_some(if rising { [low, high] } else { [high, low] });
        }
        let (enter_y, leave_y) = if rising { (at_y(0, 0), at_y(height, 2)) } else { (at_y(height, 2), at_y(0, 0)) };
        // A corner belongs to the side that starts there, going round counter-clockwise.
        let x_cmp = |end: &End, x: i128| end.point.x.cmp(&(x * end.point.over));
        let by_left_side = match x_cmp(&enter_y, 0) {
            Ordering::Less => true,
            Ordering::Equal => !rising,
            Ordering::Greater => false,
        };
        let by_right_side = match x_cmp(&leave_y, width) {
            Ordering::Greater => true,
            Ordering::Equal => !rising,
            Ordering::Less => false,
        };
        let enter = if by_left_side { at_x(0, 3) } else { enter_y };
        let leave = if by_right_side { at_x(width, 1) } else { leave_y };
        let (p, q) = (enter.point, leave.point);
        (p.x * q.over < q.x * p.over).then_some([enter, leave])
    }

    fn add_vertex(&mut self, point: Point) -> u32 {
        let floats = point.to_floats();
        self.vertices.push(floats);
        self.rows_below.push(point.rows_below(floats[1], self.height as usize));
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

    fn build(mut self, threads: usize) -> Arrangement {
        // Crossings: one vertex for each pair of lines, made from the earlier family's side.
        let families = std::mem::take(&mut self.families);
        let count = families.len();
        let mut runs = vec![Run::default(); self.lines.len() * count];
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
                    runs[n as usize * count + g] = run;
                }
            }
        }
        // Room for all of them at once: growing would copy what is many, and touch twice the memory.
        let room = crossings as usize + 2 * self.lines.len() + 4;
        self.vertices.reserve_exact(room);
        self.rows_below.reserve_exact(room);
        self.add_crossings(&families, &runs, crossings as usize, threads);
        // Ends on the border, going round; those in one place are one vertex, corners among them.
        let mut border: Vec<(End, u32)> = Vec::new();
        let (w, h) = (i128::from(self.width), i128::from(self.height));
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
        // The vertices along each line, families merged in the order the line meets them.
        let room = 2 * crossings as usize + self.lines.len() + border.len();
        let mut made = Arrangement {
            edges: Vec::with_capacity(room),
            edge_lines: Vec::with_capacity(room),
            line_edges: Vec::with_capacity(self.lines.len()),
            ..Arrangement::default()
        };
        let mut chain = Vec::new();
        let mut sequences: Vec<Vec<(u32, u32)>> = vec![Vec::new(); count.saturating_sub(1)];
        let family_of = {
            let mut of = vec![None; self.lines.len()];
            for (f, family) in families.iter().enumerate() {
                for (place, &n) in family.members.iter().enumerate() {
                    of[n as usize] = Some((f, place as u32));
                }
            }
            of
        };
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
                let [first, last] = end_vertices[n];
                chain.clear();
                chain.push(first);
                self.merge_sequences(n as u32, &sequences, &mut chain);
                chain.push(last);
                made.edges.extend(chain.windows(2).map(|pair| [pair[0], pair[1]]));
            }
            made.edge_lines.resize(made.edges.len(), n as u32);
            made.line_edges.push(start..made.edges.len() as u32);
        }
        self.assemble(made, &border)
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
        each(parts, threads, |(f, members, vertices, rows)| {
            let mut places = vertices.iter_mut().zip(rows);
            for &n in &families[f].members[members] {
                for (g, other) in families.iter().enumerate().skip(f + 1) {
                    let run = &runs[n as usize * families.len() + g];
                    let crossed = &other.members[run.first as usize..(run.first + run.count) as usize];
                    for (&m, (vertex, rows)) in crossed.iter().zip(&mut places) {
                        let point = self.crossing(n, m);
                        *vertex = point.to_floats();
                        *rows = point.rows_below(vertex[1], self.height as usize);
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
        let mut heads = vec![0usize; sequences.len()];
        let mut last: Option<(u32, u32)> = None;
        loop {
            let mut best: Option<(usize, (u32, u32))> = None;
            for (s, sequence) in sequences.iter().enumerate() {
                let Some(&candidate) = sequence.get(heads[s]) else {
                    continue;
                };
                let sooner =
                    best.is_none_or(|(_, held)| self.order(n, by_x, forwards, candidate, held) == Ordering::Less);
                if sooner {
                    best = Some((s, candidate));
                }
            }
            let Some((s, taken)) = best else { return };
            heads[s] += 1;
            if let Some(before) = last
                && self.order(n, by_x, forwards, before, taken) == Ordering::Equal
            {
                self.merge(before.0, taken.0);
            } else {
                chain.push(taken.0);
            }
            last = Some(taken);
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

/// Order of border points going round counter-clockwise from the lower left corner.
fn around(p: &End, q: &End) -> Ordering {
    p.side.cmp(&q.side).then_with(|| {
        let axis = |e: &End| if e.side % 2 == 0 { e.point.x } else { e.point.y };
        let along = (axis(p) * q.point.over).cmp(&(axis(q) * p.point.over));
        if p.side < 2 { along } else { along.reverse() }
    })
}

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

    /// The next half-edge around the face on the left of each. `sides` are those that the border's edges lie on.
    fn link(&self, sides: &[u8]) -> Vec<u32> {
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
    fn find_faces(&mut self, next: &[u32], border: usize) {
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
