//! II-E before the map is divided into faces: corridors first, junctions where they meet, rows between them, and all
//! that may be a door.

use super::beside::placed;
use super::corridors::askew;
use super::corridors::bends;
use super::corridors::connected;
use super::corridors::cornered;
use super::corridors::frontiers;
use super::corridors::heads;
use super::corridors::joined;
use super::corridors::led;
use super::corridors::led_into;
use super::corridors::past_goods;
use super::corridors::past_last;
use super::corridors::pillared;
use super::corridors::ragged::{self, Ways};
use super::corridors::widening;
use super::corridors::{self, Strip};
use super::junctions;
use super::junctions::meeting::Meeting;
use super::junctions::shut;
use super::posts::legs;
use super::posts::rack::Rack;
use super::posts::uprights::{self, Upright};
use super::rooms::{Bar, Space};
use super::rows::blocks::Standing;
use super::rows::faced;
use super::rows::racks;
use super::rows::whole;
use super::rows::{self, Row};
use super::view::look::Look;
use super::view::panes;
use super::view::quarter;
use super::view::turned::Turned;
use super::ways;
use super::ways::carried;
use super::ways::crossed;
use super::ways::gates::{self, Gates};
use super::ways::narrowed;
use super::ways::slots;
use super::{Evidence, Ground, Scene};
use crate::bands::{Later, Side, each, map_each};
use crate::ends::{both, shared, wider};

/// What the map shows without its faces.
pub struct Sketch {
    pub views: Vec<Turned>,
    pub plan: Plan,
    pub free: Free,
}

/// The map seen along each direction, before there are lines.
pub struct Glance<'a> {
    look: Look<'a>,
    views: Vec<Turned>,
    on_legs: Vec<Row>,
}

impl<'a> Glance<'a> {
    pub fn new(scene: &Scene<'a>, look: Look<'a>, uprights: &[Upright], racks: &[Rack]) -> Self {
        let on_legs: Vec<Row> = racks.iter().map(|rack| rack.row.clone()).collect();
        let count = scene.directions.angles.len();
        let mut views: Vec<_> = (0..count).map(|direction| Turned::new(scene, direction, &on_legs)).collect();
        for view in &mut views {
            view.take_frames(uprights);
            view.take_pitches(racks);
        }
        quarter::see(&mut views, scene, &look);
        Self { look, views, on_legs }
    }
}

/// What is seen before anything is made of it.
pub struct Sight<'a, F> {
    look: Look<'a>,
    views: Vec<Turned>,
    on_legs: Vec<Row>,
    free: F,
}

/// The free space, if there is some, and all that may be a door in it.
type Free = Option<(Space, Vec<Bar>)>;

impl<'s, 'a> Sight<'a, Later<'s, Free>> {
    /// From the lines, and what was begun before there were any.
    pub fn new(
        side: Side<'s, '_>,
        evidence: &'s Evidence,
        space: Later<'s, Option<Space>>,
        glance: Later<Glance<'a>>,
    ) -> Self {
        let free = side.start(move || space.get().map(|space| with_bars(evidence, space)));
        let Glance { look, mut views, on_legs } = glance.get();
        each(views.iter_mut().collect(), evidence.threads, |view: &mut Turned| {
            view.line(evidence);
            view.glaze();
            view.recur(&evidence.shared_out());
        });
        panes::share(&mut views);
        Self { look, views, on_legs, free }
    }
}

/// What is seen of a map of many pixels that needs gradients, one after another; nothing between the lines yet.
pub struct Lined<'a> {
    sight: Sight<'a, Free>,
    uprights: Vec<Upright>,
}

impl<'a> Lined<'a> {
    /// From the lines.
    pub fn new(evidence: &Evidence, Ground { look, space }: Ground<'_, 'a>) -> Self {
        let free = space.get().map(|space| with_bars(evidence, space));
        let scene = evidence.scene();
        let uprights = uprights::find(&evidence.grid.frame, &evidence.gradients.pixels);
        let racks = legs::find(&scene, &uprights);
        let on_legs: Vec<Row> = racks.iter().map(|rack| rack.row.clone()).collect();
        let views = map_each(evidence.directions.angles.len(), evidence.threads, |direction| {
            let mut view = Turned::new(&scene, direction, &on_legs);
            view.take_pitches(&racks);
            view.line(evidence);
            view
        });
        Self { sight: Sight { look: look.get(), views, on_legs, free }, uprights }
    }

    /// And all else.
    pub fn seen(self, evidence: &Evidence) -> Sight<'a, Free> {
        let Self { mut sight, uprights } = self;
        each(sight.views.iter_mut().collect(), evidence.threads, |view: &mut Turned| view.take_frames(&uprights));
        drop(uprights);
        see(evidence, &sight.look, &mut sight.views);
        sight
    }
}

/// A space and what may be a door in it.
fn with_bars(evidence: &Evidence, space: Space) -> (Space, Vec<Bar>) {
    let bars = space.bars(evidence);
    (space, bars)
}

impl Sketch {
    /// Beside what is still being made of it.
    pub fn beside(evidence: &Evidence, sight: Sight<Later<Free>>) -> Self {
        let Sight { look, views, on_legs, free } = sight;
        let (views, plan) = planned(evidence, &look, views, &on_legs);
        Self { views, plan, free: free.get() }
    }

    /// From what is seen.
    pub fn new(evidence: &Evidence, sight: Sight<Free>) -> Self {
        let Sight { look, views, on_legs, free } = sight;
        let (views, plan) = planned(evidence, &look, views, &on_legs);
        Self { views, plan, free }
    }
}

/// The plan, and the views that it is of: where ways across rows lead over the ground of racks on legs, of those that are
/// left beside the ways.
fn planned(evidence: &Evidence, look: &Look, mut views: Vec<Turned>, on_legs: &[Row]) -> (Vec<Turned>, Plan) {
    let (plan, across) = Plan::of(evidence, look, &views, on_legs);
    if on_legs.is_empty() || plan.rows.is_empty() {
        return (views, plan);
    }
    // Goods that stand between legs tell where there are none.
    let mut bare = seen(evidence, look, &mut views, &[]);
    let over = gates::through_several(evidence, look, &bare, &plan.strips, &plan.rows);
    if bare.iter().any(Turned::is_large) {
        views = seen(evidence, look, &mut bare, on_legs);
    }
    drop(bare);
    let left = carried::left_beside(&views, &over, on_legs);
    let left = carried::without_ways(evidence, &views, &joined::apart(&views, [across, over].concat()), &left);
    if left == on_legs {
        return (views, plan);
    }
    drop(plan);
    let views = seen(evidence, look, &mut views, &left);
    let (plan, _) = Plan::of(evidence, look, &views, &left);
    (views, plan)
}

/// What is seen where other racks than those of some views stand on legs. Of a large map there is no room for both: those
/// views let go of what they see.
fn seen(evidence: &Evidence, look: &Look, views: &mut [Turned], on_legs: &[Row]) -> Vec<Turned> {
    let scene = evidence.scene();
    let mut others: Vec<_> = views.iter().map(|view| view.with(&scene, on_legs)).collect();
    views.iter_mut().filter(|view| view.is_large()).for_each(Turned::unsee);
    see(evidence, look, &mut others);
    others
}

/// What lies between the lines, for which of the gradients the specks are enough.
fn see(evidence: &Evidence, look: &Look, views: &mut [Turned]) {
    quarter::see(views, &evidence.scene(), look);
    each(views.iter_mut().collect(), evidence.threads, |view: &mut Turned| {
        view.glaze();
        view.recur(&evidence.shared_out());
    });
    panes::share(views);
}

/// The ways, what they meet and where they end, and the rows between them.
pub struct Plan {
    pub strips: Vec<Strip>,
    pub meetings: Vec<Meeting>,
    /// Dead ends: the corridor, which end of it, and the place along.
    pub ends: Vec<(usize, usize, f64)>,
    /// Where each corridor begins and ends, along, with its junctions.
    pub extents: Vec<[f64; 2]>,
    pub rows: Vec<Row>,
    /// The racks, of which not all are such rows.
    pub racks: Vec<Row>,
}

impl Plan {
    /// And the ways before those that may be bays, or lie within others, were left out.
    fn of(evidence: &Evidence, look: &Look, views: &[Turned], on_legs: &[Row]) -> (Self, Vec<Strip>) {
        let least = evidence.parameters.labels_min_width;
        let Ways { sure, over, cut, on } = corridors::find(evidence, views);
        let mut found = joined::join(views, [sure, on.clone()].concat(), least);
        // What goes on beyond a way is none by itself.
        let beyond = placed(views, on.iter().map(Strip::place));
        let is_on =
            |way: &Strip| beyond[way.direction].touching(way.along, way.across).into_iter().any(|n| on[n] == *way);
        found.retain(|way| !is_on(way));
        let found = rows::without_lanes(views, crossed::without_bays(evidence, look, views, found));
        let found = pillared::widened(views, &slots::without(views, found), evidence.parameters);
        let found = corridors::without_bent(views, past_goods::led_on(views, found, least));
        let found = askew::cut(views, found);
        let threads = evidence.threads;
        let standing = Standing::new(views, evidence.recall, threads);
        // What was too short to stay bars no way whose sides are no lines, but tells how wide that is.
        let pieces = placed(views, found.iter().map(Strip::place));
        let over: Vec<Strip> = over.into_iter().map(|way| led::sided_by(views, way, &found, &pieces)).collect();
        let mut plan = Self::new(views, found, threads);
        plan = plan.with(views, &over, least, threads);
        // A way that ends at walls is no part of a room where others open into it and it goes on as one of them, or
        // racks stand.
        let known = placed(views, plan.strips.iter().map(Strip::place));
        let (led, cut): (Vec<_>, Vec<_>) = cut
            .into_iter()
            .filter(|way| led::is_opened_into(views, way, &plan.strips, &known))
            .partition(|way| led::goes_on_as(way, &plan.strips, &known));
        plan = plan.with(views, &led, least, threads);
        if !cut.is_empty() && !plan.find_racks(views, on_legs, &standing, threads).is_empty() {
            plan = plan.with(views, &cut, least, threads);
        }
        let (mut plan, mut across) = plan.with_others(evidence, look, views);
        plan.racks = plan.find_racks(views, on_legs, &standing, threads);
        let faced = faced::whole(views, &plan.strips, &plan.racks);
        if faced != plan.strips {
            // As long as they are, they may show where others lead.
            (plan, across) = Self::new(views, faced, threads).with_others(evidence, look, views);
            plan.racks = plan.find_racks(views, on_legs, &standing, threads);
        }
        let laid_out = |strips: Vec<Strip>| {
            let mut plan = Self::new(views, strips, threads);
            plan.racks = plan.find_racks(views, on_legs, &standing, threads);
            plan
        };
        if let Some(shorter) = led_into::cut(views, &plan.strips) {
            plan = laid_out(shorter);
        }
        let slots = slots::by_meetings(views, &plan.strips, &plan.meetings, &plan.racks);
        if !slots.is_empty() {
            let rest = (0..plan.strips.len()).filter(|n| !slots.contains(n)).map(|n| plan.strips[n].clone());
            plan = laid_out(rest.collect());
        }
        let narrow = narrowed::past(views, &plan.strips, &plan.racks, &plan.reached(views), least);
        if narrow != plan.strips {
            plan = laid_out(narrow);
        }
        if let Some(longer) = past_goods::past_piles(views, &plan.strips, &plan.rows, least) {
            plan = laid_out(longer);
        }
        if let Some(longer) = past_last::led_on(views, &plan.strips, &plan.meetings, [&plan.rows, &plan.racks]) {
            plan = laid_out(longer);
        }
        plan.racks = whole::uncrossed(views, &plan.strips, &plan.extents, &plan.racks);
        (plan, across)
    }

    /// With the ways through and past its rows, and those that are known by them; and the ways that had been there and those
    /// through rows before some of them were left out.
    fn with_others(self, evidence: &Evidence, look: &Look, views: &[Turned]) -> (Self, Vec<Strip>) {
        let threads = evidence.threads;
        let Gates { known, ways, as_bays } = gates::find(evidence, look, views, &self.strips, &self.rows);
        let across = [&*known, &ways].concat();
        let alike = [ways::among(evidence, look, views, &across, known.len()), as_bays].concat();
        let carried = carried::on(evidence, look, views, joined::apart(views, alike));
        let mut plan = if carried == self.strips { self } else { Self::new(views, carried, threads) };
        // Two that were led on to meet each other lie over one another.
        let once = joined::once(views, &plan.strips);
        if once.len() < plan.strips.len() {
            plan = Self::new(views, once, threads);
        }
        if let Some(more) = heads::with(evidence, look, views, &plan.strips, &plan.rows) {
            plan = Self::new(views, more, threads);
        }
        if let Some(more) = cornered::with(views, &plan.strips, evidence.parameters) {
            plan = Self::new(views, more, threads);
        }
        if let Some(more) = frontiers::with(views, &plan.strips, &plan.rows, evidence.parameters) {
            plan = Self::new(views, more, threads);
        }
        if let Some(more) = bends::with(views, &plan.strips, &plan.meetings, &plan.rows, evidence.parameters) {
            plan = Self::new(views, more, threads);
        }
        (plan, across)
    }

    /// From where to where each way leads, along: to what it meets, and to walls at its ends.
    fn reached(&self, views: &[Turned]) -> Vec<[f64; 2]> {
        let mut reached = vec![[f64::INFINITY, f64::NEG_INFINITY]; self.strips.len()];
        let mut add = |n: usize, place: f64, reach: f64| reached[n] = both(reached[n], wider([place; 2], reach));
        for meeting in &self.meetings {
            for &n in &meeting.corridors {
                add(n, views[self.strips[n].direction].place(meeting.at)[0], connected::reach(meeting, n));
            }
        }
        self.ends.iter().for_each(|&(n, _, place)| add(n, place, 0.0));
        reached
    }

    /// With what its ways leave of others.
    fn with(self, views: &[Turned], others: &[Strip], least: f64, threads: usize) -> Self {
        let more: Vec<Strip> = others.iter().filter_map(|way| ragged::clear_of(way, &self.strips)).collect();
        if more.is_empty() {
            return self;
        }
        Self::new(views, joined::join(views, [self.strips, more].concat(), least), threads)
    }

    fn find_racks(&self, views: &[Turned], on_legs: &[Row], standing: &Standing, threads: usize) -> Vec<Row> {
        let rows = racks::with_bays(views, &self.strips, &self.extents, &self.rows, threads);
        whole::find(views, &self.strips, &self.extents, [&rows, on_legs], standing, threads)
    }

    fn new(views: &[Turned], strips: Vec<Strip>, threads: usize) -> Self {
        let (mut strips, meetings) = connected::of(views, strips, threads);
        // A corridor goes on to what it meets, and there it may be what another one meets.
        let longer = extents(views, &strips, &meetings);
        for (strip, along) in strips.iter_mut().zip(longer) {
            strip.found = shared(strip.found, strip.along);
            strip.along = both(strip.along, along);
        }
        let strips = widening::up_to(views, &strips, &meetings);
        let (strips, meetings) = connected::of(views, strips, threads);
        let mut extents = extents(views, &strips, &meetings);
        let ends = junctions::ends(views, &strips, &meetings);
        for &(n, side, place) in &ends {
            extents[n][side] = place;
        }
        let rows = racks::find(views, &strips, &extents, threads);
        Self { strips, meetings, ends, extents, rows, racks: Vec::new() }
    }
}

/// Where each corridor begins and ends, along: its walled part, and the middle of the junction at each end that it has
/// no arm beyond.
fn extents(views: &[Turned], strips: &[Strip], meetings: &[Meeting]) -> Vec<[f64; 2]> {
    let mut extents: Vec<[f64; 2]> = strips.iter().map(|strip| strip.along).collect();
    let all = || {
        let each = |m: &Meeting, p: usize| (m.corridors[p], m.reach[p.min(1)], m.at);
        meetings.iter().flat_map(move |m| (0..m.corridors.len()).map(move |p| each(m, p)))
    };
    let place = |n: usize, at: [f64; 2]| views[strips[n].direction].place(at)[0];
    for (n, reach, at) in all() {
        let (u, [low, high]) = (place(n, at), strips[n].along);
        for (side, beyond) in [(0, u - low), (1, high - u)] {
            if !shut::goes_on(&views[strips[n].direction], &strips[n], side, beyond - reach) {
                extents[n][side] = u;
            }
        }
    }
    for (n, _, at) in all() {
        let u = place(n, at);
        extents[n] = both(extents[n], [u; 2]);
    }
    extents
}
