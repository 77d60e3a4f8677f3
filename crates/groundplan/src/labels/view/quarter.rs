//! Views at right angles to one another: what one sees is what the other sees, turned by a quarter, and it is looked at the
//! map once for both.

use super::look::Look;
use super::turned::Turned;
use crate::bands::{each, map_bands, map_each, worth};
use crate::directions::Directions;
use crate::grid::Frame;
use crate::labels::Scene;
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

/// Where two directions are at right angles but for so little that their samples lie no farther apart anywhere, samples.
const APART: f64 = 0.5;

/// Which other view one is a quarter turn from.
#[derive(Clone, Copy)]
pub struct Quarter {
    pub other: usize,
    /// Whether it is turned on from there, or back.
    is_on: bool,
}

impl Quarter {
    /// Of directions whose samples are so far apart, metres; those that others are turned from are none themselves.
    pub fn of(directions: &Directions, frame: &Frame, sample: f64, direction: usize) -> Option<Self> {
        let reach = 0.5 * (frame.width as f64).hypot(frame.height as f64) * frame.resolution;
        let from = |other: usize| {
            let turn = directions.angles[direction] - directions.angles[other];
            let is_near = (turn.abs() - FRAC_PI_2).abs() * reach <= APART * sample;
            is_near.then_some(Self { other, is_on: turn > 0.0 })
        };
        (0..direction).filter_map(from).find(|quarter| Self::of(directions, frame, sample, quarter.other).is_none())
    }

    /// How far a point lies from the first cell's lower corner along and across, from how far it lies so in the other view,
    /// which is so long and wide.
    pub fn place(self, [u, v]: [f64; 2], [length, width]: [f64; 2]) -> [f64; 2] {
        if self.is_on { [v, length - u] } else { [width - v, u] }
    }

    /// The cells of the other view, row after row, which has so many along and across, as this one has them.
    fn turn(self, cells: &[u8], [length, width]: [usize; 2]) -> Vec<u8> {
        let mut turned = vec![0; cells.len()];
        for (n, row) in turned.chunks_mut(width).enumerate() {
            let column = if self.is_on { length - 1 - n } else { n };
            let column = cells[column..].iter().step_by(length);
            row.iter_mut().zip(column).for_each(|(to, cell)| *to = *cell);
            if !self.is_on {
                row.reverse();
            }
        }
        turned
    }
}

/// What several views see of the map, each by itself or as another does.
pub fn see(views: &mut [Turned], scene: &Scene, look: &Look) {
    let is_asked = |n: usize| views.iter().any(|view| view.quarter.is_some_and(|quarter| quarter.other == n));
    let asked: Vec<usize> = (0..views.len()).filter(|&n| is_asked(n)).collect();
    let threads = scene.threads / asked.len().max(1);
    let seen =
        map_each(asked.len(), scene.threads, |n| (views[asked[n]].size, cells(&views[asked[n]], scene, look, threads)));
    each(views.iter_mut().enumerate().collect(), scene.threads, |(n, view): (usize, &mut Turned)| {
        let own = view.quarter.map_or(n, |quarter| quarter.other);
        let of = asked.iter().position(|&other| other == own).map(|place| &seen[place]);
        let turned = of.zip(view.quarter).map(|((size, cells), quarter)| quarter.turn(cells, *size));
        let known = turned.as_deref().or(of.map(|(_, cells)| &cells[..]));
        view.see(&scene.shared_out(), look, known);
    });
}

/// The cells of a view, row after row, as the map has them.
fn cells(view: &Turned, scene: &Scene, look: &Look, threads: usize) -> Vec<u8> {
    let ([length, width], frame) = (view.size, &scene.grid.frame);
    let ahead = view.ahead(frame, look);
    let rows = |band: Range<usize>| {
        let mut cells = vec![0; band.len() * length];
        view.look_along(frame, look, &ahead, band, 0, &mut cells);
        cells
    };
    // Without threads nothing need be put together.
    if worth(length * width, threads) == 1 {
        rows(0..width)
    } else {
        map_bands([length, width], threads, rows).concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_turned_by_a_quarter_lies_where_its_places_do() {
        let frame = Frame::new(300, 200, 0.05, [0.0; 3]);
        let angles = vec![-0.4, FRAC_PI_2 - 0.4 + 1e-5, -0.4 - FRAC_PI_2, 0.7, FRAC_PI_2 - 0.39];
        let directions = Directions { angles, ..Directions::default() };
        let of = |n: usize| Quarter::of(&directions, &frame, 0.05, n);
        // The first by itself, the next two as it is; the last two are at right angles to none.
        assert_eq!([0, 1, 2, 3, 4].map(|n| of(n).map(|quarter| quarter.other)), [None, Some(0), Some(0), None, None]);
        let size = [5, 3];
        let cells: Vec<u8> = (0..15).collect();
        for quarter in [1, 2].map(|n| of(n).unwrap()) {
            let turned = quarter.turn(&cells, size);
            for (n, cell) in cells.iter().enumerate() {
                let middle = [n % size[0], n / size[0]].map(|cells| cells as f64 + 0.5);
                let [u, v] = quarter.place(middle, size.map(|cells| cells as f64));
                assert_eq!(turned[v as usize * size[1] + u as usize], *cell);
            }
        }
    }
}
