//! Going over a view from place to place across. Of a large one, which is kept in squares, the rows that some places look
//! at are first laid out as sums: most that is found along a direction asks them many times over.

use super::summed::Summed;
use super::sums::What;
use super::turned::Turned;
use crate::bands::{map_each_in, worth};
use crate::ends::around;
use std::cell::{Cell, OnceCell};

/// So many rows of cells are gone over together.
const ROWS: f64 = 128.0;
/// Rows that look farther than this beside them, metres, are asked as they are kept.
const FAR: f64 = 50.0;

/// What is gone over.
pub struct Sweep<'a> {
    pub view: &'a Turned,
    /// Places across.
    pub places: &'a [f64],
    /// How far each looks below and above it, metres, and what most that it asks is.
    pub around: [f64; 2],
    pub what: &'a [What],
}

impl Sweep<'_> {
    /// What is found at the places of one group after another. On a small view a group is places in their order that have
    /// so many columns together, which are worth a thread's while, on a large one those that lie in the same rows. `find`
    /// is given what lies near the places of the group, the number of a place, and where to put what it finds.
    pub fn find<T: Send>(
        &self,
        columns: usize,
        threads: usize,
        find: impl Fn(&Near, usize, &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        let view = self.view;
        let rows = |place: usize| ((self.places[place] - view.start[1]) / (ROWS * view.cell)).floor() as i64;
        let mut order: Vec<usize> = (0..self.places.len()).collect();
        let is_large = view.is_large() && self.around.into_iter().all(|far| far <= FAR);
        let groups: Vec<&[usize]> = if is_large {
            order.sort_by_key(|&place| rows(place));
            order.chunk_by(|&one, &two| rows(one) == rows(two)).collect()
        } else {
            order.chunks((columns / view.size[0]).max(1)).collect()
        };
        let threads = worth(view.size[0] * view.size[1], threads);
        let made = map_each_in(groups.len(), threads, |room: &mut Summed, n| {
            let places = || groups[n].iter().map(|&place| self.places[place]);
            let ends = is_large.then(|| {
                let [low, high] = around(places());
                [low - self.around[0], high + self.around[1]]
            });
            let near = Near { sweep: self, ends, room: Cell::new(std::mem::take(room)), laid_out: OnceCell::new() };
            let mut found = Vec::new();
            for &place in groups[n] {
                find(&near, place, &mut found);
            }
            *room = near.into_room();
            found
        });
        made.into_iter().flatten().collect()
    }
}

/// What lies near the places of a group.
pub struct Near<'a> {
    sweep: &'a Sweep<'a>,
    /// Of a large view from where to where across.
    ends: Option<[f64; 2]>,
    room: Cell<Summed>,
    laid_out: OnceCell<Option<Turned>>,
}

impl Near<'_> {
    /// The view; of a large one the rows near by are laid out when it is first asked for, as all that is found there may
    /// be known from before.
    pub fn view(&self) -> &Turned {
        let view = self.sweep.view;
        let lay_out = |[low, high]: [f64; 2]| view.near(self.sweep.what, low, high, self.room.take());
        self.laid_out.get_or_init(|| self.ends.and_then(lay_out)).as_ref().unwrap_or(view)
    }

    fn into_room(self) -> Summed {
        self.laid_out.into_inner().flatten().map_or(self.room.into_inner(), Turned::into_room)
    }
}
