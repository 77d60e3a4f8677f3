//! Ways between sides: where one leads nowhere, what stands along it alone tells it from what is free of a room.

use super::corridors::Strip;
use super::turned::Turned;

/// Over so much of a way's length something stands at a side.
const SIDED: f64 = 0.6;
/// It does so from so far within the side to so far beyond, in widths.
const SIDE: (f64, f64) = (0.1, 0.25);

/// True when something that is not free stands along both sides of a strip.
pub fn is_sided(view: &Turned, strip: &Strip) -> bool {
    let columns = view.column(strip.along[0])..view.column(strip.along[1]);
    let [low, high] = strip.across;
    let (within, beyond) = (SIDE.0 * strip.width(), SIDE.1 * strip.width());
    [[low - beyond, low + within], [high - within, high + beyond]].into_iter().all(|[low, high]| {
        let held = view.blocked_where(columns.clone(), low, high, |share| share > 0.0);
        held.count(0..columns.len()) as f64 >= SIDED * columns.len() as f64
    })
}
