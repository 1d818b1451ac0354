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
        // To divide by iω/(iω + ω_c) is to multiply by 1 − iω_c/ω.
        let undoing =
            |corner_hz: Option<f64>| Complex::new(1.0, -corner_hz.unwrap_or(0.0) / frequency_hz);
        let factor = undoing(high_pass_hz) / undoing(self.high_pass_hz);
        let value = Complex::new(self.real, self.imaginary) * factor;
        Self {
            real: value.re,
            imaginary: value.im,
            error: self.error * factor.norm(),
            high_pass_hz,
            ..*self
        }
    }
}

/// Response of all motion channels of a record to its drive.
pub(super) fn responses(record: &Record, drive: &DriveTone) -> Vec<Response> {
    record
        .channels
        .iter()
        .filter(|c| c.role.is_motion())
        .filter_map(|c| {
            let raw = tone_at_drive(&c.values, record.sample_rate_hz, drive)?;
            let measured = Response {
                role: c.role,
                real: raw.0,
                imaginary: raw.1,
                error: raw.2,
                residual_rms: raw.3,
                high_pass_hz: None,
            };
            Some(measured.behind(c.high_pass_hz, drive.frequency_hz))
        })
        .collect()
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
