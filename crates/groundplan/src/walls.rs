//! II-D: cogency -> separating and freestanding walls, the abstraction (Fig. 6).

use crate::arrangement::NONE;
use crate::bands::map_each;
use crate::grid::{State, tidy};
use crate::occupancy::Occupancy;
use crate::parameters::Parameters;
use crate::subdivision::Subdivision;
use std::ops::Range;

/// Metres in the map frame.
type Point = [f64; 2];

/// How a wall was known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallKind {
    /// By what it separates: one side is taken, the other is not.
    Separating,
    /// By what lies on it: both sides are alike.
    Freestanding,
}

/// A piece of wall: what lies on cogent edges of one kind, joined along their line, from where it begins to where it
/// ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Its ends, metres in the map frame.
    pub points: [[f64; 2]; 2],
    /// Its line.
    pub line: u32,
    /// How it was known.
    pub kind: WallKind,
}

/// C(edge) of the paper for each edge, and the walls that the cogent edges make.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walls {
    /// C(edge): there is a physical separation on it.
    pub cogent: Vec<bool>,
    /// Face disparity |O(f1) - O(f2)| of each edge; 0 on the border.
    pub disparity: Vec<f64>,
    /// The abstraction.
    pub walls: Vec<Wall>,
}

/// Against the unknown, disparity alone is the frontier of what was explored: a wall has this much on it as well.
const LEAST_OCCUPANCY_AT_FRONTIER: f64 = 0.2;
/// So many edges are worth a thread's while.
const SHARE: usize = 1 << 14;

/// C(edge) = |O(f1) - O(f2)| > t1 or O(edge) > t2.
#[must_use]
pub fn find_walls(subdivision: &Subdivision, occupancy: &Occupancy, parameters: &Parameters, threads: usize) -> Walls {
    let disparity = disparities(&subdivision.edge_faces, occupancy);
    Walls { disparity, ..trace_walls(subdivision, &edges_of_lines(subdivision), occupancy, parameters, threads) }
}

/// The edges of a line follow one another; those of the border come last.
fn edges_of_lines(subdivision: &Subdivision) -> Vec<(u32, Range<usize>)> {
    let mut first = 0;
    let lines = subdivision.edge_lines.chunk_by(|a, b| a == b).map(|edges| {
        let own = first..first + edges.len();
        first = own.end;
        (edges[0], own)
    });
    lines.filter(|(line, _)| *line != NONE).collect()
}

/// |O(f1) - O(f2)| of each edge, 0 on the border.
pub(crate) fn disparities(edge_faces: &[[u32; 2]], occupancy: &Occupancy) -> Vec<f64> {
    edge_faces.iter().map(|&faces| disparity(faces, occupancy)).collect()
}

fn disparity([l, r]: [u32; 2], occupancy: &Occupancy) -> f64 {
    if l == NONE || r == NONE { 0.0 } else { tidy((occupancy.faces[l as usize] - occupancy.faces[r as usize]).abs()) }
}

/// The same without the disparities, from lines and the edges of each.
pub(crate) fn trace_walls(
    subdivision: &Subdivision,
    lines: &[(u32, Range<usize>)],
    occupancy: &Occupancy,
    parameters: &Parameters,
    threads: usize,
) -> Walls {
    let edges = 0..subdivision.edge_faces.len();
    let disparity = |e: usize| disparity(subdivision.edge_faces[e], occupancy);
    let inner = |e: usize| !subdivision.edge_faces[e].contains(&NONE);
    let cogent: Vec<bool> = edges
        .clone()
        .map(|e| {
            inner(e) && (disparity(e) > parameters.walls_disparity || occupancy.edges[e] > parameters.walls_occupancy)
        })
        .collect();
    let kind = |e: usize| {
        if !cogent[e] {
            return None;
        }
        let unknown = subdivision.edge_faces[e].iter().any(|&f| occupancy.states[f as usize] == State::Unknown);
        if unknown && occupancy.edges[e] < LEAST_OCCUPANCY_AT_FRONTIER {
            None
        } else if disparity(e) > parameters.walls_disparity {
            Some(WallKind::Separating)
        } else {
            Some(WallKind::Freestanding)
        }
    };
    let kinds: Vec<Option<WallKind>> = edges.map(kind).collect();
    let min_opening = parameters.walls_min_opening + SAME;
    let parts = threads.clamp(1, kinds.len() / SHARE + 1);
    let walls = Evidence { subdivision, lines, occupancy, kinds: &kinds, min_opening }.walls(parts);
    Walls { walls, cogent, disparity: Vec::new() }
}

/// What the walls are traced from.
struct Evidence<'a> {
    subdivision: &'a Subdivision,
    lines: &'a [(u32, Range<usize>)],
    occupancy: &'a Occupancy,
    /// Of the cogent edges.
    kinds: &'a [Option<WallKind>],
    /// What is no wider is no opening: by a rounding's breadth above the parameter, since gaps are whole pixels and
    /// one just as wide would be one or not by where the origin lies.
    min_opening: f64,
}

/// Part of an edge on which something lies.
#[derive(Clone, Copy)]
struct Run {
    points: [Point; 2],
    /// Of its edge; none where that is not cogent.
    kind: Option<WallKind>,
    /// Where its edge begins.
    vertex: Point,
}

impl Evidence<'_> {
    /// Found in so many parts side by side.
    fn walls(&self, parts: usize) -> Vec<Wall> {
        let met = self.met();
        let part = |n: usize| &self.lines[self.lines.len() * n / parts..self.lines.len() * (n + 1) / parts];
        let mut made = map_each(parts, parts, |n| self.walls_on(part(n), &met)).into_iter();
        let first = made.next().unwrap_or_default();
        made.fold(first, |mut walls, more| {
            walls.extend(more);
            walls
        })
    }

    /// Those on some lines.
    fn walls_on(&self, lines: &[(u32, Range<usize>)], met: &[[u32; 2]]) -> Vec<Wall> {
        let mut walls = Vec::new();
        for (line, edges) in lines.iter().cloned() {
            let crossings: Vec<Point> = edges
                .clone()
                .map(|edge| self.subdivision.edge_vertices[edge][0])
                .chain([self.subdivision.edge_vertices[edges.end - 1][1]])
                .filter(|&v| met[v as usize].iter().any(|&other| other != NONE && other != line))
                .map(|v| self.subdivision.vertices[v as usize])
                .collect();
            let runs: Vec<Run> = edges.flat_map(|edge| self.runs(edge)).collect();
            for stretch in self.whole(&runs).chunk_by(|a, b| gap(a, b) <= self.min_opening) {
                self.trace(line, stretch, &crossings, &mut walls);
            }
        }
        walls
    }

    fn ends(&self, edge: usize) -> [Point; 2] {
        self.subdivision.edge_vertices[edge].map(|v| self.subdivision.vertices[v as usize])
    }

    /// Two lines that have walls up to each vertex, or next to it.
    fn met(&self) -> Vec<[u32; 2]> {
        let mut met = vec![[NONE; 2]; self.subdivision.vertices.len()];
        let edges = self.lines.iter().flat_map(|(line, edges)| edges.clone().map(|edge| (*line, edge)));
        for (line, edge) in edges.filter(|(_, edge)| self.kinds[*edge].is_some()) {
            let [p, q] = self.ends(edge);
            let runs = self.occupancy.runs_of(edge);
            let (before, after) = (runs.first().map(|run| run[0]), runs.last().map(|run| distance(p, q) - run[1]));
            for (vertex, apart) in self.subdivision.edge_vertices[edge].into_iter().zip([before, after]) {
                if apart.is_some_and(|apart| apart <= self.min_opening) {
                    let lines = &mut met[vertex as usize];
                    if lines[0] == NONE {
                        lines[0] = line;
                    } else if lines[0] != line {
                        lines[1] = line;
                    }
                }
            }
        }
        met
    }

    fn runs(&self, edge: usize) -> impl Iterator<Item = Run> {
        let (ends, kind, runs) = (self.ends(edge), self.kinds[edge], self.occupancy.runs_of(edge));
        // Mostly nothing lies on it.
        let length = if runs.is_empty() { 0.0 } else { distance(ends[0], ends[1]) };
        let run = move |run: &[f64; 2]| Run { points: run.map(|at| point(ends, at, length)), kind, vertex: ends[0] };
        runs.iter().map(run)
    }

    /// The runs of a line without scraps: what a gap too narrow to be an opening parts from the rest counts when it is
    /// longer than the gap.
    fn whole(&self, runs: &[Run]) -> Vec<Run> {
        let pieces: Vec<&[Run]> = runs.chunk_by(|a, b| gap(a, b) < SAME).collect();
        let gaps: Vec<f64> = pieces.windows(2).map(|pair| gap(&pair[0][pair[0].len() - 1], &pair[1][0])).collect();
        let counts = |n: usize| {
            let length = distance(pieces[n][0].points[0], pieces[n][pieces[n].len() - 1].points[1]);
            let beside = [n.checked_sub(1), Some(n)].into_iter().flatten();
            beside.filter_map(|n| gaps.get(n)).all(|&gap| gap > self.min_opening || gap <= length + SAME)
        };
        (0..pieces.len()).filter(|&n| counts(n)).flat_map(|n| pieces[n]).copied().collect()
    }

    /// The walls of a stretch without openings, one after another where its kind changes. Beyond its cogent edges it
    /// goes on as far as it does.
    fn trace(&self, line: u32, stretch: &[Run], crossings: &[Point], walls: &mut Vec<Wall>) {
        let first = walls.len();
        for run in stretch {
            let last = walls[first..].last_mut();
            match (last, run.kind) {
                (Some(wall), Some(kind)) if wall.kind != kind => {
                    wall.points[1] = run.vertex;
                    walls.push(Wall { points: [run.vertex, run.points[1]], line, kind });
                }
                (Some(wall), _) => wall.points[1] = run.points[1],
                (None, Some(kind)) => walls.push(Wall { points: [stretch[0].points[0], run.points[1]], line, kind }),
                (None, None) => {}
            }
        }
        // Edge pixels at a corner lie along neither wall: each is taken up to the other.
        if let [wall, ..] = &mut walls[first..] {
            wall.points[0] = self.corner(wall.points, crossings);
        }
        if let [.., wall] = &mut walls[first..] {
            wall.points[1] = self.corner([wall.points[1], wall.points[0]], crossings);
        }
    }

    /// The crossing that a wall's first end meets another wall in, else that end. The crossings follow one another along
    /// the wall's line.
    fn corner(&self, wall: [Point; 2], crossings: &[Point]) -> Point {
        let (Some(first), Some(last)) = (crossings.first(), crossings.last()) else { return wall[0] };
        // How far along, as a multiple of the way from the first to the last; those near enough are a few of all.
        let way = [0, 1].map(|axis| last[axis] - first[axis]);
        let along = |p: &Point| way[0] * (p[0] - first[0]) + way[1] * (p[1] - first[1]);
        let reach = 2.0 * self.min_opening * libm::hypot(way[0], way[1]);
        let from = crossings.partition_point(|p| along(p) < along(&wall[0]) - reach);
        let apart = |p: &Point| distance(*p, wall[0]);
        crossings[from..]
            .iter()
            .take_while(|p| along(p) <= along(&wall[0]) + reach)
            .filter(|p| apart(p) <= self.min_opening && 2.0 * apart(p) < distance(wall[0], wall[1]))
            .min_by(|p, q| apart(p).total_cmp(&apart(q)))
            .map_or(wall[0], |p| *p)
    }
}

/// Places nearer to each other than this are one, metres: what rounding makes of one.
const SAME: f64 = 1e-5;

fn distance(p: Point, q: Point) -> f64 {
    libm::hypot(q[0] - p[0], q[1] - p[1])
}

fn gap(before: &Run, after: &Run) -> f64 {
    distance(before.points[1], after.points[0])
}

/// The place so many metres along an edge, a vertex where it is one.
fn point(ends: [Point; 2], metres: f64, length: f64) -> Point {
    if metres < SAME {
        ends[0]
    } else if metres > length - SAME {
        ends[1]
    } else {
        [0, 1].map(|axis| tidy(ends[0][axis] + (ends[1][axis] - ends[0][axis]) * metres / length))
    }
}
