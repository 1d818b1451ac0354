//! Invariants of the simulator over random machines and starts, and the hard cases of the search
//! for the next impact.

use proptest::prelude::*;

use super::crossing::first_zero;
use super::params::Asymmetry;
use super::path::{C64, Mode, Path};
use super::*;

fn run(m: &Machine, setting: Setting, start: Initial, periods: f64) -> Trajectory {
    simulate(m, setting, start, periods * setting.period()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn prop_no_penetration_and_no_gain_of_energy(
        eta in 0.4..3.0f64, rho in -0.5..3.0f64, r in 0.0..1.0f64, beta in 0.0..0.3f64,
        stiffness in 0.8..1.2f64, mass in 0.7..1.4f64, v in -1.0..1.0f64,
    ) {
        let m = Machine::asymmetric(beta, r, Asymmetry { stiffness, mass, drive_amplitude: 0.9 });
        let x = rho.min(0.0) - 0.1;
        let setting = Setting::new(eta, rho);
        let t = run(&m, setting, Initial { x, vx: v, y: x, vy: -v }, 12.0);
        let (mx, my) = (m.x.mass, m.y.unwrap().mass);
        for i in &t.impacts {
            let before = mx * i.vx_before.powi(2) + my * i.vy_before.powi(2);
            let after = mx * i.vx_after.powi(2) + my * i.vy_after.powi(2);
            prop_assert!(after <= before * (1.0 + 1e-12));
            let momentum = mx * i.vx_before - my * i.vy_before;
            prop_assert!((mx * i.vx_after - my * i.vy_after - momentum).abs() < 1e-11);
            prop_assert!(i.approach_speed > 0.0 && i.separation_speed >= 0.0);
        }
        let end = t.end();
        for s in t.sample((0..4000).map(|k| end * f64::from(k) / 4000.0)) {
            prop_assert!(s.x + s.y - 2.0 * rho < 1e-10, "{}", s.x + s.y - 2.0 * rho);
        }
    }

    #[test]
    fn prop_symmetric_double_is_the_single_and_v_is_untouched(
        eta in 0.5..2.5f64, rho in 0.1..2.0f64, r in 0.0..0.95f64, beta in 0.02..0.2f64,
        d in -0.5..0.5f64, vd in -0.5..0.5f64,
    ) {
        let setting = Setting::new(eta, rho);
        // U = X + Y is twice the single mass, whatever V = X − Y does
        let double = run(&Machine::symmetric(beta, r), setting, Initial { x: d, y: -d, vx: vd, vy: -vd }, 4.0);
        let single = run(&Machine::single(beta, r), setting, Initial::rest(), 4.0);
        let count = double.impacts.len().min(single.impacts.len()).min(5);
        prop_assert!(double.impacts.len().abs_diff(single.impacts.len()) <= 1);
        for k in 0..count {
            let (a, b) = (&double.impacts[k], &single.impacts[k]);
            prop_assert!((a.tau - b.tau).abs() < 1e-8, "{} {}", a.tau, b.tau);
            prop_assert!((a.approach_speed - 2.0 * b.approach_speed).abs() < 1e-7);
            let jump = (a.vx_after - a.vy_after) - (a.vx_before - a.vy_before);
            prop_assert!(jump.abs() < 1e-12);
        }
    }

    #[test]
    fn prop_a_shift_by_a_drive_period_changes_nothing(
        eta in 0.5..2.5f64, rho in 0.1..2.0f64, r in 0.0..0.95f64, phase in 0.0..6.0f64,
    ) {
        let m = Machine::symmetric(0.1, r);
        let setting = Setting { phase, ..Setting::new(eta, rho) };
        let later = Setting { phase: phase + std::f64::consts::TAU, ..setting };
        let (a, b) = (run(&m, setting, Initial::rest(), 4.0), run(&m, later, Initial::rest(), 4.0));
        for (p, q) in a.impacts.iter().zip(&b.impacts).take(5) {
            prop_assert!((p.tau - q.tau).abs() < 1e-9);
        }
    }

    #[test]
    fn prop_the_first_zero_is_the_first(
        a in 0.1..3.0f64, phase in 0.0..6.28f64, eta in 0.3..3.0f64,
        zr in -2.0..2.0f64, zi in -2.0..2.0f64, level in 0.05..3.0f64,
    ) {
        let mut path = Path::constant(0.0, eta);
        path.force = C64::from_polar(a, phase);
        let exponent = C64::new(-0.05, 0.998);
        path.add_mode(Mode { amplitude: C64::new(zr, zi), exponent });
        path.polynomial[0] = level - path.at(0.0)[0];
        let found = first_zero(&path, 30.0).unwrap_or(30.0);
        for k in 1..30_000 {
            let t = found * f64::from(k) / 30_000.0;
            prop_assert!(path.at(t)[0] > -1e-13, "passed a zero at {t} before {found}");
        }
        if found < 30.0 {
            prop_assert!(path.at(found)[0].abs() < 1e-12);
        }
    }
}

/// 1 + ε − cos t, which touches zero at t = 2π for ε = 0.
fn touching(epsilon: f64) -> Path {
    let mut path = Path::constant(1.0 + epsilon, 1.0);
    path.force = C64::new(-1.0, 0.0);
    path
}

#[test]
fn valid_grazing_on_both_sides() {
    let half = |path: &Path| {
        // start half a turn away, where the path is far from zero
        let mut p = *path;
        p.force = C64::new(1.0, 0.0);
        first_zero(&p, 6.0)
    };
    for epsilon in [1e-3, 1e-6, 1e-9, 1e-12] {
        assert!(half(&touching(epsilon)).is_none(), "{epsilon}");
        let hit = half(&touching(-epsilon)).expect("crosses");
        // cos(π − x) = −(1 − ε): x = √(2ε) before π
        assert!(
            (std::f64::consts::PI - hit - (2.0 * epsilon).sqrt()).abs()
                < 1e-3 * epsilon.sqrt() + 1e-8
        );
    }
}

#[test]
fn valid_two_crossings_within_a_short_time_are_not_stepped_over() {
    // below zero for 2·1e-5 of a period only
    let epsilon = 5e-11;
    let mut p = touching(-epsilon);
    p.force = C64::new(1.0, 0.0);
    let hit = first_zero(&p, 6.0).expect("found");
    assert!((std::f64::consts::PI - hit - 1e-5).abs() < 1e-7);
    assert!((-p.at(hit)[1] - 1e-5).abs() < 1e-7);
}

#[test]
fn valid_an_impact_right_after_an_impact() {
    // leaving with speed v against a = 1: back after 2v, however small v is
    for v in [1e-3, 1e-5, 1e-7] {
        let path = Path::parabola(0.0, v, -1.0);
        let hit = first_zero(&path, 1.0).expect("comes back");
        assert!((hit - 2.0 * v).abs() < 1e-9 * v, "{v}: {hit}");
        assert!((-path.at(hit)[1] - v).abs() < 1e-9 * v);
    }
}

#[test]
fn valid_a_tangential_start_leaves() {
    // f = t³/6: value, slope and curvature vanish at the start
    let mut path = Path::constant(0.0, 1.0);
    path.force = C64::new(0.0, 1.0);
    path.polynomial = [0.0, 1.0, 0.0];
    // t − sin t grows without bound
    assert!(first_zero(&path, 100.0).is_none());
}
