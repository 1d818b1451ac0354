//! Two modes that beat.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use super::super::Watched;
use super::super::beat::{LIMITS, Limits, find_within};
use super::super::hum::Cleared;
use super::super::prepared::Prepared;

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
    all.filter_map(|samples| Prepared::of(&Cleared::plain(Watched::displacement(&samples))))
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
