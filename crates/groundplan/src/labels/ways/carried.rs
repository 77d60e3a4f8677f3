//! Ways across rows lead on through the next row where that is free: empty bays end racks as nothing does, but what leads
//! through the rows beside shows that a way lies there.

use super::across::crossing;
use super::lead::Lead;
use super::passing::Place;
use crate::ends::{both, overlap, wider};
use crate::grid::State;
use crate::labels::Evidence;
use crate::labels::beside::{Beside, placed};
use crate::labels::corridors::Strip;
use crate::labels::rows::sections::Columns;
use crate::labels::rows::{Row, SHORTEST};
use crate::labels::view::look::Look;
use crate::labels::view::turned::Turned;

/// What leads through so many rows is a way.
const ROWS: usize = 2;
/// What stands so near to its sides is beside it, metres; what lies between is looked at in such steps, metres.
const SIDE: f64 = 0.35;
const STEP: f64 = 0.1;

/// The strips, those across rows as far as these are free.
pub fn on(evidence: &Evidence, look: &Look, views: &[Turned], mut strips: Vec<Strip>) -> Vec<Strip> {
    loop {
        let longer = a_row_on(evidence, look, views, &strips);
        if longer == strips {
            return strips;
        }
        strips = longer;
    }
}

/// The strips, those across rows through the next one on either side.
fn a_row_on(evidence: &Evidence, look: &Look, views: &[Turned], strips: &[Strip]) -> Vec<Strip> {
    let mut longer = strips.to_vec();
    each(views, strips, |next| {
        if next.lead.is_free(evidence, look) && !next.is_backed() {
            longer[next.strip].along = next.led_on(longer[next.strip].along);
        }
    });
    longer
}

/// Racks on legs, without what of their ground ways across rows would lead over as far as floor shows there: legs at a whole
/// number of bays from one another stand on both sides of such a way too.
pub fn without_ways(evidence: &Evidence, views: &[Turned], strips: &[Strip], on_legs: &[Row]) -> Vec<Row> {
    let (mut racks, mut strips) = (on_legs.to_vec(), strips.to_vec());
    while !racks.is_empty() {
        let mut longer = strips.clone();
        each(views, &strips, |next| {
            if next.lead.is_within() && next.lead.shows_floor(evidence) {
                longer[next.strip].along = next.led_on(longer[next.strip].along);
                racks = racks.iter().flat_map(|rack| next.lead.left_of(rack)).collect();
            }
        });
        if longer == strips {
            break;
        }
        strips = longer;
    }
    racks
}

/// Racks on legs, without what of their ground some ways lead over.
pub fn left_beside(views: &[Turned], strips: &[Strip], on_legs: &[Row]) -> Vec<Row> {
    let mut racks = on_legs.to_vec();
    for strip in strips {
        let left = |rack: &Row| {
            let lead = Lead { views: [rack.direction, strip.direction].map(|n| &views[n]), row: rack, strip };
            let is_across = crossing(views, rack.direction).is_some_and(|view| view.direction == strip.direction);
            let is_there = is_across && overlap(lead.along(rack.across), strip.along) > 0.0;
            if is_there { lead.left_of(rack) } else { vec![rack.clone()] }
        };
        racks = racks.iter().flat_map(left).collect();
    }
    racks
}

/// A strip that leads through rows and ends before another one, through which none leads there.
struct Next<'a> {
    strip: usize,
    place: &'a Place<'a>,
    row: usize,
    lead: Lead<'a>,
    /// Of the aisles beside the row.
    middles: [f64; 2],
}

impl Next<'_> {
    /// From where to where it leads along, when it leads through the row too.
    fn led_on(&self, along: [f64; 2]) -> [f64; 2] {
        both(along, self.lead.along(self.middles))
    }

    /// True when backs of racks close the row there.
    fn is_backed(&self) -> bool {
        self.place.shelves(self.row).is_backed(self.lead.views[0], self.lead.sides())
    }
}

/// Tells of each such strip and row.
fn each(views: &[Turned], strips: &[Strip], mut tell: impl FnMut(Next)) {
    let placed = placed(views, strips.iter().map(Strip::place));
    for place in &Place::of_each(views, strips) {
        for (n, own) in place.passing.iter().enumerate().filter(|(_, own)| own.rows.len() >= ROWS) {
            for &number in &own.next {
                let (row, between) = &place.rows[number];
                let lead = Lead { views: place.views, row, strip: &strips[n] };
                if lead.is_alone(n, strips, &placed) {
                    let middles = between.map(|aisle| strips[place.aisles[aisle]].middle());
                    tell(Next { strip: n, place, row: number, lead, middles });
                }
            }
        }
    }
}

impl Lead<'_> {
    /// What of a rack it does not lead over.
    fn left_of(&self, rack: &Row) -> Vec<Row> {
        let sides = self.sides();
        let is_there = overlap(rack.across, self.row.across) > 0.0 && overlap(rack.along, sides) > 0.0;
        if rack.direction != self.row.direction || !is_there {
            return vec![rack.clone()];
        }
        let [from, to] = rack.along;
        let left = [[from, to.min(sides[0])], [from.max(sides[1]), to]].map(|along| Row { along, ..rack.clone() });
        left.into_iter().filter(|rack| rack.length() >= SHORTEST).collect()
    }

    /// True when no other strip leads through the row there; of all it is known where they lie.
    fn is_alone(&self, own: usize, strips: &[Strip], placed: &[Beside]) -> bool {
        let along = self.along(self.row.across);
        let others = placed[self.strip.direction].touching(along, self.strip.across);
        let is_there =
            |strip: &Strip| overlap(strip.along, along) > 0.0 && overlap(strip.across, self.strip.across) > 0.0;
        !others.into_iter().any(|n| n != own && is_there(&strips[n]))
    }

    /// True when it would lie between the row's ends, and nothing stands there, or goods between the ends of racks.
    fn is_free(&self, evidence: &Evidence, look: &Look) -> bool {
        let columns =
            || Columns::new(look, &evidence.grid.frame, self.views, self.row, self.views[0].pitch_of(self.row));
        let is_free = |columns: Columns| columns.is_free(self.sides()) || columns.is_free_beside_goods(self.sides());
        self.is_within() && is_free(columns())
    }

    /// True when the map shows floor where it would lead through the row, and no leg.
    fn shows_floor(&self, evidence: &Evidence) -> bool {
        let (across, along) = (wider(self.strip.across, -SIDE), self.along(self.row.across));
        let state = |s: f64, t: f64| evidence.grid.state_at(self.views[1].to_map([s, t]));
        let mut places = steps(along).flat_map(|s| steps(across).map(move |t| (s, t)));
        places.all(|(s, t)| state(s, t) == State::Free)
    }
}

/// Places from one to another.
fn steps([from, to]: [f64; 2]) -> impl Iterator<Item = f64> + Clone {
    let count = ((to - from) / STEP).ceil().max(1.0) as usize;
    (0..=count).map(move |n| from + (to - from) * n as f64 / count as f64)
}
