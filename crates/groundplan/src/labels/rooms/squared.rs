//! From how far it is within each column to how far it is at all: the lower envelope of parabolas along each row (Meijster,
//! Roerdink and Hesselink 2000).

/// Where squares fit in 16 bits so many pixels side by side are looked at together: what lies so many steps more to either
/// side, before it is asked whether something farther off may be nearer. Beyond the last of these numbers nothing is.
const LANES: usize = 32;
const STEPS: usize = 4;
const FARTHEST: usize = 46 * STEPS;
/// The square of a greater height does not fit.
const HIGHEST: u16 = 181;

/// Room for what is made of a row.
pub struct Squared {
    /// The squares of heights, with zeros at both ends: what is not free is zero, and what lies beyond it never the nearest.
    squares: Vec<i16>,
    seats: Vec<(i64, i64)>,
}

impl Squared {
    /// For rows of so many pixels.
    pub fn new(width: usize) -> Self {
        Self { squares: vec![0; FARTHEST + width + LANES + FARTHEST], seats: Vec::new() }
    }

    /// From the heights of a row to the squared distances, which are put to what is there.
    pub fn row(&mut self, heights: &[u16], squared: &mut Vec<u32>) {
        let start = squared.len();
        let top = self.low(heights, squared);
        // With heights that are cut off what is less than the square of these is right.
        if top < HIGHEST * HIGHEST || heights.iter().all(|&height| height <= HIGHEST) {
            return;
        }
        // Within a run of free pixels only the run and its two ends count.
        let mut next = 1;
        while let Some(before) = heights[next..].iter().position(|height| *height != 0) {
            let from = next + before;
            let end = heights[from..].iter().position(|height| *height == 0).map_or(heights.len() - 1, |n| from + n);
            envelope(&heights[from - 1..=end], &mut squared[start + from - 1..=start + end], &mut self.seats);
            next = end + 1;
        }
    }

    /// The same where squares fit in 16 bits, greater heights cut off: of each pixel its own square, or what lies to either
    /// side, as long as something so far off can be nearer. And the greatest.
    fn low(&mut self, heights: &[u16], squared: &mut Vec<u32>) -> u16 {
        // The zeros at both ends reach as far as is looked: no chunk is ever cut short.
        for (to, &height) in self.squares[FARTHEST..].iter_mut().zip(heights) {
            *to = height.min(HIGHEST).pow(2) as i16;
        }
        let most = |least: &[i16; LANES]| least.iter().fold(0, |most, &own| most.max(own)) as usize;
        let mut top = 0;
        for from in (0..heights.len()).step_by(LANES) {
            let at = FARTHEST + from;
            let Some(mut least) = self.squares[at..].first_chunk::<LANES>().copied() else { break };
            let mut off = 1;
            while off * off < most(&least) {
                let near = [at + 1 - off - STEPS, at + off].map(|from| self.squares[from..].first_chunk());
                let [Some(left), Some(right)]: [Option<&[i16; LANES + STEPS - 1]>; 2] = near else { break };
                let squares: [i16; STEPS] =
                    std::array::from_fn(|step| i16::try_from((off + step).pow(2)).unwrap_or(i16::MAX));
                for (n, own) in least.iter_mut().enumerate() {
                    for (step, squared) in squares.into_iter().enumerate() {
                        let near = left[n + STEPS - 1 - step].min(right[n + step]);
                        *own = near.saturating_add(squared).min(*own);
                    }
                }
                off += STEPS;
            }
            top = top.max(most(&least));
            let own = &least[..LANES.min(heights.len() - from)];
            squared.extend(own.iter().map(|&own| own as u32));
        }
        top as u16
    }
}

/// The lower envelope of the parabolas over some heights; `seats` is room for the places of those that are in it, and
/// what each is at zero.
fn envelope(heights: &[u16], squared: &mut [u32], seats: &mut Vec<(i64, i64)>) {
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
            let mut row: Vec<u16> =
                (0..width).map(|_| if next(50) == 0 { 0 } else { 1 + next(top - 1) as u16 }).collect();
            (row[0], row[width - 1]) = (0, 0);
            // And one that is as high as it may be nearly everywhere.
            let mut even = vec![top as u16 - 1; width];
            (even[0], even[width - 1]) = (0, 0);
            let (mut made, mut all) = (Squared::new(width), Vec::new());
            let heights = [row, even];
            for row in &heights {
                made.row(row, &mut all);
            }
            for (row, squared) in heights.iter().zip(all.chunks(width)) {
                let places = || row.iter().enumerate().map(|(x, &height)| (x, u32::from(height).pow(2)));
                let least = |x: usize| places().map(|(other, square)| square + x.abs_diff(other).pow(2) as u32).min();
                assert!(squared.iter().enumerate().all(|(x, own)| least(x) == Some(*own)), "{width} {top}");
            }
        }
    }
}
