//! Flags and scores in a row: runs of what is alike, and pieces that are the best.

use std::ops::AddAssign;

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
pub fn runs(flags: &[bool], wanted: bool) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut from = next(flags, 0, wanted);
    while from < flags.len() {
        let to = next(flags, from, !wanted);
        found.push((from, to));
        from = next(flags, to, wanted);
    }
    found
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
