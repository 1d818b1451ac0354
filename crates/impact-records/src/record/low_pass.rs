//! The low-pass of a channel: an anti-alias filter, a vibrometer's or an amplifier's.

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

/// A Butterworth low-pass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LowPass {
    /// Where it passes 1/√2 of an amplitude, Hz.
    pub corner_hz: f64,
    /// Number of its poles.
    pub order: u32,
}

/// Share of a jump that is left when the filter counts as settled, as a power of e.
const SETTLED: f64 = 8.0;

impl LowPass {
    /// Its poles, 1/s: on a circle, the angles between them alike, none to the right.
    fn poles(&self) -> impl Iterator<Item = Complex<f64>> {
        let rate = std::f64::consts::TAU * self.corner_hz;
        let order = self.order.max(1);
        (0..order).map(move |k| {
            let turns = f64::from(2 * k + order + 1) / f64::from(4 * order);
            Complex::from_polar(rate, std::f64::consts::TAU * turns)
        })
    }

    /// What it makes of e^{st}, s in 1/s, once it has settled.
    pub fn transfer(&self, s: Complex<f64>) -> Complex<f64> {
        self.poles().map(|pole| pole / (pole - s)).product()
    }

    /// Slope of [`Self::transfer`] over s, s.
    pub fn transfer_slope(&self, s: Complex<f64>) -> Complex<f64> {
        let relative: Complex<f64> = self.poles().map(|pole| (pole - s).inv()).sum();
        self.transfer(s) * relative
    }

    /// How much later it shows slow motion, s.
    pub fn delay_s(&self) -> f64 {
        self.poles().map(|pole| -pole.inv().re).sum()
    }

    /// Time after a jump until it has settled, s.
    pub fn settling_s(&self) -> f64 {
        let slowest = self
            .poles()
            .map(|pole| -pole.re)
            .fold(f64::INFINITY, f64::min);
        SETTLED / slowest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_butterworth_s_amplitudes_delays_and_settling() {
        for order in [1, 2, 4] {
            let filter = LowPass {
                corner_hz: 200.0,
                order,
            };
            // |H|² = 1/(1 + (f/f_c)^{2n})
            for frequency_hz in [10.0f64, 200.0, 300.0] {
                let s = Complex::new(0.0, std::f64::consts::TAU * frequency_hz);
                let power = (frequency_hz / 200.0).powi(2 * i32::try_from(order).expect("small"));
                let want = (1.0 + power).sqrt().recip();
                assert!((filter.transfer(s).norm() - want).abs() < 1e-12, "{order}");
            }
            // 1, √2 and 2.6131 over the angular frequency of the corner
            let want = [1.0, 2f64.sqrt(), 0.0, 2.613_125_9][order as usize - 1];
            let rate = std::f64::consts::TAU * 200.0;
            assert!((filter.delay_s() * rate - want).abs() < 1e-6, "{order}");
            // the slowest pole lies at sin(90°/n) of the corner
            let slowest = (std::f64::consts::FRAC_PI_2 / f64::from(order)).sin() * rate;
            assert!(
                (filter.settling_s() * slowest - 8.0).abs() < 1e-9,
                "{order}"
            );
        }
    }
}
