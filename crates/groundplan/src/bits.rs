//! Bits in words: a bit for each pixel, row after row without gaps.

use std::ops::Range;

/// Pixels that are looked at together.
pub const WORD: usize = 64;

/// A set of pixels.
#[derive(Clone, Default)]
pub struct Bits(Vec<u64>);

impl Bits {
    /// So many pixels, none of them in the set.
    pub fn new(pixels: usize) -> Self {
        // One word more: what begins in the last one is read across its end.
        Self(vec![0; pixels / WORD + 2])
    }

    pub fn get(&self, pixel: usize) -> bool {
        self.0[pixel / WORD] >> (pixel % WORD) & 1 == 1
    }

    pub fn insert(&mut self, pixel: usize) {
        self.0[pixel / WORD] |= 1 << (pixel % WORD);
    }

    /// The pixels from one on, the first in the lowest bit.
    pub fn word(&self, pixel: usize) -> u64 {
        let (word, shift) = (pixel / WORD, pixel % WORD);
        let above = if shift == 0 { 0 } else { self.0[word + 1] << (WORD - shift) };
        self.0[word] >> shift | above
    }

    /// Adds the lowest bits of a word, from a pixel on.
    pub fn add(&mut self, pixel: usize, bits: u64) {
        let (word, shift) = (pixel / WORD, pixel % WORD);
        self.0[word] |= bits << shift;
        if shift != 0 {
            self.0[word + 1] |= bits >> (WORD - shift);
        }
    }

    /// Adds pixels one after another.
    pub fn fill(&mut self, pixels: Range<usize>) {
        for at in pixels.clone().step_by(WORD) {
            self.add(at, lowest(pixels.end - at));
        }
    }

    /// How many of some pixels are in the set.
    pub fn count(&self, pixels: Range<usize>) -> usize {
        let ones = |at: usize| (self.word(at) & lowest(pixels.end - at)).count_ones() as usize;
        pixels.clone().step_by(WORD).map(ones).sum()
    }

    /// Runs of pixels in the set among some pixels, each going on over so many that are not.
    pub fn joined(&self, pixels: Range<usize>, gap: usize) -> Vec<Range<usize>> {
        let mut joined: Vec<Range<usize>> = Vec::new();
        for run in self.runs(pixels, true) {
            match joined.last_mut() {
                Some(last) if run.start - last.end <= gap => last.end = run.end,
                _ => joined.push(run),
            }
        }
        joined
    }

    /// Runs of pixels in the set, or of those that are not, among some pixels.
    pub fn runs(&self, pixels: Range<usize>, wanted: bool) -> impl Iterator<Item = Range<usize>> + '_ {
        runs(&self.0, pixels, wanted)
    }
}

/// Runs of bits that are set, or of those that are not, among some bits; none is set beyond the last word.
pub fn runs(words: &[u64], bits: Range<usize>, wanted: bool) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut at = bits.start;
    std::iter::from_fn(move || {
        let from = next(words, at, bits.end, wanted);
        at = next(words, from, bits.end, !wanted);
        (from < at).then_some(from..at)
    })
}

/// The next bit that is set, or that is not, from one on; or the end.
fn next(words: &[u64], mut at: usize, end: usize, wanted: bool) -> usize {
    while at < end {
        let word = words.get(at / WORD).copied().unwrap_or(0) ^ if wanted { 0 } else { u64::MAX };
        let ahead = (word >> (at % WORD)).trailing_zeros() as usize;
        if ahead < WORD {
            return (at + ahead).min(end);
        }
        at = (at / WORD + 1) * WORD;
    }
    end
}

/// So many of a word's lowest bits.
pub fn lowest(count: usize) -> u64 {
    if count >= WORD { u64::MAX } else { (1 << count) - 1 }
}

/// A bit for each of up to [`WORD`] pixels, mostly alike eight by eight: whether it is of the values that are wanted.
pub fn word_of(pixels: &[u8], wanted: &[bool; 256]) -> u64 {
    pixels.chunks(8).rev().fold(0, |word, eight| {
        let bit = |pixel: u8| u64::from(wanted[usize::from(pixel)]);
        let alike = <[u8; 8]>::try_from(eight).is_ok_and(|eight| eight == [eight[0]; 8]);
        let bits = if alike { 255 * bit(eight[0]) } else { eight.iter().rev().fold(0, |bits, &p| bits << 1 | bit(p)) };
        word << 8 | bits
    })
}
