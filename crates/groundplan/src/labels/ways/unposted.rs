//! Ways told by posts that are missing: empty bays show a post from bay to bay on either face, and where a row that shows nearly
//! all of them is open for longer, without one on either, two racks end.

use crate::labels::corridors::Strip;
use crate::labels::rows::sections::WIDTH;
use crate::labels::rows::seen::{self, Seen};
use crate::labels::rows::shelves::Shelves;
use crate::labels::view::runs::Run;
use crate::labels::view::turned::Turned;
use std::collections::BTreeMap;

/// Gaps differ by no more than so many columns where they are alike.
const ALIKE: usize = 2;
/// No bay is shorter, metres: goods leave slits between them.
const SLIT: f64 = 0.7;
/// A post is no longer along a face, metres.
const POST: f64 = 0.35;
/// So many gaps of a row that are alike are its bays.
const BAYS: usize = 3;
/// What is so many bays long, or longer, has no post in it where one would stand.
const LONGER: f64 = 1.4;
/// Fewer posts that are seen tell nothing.
const SEEN: usize = 8;
/// Fewer such places than this are expected where as many posts of one face are not seen.
const EXPECTED: f64 = 0.05;
/// Some bays may be longer: then there are more of them, and of two racks one has them where the other does not.
const SHARE: usize = 4;
const SEVERAL: usize = 3;

/// The ways in which posts are missing through rows between so many aisles, place by place.
pub fn find(seen: &[Seen], aisles: usize) -> Vec<Strip> {
    let of_place = |rows: Vec<&Seen>| among(&rows.iter().map(|row| (*row, Gaps::of(row))).collect::<Vec<_>>());
    seen::by_place(seen, aisles).into_iter().flat_map(of_place).collect()
}

fn among(rows: &[(&Seen, Gaps)]) -> Vec<Strip> {
    let Some(bay) = bay(rows) else { return Vec::new() };
    let told: Vec<(&Seen, Posts)> = rows.iter().map(|(row, gaps)| (*row, gaps.posts(row.views[0], bay))).collect();
    let all = told.iter().fold(Posts::default(), |all, (_, own)| all.and(own));
    if !all.tell() {
        return Vec::new();
    }
    let gates = told.iter().flat_map(|(row, own)| own.gaps.iter().map(move |gap| (row, *gap)));
    let gate = |(row, (from, to)): (&&Seen, Run)| {
        let view = row.views[0];
        let first = view.column(row.row.along[0]);
        let ends = [from, to].map(|n| view.start[0] + (first + n) as f64 * view.cell);
        (ends[1] - ends[0] >= WIDTH.0).then(|| row.gate(ends)).flatten()
    };
    gates.filter_map(gate).collect()
}

/// How long most gaps of some rows are, columns.
fn bay(rows: &[(&Seen, Gaps)]) -> Option<usize> {
    let mut lengths: BTreeMap<usize, usize> = BTreeMap::new();
    rows.iter()
        .flat_map(|(_, gaps)| gaps.0.iter().flatten())
        .for_each(|((from, to), _)| *lengths.entry(to - from).or_default() += 1);
    let alike = |length: usize| {
        lengths.range(length.saturating_sub(ALIKE / 2)..=length + ALIKE / 2).map(|(_, count)| count).sum::<usize>()
    };
    let most = lengths.keys().copied().max_by_key(|&length| (alike(length), length))?;
    (alike(most) >= BAYS).then_some(most)
}

/// From post to post of each face where the half of the row behind it is open, columns of the row, and whether the other half is
/// there, too.
struct Gaps([Vec<(Run, bool)>; 2]);

/// What posts tell.
#[derive(Default)]
struct Posts {
    /// How many stand between two empty bays, of both faces.
    stand: usize,
    /// How many bays are empty where the row is not open to the other face.
    alone: usize,
    /// How many do not stand on one face, where the other has them or is hidden.
    miss: usize,
    /// Where both faces have none for longer than a bay and the row is open.
    gaps: Vec<Run>,
}

impl Gaps {
    fn of(row: &Seen) -> Self {
        let view = row.views[0];
        let shelves = Shelves::new(view, row.row);
        let faces = shelves.faces(view);
        let is_open =
            |side: usize, (from, to): Run| shelves.halves[side].iter().any(|open| open.0 <= from && to <= open.1);
        Self([0, 1].map(|side| {
            let between = faces[side].windows(2).map(|pair| (pair[0].1, pair[1].0));
            between
                .filter(|&(from, to)| (to - from) as f64 * view.cell >= SLIT && is_open(side, (from, to)))
                .map(|gap| (gap, is_open(1 - side, gap)))
                .collect()
        }))
    }

    fn posts(&self, view: &Turned, bay: usize) -> Posts {
        let post = (POST / view.cell) as usize;
        let mut told = Posts::default();
        let is_bay = |(from, to): Run| (to - from).abs_diff(bay) <= ALIKE;
        for side in [0, 1] {
            let gaps = &self.0[side];
            let are_beside = |pair: &&[(Run, bool)]| {
                let [(one, _), (other, _)] = [pair[0], pair[1]];
                is_bay(one) && is_bay(other) && other.0 - one.1 <= post
            };
            told.stand += gaps.windows(2).filter(are_beside).count();
            told.alone += gaps.iter().filter(|(gap, is_through)| is_bay(*gap) && !is_through).count();
            let longer =
                gaps.iter().map(|(gap, _)| *gap).filter(|(from, to)| (to - from) as f64 >= LONGER * bay as f64);
            for (from, to) in longer {
                let is_same = |other: &Run| other.0.abs_diff(from) <= ALIKE && other.1.abs_diff(to) <= ALIKE;
                match self.0[1 - side].iter().map(|(gap, _)| *gap).find(is_same) {
                    Some(other) if side == 0 => told.gaps.push((from.max(other.0), to.min(other.1))),
                    Some(_) => {}
                    None => told.miss += ((to - from) / (bay + 1)).max(1),
                }
            }
        }
        // Of a row whose bays are longer than those of others none is a way.
        let bays = self.0.iter().flatten().filter(|(gap, _)| is_bay(*gap)).count();
        if bays <= told.gaps.len() {
            told.miss += told.gaps.len();
            told.gaps.clear();
        }
        told
    }
}

impl Posts {
    fn and(mut self, other: &Self) -> Self {
        self.gaps.extend(&other.gaps);
        let [stand, alone, miss] = [self.stand + other.stand, self.alone + other.alone, self.miss + other.miss];
        Self { stand, alone, miss, ..self }
    }

    /// True when the gaps are no bays: next to no post is missed between others, or of two racks back to back the one is empty for
    /// so long nowhere but where the other is.
    fn tell(&self) -> bool {
        let all = self.stand + self.miss;
        // As if half a post more were missed.
        let share = (self.miss as f64 + 0.5) / (all + 1) as f64;
        let are_seen =
            self.stand >= SEEN && SHARE * self.gaps.len() <= all && all as f64 / 2.0 * share * share < EXPECTED;
        let are_of_both =
            self.gaps.len() >= SEVERAL && SHARE * self.gaps.len() <= self.alone && SHARE * self.miss <= self.gaps.len();
        are_seen || are_of_both
    }
}
