//! The model against published numbers, closed forms and independent arithmetic.

use std::f64::consts::{PI, TAU};

use super::boundary::*;
use super::orbit::{orbits, stable_orbit};
use super::params::Asymmetry;
use super::*;

fn close(got: f64, want: f64, tolerance: f64) {
    assert!(
        (got - want).abs() <= tolerance,
        "got {got}, want {want} ± {tolerance}"
    );
}

#[test]
fn valid_paper_fig2_plastic_impacts_and_dead_zones() {
    let setting = Setting {
        phase: PI / 4.0,
        ..Setting::new(0.95, 0.7)
    };
    let start = Initial {
        x: -1.0,
        vx: 1.5,
        y: -3.0,
        vy: 2.5,
    };
    let period = setting.period();
    let t = simulate(&Machine::symmetric(0.1, 0.0), setting, start, 3.0 * period).unwrap();
    let want = [
        (0.1589, 4.9422),
        (0.8846, 4.6027),
        (1.8677, 4.4129),
        (2.8677, 4.4129),
    ];
    assert_eq!(t.impacts.len(), want.len());
    for (impact, (tau, w)) in t.impacts.iter().zip(want) {
        close(impact.tau / period, tau, 6e-5);
        close(impact.approach_speed, w, 6e-5);
    }
    let kinds: Vec<_> = t.impacts.iter().map(|i| i.kind).collect();
    assert_eq!(kinds[0], ImpactKind::Plastic);
    assert!(kinds[1..].iter().all(|k| *k == ImpactKind::Stick));
    assert!(t.impacts[1..].iter().all(|i| i.dead_zone > 0.05));
}

#[test]
fn valid_paper_fig5_greatest_approach_speeds() {
    let greatest = |r: f64| {
        (0..6000)
            .filter_map(|i| {
                let eta = 1.0 + f64::from(i) * 1e-3 / 6.0;
                let o = stable_orbit(&Machine::symmetric(0.005, r), Setting::new(eta, 3.0), 1);
                o.unwrap().map(|o| (eta, o.approach_speed))
            })
            .fold((0.0, 0.0), |m, p| if p.1 > m.1 { p } else { m })
    };
    for (r, eta, w) in [
        (0.0, 1.189, 9.253),
        (0.3, 1.304, 9.533),
        (0.6, 1.459, 11.890),
        (0.9, 1.753, 28.175),
    ] {
        let (at, speed) = greatest(r);
        close(speed, w, 2e-3);
        close(at, eta, 1.5e-3);
    }
    let o = stable_orbit(&Machine::symmetric(0.005, 0.9), Setting::new(1.5, 3.0), 1).unwrap();
    close(o.unwrap().approach_speed, 13.646, 5e-4);
}

#[test]
fn valid_saddle_node_and_doubling_in_closed_form() {
    for m in [Machine::symmetric(0.07, 0.9), Machine::single(0.07, 0.9)] {
        for (eta, rho) in [(1.1, 6.351142), (1.3, 4.151754), (1.6, 1.812702)] {
            let p = rho_s2(&m, eta, 1).unwrap();
            close(p.rho, rho, 6e-7);
            assert!(p.is_valid());
            close(eta_s2(&m, rho, 1).unwrap().eta, eta, 1e-6);
        }
        let p = rho_s1(&m, 0.9, 1).unwrap();
        close(p.rho, 1.760461, 6e-7);
        assert!(p.is_valid());
        for (eta, rho) in [(1.1, 3.840), (1.3, 1.401), (1.9, 0.381)] {
            close(rho_grazing(&m, eta), rho, 6e-4);
        }
    }
}

#[test]
fn valid_orbits_of_known_speed() {
    let m = Machine::single(0.07, 0.9);
    let o = stable_orbit(&m, Setting::new(1.2, 2.0), 1)
        .unwrap()
        .unwrap();
    close(o.approach_speed, 2.413516, 6e-7);
    let m = Machine::symmetric(0.02, 0.3);
    let o = stable_orbit(&m, Setting::new(1.1, 3.0), 1)
        .unwrap()
        .unwrap();
    close(o.approach_speed, 6.534558, 6e-7);
}

#[test]
fn valid_paper_fig4_boundaries_along_line_q() {
    let m = Machine::symmetric(0.002, 0.0);
    let g1 = |eta: f64| rho_grazing(&m, eta) - 3.0;
    close(super::orbit::bisect(g1, 0.5, 0.95), 0.8165, 6e-5);
    close(super::orbit::bisect(g1, 1.05, 1.5), 1.1546, 1.1e-4);
    // the printed values are from sweeps in steps: a jump comes early, never late
    let s2 = eta_s2(&m, 3.0, 1).unwrap().eta;
    close(s2, 1.2728, 3e-4);
    let exists = |eta| {
        stable_orbit(&m, Setting::new(eta, 3.0), 1)
            .unwrap()
            .is_some()
    };
    assert!(exists(s2 - 1e-6) && !exists(s2 + 1e-6));
    let s1 = |eta: f64| rho_s1(&m, eta, 1).unwrap().rho - 3.0;
    close(super::orbit::bisect(s1, 0.87, 0.92), 0.889, 6e-4);
}

#[test]
fn orbit_is_periodic_in_the_simulator() {
    let asymmetry = Asymmetry {
        drive_amplitude: 0.95,
        stiffness: 0.97,
        mass: 1.2,
    };
    for m in [
        Machine::single(0.07, 0.9),
        Machine::symmetric(0.07, 0.9),
        Machine::asymmetric(0.07, 0.8, asymmetry),
    ] {
        for o in orbits(&m, Setting::new(1.25, 2.2), 1).unwrap() {
            let s = o.after;
            let start = Initial {
                x: s.x,
                vx: s.vx,
                y: s.y,
                vy: s.vy,
            };
            let t = simulate(&m, o.setting, start, 1.01 * o.period()).unwrap();
            assert!(o.exists());
            close(t.impacts[0].tau, o.period(), 1e-10);
            close(t.impacts[0].approach_speed, o.approach_speed, 1e-10);
            close(t.impacts[0].vx_after, s.vx, 1e-10);
            let (a, b) = (o.at(1.0), t.at(1.0));
            close(a.x, b.x, 1e-12);
            close(a.vy, b.vy, 1e-12);
        }
    }
}

#[test]
fn multipliers_match_finite_differences() {
    let asymmetry = Asymmetry {
        drive_amplitude: 0.9,
        stiffness: 1.1,
        mass: 0.8,
    };
    for m in [
        Machine::symmetric(0.05, 0.7),
        Machine::asymmetric(0.05, 0.7, asymmetry),
    ] {
        let o = stable_orbit(&m, Setting::new(1.2, 2.0), 1)
            .unwrap()
            .unwrap();
        // stroboscopic map half a period after the impact
        let half = 0.5 * o.period();
        let s = o.at(half);
        let base = [s.x, s.vx, s.y, s.vy];
        let phase = o.phase_at_impact + half * 1.2;
        let map = |z: [f64; 4]| {
            let start = Initial {
                x: z[0],
                vx: z[1],
                y: z[2],
                vy: z[3],
            };
            let setting = Setting { phase, ..o.setting };
            let mut sim = Simulator::new(&m, setting, start).unwrap();
            sim.advance(o.period(), &mut |_: &Impact| {});
            let e = sim.state();
            [e.x, e.vx, e.y, e.vy]
        };
        let mut jacobian = nalgebra::Matrix4::zeros();
        for k in 0..4 {
            let (mut up, mut down) = (base, base);
            up[k] += 1e-5;
            down[k] -= 1e-5;
            let (fu, fd) = (map(up), map(down));
            for i in 0..4 {
                jacobian[(i, k)] = (fu[i] - fd[i]) / 2e-5;
            }
        }
        let values = super::variation::eigenvalues(&m, &jacobian);
        for (a, b) in values.iter().zip(&o.multipliers) {
            close(a.norm(), b.norm(), 1e-8);
            close(a.re, b.re, 1e-8);
        }
    }
}

#[test]
fn valid_cart_on_incline_bounces_geometrically() {
    // v0 = √(2(a−f)d); each flight keeps √((a−f)/(a+f)) of the speed, each impact R
    let m = Machine::on_incline(2.0, 0.1, 0.9);
    let start = Initial {
        x: -1.0,
        ..Initial::rest()
    };
    let t = simulate(&m, Setting::new(1.0, 0.0), start, 100.0).unwrap();
    let v0 = (2.0f64 * 1.9).sqrt();
    let kept = (1.9f64 / 2.1).sqrt();
    close(t.impacts[0].approach_speed, v0, 1e-12);
    close(
        t.impacts[5].approach_speed,
        v0 * (0.9 * kept).powi(5),
        1e-12,
    );
    let last = t.impacts.last().unwrap();
    assert_eq!(last.kind, ImpactKind::ChatterEnd);
    let flight = |v: f64| v / 2.1 + v * kept / 1.9;
    close(
        last.tau,
        v0 / 1.9 + flight(0.9 * v0) / (1.0 - 0.9 * kept),
        1e-9,
    );
    close(t.at(99.0).x, 0.0, 1e-12);
}

#[test]
fn complete_chatter_ends_and_releases() {
    // ρ slightly below 1 with slow drive: long press, chatter, release
    let m = Machine::symmetric(0.05, 0.5);
    let t = simulate(
        &m,
        Setting::new(0.2, 0.3),
        Initial::rest(),
        10.0 * TAU / 0.2,
    )
    .unwrap();
    let ends = t
        .impacts
        .iter()
        .filter(|i| i.kind == ImpactKind::ChatterEnd)
        .count();
    assert!(ends >= 9, "{ends}");
    for i in &t.impacts {
        assert!(i.kind != ImpactKind::ChatterEnd || i.dead_zone > 0.1);
    }
    let gap = |tau: f64| 0.6 - t.at(tau).x - t.at(tau).y;
    let worst = (0..100_000)
        .map(|k| gap(f64::from(k) * t.end() / 1e5))
        .fold(1.0, f64::min);
    assert!(worst > -1e-11, "{worst}");
}

#[test]
fn valid_preload_keeps_the_masses_sticking() {
    let m = Machine::symmetric(0.05, 0.5);
    let start = Initial {
        x: -1.5,
        y: -1.5,
        ..Initial::rest()
    };
    let t = simulate(&m, Setting::new(0.9, -1.5), start, 50.0).unwrap();
    assert!(t.impacts.is_empty());
    assert_eq!(t.arcs.len(), 1);
    assert!(t.arcs[0].sticking);
    // just above ρp = −1 the force vanishes once a period
    let start = Initial {
        x: -0.9,
        y: -0.9,
        ..Initial::rest()
    };
    let t = simulate(&m, Setting::new(0.9, -0.9), start, 50.0).unwrap();
    assert!(!t.impacts.is_empty());
}

#[test]
fn newton_orbits_match_simulated_motions() {
    let asymmetry = Asymmetry {
        drive_amplitude: 0.95,
        stiffness: 1.0,
        mass: 1.0,
    };
    for (m, eta, rho) in [
        (Machine::symmetric(0.07, 0.9), 0.9, 1.6),
        (Machine::symmetric(0.07, 0.9), 2.6, 0.1),
        (Machine::asymmetric(0.07, 0.8, asymmetry), 0.75, 0.8),
        (Machine::symmetric(0.07, 0.9), 0.7, 0.7),
    ] {
        let setting = Setting::new(eta, rho);
        let watch = Watch {
            settle_periods: 600.0,
            ..Watch::default()
        };
        let (motion, impacts) = settle(&m, setting, Initial::rest(), &watch).unwrap();
        let SettledMotion::Periodic { p, n, .. } = motion else {
            panic!("{eta} {rho} {motion:?}")
        };
        let last = &impacts[impacts.len() - p as usize..];
        let guess = PeriodicOrbit::from_impacts(last, setting, n).unwrap();
        let orbit = guess.clone().solve(&m).unwrap();
        println!(
            "{eta} {rho}: {p}/{n} {:?}",
            orbit
                .multipliers(&m)
                .iter()
                .map(|c| c.norm())
                .collect::<Vec<_>>()
        );
        close((orbit.unknowns() - guess.unknowns()).amax(), 0.0, 1e-6);
        assert!(orbit.residual(&m).amax() < 1e-11);
        assert_eq!(orbit.existence(&m), Existence::Exists);
        assert!(orbit.is_stable(&m));
        if p == 1 {
            let closed = stable_orbit(&m, setting, n).unwrap().unwrap();
            close(closed.approach_speed, orbit.speeds[0], 1e-11);
            for (a, b) in closed.multipliers.iter().zip(orbit.multipliers(&m)) {
                close(a.norm(), b.norm(), 1e-9);
            }
        }
    }
}

#[test]
fn masses_stick_for_all_time_below_rho_p() {
    let asymmetry = params::Asymmetry {
        drive_amplitude: 0.8,
        stiffness: 1.3,
        mass: 1.5,
    };
    let machines = [
        Machine::single(0.1, 0.0),
        Machine::symmetric(0.1, 0.0),
        Machine::asymmetric(0.1, 0.0, asymmetry),
    ];
    for (machine, eta) in machines.iter().zip([0.8, 1.3, 0.9]) {
        let edge = boundary::rho_sticking(machine, eta);
        let stays = |rho: f64| {
            // in contact and at rest; the sticking masses' own vibration has died away
            let start = Initial::both(rho, 0.0);
            let mut s = Simulator::new(machine, Setting::new(eta, rho), start).unwrap();
            s.advance(400.0, &mut |_: &Impact| {});
            let mut apart = false;
            for _ in 0..2000 {
                s.advance(0.01, &mut |_: &Impact| {});
                apart |= !s.is_sticking();
            }
            !apart
        };
        assert!(stays(edge - 1e-3), "{edge}");
        assert!(!stays(edge + 1e-3), "{edge}");
    }
    assert!((boundary::rho_sticking(&machines[1], 2.0) + 1.0).abs() < 1e-12);
}

#[test]
fn boundaries_at_a_clearance_are_those_at_their_frequency() {
    let machine = Machine::symmetric(0.07, 0.9);
    for p in boundary::etas_s1(&machine, 1.9, 1) {
        assert!((rho_s1(&machine, p.eta, 1).unwrap().rho - 1.9).abs() < 1e-8);
    }
    let grazing = boundary::etas_grazing(&machine, 2.0);
    assert_eq!(grazing.len(), 2);
    for eta in grazing {
        assert!((rho_grazing(&machine, eta) - 2.0).abs() < 1e-9);
    }
}

#[test]
fn every_impact_follows_the_law_of_its_speed() {
    let laws = [
        Restitution::Table(vec![(0.0, 0.95), (2.0, 0.8), (6.0, 0.6)]),
        Restitution::PowerLaw {
            coefficient: 0.1,
            exponent: 0.25,
            floor: 0.3,
        },
        Restitution::Exponential {
            slow: 0.95,
            fast: 0.5,
            speed: 2.0,
        },
    ];
    let asymmetry = Asymmetry {
        drive_amplitude: 0.95,
        stiffness: 0.95,
        mass: 1.2,
    };
    for law in laws {
        let m = Machine::asymmetric(0.05, 0.0, asymmetry).with_restitution(law.clone());
        let t = simulate(&m, Setting::new(0.9, 0.8), Initial::rest(), 80.0).unwrap();
        let bounces = t.impacts.iter().filter(|i| i.kind == ImpactKind::Bounce);
        let mut seen = (f64::MAX, 0.0_f64);
        for i in bounces {
            let r = law.at(i.approach_speed);
            close(
                i.separation_speed,
                r * i.approach_speed,
                1e-13 * (1.0 + i.approach_speed),
            );
            seen = (seen.0.min(r), seen.1.max(r));
        }
        assert!(seen.1 - seen.0 > 0.02, "{seen:?}: the law was not tried");
    }
}

#[test]
fn valid_a_nearly_elastic_chatter_is_summed_up_not_cut_off() {
    let m = Machine::single(0.05, 0.99);
    let setting = Setting::new(0.02, 0.3);
    let t = simulate(&m, setting, Initial::rest(), 3.0 * setting.period()).unwrap();
    let before: Vec<usize> = (0..t.impacts.len())
        .filter(|&i| t.impacts[i].kind == ImpactKind::ChatterEnd)
        .collect();
    assert!(!before.is_empty());
    // R^n = 1e-13 takes some 1500 impacts at half the exponent: far beyond any cap
    assert!(before[0] > 500, "{before:?}");
    // the geometric sequence goes on into its end
    let i = before[0];
    let [a, b, end] = [i - 2, i - 1, i].map(|k| t.impacts[k].tau);
    let left = (b - a) * 0.99 / (1.0 - 0.99);
    assert!((end - b - left).abs() < 0.05 * left, "{} {left}", end - b);
}

#[test]
fn valid_a_chatter_whose_restitution_tends_to_one_is_summed_up() {
    let (coefficient, exponent) = (0.3, 0.2);
    let law = Restitution::PowerLaw {
        coefficient,
        exponent,
        floor: 0.0,
    };
    let machine = Machine::on_incline(1.0, 0.0, 0.0).with_restitution(law.clone());
    let start = Initial {
        x: -0.5,
        ..Initial::rest()
    };
    let motion = simulate(&machine, Setting::new(1.0, 0.0), start, 40.0).unwrap();
    let rest = motion.impacts.last().unwrap();
    assert_eq!(rest.kind, ImpactKind::ChatterEnd);
    // the first impact at τ = 1 with speed 1, then flights of 2v
    let (mut tau, mut v) = (1.0, 1.0);
    for _ in 0..1_000_000 {
        v *= law.at(v);
        tau += 2.0 * v;
    }
    assert!((rest.tau - tau).abs() < 1e-6, "{} {tau}", rest.tau);
}

#[test]
fn valid_an_alternation_keeps_the_share_that_its_multiplier_says() {
    use super::boundary::alternating_of_branch;
    use super::orbit::{Branch, orbit_with_speed};
    use super::variation::{free_flow, saltation};
    let (eta, r) = (0.9, 0.8);
    let machine = Machine::symmetric(0.06, r);
    let branch = Branch::new(&machine, eta, 1);
    for kept in [1.0, 0.95, 0.85, 0.7] {
        let (rho, w) = alternating_of_branch(&machine, &branch, r, kept).expect("an orbit");
        let orbit = orbit_with_speed(&machine, Setting::new(eta, rho), 1, w);
        let map =
            saltation(&machine, &orbit.before, &orbit.after) * free_flow(&machine, orbit.period());
        let left = (map + nalgebra::Matrix4::identity() * kept).determinant();
        assert!(left.abs() < 1e-9, "{kept}: {left}");
    }
}
