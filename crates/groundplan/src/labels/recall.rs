//! What was found before: where the map and the lines have not changed, what was found from them holds.
//!
//! What a strip or a part of the map is made from is summed up in a key of 128 bits, and what was found is kept by it.
//! Where nobody knows beforehand what will be looked at, the answer is kept with the part of the map that was.
//! A survey looks into what another one kept before it looks at the pixels, so the answer is the same with and without.

use super::corridors::Strip;
use super::corridors::stretches;
use super::posts::period::Period;
use super::rooms::{Bar, Part, Width};
use super::rows::Row;
use super::view::patches::{Area, Patches};
use super::view::squares::Band;
use super::view::sums::Told;
use crate::bits::{Bits, WORD, lowest};
use crate::grid::Grid;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// What something was made from, in 128 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key(u128);

/// An odd number without a pattern: the digits of pi.
const FACTOR: u128 = 0x243f_6a88_85a3_08d3_1319_8a2e_0370_7345;

impl Key {
    /// The key of this and a word more.
    pub fn with(self, word: u64) -> Self {
        Self((self.0 ^ u128::from(word)).wrapping_mul(FACTOR).rotate_left(64).wrapping_add(1))
    }

    pub fn number(self, value: f64) -> Self {
        self.with(value.to_bits())
    }

    pub fn numbers(self, values: &[f64]) -> Self {
        values.iter().copied().fold(self.with(values.len() as u64), Self::number)
    }

    pub fn key(self, other: Self) -> Self {
        self.with(other.0 as u64).with((other.0 >> 64) as u64)
    }

    pub fn bytes(self, bytes: &[u8]) -> Self {
        let chunks = bytes.chunks_exact(8);
        let rest = chunks.remainder().iter().fold(0, |word, &byte| word << 8 | u64::from(byte));
        let word = |chunk: &[u8]| chunk.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
        chunks.fold(self.with(bytes.len() as u64), |key, chunk| key.with(word(chunk))).with(rest)
    }

    /// With some of a set's bits.
    pub fn bits(self, bits: &Bits, some: Range<usize>) -> Self {
        let word = |at: usize| bits.word(at) & lowest(some.end - at);
        some.clone().step_by(WORD).map(word).fold(self.with(some.start as u64).with(some.end as u64), Self::with)
    }
}

/// Rows of a view, and what is told of each.
type SeenRows = (Arc<Band>, Vec<Told>);

/// What was found, by what it was found from.
type Known<T> = Arc<HashMap<Key, T, BuildHasherDefault<AsItIs>>>;

/// What is known by keys is found by them as they are: they have no pattern.
#[derive(Debug, Default)]
struct AsItIs(u64);

impl Hasher for AsItIs {
    fn write_u128(&mut self, key: u128) {
        self.0 = key as u64;
    }

    fn write(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |place, &byte| place << 8 ^ u64::from(byte));
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// What is kept, of each kind what was found by its keys.
macro_rules! kinds {
    ($($(#[$about:meta])* $name:ident: $of:ty,)*) => {
        /// What a survey found and keeps for another one of the same parameters.
        #[derive(Clone, Debug, Default)]
        pub struct Memory {
            $($(#[$about])* $name: Known<$of>,)*
        }

        /// What is known from before, and what is kept for later.
        #[derive(Debug, Default)]
        pub struct Recall {
            $($(#[$about])* pub(super) $name: Found<$of>,)*
            /// Keys of the map's patches, once they are asked for.
            patches: OnceLock<Patches>,
        }

        impl Recall {
            /// With a memory, be it empty, all that is found is kept; without one nothing is.
            #[must_use]
            pub fn new(memory: Option<Memory>) -> Self {
                let with = |known: Memory| Self { $($name: Found::new(known.$name),)* patches: OnceLock::new() };
                memory.map_or_else(Self::default, with)
            }

            /// What was found this time, and nothing else.
            #[must_use]
            pub fn memory(self) -> Memory {
                Memory { $($name: self.$name.known(),)* }
            }
        }
    };
}

kinds! {
    /// Pieces of a strip between two lines, and whether they are corridors.
    strips: Vec<(Strip, bool)>,
    /// Stretches of such strips that are not closed, from column to column.
    open: Vec<Range<usize>>,
    ragged: Vec<stretches::Found>,
    /// In which columns of a view structure lies on a line, and in which something touches it.
    lined: [Bits; 2],
    /// Of the specks on a line, how many pairs with a row beside them are so many steps apart.
    faced: Arc<Vec<u32>>,
    /// Of a line.
    gaps: Vec<Bar>,
    /// What stands between two lines with floor before it.
    blocks: Vec<Row>,
    /// What is free in rows of the raster.
    free: Arc<Part>,
    narrows: Vec<Bar>,
    /// Rings of regions, simplified.
    rings: Arc<Vec<[i64; 2]>>,
    /// Of runs of the free space along rows.
    widths: Vec<Width>,
    /// Rows of views.
    views: SeenRows,
    /// How strongly what stands along a row recurs at some frequencies, and the period of a row.
    strengths: Arc<Vec<f64>>,
    periods: Option<Period>,
    /// How sure a label is, and by what.
    sure: Looked<f64>,
}

impl Recall {
    /// True when what is found is kept, so that it has keys.
    #[must_use]
    pub fn keeps(&self) -> bool {
        self.strips.now.is_some()
    }

    /// Keys of the patches of the map that is surveyed, where what is found is kept.
    pub(super) fn patches(&self, grid: &Grid, threads: usize) -> Option<&Patches> {
        self.keeps().then(|| self.patches.get_or_init(|| Patches::new(grid, threads)))
    }
}

/// What was found of a map by looking at some part of it, which had such a key.
#[derive(Clone, Copy, Debug)]
pub(super) struct Looked<T> {
    pub found: T,
    part: Area,
    key: Key,
}

#[derive(Debug)]
pub(super) struct Found<T> {
    before: Known<T>,
    now: Option<Mutex<HashMap<Key, T, BuildHasherDefault<AsItIs>>>>,
}

impl<T> Default for Found<T> {
    fn default() -> Self {
        Self { before: Arc::default(), now: None }
    }
}

impl<T: Clone> Found<T> {
    fn new(before: Known<T>) -> Self {
        Self { before, now: Some(Mutex::default()) }
    }

    fn known(self) -> Known<T> {
        let now = self.now.map(|now| now.into_inner().unwrap_or_else(PoisonError::into_inner));
        Arc::new(now.unwrap_or_default())
    }

    /// What was found from the same before, or else what is found now.
    pub fn or_find(&self, key: impl FnOnce() -> Key, find: impl FnOnce() -> T) -> T {
        self.if_so(key, |_| true, find)
    }

    /// The same of many, of which those that are not known are found together: by their places.
    pub fn or_find_some(
        &self,
        count: usize,
        key: impl Fn(usize) -> Key,
        find: impl FnOnce(&[usize]) -> Vec<T>,
    ) -> Vec<T> {
        let all: Vec<usize> = (0..count).collect();
        let Some(now) = &self.now else { return find(&all) };
        let keys: Vec<Key> = all.iter().map(|&n| key(n)).collect();
        let known: Vec<Option<T>> = keys.iter().map(|key| self.before.get(key).cloned()).collect();
        let others: Vec<usize> = all.into_iter().filter(|&n| known[n].is_none()).collect();
        let found = if others.is_empty() { Vec::new() } else { find(&others) };
        let mut found = found.into_iter();
        let all: Vec<T> = known.into_iter().filter_map(|known| known.or_else(|| found.next())).collect();
        now.lock().unwrap_or_else(PoisonError::into_inner).extend(keys.into_iter().zip(all.iter().cloned()));
        all
    }

    /// The same, if what was found before holds.
    fn if_so(&self, key: impl FnOnce() -> Key, holds: impl FnOnce(&T) -> bool, find: impl FnOnce() -> T) -> T {
        let Some(now) = &self.now else { return find() };
        let key = key();
        let found = self.before.get(&key).filter(|before| holds(before)).cloned().unwrap_or_else(find);
        now.lock().unwrap_or_else(PoisonError::into_inner).insert(key, found.clone());
        found
    }
}

impl<T: Clone> Found<Looked<T>> {
    /// What was found from the same by looking at a part of the map that is as it was, or else what is found now; `look`
    /// says what part it has looked at.
    pub fn or_look(&self, patches: Option<&Patches>, key: impl FnOnce() -> Key, look: impl FnOnce() -> (T, Area)) -> T {
        let of = |part| patches.map_or(Key::default(), |patches| patches.over(part));
        let looked = || {
            let (found, part) = look();
            Looked { found, part, key: of(part) }
        };
        self.if_so(key, |before| before.key == of(before.part), looked).found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Frame, Table};

    #[test]
    fn what_was_found_before_is_not_looked_for() {
        let key = || Key::default().number(0.5).with(1);
        let first = Recall::new(Some(Memory::default()));
        assert_eq!(first.strips.or_find(key, Vec::new), []);
        let second = Recall::new(Some(first.memory()));
        assert_eq!(second.strips.or_find(key, || panic!("it is known")), []);
        // What is not asked for again is not kept.
        let third = Recall::new(Some(Recall::new(Some(second.memory())).memory()));
        let mut looked = false;
        third.strips.or_find(key, || {
            looked = true;
            Vec::new()
        });
        assert!(looked);
    }

    #[test]
    fn of_many_those_that_are_not_known_are_found_together() {
        let mut memory = Memory::default();
        let mut asked = |keys: &[u64]| {
            let recall = Recall::new(Some(memory.clone()));
            let mut sought = Vec::new();
            let key = |n: usize| Key::default().with(keys[n]);
            let found = recall.gaps.or_find_some(keys.len(), key, |some| {
                sought = some.to_vec();
                some.iter().map(|&n| vec![Bar::new([[keys[n] as f64; 2]; 2])]).collect()
            });
            let of = |key: &u64| vec![Bar::new([[*key as f64; 2]; 2])];
            assert_eq!(found, keys.iter().map(of).collect::<Vec<_>>());
            memory = recall.memory();
            sought
        };
        assert_eq!(asked(&[1, 2, 3]), [0, 1, 2]);
        assert_eq!(asked(&[3, 4, 1, 5]), [1, 3]);
        assert_eq!(asked(&[5, 4, 3, 1]), [] as [usize; 0]);
    }

    #[test]
    fn what_was_found_by_looking_holds_until_something_changes_there() {
        let (width, height) = (200, 100);
        let (table, frame) = (Table::trinary(), Frame::new(width, height, 0.05, [0.0; 3]));
        let mut pixels = vec![254; width * height];
        let mut memory = Memory::default();
        let mut looks = |pixels: &[u8]| {
            let grid = Grid::new(pixels, true, &table, frame);
            let recall = Recall::new(Some(memory.clone()));
            let mut looked = false;
            let look = || {
                looked = true;
                (0.5, Area::NONE.with([3, 90]).with([70, 95]))
            };
            assert_eq!(recall.sure.or_look(recall.patches(&grid, 1), Key::default, look), 0.5);
            memory = recall.memory();
            looked
        };
        assert!(looks(&pixels));
        assert!(!looks(&pixels));
        for (x, y, is_there) in [(150, 80, false), (10, 10, false), (60, 93, true), (199, 99, false), (3, 90, true)] {
            pixels[y * width + x] = 0;
            assert_eq!(looks(&pixels), is_there, "{x}, {y}");
        }
    }

    #[test]
    fn keys_tell_apart_what_differs_anywhere() {
        let row: Vec<u8> = (0..100).map(|n| n % 3).collect();
        let mut keys = vec![Key::default().bytes(&row), Key::default().bytes(&row[1..]), Key::default()];
        for n in 0..row.len() {
            let mut other = row.clone();
            other[n] += 16;
            keys.push(Key::default().bytes(&other));
        }
        let only = |n: usize| {
            let mut bits = Bits::new(130);
            bits.insert(n);
            bits
        };
        keys.extend((0..130).map(|n| Key::default().bits(&only(n), 0..130)));
        let count = keys.len();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), count);
    }
}
