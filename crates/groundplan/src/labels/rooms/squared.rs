//! From how far it is within each column to how far it is at all: the lower envelope of parabolas along each row (Meijster,
//! Roerdink and Hesselink 2000).

/// Where squares fit in 16 bits so many pixels side by side are looked at together: what lies so many steps more to either
/// side, before it is asked whether something farther off may be nearer. Beyond the last of these numbers nothing is.
const LANES: usize = 32;
const STEPS: usize = 4;
const FARTHEST: usize = 46 * STEPS;

/// From the heights of rows to the squared distances.
pub fn square(rows: &mut [u32], width: usize) {
    let (mut seats, mut heights) = (Vec::new(), Vec::with_capacity(width));
    let mut squares = vec![0; FARTHEST + width + LANES + FARTHEST];
    for row in rows.chunks_mut(width) {
        if square_low(row, &mut squares) {
            continue;
        }
        heights.clear();
        heights.extend_from_slice(row);
        // Within a run of free pixels only the run and its two ends count.
        let mut next = 1;
        while let Some(before) = heights[next..].iter().position(|height| *height != 0) {
            let from = next + before;
            let end = heights[from..].iter().position(|height| *height == 0).map_or(width - 1, |n| from + n);
            envelope(&heights[from - 1..=end], &mut row[from - 1..=end], &mut seats);
            next = end + 1;
        }
    }
}

/// The same of a row whose squares fit in 16 bits, or false: of each pixel its own square, or what lies to either side, as
/// long as something so far off can be nearer. `squares` is room for theirs, with zeros at both ends: what is not free is
/// zero, and what lies beyond it never the nearest.
fn square_low(row: &mut [u32], squares: &mut [i16]) -> bool {
    if row.iter().fold(0, |bits, height| bits | height) > u8::MAX.into() {
        return false;
    }
    let mut least = 0;
    for (to, &height) in squares[FARTHEST..].iter_mut().zip(&*row) {
        *to = (height as i16).wrapping_mul(height as i16);
        least = least.min(*to);
    }
    if least < 0 {
        return false;
    }
    for (n, to) in row.chunks_mut(LANES).enumerate() {
        let at = FARTHEST + n * LANES;
        let mut least = [0; LANES];
        least.copy_from_slice(&squares[at..at + LANES]);
        let mut off = 1;
        while off * off < least.iter().fold(0, |most, &own| most.max(own)) as usize {
            let near = &squares[at + 1 - off - STEPS..at - 1 + off + STEPS + LANES];
            for step in 0..STEPS {
                let (left, right) = (&near[STEPS - 1 - step..][..LANES], &near[2 * off + STEPS - 1 + step..][..LANES]);
                let squared = i16::try_from((off + step).pow(2)).unwrap_or(i16::MAX);
                for ((own, left), right) in least.iter_mut().zip(left).zip(right) {
                    *own = (*left).min(*right).saturating_add(squared).min(*own);
                }
            }
            off += STEPS;
        }
        to.iter_mut().zip(least).for_each(|(to, own)| *to = own as u32);
    }
    true
}

/// The lower envelope of the parabolas over some heights; `seats` is room for the places of those that are in it, and
/// what each is at zero.
fn envelope(heights: &[u32], squared: &mut [u32], seats: &mut Vec<(i64, i64)>) {
    seats.clear();
    for (x, &height) in heights.iter().enumerate() {
        let (x, height) = (x as i64, i64::from(height));
        let own = (x, x * x + height * height);
        // One is in it as long as it is below both its neighbours where they meet.
        while let [.., before, last] = seats[..]
            && (last.1 - before.1) * (own.0 - last.0) >= (own.1 - last.1) * (last.0 - before.0)
        {
            seats.pop();
        }
        seats.push(own);
    }
    // Each is followed from pixel to pixel: its square, and how much the next one is more.
    let at = |&(seat, zero): &(i64, i64), x: i64| (zero - 2 * seat * x + x * x, 2 * (x - seat) + 1);
    let mut seats = seats.iter();
    let Some((mut own, mut more)) = seats.next().map(|seat| at(seat, 0)) else { return };
    let mut after = seats.next().map(|seat| at(seat, 0));
    for (x, to) in (0..).zip(squared) {
        while let Some((square, step)) = after.filter(|after| after.0 < own) {
            (own, more) = (square, step);
            after = seats.next().map(|seat| at(seat, x));
        }
        *to = own as u32;
        (own, more) = (own + more, more + 2);
        after = after.map(|(square, step)| (square + step, step + 2));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_squared_as_if_every_pixel_were_held_against_all_others() {
        let mut random = 7u32;
        let mut next = |below: u32| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 8) % below
        };
        // From low rows to those whose squares do not fit in 16 bits.
        for (width, top) in [(40, 4), (500, 40), (500, 182), (700, 183), (700, 256), (700, 400), (35, 1000)] {
            let mut row: Vec<u32> = (0..width).map(|_| if next(50) == 0 { 0 } else { 1 + next(top - 1) }).collect();
            (row[0], row[width - 1]) = (0, 0);
            // And one that is as high as it may be nearly everywhere.
            let mut even = vec![top - 1; width];
            (even[0], even[width - 1]) = (0, 0);
            let heights = [row, even];
            let mut squared = heights.concat();
            square(&mut squared, width);
            for (row, squared) in heights.iter().zip(squared.chunks(width)) {
                let places = || row.iter().enumerate().map(|(x, height)| (x, height.pow(2)));
                let least = |x: usize| places().map(|(other, square)| square + x.abs_diff(other).pow(2) as u32).min();
                assert!(squared.iter().enumerate().all(|(x, own)| least(x) == Some(*own)), "{width} {top}");
            }
        }
    }
}
