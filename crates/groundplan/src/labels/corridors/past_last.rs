//! Ways past the ends of a place's last row: they lead on beyond the aisle along it, into what is open behind that row, or
//! was not seen, and is no corridor.

use super::barriers;
use super::frontiers::ROW;
use super::sided;
use crate::ends::{around, holds, overlap, shared, sorted, wider};
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::{ASKEW, Strip};
use crate::labels::junctions;
use crate::labels::junctions::meeting::{Meeting, of_each};
use crate::labels::junctions::shut::{ARM, sign};
use crate::labels::rows::{DEPTH, Row, SAME};
use crate::labels::view::runs::runs;
use crate::labels::view::turned::Turned;

/// Behind the row it is open where floor goes on for so long, metres, but for this share, and so far beside the strip as well,
/// but for the other.
const OPEN: f64 = 4.0;
const CLUTTER: f64 = 0.05;
const BESIDE: f64 = 1.0;
const TAKEN: f64 = 0.3;
/// It may be open where so much of that was not seen.
const UNSEEN: f64 = 0.3;
/// A row has an end, or a gap so wide between goods; its back lies so near to where it is seen to end, metres.
const GAP: f64 = 1.0;
const BACK: f64 = 0.2;
/// No corridor runs behind it so far beyond where the deepest row ends, metres.
const BEHIND: f64 = 2.0;

/// The strips, each with what it leads on between the ends of racks, or of one and a wall, that stand along the last aisle that
/// it meets, where some are known beside that; nothing where none does.
pub fn led_on(
    views: &[Turned],
    strips: &[Strip],
    meetings: &[Meeting],
    [rows, racks]: [&[Row]; 2],
) -> Option<Vec<Strip>> {
    if racks.is_empty() {
        return None;
    }
    let standing: Vec<&Row> = rows.iter().chain(racks).collect();
    let stands = placed(views, standing.iter().map(|row| row.place()));
    let is_aisle = |strip: &Strip| {
        let across = wider(strip.across, SAME);
        let near = stands[strip.direction].touching(strip.along, across).into_iter().map(|n| standing[n]);
        let mut beside = near.filter(|row| overlap(row.along, strip.along) > 0.0 && overlap(row.across, across) > 0.0);
        beside.next().is_some()
    };
    let met = of_each(meetings, strips.len());
    let ways = placed(views, strips.iter().map(Strip::place));
    let mut longer = strips.to_vec();
    for (n, strip) in strips.iter().enumerate() {
        let view = &views[strip.direction];
        for side in [0, 1] {
            let sign = sign(side);
            let here = || met[n].iter().map(|&m| &meetings[m]);
            if !junctions::is_met(view, strip, n, side, here()) {
                continue;
            }
            let far = here().flat_map(|meeting| far_sides(views, strips, meeting, n, side));
            let farthest = far.max_by(|(_, a), (_, b)| (a * sign).total_cmp(&(b * sign)));
            // Where the row begins, and where it ends.
            let Some((aisle, from)) = farthest.filter(|(m, _)| is_aisle(&strips[*m])) else { continue };
            let Some(end) = row_end(view, strip, side, from) else { continue };
            let [behind, beyond, past] = [end + sign * SAME, end + sign * OPEN, from + sign * (DEPTH.1 + BEHIND)];
            let is_before_floor = || {
                let reached = reached_by(views, strip, &strips[aisle]);
                is_open(view, strip, sorted([from - sign * SAME, beyond]))
                    && is_row(view, strip, reached, [from, end], [behind, beyond])
            };
            let is_before_unseen = || {
                is_open(view, strip, sorted([from - sign * SAME, behind]))
                    && is_unseen(view, strip, sorted([behind, beyond]))
            };
            // Nothing is known beyond the map.
            let leads_on = holds([view.along(0), view.along(view.size[0])], beyond)
                && (is_before_floor() || is_before_unseen())
                && !is_crossed(views, strip, sorted([from + sign * SAME, past]), strips, &ways);
            if leads_on {
                // A junction's arm is no shorter.
                let reached = [strip.along[side], from + sign * (ARM.0 + view.cell), end];
                longer[n].along[side] = around(reached.into_iter())[side];
            }
        }
    }
    (longer != strips).then_some(longer)
}

/// The corridors that a strip meets at a junction, and where each has its farther side, along the strip.
fn far_sides(views: &[Turned], strips: &[Strip], meeting: &Meeting, n: usize, side: usize) -> Vec<(usize, f64)> {
    let view = &views[strips[n].direction];
    let sine = |m: usize| view.sine(&views[strips[m].direction]);
    let others = meeting.corridors.iter().filter(|&&m| sine(m) > ASKEW);
    let at = view.place(meeting.at)[0];
    others.map(|&m| (m, at + sign(side) * strips[m].width() / 2.0 / sine(m))).collect()
}

/// How far along a strip what stands at both its sides from a place on does so, where that is as deep as rows are.
fn row_end(view: &Turned, strip: &Strip, side: usize, from: f64) -> Option<f64> {
    let sign = sign(side);
    let columns = view.columns(sorted([from - sign * SAME, from + sign * DEPTH.1]));
    let ends = sided::sides(strip).map(|[low, high]| {
        let stands = view.some_occupied(columns.clone(), low, high);
        let mut places = columns.clone().zip(stands).filter(|(_, share)| *share > 0.0).map(|(column, _)| column);
        let first = places.next()?;
        let last = places.next_back()?;
        let [near, far] = if side == 0 { [last, first] } else { [first, last] };
        let [near, far] = [near, far].map(|column| sign * (view.along(column) + view.cell / 2.0 - from));
        (near.abs() <= SAME + view.cell && far - near >= DEPTH.0).then_some(far)
    });
    let [Some(one), Some(two)] = ends else { return None };
    Some(from + sign * one.min(two))
}

/// True when nothing bars a strip between two places.
fn is_open(view: &Turned, strip: &Strip, along: [f64; 2]) -> bool {
    let columns = view.columns(along);
    let [low, high] = inner(strip);
    view.mean_blocked(columns.clone(), low, high) <= CLUTTER
        && !barriers::among(view, strip.across, columns.clone()).any()
        && barriers::stops(view, strip.across, columns).is_empty()
}

/// What of a strip certainly lies between what stands at its sides.
fn inner(strip: &Strip) -> [f64; 2] {
    wider(strip.across, -SAME.min(strip.width() / 4.0))
}

/// True when much of a strip between two places was not seen, and nothing of what was stands there.
fn is_unseen(view: &Turned, strip: &Strip, along: [f64; 2]) -> bool {
    let columns = view.columns(along);
    let [low, high] = inner(strip);
    let taken = view.some_occupied(columns.clone(), low, high);
    view.mean_blocked(columns, low, high) >= UNSEEN && taken.iter().sum::<f64>() <= CLUTTER * taken.len() as f64
}

/// From where to where across a strip an aisle leads that it meets, with what lies about its ends.
fn reached_by(views: &[Turned], strip: &Strip, aisle: &Strip) -> [f64; 2] {
    let ends = aisle.along.map(|u| views[aisle.direction].to_map([u, aisle.middle()]));
    wider(sorted(ends.map(|end| views[strip.direction].place(end)[1])), aisle.width())
}

/// True when what stands along an aisle at a strip's sides from one place to another is a row before floor, and no wall with a gate in
/// it: floor shows behind one of the sides, and where it does behind both, the row has an end or a gap. Where it does behind neither the
/// row is as deep as no wall, and behind one of them nothing stands: that was not seen.
fn is_row(view: &Turned, strip: &Strip, aisle: [f64; 2], [from, end]: [f64; 2], [behind, beyond]: [f64; 2]) -> bool {
    let [low, high] = strip.across;
    let columns = view.columns(sorted([behind, beyond]));
    let is_floor = |[low, high]: [f64; 2]| view.mean_blocked(columns.clone(), low, high) <= TAKEN;
    let is_empty = |[low, high]: [f64; 2]| view.share_touched(columns.clone(), low, high) <= CLUTTER;
    let beside = [[low - BESIDE, low], [high, high + BESIDE]];
    match beside.map(is_floor) {
        [false, false] => (end - from).abs() >= ROW && beside.into_iter().any(is_empty),
        [true, true] => {
            let back = view.columns(wider([end; 2], BACK));
            let [first, last] = shared(aisle, view.reach_across());
            let is_free = |n: usize| {
                let row = first + n as f64 * view.cell;
                // Of the strip itself it is known.
                (row + view.cell < low || row > high)
                    && view.mean_blocked(back.clone(), row, row + view.cell) <= CLUTTER
            };
            let free: Vec<bool> = (0..((last - first) / view.cell) as usize).map(is_free).collect();
            runs(&free, true).iter().any(|(from, to)| (to - from) as f64 * view.cell >= GAP)
        }
        _ => true,
    }
}

/// True when another strip runs across a strip's middle between two places along it.
fn is_crossed(views: &[Turned], strip: &Strip, along: [f64; 2], strips: &[Strip], placed: &[Beside]) -> bool {
    let own = &views[strip.direction];
    let ends = along.map(|u| own.to_map([u, strip.middle()]));
    views.iter().filter(|its| own.sine(its) > ASKEW).any(|its| {
        let [u, v] = [0, 1].map(|axis| around(ends.iter().map(|&end| its.place(end)[axis])));
        let near = placed[its.direction].touching(u, v);
        near.into_iter().map(|n| &strips[n]).any(|other| overlap(other.along, u) >= 0.0 && holds(v, other.middle()))
    })
}
