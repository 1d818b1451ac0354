//! Dry friction beside viscous damping.

use super::super::{MotionSignal, Watched, fit_channels};
use super::{released, white};

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
        let channel = Watched::new(&values, quantity);
        let found = fit_channels(&[channel], 180.0)[0].beside_friction.unwrap();
        assert!(
            (found.damping_ratio / 0.02 - 1.0).abs() < 0.01,
            "{quantity:?} {found:?}"
        );
    }
}

#[test]
fn valid_friction_is_told_under_a_drift_and_in_noise_above_it() {
    // β, friction, rate, periods, drift over the record, noise
    for (damping_ratio, rest, rate_hz, periods, drift, noise) in [
        (0.03, 0.01, 120.0, 15.0, 0.3, 5e-3),
        (0.03, 0.01, 120.0, 15.0, -0.3, 5e-3),
        (0.0023, 0.01, 25.5, 43.0, 0.0, 0.03),
    ] {
        let mut held = 0;
        for seed in 0..8 {
            let mut samples = released(3.0, damping_ratio, rest, (rate_hz, periods));
            let count = samples.len() as f64;
            let times = samples.iter_mut().enumerate();
            times.for_each(|(i, v)| *v += drift * i as f64 / count);
            white(&mut samples, noise, seed);
            let found = fit_channels(&[Watched::displacement(&samples)], rate_hz)[0]
                .beside_friction
                .unwrap();
            let error = found.known_friction_error.hypot(found.added_error);
            held += usize::from((found.damping_ratio - damping_ratio).abs() < 2.2 * error);
        }
        assert!(held > 5, "{damping_ratio} {drift}: {held} of 8");
    }
}

#[test]
fn valid_harmonics_of_another_cause_are_no_friction() {
    // a gyroscope on a wheel that swings for five periods, with a third harmonic of 0.4 % at the phase that friction's has
    let beta = 0.015;
    let (decay, third) = (super::decay(2.4, beta, 0.0), super::decay(7.2, beta, 0.0));
    for seed in 0..4 {
        let mut samples = super::sampled(1000, 500.0, |t| decay(t) + 4e-3 * third(t));
        white(&mut samples, 8e-4, seed);
        let channel = Watched::new(&samples, MotionSignal::Velocity);
        let found = fit_channels(&[channel], 500.0)[0].beside_friction.unwrap();
        let error = found.known_friction_error.hypot(found.added_error);
        let off = (found.damping_ratio - beta).abs();
        assert!(off < 4.0 * error, "{found:?}");
    }
}
