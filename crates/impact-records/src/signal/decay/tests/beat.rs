//! Two modes that beat.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::super::beat::{LIMITS, Limits, find_within};
use super::super::hum::Cleared;
use super::super::prepared::Prepared;
use super::super::watched::{MotionSignal, Watched};

const RATE_HZ: f64 = 60.0;

/// A decay of frequency 3 Hz and another one beside it, in noise.
fn two(rng: &mut ChaCha8Rng, ratio: f64) -> Vec<f64> {
    let seconds = rng.random_range(8.0..12.0);
    let apart = rng.random_range(0.9..3.0) / seconds;
    let phase = rng.random_range(0.0..std::f64::consts::TAU);
    let noise = rng.random_range(1e-3..5e-3);
    let damping = rng.random_range(0.003..0.01);
    let decay = |hz: f64, t: f64, phase: f64| {
        let natural = std::f64::consts::TAU * hz;
        (-damping * natural * t).exp() * (natural * t + phase).cos()
    };
    let count = crate::signal::whole::index(seconds * RATE_HZ);
    (0..count)
        .map(|i| {
            let t = i as f64 / RATE_HZ;
            let shock: f64 = StandardNormal.sample(rng);
            decay(3.0, t, 0.0) + ratio * decay(3.0 + apart, t, phase) + noise * shock
        })
        .collect()
}

/// Some decays beside which there is another one of a part of their amplitude.
fn prepared(ratio: f64) -> Vec<Prepared> {
    let mut rng = ChaCha8Rng::seed_from_u64(20_261_127);
    let all = (0..8).map(|_| two(&mut rng, ratio));
    all.filter_map(|samples| Prepared::alone(&Cleared::plain(Watched::displacement(&samples))))
        .collect()
}

#[test]
fn valid_beats_are_told_over_a_range_of_the_limits() {
    let others = [0.5, 2.0].map(|by| {
        [
            Limits {
                left: by * LIMITS.left,
                ..LIMITS
            },
            Limits {
                explained: by * LIMITS.explained,
                ..LIMITS
            },
            Limits {
                apart: by * LIMITS.apart,
                ..LIMITS
            },
            Limits {
                cancels: by * LIMITS.cancels,
                ..LIMITS
            },
            Limits {
                telling: by * LIMITS.telling,
                ..LIMITS
            },
            Limits {
                lines: LIMITS.lines.map(|l| by * l),
                ..LIMITS
            },
        ]
    });
    let ratios = [0.0, 0.3, 0.8].map(prepared);
    for limits in others.as_flattened().iter().chain([&LIMITS]) {
        let told = ratios.each_ref().map(|all| {
            let found = all
                .iter()
                .filter(|p| find_within(&p.series, &p.free, limits).is_some());
            found.count()
        });
        assert_eq!(told, [0, 8, 8], "{limits:?}");
    }
}

/// A weaker mode that beats with the decay many times: what its beat makes of the envelope is no rub.
#[test]
fn valid_a_partner_of_many_beats_is_told_and_no_rub() {
    let mut rng = ChaCha8Rng::seed_from_u64(44);
    for (ratio, apart) in [
        (0.1, 1.07),
        (0.2, 1.12),
        (0.2, 1.185),
        (0.3, 0.9),
        (0.15, 0.85),
    ] {
        let decay = |hz: f64, t: f64| {
            let natural = std::f64::consts::TAU * hz;
            (-0.01 * natural * t).exp() * (natural * t).cos()
        };
        let samples: Vec<f64> = (0..2000)
            .map(|i| {
                let t = f64::from(i) / 100.0;
                let shock: f64 = StandardNormal.sample(&mut rng);
                decay(3.784, t) + ratio * decay(apart * 3.784, t) + 2e-3 * shock
            })
            .collect();
        let found = super::super::fit_channels(&[Watched::displacement(&samples)], 100.0);
        let [decay] = found.as_slice() else {
            panic!("{ratio} {apart}: {found:?}");
        };
        let begins = decay.beside_friction.and_then(|friction| friction.begins);
        assert!(begins.is_none() || decay.beside.beat.is_some(), "{decay:?}");
        let other = decay.beside.beat.map(|beat| beat[1]);
        let other = other.or(decay.beside.mode.map(|mode| mode[0]));
        let other = other.expect("the other mode");
        assert!(
            (other / (apart * 3.784) - 1.0).abs() < 0.01,
            "{ratio} {apart}: {other}"
        );
        assert!(decay.periods > 20.0, "{ratio} {apart}: {}", decay.periods);
    }
}

/// An accelerometer that rests before a release: the jump there is the beginning, also beside a partner whose beat hides what
/// does not follow.
#[test]
fn valid_an_acceleration_that_jumps_from_rest_begins_there_beside_a_partner() {
    let mut rng = ChaCha8Rng::seed_from_u64(45);
    for (ratio, apart, noise) in [(0.26, 1.174, 0.03), (0.2, 1.185, 0.04), (0.16, 1.122, 0.08)] {
        let decay = |hz: f64, t: f64| {
            let natural = std::f64::consts::TAU * hz;
            (-0.01 * natural * t).exp() * (natural * t).cos()
        };
        let samples: Vec<f64> = (-100..1900)
            .map(|i| {
                let t = f64::from(i) / 100.0;
                let shock: f64 = StandardNormal.sample(&mut rng);
                let moves = decay(3.784, t) + ratio * decay(apart * 3.784, t);
                if i < 0 {
                    noise * shock
                } else {
                    3.0 * moves + noise * shock
                }
            })
            .collect();
        let channel = Watched::new(&samples, MotionSignal::Acceleration);
        let found = super::super::fit_channels(&[channel], 100.0);
        let [decay] = found.as_slice() else {
            panic!("{ratio} {apart}: {found:?}");
        };
        assert!((98..105).contains(&decay.first), "{}", decay.first);
        let begins = decay.beside_friction.and_then(|friction| friction.begins);
        assert_eq!(begins, None, "{decay:?}");
        // the damped frequency is 3.784 Hz
        let off = decay.natural_frequency_hz - 3.784 / (1.0f64 - 1e-4).sqrt();
        assert!(
            off.abs() < 3.0 * decay.natural_frequency_error_hz,
            "{decay:?}"
        );
        let mode = decay.beside.mode.map(|mode| mode[0]);
        let beat = decay.beside.beat.map(|beat| beat[1]);
        let other = mode.or(beat).expect("the other mode");
        assert!((other / (apart * 3.784) - 1.0).abs() < 0.01, "{other}");
    }
}

/// A partner near by beside noise of a tenth: what two decays leave is noise alone.
#[test]
fn valid_a_beat_is_told_beside_noise() {
    let mut rng = ChaCha8Rng::seed_from_u64(46);
    let tell = |ratio: f64, rng: &mut ChaCha8Rng| {
        let decay = |hz: f64, t: f64| {
            let natural = std::f64::consts::TAU * hz;
            (-0.015 * natural * t).exp() * (natural * t).cos()
        };
        let samples: Vec<f64> = (0..1200)
            .map(|i| {
                let t = f64::from(i) / 100.0;
                let shock: f64 = StandardNormal.sample(rng);
                decay(3.318, t) + ratio * decay(3.57, t) + 0.02 * shock
            })
            .collect();
        let prepared = Prepared::alone(&Cleared::plain(Watched::displacement(&samples)));
        let prepared = prepared.expect("a decay");
        find_within(&prepared.series, &prepared.free, &LIMITS)
    };
    for _ in 0..8 {
        assert!(tell(0.15, &mut rng).is_some());
        assert!(tell(0.0, &mut rng).is_none());
    }
}

/// Two modes that beat are fitted beside each other: f0 and β are those of one of them, which a fit of one decay has off.
#[test]
fn valid_a_decay_has_its_own_f0_and_beta_beside_a_partner_that_beats_with_it() {
    let mut rng = ChaCha8Rng::seed_from_u64(45);
    for _ in 0..6 {
        let ratio = rng.random_range(0.1..0.6);
        let apart: f64 = rng.random_range(0.06..0.15);
        let (own, other) = (
            rng.random_range(0.003..0.008),
            rng.random_range(0.003..0.008),
        );
        let decay = |hz: f64, beta: f64, t: f64| {
            let natural = std::f64::consts::TAU * hz;
            let damped = natural * (1.0 - beta * beta).sqrt();
            (-beta * natural * t).exp() * (damped * t).cos()
        };
        let samples: Vec<f64> = (0..2400)
            .map(|i| {
                let t = f64::from(i) / 100.0;
                let shock: f64 = StandardNormal.sample(&mut rng);
                decay(5.0, own, t) + ratio * decay(5.0 * (1.0 + apart), other, t) + 3e-3 * shock
            })
            .collect();
        let found = super::super::fit(&samples, 100.0).expect("a decay");
        assert!(found.structured_ratio < 0.02, "{ratio} {apart}: {found:?}");
        assert!(found.beside.mode.is_some(), "{ratio} {apart}: {found:?}");
        // the one that lasts may be taken though it begins weaker, as a rival of the other
        let partner_hz = 5.0 * (1.0 + apart);
        let near_hz = |hz: f64| (found.natural_frequency_hz - hz).abs();
        let (off_hz, beta) = if near_hz(5.0) < near_hz(partner_hz) {
            (near_hz(5.0), own)
        } else {
            assert!(other < own, "{ratio} {apart}: {found:?}");
            (near_hz(partner_hz), other)
        };
        assert!(off_hz < 5e-3, "{ratio} {apart}: {found:?}");
        let off = (found.damping_ratio - beta).abs();
        assert!(off < 0.05 * beta, "{ratio} {apart}: {beta} {found:?}");
    }
}
