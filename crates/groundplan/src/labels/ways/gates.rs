//! Ways through rows of racks: gates, which are too short to be known by walls of their own.

use super::across::crossing;
use super::backed;
use super::bars;
use super::empties;
use super::hollow;
use super::narrowed;
use super::passing::{self, Place};
use super::step::{self, Section};
use super::thin;
use super::through::{BETWEEN_CELLS, Through};
use super::unposted;
use super::walled;
use super::widths::Widths;
use crate::bands::flat_map_each;
use crate::ends::{both, holds, overlap, wider};
use crate::labels::Evidence;
use crate::labels::beside::placed;
use crate::labels::corridors::{self, Strip};
use crate::labels::rows::Row;
use crate::labels::rows::sections::{self, Columns};
use crate::labels::rows::seen::Seen;
use crate::labels::view::look::Look;
use crate::labels::view::turned::Turned;
use std::borrow::Cow;
use std::cell::LazyCell;
use std::collections::BTreeMap;
use std::iter;

/// Gates whose middles are this near across are in line, and one when they end this near to each other, metres.
pub const IN_LINE: (f64, f64) = (0.7, 0.5);
/// Rows that hold goods are open over less than this share of their length.
const OPEN: f64 = 0.5;

/// Ways through rows, as strips of the direction that crosses them.
pub struct Gates<'a> {
    /// Those that were known, each as wide as the uprights of the rows that it leads through leave.
    pub known: Cow<'a, [Strip]>,
    pub ways: Vec<Strip>,
    /// Others that are told from bays, as wide as they may be.
    pub as_bays: Vec<Strip>,
}

/// The ways through the rows between corridors.
pub fn find<'a>(evidence: &Evidence, look: &Look, views: &[Turned], strips: &'a [Strip], rows: &[Row]) -> Gates<'a> {
    let (mut gates, mut doubtful) = (Vec::new(), Vec::new());
    let placed = placed(views, strips.iter().map(Strip::place));
    let widest = corridors::widest(strips);
    let reaching: Vec<Row> = rows.iter().map(|row| walled::up_to_walls(views, strips, &placed, widest, row)).collect();
    let least = evidence.parameters.labels_min_width;
    // A way that is known cuts the row that it leads through.
    let are_racked = |row: &&Row| views[row.direction].pitch_of(row).is_some();
    let (racked, others) = rows.iter().filter(|row| row.between.is_some()).partition(are_racked);
    let [racked, others]: [Option<Vec<Row>>; 2] = [uncut(racked), uncut(others)];
    let seen_whole = |rows| seen(evidence, look, views, strips, rows, rows);
    let [whole, whole_others] = [&racked, &others].map(|rows| rows.as_deref().map(seen_whole));
    let mut all_known = Cow::Borrowed(strips);
    for rows in [&whole, &whole_others].into_iter().flatten() {
        all_known = Cow::Owned(narrowed::whole(&all_known, rows, &placed, widest));
    }
    if let Some(rows) = &whole {
        all_known = Cow::Owned(narrowed::between_uprights(&all_known, rows, &placed, [least, widest]));
    }
    let strips = &*all_known;
    let mut through = Through::new(views, strips, seen(evidence, look, views, strips, rows, &reaching));
    // What leads past rows at a wall, or through a row that is a wall itself from one wall to another, though it is as wide as
    // bays; it tells nothing of how wide other ways are.
    let mut at_walls = Vec::new();
    for (n, row) in through.rows().iter().enumerate() {
        let is_wall = through.is_wall(n) && [0, 1].into_iter().all(|side| row.is_at_wall(strips, side));
        for &way in &row.ways {
            let found = match (row.columns.is_as_bays(way), is_wall) {
                (true, true) => &mut at_walls,
                (true, false) => &mut doubtful,
                (false, _) => &mut gates,
            };
            found.extend(row.gate(way));
        }
    }
    let mut as_bays: Vec<Strip> = views.iter().flat_map(|view| between_posts(view, through.rows())).collect();
    // What leads through each row is counted in whole rows.
    let whole = whole.map(|rows| Through::new(views, strips, rows));
    let in_each_row = whole.as_ref().unwrap_or(&through).in_each_row();
    // What the faces of rows show: posts that are missing, and gaps in what is solid. A row that a known way cuts is solid in each
    // of its pieces.
    let mut by_faces = unposted::find(whole.as_ref().unwrap_or(&through).rows(), strips.len());
    let is_in_way = |gate: &Strip| strips.iter().any(|way| is_in(gate, way));
    by_faces.retain(|gate| !is_in_way(gate));
    by_faces.extend(backed::find(whole.as_ref().unwrap_or(&through).rows(), strips.len(), is_in_way));
    let mut hollow = hollow::find(through.rows());
    for (gate, is_as_a_bay) in through.at_walls(strips, &placed) {
        let found = if is_as_a_bay { &mut at_walls } else { &mut gates };
        found.push(gate);
    }
    let between_racks = through.between_racks();
    let mut known = in_line(gates.clone());
    let first = known.len();
    known.extend(strips.iter().filter(|strip| !strip.bays).cloned());
    let places = LazyCell::new(|| Place::of_each(views, &known));
    let staggered = LazyCell::new(|| Widths::of_staggered(views, &known, &places));
    // What passes the ends is as wide as the hall leaves: if that is a bay's width it tells no others, nor that any is a way.
    // Without posts nothing is as wide as bays, and the places need not be laid out.
    let is_racked = views.iter().any(|view| view.pitch.is_some());
    let tells = |n: &usize| !is_racked || !passing::is_past_ends_as_bays(&known, &places, *n);
    let telling = (first..known.len()).filter(tells).map(|n| &known[n]);
    let mut sure = Widths::of(views, telling.chain(&gates));
    // Where a direction has no ways at all nothing speaks against one.
    let is_any_known = |direction: usize| known.iter().any(|way| way.direction == direction);
    let within = LazyCell::new(|| passing::are_within(views, &places));
    let several = through.find(&mut sure, |direction| within[direction]);
    let mut turns: Vec<Strip> = Vec::new();
    for way in iter::once(&through).chain(&whole).flat_map(Through::turns) {
        if !turns.iter().any(|known| is_in(&way, known)) {
            turns.push(way);
        }
    }
    // Frames of racks close an empty bay as a cross aisle's guards do: then those of the place tell them apart.
    let all = LazyCell::new(|| [&known[..], &doubtful].concat());
    let all_places = LazyCell::new(|| Place::of_each(views, &all));
    let open = LazyCell::new(|| passing::open_through(&all_places, &all, known.len()));
    let between_bars = LazyCell::new(|| bars::are_between(evidence, look, &all_places, &all, known.len()));
    let is_told = |n: usize, gate: &Strip| {
        let widths = &sure[gate.direction];
        let pitch = crossing(views, gate.direction).and_then(|view| view.pitch);
        !is_any_known(gate.direction) || widths.have(gate.width() + BETWEEN_CELLS, pitch) || open[n] || between_bars[n]
    };
    gates.extend(doubtful.iter().enumerate().filter(|(n, gate)| is_told(*n, gate)).map(|(_, gate)| gate.clone()));
    // Where no row beside tells a bay from a way, a way is as wide as others of the place; and where ways are staggered from
    // row to row, as those.
    let is_as_wide = |gate: &Strip, pitch, is_alone| {
        let widths = if is_alone { &sure } else { &*staggered };
        widths[gate.direction].have(gate.width() + BETWEEN_CELLS, pitch)
    };
    let as_wide = between_racks.into_iter().filter(|(gate, pitch, is_alone)| is_as_wide(gate, *pitch, *is_alone));
    gates.extend(as_wide.map(|(gate, ..)| gate));
    gates.retain(|gate| !several.iter().chain(&turns).any(|way| is_in(gate, way)));
    gates.extend(several);
    gates.extend(at_walls.into_iter().chain(thin::gates(views, strips)));
    let mut ways = in_line(gates);
    // What leads through other rows as well is known better than by the faces of one.
    let is_part = |gate: &Strip| ways.iter().any(|way| is_in(gate, way) && way.length() > gate.length() + IN_LINE.1);
    hollow.retain(|gate| !is_part(gate) && !strips.iter().chain(&by_faces).any(|way| is_in(gate, way)));
    by_faces.extend(hollow);
    ways.retain(|way| !by_faces.iter().any(|gate| is_in(gate, way)));
    as_bays.extend(turns);
    as_bays.extend(as_wide_as_others(views, strips, &ways, in_each_row));
    as_bays.retain(|gate| !ways.iter().chain(&by_faces).any(|way| is_in(gate, way)));
    as_bays.extend(by_faces);
    Gates { known: all_known, ways, as_bays: in_line(as_bays) }
}

/// Rows as if no way that is known cut them, none of them up to the walls beyond its ends; nothing where none is cut.
fn uncut(rows: Vec<&Row>) -> Option<Vec<Row>> {
    let mut whole: BTreeMap<_, Row> = BTreeMap::new();
    let mut is_cut = false;
    for row in rows {
        let known = whole.entry((row.direction, row.between)).or_insert_with(|| row.clone());
        is_cut |= known != row;
        (known.along, known.across) = (both(known.along, row.along), both(known.across, row.across));
    }
    is_cut.then(|| whole.into_values().collect())
}

/// Those of some ways, one like another in each row, that are as wide as what leads through all rows of their place between
/// their ends: where anything does, and bays are empty, others may be of these.
fn as_wide_as_others(views: &[Turned], strips: &[Strip], ways: &[Strip], some: Vec<Strip>) -> Vec<Strip> {
    if some.is_empty() {
        return some;
    }
    let known = strips.iter().filter(|strip| !strip.bays).chain(ways);
    let all: Vec<Strip> = some.iter().chain(known).cloned().collect();
    let places = Place::of_each(views, &all);
    let stays = |&n: &usize| {
        let width = all[n].width();
        let in_place = |place: &Place| {
            let Some(first) = place.first_of(&place.passing[n]) else { return true };
            let rows = place.rows_with(first);
            let whole = Widths::of_whole(place, &all, &rows);
            whole.is_empty()
                || whole.have(width + BETWEEN_CELLS, None)
                || !empties::have_empty_bays(place, &all, &rows, width)
        };
        places.iter().all(in_place)
    };
    (0..some.len()).filter(stays).map(|n| all[n].clone()).collect()
}

/// The rows with what is asked of them.
fn seen<'a>(
    evidence: &'a Evidence,
    look: &'a Look,
    views: &'a [Turned],
    strips: &[Strip],
    rows: &'a [Row],
    reaching: &'a [Row],
) -> Vec<Seen<'a>> {
    flat_map_each(rows.len(), evidence.threads, |n| {
        let (row, reaching) = (&rows[n], &reaching[n]);
        let (between, other) = (row.between?, crossing(views, row.direction)?);
        let view = &views[row.direction];
        let middles = between.map(|n| strips[n].middle());
        let widest = between.map(|n| strips[n].width()).into_iter().fold(0.0, f64::max);
        let columns = Columns::new(look, &evidence.grid.frame, [view, other], reaching, view.pitch_of(row));
        let ways = columns.ways(sections::least_width(iter::once(widest)));
        Some(Seen { own: row.along, row: reaching, columns, ways, views: [view, other], between, middles, widest })
    })
}

/// What leads through several rows, by where all of them are free, between the ends of some that mostly are not.
pub fn through_several(
    evidence: &Evidence,
    look: &Look,
    views: &[Turned],
    strips: &[Strip],
    rows: &[Row],
) -> Vec<Strip> {
    let seen = seen(evidence, look, views, strips, rows, rows);
    let open = |row: &Seen| row.columns.open().iter().map(|[from, to]| to - from).sum::<f64>();
    let taken: Vec<&Row> = seen.iter().filter(|row| open(row) < OPEN * row.row.length()).map(|row| row.row).collect();
    let mut sure = Widths::of(views, strips.iter().filter(|strip| !strip.bays));
    let mut ways = in_line(Through::new(views, strips, seen).find(&mut sure, |_| false));
    let leads_through = |way: &Strip, row: &Row| {
        let middle = f64::midpoint(row.across[0], row.across[1]);
        let [s, u] = views[row.direction].crossing(&views[way.direction], middle, way.middle());
        holds(way.along, s) && holds(wider(row.along, -way.width()), u)
    };
    ways.retain(|way| taken.iter().any(|row| row.direction != way.direction && leads_through(way, row)));
    ways
}

/// The ways through a direction's rows that are out of step with their bays.
fn between_posts(view: &Turned, seen: &[Seen]) -> Vec<Strip> {
    let Some(pitch) = view.pitch else { return Vec::new() };
    let rows = seen.iter().filter(|row| row.row.direction == view.direction);
    let sections = rows.flat_map(|row| row.columns.beside_racks().into_iter().map(move |section| (row, section)));
    let (rows, sections): (Vec<&Seen>, Vec<Section>) = sections.unzip();
    let are_out = step::are_out(&sections, pitch);
    let out = rows.into_iter().zip(sections).zip(are_out).filter(|(_, is_out)| *is_out);
    out.filter_map(|((row, section), _)| row.gate(section.ends)).collect()
}

/// True when one strip lies in another of its direction.
fn is_in(one: &Strip, two: &Strip) -> bool {
    one.direction == two.direction && overlap(one.along, two.along) > 0.0 && overlap(one.across, two.across) > 0.0
}

/// Gates that follow one another through neighbouring rows are one way.
fn in_line(mut gates: Vec<Strip>) -> Vec<Strip> {
    gates.sort_by(|a, b| a.direction.cmp(&b.direction).then(a.along[0].total_cmp(&b.along[0])));
    let mut joined: Vec<Strip> = Vec::new();
    for gate in gates {
        let before = joined.iter_mut().find(|other| {
            other.direction == gate.direction
                && (other.middle() - gate.middle()).abs() < IN_LINE.0
                && gate.along[0] - other.along[1] < IN_LINE.1
        });
        if let Some(other) = before {
            other.along[1] = other.along[1].max(gate.along[1]);
            other.across = [0, 1].map(|n| f64::midpoint(other.across[n], gate.across[n]));
            other.score += gate.score;
        } else {
            joined.push(gate);
        }
    }
    joined
}
