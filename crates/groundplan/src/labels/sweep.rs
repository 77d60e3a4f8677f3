//! Going over a view from place to place across. Of a large one, which is kept in squares, the rows that some places look
//! at are first laid out as sums: most that is found along a direction asks them many times over.

use super::summed::Summed;
use super::sums::What;
use super::turned::Turned;
use crate::bands::map_each_in;

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
    /// What is found at the places of one group after another. On a small view a group is so many places in their order,
    /// on a large one those that lie in the same rows. `find` is given the view, the number of a place, and where to put
    /// what it finds.
    pub fn find<T: Send>(
        &self,
        together: usize,
        threads: usize,
        find: impl Fn(&Turned, usize, &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        let view = self.view;
        let rows = |place: usize| ((self.places[place] - view.start[1]) / (ROWS * view.cell)).floor() as i64;
        let mut order: Vec<usize> = (0..self.places.len()).collect();
        let is_large = view.is_large() && self.around.into_iter().all(|far| far <= FAR);
        let groups: Vec<&[usize]> = if is_large {
            order.sort_by_key(|&place| rows(place));
            order.chunk_by(|&one, &two| rows(one) == rows(two)).collect()
        } else {
            order.chunks(together).collect()
        };
        let made = map_each_in(groups.len(), threads, |room: &mut Summed, n| {
            let group = groups[n];
            let places = || group.iter().map(|&place| self.places[place]);
            let near = is_large.then(|| {
                let low = places().fold(f64::INFINITY, f64::min) - self.around[0];
                let high = places().fold(f64::NEG_INFINITY, f64::max) + self.around[1];
                view.near(self.what, low, high, std::mem::take(room))
            });
            let near = near.flatten();
            let mut found = Vec::new();
            for &place in group {
                find(near.as_ref().unwrap_or(view), place, &mut found);
            }
            *room = near.map(Turned::into_room).unwrap_or_default();
            found
        });
        made.into_iter().flatten().collect()
    }
}
