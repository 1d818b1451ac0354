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
