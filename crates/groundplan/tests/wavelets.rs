//! Peaks do not know where the signal starts or which way it runs.

use groundplan::wavelets::{Peak, peaks, transform, widths};

fn found(signal: &[f64]) -> Vec<Peak> {
    peaks(&transform(signal, &widths(1.0, 20.0)), 3.0)
}

/// A floor of noise with peaks of several widths, and nothing for as far as a wavelet reaches at both ends.
fn signal(seed: u64, peaks: &[(f64, f64, f64)]) -> Vec<f64> {
    // Noise enough like chance, the same everywhere.
    let noise = |n: f64| (43_758.545 * libm::sin(n * 12.9898 + seed as f64 * 78.233)).rem_euclid(1.0) * 0.2;
    let at =
        |n: f64| peaks.iter().map(|(bin, high, wide)| high * (-0.5 * ((n - bin) / wide).powi(2)).exp()).sum::<f64>();
    (0..900).map(|n| if (110..790).contains(&n) { noise(f64::from(n)) + at(f64::from(n)) } else { 0.0 }).collect()
}

const PEAKS: &[(f64, f64, f64)] = &[(120.3, 10.0, 1.2), (300.7, 8.0, 2.5), (340.2, 12.0, 1.0), (700.4, 20.0, 4.0)];

#[test]
fn peaks_are_found_where_they_are() {
    let strong: Vec<Peak> = found(&signal(1, PEAKS)).into_iter().filter(|p| p.response > 8.0).collect();
    assert_eq!(strong.len(), PEAKS.len());
    for (peak, (bin, _, _)) in strong.iter().zip(PEAKS) {
        assert!((peak.bin as f64 - bin).abs() <= 1.0, "{} and not {bin}", peak.bin);
    }
    assert!(strong[3].width > strong[2].width);
}

#[test]
fn a_shifted_signal_has_its_peaks_shifted() {
    for seed in 0..20 {
        let signal = signal(seed, PEAKS);
        let shift = 1 + 7 * seed as usize;
        let mut shifted = vec![0.0; shift];
        shifted.extend(&signal);
        let moved: Vec<Peak> = found(&signal).into_iter().map(|p| Peak { bin: p.bin + shift, ..p }).collect();
        assert_eq!(found(&shifted), moved, "seed {seed}");
    }
}

#[test]
fn a_signal_turned_about_has_the_same_strong_peaks() {
    for seed in 0..20 {
        let signal = signal(seed, PEAKS);
        let turned: Vec<f64> = signal.iter().rev().copied().collect();
        let strong = |signal: &[f64]| -> Vec<usize> {
            found(signal).iter().filter(|p| p.response > 8.0).map(|p| p.bin).collect()
        };
        let back: Vec<usize> = strong(&turned).into_iter().rev().map(|bin| signal.len() - 1 - bin).collect();
        assert_eq!(strong(&signal), back, "seed {seed}");
    }
}

#[test]
fn nothing_has_no_peaks() {
    assert_eq!(found(&[]), []);
    assert_eq!(found(&[0.0; 500]), []);
    assert_eq!(found(&[0.0]), []);
}

#[test]
fn one_spike_is_one_peak() {
    let mut signal = vec![0.0; 400];
    signal[200] = 5.0;
    let bins: Vec<usize> = found(&signal).iter().map(|p| p.bin).collect();
    assert_eq!(bins, [200]);
}
