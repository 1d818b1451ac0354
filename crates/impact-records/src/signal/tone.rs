//! Least-squares fit of a tone: offset + a cos(2π f t) + b sin(2π f t), frequency known (three
//! parameters) or free (four parameters, as in IEEE Std 1057).

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

use super::columns::{dot, subtract, sum};
use super::robust;
use super::spectrum::peak_frequency;
use super::turns::Turns;

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

/// Fit a tone with its frequency, starting at the greatest spectral peak.
///
/// `None` if the samples hold no peak or the fit does not settle.
///
/// ```
/// use impact_records::signal::tone;
///
/// let angle = |i: i32| std::f64::consts::TAU * 12.6 * f64::from(i) / 2000.0;
/// let samples: Vec<f64> = (0..2000).map(|i| 0.5 + 2.0 * angle(i).cos()).collect();
/// let found = tone::fit(&samples, 2000.0).unwrap();
/// assert!((found.frequency_hz - 12.6).abs() < 1e-8);
/// assert!((found.amplitude - 2.0).abs() < 1e-8);
/// assert!((found.offset - 0.5).abs() < 1e-8);
/// ```
pub fn fit(samples: &[f64], rate_hz: f64) -> Option<Tone> {
    fit_from(samples, rate_hz, peak_frequency(samples)? * rate_hz)
}

/// Fit a tone with its frequency, starting at a given one.
///
/// `None` if the fit does not settle.
pub fn fit_from(samples: &[f64], rate_hz: f64, start_hz: f64) -> Option<Tone> {
    let mut frequency_hz = start_hz;
    for _ in 0..12 {
        let harmonic = Harmonic::new(samples, rate_hz, frequency_hz)?;
        let (step_hz, error_hz) = harmonic.frequency_step(rate_hz)?;
        frequency_hz += step_hz;
        if !(frequency_hz > 0.0 && frequency_hz < 0.5 * rate_hz) {
            return None;
        }
        if step_hz.abs() <= 1e-3 * error_hz + 1e-12 * frequency_hz {
            let harmonic = Harmonic::new(samples, rate_hz, frequency_hz)?;
            return Some(harmonic.tone(frequency_hz, error_hz));
        }
    }
    None
}

/// Offset, cosine and sine of one frequency fitted to samples.
struct Harmonic {
    turns: Turns,
    normal: Matrix3<f64>,
    /// Offset, and factors of the cosine and the sine.
    solution: Vector3<f64>,
    residuals: Vec<f64>,
    /// Root mean square of the residuals.
    residual_rms: f64,
}

impl Harmonic {
    /// `None` with fewer than four samples.
    fn new(samples: &[f64], rate_hz: f64, frequency_hz: f64) -> Option<Self> {
        if samples.len() < 4 {
            return None;
        }
        let turns = Turns::new(frequency_hz / rate_hz, 0.0, samples.len());
        let (c, s) = (&turns.cos, &turns.sin);
        let (sum_c, sum_s, cs) = (sum(c), sum(s), dot(c, s));
        let normal = Matrix3::new(
            samples.len() as f64,
            sum_c,
            sum_s,
            sum_c,
            dot(c, c),
            cs,
            sum_s,
            cs,
            dot(s, s),
        );
        let right = Vector3::new(sum(samples), dot(samples, c), dot(samples, s));
        let solution = normal.cholesky()?.solve(&right);
        let mut residuals: Vec<f64> = samples.iter().map(|y| y - solution[0]).collect();
        subtract(&mut residuals, solution[1], c);
        subtract(&mut residuals, solution[2], s);
        let residual_rms = robust::rms(&residuals);
        Some(Self {
            turns,
            normal,
            solution,
            residuals,
            residual_rms,
        })
    }

    /// One Gauss–Newton step of the frequency, with its standard error.
    fn frequency_step(&self, rate_hz: f64) -> Option<(f64, f64)> {
        let (c, s, rest) = (&self.turns.cos, &self.turns.sin, &self.residuals);
        let (a, b) = (self.solution[1], self.solution[2]);
        let middle = 0.5 * rest.len() as f64;
        let slope = |(i, (c, s)): (usize, (&f64, &f64))| {
            let time = (i as f64 - middle) / rate_hz;
            std::f64::consts::TAU * time * (b * c - a * s)
        };
        let slopes: Vec<f64> = c.iter().zip(s).enumerate().map(slope).collect();
        let beside = Vector3::new(sum(&slopes), dot(&slopes, c), dot(&slopes, s));
        let mut normal = Matrix4::zeros();
        normal.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.normal);
        normal.fixed_view_mut::<3, 1>(0, 3).copy_from(&beside);
        normal
            .fixed_view_mut::<1, 3>(3, 0)
            .copy_from(&beside.transpose());
        normal[(3, 3)] = dot(&slopes, &slopes);
        let right = Vector4::new(sum(rest), dot(rest, c), dot(rest, s), dot(rest, &slopes));
        let inverse = normal.try_inverse()?;
        let step = (inverse * right)[3];
        let freedom = rest.len().saturating_sub(4).max(1) as f64;
        let variance = self.residual_rms.powi(2) * rest.len() as f64 / freedom;
        Some((step, (inverse[(3, 3)] * variance).sqrt()))
    }

    fn tone(&self, frequency_hz: f64, frequency_error_hz: f64) -> Tone {
        let [offset, a, b] = self.solution.into();
        Tone {
            frequency_hz,
            frequency_error_hz,
            amplitude: a.hypot(b),
            phase_rad: (-b).atan2(a),
            offset,
            residual_rms: self.residual_rms,
        }
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
