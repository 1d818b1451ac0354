//! Filters that keep cubics and take away what turns over from tap to tap.

/// A symmetric filter, by its taps.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kernel(&'static [f64]);

/// Gain 1 − sin⁴(ω/2) at ω radians from tap to tap.
pub(crate) const SHORT: Kernel = Kernel(&[-0.0625, 0.25, 0.625, 0.25, -0.0625]);

/// Gain cos⁴(ω/2)·(1 + 2 sin²(ω/2)), as in Deslauriers and Dubuc's interpolation: it takes away more beside the frequency
/// at which it is zero.
pub(crate) const LONG: Kernel = Kernel(&[-0.03125, 0.0, 0.28125, 0.5, 0.28125, 0.0, -0.03125]);

impl Kernel {
    /// Variance that it leaves of white noise.
    pub(crate) fn noise_gain(self) -> f64 {
        self.0.iter().map(|tap| tap * tap).sum()
    }

    /// Samples to either side of which a smoothed value is made, with taps so many samples apart.
    pub(crate) const fn reach(self, apart: usize) -> usize {
        self.0.len() / 2 * apart
    }

    /// The values smoothed with taps so many samples apart; within its reach of either end they are as they were.
    pub(crate) fn smoothed(self, values: &[f64], apart: usize) -> Vec<f64> {
        let mut out = values.to_vec();
        let reach = self.reach(apart);
        for (i, window) in values.windows(2 * reach + 1).enumerate() {
            let taps = window.iter().step_by(apart.max(1)).zip(self.0);
            out[i + reach] = taps.map(|(value, tap)| value * tap).sum();
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_a_cubic_passes_and_what_turns_over_from_tap_to_tap_does_not() {
        for (kernel, apart) in [(SHORT, 1), (SHORT, 3), (LONG, 1), (LONG, 3)] {
            let value = |i: i32| {
                let t = 0.1 * f64::from(i);
                1.0 - 2.0 * t + 0.5 * t * t - 0.2 * t.powi(3)
            };
            let turns = |i: i32| (std::f64::consts::PI * f64::from(i) / apart as f64).cos();
            let cubic: Vec<f64> = (0..60).map(value).collect();
            let both: Vec<f64> = (0..60).map(|i| value(i) + turns(i)).collect();
            let found = kernel.smoothed(&both, apart);
            for i in kernel.reach(apart)..60 - kernel.reach(apart) {
                assert!((found[i] - cubic[i]).abs() < 1e-12, "{apart}, {i}");
            }
        }
    }

    #[test]
    fn valid_their_gains_are_those_of_their_formulas() {
        for omega in [0.2f64, 1.0, 2.0, 3.0] {
            let tone: Vec<f64> = (0..50).map(|i| (omega * f64::from(i)).cos()).collect();
            let half = 0.5 * omega;
            let short = 1.0 - half.sin().powi(4);
            let long = half.cos().powi(4) * (1.0 + 2.0 * half.sin().powi(2));
            for (kernel, gain) in [(SHORT, short), (LONG, long)] {
                let found = kernel.smoothed(&tone, 1)[25];
                assert!((found - gain * tone[25]).abs() < 1e-12, "{omega}");
            }
        }
    }

    #[test]
    fn valid_they_leave_so_much_of_white_noise() {
        assert!((SHORT.noise_gain() - 0.523_437_5).abs() < 1e-15);
        assert!((LONG.noise_gain() - 0.410_156_25).abs() < 1e-15);
    }
}
