//! What was found before: where the map and the lines have not changed, what was found from them holds.
//!
//! What a strip or a part of the map is made from is summed up in a key of 128 bits, and what was found is kept by it.
//! A survey looks into what another one kept before it looks at the pixels, so the answer is the same with and without.

use super::corridors::Strip;
use super::ragged::Held;
use super::rooms::{Bar, Width};
use super::squares::Band;
use super::sums::Told;
use crate::bits::Bits;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// What something was made from, in 128 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
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

    pub fn key(self, other: Self) -> Self {
        self.with(other.0 as u64).with((other.0 >> 64) as u64)
    }

    pub fn bytes(self, bytes: &[u8]) -> Self {
        let chunks = bytes.chunks_exact(8);
        let rest = chunks.remainder().iter().fold(0, |word, &byte| word << 8 | u64::from(byte));
        let word = |chunk: &[u8]| chunk.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
        chunks.fold(self.with(bytes.len() as u64), |key, chunk| key.with(word(chunk))).with(rest)
    }

    pub fn bits(self, bits: &Bits) -> Self {
        bits.words().iter().fold(self.with(bits.words().len() as u64), |key, &word| key.with(word))
    }
}

/// Rows of a view, and what is told of each.
type SeenRows = (Arc<Band>, Vec<Told>);

/// What was found, by what it was found from.
type Known<T> = Arc<BTreeMap<Key, T>>;

/// What a survey found and keeps for another one of the same parameters.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    /// Pieces of a strip between two lines, and whether they are corridors.
    strips: Known<Vec<(Strip, bool)>>,
    ragged: Known<Vec<(Strip, Held)>>,
    narrows: Known<Vec<Bar>>,
    /// Of runs of the free space along rows.
    widths: Known<Vec<Width>>,
    /// Rows of views.
    views: Known<SeenRows>,
}

/// What is known from before, and what is kept for later.
#[derive(Debug, Default)]
pub struct Recall {
    pub(super) strips: Found<Vec<(Strip, bool)>>,
    pub(super) ragged: Found<Vec<(Strip, Held)>>,
    pub(super) narrows: Found<Vec<Bar>>,
    pub(super) widths: Found<Vec<Width>>,
    pub(super) views: Found<SeenRows>,
}

impl Recall {
    /// With a memory, be it empty, all that is found is kept; without one nothing is.
    #[must_use]
    pub fn new(memory: Option<Memory>) -> Self {
        memory.map_or_else(Self::default, |known| Self {
            strips: Found::new(known.strips),
            ragged: Found::new(known.ragged),
            narrows: Found::new(known.narrows),
            widths: Found::new(known.widths),
            views: Found::new(known.views),
        })
    }

    /// True when what is found is kept, so that it has keys.
    #[must_use]
    pub fn keeps(&self) -> bool {
        self.strips.now.is_some()
    }

    /// What was found this time, and nothing else.
    #[must_use]
    pub fn memory(self) -> Memory {
        Memory {
            strips: self.strips.known(),
            ragged: self.ragged.known(),
            narrows: self.narrows.known(),
            widths: self.widths.known(),
            views: self.views.known(),
        }
    }
}

#[derive(Debug)]
pub(super) struct Found<T> {
    before: Known<T>,
    now: Option<Mutex<BTreeMap<Key, T>>>,
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
        let Some(now) = &self.now else { return find() };
        let key = key();
        let found = self.before.get(&key).cloned().unwrap_or_else(find);
        now.lock().unwrap_or_else(PoisonError::into_inner).insert(key, found.clone());
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        keys.extend((0..130).map(|n| Key::default().bits(&only(n))));
        let count = keys.len();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), count);
    }
}
