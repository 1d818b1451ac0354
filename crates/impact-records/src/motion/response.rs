//! Response of an impactless record at the drive's frequency: complex amplitude of each motion
//! channel relative to the drive's phase, the integrators' high-pass divided out.
//!
//! What is left of a free decay when the record begins is not told from the response where it decays slowly, but for how the
//! response changes over the record: that counts as an error of the response where noise does not explain it.

use nalgebra::{Complex, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::event::DriveTone;
use crate::record::{LowPass, Record, Role, before_high_pass};
use crate::signal::columns::{dot, products, subtract};
use crate::signal::turns::Turns;

/// Complex amplitude of one channel: it moves as Re[(real + i·imaginary) e^{iθ}] while the drive
/// is cos θ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Response {
    /// The channel's role.
    pub role: Role,
    /// In phase with the drive, SI.
    pub real: f64,
    /// A quarter period ahead of the drive, SI.
    pub imaginary: f64,
    /// Standard error of either part by noise and by what has not settled, SI.
    pub error: f64,
    /// Root mean square of the residual, SI.
    pub residual_rms: f64,
    /// Corner of the first-order high-pass that was divided out, Hz; `None`: none.
    #[serde(default)]
    pub high_pass_hz: Option<f64>,
}

impl Response {
    /// Amplitude, SI.
    pub fn amplitude(&self) -> f64 {
        self.real.hypot(self.imaginary)
    }

    /// The same measured values times a factor.
    #[must_use]
    pub fn times(&self, factor: Complex<f64>) -> Self {
        let value = Complex::new(self.real, self.imaginary) * factor;
        Self {
            real: value.re,
            imaginary: value.im,
            error: self.error * factor.norm(),
            ..*self
        }
    }

    /// What a low-pass was given that made this of it.
    fn before(&self, filter: LowPass, frequency_hz: f64) -> Self {
        self.times(transfer(filter, frequency_hz).inv())
    }

    /// The same measured values if the channel has passed another low-pass than was assumed.
    #[must_use]
    pub fn behind_low_pass(&self, [assumed, other]: [LowPass; 2], frequency_hz: f64) -> Self {
        let measured = self.times(transfer(assumed, frequency_hz));
        measured.before(other, frequency_hz)
    }

    /// The same measured values if the channel has passed another high-pass than was assumed.
    #[must_use]
    pub fn behind(&self, high_pass_hz: Option<f64>, frequency_hz: f64) -> Self {
        let undoing =
            |corner_hz: Option<f64>| before_high_pass(corner_hz.unwrap_or(0.0), frequency_hz);
        Self {
            high_pass_hz,
            ..self.times(undoing(high_pass_hz) / undoing(self.high_pass_hz))
        }
    }
}

/// What a low-pass makes of a unit amplitude at a frequency.
fn transfer(filter: LowPass, frequency_hz: f64) -> Complex<f64> {
    filter.transfer(Complex::new(0.0, std::f64::consts::TAU * frequency_hz))
}

/// Response of all motion channels of a record to its drive.
pub(super) fn responses(record: &Record, drive: &DriveTone) -> Vec<Response> {
    // as a rule all channels are as long
    let mut basis: Option<Basis> = None;
    let motion = record.channels.iter().filter(|c| c.role.is_motion());
    motion
        .filter_map(|c| {
            let count = c.values.len();
            basis = basis
                .take()
                .filter(|b| b.columns[0].len() == count)
                .or_else(|| Basis::new(count, record.sample_rate_hz, drive));
            let raw = basis.as_ref()?.fit(&c.values)?;
            let measured = Response {
                role: c.role,
                real: raw.0,
                imaginary: raw.1,
                error: raw.2,
                residual_rms: raw.3,
                high_pass_hz: None,
            };
            let measured = match c.low_pass {
                Some(filter) => measured.before(filter, drive.frequency_hz),
                None => measured,
            };
            Some(measured.behind(c.high_pass_hz, drive.frequency_hz))
        })
        .collect()
}

/// Terms of a record's waveform: 1, t, cos θ, sin θ, t cos θ and t sin θ, with t from −1 to 1.
const TERMS: usize = 6;
/// Standard errors from which a response changes over the record.
const CHANGES: f64 = 3.0;
/// What is left of a free decay in a response over the change that it makes of it from the record's middle to its end, of a
/// record as long as it takes the decay to fall to half of itself: shorter ones hardly tell it at all.
const SETTLING: f64 = 3.0;

/// The terms at the samples of a record, and the inverse of their normal equations.
struct Basis {
    columns: [Vec<f64>; TERMS],
    inverse: SMatrix<f64, TERMS, TERMS>,
}

impl Basis {
    fn new(count: usize, rate_hz: f64, drive: &DriveTone) -> Option<Self> {
        let turns = Turns::new(drive.frequency_hz / rate_hz, drive.phase_rad, count);
        let times = (0..count).map(|i| 2.0 * i as f64 / count as f64 - 1.0);
        let times: Vec<f64> = times.collect();
        let changing = [&turns.cos, &turns.sin].map(|values| products(&times, values));
        let [along, across] = changing;
        let columns = [vec![1.0; count], times, turns.cos, turns.sin, along, across];
        let normal = SMatrix::<f64, TERMS, TERMS>::from_fn(|i, k| dot(&columns[i], &columns[k]));
        Some(Self {
            inverse: normal.try_inverse()?,
            columns,
        })
    }

    /// Least squares: (real, imaginary, error, residual rms); `None` where a channel is too short or
    /// has gaps.
    fn fit(&self, values: &[f64]) -> Option<(f64, f64, f64, f64)> {
        let count = values.len();
        if count < 2 * TERMS || values.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let right = SVector::<f64, TERMS>::from_fn(|i, _| dot(&self.columns[i], values));
        let solution = self.inverse * right;
        let mut residuals = values.to_vec();
        for (share, column) in solution.iter().zip(&self.columns) {
            subtract(&mut residuals, *share, column);
        }
        let squares = dot(&residuals, &residuals);
        let deviation = (squares / (count - TERMS) as f64).sqrt();
        let error = |i: usize, k: usize| {
            deviation * (0.5 * (self.inverse[(i, i)] + self.inverse[(k, k)])).sqrt()
        };
        let change = solution[4].hypot(solution[5]);
        let unsettled = if change > CHANGES * error(4, 5) {
            SETTLING * change
        } else {
            0.0
        };
        let rms = (squares / count as f64).sqrt();
        // a cos θ + b sin θ = Re[(a − i b) e^{iθ}].
        Some((solution[2], -solution[3], error(2, 3).hypot(unsettled), rms))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::whole;

    const RATE_HZ: f64 = 2000.0;

    fn drive() -> DriveTone {
        DriveTone {
            phase_rad: 0.4,
            ..DriveTone::at(12.6, 1.0)
        }
    }

    fn record(of: impl Fn(f64, f64) -> f64) -> Record {
        let value = |i: usize| {
            let time = i as f64 / RATE_HZ;
            of(drive().phase_at(time), time)
        };
        let values: Vec<f64> = (0..2000).map(value).collect();
        Record::of(RATE_HZ, &[(Role::VelocityX, &values)])
    }

    #[test]
    fn valid_parts_in_phase_and_ahead_are_separated_from_a_drifting_offset() {
        // Re[(0.3 + 0.2i) e^{iθ}] = 0.3 cos θ − 0.2 sin θ.
        let record = record(|theta, t| 0.3 * theta.cos() - 0.2 * theta.sin() + 0.5 - 0.1 * t);
        let found = responses(&record, &drive());
        assert_eq!(found.len(), 1);
        assert!((found[0].real - 0.3).abs() < 1e-9);
        assert!((found[0].imaginary - 0.2).abs() < 1e-9);
        assert!((found[0].amplitude() - 0.13f64.sqrt()).abs() < 1e-9);
        assert!(found[0].residual_rms < 1e-9);
    }

    #[test]
    fn valid_a_high_pass_is_divided_out_and_can_be_exchanged() {
        // Behind a corner at the drive's own frequency 1 becomes i/(1 + i) = (1 + i)/2.
        let mut record = record(|theta, _| 0.5 * theta.cos() - 0.5 * theta.sin());
        record.channels[0].high_pass_hz = Some(12.6);
        let found = responses(&record, &drive())[0];
        assert!((found.real - 1.0).abs() < 1e-9 && found.imaginary.abs() < 1e-9);
        let raw = found.behind(None, 12.6);
        assert!((raw.real - 0.5).abs() < 1e-9 && (raw.imaginary - 0.5).abs() < 1e-9);
    }

    #[test]
    fn valid_what_is_left_of_a_free_decay_enters_the_error_and_noise_alone_does_not() {
        use rand::SeedableRng;
        use rand_distr::{Distribution, StandardNormal};
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(8);
        let noise: Vec<f64> = (0..2000).map(|_| StandardNormal.sample(&mut rng)).collect();
        let noisy = |left: f64| {
            record(|theta, t| {
                let decay = (-0.9 * t).exp() * (1.0 + 12.4 * std::f64::consts::TAU * t).cos();
                theta.cos() + left * decay + 1e-3 * noise[whole::index(t * RATE_HZ)]
            })
        };
        let settled = responses(&noisy(0.0), &drive())[0];
        // noise of 0.1 % on 2000 samples
        assert!((settled.error / 3.2e-5 - 1.0).abs() < 0.1, "{settled:?}");
        for left in [0.002, 0.01, 0.05] {
            let found = responses(&noisy(left), &drive())[0];
            let off = (found.real - 1.0).hypot(found.imaginary);
            assert!(
                off > 3.0 * settled.error && off < 2.0 * found.error,
                "{left}: {off} {found:?}"
            );
            assert!(found.error < 3.0 * left, "{left}: {found:?}");
        }
    }
}
