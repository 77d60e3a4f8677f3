//! II-B: peaks of the radiograms -> lines; III: the resolution knob over them.

use crate::bands::map_each;
use crate::grid::tidy;
use crate::parameters::Parameters;
use crate::radiograms::Radiogram;
use crate::wavelets::{self, Peak};

/// Lines right across the map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lines {
    /// Index of each line's direction.
    pub directions: Vec<u32>,
    /// Offset along the direction's normal (-sin, cos), metres in the map frame; ascending within a direction.
    pub offsets: Vec<f64>,
    /// Metres of structure that lie on the line.
    pub amplitudes: Vec<f64>,
    /// How well it lines up: the width (sigma) of the peak, metres.
    pub widths: Vec<f64>,
    /// Least amplitude of a peak that was let through, metres: what the resolution knob came to.
    pub min_amplitude: f64,
}

/// One of them: its direction, offset, amplitude and width.
pub(crate) type Line = (u32, f64, f64, f64);

impl Lines {
    /// Of some in any order.
    pub(crate) fn of(mut all: Vec<Line>, min_amplitude: f64) -> Self {
        all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        Self {
            directions: all.iter().map(|line| line.0).collect(),
            offsets: all.iter().map(|line| line.1).collect(),
            amplitudes: all.iter().map(|line| line.2).collect(),
            widths: all.iter().map(|line| line.3).collect(),
            min_amplitude,
        }
    }

    /// Each of them.
    pub(crate) fn each(&self) -> impl Iterator<Item = Line> {
        (0..self.len()).map(|n| (self.directions[n], self.offsets[n], self.amplitudes[n], self.widths[n]))
    }

    /// How many.
    #[must_use]
    pub fn len(&self) -> usize {
        self.offsets.len()
    }

    /// What a strong line has: half of all structure lies on lines at least as strong, metres.
    #[must_use]
    pub fn typical_amplitude(&self) -> f64 {
        reaching(&self.amplitudes, 0.5)
    }

    /// True when there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.offsets.is_empty()
    }
}

/// Wavelets of one to twenty pixels, as the paper found sufficient.
const WIDTHS_PIXELS: (f64, f64) = (1.0, 20.0);
/// Lines are kept until this share of all that stands out is explained, unless a detail is asked for.
const EXPLAINED: f64 = 0.97;
/// Where all lines stand out, the least of them are no noise: what has so much of a typical line, and so many metres, is
/// kept all the same, such as the ends of a few rows.
pub(crate) const SHORT: (f64, f64) = (0.02, 2.0);
/// Detail 1 lets through a line with this share of what the strongest lines have.
const FINEST: f64 = 0.01;

/// Finds the lines of all radiograms.
#[must_use]
pub fn find_lines(radiograms: &[Radiogram], parameters: &Parameters, threads: usize) -> Lines {
    let found = map_each(radiograms.len(), threads, |n| lines_of(&radiograms[n], parameters));
    let mut found = found.concat();
    let amplitudes: Vec<f64> = found.iter().map(|f| f.2).collect();
    let least = least_amplitude(&amplitudes, parameters);
    found.retain(|f| f.2 >= least);
    Lines::of(found, least)
}

/// The lines of one radiogram.
fn lines_of(radiogram: &Radiogram, parameters: &Parameters) -> Vec<Line> {
    let signal = &radiogram.values;
    let peaks = wavelets::peaks(&respond(radiogram, parameters), parameters.lines_snr);
    let line = |(n, peak): (usize, &Peak)| {
        // A line's structure reaches half way to its neighbours at most.
        let before = n.checked_sub(1).map_or(0, |m| usize::midpoint(peaks[m].bin, peak.bin + 1));
        let after = peaks.get(n + 1).map_or(signal.len(), |next| usize::midpoint(peak.bin, next.bin) + 1);
        let (place, amplitude) = measure(signal, peak, before..after);
        let offset = radiogram.start + place * radiogram.step;
        (radiogram.direction as u32, tidy(offset), tidy(amplitude), tidy(peak.width * radiogram.step))
    };
    peaks.iter().enumerate().map(line).collect()
}

/// The wavelet response that a radiogram's peaks are read from.
#[must_use]
pub fn respond(radiogram: &Radiogram, parameters: &Parameters) -> wavelets::Response {
    let bins = |metres: Option<f64>, pixels: f64| metres.map_or(pixels, |m| (m / radiogram.step).max(0.5));
    let low = bins(parameters.lines_min_width, WIDTHS_PIXELS.0);
    let high = bins(parameters.lines_max_width, WIDTHS_PIXELS.1).max(low);
    wavelets::transform(&radiogram.values, &wavelets::widths(low, high))
}

/// A peak's centre in bins and its metres of structure, above the lower of its two flanks; within some bins.
fn measure(signal: &[f64], peak: &Peak, within: std::ops::Range<usize>) -> (f64, f64) {
    let reach = (1.5 * peak.width).round().clamp(1.0, 4.0) as usize;
    let from = peak.bin.saturating_sub(reach).max(within.start).min(peak.bin);
    let to = (peak.bin + reach + 1).min(within.end).max(peak.bin + 1);
    let base = signal[from].min(signal[to - 1]);
    let (mut sum, mut moment) = (0.0, 0.0);
    for (n, value) in signal[from..to].iter().enumerate() {
        let above = (value - base).max(0.0);
        sum += above;
        moment += above * (from + n) as f64;
    }
    (if sum > 0.0 { moment / sum } else { peak.bin as f64 }, sum)
}

/// The resolution knob: the least amplitude of a line.
fn least_amplitude(amplitudes: &[f64], parameters: &Parameters) -> f64 {
    match (parameters.lines_min_amplitude, parameters.lines_detail) {
        (Some(metres), _) => metres,
        (None, Some(detail)) => reaching(amplitudes, 0.5) * libm::pow(FINEST, detail),
        (None, None) => {
            let short = SHORT.1.max(SHORT.0 * reaching(amplitudes, 0.5));
            reaching(amplitudes, EXPLAINED).min(short)
        }
    }
}

/// The amplitude down to which lines together hold a share of all structure on lines.
fn reaching(amplitudes: &[f64], share: f64) -> f64 {
    let mut amplitudes = amplitudes.to_vec();
    amplitudes.sort_by(|a, b| b.total_cmp(a));
    let total: f64 = amplitudes.iter().sum();
    let mut sum = 0.0;
    let enough = |a: &f64| {
        sum += *a;
        sum >= share * total
    };
    amplitudes.into_iter().find(enough).unwrap_or(0.0)
}
