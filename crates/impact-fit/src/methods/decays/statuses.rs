//! Statuses of f0 and β beside what is said of the decays.

use impact_records::motion::{Motion, Observation};
use impact_records::signal::decay::{self, Decay, MotionSignal, Watched};
use std::f64::consts::TAU;

use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use super::pooled;
use crate::estimate::{Estimate, Status};
use crate::messages::{Note, Remark};
use crate::parameters::effect::Effects;

/// The decay of samples at 1 kHz.
fn fitted(seconds: f64, value: impl Fn(f64) -> f64) -> Decay {
    let count = impact_records::signal::whole::index(seconds * 1000.0);
    // rounded, as a converter does
    let rounded = |v: f64| (v * 2e3).round() / 2e3;
    let samples: Vec<f64> = (0..count)
        .map(|i| rounded(value(i as f64 / 1000.0)))
        .collect();
    decay::fit(&samples, 1000.0).unwrap()
}

fn observation(decays: Vec<Decay>) -> Observation {
    let mut own = Observation::of("decay", decays[0].natural_frequency_hz, Motion::Impactless);
    own.decays = decays;
    own
}

#[test]
fn a_tone_of_the_mains_gives_no_identified_f0_and_an_undamped_motion_does() {
    for (hz, status) in [(50.013, Status::Weak), (47.3, Status::Identified)] {
        let tone = fitted(6.0, |t| (TAU * hz * t).cos());
        let found = pooled(&[observation(vec![tone])], Effects::none()).unwrap();
        let f0 = found.parameters.natural_frequency_hz.unwrap();
        assert_eq!(f0.status, status, "{f0:?}");
        let is_hum = matches!(f0.note, Some(Note::MayBeHum { mains_hz }) if mains_hz == 50.0);
        assert_eq!(is_hum, status == Status::Weak, "{f0:?}");
        let beta = found.parameters.damping_ratio.unwrap();
        assert_eq!(beta.status, Status::Weak);
    }
}

#[test]
fn valid_a_long_decay_that_drifts_does_not_draw_f0_from_short_ones_that_do_not() {
    let decay =
        |rise: f64| move |t: f64| (-0.3 * t).exp() * (TAU * 8.0 * (t + rise * t * t / 20.0)).cos();
    let mut decays = vec![fitted(10.0, decay(0.02))];
    decays.extend([0.5, 0.45, 0.55].map(|seconds| fitted(seconds, decay(0.0))));
    let found = pooled(&[observation(decays)], Effects::none()).unwrap();
    assert!(
        found
            .remarks
            .iter()
            .any(|r| matches!(r, Remark::DecaysDrift { count: 1, .. })),
        "{:?}",
        found.remarks
    );
    let f0 = found.parameters.natural_frequency_hz.unwrap();
    let [low, high] = f0.interval95.unwrap();
    let undamped = 8f64.hypot(0.3 / TAU);
    assert!((low..=high).contains(&undamped), "{f0:?}");
}

#[test]
fn an_undamped_motion_that_drifts_has_a_frequency_between_its_ends() {
    let tone = fitted(3.0, |t| (TAU * 8.0 * (t + 2e-3 * t * t)).cos());
    assert!(tone.course.drift.is_some_and(|d| d.z_score() > 10.0));
    let found = pooled(&[observation(vec![tone])], Effects::none()).unwrap();
    let [low, high] = found
        .parameters
        .natural_frequency_hz
        .unwrap()
        .interval95
        .unwrap();
    assert!(7.9 < low && high < 8.2, "{low} {high}");
}

/// A pendulum, integrated by the classical Runge–Kutta method: its frequency rises toward that of small swings as it dies
/// away. Where the record shows that, the interval holds the latter.
#[test]
fn valid_the_interval_of_a_pendulum_holds_the_frequency_of_small_swings() {
    let (f0, beta, step_s) = (2.0, 0.004, 1e-3);
    let omega = TAU * f0;
    let slope = |[angle, rate]: [f64; 2]| {
        [
            rate,
            -omega * omega * angle.sin() - 2.0 * beta * omega * rate,
        ]
    };
    let plus = |[a, b]: [f64; 2], [c, d]: [f64; 2], h: f64| [h.mul_add(c, a), h.mul_add(d, b)];
    for release in [0.15, 0.3, 0.5] {
        let mut state = [release, 0.0];
        let angles: Vec<f64> = (0..12_000)
            .map(|_| {
                let now = state;
                let first = slope(now);
                let second = slope(plus(now, first, 0.5 * step_s));
                let third = slope(plus(now, second, 0.5 * step_s));
                let fourth = slope(plus(now, third, step_s));
                for (k, all) in [(first, 1.0), (second, 2.0), (third, 2.0), (fourth, 1.0)] {
                    state = plus(state, k, step_s * all / 6.0);
                }
                now[0]
            })
            .collect();
        let at = |t: f64| angles[impact_records::signal::whole::index((1000.0 * t).round())];
        let found = pooled(&[observation(vec![fitted(11.9, at)])], Effects::none()).unwrap();
        let estimate = found.parameters.natural_frequency_hz.unwrap();
        let [low, high] = estimate.interval95.unwrap();
        assert!((low..=high).contains(&f0), "{release}: {estimate:?}");
    }
}

#[test]
fn an_interval_that_what_changes_made_wide_is_weak_with_that_reason() {
    // lighter from the middle on, beside a steady decay that tells more
    let lighter = |t: f64| {
        let lost = if t < 1.0 {
            0.9 * t
        } else {
            0.9 + 0.5 * (t - 1.0)
        };
        f64::exp(-lost) * (TAU * 8.0 * t).cos()
    };
    let steady = |t: f64| (-0.5 * t).exp() * (TAU * 8.0 * t).cos();
    let decays = vec![fitted(2.0, lighter), fitted(8.0, steady)];
    let found = pooled(&[observation(decays)], Effects::none()).unwrap();
    let beta = found.parameters.damping_ratio.unwrap();
    assert_eq!(beta.status, Status::Weak, "{beta:?}");
    assert_eq!(beta.note, Some(Note::DampingChanges), "{beta:?}");
}

#[test]
fn a_tone_before_which_another_motion_died_is_not_surely_the_rig() {
    let mut tone = fitted(6.0, |t| (TAU * 47.3 * t).cos());
    tone.before = 3.0;
    let found = pooled(&[observation(vec![tone])], Effects::none()).unwrap();
    let f0 = found.parameters.natural_frequency_hz.unwrap();
    assert_eq!(
        (f0.status, f0.note),
        (Status::Weak, Some(Note::MayBeForced))
    );
}

#[test]
fn an_upper_limit_of_beta_is_no_nearer_to_zero_than_its_error_allows() {
    let mut grows = fitted(4.0, |t| (TAU * 5.0 * t).cos());
    grows.damping_ratio = -3e-3;
    grows.damping_ratio_error = 1e-3;
    grows.beside_friction = None;
    let found = pooled(&[observation(vec![grows])], Effects::none()).unwrap();
    let [low, high] = found.parameters.damping_ratio.unwrap().interval95.unwrap();
    assert!(low == 0.0 && high > 1.9e-3, "{high}");
}

#[test]
fn a_stop_by_hand_is_named() {
    let decay = |t: f64| (-0.4 * t).exp() * (TAU * 4.0 * t).cos();
    let stopped = fitted(6.0, |t| if t < 3.0 { decay(t) } else { 0.0 });
    let found = pooled(&[observation(vec![stopped])], Effects::all()).unwrap();
    let named = found.remarks.iter().find_map(|r| match r {
        Remark::DecaysStopped { count: 1, seconds } => Some(*seconds),
        _ => None,
    });
    assert!((named.unwrap() - 3.0).abs() < 0.02, "{:?}", found.remarks);
    assert_eq!(found.fits, Some(true));
}

#[test]
fn f0_whose_friction_may_begin_later_has_the_error_of_its_interval() {
    let decay = |t: f64| (-0.4 * t).exp() * (TAU * 4.0 * t).cos();
    let mut open = fitted(4.0, decay);
    let of = |decay: &Decay| {
        let found = pooled(&[observation(vec![decay.clone()])], Effects::all()).unwrap();
        found.parameters.natural_frequency_hz.unwrap()
    };
    let plain = of(&open);
    let friction = open.beside_friction.as_mut().unwrap();
    friction.open.natural_frequency = [0.02, 0.05];
    let wide = of(&open);
    let [low, high] = wide.interval95.unwrap();
    let [least, most] = plain.interval95.unwrap();
    assert!(low < 0.985 * least && high > 1.045 * most, "{low} {high}");
    let error = wide.standard_error.unwrap();
    assert!((0.2..0.26).contains(&(error / (high - low))), "{error}");
    assert_eq!(wide.status, Status::Weak);
    assert!(matches!(wide.note, Some(Note::Open { .. })), "{wide:?}");
}

#[test]
fn valid_friction_by_the_fall_of_the_amplitude_alone_is_told_where_the_damping_changes() {
    let mut decay = fitted(5.0, |t| (-0.4 * t).exp() * (TAU * 4.0 * t).cos());
    let friction = decay.beside_friction.as_mut().unwrap();
    (friction.added, friction.added_error) =
        (0.5 * decay.damping_ratio, 0.05 * decay.damping_ratio);
    friction.damping_ratio = 0.5 * decay.damping_ratio;
    (friction.by_fall, friction.open) = (true, Default::default());
    let of = |decay: &Decay| {
        let found = pooled(&[observation(vec![decay.clone()])], Effects::all()).unwrap();
        found.parameters.damping_ratio.unwrap()
    };
    decay.course.damping_z_score = 2.3;
    let doubtful = of(&decay);
    assert_eq!(doubtful.status, Status::Weak);
    assert!(
        doubtful.value.unwrap() > 0.9 * decay.damping_ratio,
        "{doubtful:?}"
    );
    let [low, high] = doubtful.interval95.unwrap();
    assert!(
        low < 0.5 * decay.damping_ratio && high > decay.damping_ratio,
        "{low} {high}"
    );
    decay.course.damping_z_score = 5.0;
    let told = of(&decay);
    assert!(told.value.unwrap() < 0.6 * decay.damping_ratio, "{told:?}");
}

/// A motion under x'' + 2βω x' + ω² x = −ω² r(t) sign x' from rest at one, in small steps: displacement, velocity over ω and
/// acceleration over ω² at a number of samples for each period.
fn rubbed(
    beta: f64,
    rest: &dyn Fn(f64) -> f64,
    [periods, per_period]: [usize; 2],
) -> Vec<[f64; 3]> {
    const STEPS: usize = 40;
    let step = TAU / (per_period * STEPS) as f64;
    let (mut x, mut v, mut sticks) = (1.0f64, 0.0f64, false);
    let mut out = Vec::new();
    for k in 0..periods * per_period * STEPS {
        let rest = rest(k as f64 * step / TAU);
        let force = |x: f64, v: f64| {
            let side = if v == 0.0 { -x.signum() } else { v.signum() };
            -2.0 * beta * v - x - rest * side
        };
        if k % STEPS == 0 {
            out.push([x, v, if sticks { 0.0 } else { force(x, v) }]);
        }
        let mut left = step;
        while left > 0.0 && !sticks {
            let half = v + 0.5 * left * force(x, v);
            let after = v + left * force(x + 0.5 * left * half, half);
            let turns = v != 0.0 && after * v <= 0.0;
            // the part of the step until it turns
            let part = if turns { left * v / (v - after) } else { left };
            x += 0.5 * part * (v + if turns { 0.0 } else { after });
            v = if turns { 0.0 } else { after };
            left -= part;
            sticks = turns && x.abs() <= rest;
        }
    }
    out
}

/// In how many decays f0 and β are held, and that something begins to rub is named.
#[derive(Debug, Default)]
struct Told {
    natural_frequency: usize,
    damping_ratio: usize,
    named: usize,
}

impl Told {
    /// Of a decay with these f0 and β.
    fn add(&mut self, found: &crate::methods::answer::MethodResult, [f0, beta]: [f64; 2]) {
        let holds = |estimate: Option<&Estimate>, value: f64| {
            let [low, high] = estimate.and_then(|e| e.interval95).unwrap();
            usize::from((low..=high).contains(&value))
        };
        self.natural_frequency += holds(found.parameters.natural_frequency_hz.as_ref(), f0);
        self.damping_ratio += holds(found.parameters.damping_ratio.as_ref(), beta);
        let later = |r: &Remark| matches!(r, Remark::DecaysRubbedLater { .. });
        self.named += usize::from(found.remarks.iter().any(later));
    }

    /// In how many either is.
    fn held(&self) -> usize {
        self.natural_frequency.min(self.damping_ratio)
    }
}

#[test]
fn prop_what_is_pressed_on_midway_is_no_friction_of_the_rig_whatever_the_sensor() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_129);
    let (f0, per_period) = (5.0, 60);
    for quantity in [
        MotionSignal::Displacement,
        MotionSignal::Velocity,
        MotionSignal::Acceleration,
    ] {
        let mut told = Told::default();
        let drawn = 8;
        for _ in 0..drawn {
            let beta: f64 = rng.random_range(0.005..0.02);
            let rig: f64 = rng.random_range(0.0..0.004);
            let begins: f64 = rng.random_range(5.0..8.0);
            let takes: f64 = rng.random_range(0.01..2.0);
            let more: f64 = rng.random_range(0.01..0.06);
            let rest = |t: f64| rig + more * ((t - begins) / takes).clamp(0.0, 1.0);
            let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
            let motion = rubbed(beta, &rest, [14, per_period]);
            let values: Vec<f64> = motion
                .iter()
                .map(|m| m[quantity as usize] + 1e-3 * normal())
                .collect();
            let channel = Watched::new(&values, quantity);
            let decays = decay::fit_channels(&[channel], f0 * per_period as f64);
            let found = pooled(&[observation(decays)], Effects::all()).unwrap();
            told.add(&found, [f0, beta]);
        }
        assert!(
            told.held() >= 6 && told.named >= 6,
            "{quantity:?}: {told:?} of {drawn}"
        );
    }
}

#[test]
fn prop_a_hand_that_stops_the_mass_over_some_periods_is_no_friction_of_the_rig() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_130);
    let (f0, drawn) = (6.0, 24);
    let mut told = Told::default();
    for _ in 0..drawn {
        let beta: f64 = rng.random_range(0.003..0.012);
        let stop: f64 = rng.random_range(12.0..40.0) / f0;
        let takes: f64 = rng.random_range(2.0..8.0) / f0;
        let phase: f64 = rng.random_range(0.0..TAU);
        let natural = TAU * f0;
        let damped = natural * f64::sqrt(1.0 - beta * beta);
        let samples: Vec<f64> = (0..impact_records::signal::whole::index(1.5 * stop * 300.0))
            .map(|i| {
                let t = i as f64 / 300.0;
                let free = f64::exp(-beta * natural * t) * (damped * t + phase).cos();
                let noise: f64 = StandardNormal.sample(&mut rng);
                free * (1.0 - (t - stop) / takes).clamp(0.0, 1.0) + 3e-3 * noise
            })
            .collect();
        let decay = decay::fit(&samples, 300.0).unwrap();
        let found = pooled(&[observation(vec![decay])], Effects::all()).unwrap();
        told.add(&found, [f0, beta]);
    }
    // 95 % less three standard deviations
    assert!(told.held() >= 20, "{told:?} of {drawn}");
    assert!(2 * told.named > drawn, "{told:?} of {drawn}");
}

/// Decays of one oscillator in media of unlike damping.
#[test]
fn valid_decays_of_unlike_damping_are_no_undamped_motion() {
    let decays: Vec<Decay> = [0.004, 0.02, 0.06]
        .map(|beta| {
            fitted(6.0, move |t| {
                (-TAU * 8.0 * beta * t).exp() * (TAU * 8.0 * t).cos()
            })
        })
        .into();
    let found = pooled(&[observation(decays)], Effects::all()).unwrap();
    let differ = |r: &Remark| matches!(r, Remark::DecaysDampingDiffers { .. });
    assert!(found.remarks.iter().any(differ), "{:?}", found.remarks);
    let damping = found.parameters.damping_ratio.unwrap();
    let [low, high] = damping.interval95.unwrap();
    assert!(low < 0.005 && high > 0.059, "{damping:?}");
    assert_eq!(damping.note, Some(Note::DampingsDiffer));
}

/// White noise of the amplitude's own size: what neighbours share of it by chance is no structure.
#[test]
fn valid_noise_of_the_amplitudes_size_is_no_structure() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_130);
    let natural = TAU * 9.0;
    for _ in 0..12 {
        let samples: Vec<f64> = (0..1200)
            .map(|i| {
                let t = f64::from(i) / 200.0;
                let noise: f64 = StandardNormal.sample(&mut rng);
                f64::exp(-0.002 * natural * t) * (natural * t).cos() + 0.45 * noise
            })
            .collect();
        let decay = decay::fit(&samples, 200.0).unwrap();
        let found = pooled(&[observation(vec![decay])], Effects::none()).unwrap();
        assert_eq!(found.fits, Some(true), "{:?}", found.remarks);
        let f0 = found.parameters.natural_frequency_hz.unwrap();
        let [low, high] = f0.interval95.unwrap();
        assert!(low < 9.01 && high > 8.99 && high - low < 0.1, "{f0:?}");
    }
}
