//! Bits in words: a bit for each pixel, row after row without gaps, or for each column of a strip.

use std::ops::{BitAnd, BitOrAssign, Range};

/// Pixels that are looked at together.
pub const WORD: usize = 64;

/// A set of pixels.
#[derive(Clone, Debug, Default)]
pub struct Bits(Vec<u64>);

impl Bits {
    /// So many pixels, none of them in the set.
    pub fn new(pixels: usize) -> Self {
        // One word more: what begins in the last one is read across its end.
        Self(vec![0; pixels / WORD + 2])
    }

    /// The places of those of some values that are as asked for.
    pub fn of<T>(values: &[T], is: impl Fn(&T) -> bool) -> Self {
        let mut words: Vec<u64> = values.chunks(WORD).map(|some| word_where(some.iter().map(&is))).collect();
        words.resize(values.len() / WORD + 2, 0);
        Self(words)
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

    /// Some pixels as a set of their own.
    pub fn part(&self, pixels: Range<usize>) -> Self {
        let mut part = Self::new(pixels.len());
        let word = |at: usize| self.word(at) & lowest(pixels.end - at);
        pixels.clone().step_by(WORD).zip(&mut part.0).for_each(|(at, to)| *to = word(at));
        part
    }

    /// True when there is a pixel in the set.
    pub fn any(&self) -> bool {
        self.0.iter().any(|word| *word != 0)
    }

    /// Adds what lies between pixels in the set, up to so many, among some pixels.
    pub fn close(&mut self, pixels: Range<usize>, gap: usize) {
        self.joined(pixels, gap).into_iter().for_each(|run| self.fill(run));
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

/// What is in one set or the other, of sets of as many pixels.
impl BitOrAssign<&Self> for Bits {
    fn bitor_assign(&mut self, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(own, other)| *own |= other);
    }
}

/// What is in both sets.
impl BitAnd for &Bits {
    type Output = Bits;

    fn bitand(self, other: Self) -> Bits {
        Bits(self.0.iter().zip(&other.0).map(|(own, other)| own & other).collect())
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

/// A bit for each of up to [`WORD`] flags.
pub fn word_where(flags: impl Iterator<Item = bool>) -> u64 {
    // Compared many at a time, as bytes, of which eight at a time have their lowest bits put side by side.
    let mut bytes = [[0u8; 8]; WORD / 8];
    bytes.as_flattened_mut().iter_mut().zip(flags).for_each(|(byte, flag)| *byte = u8::from(flag));
    bytes.into_iter().rev().fold(0, |word, eight| word << 8 | bits_of(eight))
}

/// A bit for each of eight bytes that are 0 or 1.
pub fn bits_of(eight: [u8; 8]) -> u64 {
    u64::from_le_bytes(eight).wrapping_mul(0x0102_0408_1020_4080) >> 56
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_answer_as_the_flags_they_are_made_of() {
        for count in [0, 1, 63, 64, 65, 200] {
            let is = |n: usize, of: usize| n % of < of / 2;
            let places: Vec<usize> = (0..count).collect();
            let [one, two] = [7, 30].map(|of| Bits::of(&places, |n| is(*n, of)));
            let mut either = one.clone();
            either |= &two;
            let both = &one & &two;
            for n in 0..count {
                assert_eq!([one.get(n), two.get(n)], [is(n, 7), is(n, 30)]);
                assert_eq!([either.get(n), both.get(n)], [is(n, 7) || is(n, 30), is(n, 7) && is(n, 30)]);
            }
            assert_eq!(both.any(), count > 0);
            let part = either.part(count / 3..count);
            assert!((count / 3..count).all(|n| part.get(n - count / 3) == either.get(n)));
            assert_eq!(part.count(0..count - count / 3), either.count(count / 3..count));
        }
    }

    #[test]
    fn gaps_that_are_longer_stay_open() {
        let mut bits = Bits::new(200);
        for run in [3..5, 60..70, 74..75, 100..140] {
            bits.fill(run);
        }
        bits.close(0..200, 25);
        assert_eq!(bits.runs(0..200, true).collect::<Vec<_>>(), [3..5, 60..140]);
    }
}
