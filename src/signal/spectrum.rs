//! Spectra of real samples.

use std::cell::RefCell;

use rustfft::algorithm::Radix4;
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftDirection, Length};

use super::tone::Phasor;

thread_local! {
    /// The transform that was made last: records of a campaign are equally long.
    static LAST: RefCell<Option<Radix4<f64>>> = const { RefCell::new(None) };
}

/// Fourier transform in place of samples whose number is a power of two: no planner, whose every
/// algorithm would be compiled here.
fn transform(bins: &mut [Complex64]) {
    LAST.with_borrow_mut(|last| {
        let made = last.take().filter(|made| made.len() == bins.len());
        let made = made.unwrap_or_else(|| Radix4::new(bins.len(), FftDirection::Forward));
        made.process(bins);
        *last = Some(made);
    });
}

/// One-sided power spectrum of the samples in no unit, mean removed, Hann window, zero-padded to twice
/// the next power of two: (frequency step in units of the sample rate, squares of the amplitudes).
fn power_spectrum(samples: &[f64]) -> (f64, Vec<f64>) {
    let count = samples.len();
    let padded = (2 * count.max(2)).next_power_of_two();
    let mut bins = vec![Complex64::new(0.0, 0.0); padded];
    let mean = super::robust::mean(samples);
    let once = 1.0 / count.max(1) as f64;
    let turn = Phasor::new(once, std::f64::consts::PI * once);
    for ((slot, sample), (cosine, _)) in bins.iter_mut().zip(samples).zip(turn) {
        slot.re = (sample - mean) * (0.5 - 0.5 * cosine);
    }
    transform(&mut bins);
    bins.truncate(padded / 2 + 1);
    let squares = bins.iter().map(Complex64::norm_sqr).collect();
    (1.0 / padded as f64, squares)
}

/// Frequency of the greatest spectral peak, in units of the sample rate, refined by a parabola
/// through the logarithms of the three bins at the top; `None` without a peak.
pub(super) fn peak_frequency(samples: &[f64]) -> Option<f64> {
    let (step, squares) = power_spectrum(samples);
    let first = 2.min(squares.len());
    let (top, &height) = squares
        .iter()
        .enumerate()
        .skip(first)
        .max_by(|a, b| a.1.total_cmp(b.1))?;
    if !(height > 0.0) || top + 1 >= squares.len() {
        return None;
    }
    let around = [top - 1, top, top + 1];
    let [left, centre, right] = around.map(|i| squares[i].max(f64::MIN_POSITIVE).ln());
    let curvature = left - 2.0 * centre + right;
    let shift = if curvature < 0.0 {
        0.5 * (left - right) / curvature
    } else {
        0.0
    };
    Some((top as f64 + shift.clamp(-0.5, 0.5)) * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_peak_of_a_sine_is_found_between_bins() {
        let samples: Vec<f64> = (0..2000)
            .map(|i| (std::f64::consts::TAU * 0.006_31 * f64::from(i)).sin())
            .collect();
        assert!((peak_frequency(&samples).unwrap() - 0.006_31).abs() < 2e-5);
        assert_eq!(peak_frequency(&[1.0; 64]), None);
    }
}
