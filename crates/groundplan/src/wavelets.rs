//! II-B: peaks by continuous wavelet transform with ridge lines, after Du, Kibbe and Lin (2006).

/// Responses of a signal to Ricker wavelets of several widths.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// Widths (sigma) of the wavelets, bins, ascending.
    pub widths: Vec<f64>,
    /// `rows[w][n]`: response to width w at bin n.
    pub rows: Vec<Vec<f64>>,
}

/// A peak that holds through several widths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Bin of the peak at the narrowest width of its ridge.
    pub bin: usize,
    /// Width (sigma) at which the ridge responds most, bins.
    pub width: f64,
    /// That greatest response.
    pub response: f64,
    /// Greatest response over the noise around.
    pub snr: f64,
}

/// Beyond this many sigmas a Ricker wavelet is nothing.
const REACH_SIGMAS: f64 = 5.0;
/// Widths from one to the next grow by this factor.
const WIDTH_FACTOR: f64 = 1.25;
/// A ridge may miss this many widths in a row.
const MOST_GAPS: usize = 1;
/// A ridge holds through at least this many widths, or all when there are fewer.
const SHORTEST_RIDGE: usize = 3;
/// A ridge must reach down to one of this many narrowest widths.
const NARROWEST: usize = 5;
/// Half the window in which noise is measured, bins.
const NOISE_BINS: usize = 100;

/// Widths from `low` to `high`, both included, evenly spaced on a logarithmic scale.
#[must_use]
pub fn widths(low: f64, high: f64) -> Vec<f64> {
    let mut all = vec![low];
    while all[all.len() - 1] * WIDTH_FACTOR < high {
        all.push(all[all.len() - 1] * WIDTH_FACTOR);
    }
    if high > low {
        all.push(high);
    }
    all
}

/// The continuous wavelet transform of `signal` with Ricker wavelets of unit energy.
#[must_use]
pub fn transform(signal: &[f64], widths: &[f64]) -> Response {
    let some: Vec<(usize, f64)> = signal.iter().copied().enumerate().filter(|(_, value)| *value != 0.0).collect();
    let rows = widths.iter().map(|&width| convolve(signal.len(), &some, &ricker(width))).collect();
    Response { widths: widths.to_vec(), rows }
}

/// Right half of a Ricker wavelet, its middle first.
fn ricker(sigma: f64) -> Vec<f64> {
    let norm = 2.0 / ((3.0 * sigma).sqrt() * std::f64::consts::PI.sqrt().sqrt());
    let reach = (REACH_SIGMAS * sigma).ceil() as usize;
    let mut half: Vec<f64> = (0..=reach)
        .map(|n| {
            let t = (n as f64 / sigma).powi(2);
            norm * (1.0 - t) * libm::exp(-0.5 * t)
        })
        .collect();
    // A sampled narrow wavelet does not quite sum to zero; a flat signal must give no response.
    let sum = half[0] + 2.0 * half[1..].iter().sum::<f64>();
    let weight: f64 = 1.0 + 2.0 * (1..=reach).map(|n| libm::exp(-0.5 * (n as f64 / sigma).powi(2))).sum::<f64>();
    for (n, value) in half.iter_mut().enumerate() {
        *value -= sum / weight * libm::exp(-0.5 * (n as f64 / sigma).powi(2));
    }
    half
}

/// Values of a convolution that are made together.
const TOGETHER: usize = 16;

/// Convolution of so many values, of which those that are not zero are given with their places, with a symmetric kernel
/// given by its right half; beyond the ends the signal is zero.
fn convolve(count: usize, signal: &[(usize, f64)], half: &[f64]) -> Vec<f64> {
    let reach = half.len() - 1;
    // With zeros at both ends, so that of values made together each finds its part.
    let (left, beyond) = (half[1..].iter().rev().copied(), [0.0; TOGETHER]);
    let kernel: Vec<f64> = beyond.into_iter().chain(left).chain(half.iter().copied()).chain(beyond).collect();
    let mut out = vec![0.0; count];
    let (mut from, mut to) = (0, 0);
    for (first, some) in (0usize..).step_by(TOGETHER).zip(out.chunks_mut(TOGETHER)) {
        while signal.get(from).is_some_and(|(n, _)| n + reach < first) {
            from += 1;
        }
        while signal.get(to).is_some_and(|(n, _)| *n < first + TOGETHER + reach) {
            to += 1;
        }
        let mut sums = [0.0; TOGETHER];
        for &(n, value) in &signal[from..to] {
            let start = first + TOGETHER + reach - n;
            for (sum, k) in sums.iter_mut().zip(&kernel[start..start + TOGETHER]) {
                *sum += value * k;
            }
        }
        some.copy_from_slice(&sums[..some.len()]);
    }
    out
}

/// A ridge line: local maxima that follow one another from wide to narrow.
struct Ridge {
    bin: usize,
    points: usize,
    gaps: usize,
    row: usize,
    best: (f64, usize),
}

/// Peaks whose ridge lines hold through the widths and whose response exceeds the noise around them by `snr`,
/// in the order of their bins.
#[must_use]
pub fn peaks(response: &Response, snr: f64) -> Vec<Peak> {
    let Some(narrow) = response.rows.first() else {
        return Vec::new();
    };
    let noise = noise(narrow);
    let shortest = SHORTEST_RIDGE.min(response.rows.len());
    let mut found: Vec<Peak> = ridges(response)
        .into_iter()
        .filter(|ridge| ridge.points >= shortest && ridge.row < NARROWEST)
        .map(|ridge| {
            let (value, row) = ridge.best;
            let floor = noise[ridge.bin].max(f64::MIN_POSITIVE);
            Peak { bin: ridge.bin, width: response.widths[row], response: value, snr: value / floor }
        })
        .filter(|peak| peak.snr >= snr)
        .collect();
    found.sort_by_key(|peak| peak.bin);
    found.dedup_by_key(|peak| peak.bin);
    found
}

fn ridges(response: &Response) -> Vec<Ridge> {
    let mut open: Vec<Ridge> = Vec::new();
    let mut closed = Vec::new();
    for row in (0..response.rows.len()).rev() {
        let values = &response.rows[row];
        let reach = (response.widths[row] * 0.75).ceil() as usize;
        let maxima: Vec<usize> = (0..values.len())
            .filter(|&n| {
                let left = if n == 0 { 0.0 } else { values[n - 1] };
                let right = values.get(n + 1).copied().unwrap_or(0.0);
                values[n] > 0.0 && values[n] > left && values[n] >= right
            })
            .collect();
        let mut free = vec![true; maxima.len()];
        for ridge in &mut open {
            // The nearest maximum continues the ridge; the others start ridges of their own.
            let after = maxima.partition_point(|&n| n < ridge.bin);
            let near = [after.checked_sub(1), Some(after)].into_iter().flatten().filter(|&m| m < maxima.len());
            let nearest = near.filter(|&m| free[m]).min_by_key(|&m| maxima[m].abs_diff(ridge.bin));
            match nearest.filter(|&m| maxima[m].abs_diff(ridge.bin) <= reach) {
                Some(m) => {
                    free[m] = false;
                    (ridge.bin, ridge.row, ridge.gaps) = (maxima[m], row, 0);
                    ridge.points += 1;
                    if values[maxima[m]] > ridge.best.0 {
                        ridge.best = (values[maxima[m]], row);
                    }
                }
                None => ridge.gaps += 1,
            }
        }
        let (ended, going): (Vec<Ridge>, Vec<Ridge>) = open.into_iter().partition(|ridge| ridge.gaps > MOST_GAPS);
        closed.extend(ended);
        open = going;
        open.extend(maxima.iter().zip(&free).filter(|(_, free)| **free).map(|(&bin, _)| Ridge {
            bin,
            points: 1,
            gaps: 0,
            row,
            best: (values[bin], row),
        }));
        open.sort_by_key(|ridge| ridge.bin);
    }
    closed.extend(open);
    closed
}

/// Noise at each bin: the median of the narrowest response's magnitude around it. Where most of the surroundings are
/// empty, a part of the median of all that is not stands in. The window is centred on each bin and nothing lies beyond
/// the ends, so that a signal shifted or turned about has its noise shifted and turned about.
fn noise(narrow: &[f64]) -> Vec<f64> {
    let magnitudes: Vec<f64> = narrow.iter().map(|v| v.abs()).collect();
    let mut some: Vec<f64> = magnitudes.iter().copied().filter(|v| *v > 0.0).collect();
    let middle = some.len() / 2;
    let least = if some.is_empty() { 0.0 } else { 0.25 * *some.select_nth_unstable_by(middle, f64::total_cmp).1 };
    let mut window: Vec<f64> = vec![0.0; 2 * NOISE_BINS + 1];
    let mut exchange = |gone: f64, come: f64| {
        let [from, to] = [gone, come].map(|value| window.partition_point(|v| *v < value));
        // Only what lies between the two moves.
        if from < to {
            window.copy_within(from + 1..to, from);
            window[to - 1] = come;
        } else {
            window.copy_within(to..from, to + 1);
            window[to] = come;
        }
        window[NOISE_BINS]
    };
    let at = |n: usize| magnitudes.get(n).copied().unwrap_or(0.0);
    for n in 0..NOISE_BINS {
        exchange(0.0, at(n));
    }
    (0..magnitudes.len())
        .map(|n| exchange(n.checked_sub(NOISE_BINS + 1).map_or(0.0, at), at(n + NOISE_BINS)).max(least))
        .collect()
}
