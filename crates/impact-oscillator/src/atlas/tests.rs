//! Maps: the vector kernel against the exact simulator, and invariants of maps.

use super::agreement::Cause;
use super::brute::brute_maps;
use super::edge::EdgeKind;
use super::line::Slice;
use super::map::{Kernel, even};
use super::regions::slices_at;
use super::shard::{AtlasPart, AtlasRequest, MergeError, merge, part};
use super::sweep::{Carried, Sweep, SweepPoint, sweep};
use super::*;

use crate::model::orbit::stable_orbit;
use crate::model::params::Asymmetry;
use crate::model::{
    Impact, Initial, Machine, Restitution, Setting, SettledMotion, Simulator, Watch, eta_s2,
    rho_grazing, rho_s1, rho_s2,
};

const KERNELS: [Kernel; 3] = [Kernel::Scalar, Kernel::Avx2, Kernel::Avx512];

/// The same machine, but with a law R(v) that is constant: it takes the exact simulator.
fn slow_path(machine: &Machine) -> Machine {
    let r = machine.restitution().constant().unwrap();
    machine
        .clone()
        .with_restitution(Restitution::Table(vec![(0.0, r)]))
}

fn differing_periodic(machine: &Machine, grid: &MapGrid, settings: &MapSettings) -> Vec<String> {
    let exact = region_map(&slow_path(machine), grid, settings).unwrap();
    let mut differ = Vec::new();
    for kernel in KERNELS.into_iter().filter(|k| k.is_available()) {
        let fast = MapSettings {
            kernel: Some(kernel),
            ..*settings
        };
        let map = region_map(machine, grid, &fast).unwrap();
        for (i, (a, b)) in map.cells.iter().zip(&exact.cells).enumerate() {
            if a != b && (a.is_periodic() || b.is_periodic()) {
                differ.push(format!("{kernel:?} {:?}: {a:?}, exact {b:?}", grid.at(i)));
            }
        }
    }
    differ
}

#[test]
fn kernel_agrees_with_the_exact_simulator() {
    let grid = MapGrid::even((0.6, 3.0, 20), (0.05, 3.0, 20));
    for (beta, r) in [(0.07, 0.9), (0.2, 0.5), (0.05, 0.0)] {
        let differ =
            differing_periodic(&Machine::symmetric(beta, r), &grid, &MapSettings::default());
        assert!(
            differ.is_empty(),
            "β {beta} R {r}: {} {differ:#?}",
            differ.len()
        );
    }
}

#[test]
fn parts_make_up_the_whole_atlas_and_nothing_else_does() {
    let settings = AtlasSettings {
        grid: MapGrid::even((0.7, 2.0, 13), (0.1, 3.0, 11)),
        largest_p: 2,
        largest_n: 2,
        map: MapSettings::default(),
    };
    let machine = Machine::symmetric(0.07, 0.9);
    let request = AtlasRequest::new(machine.clone(), settings.clone());
    let whole = brute_maps(&machine, &settings.grid, &settings.map).unwrap();
    for of in [1, 3, 14] {
        let parts: Vec<AtlasPart> = (0..of).map(|k| part(&request, k, of).unwrap()).collect();
        assert_eq!(merge(&parts).unwrap(), whole, "{of} parts");
        let text = serde_json::to_string(&parts[0]).unwrap();
        assert_eq!(serde_json::from_str::<AtlasPart>(&text).unwrap(), parts[0]);
    }
    let parts: Vec<AtlasPart> = (0..3).map(|k| part(&request, k, 3).unwrap()).collect();
    assert_eq!(merge(&[]), Err(MergeError::Nothing));
    let (numbers, of) = (vec![2], 3);
    assert_eq!(merge(&parts[..2]), Err(MergeError::Missing { numbers, of }));
    let doubled = [parts[0].clone(), parts[0].clone()];
    assert_eq!(merge(&doubled), Err(MergeError::Doubled { number: 0 }));
    let other = AtlasRequest::new(Machine::symmetric(0.07, 0.8), settings);
    let foreign = [parts[0].clone(), part(&other, 1, 3).unwrap()];
    assert_eq!(
        merge(&foreign),
        Err(MergeError::Foreign { number: 1, of: 3 })
    );
    let mut short = parts.clone();
    short[2].maps[1].pop();
    assert!(matches!(
        merge(&short),
        Err(MergeError::Damaged { number: 2, .. })
    ));
}

#[cfg(feature = "rayon")]
#[test]
fn maps_do_not_depend_on_the_number_of_threads() {
    let grid = MapGrid::even((0.7, 3.0, 17), (0.05, 3.0, 13));
    let machine = Machine::symmetric(0.07, 0.9);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| region_map(&machine, &grid, &MapSettings::default()).unwrap())
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn edges_by_continuation_are_the_closed_forms() {
    let machine = Machine::symmetric(0.07, 0.9);
    let settings = AtlasSettings {
        grid: MapGrid::even((0.9, 0.9, 1), (0.1, 6.0, 60)),
        largest_p: 2,
        largest_n: 2,
        map: MapSettings::default(),
    };
    let at = |eta: f64| slices_at(&machine, eta, &settings).unwrap();
    let one = |slices: &[Slice]| {
        slices
            .iter()
            .find(|s| (s.p, s.n) == (1, 1))
            .unwrap()
            .clone()
    };
    let s = one(&at(0.9));
    assert_eq!(s.high.kind, EdgeKind::PeriodDoubling);
    assert!((s.high.orbit.rho - rho_s1(&machine, 0.9, 1).unwrap().rho).abs() < 1e-6);
    let s = one(&at(1.3));
    assert_eq!(s.high.kind, EdgeKind::SaddleNode);
    assert!((s.high.orbit.rho - rho_s2(&machine, 1.3, 1).unwrap().rho).abs() < 1e-6);
    // the doubled motion branches off where z = 1 ends
    let two = at(0.9).into_iter().find(|s| (s.p, s.n) == (2, 2)).unwrap();
    assert!((two.low.orbit.rho - rho_s1(&machine, 0.9, 1).unwrap().rho).abs() < 1e-3);
}

#[test]
fn curves_and_brute_force_agree() {
    let settings = AtlasSettings {
        grid: MapGrid::even((0.6, 2.4, 19), (0.05, 4.0, 24)),
        largest_p: 4,
        largest_n: 4,
        map: MapSettings::default(),
    };
    for (beta, r) in [(0.07, 0.9), (0.05, 0.0)] {
        let atlas = atlas(&Machine::symmetric(beta, r), &settings).unwrap();
        let a = &atlas.agreement;
        assert!(a.compared > 900);
        let share = a.differing.len() as f64 / a.compared as f64;
        assert!(share < 0.002, "R {r}: {share} {:?}", a.differing);
        let missed = a.differing.iter().any(|d| d.cause == Cause::NoRegion);
        assert!(!missed, "R {r}: {:?}", a.differing);
    }
}

#[test]
fn valid_preloaded_cells_stick_or_rest_once_a_period() {
    let grid = MapGrid::even((0.5, 2.0, 7), (-1.3, -0.7, 7));
    let machine = Machine::symmetric(0.1, 0.0);
    let map = region_map(&machine, &grid, &MapSettings::default()).unwrap();
    let exact = region_map(&slow_path(&machine), &grid, &MapSettings::default()).unwrap();
    assert_eq!(map.cells, exact.cells);
    for (i, cell) in map.cells.iter().enumerate() {
        let joined = *cell == SettledMotion::Sticking;
        assert_eq!(
            joined,
            grid.at(i).1 < -1.0 + 1e-9,
            "{:?} {cell:?}",
            grid.at(i)
        );
    }
}

fn walk_eta(first: f64, last: f64, count: usize, rho: f64) -> Sweep {
    let steps = even((first, last, count))
        .into_iter()
        .map(|eta| (eta, rho))
        .collect();
    let watch = Watch {
        settle_periods: 150.0,
        watch_periods: 40.0,
        ..Watch::default()
    };
    Sweep {
        steps,
        start: Initial::rest(),
        watch,
    }
}

#[test]
fn sweeps_show_hysteresis_between_grazing_and_s2() {
    let machine = Machine::symmetric(0.07, 0.9);
    let s2 = eta_s2(&machine, 2.0, 1).unwrap().eta;
    let is_one = |p: &SweepPoint| matches!(p.motion, SettledMotion::Periodic { p: 1, n: 1, .. });
    let up = sweep(&machine, &walk_eta(1.1, 1.7, 121, 2.0), |_| true).unwrap();
    let jump = up.iter().rfind(|p| is_one(p)).unwrap();
    assert!(jump.eta <= s2 && jump.eta > s2 - 0.03, "{} {s2}", jump.eta);
    // X of a z = 1 motion of equal masses is greatest at the contact, or before
    assert!(
        up.iter()
            .filter(|p| is_one(p))
            .all(|p| p.x_max >= 2.0 - 1e-9 && p.x_max < 2.0 + 1e-9)
    );
    let down = sweep(&machine, &walk_eta(1.7, 1.1, 121, 2.0), |_| true).unwrap();
    let first = down.iter().find(|p| !p.approach_speeds.is_empty()).unwrap();
    assert!(
        (rho_grazing(&machine, first.eta) - 2.0).abs() < 0.1,
        "{}",
        first.eta
    );
}

/// An asymmetry of 5 % at β = 0.002: z = 1 is reached after some 600 periods, as eq. (15)'s figures 6(e), (f) have it.
#[test]
fn valid_a_motion_that_converges_slowly_is_periodic_and_not_chaotic() {
    let unlike = Asymmetry {
        stiffness: 0.95,
        ..Asymmetry::default()
    };
    let machine = Machine::asymmetric(0.002, 0.0, unlike);
    let mut carried =
        Carried::start(&machine, (1.1, 3.0), Initial::rest(), Watch::default()).expect("a motion");
    let point = carried.step((1.1, 3.0)).expect("a motion");
    assert_eq!(point.motion.label(), "1");
    assert!(point.lyapunov < Some(0.0));
    let grid = MapGrid::even((1.1, 1.1, 1), (2.5, 3.0, 2));
    let map = region_map(&machine, &grid, &MapSettings::default()).expect("a map");
    assert_eq!(map.at(0, 1).label(), "1");
}

/// A motion that settles from rest at a place.
fn settled_at(machine: &Machine, at: (f64, f64), watch: Watch) -> SweepPoint {
    let mut carried = Carried::start(machine, at, Initial::rest(), watch).expect("a motion");
    carried.step(at).expect("a motion")
}

/// Of like masses a variation that leaves their distance as it is decays with β whatever the impacts do, and of no
/// impacts every one.
#[test]
fn valid_the_interval_of_a_periodic_motion_s_exponent_holds_it() {
    let mut one_impact = 0;
    for (restitution, beta) in [(0.9, 0.07), (0.5, 0.07), (0.9, 0.02), (0.8, 0.005)] {
        let machine = Machine::symmetric(beta, restitution);
        for eta in [0.9, 1.0, 1.1, 1.3, 1.5, 1.8] {
            for rho in [0.3, 0.6, 1.0, 1.5, 250.0] {
                let point = settled_at(&machine, (eta, rho), Watch::default());
                let label = point.motion.label();
                let exponent = point.lyapunov.expect("an exponent");
                let half_width = 1.96 * point.lyapunov_error.expect("an error");
                if !matches!(label.as_str(), "0" | "1") {
                    continue;
                }
                one_impact += usize::from(label == "1");
                let long = Watch {
                    settle_periods: 1000.0,
                    watch_periods: 2000.0,
                    ..Watch::default()
                };
                let whole = if label == "0" {
                    -beta
                } else {
                    let long = settled_at(&machine, (eta, rho), long).lyapunov;
                    long.expect("an exponent")
                };
                assert!(
                    (exponent - whole).abs() <= half_width
                        && whole >= -beta - 1e-9
                        && half_width < 2e-3,
                    "{label} at {eta}, {rho}, R = {restitution}, β = {beta}: {exponent} ± {half_width}, {whole}"
                );
            }
        }
    }
    assert!(one_impact > 40, "{one_impact}");
}

/// Weak chaos that nearly closes after 48 drive periods within the watch.
#[test]
fn chaos_is_no_period_that_is_hardly_seen_once() {
    let machine = Machine::symmetric(0.07, 0.9);
    let lively = Initial {
        vx: 0.6,
        vy: 0.6,
        ..Initial::rest()
    };
    let mut carried =
        Carried::start(&machine, (2.86, 0.1), lively, Watch::default()).expect("a motion");
    let point = carried.step((2.86, 0.1)).expect("a motion");
    assert_eq!(
        point.motion,
        SettledMotion::Chaotic,
        "{:?} {:?}",
        point.lyapunov,
        point.lyapunov_error
    );
}

/// Windows of a chaotic motion scatter as the error of each says.
#[test]
fn valid_the_error_of_a_lyapunov_exponent_is_its_scatter() {
    let machine = Machine::single(0.07, 0.9);
    let grid = MapGrid::even((0.55, 0.9, 15), (0.5, 1.5, 11));
    let map = region_map(&machine, &grid, &MapSettings::default()).expect("a map");
    let mut chaotic = (0..grid.len()).filter(|i| map.cells[*i] == SettledMotion::Chaotic);
    let (eta, rho) = grid.at(chaotic.next().expect("chaos"));
    let setting = Setting::new(eta, rho);
    let mut simulator = Simulator::new(&machine, setting, Initial::rest()).expect("a simulator");
    simulator.advance(200.0 * setting.period(), &mut |_: &Impact| ());
    let windows: Vec<(f64, f64)> = (0..24)
        .map(|_| {
            let mut window = Lyapunov::new(&machine, setting.frequency_ratio);
            simulator.advance(400.0 * setting.period(), &mut window);
            let error = window.standard_error().expect("an error");
            (window.exponent(), error)
        })
        .collect();
    let mean = windows.iter().map(|w| w.0).sum::<f64>() / 24.0;
    let scatter = (windows.iter().map(|w| (w.0 - mean).powi(2)).sum::<f64>() / 23.0).sqrt();
    let stated = windows.iter().map(|w| w.1).sum::<f64>() / 24.0;
    assert!(
        mean > 0.0 && (0.6..2.5).contains(&(stated / scatter)),
        "{mean} {scatter} {stated}"
    );
}

#[test]
fn lyapunov_exponent_is_that_of_the_multipliers() {
    let machine = Machine::single(0.07, 0.9);
    let setting = Setting::new(1.2, 2.0);
    let orbit = stable_orbit(&machine, setting, 1).unwrap().unwrap();
    let s = orbit.after;
    let start = Initial {
        x: s.x,
        vx: s.vx,
        ..Initial::rest()
    };
    let mut simulator = Simulator::new(&machine, orbit.setting, start).unwrap();
    let mut lyapunov = Lyapunov::new(&machine, 1.2);
    simulator.advance(2000.0 * setting.period(), &mut lyapunov);
    let want = orbit.multipliers[0].norm().ln() / setting.period();
    assert!(
        (lyapunov.exponent() - want).abs() < 1e-3,
        "{} {want}",
        lyapunov.exponent()
    );
    // chaos where the map says so
    let plan = Sweep {
        steps: vec![(2.0, 0.2)],
        ..walk_eta(1.0, 2.0, 2, 0.2)
    };
    let point = &sweep(&machine, &plan, |_| true).unwrap()[0];
    let positive = point.lyapunov.unwrap() > 0.0;
    assert_eq!(positive, !point.motion.is_periodic(), "{point:?}");
}

#[test]
fn valid_basins_of_fig5_shrink_with_restitution() {
    // in the hysteresis region, at the greatest approach speeds: z = 1 is easily reached at
    // R = 0 and hardly at R = 0.9
    let share = |r: f64, eta: f64| {
        let grid = BasinGrid {
            x: (-6.0, 3.0, 31),
            vx: (-6.0, 6.0, 31),
            starts: Starts::BothMasses,
        };
        let machine = Machine::symmetric(0.005, r);
        let long = Watch {
            settle_periods: 600.0,
            ..Watch::default()
        };
        let settings = MapSettings {
            watch: long,
            ..MapSettings::default()
        };
        let b = basins(&machine, Setting::new(eta, 3.0), &grid, &settings).unwrap();
        let one = |c: &&Option<SettledMotion>| {
            matches!(c, Some(SettledMotion::Periodic { p: 1, n: 1, .. }))
        };
        b.cells.iter().filter(one).count() as f64 / b.cells.len() as f64
    };
    let (plastic, elastic) = (share(0.0, 1.19), share(0.9, 1.74));
    assert!(plastic > 0.5 && elastic < 0.1, "{plastic} {elastic}");
}

#[test]
fn regress_a_release_near_full_preload_at_resonance_ends() {
    // amplitudes of 250 cancel at the release: gap and speed are rounding there
    let machine = Machine::symmetric(0.002, 0.0);
    let grid = MapGrid::even((1.0, 1.0, 1), (-1.2, 5.0, 90));
    let slices = super::resting::resting_slices(&machine, &grid, (4, 4), None, &[]);
    let low = slices[0].first().unwrap().low.unwrap();
    assert!((low.0 + 1.0).abs() < 1e-6, "{low:?}");
}

#[test]
fn two_branches_of_one_motion_in_a_column_are_both_followed() {
    // z = 2/1 with preload: the branches overlap between their saddle-nodes
    let settings = AtlasSettings {
        grid: MapGrid::even((1.2211, 1.2211, 1), (-0.6, 0.2, 41)),
        largest_p: 2,
        largest_n: 1,
        map: MapSettings::default(),
    };
    let slices = slices_at(&Machine::symmetric(0.07, 0.9), 1.2211, &settings).unwrap();
    let two: Vec<&Slice> = slices.iter().filter(|s| (s.p, s.n) == (2, 1)).collect();
    assert_eq!(two.len(), 2, "{two:?}");
    // in a map of many columns as well, each cell of a run being told apart
    let many = AtlasSettings {
        grid: MapGrid::even((1.1911, 1.2511, 3), (-0.6, 0.2, 41)),
        ..settings
    };
    let all = atlas(&Machine::symmetric(0.07, 0.9), &many).unwrap().slices;
    let middle = all.iter().filter(|s| (s.eta - 1.2211).abs() < 1e-9);
    assert_eq!(middle.filter(|s| (s.p, s.n) == (2, 1)).count(), 2);
}

#[test]
fn regress_a_beat_longer_than_the_watch_is_not_impactless() {
    // ρ lies far below ρ' = 17: a watch without impacts lies between two
    let machine = Machine::symmetric(0.002, 0.0);
    let (eta, rho) = (0.971_428_571_428_571_5, 3.885_393_258_426_966_6);
    let settings = MapSettings {
        watch: Watch {
            settle_periods: 0.0,
            watch_periods: 0.3,
            ..Watch::default()
        },
        ..MapSettings::default()
    };
    let grid = MapGrid::even((eta, eta, 1), (rho, rho, 1));
    let map = region_map(&machine, &grid, &settings).unwrap();
    assert_eq!(map.at(0, 0), SettledMotion::Beat);
}

/// Asymmetric machines: drive, stiffness, mass.
fn uneven(damping_ratio: f64, restitution: f64) -> [Machine; 3] {
    let ratios = [(0.9, 1.0, 1.0), (1.0, 0.9, 1.0), (1.0, 1.0, 1.3)];
    ratios.map(|(drive_amplitude, stiffness, mass)| {
        let asymmetry = crate::model::params::Asymmetry {
            drive_amplitude,
            stiffness,
            mass,
        };
        Machine::asymmetric(damping_ratio, restitution, asymmetry)
    })
}

fn resting_at(machine: &Machine, eta: f64, rows: usize) -> Vec<super::resting::RestingSlice> {
    let grid = MapGrid::even((eta, eta, 1), (-1.3, 1.5, rows));
    super::resting::resting_slices(machine, &grid, (3, 3), None, &[]).remove(0)
}

#[test]
fn dead_zones_of_the_exact_search_are_those_of_the_kernel() {
    for (beta, r) in [(0.07, 0.0), (0.02, 0.5), (0.07, 0.8)] {
        let machine = Machine::symmetric(beta, r);
        for eta in [0.55, 0.8, 1.05] {
            let (kernel, exact) = (
                resting_at(&machine, eta, 57),
                resting_at(&slow_path(&machine), eta, 57),
            );
            assert!(!kernel.is_empty());
            assert_eq!(kernel.len(), exact.len(), "{kernel:?} {exact:?}");
            for (a, b) in kernel.iter().zip(&exact) {
                assert_eq!((a.p, a.n), (b.p, b.n));
                for (a, b) in [(a.low, b.low), (a.high, b.high)] {
                    let (a, b) = (a.unwrap(), b.unwrap());
                    assert!(a.1 == b.1 && (a.0 - b.0).abs() < 3e-6, "{a:?} {b:?}");
                }
            }
        }
    }
}

#[test]
fn dead_zones_of_nearly_equal_masses_are_those_of_equal_ones() {
    let asymmetry = crate::model::params::Asymmetry {
        drive_amplitude: 1.0 + 1e-9,
        ..Default::default()
    };
    for (eta, r) in [(0.7, 0.0), (0.9, 0.4)] {
        let (near, equal) = (
            resting_at(&Machine::asymmetric(0.07, r, asymmetry), eta, 41),
            resting_at(&Machine::symmetric(0.07, r), eta, 41),
        );
        assert_eq!(near.len(), equal.len(), "{near:?} {equal:?}");
        for (a, b) in near.iter().zip(&equal) {
            assert_eq!((a.p, a.n), (b.p, b.n));
            let (a, b) = (a.high.unwrap(), b.high.unwrap());
            assert!(a.1 == b.1 && (a.0 - b.0).abs() < 3e-6, "{a:?} {b:?}");
        }
    }
}

#[test]
fn one_and_one_with_a_dead_zone_share_their_edge() {
    // 1 | 1j from both sides: Newton on the impact's time, and the map from release to release
    for machine in uneven(0.07, 0.0) {
        let mut shared = 0;
        for eta in even((0.9, 2.0, 12)) {
            let settings = AtlasSettings {
                grid: MapGrid::even((eta, eta, 1), (-1.3, 1.5, 41)),
                largest_p: 1,
                largest_n: 1,
                map: MapSettings::default(),
            };
            let moving = slices_at(&machine, eta, &settings).unwrap();
            let Some(moving) = moving.iter().find(|s| s.low.kind == EdgeKind::DeadZone) else {
                continue;
            };
            let resting = resting_at(&machine, eta, 41);
            let resting = resting.iter().find(|s| s.is(1, 1)).unwrap();
            let (rho, kind) = resting.high.unwrap();
            assert_eq!(kind, super::edge::EdgeKind::DeadZone);
            let other = moving.low.orbit.rho;
            assert!((rho - other).abs() < 1e-6, "{eta}: {rho} {other}");
            shared += 1;
        }
        assert!(shared >= 3, "{shared}");
    }
}

#[test]
fn dead_zones_of_uneven_machines_contain_what_brute_force_finds() {
    let settings = AtlasSettings {
        grid: MapGrid::even((0.5, 1.3, 5), (-1.3, 1.5, 15)),
        largest_p: 3,
        largest_n: 3,
        map: MapSettings::default(),
    };
    for machine in uneven(0.07, 0.0).iter().chain(&uneven(0.07, 0.6)) {
        let atlas = atlas(machine, &settings).unwrap();
        let rests = |m: &&SettledMotion| {
            matches!(
                m,
                SettledMotion::Periodic {
                    dead_zone: true,
                    ..
                }
            )
        };
        assert!(atlas.maps[0].iter().filter(rests).count() > 5);
        let differing = &atlas.agreement.differing;
        assert!(differing.is_empty(), "{differing:#?}");
        let edges = atlas.curves.iter().filter(|c| c.dead_zone);
        assert!(edges.clone().any(|c| c.kind.name() == "dead_zone"));
        assert!(edges.clone().any(|c| c.kind.name() == "joined"));
    }
}

#[test]
fn regress_a_release_at_full_preload_but_for_rounding_ends() {
    // the bisection of the edges meets ρ = −1 + 1e-16: what lets go there is rounding alone
    let machine = Machine::symmetric(0.07, 0.7);
    for kernel in KERNELS.into_iter().filter(|k| k.is_available()) {
        let grid = MapGrid::even((0.8, 1.6, 9), (-1.2, 2.0, 9));
        let columns = super::resting::resting_slices(&machine, &grid, (2, 2), Some(kernel), &[]);
        for low in columns.iter().flatten().filter_map(|s| s.low) {
            assert!((low.0 + 1.0).abs() < 1e-6, "{low:?}");
        }
    }
}
