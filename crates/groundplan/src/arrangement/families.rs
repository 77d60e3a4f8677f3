//! Lines of one normal, which cross any other line in the order of their offsets.

use super::lattice::{End, LatticeLine, clip};

/// Lines of one normal, in the order of their offsets.
pub struct Family {
    pub a: i64,
    pub b: i64,
    /// Ids of the lines, ascending in c, no two the same line.
    pub members: Vec<u32>,
    offsets: Vec<i64>,
}

/// Crossings of one line with one family: a run of its members.
#[derive(Clone, Default)]
pub struct Run {
    pub first: u32,
    pub count: u32,
    /// Id of the vertex with member `first`; the others follow.
    pub vertex: u32,
}

impl Family {
    /// Members that cross the open piece between the ends of a line.
    fn run(&self, ends: &[End; 2]) -> Run {
        let value = |end: &End| (i128::from(self.a) * end.point.x + i128::from(self.b) * end.point.y, end.point.over);
        let (p, q) = (value(&ends[0]), value(&ends[1]));
        let (low, high) = if p.0 * q.1 <= q.0 * p.1 { (p, q) } else { (q, p) };
        let first = self.offsets.partition_point(|&c| i128::from(c) * low.1 <= low.0);
        let last = self.offsets.partition_point(|&c| i128::from(c) * high.1 < high.0);
        Run { first: first as u32, count: last.saturating_sub(first) as u32, vertex: 0 }
    }
}

/// The lines by their normals, those that cross a map of so many pixels, each once; and the ends of these on its border.
pub fn families(lines: &[LatticeLine], size: [i64; 2]) -> (Vec<Family>, Vec<Option<[End; 2]>>) {
    let mut order: Vec<u32> = (0..lines.len() as u32).collect();
    let key = |&n: &u32| {
        let line = lines[n as usize];
        (line.a, line.b, line.c, n)
    };
    order.sort_unstable_by_key(key);
    order.dedup_by_key(|n| lines[*n as usize]);
    let mut families: Vec<Family> = Vec::new();
    let mut ends = vec![None; lines.len()];
    for n in order {
        let line = lines[n as usize];
        ends[n as usize] = clip(line, size);
        if ends[n as usize].is_none() {
            continue;
        }
        match families.last_mut() {
            Some(family) if (family.a, family.b) == (line.a, line.b) => {
                family.members.push(n);
                family.offsets.push(line.c);
            }
            _ => families.push(Family { a: line.a, b: line.b, members: vec![n], offsets: vec![line.c] }),
        }
    }
    (families, ends)
}

/// For each line and family, line after line, which members it crosses; and how many crossings there are: one vertex for
/// each pair of lines, made from the earlier family's side.
pub fn runs(families: &[Family], ends: &[Option<[End; 2]>]) -> (Vec<Run>, usize) {
    let mut runs = vec![Run::default(); ends.len() * families.len()];
    let mut crossings = 0;
    for (f, family) in families.iter().enumerate() {
        for &n in &family.members {
            let Some(ends) = ends[n as usize] else { continue };
            for (g, other) in families.iter().enumerate().filter(|(g, _)| *g != f) {
                let mut run = other.run(&ends);
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
