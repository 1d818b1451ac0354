//! Oscillations that do not decay at the frequency of the mains: a hum, or what a motor drives, recorded as a free decay.

use impact_records::signal::decay::Decay;

use crate::statistics::quantile::NORMAL_975;

/// Frequencies of mains, Hz.
const MAINS_HZ: [f64; 2] = [50.0, 60.0];
/// How far they wander, relative: 50 mHz in 50 Hz (Commission Regulation (EU) 2017/1485, annex III).
const WANDERS: f64 = 1e-3;
/// Harmonics that mains have (EN 50160 counts 40).
const HARMONICS: f64 = 40.0;
/// Fall of the amplitude over a record that a voltage within its limits may show (EN 50160).
const FALLS: f64 = 0.1;

/// The mains' frequency, Hz, of which a decay may be a hum: it has it or a multiple, and hardly decays, if at all.
pub(super) fn hum_of(decay: &Decay) -> Option<f64> {
    let turns = std::f64::consts::TAU * decay.periods;
    let least = decay.damping_ratio - NORMAL_975 * decay.damping_ratio_error;
    if least > 0.0 && decay.damping_ratio * turns > FALLS {
        return None;
    }
    let hz = decay.natural_frequency_hz;
    let within = WANDERS + NORMAL_975 * decay.relative_error();
    let is_harmonic = |mains: &f64| {
        let number = (hz / mains).round();
        (1.0..=HARMONICS).contains(&number) && (hz / (number * mains) - 1.0).abs() < within
    };
    MAINS_HZ.into_iter().find(is_harmonic)
}

#[cfg(test)]
mod tests {
    use super::*;

    use impact_records::signal::decay;

    fn tone(hz: f64, beta: f64) -> Decay {
        let natural = std::f64::consts::TAU * hz;
        let value = |t: f64| (-beta * natural * t).exp() * (natural * t).cos();
        let samples: Vec<f64> = (0..4000).map(|i| value(f64::from(i) / 1000.0)).collect();
        decay::fit(&samples, 1000.0).unwrap()
    }

    #[test]
    fn a_tone_at_a_multiple_of_the_mains_that_does_not_decay_may_be_hum() {
        for (hz, beta, mains) in [
            (50.02, 0.0, Some(50.0)),
            (60.0, 0.0, Some(60.0)),
            (149.95, 0.0, Some(50.0)),
            (50.0, 5e-5, Some(50.0)),
            (50.0, 0.002, None),
            (51.0, 0.0, None),
            (3.0, 0.0, None),
        ] {
            let tone = tone(hz, beta);
            assert_eq!(hum_of(&tone), mains, "{hz} {beta}: {tone:?}");
        }
    }
}
