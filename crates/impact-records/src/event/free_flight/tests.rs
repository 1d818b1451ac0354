use super::*;
use crate::record::{Record, Role};

const RATE_HZ: f64 = 50.0;

/// Velocities of two carts: x is pushed up to 0.6 m/s, rolls freely and brakes by friction; at 2 s it
/// hits y, which rests. Masses 1 and 2, restitution as given.
fn carts(restitution: f64) -> [Vec<f64>; 2] {
    let friction = 0.02;
    let before = |t: f64| match t {
        t if t < 0.4 => 0.0,
        t if t < 0.8 => 0.3 * (1.0 - (std::f64::consts::PI * (t - 0.4) / 0.4).cos()),
        t => 0.6 - friction * (t - 0.8),
    };
    let speed = before(2.0);
    let x_after = speed * (1.0 - 2.0 * restitution) / 3.0;
    let y_after = -speed * (1.0 + restitution) / 3.0;
    let brake = |v: f64, t: f64| v - v.signum() * (friction * (t - 2.0)).min(v.abs());
    let time = |i: usize| i as f64 / RATE_HZ;
    let x = |i: usize| match time(i) {
        t if t < 2.0 => before(t),
        t => brake(x_after, t),
    };
    let y = |i: usize| match time(i) {
        t if t < 2.0 => 0.0,
        t => brake(y_after, t),
    };
    [(0..150).map(x).collect(), (0..150).map(y).collect()]
}

fn detected(x: &[f64], y: &[f64]) -> FreeFlights {
    let record = Record::of(RATE_HZ, &[(Role::VelocityX, x), (Role::VelocityY, y)]);
    detect(
        &Kinematics::of(&record, RigKind::Double, 1),
        RigKind::Double,
        &[],
    )
}

fn ratio(found: &FreeFlights) -> f64 {
    let impact = &found.impacts[0];
    let [before, after] = [
        impact.approach_speed_before_m_s,
        impact.approach_speed_after_m_s,
    ]
    .map(Option::unwrap);
    -after / before
}

#[test]
fn valid_two_carts_give_their_restitution_whatever_pushed_them() {
    for restitution in [0.0, 0.5, 0.98] {
        let [x, y] = carts(restitution);
        let found = detected(&x, &y);
        assert_eq!(found.impacts.len(), 1, "{restitution}: {found:?}");
        assert!((ratio(&found) - restitution).abs() < 5e-3, "{restitution}");
        let impact = &found.impacts[0];
        let before = impact.approach_speed_before_m_s.unwrap();
        assert!((before - (0.6 - 0.02 * 1.2)).abs() < 2e-3, "{before}");
        assert_eq!(found.flags.len(), 1, "{:?}", found.flags);
        assert_eq!(found.flags[0].code, FlagCode::ApproachCut);
    }
}

#[test]
fn carts_measured_the_other_way_round_are_turned_and_along_one_axis_are_refused() {
    let [x, y] = carts(0.6);
    let negative = |v: &[f64]| v.iter().map(|v| -v).collect::<Vec<f64>>();
    let turned = detected(&negative(&x), &negative(&y));
    assert!((ratio(&turned) - 0.6).abs() < 5e-3);
    assert_eq!(turned.flags[0].code, FlagCode::MeasuredAway);
    assert!(!turned.flags[0].excludes);
    let along = detected(&x, &negative(&y));
    assert!(along.impacts.is_empty());
    assert_eq!(along.flags[0].code, FlagCode::OppositeSign);
    assert!(along.flags[0].excludes);
}

#[test]
fn a_mass_that_is_pushed_into_the_stop_has_no_speed() {
    // Faster and faster up to the contact, then a free flight away.
    let value = |i: usize| match i {
        i if i < 40 => 0.5 * (i as f64 / 40.0).powi(3),
        i => -0.3 + 1e-3 * (i - 40) as f64,
    };
    let velocity: Vec<f64> = (0..100).map(value).collect();
    let record = Record::of(RATE_HZ, &[(Role::VelocityX, &velocity)]);
    let found = detect(
        &Kinematics::of(&record, RigKind::Single, 1),
        RigKind::Single,
        &[],
    );
    for impact in &found.impacts {
        let before = impact.approach_speed_before_m_s.unwrap();
        assert!(before < 0.56, "{before} m/s was never measured");
    }
}

#[test]
fn valid_a_ball_followed_by_a_camera_gives_its_restitution() {
    // Height below the start, m: falls of 9.81 m/s² on a floor 0.5 m below, R = 0.6.
    let (g, floor, restitution) = (9.81f64, 0.5f64, 0.6);
    let first = (2.0 * floor / g).sqrt();
    let speed = g * first;
    let second = first + 2.0 * restitution * speed / g;
    let height = |t: f64| match t {
        t if t < first => 0.5 * g * t * t,
        t if t < second => {
            let s = t - first;
            floor - restitution * speed * s + 0.5 * g * s * s
        }
        t => {
            let s = t - second;
            floor - restitution * restitution * speed * s + 0.5 * g * s * s
        }
    };
    let scatter = |i: usize| 2e-5 * (i as f64 * 2.399_963).sin();
    let values: Vec<f64> = (0..800)
        .map(|i| height(i as f64 / 1000.0) + scatter(i))
        .collect();
    let record = Record::of(1000.0, &[(Role::DisplacementX, &values)]);
    let found = detect(
        &Kinematics::of(&record, RigKind::Single, 1),
        RigKind::Single,
        &[],
    );
    assert_eq!(found.impacts.len(), 2, "{found:?}");
    for impact in &found.impacts {
        let before = impact.approach_speed_before_m_s.unwrap();
        let after = impact.approach_speed_after_m_s.unwrap();
        let error = impact.speed_error_m_s.unwrap() / before;
        assert!((-after / before - restitution).abs() < 2.0 * error.max(1e-3));
        assert!(error < 0.01, "{error}");
    }
}

#[test]
fn prop_no_separation_speed_is_outside_what_was_measured_whatever_rings_or_lasts() {
    use rand::{Rng, SeedableRng};
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(741);
    let (mut impacts, rate_hz) = (0, 500.0);
    for _ in 0..80 {
        let restitution: f64 = rng.random_range(0.05..0.95);
        let approach: f64 = rng.random_range(0.2..1.5);
        let contact_s: f64 = rng.random_range(0.004..0.06);
        let friction: f64 = rng.random_range(0.0..0.05);
        let ringing: f64 = rng.random_range(0.0..0.25) * approach;
        let ring_hz: f64 = rng.random_range(12.0..80.0);
        let noise: f64 = rng.random_range(1e-3..5e-3);
        let value = |i: usize| {
            let t = i as f64 / rate_hz - 0.6;
            let after = (t - contact_s).max(0.0);
            let free = match t {
                t if t < 0.0 => approach - friction * (t + 0.6),
                t if t < contact_s => {
                    let share = 0.5 - 0.5 * (std::f64::consts::PI * t / contact_s).cos();
                    approach * (1.0 - (1.0 + restitution) * share)
                }
                _ => -restitution * approach + friction * after,
            };
            let rings =
                ringing * (-after / 0.08).exp() * (std::f64::consts::TAU * ring_hz * after).sin();
            free + if after > 0.0 { rings } else { 0.0 }
        };
        let x: Vec<f64> = (0..800)
            .map(|i| value(i) + noise * rng.random_range(-1.7..1.7))
            .collect();
        // each mass has half of it, beside a motion of both
        let of_mass = |both: f64| x.iter().map(|v| 0.5 * v + both).collect::<Vec<f64>>();
        let (own, other) = (of_mass(0.1), of_mass(-0.1));
        let record = Record::of(
            rate_hz,
            &[(Role::VelocityX, &own), (Role::VelocityY, &other)],
        );
        let kinematics = Kinematics::of(&record, RigKind::Double, 1);
        for impact in detect(&kinematics, RigKind::Double, &[]).impacts {
            let separation = -impact.approach_speed_after_m_s.unwrap();
            let before = impact.approach_speed_before_m_s.unwrap();
            // over means of 6 ms after the impact, up to what friction changes on the way
            let from = crate::signal::whole::index(impact.time_s * rate_hz);
            let means = x[from..]
                .windows(3)
                .map(|w| -crate::signal::robust::mean(w));
            let fastest = means.fold(0.0f64, f64::max);
            assert!(
                separation <= fastest + 0.01 * approach,
                "{separation} of {fastest}"
            );
            assert!(separation <= 1.3 * before);
            impacts += 1;
        }
    }
    assert!(impacts > 40, "{impacts}");
}
