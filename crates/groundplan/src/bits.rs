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

    /// So many pixels, as they are in words from the first on.
    pub fn of_words(pixels: usize, all: impl Iterator<Item = u64>) -> Self {
        let mut words = Vec::with_capacity(pixels / WORD + 2);
        words.extend(all);
        words.resize(pixels / WORD + 2, 0);
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

/// Values of a pixel that are wanted.
pub struct Wanted {
    values: [bool; 256],
    /// The first and how many more, where they follow one another, as they mostly do: many pixels are compared together.
    row: Option<[u8; 2]>,
}

impl Wanted {
    pub fn new(values: [bool; 256]) -> Self {
        let first = values.iter().position(|&is| is);
        let count = values.iter().filter(|is| **is).count();
        let follow = |first: &usize| values[*first..].iter().take_while(|is| **is).count() == count;
        let row = first.filter(follow).map(|first| [first as u8, (count - 1) as u8]);
        Self { values, row }
    }

    /// A bit for each of up to [`WORD`] pixels.
    pub fn word(&self, pixels: &[u8]) -> u64 {
        let Some([first, more]) = self.row else {
            return pixels.iter().rev().fold(0, |word, &p| word << 1 | u64::from(self.values[usize::from(p)]));
        };
        let is = |pixel: &u8| pixel.wrapping_sub(first) <= more;
        // Of a whole word it is known how many there are.
        match pixels.first_chunk::<WORD>() {
            Some(pixels) => word_where(pixels.iter().map(is)),
            None => word_where(pixels.iter().map(is)),
        }
    }

    pub fn holds(&self, pixel: u8) -> bool {
        self.values[usize::from(pixel)]
    }
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
    fn pixels_are_those_of_the_values_that_are_wanted() {
        let row = |from: u8, to: u8| move |value: u8| (from..=to).contains(&value);
        let wanted: [&dyn Fn(u8) -> bool; 6] =
            [&row(1, 0), &row(0, 0), &row(254, 255), &row(17, 90), &row(0, 255), &|value| value % 3 == 1];
        for is in wanted {
            let wanted = Wanted::new(std::array::from_fn(|value| is(value as u8)));
            for count in [0, 1, 63, 64] {
                for start in [0, 60, 200] {
                    let pixels: Vec<u8> = (0..count).map(|n| (start + n) as u8).collect();
                    let word = wanted.word(&pixels);
                    assert!((0..WORD).all(|n| (word >> n & 1 == 1) == (n < pixels.len() && is(pixels[n]))));
                    assert!(pixels.iter().all(|&pixel| wanted.holds(pixel) == is(pixel)));
                }
            }
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
