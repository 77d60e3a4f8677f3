//! Passes over pixels as sums over row bands: any number of threads gives the same bytes.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};
use std::thread::{Scope, ScopedJoinHandle};

/// Rows of one band: few enough to share out evenly.
pub const BAND_ROWS: usize = 64;
/// Such as strips, or rows of racks.
const SEVERAL: usize = 32;
/// Each thread has so many pixels, or cells of a view, at least: less takes as long as to start one.
const WORTH: usize = 1 << 18;

/// What `pass` makes of each band of the rows of so many pixels by so many, in the bands' order. Threads are started only
/// when asked for.
pub fn map_bands<T: Send>(
    [width, rows]: [usize; 2],
    threads: usize,
    pass: impl Fn(Range<usize>) -> T + Sync,
) -> Vec<T> {
    map_bands_in([width, rows], threads, |(), band| pass(band))
}

/// [`map_bands`] in room of each thread's own, which it finds as it left it: what is large is not asked of the system anew.
pub fn map_bands_in<T: Send, R: Default + Send>(
    [width, rows]: [usize; 2],
    threads: usize,
    pass: impl Fn(&mut R, Range<usize>) -> T + Sync,
) -> Vec<T> {
    map_each_in(rows.div_ceil(BAND_ROWS), worth(width * rows, threads), |room, n| pass(room, band_rows(n, rows)))
}

/// As many of the threads as so many pixels are worth.
pub fn worth(pixels: usize, threads: usize) -> usize {
    threads.min(pixels / WORTH).max(1)
}

/// What `make` makes of each of `0..count`, in their order; each is worth a thread's while.
pub fn map_each<T: Send>(count: usize, threads: usize, make: impl Fn(usize) -> T + Sync) -> Vec<T> {
    map_each_in(count, threads, |(), n| make(n))
}

/// All that `make` makes of each of `0..count`, in their order; only several together are worth a thread's while.
pub fn flat_map_each<T: Send, M: IntoIterator<Item = T>>(
    count: usize,
    threads: usize,
    make: impl Fn(usize) -> M + Sync,
) -> Vec<T> {
    let some = |n: usize| n * SEVERAL..((n + 1) * SEVERAL).min(count);
    let made = map_each(count.div_ceil(SEVERAL), threads, |n| some(n).flat_map(&make).collect::<Vec<_>>());
    made.into_iter().flatten().collect()
}

/// [`map_each`] in room of each thread's own, as in [`map_bands_in`].
pub fn map_each_in<T: Send, R: Default + Send>(
    count: usize,
    threads: usize,
    make: impl Fn(&mut R, usize) -> T + Sync,
) -> Vec<T> {
    let gather = |(room, made): &mut (R, Vec<(usize, T)>), n: usize| made.push((n, make(room, n)));
    let (_, mut made) = fold(count, threads, Default::default, gather, |all, more| all.1.extend(more.1));
    made.sort_unstable_by_key(|(n, _)| *n);
    made.into_iter().map(|(_, t)| t).collect()
}

/// Work of which parts can be started beside the rest, where threads were asked for.
pub fn side_by_side<'env, R>(threads: usize, work: impl for<'s> FnOnce(Side<'s, 'env>) -> R) -> R {
    if threads <= 1 { work(Side(None)) } else { std::thread::scope(|scope| work(Side(Some(scope)))) }
}

/// Where work can be started beside what the thread does itself.
#[derive(Clone, Copy)]
pub struct Side<'scope, 'env>(Option<&'scope Scope<'scope, 'env>>);

impl<'scope> Side<'scope, '_> {
    /// Starts something on a thread of its own; without threads it is made at once.
    pub fn start<T: Send + 'scope>(self, make: impl FnOnce() -> T + Send + 'scope) -> Later<'scope, T> {
        match self.0 {
            Some(scope) => Later::Started(scope.spawn(make)),
            None => Later::Made(make()),
        }
    }
}

/// What was started.
pub enum Later<'scope, T> {
    Made(T),
    Started(ScopedJoinHandle<'scope, T>),
}

impl<T> Later<'_, T> {
    /// What was made, waiting for it where it is not there yet.
    pub fn get(self) -> T {
        match self {
            Self::Made(made) => made,
            Self::Started(handle) => handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
        }
    }
}

/// What was started and is asked for by several.
pub struct Awaited<'scope, T> {
    started: Mutex<Option<Later<'scope, T>>>,
    made: OnceLock<T>,
}

impl<'scope, T> Awaited<'scope, T> {
    pub fn new(started: Later<'scope, T>) -> Self {
        Self { started: Mutex::new(Some(started)), made: OnceLock::new() }
    }

    /// What was made: whoever asks first waits for it, and the others for that one.
    pub fn get(&self) -> &T {
        self.made.get_or_init(|| {
            let started = self.started.lock().ok().and_then(|mut started| started.take());
            started.map_or_else(|| unreachable!("it is taken once, unless making it has panicked"), Later::get)
        })
    }

    /// And no longer shared.
    pub fn into_made(self) -> T {
        self.get();
        self.made.into_inner().unwrap_or_else(|| unreachable!("it has just been made"))
    }
}

/// Works off tasks that have nothing to do with one another, such as the parts of what is filled.
pub fn each<T: Send>(tasks: Vec<T>, threads: usize, work: impl Fn(T) + Sync) {
    if threads <= 1 || tasks.len() <= 1 {
        return tasks.into_iter().for_each(work);
    }
    let (count, tasks) = (tasks.len(), Mutex::new(tasks.into_iter()));
    // Where a task has panicked, what is left is not begun.
    let next = || tasks.lock().ok().and_then(|mut tasks| tasks.next());
    fold(count, threads, || (), |(), _| next().into_iter().for_each(&work), |(), ()| ());
}

/// The rows of a band, of so many.
pub fn band_rows(n: usize, rows: usize) -> Range<usize> {
    n * BAND_ROWS..((n + 1) * BAND_ROWS).min(rows)
}

/// A sum over `0..count`: each thread adds to a total of its own, and the totals are merged. The sum must not depend on
/// the order, as sums of integers do not.
pub fn fold<T: Send>(
    count: usize,
    threads: usize,
    empty: impl Fn() -> T + Sync,
    add: impl Fn(&mut T, usize) + Sync,
    merge: impl Fn(&mut T, T),
) -> T {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut total = empty();
        loop {
            let n = next.fetch_add(1, Ordering::Relaxed);
            if n >= count {
                return total;
            }
            add(&mut total, n);
        }
    };
    let workers = threads.min(count);
    if workers <= 1 {
        return work();
    }
    std::thread::scope(|scope| {
        // The thread that asks works too.
        let handles: Vec<_> = (1..workers).map(|_| scope.spawn(work)).collect();
        let mut sum = work();
        for handle in handles {
            merge(&mut sum, handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        sum
    })
}
