//! Least-squares fit of a tone: offset + a cos(2π f t) + b sin(2π f t), frequency known (three
//! parameters) or free (four parameters, as in IEEE Std 1057).

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

use super::spectrum::peak_frequency;

/// A tone fitted to samples: `offset + amplitude · cos(2π f t + phase)`, t from the first sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tone {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Standard error of the frequency, Hz; zero if it was given.
    pub frequency_error_hz: f64,
    /// Amplitude, the samples' unit.
    pub amplitude: f64,
    /// Phase of the cosine at the first sample, rad in (−π, π].
    pub phase_rad: f64,
    /// Constant part, the samples' unit.
    pub offset: f64,
    /// Root mean square of the residual, the samples' unit.
    pub residual_rms: f64,
}

/// Fit a tone of known frequency; `None` with fewer than four samples.
fn fit_known_frequency(samples: &[f64], rate_hz: f64, frequency_hz: f64) -> Option<Tone> {
    let mut normal = Matrix3::zeros();
    let mut right = Vector3::zeros();
    for (sample, (c, s)) in samples.iter().zip(Phasor::new(frequency_hz / rate_hz, 0.0)) {
        let row = Vector3::new(1.0, c, s);
        normal += row * row.transpose();
        right += row * *sample;
    }
    if samples.len() < 4 {
        return None;
    }
    let solution = normal.cholesky()?.solve(&right);
    Some(tone_from(
        samples,
        rate_hz,
        frequency_hz,
        [solution[0], solution[1], solution[2]],
    ))
}

/// Fit a tone with its frequency, starting at the greatest spectral peak.
///
/// `None` if the samples hold no peak or the fit does not settle.
///
/// ```
/// use impactid::signal::tone;
///
/// let angle = |i: i32| std::f64::consts::TAU * 12.6 * f64::from(i) / 2000.0;
/// let samples: Vec<f64> = (0..2000).map(|i| 0.5 + 2.0 * angle(i).cos()).collect();
/// let found = tone::fit(&samples, 2000.0).unwrap();
/// assert!((found.frequency_hz - 12.6).abs() < 1e-8);
/// assert!((found.amplitude - 2.0).abs() < 1e-8);
/// assert!((found.offset - 0.5).abs() < 1e-8);
/// ```
pub fn fit(samples: &[f64], rate_hz: f64) -> Option<Tone> {
    let mut frequency_hz = peak_frequency(samples)? * rate_hz;
    for _ in 0..12 {
        let tone = fit_known_frequency(samples, rate_hz, frequency_hz)?;
        let (step_hz, error_hz) = frequency_step(samples, rate_hz, &tone)?;
        frequency_hz += step_hz;
        if !(frequency_hz > 0.0 && frequency_hz < 0.5 * rate_hz) {
            return None;
        }
        if step_hz.abs() <= 1e-3 * error_hz + 1e-12 * frequency_hz {
            let tone = fit_known_frequency(samples, rate_hz, frequency_hz)?;
            return Some(Tone {
                frequency_error_hz: error_hz,
                ..tone
            });
        }
    }
    None
}

/// One Gauss–Newton step of the frequency, with its standard error.
fn frequency_step(samples: &[f64], rate_hz: f64, tone: &Tone) -> Option<(f64, f64)> {
    let a = tone.amplitude * tone.phase_rad.cos();
    let b = -tone.amplitude * tone.phase_rad.sin();
    let mut normal = Matrix4::zeros();
    let mut right = Vector4::zeros();
    let middle = 0.5 * samples.len() as f64;
    let phasor = Phasor::new(tone.frequency_hz / rate_hz, 0.0);
    for (i, (sample, (c, s))) in samples.iter().zip(phasor).enumerate() {
        let time = (i as f64 - middle) / rate_hz;
        let slope = std::f64::consts::TAU * time * (b * c - a * s);
        let row = Vector4::new(1.0, c, s, slope);
        normal += row * row.transpose();
        right += row * (sample - tone.offset - a * c - b * s);
    }
    let inverse = normal.try_inverse()?;
    let step = (inverse * right)[3];
    let freedom = samples.len().saturating_sub(4).max(1) as f64;
    let variance = tone.residual_rms.powi(2) * samples.len() as f64 / freedom;
    Some((step, (inverse[(3, 3)] * variance).sqrt()))
}

fn tone_from(samples: &[f64], rate_hz: f64, frequency_hz: f64, [o, a, b]: [f64; 3]) -> Tone {
    let squares: f64 = samples
        .iter()
        .zip(Phasor::new(frequency_hz / rate_hz, 0.0))
        .map(|(sample, (c, s))| (sample - o - a * c - b * s).powi(2))
        .sum();
    Tone {
        frequency_hz,
        frequency_error_hz: 0.0,
        amplitude: a.hypot(b),
        phase_rad: (-b).atan2(a),
        offset: o,
        residual_rms: (squares / samples.len().max(1) as f64).sqrt(),
    }
}

/// (cos, sin) of 2π·ratio·i + phase for i = 0, 1, …, by rotation, re-anchored every 64 steps.
pub(crate) struct Phasor {
    ratio: f64,
    phase_rad: f64,
    index: u64,
    current: (f64, f64),
    step: (f64, f64),
}

impl Phasor {
    /// Of a frequency over the sampling rate, and the phase at i = 0, rad.
    pub(crate) fn new(ratio: f64, phase_rad: f64) -> Self {
        let (sin, cos) = (std::f64::consts::TAU * ratio).sin_cos();
        let (sin_0, cos_0) = phase_rad.sin_cos();
        Self {
            ratio,
            phase_rad,
            index: 0,
            current: (cos_0, sin_0),
            step: (cos, sin),
        }
    }
}

impl Iterator for Phasor {
    type Item = (f64, f64);

    fn next(&mut self) -> Option<(f64, f64)> {
        let out = self.current;
        self.index += 1;
        self.current = if self.index.is_multiple_of(64) {
            let turns = (self.ratio * self.index as f64).fract();
            let (sin, cos) = (std::f64::consts::TAU * turns + self.phase_rad).sin_cos();
            (cos, sin)
        } else {
            let (c, s) = self.step;
            (out.0 * c - out.1 * s, out.0 * s + out.1 * c)
        };
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    #[test]
    fn valid_noise_free_tone_is_recovered() {
        let rate = 2000.0;
        let samples: Vec<f64> = (0..2000)
            .map(|i| 0.3 + 2.0 * (std::f64::consts::TAU * 12.637 * f64::from(i) / rate + 0.4).cos())
            .collect();
        let tone = fit(&samples, rate).unwrap();
        assert!((tone.frequency_hz - 12.637).abs() < 1e-9);
        assert!((tone.phase_rad - 0.4).abs() < 1e-8);
        assert!((tone.amplitude - 2.0).abs() < 1e-9);
        assert!((tone.offset - 0.3).abs() < 1e-9);
    }

    #[test]
    fn valid_frequency_error_matches_the_scatter() {
        let rate = 2000.0;
        let normal = Normal::new(0.0, 0.05).unwrap();
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(11);
        let scores: Vec<f64> = (0..60)
            .map(|_| {
                let samples: Vec<f64> = (0..1000)
                    .map(|i| {
                        let angle = std::f64::consts::TAU * 14.2 * f64::from(i) / rate;
                        angle.cos() + normal.sample(&mut rng)
                    })
                    .collect();
                let tone = fit(&samples, rate).unwrap();
                (tone.frequency_hz - 14.2) / tone.frequency_error_hz
            })
            .collect();
        let spread = super::super::robust::rms(&scores);
        assert!((0.7..1.35).contains(&spread), "{spread}");
    }
}
