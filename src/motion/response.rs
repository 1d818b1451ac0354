//! Response of an impactless record at the drive's frequency: complex amplitude of each motion
//! channel relative to the drive's phase, the integrators' high-pass divided out.

use nalgebra::{Complex, Matrix4, Vector4};
use serde::{Deserialize, Serialize};

use crate::event::DriveTone;
use crate::record::{Record, Role};

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
    /// Standard error of either part, SI.
    pub error: f64,
    /// Root mean square of what the tone leaves over, SI.
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

    /// The same measured values where the channel has passed another high-pass than was taken.
    pub fn behind(&self, high_pass_hz: Option<f64>, frequency_hz: f64) -> Self {
        let ratio = |corner_hz: Option<f64>| corner_hz.unwrap_or(0.0) / frequency_hz;
        let taken = Complex::new(1.0, -ratio(self.high_pass_hz));
        let passed = Complex::new(1.0, -ratio(high_pass_hz));
        let value = Complex::new(self.real, self.imaginary) * passed / taken;
        Self {
            real: value.re,
            imaginary: value.im,
            high_pass_hz,
            ..*self
        }
    }
}

/// Response of all motion channels of a record to its drive.
pub fn responses(record: &Record, drive: &DriveTone) -> Vec<Response> {
    record
        .channels
        .iter()
        .filter(|c| c.role.is_motion())
        .filter_map(|c| {
            let raw = tone_at_drive(&c.values, record.sample_rate_hz, drive)?;
            let (real, imaginary, gain) = match c.high_pass_hz {
                Some(corner) => undo(raw.0, raw.1, corner / drive.frequency_hz),
                None => (raw.0, raw.1, 1.0),
            };
            let error = raw.2 / gain;
            Some(Response {
                role: c.role,
                real,
                imaginary,
                error,
                residual_rms: raw.3,
                high_pass_hz: c.high_pass_hz,
            })
        })
        .collect()
}

/// Divide by iω/(iω + ω_c); `ratio` = ω_c/ω. Returns the parts and the filter's gain.
fn undo(real: f64, imaginary: f64, ratio: f64) -> (f64, f64, f64) {
    // (a + ib)(1 − i r), with r = ω_c/ω.
    let gain = 1.0 / 1f64.hypot(ratio);
    (real + ratio * imaginary, imaginary - ratio * real, gain)
}

/// Least squares of 1, t, cos θ, sin θ: (real, imaginary, error, residual rms).
fn tone_at_drive(values: &[f64], rate_hz: f64, drive: &DriveTone) -> Option<(f64, f64, f64, f64)> {
    let count = values.len();
    if count < 8 || values.iter().any(|v| !v.is_finite()) {
        return None;
    }
    let row = |i: usize| {
        let time = i as f64 / rate_hz;
        let (sin, cos) = drive.phase_at(time).sin_cos();
        Vector4::new(1.0, 2.0 * i as f64 / count as f64 - 1.0, cos, sin)
    };
    let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for (i, value) in values.iter().enumerate() {
        let row = row(i);
        normal += row * row.transpose();
        right += row * *value;
    }
    let inverse = normal.try_inverse()?;
    let solution = inverse * right;
    let squares: f64 = values
        .iter()
        .enumerate()
        .map(|(i, v)| (v - solution.dot(&row(i))).powi(2))
        .sum();
    let deviation = (squares / (count - 4) as f64).sqrt();
    let error = deviation * (0.5 * (inverse[(2, 2)] + inverse[(3, 3)])).sqrt();
    let rms = (squares / count as f64).sqrt();
    // a cos θ + b sin θ = Re[(a − i b) e^{iθ}].
    Some((solution[2], -solution[3], error, rms))
}
