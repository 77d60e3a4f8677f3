//! Passes over pixels as sums over row bands: any number of threads gives the same bytes.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Rows of one band: enough to be worth a thread's while, few enough to share out evenly.
const BAND_ROWS: usize = 64;

/// What `pass` makes of each band of `0..rows`, in the bands' order. Threads are started only when asked for.
pub fn map_bands<T: Send>(rows: usize, threads: usize, pass: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
    let gather = |made: &mut Vec<(usize, T)>, band: Range<usize>| made.push((band.start, pass(band)));
    let mut made = fold_bands(rows, threads, Vec::new, gather, Vec::extend);
    made.sort_unstable_by_key(|(start, _)| *start);
    made.into_iter().map(|(_, t)| t).collect()
}

/// A sum over the bands of `0..rows`: each thread adds bands to a total of its own, and the totals are merged. The
/// sum must not depend on the order, as sums of integers do not.
pub fn fold_bands<T: Send>(
    rows: usize,
    threads: usize,
    empty: impl Fn() -> T + Sync,
    add: impl Fn(&mut T, Range<usize>) + Sync,
    merge: impl Fn(&mut T, T),
) -> T {
    let bands = rows.div_ceil(BAND_ROWS);
    let band = |n: usize| n * BAND_ROWS..((n + 1) * BAND_ROWS).min(rows);
    let next = AtomicUsize::new(0);
    let work = || {
        let mut total = empty();
        loop {
            let n = next.fetch_add(1, Ordering::Relaxed);
            if n >= bands {
                return total;
            }
            add(&mut total, band(n));
        }
    };
    let workers = threads.min(bands);
    if workers <= 1 {
        return work();
    }
    let totals: Vec<T> = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        handles.into_iter().map(|h| h.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
    });
    let mut totals = totals.into_iter();
    let mut sum = totals.next().unwrap_or_else(empty);
    totals.for_each(|total| merge(&mut sum, total));
    sum
}
