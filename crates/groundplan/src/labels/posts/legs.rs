//! Racks of which a lidar sees the legs alone: under the lowest beams there is floor, and the legs stand in pairs of rows at
//! one pitch. Two legs that stand across from each other make a frame, as does a plate that joins them; frames that
//! follow one another at one pitch with the same two faces are a rack, where there are others of the kind or what is back to
//! back is no table.

use super::against;
use super::frames::{AISLE, BACK, Frame, LEG, Legs, NEAR, frames};
use super::grounds::on_map;
use super::map::{Map, steps};
use super::rack::{ALIKE, Rack, UP_TO_WALL};
use super::uprights::Upright;
use crate::bands::{map_each, worth};
use crate::directions::Directions;
use crate::ends::{both, holds, overlap, sorted, wider};
use crate::labels::Scene;
use crate::labels::near::Near;
use crate::labels::rows::Row;
use crate::labels::rows::blocks;
use crate::labels::view::axes::Axes;
use std::collections::BTreeMap;

/// From frame to frame, metres, and in depths at least.
const PITCH: [f64; 2] = [0.8, 4.5];
const OBLONG: f64 = 0.7;
/// Of the gaps from frame to frame the one that so many times as many are no less than is the pitch: frames may be missing.
const QUARTER: usize = 4;
/// So many frames make what may be a rack, and so many of a kind are racks: one may be a long table.
const FRAMES: usize = 3;
const KIND: usize = 2;
/// Pitches of racks that are not as deep differ by no more than this share where they are of a kind, and of these there are more.
const STEPS: f64 = 0.01;
const SEVERAL: usize = 3;
/// Between plates a single rack shows so many frames, with these.
const CLOSED: usize = 5;
/// With so many frames that are no plates those tell that plates are ends.
const OTHERS: usize = 2;
/// No table is longer, nor desks side by side, metres; a desk is no wider, and what is, in two rows, no longer.
const TABLE: f64 = 14.0;
const DESK: (f64, f64) = (2.2, 8.0);
/// Two racks are one where they share so much of their length.
const SHARED: f64 = 0.8;
/// A rack that leans on something shows so many of its frames.
const LEANING: usize = 2;
/// No way leads between a wall and what ends one bay before it, where bays are shorter, metres: that leans on the wall.
const NARROW: f64 = 1.2;
/// What is smaller than this share of a rack's legs is none where one stands alone.
const SPECK: f64 = 0.4;

/// The racks that some uprights are legs of, along each direction.
pub fn find(scene: &Scene, uprights: &[Upright]) -> Vec<Rack> {
    let Scene { grid, directions, threads, .. } = *scene;
    let threads = worth(grid.frame.width * grid.frame.height, threads);
    let along = |direction: usize| {
        let angle = directions.angles[direction];
        let heading = [libm::cos(angle), libm::sin(angle)];
        let (frames, legs) = frames(uprights, heading);
        let map = Map { grid, heading };
        let rows = in_rows(&frames, &legs, &map);
        let mut found: Vec<Rack> = rows.iter().map(|(pitch, row)| rack(direction, row, *pitch, &legs, &map)).collect();
        found.retain(|rack| blocks::is_oblong(&rack.row) && map.shows_floor(&rack.row));
        let mut found = back_to_back(found);
        found.retain(|rack| !map.goes_on(rack));
        let mut found: Vec<Rack> = found.iter().filter(|rack| is_kind(rack, &found)).cloned().collect();
        let leaning: Vec<Rack> = frames.iter().filter_map(|frame| leaning(&map, &found, &frames, frame)).collect();
        found.extend(leaning);
        let mut found = back_to_back(found);
        against::up_to_walls(&map, &mut found);
        lean(&mut found, Axes::of(directions, direction).lean);
        found
    };
    let mut racks = map_each(directions.angles.len(), threads, along).concat();
    // Legs of more than one direction's racks are of that which has most of them in a row.
    racks.sort_by_key(|rack| std::cmp::Reverse(rack.frames));
    let rows: Vec<&Row> = racks.iter().map(|rack| &rack.row).collect();
    let corners: Vec<_> = rows.iter().map(|row| on_map(directions, row).to_vec()).collect();
    let near = Near::polygons(&corners);
    let mut stays = vec![false; rows.len()];
    for (n, row) in rows.iter().enumerate() {
        let is_same = |m: u32| {
            let other = rows[m as usize];
            let is_kept = stays[m as usize] && other.direction != row.direction;
            is_kept && (lies_over(directions, other, row) || lies_over(directions, row, other))
        };
        stays[n] = !near.beside(&corners[n]).into_iter().any(is_same);
    }
    racks.into_iter().zip(stays).filter_map(|(rack, stays)| stays.then_some(rack)).collect()
}

/// Places along racks as they lean with what crosses them.
fn lean(racks: &mut [Rack], lean: f64) {
    for Rack { row, .. } in racks {
        let by = lean * f64::midpoint(row.across[0], row.across[1]);
        row.along = row.along.map(|u| u - by);
    }
}

/// True when a row lies over some of another's middle line.
fn lies_over(directions: &Directions, row: &Row, other: &Row) -> bool {
    let [own, its] = [row, other].map(|row| Axes::of(directions, row.direction));
    let v = f64::midpoint(other.across[0], other.across[1]);
    let mut places = steps(other.along, row.depth().min(row.length()) / 2.0);
    places.any(|u| {
        let [u, v] = own.place(its.to_map([u, v]));
        holds(row.along, u) && holds(row.across, v)
    })
}

/// Frames that follow one another at one pitch, and that.
fn in_rows(frames: &[Frame], legs: &Legs, map: &Map) -> Vec<(f64, Vec<Frame>)> {
    // By strips as wide as legs may be off.
    let strip = |frame: &Frame| (frame.faces[0] / NEAR).floor() as i64;
    let mut strips: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    (0..frames.len()).for_each(|n| strips.entry(strip(&frames[n])).or_default().push(n));
    let next = |n: usize| {
        let own = &frames[n];
        let near = (strip(own) - 1..=strip(own) + 1).filter_map(|s| strips.get(&s)).filter_map(|strip| {
            let first = strip.partition_point(|&m| m <= n);
            let is_like = |m: &&usize| own.is_in_line(frames[**m].faces);
            strip[first..].iter().take_while(|m| frames[**m].at <= own.at + 2.0 * PITCH[1]).find(is_like)
        });
        near.min().copied()
    };
    let nexts: Vec<Option<usize>> = (0..frames.len()).map(next).collect();
    let mut taken = vec![false; frames.len()];
    let mut rows = Vec::new();
    for first in 0..frames.len() {
        if taken[first] {
            continue;
        }
        let mut row = vec![first];
        while let Some(other) = nexts[row[row.len() - 1]].filter(|&other| !taken[other]) {
            taken[other] = true;
            row.push(other);
        }
        rows.extend(at_one_pitch(row.iter().map(|&n| frames[n]).collect(), legs, map));
    }
    rows
}

/// From frame to frame of a row, as it is where none is missing; nothing where that is no rack's.
fn pitch_of(row: &[Frame]) -> Option<f64> {
    let mut gaps: Vec<f64> = row.windows(2).map(|pair| pair[1].at - pair[0].at).collect();
    gaps.sort_by(f64::total_cmp);
    let least = PITCH[0].max(OBLONG * row[0].depth());
    gaps.get(gaps.len() / QUARTER).copied().filter(|pitch| (least..=PITCH[1]).contains(pitch))
}

/// The pieces of a row of frames whose gaps are alike, but for frames of which one leg was not seen, each with its pitch.
fn at_one_pitch(mut row: Vec<Frame>, legs: &Legs, map: &Map) -> Vec<(f64, Vec<Frame>)> {
    // A plate and the legs that it joins are one frame, and so is what a map shows twice.
    row.dedup_by(|next, frame| {
        let is_same = next.at - frame.at <= LEG;
        if is_same {
            *frame =
                Frame { at: f64::midpoint(frame.at, next.at), is_plate: frame.is_plate || next.is_plate, ..*frame };
        }
        is_same
    });
    let mut found = Vec::new();
    let mut left = vec![&row[..]];
    while let Some(some) = left.pop() {
        let Some(pitch) = pitch_of(some) else { continue };
        let pieces = pieces(some, pitch, legs, map);
        let mut first = 0;
        for others in pieces.chunk_by(|a, b| a.len() < FRAMES && b.len() < FRAMES) {
            let frames = &some[first..first + others.iter().map(|piece| piece.len()).sum::<usize>()];
            first += frames.len();
            // Of another rack in line bays may be longer.
            match others {
                [piece] if piece.len() >= FRAMES => found.push((own_pitch(piece, pitch), piece.to_vec())),
                _ if frames.len() < some.len() => left.push(frames),
                _ => {}
            }
        }
    }
    found.sort_by(|a: &(f64, Vec<Frame>), b| a.1[0].at.total_cmp(&b.1[0].at));
    found
}

/// The pitch of a piece of a row by itself, if all its frames are whole numbers of that apart and it is nearly the one by which they
/// were parted from others, else that: where no two next to each other were seen it is twice as long.
fn own_pitch(piece: &[Frame], parted: f64) -> f64 {
    let is_nearly = |pitch: &f64| (pitch / parted).round() as i64 == 1;
    let is_whole = |pitch: &f64| piece.windows(2).all(|pair| bays_between(&pair[0], &pair[1], *pitch).is_some());
    pitch_of(piece).filter(is_nearly).filter(is_whole).unwrap_or(parted)
}

/// How many bays of a pitch lie from one frame to a later one, where that is a whole number.
fn bays_between(one: &Frame, other: &Frame, pitch: f64) -> Option<usize> {
    let gap = other.at - one.at;
    let bays = (gap / pitch).round();
    (bays >= 1.0 && (gap - bays * pitch).abs() <= NEAR).then_some(bays as usize)
}

/// True when plates end racks of a row: no more of its frames are some, or of those that goods leave to be seen the first and the
/// last are, and each other one faces just one.
fn are_ends(row: &[Frame], pitch: f64) -> bool {
    let plates = row.iter().filter(|frame| frame.is_plate).count();
    let face = |n: usize| {
        let [one, other] = [&row[n], &row[n + 1]];
        one.is_plate && other.is_plate && bays_between(one, other, pitch) == Some(1)
    };
    let last = row.len() - 1;
    let is_end = |n: usize| {
        let faced = usize::from(n > 0 && face(n - 1)) + usize::from(n < last && face(n));
        faced == 1 || faced == 0 && (n == 0 || n == last)
    };
    let is_closed = || row[0].is_plate && row[last].is_plate && row.len() >= plates + OTHERS;
    2 * plates <= row.len() || is_closed() && (0..row.len()).filter(|&n| row[n].is_plate).all(is_end)
}

/// A row of frames, parted where one does not follow another at a pitch.
fn pieces<'a>(row: &'a [Frame], pitch: f64, legs: &Legs, map: &Map) -> Vec<&'a [Frame]> {
    // Of racks that plates close two face each other across a way, be it as wide as a bay.
    let are_ends = are_ends(row, pitch);
    let is_next = |a: &Frame, b: &Frame| {
        if are_ends && a.is_plate && b.is_plate {
            return false;
        }
        let Some(bays) = bays_between(a, b, pitch) else { return false };
        let place = |n: f64| a.at + (b.at - a.at) * n / bays as f64;
        let is_seen = |n: usize| legs.stand_at(place(n as f64), a.faces);
        // Between goods that hide both its frames what is free may be a way.
        let is_bay = |n: usize| is_seen(n) || is_seen(n + 1) || map.hides(place(n as f64 + 0.5), a.faces);
        (1..bays).all(|n| is_seen(n) || map.is_hidden(place(n as f64), a.faces)) && (1..bays - 1).all(is_bay)
    };
    row.chunk_by(is_next).collect()
}

/// The rack of some frames at about a pitch, with those at its ends of which one leg was not seen, unless a wall parts them from
/// it: specks lie behind that, and elsewhere a few that are smaller than legs.
fn rack(direction: usize, row: &[Frame], pitch: f64, legs: &Legs, map: &Map) -> Rack {
    let [first, last] = [row[0].at, row[row.len() - 1].at];
    let bays = ((last - first) / pitch).round().max(1.0);
    let pitch = (last - first) / bays;
    let mean = |face: usize| row.iter().map(|frame| frame.faces[face]).sum::<f64>() / row.len() as f64;
    let across = [mean(0), mean(1)];
    let mut sizes: Vec<f64> = row.iter().flat_map(|frame| legs.sizes_at(frame.at, frame.faces)).collect();
    sizes.sort_by(f64::total_cmp);
    let usual = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    let least = SPECK * usual;
    let is_leg = |place: f64| legs.sizes_at(place, across).any(|size| size >= least);
    let beyond = |from: f64, by: f64| {
        let mut off = 0.0;
        while is_leg(from + off + by) && !map.is_walled(sorted([from + off, from + off + by]), across) {
            off += by;
        }
        off
    };
    let (below, above) = (beyond(first, -pitch), beyond(last, pitch));
    let closed = [row[0].is_plate && below == 0.0, row[row.len() - 1].is_plate && above == 0.0];
    // Where plates close racks, one that ends without leans on what it ends at, as what leaves no room for a way does.
    let up_to_wall = |end: f64, by: f64, is_closed: bool| {
        let may_lean = !is_closed && (closed.contains(&true) || pitch < NARROW);
        if may_lean && map.is_walled(wider([end + by; 2], UP_TO_WALL), across) { end + by } else { end }
    };
    let along = [up_to_wall(first + below, -pitch, closed[0]), up_to_wall(last + above, pitch, closed[1])];
    let frames = ((along[1] - along[0]) / pitch).round() as usize + 1;
    let row = Row { direction, along, across, between: None };
    let leg = (usual / 2.0).max(map.grid.frame.resolution);
    Rack { depth: row.depth(), leg, row, pitch, frames, closed, is_double: false }
}

/// The rack that a frame is of which stands beside another one and has frames at its places, but for some that are lost
/// in what it leans on; `racks` and `frames` are in the order of their places across, and along.
fn leaning(map: &Map, racks: &[Rack], frames: &[Frame], frame: &Frame) -> Option<Rack> {
    let first = racks.partition_point(|rack| rack.row.across[0] < frame.faces[0] - AISLE);
    let near = || racks[first..].iter().take_while(|rack| rack.row.across[0] <= frame.faces[1] + AISLE);
    let is_at = |rack: &Rack| (rack.row.along[0] - NEAR..=rack.row.along[1] + NEAR).contains(&frame.at);
    let overlaps = |rack: &Rack| rack.row.across[0] < frame.faces[1] && frame.faces[0] < rack.row.across[1];
    if near().any(|rack| is_at(rack) && overlaps(rack)) {
        return None;
    }
    let is_like = |rack: &&Rack| is_at(rack) && (rack.row.depth() - frame.depth()).abs() <= NEAR;
    near().filter(is_like).find_map(|rack| {
        let place = |n: usize| rack.row.along[0] + n as f64 * rack.pitch;
        let at = |place: f64| {
            let first = frames.partition_point(|other| other.at < place - NEAR);
            let near = frames[first..].iter().take_while(|other| other.at <= place + NEAR);
            near.filter(|other| frame.is_in_line(other.faces)).count()
        };
        let (own, lost): (Vec<f64>, Vec<f64>) = (0..rack.frames).map(place).partition(|&place| at(place) > 0);
        let is_one = own.len() >= LEANING && lost.into_iter().all(|place| map.stands(place, frame.faces));
        let row = Row { across: frame.faces, ..rack.row.clone() };
        (is_one && map.shows_floor(&row)).then(|| Rack { row, ..rack.clone() })
    })
}

/// Racks, and in place of two back to back the one that they are.
fn back_to_back(mut racks: Vec<Rack>) -> Vec<Rack> {
    racks.sort_by(|a, b| a.row.across[0].total_cmp(&b.row.across[0]));
    let mut whole: Vec<Rack> = Vec::new();
    for rack in racks {
        let row = &rack.row;
        let is_back = |other: &&mut Rack| {
            let other = &other.row;
            row.across[0] - other.across[1] <= BACK
                && overlap(row.along, other.along) >= SHARED * row.length().min(other.length())
        };
        let near = whole.iter_mut().rev().take_while(|other| row.across[0] - other.row.across[0] <= AISLE);
        if let Some(whole) = near.into_iter().find(is_back) {
            whole.row.along = both(whole.row.along, row.along);
            whole.row.across[1] = whole.row.across[1].max(row.across[1]);
            whole.closed = [0, 1].map(|end| whole.closed[end] || rack.closed[end]);
            whole.is_double = true;
        } else {
            whole.push(rack);
        }
    }
    whole
}

/// True when what may be a rack has plates at both its ends, and is two back to back or has frames enough between them; or is
/// longer than any table.
fn is_no_table(rack: &Rack) -> bool {
    let is_closed = rack.closed == [true; 2] && (rack.is_double || rack.frames >= CLOSED);
    let is_no_desk = rack.is_double && rack.pitch > DESK.0 && rack.row.length() > DESK.1;
    is_closed || is_no_desk || rack.row.length() > TABLE
}

/// True when there are enough of a rack's kind: as deep and with bays as long, or both of two back to back; or with bays of one
/// length side by side and in step. Of what is no table one is enough.
fn is_kind(rack: &Rack, all: &[Rack]) -> bool {
    let alike = |other: &&Rack| {
        (other.depth - rack.depth).abs() <= NEAR
            && ((other.pitch - rack.pitch).abs() <= ALIKE * rack.pitch || rack.is_double && other.is_double)
    };
    let in_step = |other: &&Rack| {
        let bays = (other.row.along[0] - rack.row.along[0]) / rack.pitch;
        (other.pitch - rack.pitch).abs() <= STEPS * rack.pitch
            && (bays - bays.round()).abs() * rack.pitch <= NEAR
            && overlap(other.row.along, rack.row.along) > 0.0
    };
    is_no_table(rack)
        || all.iter().filter(alike).take(KIND).count() == KIND
        || all.iter().filter(in_step).take(SEVERAL).count() == SEVERAL
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Frame as MapFrame;
    use crate::labels::posts::map::tests::{EAST, on_map};
    use crate::labels::posts::uprights;
    use crate::pixels::Pixels;

    #[test]
    fn frames_at_one_place_are_one_and_the_rack_of_them_ends() {
        let frame = |at: f64| Frame { at, faces: [0.0, 1.1], is_plate: false };
        let (_, legs) = frames(&[], EAST);
        let places = [-0.125, 0.125, 2.0, 2.0, 3.875, 4.125, 6.0];
        let (rows, rack) = on_map(
            |_, _| false,
            EAST,
            |map| {
                let rows = at_one_pitch(places.map(frame).to_vec(), &legs, map);
                let rack = rack(0, &rows[0].1, rows[0].0, &legs, map);
                (rows.len(), rack)
            },
        );
        assert_eq!(rows, 1);
        assert_eq!((rack.frames, rack.pitch, rack.row.along), (4, 2.0, [0.0, 6.0]));
    }

    #[test]
    fn a_rack_of_few_frames_has_the_pitch_by_which_it_is_parted_from_the_next_one() {
        // Bays of 1.8 m, and of every second frame one leg alone was seen; the next rack in line begins 3.1 m farther on.
        let leg = |n: u32| Upright::point([1.8 * f64::from(n), 0.0]);
        let (_, legs) = frames(&[2, 4, 6].map(leg), EAST);
        let places = [0, 1, 3, 5, 7].map(|n| 1.8 * f64::from(n)).into_iter().chain([15.7, 17.5, 19.3, 21.1]);
        let row: Vec<Frame> = places.map(|at| Frame { at, faces: [0.0, 1.1], is_plate: false }).collect();
        let racks = on_map(
            |_, _| false,
            EAST,
            |map| {
                let rows = at_one_pitch(row.clone(), &legs, map);
                rows.iter().map(|(pitch, row)| rack(0, row, *pitch, &legs, map)).collect::<Vec<_>>()
            },
        );
        let found: Vec<(usize, f64)> = racks.iter().map(|rack| (rack.frames, rack.row.along[1])).collect();
        assert_eq!(found.iter().map(|(frames, _)| *frames).collect::<Vec<_>>(), [8, 4]);
        assert!((found[0].1 - 12.6).abs() < 1e-9 && (racks[0].pitch - 1.8).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn of_two_racks_in_line_each_has_its_own_pitch_though_they_are_nearly_alike() {
        let (_, legs) = frames(&[], EAST);
        let places = (0..7).map(|n| 2.7 * f64::from(n)).chain((0..16).map(|n| 19.7 + 2.8 * f64::from(n)));
        let row: Vec<Frame> = places.map(|at| Frame { at, faces: [0.0, 1.1], is_plate: false }).collect();
        let rows = on_map(|_, _| false, EAST, |map| at_one_pitch(row.clone(), &legs, map));
        let found: Vec<(usize, i64)> =
            rows.iter().map(|(pitch, row)| (row.len(), (pitch * 100.0).round() as i64)).collect();
        assert_eq!(found, [(7, 270), (16, 280)]);
    }

    #[test]
    fn two_racks_back_to_back_are_of_a_kind_with_one_as_deep() {
        let rack = |low: f64, depth: f64, pitch: f64| {
            let row = Row { direction: 0, along: [0.0, 4.0 * pitch], across: [low, low + depth], between: None };
            Rack { row, pitch, frames: 5, depth, leg: 0.1, closed: [false; 2], is_double: false }
        };
        let are_kinds = |others: &[Rack]| {
            let all = back_to_back([&[rack(0.0, 0.9, 0.95), rack(1.1, 0.9, 0.95)], others].concat());
            all.iter().map(|rack| is_kind(rack, &all)).collect::<Vec<_>>()
        };
        assert_eq!(are_kinds(&[]), [false]);
        assert_eq!(are_kinds(&[rack(5.0, 0.9, 0.95)]), [true, true]);
        assert_eq!(are_kinds(&[rack(5.0, 2.0, 0.95)]), [false, false]);
        assert_eq!(are_kinds(&[rack(5.0, 0.9, 1.1)]), [false, false]);
    }

    #[test]
    fn a_rack_goes_on_to_a_leg_by_itself_but_not_past_a_wall() {
        let leg = |u: f64| Upright::point([u, 3.0]);
        let row = [4.0, 6.0, 8.0].map(|at| Frame { at, faces: [3.0, 4.1], is_plate: false });
        let (_, legs) = frames(&[leg(2.0), leg(10.0)], EAST);
        let along = |wall: usize| on_map(|x, _| x == wall, EAST, |map| rack(0, &row, 2.0, &legs, map)).row.along;
        assert_eq!([along(230), along(180), along(60)], [[2.0, 10.0], [2.0, 8.0], [4.0, 10.0]]);
    }

    #[test]
    fn a_speck_at_a_racks_end_is_no_leg() {
        // Legs of three pixels along two faces, 2 m apart, and one thing by itself a bay farther on.
        let leg = |x: u32, y: u32, side: u32| (0..side).flat_map(move |n| (0..side).map(move |m| [x + m, y + n]));
        let along = |side: u32| {
            let mut pixels: Vec<[u32; 2]> =
                [80, 120, 160].into_iter().flat_map(|x| leg(x, 60, 3).chain(leg(x, 82, 3))).collect();
            pixels.extend(leg(200, 60, side));
            pixels.sort_unstable_by_key(|&[x, y]| [y, x]);
            let frame = MapFrame::new(240, 120, 0.05, [0.0; 3]);
            let (frames, legs) = frames(&uprights::find(&frame, &Pixels::from_iter(pixels)), EAST);
            on_map(|_, _| false, EAST, |map| rack(0, &frames, 2.0, &legs, map)).row.length()
        };
        assert!((along(1) - 4.0).abs() < 0.01 && (along(3) - 6.0).abs() < 0.01, "{} {}", along(1), along(3));
    }
}
