//! The pitch of racks of which most bays are empty: too few posts recur along all lines, but what stands by itself is posts and
//! frames there, and from one to the next in line it is a bay.

use super::frames::{LEG, NEAR};
use super::lags::{LAGS, LONGEST, in_parts};
use super::uprights::Upright;
use crate::ends::{holds, overlap, sorted};

/// A plate or a guard is no thicker than this, metres.
const PLATE: f64 = 0.4;
/// From face to face of one rack or of two back to back, metres; one alone is no deeper than the last.
const DEPTH: [f64; 2] = [0.5, 3.2];
const SINGLE: f64 = 1.6;
/// Where more legs than this stand around one, in line with it to either side, they are what a lidar saw of something else.
const CROWD: usize = 24;
/// What is nearer than this along a line is one thing, metres.
const APART: f64 = 0.3;
/// Gaps are of one length when they differ by no more than this, metres.
const ALIKE: f64 = 0.1;
/// So many from frame to frame, or from post to post, tell a pitch where half of all or more are of one length.
const FRAMES: usize = 3;
const POSTS: usize = 5;
const MOST: f64 = 0.5;

/// What stands across from face to face; of a post by itself both are where it stands.
#[derive(Clone, Copy, Debug)]
struct Frame {
    /// Along.
    at: f64,
    /// Across.
    faces: [f64; 2],
    is_plate: bool,
    /// A plate, no deeper than a rack, or with the legs of two back to back: pillars are none of these.
    is_rack: bool,
}

/// From a frame to the next one between the same faces.
#[derive(Clone, Copy, Debug)]
struct Gap {
    at: f64,
    faces: [f64; 2],
    length: f64,
    is_rack: bool,
}

impl Frame {
    /// Along and across.
    fn stands(&self) -> [f64; 2] {
        [self.at, self.faces[0]]
    }
}

impl Gap {
    fn begins(&self) -> [f64; 2] {
        [self.at, self.faces[0]]
    }
}

/// From post to post along a heading, metres, where that is told.
pub fn pitch(uprights: &[Upright], heading: [f64; 2]) -> Option<f64> {
    let (posts, frames) = standing(uprights, heading);
    let bays = apart(gaps(&frames));
    let racks =
        |pitch: f64, off: f64| bays.iter().filter(|bay| bay.is_rack && (bay.length - pitch).abs() <= off).count();
    let by_frames = common(&bays).filter(|(pitch, count)| *count >= FRAMES && 2 * racks(*pitch, ALIKE) > *count);
    let posts = gaps(&posts);
    let by_posts = || common(&posts).filter(|(pitch, count)| *count >= POSTS && racks(*pitch, 2.0 * ALIKE) > 0);
    let told = by_frames.or_else(by_posts).filter(|(pitch, _)| goes_on(&posts, *pitch));
    told.map(|(pitch, _)| in_parts(pitch))
}

/// The length that half of some gaps or more have, metres, and how many these are.
fn common(gaps: &[Gap]) -> Option<(f64, usize)> {
    let mut lengths: Vec<f64> = gaps.iter().map(|gap| gap.length).collect();
    lengths.sort_by(f64::total_cmp);
    let alike = |length: f64| {
        let from = lengths.partition_point(|other| *other < length - ALIKE);
        let to = lengths.partition_point(|other| *other <= length + ALIKE);
        &lengths[from..to]
    };
    let most = lengths.iter().map(|&length| alike(length)).max_by_key(|alike| alike.len())?;
    let mean = most.iter().sum::<f64>() / most.len() as f64;
    let is_told = most.len() as f64 >= MOST * lengths.len() as f64 && holds([LAGS.0, LONGEST], mean);
    is_told.then_some((mean, most.len()))
}

/// True when two gaps of a length follow one another: across rows that are full posts are as far apart on both sides of a way,
/// but beyond them no others are.
fn goes_on(gaps: &[Gap], length: f64) -> bool {
    let alike = |gap: &&Gap| (gap.length - length).abs() <= ALIKE;
    let cells = Cells::new([NEAR; 2], gaps.iter().map(Gap::begins));
    gaps.iter().filter(alike).any(|gap| {
        let end = [gap.at + gap.length, gap.faces[0]];
        let begins = |n: usize| {
            let other = &gaps[n];
            alike(&other) && (0..2).all(|axis| (other.begins()[axis] - end[axis]).abs() <= NEAR)
        };
        cells.around(end).any(begins)
    })
}

/// The posts and the frames that uprights are: a plate's ends are posts, and two legs across from each other are a frame.
fn standing(uprights: &[Upright], heading @ [cos, sin]: [f64; 2]) -> (Vec<Frame>, Vec<Frame>) {
    let (mut legs, mut plates) = (Vec::new(), Vec::new());
    for upright in uprights {
        let [x, y] = upright.at;
        let (at, v) = (x * cos + y * sin, y * cos - x * sin);
        let [along, across] = upright.extents(heading);
        if along <= LEG && across <= LEG {
            legs.push(Frame { at, faces: [v; 2], is_plate: false, is_rack: false });
        } else if along <= PLATE && holds(DEPTH, across) {
            let faces = [v - across / 2.0, v + across / 2.0];
            plates.push(Frame { at, faces, is_plate: true, is_rack: true });
        }
    }
    let cells = Cells::new([NEAR, DEPTH[1]], legs.iter().map(Frame::stands));
    legs.retain(|leg| cells.around(leg.stands()).take(CROWD + 1).count() <= CROWD);
    let cells = Cells::new([NEAR, DEPTH[1]], legs.iter().map(Frame::stands));
    let frame = |one: &Frame, other: &Frame| {
        let is_near = |leg: &Frame| (leg.at - one.at).abs() <= NEAR;
        let faces = sorted([one.faces[0], other.faces[0]]);
        let depth = faces[1] - faces[0];
        if !is_near(other) || !holds(DEPTH, depth) {
            return None;
        }
        let between = [faces[0] + LEG, faces[1] - LEG];
        let is_between = |n: usize| is_near(&legs[n]) && holds(between, legs[n].faces[0]);
        let is_rack = depth <= SINGLE || cells.around(one.stands()).any(is_between);
        Some(Frame { at: f64::midpoint(one.at, other.at), faces, is_plate: false, is_rack })
    };
    let mut frames = plates.clone();
    for (n, leg) in legs.iter().enumerate() {
        frames.extend(cells.around(leg.stands()).filter(|&m| m > n).filter_map(|m| frame(leg, &legs[m])));
    }
    let ends = plates.iter().flat_map(|plate| plate.faces.map(|face| Frame { faces: [face; 2], ..*plate }));
    (legs.iter().copied().chain(ends).collect(), frames)
}

/// From each of some frames to the next one in line. Between two plates lies a way as a rule.
fn gaps(frames: &[Frame]) -> Vec<Gap> {
    let cells = Cells::new([LAGS.1, NEAR], frames.iter().map(Frame::stands));
    let gap = |one: &Frame| {
        let is_in_line = |other: &&Frame| {
            (APART..=LAGS.1).contains(&(other.at - one.at))
                && (0..2).all(|face| (other.faces[face] - one.faces[face]).abs() <= NEAR)
        };
        let others = cells.around(one.stands()).map(|n| &frames[n]).filter(is_in_line);
        let next = others.min_by(|a, b| a.at.total_cmp(&b.at))?;
        let (length, is_rack) = (next.at - one.at, one.is_rack || next.is_rack);
        (!one.is_plate || !next.is_plate).then_some(Gap { at: one.at, faces: one.faces, length, is_rack })
    };
    frames.iter().filter_map(gap).collect()
}

/// Of gaps at one place one: of two racks back to back each has one, and both together.
fn apart(mut gaps: Vec<Gap>) -> Vec<Gap> {
    let cells = Cells::new([APART, DEPTH[1]], gaps.iter().map(Gap::begins));
    let mut is_kept = vec![false; gaps.len()];
    for n in 0..gaps.len() {
        let gap = gaps[n];
        let is_same = |other: &Gap| {
            let is_near = |one: f64, other: f64| (one - other).abs() <= APART;
            is_near(gap.at, other.at) && is_near(gap.length, other.length) && overlap(gap.faces, other.faces) > 0.0
        };
        let same = cells.around(gap.begins()).find(|&m| is_kept[m] && is_same(&gaps[m]));
        match same {
            Some(same) => gaps[same].is_rack |= gap.is_rack,
            None => is_kept[n] = true,
        }
    }
    gaps.into_iter().zip(is_kept).filter_map(|(gap, is_kept)| is_kept.then_some(gap)).collect()
}

/// Numbers by places along and across: what is nearer than a cell's sides is in it or in one around it.
struct Cells {
    /// Metres.
    sides: [f64; 2],
    /// The first column.
    first: i64,
    /// Where each column begins, and where the last one ends.
    starts: Vec<u32>,
    /// Column after column rows and numbers, ascending.
    numbers: Vec<(i64, u32)>,
}

impl Cells {
    fn new(sides: [f64; 2], places: impl Iterator<Item = [f64; 2]>) -> Self {
        let mut cells: Vec<_> = (0..).zip(places).map(|(n, place)| (cell(sides, place), n)).collect();
        cells.sort_unstable();
        let first = cells.first().map_or(0, |([column, _], _)| *column);
        let mut starts = Vec::new();
        for (n, ([column, _], _)) in cells.iter().enumerate() {
            starts.resize((column - first) as usize + 1, n as u32);
        }
        starts.push(cells.len() as u32);
        Self { sides, first, starts, numbers: cells.into_iter().map(|([_, row], n)| (row, n)).collect() }
    }

    fn around(&self, place: [f64; 2]) -> impl Iterator<Item = usize> {
        let [column, row] = cell(self.sides, place);
        let of_column = move |column: i64| {
            let n = usize::try_from(column - self.first).unwrap_or(usize::MAX);
            let ends = self.starts.get(n).zip(self.starts.get(n.saturating_add(1)));
            let cells = ends.map_or(&[][..], |(from, to)| &self.numbers[*from as usize..*to as usize]);
            let from = cells.partition_point(|(other, _)| *other < row.saturating_sub(1));
            cells[from..].iter().take_while(move |(other, _)| *other <= row.saturating_add(1))
        };
        (column.saturating_sub(1)..=column.saturating_add(1)).flat_map(of_column).map(|(_, n)| *n as usize)
    }
}

fn cell(sides: [f64; 2], place: [f64; 2]) -> [i64; 2] {
    [0, 1].map(|axis| (place[axis] / sides[axis]).floor() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Legs and plates at places, in pixels of 5 cm from one corner to another.
    fn uprights(boxes: &[[u32; 4]]) -> Vec<Upright> {
        use crate::grid;
        use crate::labels::posts::uprights;
        use crate::pixels::Pixels;
        let frame = grid::Frame::new(1000, 1000, 0.05, [0.0; 3]);
        let mut pixels: Vec<[u32; 2]> = boxes
            .iter()
            .flat_map(|&[left, low, right, high]| (low..=high).flat_map(move |y| (left..=right).map(move |x| [x, y])))
            .collect();
        pixels.sort_unstable_by_key(|&[x, y]| [y, x]);
        uprights::find(&frame, &Pixels::from_iter(pixels))
    }

    fn leg([x, y]: [u32; 2]) -> [u32; 4] {
        [x, y, x + 1, y + 1]
    }

    /// The legs of two racks back to back.
    fn frame(x: u32, y: u32) -> Vec<[u32; 4]> {
        [0, 18, 24, 42].map(|v| leg([x, y + v])).to_vec()
    }

    /// The pitch of what stands along x, and of what stands along y.
    fn pitches(boxes: &[[u32; 4]]) -> [Option<f64>; 2] {
        let uprights = uprights(boxes);
        [[1.0, 0.0], [0.0, 1.0]].map(|heading| pitch(&uprights, heading))
    }

    #[test]
    fn three_bays_between_frames_tell_a_pitch_though_others_hold_goods() {
        let row = |y: u32, places: &[u32]| places.iter().flat_map(|x| frame(*x, y)).collect::<Vec<_>>();
        let guards = [[99, 100, 100, 143], [339, 100, 340, 143]];
        let goods = [[225, 103, 250, 118], [260, 105, 280, 130]];
        let all = [row(100, &[160, 220]), row(200, &[100, 160, 400]), guards.to_vec(), goods.to_vec()].concat();
        assert_eq!(pitches(&all), [Some(3.0), None]);
    }

    #[test]
    fn posts_on_both_sides_of_ways_through_full_rows_tell_none() {
        let all = [100, 200, 300].map(|y| [100, 160, 300, 360].map(|x| frame(x, y)).concat()).concat();
        assert_eq!(pitches(&all), [None; 2]);
        let bays = [100, 200].map(|y| [100, 160, 220].map(|x| frame(x, y)).concat()).concat();
        assert_eq!(pitches(&bays), [Some(3.0), None]);
    }

    #[test]
    fn posts_in_line_tell_a_pitch_where_frames_are_too_few() {
        let frames = [frame(400, 200), frame(460, 200)].concat();
        let wall = [100, 160, 220, 280, 340].map(|x| leg([x, 300]));
        assert_eq!(pitches(&frames), [None; 2]);
        assert_eq!(pitches(&wall), [None; 2]);
        assert_eq!(pitches(&[frames, wall.to_vec()].concat()), [Some(3.0), None]);
    }

    #[test]
    fn pillars_are_no_frames() {
        let lattice =
            |step: u32| (0..16).map(|n| leg([100 + step * (n % 4), 100 + step * (n / 4)])).collect::<Vec<_>>();
        assert_eq!(pitches(&lattice(48)), [None; 2]);
    }

    #[test]
    fn what_lies_between_two_guards_is_a_way() {
        let guards = [100, 180, 260, 340].map(|x| [x, 100, x + 1, 143]);
        assert_eq!(pitches(&guards), [None; 2]);
    }
}
