//! Spectra of real samples.

use std::cell::RefCell;

use rustfft::algorithm::Radix4;
use rustfft::num_complex::Complex64;
use rustfft::{Fft, FftDirection, Length};

use super::turns::Turns;

thread_local! {
    /// What was used last: records of a campaign are equally long.
    static LAST: RefCell<Option<Plan>> = const { RefCell::new(None) };
}

/// What the spectrum of a number of samples takes: no planner of the library, whose every algorithm
/// would be compiled here.
struct Plan {
    /// Hann's window.
    window: Vec<f64>,
    /// The transform of pairs of samples.
    pairs: Radix4<f64>,
    /// e^{2πik/N} of the bins.
    turns: Turns,
}

impl Plan {
    /// For samples that are padded to twice the next power of two.
    fn new(samples: usize) -> Self {
        let half = samples.max(2).next_power_of_two();
        let once = 1.0 / samples.max(1) as f64;
        let turn = Turns::new(once, std::f64::consts::PI * once, samples);
        Self {
            window: turn.cos.iter().map(|cosine| 0.5 - 0.5 * cosine).collect(),
            pairs: Radix4::new(half, FftDirection::Forward),
            turns: Turns::new(0.5 / half as f64, 0.0, half + 1),
        }
    }

    /// Squares of the amplitudes of the samples' spectrum, mean removed.
    fn squares(&self, samples: &[f64]) -> Vec<f64> {
        let mean = super::robust::mean(samples);
        let windowed = samples.iter().zip(&self.window);
        let windowed: Vec<f64> = windowed.map(|(s, w)| (s - mean) * w).collect();
        // Even samples are the real parts, odd ones the imaginary parts of half as many.
        let mut bins = vec![Complex64::new(0.0, 0.0); self.pairs.len()];
        for (bin, pair) in bins.iter_mut().zip(windowed.chunks(2)) {
            *bin = Complex64::new(pair[0], pair.get(1).copied().unwrap_or(0.0));
        }
        self.pairs.process(&mut bins);
        self.squares_of_pairs(&bins)
    }

    /// Squares of a real signal's transform from that of its pairs z = even + i odd: with Z* the conjugate
    /// from the other end, X = (Z + Z*)/2 − i/2 e^{−2πik/N} (Z − Z*).
    fn squares_of_pairs(&self, bins: &[Complex64]) -> Vec<f64> {
        let half = bins.len();
        let square = |k: usize| {
            let (z, mirrored) = (bins[k % half], bins[(half - k) % half].conj());
            let (even, odd) = (z + mirrored, z - mirrored);
            let turned = Complex64::new(-self.turns.sin[k], -self.turns.cos[k]) * odd;
            0.25 * (even + turned).norm_sqr()
        };
        (0..=half).map(square).collect()
    }
}

/// One-sided power spectrum of the samples in no unit, mean removed, Hann window, zero-padded to twice
/// the next power of two: (frequency step in units of the sample rate, squares of the amplitudes).
fn power_spectrum(samples: &[f64]) -> (f64, Vec<f64>) {
    LAST.with_borrow_mut(|last| {
        let made = last.take().filter(|p| p.window.len() == samples.len());
        let plan = last.insert(made.unwrap_or_else(|| Plan::new(samples.len())));
        (0.5 / plan.pairs.len() as f64, plan.squares(samples))
    })
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
    fn valid_the_spectrum_is_that_of_the_discrete_transform() {
        let samples: Vec<f64> = (0..21)
            .map(|i| f64::from(i * i % 7) - 0.1 * f64::from(i))
            .collect();
        let (step, found) = power_spectrum(&samples);
        assert_eq!((step, found.len()), (1.0 / 64.0, 33));
        let mean = samples.iter().sum::<f64>() / 21.0;
        for (k, square) in found.iter().enumerate() {
            let term = |(i, x): (usize, &f64)| {
                let window = (std::f64::consts::PI * (i as f64 + 0.5) / 21.0)
                    .sin()
                    .powi(2);
                let angle = -std::f64::consts::TAU * (k * i) as f64 / 64.0;
                Complex64::from_polar((x - mean) * window, angle)
            };
            let want: Complex64 = samples.iter().enumerate().map(term).sum();
            assert!((square - want.norm_sqr()).abs() < 1e-10, "{k}");
        }
    }

    #[test]
    fn valid_peak_of_a_sine_is_found_between_bins() {
        let samples: Vec<f64> = (0..2000)
            .map(|i| (std::f64::consts::TAU * 0.006_31 * f64::from(i)).sin())
            .collect();
        assert!((peak_frequency(&samples).unwrap() - 0.006_31).abs() < 2e-5);
        assert_eq!(peak_frequency(&[1.0; 64]), None);
    }
}
