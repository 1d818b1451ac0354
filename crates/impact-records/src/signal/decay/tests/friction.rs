//! Dry friction beside viscous damping.

use super::super::{MotionSignal, Watched, fit_channels};
use super::released;

/// Differences of a series, at the same times.
fn differentiated(values: &[f64], rate_hz: f64) -> Vec<f64> {
    let inner = values.windows(3).map(|w| 0.5 * (w[2] - w[0]) * rate_hz);
    inner.collect()
}

#[test]
fn valid_f0_beta_and_friction_are_recovered_from_motions_under_both() {
    for (damping_ratio, rest, periods) in [
        (0.05, 0.02, 2.0),
        (0.05, 0.02, 6.0),
        (0.08, 0.03, 3.0),
        (0.01, 4e-3, 10.0),
        (0.002, 1e-3, 40.0),
    ] {
        let samples = released(3.0, damping_ratio, rest, (180.0, periods));
        let channel = Watched::displacement(&samples);
        let found = fit_channels(&[channel], 180.0)[0].beside_friction.unwrap();
        assert!(
            (found.natural_frequency_hz / 3.0 - 1.0).abs() < 1e-5,
            "{found:?}"
        );
        assert!(
            (found.damping_ratio / damping_ratio - 1.0).abs() < 1e-3,
            "{found:?}"
        );
    }
}

#[test]
fn valid_velocities_and_accelerations_tell_the_friction_too() {
    let fine = released(3.0, 0.02, 8e-3, (18_000.0, 4.0));
    let velocity = differentiated(&fine, 18_000.0);
    let acceleration = differentiated(&velocity, 18_000.0);
    for (quantity, values) in [
        (MotionSignal::Velocity, velocity),
        (MotionSignal::Acceleration, acceleration),
    ] {
        let values: Vec<f64> = values.into_iter().step_by(100).collect();
        let channel = Watched {
            values: &values,
            quantity,
        };
        let found = fit_channels(&[channel], 180.0)[0].beside_friction.unwrap();
        assert!(
            (found.damping_ratio / 0.02 - 1.0).abs() < 0.01,
            "{quantity:?} {found:?}"
        );
    }
}
