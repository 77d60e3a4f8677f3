//! Sets of lines that provoke ties, and everything that must hold of what they cut a map into.
//!
//! The checks count with fractions what the arrangement should have, and share no code with it.

use groundplan::arrangement::{Arrangement, LatticeLine, NONE, arrange};
use groundplan::directions::Directions;
use groundplan::gradients::Gradients;
use groundplan::lines::Lines;
use groundplan::occupancy::{Occupancy, find_occupancy};
use groundplan::subdivision::Subdivision;
use groundplan::sums::{FaceSums, Sums};
use groundplan::{Frame, Grid, Parameters, Table};
use std::collections::{BTreeMap, BTreeSet};

/// One lattice step, pixels.
pub const STEP: f64 = 1.0 / (1u64 << 26) as f64;

/// `SplitMix64`: the same numbers from the same seed, everywhere.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number from 0 to `end`, without `end`.
    pub fn below(&mut self, end: u64) -> u64 {
        self.next() % end
    }

    /// A number from `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len() as u64) as usize]
    }
}

/// Lines over a map, to be arranged.
#[derive(Clone, Debug)]
pub struct Case {
    pub frame: Frame,
    pub angles: Vec<f64>,
    pub directions: Vec<u32>,
    pub offsets: Vec<f64>,
}

/// What became of them.
pub struct Arranged {
    pub arrangement: Arrangement,
    pub subdivision: Subdivision,
}

impl Case {
    /// A map of `width` by `height` pixels of one metre, without lines.
    pub fn new(width: usize, height: usize) -> Self {
        let frame = Frame::new(width, height, 1.0, [0.0; 3]);
        Self { frame, angles: Vec::new(), directions: Vec::new(), offsets: Vec::new() }
    }

    /// A direction more, in degrees; its id.
    pub fn family(&mut self, degrees: f64) -> u32 {
        self.angles.push(degrees.to_radians());
        self.angles.len() as u32 - 1
    }

    /// A line more, by its offset in the map frame.
    pub fn line(&mut self, direction: u32, offset: f64) {
        self.directions.push(direction);
        self.offsets.push(offset);
    }

    /// A line more, through a point of the grid; exactly, where the point is whole pixels, the pixel is a metre and
    /// the origin zero.
    pub fn through(&mut self, direction: u32, x: f64, y: f64) {
        let angle = self.angles[direction as usize];
        let grid = self.frame.angle_to_grid(angle);
        let scale = (1u64 << 26) as f64;
        let (a, b) = ((-libm::sin(grid) * scale).round(), (libm::cos(grid) * scale).round());
        // Turned by pi, the normal points the other way.
        let same_way = libm::cos(angle - self.frame.angle_to_map(grid)).signum();
        self.line(direction, same_way * self.frame.offset_to_map(grid, (a * x + b * y) / scale));
    }

    /// The case of a seed: few pixels, up to six families, lines that meet in points and graze the border.
    pub fn random(seed: u64) -> Self {
        let mut random = Random(seed);
        let (width, height) = match random.below(8) {
            0 => (1, 1),
            1 => (1 + random.below(40), 1),
            2 => (1 + random.below(3), 1 + random.below(200)),
            _ => (1 + random.below(40), 1 + random.below(40)),
        };
        let (w, h) = (width as f64, height as f64);
        let mut case = Self::new(width as usize, height as usize);
        if random.below(4) == 0 {
            let origin = [random.between(-100.0, 100.0), random.between(-100.0, 100.0), random.between(-4.0, 4.0)];
            case.frame = Frame::new(case.frame.width, case.frame.height, 0.05, origin);
        }
        let diagonal = h.atan2(w).to_degrees();
        let first = random.between(-90.0, 90.0);
        for _ in 0..=random.below(6) {
            let turn = random.pick(&[0.5, 1e-3, 1e-6, 1e-7, 90.0, 60.0]);
            let half_slope = 0.5f64.atan().to_degrees();
            let degrees = random.pick(&[0.0, -90.0, 45.0, -45.0, 1e-6, 89.999_999, 30.0, 17.0, half_slope, diagonal]);
            let degrees = if random.below(3) == 0 { first + turn } else { degrees };
            case.family(degrees);
        }
        let points: Vec<[f64; 2]> = (0..=random.below(4))
            .map(|_| match random.below(4) {
                0 => [0.0, 0.0],
                1 => [random.pick(&[0.0, w]), random.pick(&[0.0, h])],
                2 => [random.below(width) as f64 + 0.5, random.below(height) as f64 + 0.5],
                _ => [random.below(width + 1) as f64, random.below(height + 1) as f64],
            })
            .collect();
        for _ in 0..random.below(30) {
            let family = random.below(case.angles.len() as u64) as u32;
            let last = case.offsets.last().copied().unwrap_or(0.0);
            match random.below(8) {
                0 => case.line(family, last + random.pick(&[0.0, STEP, 2.0 * STEP, 1e-3, 0.5, 1.0])),
                1 => case.line(family, random.pick(&[0.0, w, h, -w, -h, 1e3, -1e6, 1e15])),
                2 => case.through(family, random.between(0.0, w), random.between(0.0, h)),
                _ => {
                    let [x, y] = random.pick(&points);
                    case.through(family, x, y);
                }
            }
        }
        case
    }

    pub fn arrange(&self) -> Arranged {
        let count = self.offsets.len();
        let lines = Lines {
            directions: self.directions.clone(),
            offsets: self.offsets.clone(),
            amplitudes: vec![1.0; count],
            widths: vec![0.0; count],
            min_amplitude: 0.0,
        };
        let arrangement = arrange(&self.frame, &self.angles, &lines, 1);
        let subdivision = Subdivision::new(&self.frame, arrangement.clone(), 1);
        Arranged { arrangement, subdivision }
    }

    /// Arranges the lines and looks for everything that could be wrong; pixels too where the map is small.
    pub fn check(&self) -> Result<Arranged, String> {
        let made = self.arrange();
        let problems = made.subdivision.problems();
        if !problems.is_empty() {
            return Err(problems.join("; "));
        }
        check_half_edges(&made.arrangement)?;
        check_chains(&made.arrangement)?;
        check_counts(&self.frame, &made.arrangement)?;
        check_centres(&self.frame, &made)?;
        if self.frame.width * self.frame.height <= 2000 {
            self.check_pixels(&made.arrangement)?;
        }
        Ok(made)
    }

    /// Pixels of each face against the sides of the lines that each pixel's centre lies on.
    fn check_pixels(&self, arrangement: &Arrangement) -> Result<(), String> {
        let (width, height) = (self.frame.width, self.frame.height);
        let mut random = Random(0);
        let pixels: Vec<u8> = (0..width * height).map(|_| random.pick(&[0, 0, 205, 254, 255])).collect();
        let table = Table::trinary();
        let grid = Grid::new(&pixels, false, &table, self.frame);
        let crossing = crossing_lines(&self.frame, &arrangement.lines);
        let mut sums: BTreeMap<Vec<bool>, [u64; 4]> = BTreeMap::new();
        for y in 0..height {
            for x in 0..width {
                let right_or_above = |line: &LatticeLine| {
                    let (x, y) = (2 * x as i128 + 1, 2 * y as i128 + 1);
                    let side = i128::from(line.a) * x + i128::from(line.b) * y - 2 * i128::from(line.c);
                    if line.a < 0 { side <= 0 } else { side >= 0 }
                };
                let sum = sums.entry(crossing.iter().map(right_or_above).collect()).or_default();
                let value = usize::from(grid.row(y)[x]);
                sum[0] += 1;
                sum[1] += u64::from(table.occupancy[value]);
                sum[2] += u64::from(value == 205);
                sum[3] += u64::from(value >= 254);
            }
        }
        let found = self.occupancy(&grid, arrangement, 1);
        if found != self.occupancy(&grid, arrangement, 4) {
            return Err("four threads find another occupancy than one".to_owned());
        }
        let share = |part: u64, of: u64| (part as f64 / of as f64 * 1e6).round();
        let mut expected: Vec<[f64; 4]> = sums
            .values()
            .map(|s| [s[0] as f64, share(s[1], 100 * s[0]), share(s[2], s[0]), share(s[3], s[0])])
            .collect();
        let millionths = |share: f64| (share * 1e6).round();
        let mut counted: Vec<[f64; 4]> = (0..found.pixels.len())
            .filter(|&f| found.pixels[f] > 0)
            .map(|f| {
                let shares = [found.faces[f], found.unknown[f], found.free[f]].map(millionths);
                [found.pixels[f] as f64, shares[0], shares[1], shares[2]]
            })
            .collect();
        let order = |p: &[f64; 4], q: &[f64; 4]| p.partial_cmp(q).unwrap_or(std::cmp::Ordering::Equal);
        expected.sort_by(order);
        counted.sort_by(order);
        if expected == counted { Ok(()) } else { Err(format!("faces hold {counted:?} and not {expected:?}")) }
    }

    fn occupancy(&self, grid: &Grid, arrangement: &Arrangement, threads: usize) -> Occupancy {
        let directions = Directions { angles: self.angles.clone(), ..Directions::default() };
        let lines = Lines {
            directions: self.directions.clone(),
            offsets: self.offsets.clone(),
            widths: vec![0.0; self.offsets.len()],
            ..Lines::default()
        };
        let (gradients, parameters) = (Gradients::default(), Parameters::default());
        let height = grid.frame.height;
        let mut sums = FaceSums::new(grid, arrangement, 0..height, threads);
        // Found in two parts they are the same.
        let middle = height / 3;
        let parts = [0..middle, middle..height].map(|rows| FaceSums::new(grid, arrangement, rows, 1));
        let added: Vec<i64> = (0..sums.within.len())
            .map(|face| parts.iter().map(|part| part.within[face].percent + 1000 * part.within[face].free).sum())
            .collect();
        let whole: Vec<i64> = sums.within.iter().map(|sums| sums.percent + 1000 * sums.free).collect();
        assert_eq!(added, whole, "face sums in parts");
        for (sliver, under) in &mut sums.under {
            let mut found = parts.iter().flat_map(|part| &part.under).filter(|(face, _)| face == sliver);
            *under = found.next().map_or_else(Sums::default, |(_, sums)| *sums);
        }
        find_occupancy(&grid.frame, &sums, arrangement, &directions, &lines, &gradients, &parameters)
    }
}

/// The different lines that pass through the map's interior.
fn crossing_lines(frame: &Frame, lines: &[LatticeLine]) -> Vec<LatticeLine> {
    let (w, h) = (frame.width as i128, frame.height as i128);
    let crosses = |line: &&LatticeLine| {
        let corners = [(0, 0), (w, 0), (0, h), (w, h)];
        let side = |(x, y): (i128, i128)| i128::from(line.a) * x + i128::from(line.b) * y - i128::from(line.c);
        corners.iter().any(|&p| side(p) > 0) && corners.iter().any(|&p| side(p) < 0)
    };
    let different: BTreeSet<[i64; 3]> = lines.iter().filter(crosses).map(|l| [l.a, l.b, l.c]).collect();
    different.into_iter().map(|[a, b, c]| LatticeLine { a, b, c }).collect()
}

/// A point as fractions in lowest terms: x, y and what both are over.
fn crossing(p: [i128; 3], q: [i128; 3]) -> Option<[i128; 3]> {
    let over = p[0] * q[1] - q[0] * p[1];
    if over == 0 {
        return None;
    }
    let (x, y) = (p[2] * q[1] - q[2] * p[1], p[0] * q[2] - q[0] * p[2]);
    let (mut g, mut r) = (over.abs(), x.abs());
    for next in [y.abs(), 0] {
        while r != 0 {
            (g, r) = (r, g % r);
        }
        r = next;
    }
    let g = g * over.signum();
    Some([x / g, y / g, over / g])
}

/// Vertices, edges and faces as they follow from the lines' crossings, counted one by one.
fn check_counts(frame: &Frame, arrangement: &Arrangement) -> Result<(), String> {
    let lines: Vec<[i128; 3]> =
        crossing_lines(frame, &arrangement.lines).iter().map(|l| [l.a, l.b, l.c].map(i128::from)).collect();
    let (w, h) = (frame.width as i128, frame.height as i128);
    let mut inner: BTreeMap<[i128; 3], BTreeSet<usize>> = BTreeMap::new();
    for (n, &p) in lines.iter().enumerate() {
        for (m, &q) in lines.iter().enumerate().skip(n + 1) {
            let Some([x, y, over]) = crossing(p, q) else { continue };
            if 0 < x && x < w * over && 0 < y && y < h * over {
                inner.entry([x, y, over]).or_default().extend([n, m]);
            }
        }
    }
    let mut border: BTreeSet<[i128; 3]> = [[0, 0, 1], [w, 0, 1], [0, h, 1], [w, h, 1]].into();
    for &line in &lines {
        for side in [[1, 0, 0], [1, 0, w], [0, 1, 0], [0, 1, h]] {
            let Some([x, y, over]) = crossing(line, side) else {
                continue;
            };
            if 0 <= x && x <= w * over && 0 <= y && y <= h * over {
                border.insert([x, y, over]);
            }
        }
    }
    let through: usize = inner.values().map(BTreeSet::len).sum();
    let expected =
        [inner.len() + border.len(), lines.len() + through + border.len(), 1 + lines.len() + through - inner.len()];
    let found = [arrangement.vertices.len(), arrangement.edges.len(), arrangement.face_count()];
    if found == expected { Ok(()) } else { Err(format!("vertices, edges, faces are {found:?} and not {expected:?}")) }
}

/// Every half-edge is the next of exactly one, starts where that one ends, and has the same face on its left.
fn check_half_edges(arrangement: &Arrangement) -> Result<(), String> {
    let halves = arrangement.edges.len() * 2;
    let mut follows = vec![false; halves];
    let inner = (0..arrangement.face_count()).flat_map(|face| {
        let around = arrangement.around(face);
        around.iter().zip(around.iter().cycle().skip(1)).map(|(&half, &next)| (half, next))
    });
    // The outside runs along the border's twins, the other way round.
    let border: Vec<u32> =
        (0..halves as u32).filter(|&h| arrangement.edge_lines[h as usize / 2] == NONE && h % 2 == 1).collect();
    let outer = border.iter().zip(border.iter().cycle().skip(border.len() - 1)).map(|(&half, &next)| (half, next));
    for (half, next) in inner.chain(outer) {
        if std::mem::replace(&mut follows[next as usize], true) {
            return Err(format!("half-edge {next} follows two"));
        }
        if arrangement.start(next) != arrangement.start(Arrangement::twin(half)) {
            return Err(format!("half-edge {next} does not start where {half} ends"));
        }
        if arrangement.face(half) != arrangement.face(next) {
            return Err(format!("half-edges {half} and {next} have different faces"));
        }
        let outside = arrangement.edge_lines[half as usize / 2] == NONE && half % 2 == 1;
        if outside != (arrangement.face(half) == NONE) {
            return Err(format!("half-edge {half} and the outside"));
        }
    }
    if follows.contains(&false) {
        return Err("a half-edge follows none".to_owned());
    }
    Ok(())
}

/// The edges of a line follow one another, forwards, on the line.
fn check_chains(arrangement: &Arrangement) -> Result<(), String> {
    for (n, (line, edges)) in arrangement.lines.iter().zip(&arrangement.line_edges).enumerate() {
        let (a, b, c) = (line.a as f64, line.b as f64, line.c as f64);
        let mut before: Option<u32> = None;
        for edge in edges.clone() {
            let ends = arrangement.edges[edge as usize];
            if arrangement.edge_lines[edge as usize] != n as u32 || before.is_some_and(|v| v != ends[0]) {
                return Err(format!("edge {edge} of line {n} does not follow the one before"));
            }
            before = Some(ends[1]);
            let [p, q] = ends.map(|v| arrangement.vertices[v as usize]);
            if b * (q[0] - p[0]) - a * (q[1] - p[1]) < -1e-9 * (a.abs() + b.abs()) {
                return Err(format!("edge {edge} runs backwards along line {n}"));
            }
            if [p, q].iter().any(|p| (a * p[0] + b * p[1] - c).abs() > 1e-6 * (a.abs() + b.abs())) {
                return Err(format!("edge {edge} does not lie on line {n}"));
            }
        }
    }
    Ok(())
}

/// Every face's centre lies among its vertices.
fn check_centres(frame: &Frame, made: &Arranged) -> Result<(), String> {
    for face in 0..made.subdivision.faces() {
        let centre = frame.to_pixels(made.subdivision.centres[face]);
        let corners = &made.subdivision.face_vertices[made.subdivision.face(face)];
        for axis in 0..2 {
            let values = || corners.iter().map(|&v| made.arrangement.vertices[v as usize][axis]);
            let low = values().fold(f64::INFINITY, f64::min);
            let high = values().fold(f64::NEG_INFINITY, f64::max);
            // Centres are rounded to micrometres.
            let slack = 2e-6 / frame.resolution;
            if !(low - slack..=high + slack).contains(&centre[axis]) {
                return Err(format!(
                    "the centre of face {face} lies outside it: {centre:?}, axis {axis}: {low} to {high}"
                ));
            }
        }
    }
    Ok(())
}
