//! II-C: lines -> half-edges, for any number of directions.
//!
//! Lines live on a lattice: whole-number coefficients, so that every question (which side, which comes first, do three
//! meet in one point) has an exact answer, and no input is degenerate. Floats are asked first and trusted only where
//! they are far from a tie. Lines of one direction are parallel, so they cross any other line in the order of their
//! offsets: nothing is sorted that comes sorted, and the cost grows with what is made.

use crate::grid::Frame;
use crate::lines::Lines;
use std::cmp::Ordering;

/// Bits after the point of the lattice.
const BITS: u32 = 26;
/// Floats closer than this many pixels are asked again exactly.
const TIE_PIXELS: f64 = 1e-6;
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
        let guess = (y - 0.5).ceil();
        let rows = if ((y - 0.5) - (y - 0.5).round()).abs() > TIE_PIXELS {
            guess as i128
        } else {
            let (n, d) = (2 * self.y - self.over, 2 * self.over);
            -((-n).div_euclid(d))
        };
        rows.clamp(0, height as i128) as u32
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
    /// Next half-edge around the face on the left.
    pub next: Vec<u32>,
    /// Face on the left of each half-edge, [`NONE`] outside.
    pub faces: Vec<u32>,
    /// One half-edge of each face.
    pub face_starts: Vec<u32>,
}

/// Arranges the lines; those that do not cross the map's interior get no edges.
#[must_use]
pub fn arrange(frame: &Frame, angles: &[f64], lines: &Lines) -> Arrangement {
    let normals: Vec<[i64; 2]> = angles.iter().map(|&angle| normal(frame.angle_to_grid(angle))).collect();
    let scale = (1u64 << BITS) as f64;
    let lattice = |(&direction, &offset): (&u32, &f64)| {
        let [a, b] = normals[direction as usize];
        let c = frame.offset_to_grid(angles[direction as usize], offset) * scale;
        LatticeLine { a, b, c: c.round() as i64 }
    };
    let lattice: Vec<LatticeLine> = lines.directions.iter().zip(&lines.offsets).map(lattice).collect();
    Builder::new(frame.width as i64, frame.height as i64, lattice).build()
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
    /// Union-find over vertices: three lines through a point are one vertex.
    same: Vec<u32>,
    /// True once any two vertices were found to be one.
    merged: bool,
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
            merged: false,
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
        self.same.push(self.same.len() as u32);
        self.same.len() as u32 - 1
    }

    fn root(&mut self, mut n: u32) -> u32 {
        while self.same[n as usize] != n {
            self.same[n as usize] = self.same[self.same[n as usize] as usize];
            n = self.same[n as usize];
        }
        n
    }

    fn merge(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.merged |= a != b;
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

    fn build(mut self) -> Arrangement {
        // Crossings: one vertex for each pair of lines, made from the earlier family's side.
        let families = std::mem::take(&mut self.families);
        let count = families.len();
        let mut runs = vec![Run::default(); self.lines.len() * count];
        for (f, family) in families.iter().enumerate() {
            for &n in &family.members {
                let Some(ends) = self.ends[n as usize] else { continue };
                for (g, other) in families.iter().enumerate().filter(|(g, _)| *g != f) {
                    let mut run = Self::run(&ends, other);
                    if f < g {
                        run.vertex = self.vertices.len() as u32;
                        for m in run.first..run.first + run.count {
                            let point = self.crossing(n, other.members[m as usize]);
                            self.add_vertex(point);
                        }
                    }
                    runs[n as usize * count + g] = run;
                }
            }
        }
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
        let mut chains: Vec<Vec<u32>> = vec![Vec::new(); self.lines.len()];
        for (f, family) in families.iter().enumerate() {
            for (place, &n) in family.members.iter().enumerate() {
                let mut sequences = Vec::with_capacity(count);
                for (g, other) in families.iter().enumerate().filter(|(g, _)| *g != f) {
                    let run = &runs[n as usize * count + g];
                    let vertex = |m: u32| {
                        if f < g {
                            run.vertex + (m - run.first)
                        } else {
                            let back = &runs[other.members[m as usize] as usize * count + f];
                            back.vertex + (place as u32 - back.first)
                        }
                    };
                    let members = run.first..run.first + run.count;
                    let mut sequence: Vec<(u32, u32)> =
                        members.map(|m| (vertex(m), other.members[m as usize])).collect();
                    // Along (b, -a) the other's offset grows when its normal has a part that way.
                    if i128::from(other.a) * i128::from(family.b) < i128::from(other.b) * i128::from(family.a) {
                        sequence.reverse();
                    }
                    sequences.push(sequence);
                }
                let [first, last] = end_vertices[n as usize];
                let mut chain = vec![first];
                self.merge_sequences(n, &sequences, &mut chain);
                chain.push(last);
                chains[n as usize] = chain;
            }
        }
        self.assemble(&chains, &border)
    }

    /// Merges sequences of (vertex, crossing line) along line `n`; crossings in one place become one vertex.
    fn merge_sequences(&mut self, n: u32, sequences: &[Vec<(u32, u32)>], chain: &mut Vec<u32>) {
        let line = self.lines[n as usize];
        let by_x = line.b.abs() >= line.a.abs();
        let forwards = if by_x { line.b > 0 } else { line.a < 0 };
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
            if sequences.len() > 1
                && let Some(before) = last
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

    /// Chains of vertices -> edges, half-edges around the vertices, faces.
    fn assemble(mut self, chains: &[Vec<u32>], border: &[(End, u32)]) -> Arrangement {
        // Merged vertices go; the others keep their order.
        let mut ids = vec![0u32; self.vertices.len()];
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
        self.vertices.truncate(kept as usize);
        self.rows_below.truncate(kept as usize);

        let mut made = Arrangement { lines: self.lines, ..Arrangement::default() };
        let mut ranks: Vec<[u32; 2]> = Vec::new();
        let (line_ranks, border_ranks) = rank(&made.lines);
        for (n, chain) in chains.iter().enumerate() {
            let start = made.edges.len() as u32;
            for pair in chain.windows(2) {
                let [p, q] = [ids[pair[0] as usize], ids[pair[1] as usize]];
                if p != q {
                    made.edges.push([p, q]);
                    made.edge_lines.push(n as u32);
                    ranks.push(line_ranks[n]);
                }
            }
            made.line_edges.push(start..made.edges.len() as u32);
        }
        let round = border.iter().chain(border.first());
        let round: Vec<(u8, u32)> = round.map(|(end, id)| (end.side, ids[*id as usize])).collect();
        for pair in round.windows(2) {
            let [(side, p), (_, q)] = [pair[0], pair[1]];
            if p != q {
                made.edges.push([p, q]);
                made.edge_lines.push(NONE);
                let side = usize::from(side);
                ranks.push([border_ranks[side], border_ranks[(side + 2) % 4]]);
            }
        }
        made.vertices = self.vertices;
        made.rows_below = self.rows_below;
        made.link(&ranks);
        made.find_faces();
        made
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

    /// Half-edges around the face that `first` has on its left, from `first` on.
    pub fn cycle(&self, first: u32) -> impl Iterator<Item = u32> + '_ {
        let step = move |&half: &u32| Some(self.next[half as usize]).filter(|&next| next != first);
        std::iter::successors(Some(first), step)
    }

    /// Sorts the half-edges around each vertex and links each to the next around its face.
    fn link(&mut self, ranks: &[[u32; 2]]) {
        let halves = self.edges.len() * 2;
        let rank = |half: u32| ranks[(half >> 1) as usize][(half & 1) as usize];
        let mut starts = vec![0u32; self.vertices.len() + 1];
        for half in 0..halves as u32 {
            starts[self.start(half) as usize + 1] += 1;
        }
        for n in 1..starts.len() {
            starts[n] += starts[n - 1];
        }
        let mut fill = starts.clone();
        let mut out = vec![0u32; halves];
        for half in 0..halves as u32 {
            let at = &mut fill[self.start(half) as usize];
            out[*at as usize] = half;
            *at += 1;
        }
        self.next = vec![0; halves];
        for pair in starts.windows(2) {
            let ways = &mut out[pair[0] as usize..pair[1] as usize];
            ways.sort_unstable_by_key(|&half| rank(half));
            // Arriving against a way out, the face on the left goes on along the next way clockwise.
            for n in 0..ways.len() {
                let clockwise = ways[(n + ways.len() - 1) % ways.len()];
                self.next[Self::twin(ways[n]) as usize] = clockwise;
            }
        }
    }

    fn find_faces(&mut self) {
        let halves = self.edges.len() as u32 * 2;
        let mut seen = vec![false; halves as usize];
        self.faces = vec![NONE; halves as usize];
        let first_border = self.edge_lines.iter().position(|&line| line == NONE).unwrap_or(0) as u32;
        for start in 0..halves {
            if seen[start as usize] {
                continue;
            }
            // The outside runs along the border's twins only.
            let outside = start >= 2 * first_border && start & 1 == 1;
            let face = if outside { NONE } else { self.face_starts.len() as u32 };
            let mut half = start;
            while !seen[half as usize] {
                seen[half as usize] = true;
                self.faces[half as usize] = face;
                half = self.next[half as usize];
            }
            if !outside {
                self.face_starts.push(start);
            }
        }
    }
}
