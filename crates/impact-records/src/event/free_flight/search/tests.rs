use super::*;
use crate::event::free_flight::detect;
use crate::record::FlagCode;
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
fn what_one_cart_strikes_afterwards_does_not_hide_that_both_are_measured_along_one_axis() {
    let [mut x, y] = carts(0.6);
    let along: Vec<f64> = y.iter().map(|v| -v).collect();
    // at the end of the track, by hand: a fall without a flight after it
    let last = x.len() - 4;
    for (i, v) in x[last..].iter_mut().enumerate() {
        *v -= 0.4 * (i + 1) as f64;
    }
    let found = detected(&x, &along);
    assert!(found.impacts.is_empty());
    assert_eq!(found.flags[0].code, FlagCode::OppositeSign, "{found:?}");
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
        let error = impact.speed_error_m_s().unwrap() / before;
        assert!((-after / before - restitution).abs() < 2.0 * error.max(1e-3));
        assert!(error < 0.01, "{error}");
    }
}

/// Heights of a ball in air, m, from the exact flights under g and drag c v², with the times of its impacts.
fn in_air(restitution: f64, drag_per_m: f64, rate_hz: f64, count: usize) -> Vec<f64> {
    let g = 9.81f64;
    let (rate, end) = ((g * drag_per_m).sqrt(), (g / drag_per_m).sqrt());
    let rise_s = |up: f64| (up / end).atan() / rate;
    let top = |up: f64| (1.0 + (up / end).powi(2)).ln() / (2.0 * drag_per_m);
    let fall_s = |height: f64| (drag_per_m * height).exp().acosh() / rate;
    // height over the floor so long after an impact or, before the first one, after the release
    let falling = |from: f64, s: f64| from - (rate * s).cosh().ln() / drag_per_m;
    let rising = |up: f64, s: f64| {
        let angle = (up / end).atan();
        ((angle - rate * s).cos() / angle.cos()).ln() / drag_per_m
    };
    let down = |height: f64| end * (1.0 - (-2.0 * drag_per_m * height).exp()).sqrt();
    let height = |t: f64| {
        let (mut begin, mut up) = (fall_s(1.2), restitution * down(1.2));
        if t < begin {
            return falling(1.2, t);
        }
        loop {
            let flight = rise_s(up) + fall_s(top(up));
            if t < begin + flight {
                let s = t - begin;
                return if s < rise_s(up) {
                    rising(up, s)
                } else {
                    falling(top(up), s - rise_s(up))
                };
            }
            (begin, up) = (begin + flight, restitution * down(top(up)));
        }
    };
    (0..count).map(|i| height(i as f64 / rate_hz)).collect()
}

#[test]
fn valid_a_ball_that_the_air_slows_gives_the_restitution_of_its_impacts() {
    use rand::Rng;
    use rand::SeedableRng;
    use rand_distr::StandardNormal;
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_130);
    // steel, a tennis ball, a table tennis ball
    for drag_per_m in [1e-3, 0.02, 0.12] {
        for rate_hz in [120.0, 480.0] {
            let heights = in_air(0.8, drag_per_m, rate_hz, whole::index(2.2 * rate_hz));
            let noise = |_: &f64| -> f64 { 5e-4 * rng.sample::<f64, _>(StandardNormal) };
            let values: Vec<f64> = heights
                .iter()
                .map(noise)
                .zip(&heights)
                .map(|(n, h)| h + n)
                .collect();
            let record = Record::of(rate_hz, &[(Role::DisplacementX, &values)]);
            let kinematics = Kinematics::of(&record, RigKind::Single, 1);
            let found = detect(&kinematics, RigKind::Single, &[]);
            assert!(found.impacts.len() > 2, "{found:?}");
            let ratios = found.impacts.iter().map(|impact| {
                let [before, after] = [
                    impact.approach_speed_before_m_s,
                    impact.approach_speed_after_m_s,
                ];
                let (before, after) = (before.unwrap(), after.unwrap());
                let error = impact.speed_error_m_s().unwrap() / before;
                (-after / before, 1.28 * error)
            });
            let weights = |(ratio, error): (f64, f64)| [ratio / error.powi(2), error.powi(-2)];
            let [sum, all] = ratios
                .map(weights)
                .fold([0.0, 0.0], |s, w| [s[0] + w[0], s[1] + w[1]]);
            let (mean, error) = (sum / all, all.powf(-0.5));
            // without drag in the flights R of the last would be 0.02 less
            assert!(
                (mean - 0.8).abs() < 6e-3,
                "{drag_per_m} {rate_hz}: {mean} ± {error}"
            );
            assert!(error < 0.01, "{drag_per_m} {rate_hz}: {error}");
        }
    }
}

/// Two riders with bumpers that last and ring, friction, and a noise, drawn at random.
struct Bumpers {
    restitution: f64,
    approach: f64,
    contact_s: f64,
    friction: f64,
    ringing: f64,
    ring_hz: f64,
    ring_s: f64,
}

impl Bumpers {
    /// When the contact begins, s.
    const HIT_S: f64 = 0.6;

    fn random(rng: &mut impl rand::Rng) -> Self {
        let approach: f64 = rng.random_range(0.2..1.5);
        Self {
            restitution: rng.random_range(0.05..0.95),
            approach,
            contact_s: rng.random_range(0.004..0.06),
            friction: rng.random_range(0.0..0.05),
            ringing: rng.random_range(0.0..0.25) * approach,
            ring_hz: rng.random_range(12.0..80.0),
            ring_s: rng.random_range(0.02..0.1),
        }
    }

    /// Relative velocity, m/s, some time after the contact began.
    fn velocity(&self, t: f64) -> f64 {
        let after = t - self.contact_s;
        if t < 0.0 {
            return self.approach - self.friction * t;
        }
        if after < 0.0 {
            let share = 0.5 - 0.5 * (std::f64::consts::PI * t / self.contact_s).cos();
            return self.approach * (1.0 - (1.0 + self.restitution) * share);
        }
        let rings = (std::f64::consts::TAU * self.ring_hz * after).sin();
        self.friction * after - self.restitution * self.approach
            + self.ringing * (-after / self.ring_s).exp() * rings
    }

    /// Samples of the velocity and of its integral over 1.6 s.
    fn sampled(&self, rate_hz: f64) -> [Vec<f64>; 2] {
        let fine = 20;
        let count = crate::signal::whole::index(1.6 * rate_hz);
        let (mut place, mut places, mut speeds) = (0.0, Vec::new(), Vec::new());
        for i in 0..count * fine {
            let t = i as f64 / (rate_hz * fine as f64) - Self::HIT_S;
            let speed = self.velocity(t);
            if i % fine == 0 {
                places.push(place);
                speeds.push(speed);
            }
            place += speed / (rate_hz * fine as f64);
        }
        [speeds, places]
    }
}

/// What random bumpers of a seed show, by velocities or by a camera: impacts found, of those R held, and separation speeds
/// beyond any that was measured.
#[derive(Debug, Default)]
struct Bumped {
    found: usize,
    held: usize,
    outside: Vec<[f64; 3]>,
}

fn bumped((seed, by_camera): (u64, bool), all: usize, ringing: Ringing) -> Bumped {
    use rand::{Rng, SeedableRng};
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    let rate_hz = 500.0;
    let mut shown = Bumped::default();
    for _ in 0..all {
        let bumpers = Bumpers::random(&mut rng);
        let noise: f64 = if by_camera {
            rng.random_range(2e-6..2e-5)
        } else {
            rng.random_range(1e-3..5e-3)
        };
        let [speeds, places] = bumpers.sampled(rate_hz);
        // each mass has half of it, beside a motion of both
        let mut of_mass = |both: f64| -> Vec<f64> {
            let drift = |i: usize| if by_camera { i as f64 / rate_hz } else { 1.0 };
            let signal = if by_camera { &places } else { &speeds };
            let values = signal.iter().enumerate();
            values
                .map(|(i, v)| 0.5 * v + both * drift(i) + noise * rng.random_range(-1.7..1.7))
                .collect()
        };
        let (own, other) = (of_mass(0.1), of_mass(-0.1));
        let roles = if by_camera {
            [Role::DisplacementX, Role::DisplacementY]
        } else {
            [Role::VelocityX, Role::VelocityY]
        };
        let record = Record::of(rate_hz, &[(roles[0], &own), (roles[1], &other)]);
        let kinematics = Kinematics::of(&record, RigKind::Double, 1);
        for impact in Search::beside(&kinematics, RigKind::Double, ringing)
            .impacts(&[])
            .impacts
        {
            let separation = -impact.approach_speed_after_m_s.unwrap();
            let before = impact.approach_speed_before_m_s.unwrap();
            let error = impact.speed_error_m_s().unwrap();
            // the fastest mean over 6 ms after the impact, and what friction changes on the way
            let from = crate::signal::whole::index(impact.time_s * rate_hz);
            let means = kinematics.relative.velocity.as_ref().unwrap().values[from..]
                .windows(3)
                .map(|w| -robust::mean(w));
            let fastest = means.fold(0.0f64, f64::max);
            if separation > fastest + 0.01 * before {
                shown.outside.push([separation, fastest, before]);
            }
            let ratio = separation / before;
            let half = 1.96 * error * (1.0 + ratio * ratio).sqrt() / before;
            shown.found += 1;
            shown.held += usize::from((ratio - bumpers.restitution).abs() < half);
        }
    }
    shown
}

#[test]
fn prop_separation_speeds_are_within_what_was_measured_and_hold_the_truth_whatever_rings_or_lasts()
{
    for kind in [(741, false), (742, false), (743, true), (744, true)] {
        let all = 40;
        let shown = bumped(kind, all, RINGING);
        assert!(shown.outside.is_empty(), "{kind:?}: {shown:?}");
        assert!(
            (all * 8 / 10..=all).contains(&shown.found),
            "{kind:?}: {shown:?}"
        );
        assert!(shown.held * 100 >= 92 * shown.found, "{kind:?}: {shown:?}");
    }
}

#[test]
fn prop_separation_speeds_hold_the_truth_over_a_range_of_what_is_taken_for_ringing() {
    for (long, rings) in [(1, 3), (4, 3), (2, 2), (2, 6)] {
        for kind in [(745, false), (746, true)] {
            let shown = bumped(kind, 40, Ringing { long, rings });
            assert!(
                shown.outside.is_empty(),
                "{long} {rings} {kind:?}: {shown:?}"
            );
            assert!(
                shown.held * 100 >= 90 * shown.found,
                "{long} {rings} {kind:?}: {shown:?}"
            );
        }
    }
}

/// Places of a mass that slides down a slope against a bumper of a spring and a dashpot which does not pull, with the speeds at
/// which their force begins and ends: acceleration, speed at the start, length of the contact, damping ratio.
fn on_a_slope([force, start, contact_s, damping]: [f64; 4]) -> (Vec<f64>, [f64; 2]) {
    let omega = std::f64::consts::PI / contact_s;
    let (fine, rate_hz) = (200, 500.0);
    let step = 1.0 / (rate_hz * f64::from(fine));
    let (mut x, mut v) = (-0.3, start);
    let (mut places, mut speeds) = (Vec::new(), Vec::new());
    for i in 0..600 * fine {
        if i % fine == 0 {
            places.push(x);
        }
        let bumper = if x > 0.0 {
            (omega * omega * x + 2.0 * damping * omega * v).max(0.0)
        } else {
            0.0
        };
        if (bumper > 0.0) != (speeds.len() % 2 == 1) {
            speeds.push(v);
        }
        v += step * (force - bumper);
        x += step * v;
    }
    (places, [speeds[0], -speeds[1]])
}

#[test]
fn valid_a_soft_bumper_on_a_slope_leaves_r_in_its_interval() {
    of_soft_bumpers(Role::DisplacementX, 0.01..0.06, 0.03);
}

/// A contact of a tenth to a fifth of a second, as of a foam or of a pair of weak magnets: the slope changes the speeds by a
/// tenth while it lasts.
#[test]
fn valid_a_bumper_that_takes_a_fifth_of_a_second_leaves_r_in_the_middle_of_its_interval() {
    let off = of_soft_bumpers(Role::DisplacementX, 0.1..0.2, 0.12);
    assert!(off.abs() < 0.3, "{off} half widths");
}

#[test]
fn valid_a_velocity_alone_leaves_the_length_of_a_soft_contact_in_the_interval() {
    of_soft_bumpers(Role::VelocityX, 0.05..0.15, 0.12);
}

/// Whether R of soft bumpers is in intervals whose half widths are below a greatest one; its mean deviation in half widths.
fn of_soft_bumpers(role: Role, contacts_s: std::ops::Range<f64>, greatest: f64) -> f64 {
    use rand::{Rng, SeedableRng};
    use rand_distr::StandardNormal;
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_204);
    let (mut found, mut held, mut off) = (0, 0, 0.0);
    for _ in 0..40 {
        let (places, [before, after]) = on_a_slope([
            rng.random_range(0.05..0.5),
            rng.random_range(0.3..0.6),
            rng.random_range(contacts_s.clone()),
            rng.random_range(0.02..0.35),
        ]);
        let deviation = rng.random_range(1e-5..6e-5);
        let values: Vec<f64> = places
            .iter()
            .map(|x| x + deviation * rng.sample::<f64, _>(StandardNormal))
            .collect();
        let values = if role == Role::VelocityX {
            let speeds = values.windows(3).map(|w| 250.0 * (w[2] - w[0]));
            speeds.collect()
        } else {
            values
        };
        let record = Record::of(500.0, &[(role, &values)]);
        let kinematics = Kinematics::of(&record, RigKind::Single, 1);
        let detected = detect(&kinematics, RigKind::Single, &[]);
        let Some(impact) = detected.impacts.first() else {
            continue;
        };
        let approach = impact.approach_speed_before_m_s.unwrap();
        let ratio = -impact.approach_speed_after_m_s.unwrap() / approach;
        let error = impact.speed_error_m_s().unwrap();
        let half = 1.96 * error * (1.0 + ratio * ratio).sqrt() / approach;
        found += 1;
        held += usize::from((ratio - after / before).abs() < half);
        off += (ratio - after / before) / half;
        assert!(half < greatest, "{ratio} ± {half}");
    }
    assert!(found >= 36 && held * 100 >= 92 * found, "{held} of {found}");
    off / found as f64
}

/// A contact as smooth as rubber's, 40 ms at 500 Hz, after hands have braked the riders by nothing or by much.
#[test]
fn a_fall_is_one_contact_whole_and_not_what_slows_the_bodies_before_it() {
    let contact = |t: f64| 0.5 - 0.5 * (std::f64::consts::PI * t.clamp(0.0, 0.04) / 0.04).cos();
    let braking = |t: f64| 0.5 - 0.5 * (std::f64::consts::PI * t.clamp(0.0, 0.3) / 0.3).cos();
    for braked in [0.0, 0.3, 1.5] {
        let velocity: Vec<f64> = (0..1000)
            .map(|i| f64::from(i) / 500.0)
            .map(|t| 0.5 + braked - braked * braking(t - 0.3) - 0.9 * contact(t - 1.0))
            .collect();
        let mut series = crate::event::kinematics::Series::clean(velocity);
        series.noise = 1e-4;
        let falls = fall::find(&series, 0.5 + braked);
        let last = falls.last().expect("a fall");
        assert!(last.first.abs_diff(501) <= 2, "{braked}: {falls:?}");
        assert!(last.last.abs_diff(519) <= 2, "{braked}: {falls:?}");
    }
}

/// Positions of two riders by a camera: x is pushed until some time, coasts freely, and meets y at 1.4 s, whose speed
/// is given; a contact of 20 ms, equal masses.
fn ridden(
    restitution: f64,
    [x_m_s, y_m_s]: [f64; 2],
    pushed_s: f64,
    noise: (f64, &mut rand_chacha::ChaCha8Rng),
) -> [Vec<f64>; 2] {
    use rand_distr::{Distribution, StandardNormal};
    let (rate_hz, fine, contact_s, hit_s) = (200.0, 20, 0.02, 1.4);
    let closing = x_m_s - y_m_s;
    let changed = |t: f64| {
        let share = ((t - hit_s) / contact_s).clamp(0.0, 1.0);
        0.5 * (1.0 + restitution) * closing * (0.5 - 0.5 * (std::f64::consts::PI * share).cos())
    };
    let (mut places, mut at) = ([Vec::new(), Vec::new()], [0.0, 0.0]);
    let (deviation, rng) = noise;
    for i in 0..600 * fine {
        let t = f64::from(i) / (rate_hz * f64::from(fine));
        let speeds = [
            x_m_s * (t / pushed_s).min(1.0) - changed(t),
            y_m_s + changed(t),
        ];
        if i % fine == 0 {
            for (place, at) in places.iter_mut().zip(at) {
                let noise: f64 = StandardNormal.sample(rng);
                place.push(at + deviation * noise);
            }
        }
        for (at, speed) in at.iter_mut().zip(speeds) {
            *at += speed / (rate_hz * f64::from(fine));
        }
    }
    let [x, y] = places;
    [x, y.into_iter().map(|v| -v).collect()]
}

#[test]
fn prop_a_push_that_ends_within_a_flight_and_a_body_at_rest_leave_r_in_its_interval() {
    use rand::SeedableRng;
    // R, speeds, end of the push, noise
    let cases = [
        (0.8, [0.5, -0.1], 1.3, 2e-4),
        (0.6, [0.5, -0.1], 1.2, 5e-5),
        (0.8, [0.5, 0.0], 0.4, 2e-4),
        (1.0, [0.5, 0.0], 0.4, 1e-4),
    ];
    for (number, (restitution, speeds, pushed_s, noise)) in cases.into_iter().enumerate() {
        let (mut found, mut held) = (0, 0);
        for seed in 0..30 {
            let mut rng =
                rand_chacha::ChaCha8Rng::seed_from_u64(20_261 + 100 * number as u64 + seed);
            let [x, y] = ridden(restitution, speeds, pushed_s, (noise, &mut rng));
            let record = Record::of(
                200.0,
                &[(Role::DisplacementX, &x), (Role::DisplacementY, &y)],
            );
            let kinematics = Kinematics::of(&record, RigKind::Double, 1);
            for impact in detect(&kinematics, RigKind::Double, &[]).impacts {
                let before = impact.approach_speed_before_m_s.unwrap();
                let ratio = -impact.approach_speed_after_m_s.unwrap() / before;
                let error = impact.speed_error_m_s().unwrap();
                let half = 1.96 * error * (1.0 + ratio * ratio).sqrt() / before;
                found += 1;
                held += usize::from((ratio - restitution).abs() < half);
            }
        }
        assert!(found >= 24, "{number}: {found} found");
        assert!(held * 100 >= 80 * found, "{number}: {held} of {found} held");
    }
}

#[test]
fn two_balls_that_bounce_side_by_side_are_no_two_masses() {
    // heights above the floor, m, dropped together, 240 pictures a second
    let height = |restitution: f64| -> Vec<f64> {
        let (g, mut speed, mut fallen) = (9.81f64, 0.0, 0.0);
        let mut place = 1.0;
        let mut out = Vec::new();
        for i in 0..24 * 600 {
            if i % 24 == 0 {
                out.push(place);
            }
            let dt = 1.0 / (240.0 * 24.0);
            speed -= g * dt;
            place += speed * dt;
            if place < 0.0 && speed < 0.0 {
                fallen += 1.0;
                (place, speed) = (0.0, -restitution * speed);
            }
        }
        assert!(fallen > 2.0);
        out
    };
    let (x, y) = (height(0.9), height(0.6));
    let record = Record::of(
        240.0,
        &[(Role::DisplacementX, &x), (Role::DisplacementY, &y)],
    );
    let kinematics = Kinematics::of(&record, RigKind::Double, 1);
    let found = detect(&kinematics, RigKind::Double, &[]);
    assert!(found.impacts.is_empty(), "{found:?}");
    assert_eq!(
        found.flags[0].code,
        FlagCode::SeparateBodies,
        "{:?}",
        found.flags
    );
    assert!(found.flags[0].excludes);
}
