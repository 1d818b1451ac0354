//! A filter of five taps that keeps cubics and takes away what turns over from tap to tap.

/// Its taps: of the filters of five it is the flattest both at a constant and at the frequency that it takes away,
/// cos⁴(ω/2)·(1 + 2 sin²(ω/2)) at ω radians from tap to tap.
const TAPS: [f64; 5] = [-0.0625, 0.25, 0.625, 0.25, -0.0625];

/// Variance that it leaves of white noise.
pub(crate) const GAIN: f64 = 0.5234375;

/// Samples to either side of which a smoothed value is made, with taps so many samples apart.
pub(crate) const fn reach(apart: usize) -> usize {
    2 * apart
}

/// The values smoothed with taps so many samples apart; within its reach of either end they are as they were.
pub(crate) fn smoothed(values: &[f64], apart: usize) -> Vec<f64> {
    let mut out = values.to_vec();
    let reach = reach(apart);
    for (i, window) in values.windows(2 * reach + 1).enumerate() {
        let taps = window.iter().step_by(apart.max(1)).zip(TAPS);
        out[i + reach] = taps.map(|(value, tap)| value * tap).sum();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_a_cubic_passes_and_what_turns_over_from_tap_to_tap_does_not() {
        for apart in [1, 3] {
            let value = |i: i32| {
                let t = 0.1 * f64::from(i);
                1.0 - 2.0 * t + 0.5 * t * t - 0.2 * t.powi(3)
            };
            let turns = |i: i32| (std::f64::consts::PI * f64::from(i) / apart as f64).cos();
            let cubic: Vec<f64> = (0..60).map(value).collect();
            let both: Vec<f64> = (0..60).map(|i| value(i) + turns(i)).collect();
            let found = smoothed(&both, apart);
            for i in reach(apart)..60 - reach(apart) {
                assert!((found[i] - cubic[i]).abs() < 1e-12, "{apart}, {i}");
            }
        }
    }

    #[test]
    fn valid_white_noise_keeps_the_sum_of_the_squared_taps() {
        assert!((TAPS.iter().map(|t| t * t).sum::<f64>() - GAIN).abs() < 1e-15);
    }

    #[test]
    fn valid_its_gain_is_that_of_its_formula() {
        for omega in [0.2f64, 1.0, 2.0, 3.0] {
            let tone: Vec<f64> = (0..50).map(|i| (omega * f64::from(i)).cos()).collect();
            let half = 0.5 * omega;
            let gain = half.cos().powi(4) * (1.0 + 2.0 * half.sin().powi(2));
            let found = smoothed(&tone, 1)[25];
            assert!((found - gain * tone[25]).abs() < 1e-12, "{omega}");
        }
    }
}
