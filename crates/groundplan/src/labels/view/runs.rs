//! Flags and scores in a row: runs of what is alike, and pieces that are the best.

use std::ops::AddAssign;

/// From one on, up to another.
pub type Run = (usize, usize);

/// All maximal pieces with the greatest sums (Ruzzo and Tompa 1999): from, to.
pub fn best_pieces<T: Copy + Default + PartialOrd + AddAssign>(scores: &[T]) -> Vec<(usize, usize)> {
    struct Piece<T> {
        from: usize,
        to: usize,
        before: T,
        after: T,
        /// The last piece ahead of it that begins at a lower sum.
        lower: Option<usize>,
    }
    let zero = T::default();
    let mut pieces: Vec<Piece<T>> = Vec::new();
    let (mut n, mut sum) = (0, zero);
    while n < scores.len() {
        let (from, before) = (n, sum);
        while n < scores.len() && scores[n] > zero {
            sum += scores[n];
            n += 1;
        }
        if n == from {
            sum += scores[n];
            n += 1;
            continue;
        }
        let mut piece = Piece { from, to: n, before, after: sum, lower: pieces.len().checked_sub(1) };
        while let Some(place) = piece.lower {
            let other = &pieces[place];
            if other.before < piece.before {
                if other.after >= piece.after {
                    break;
                }
                (piece.from, piece.before, piece.lower) = (other.from, other.before, other.lower);
                pieces.truncate(place);
            } else {
                piece.lower = other.lower;
            }
        }
        pieces.push(piece);
    }
    pieces.into_iter().map(|piece| (piece.from, piece.to)).collect()
}

/// Fills gaps of up to `longest` between set flags.
pub fn close(flags: &mut [bool], longest: usize) {
    let mut gap = next(flags, next(flags, 0, true), false);
    while gap < flags.len() {
        let end = next(flags, gap, true);
        if end < flags.len() && end - gap <= longest {
            flags[gap..end].fill(true);
        }
        gap = next(flags, end, false);
    }
}

/// Runs of flags that are `wanted`: from, to.
pub fn runs(flags: &[bool], wanted: bool) -> Vec<Run> {
    let mut found = Vec::new();
    let mut from = next(flags, 0, wanted);
    while from < flags.len() {
        let to = next(flags, from, !wanted);
        found.push((from, to));
        from = next(flags, to, wanted);
    }
    found
}

/// What two lists of runs, each in order, have in common.
pub fn common(one: &[Run], two: &[Run]) -> Vec<Run> {
    let mut found = Vec::new();
    let (mut n, mut m) = (0, 0);
    while n < one.len() && m < two.len() {
        let (from, to) = (one[n].0.max(two[m].0), one[n].1.min(two[m].1));
        if from < to {
            found.push((from, to));
        }
        if one[n].1 < two[m].1 {
            n += 1;
        } else {
            m += 1;
        }
    }
    found
}

/// What of some runs lies outside others, all in the order of their beginnings; of the others some may overlap.
pub fn outside(some: &[Run], others: &[Run]) -> Vec<Run> {
    let (mut found, mut next) = (Vec::new(), 0);
    for &(mut from, to) in some {
        while others.get(next).is_some_and(|other| other.1 <= from) {
            next += 1;
        }
        for other in others[next..].iter().take_while(|other| other.0 < to) {
            if from < other.0 {
                found.push((from, other.0));
            }
            from = from.max(other.1);
        }
        if from < to {
            found.push((from, to));
        }
    }
    found
}

/// How many flags are in some runs.
pub fn length(runs: impl IntoIterator<Item = Run>) -> usize {
    runs.into_iter().map(|(from, to)| to - from).sum()
}

/// The next flag that is `wanted`, from one on, or the end.
fn next(flags: &[bool], from: usize, wanted: bool) -> usize {
    // Many at a time: mostly they are alike.
    const MANY: usize = 32;
    let mut at = from;
    for chunk in flags[from..].chunks_exact(MANY) {
        if chunk.contains(&wanted) {
            break;
        }
        at += MANY;
    }
    flags[at..].iter().position(|&flag| flag == wanted).map_or(flags.len(), |n| at + n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_runs_have_in_common_and_what_lies_outside_is_as_flags_say() {
        for seed in 0..500u64 {
            let flags = |n: u64| -> Vec<bool> {
                let bits = (seed * 2 + n + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
                (0..40).map(|place| bits >> (20 + place) & (bits >> (3 + place)) & 1 == n).collect()
            };
            let (one, two) = (flags(0), flags(1));
            let together = |is: fn(bool, bool) -> bool| -> Vec<bool> {
                one.iter().zip(&two).map(|(one, two)| is(*one, *two)).collect()
            };
            let [own, others] = [&one, &two].map(|flags| runs(flags, true));
            assert_eq!(common(&own, &others), runs(&together(|one, two| one && two), true));
            assert_eq!(outside(&own, &others), runs(&together(|one, two| one && !two), true));
        }
        assert_eq!(outside(&[(0, 9)], &[(1, 4), (3, 6)]), [(0, 1), (6, 9)]);
    }
}
