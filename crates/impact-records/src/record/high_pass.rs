//! The first-order high-pass of a channel: an integrator's or an AC coupling's.

use nalgebra::Complex;

/// What an amplitude of a frequency, Hz, behind a high-pass of a corner, Hz, is multiplied by to be that before it: to divide
/// by iω/(iω + `ω_c`) is to multiply by 1 − `iω_c`/ω.
pub fn before_high_pass(corner_hz: f64, frequency_hz: f64) -> Complex<f64> {
    Complex::new(1.0, -corner_hz / frequency_hz)
}
