//! A rack on legs: frames that follow one another at one pitch.

use crate::ends::{overlap, shared, wider};
use crate::labels::rows::Row;

/// Pitches of a kind differ by no more than this share.
pub const ALIKE: f64 = 0.08;
/// What ends one bay before a wall, but for so much, metres, may reach up to it.
pub const UP_TO_WALL: f64 = 0.25;

/// Frames in a row.
#[derive(Clone, Debug)]
pub struct Rack {
    pub row: Row,
    /// From frame to frame, metres.
    pub pitch: f64,
    /// How many they are.
    pub frames: usize,
    /// How deep these are, metres.
    pub depth: f64,
    /// How long a leg is along, or a plate, of which no more than a pixel need be seen, metres.
    pub leg: f64,
    /// A plate is the first of them, and the last.
    pub closed: [bool; 2],
    /// It is two, back to back.
    pub is_double: bool,
}

impl Rack {
    /// Where the outer sides of its legs are, across.
    pub fn faces(&self) -> [f64; 2] {
        wider(self.row.across, self.leg / 2.0)
    }

    /// What is seen along each of its faces, metres.
    pub fn structure(&self) -> f64 {
        self.frames as f64 * self.leg
    }
}

/// The racks of one direction, by which rows tell how far it is from frame to frame.
#[derive(Default)]
pub struct Pitches {
    /// From where to where along, across, and the pitch, in the order of their places across.
    racks: Vec<([f64; 2], [f64; 2], f64)>,
    deepest: f64,
}

impl Pitches {
    pub fn of(direction: usize, racks: &[Rack]) -> Self {
        let own = racks.iter().filter(|rack| rack.row.direction == direction);
        let mut racks: Vec<_> = own.map(|Rack { row, pitch, .. }| (row.along, row.across, *pitch)).collect();
        racks.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        let deepest = racks.iter().map(|(_, across, _)| across[1] - across[0]).fold(0.0, f64::max);
        Self { racks, deepest }
    }

    /// From frame to frame along a row, metres, where racks on legs make up most of it: that of most of them.
    pub fn about(&self, row: &Row) -> Option<f64> {
        let first = self.racks.partition_point(|(_, across, _)| across[0] < row.across[0] - self.deepest);
        let near = self.racks[first..].iter().take_while(|(_, across, _)| across[0] < row.across[1]);
        let own =
            near.filter(|(along, across, _)| overlap(*along, row.along) > 0.0 && overlap(*across, row.across) > 0.0);
        let mut own: Vec<([f64; 2], f64)> = own.map(|(along, _, pitch)| (shared(*along, row.along), *pitch)).collect();
        own.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        let of = |pitch: f64| {
            let alike = own.iter().filter(|(_, other)| (other - pitch).abs() <= ALIKE * pitch);
            alike.map(|([from, to], _)| to - from).sum::<f64>()
        };
        let most = own.iter().map(|(_, pitch)| *pitch).max_by(|one, two| of(*one).total_cmp(&of(*two)));
        // Racks beside each other are in one place.
        let (mut covered, mut end) = (0.0, f64::NEG_INFINITY);
        for ([from, to], _) in &own {
            covered += (to - from.max(end)).max(0.0);
            end = end.max(*to);
        }
        most.filter(|_| covered > row.length() / 2.0)
    }
}
