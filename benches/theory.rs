//! Run times of the theory on this machine: the marching kernel per drive period and core, scaling
//! over threads, closed forms per point, the whole atlas of Fig. 11.
//!
//! `cargo bench --bench theory`. Times are by the clock, each the least and the
//! median of several runs: the least is what the machine can do, the median shows how much other
//! work disturbed. No harness beyond this file.

use std::hint::black_box;
use std::time::Instant;

use impact_oscillator::atlas::kernel::{Cell, Outcome};
use impact_oscillator::atlas::map::{
    Kernel, MapGrid, MapSettings, Start, UnitMass, march_all, region_map,
};
use impact_oscillator::atlas::{AtlasSettings, atlas};
use impact_oscillator::model::boundary::{s1_of_branch, s2_of_branch};
use impact_oscillator::model::orbit::Branch;
use impact_oscillator::{Initial, Machine, rho_grazing, rho_s1, rho_s2};

const KERNELS: [Kernel; 3] = [Kernel::Scalar, Kernel::Avx2, Kernel::Avx512];
const PERIODS: f64 = 260.0;

fn main() {
    // `cargo bench` passes --bench; under `cargo test` nothing is measured
    if !std::env::args().any(|a| a == "--bench") {
        return;
    }
    println!("{}", processor());
    kernels();
    threads();
    closed_forms();
    whole_atlas();
}

fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find(|l| l.starts_with("model name"));
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    format!(
        "{}; load {}",
        model
            .and_then(|l| l.split(": ").nth(1))
            .unwrap_or("processor unknown"),
        load.split(' ').next().unwrap_or("unknown")
    )
}

/// Least and median of the seconds that several runs take.
fn measured(runs: usize, mut work: impl FnMut()) -> (f64, f64) {
    let mut times: Vec<f64> = (0..runs)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    (times[0], times[runs / 2])
}

fn square() -> MapGrid {
    MapGrid::even((0.6, 3.0, 64), (0.05, 3.0, 64))
}

/// The paper's rig: R = 0.9, β = 0.07.
fn rig() -> Machine {
    Machine::symmetric(0.07, 0.9)
}

/// Outcomes of the kernel alone; the exact simulator checks none of them again.
fn march(kernel: Kernel, leave_early: bool) -> Vec<Outcome> {
    let settings = MapSettings {
        leave_early,
        ..MapSettings::default()
    };
    let Some(unit) = UnitMass::of(&rig()) else {
        return Vec::new();
    };
    let grid = square();
    let start = |i: usize| Start {
        at: grid.at(i),
        initial: Initial::rest(),
        phase: 0.0,
    };
    let cells: Vec<Cell> = (0..grid.len()).map(|i| unit.cell(&start(i))).collect();
    march_all(&unit.course(&settings), &cells, Some(kernel))
}

fn kernels() {
    println!(
        "\n64 × 64 cells, η 0.6–3.0, ρ 0.05–3.0, R = 0.9, β = 0.07, from rest, 200 + 60 periods"
    );
    println!("kernel   exits  ns per drive period and core (least, median)   cells/s and core");
    let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else {
        return;
    };
    let reference = pool.install(|| march(Kernel::Scalar, false));
    for leave_early in [false, true] {
        for kernel in KERNELS.into_iter().filter(|k| k.is_available()) {
            let mut found = Vec::new();
            let (least, median) =
                pool.install(|| measured(15, || found = black_box(march(kernel, leave_early))));
            let count = found.len() as f64;
            let periodic = |o: &Outcome| o.motion.is_periodic();
            let differ = reference
                .iter()
                .zip(&found)
                .filter(|(a, b)| periodic(a) && periodic(b) && a.motion != b.motion)
                .count();
            println!(
                "{:8} {:5}  {:7.2} {:7.2}   {:9.0}   {differ} periodic cells differ from the scalar \
                 kernel's",
                format!("{kernel:?}"),
                if leave_early { "yes" } else { "no" },
                1e9 * least / (count * PERIODS),
                1e9 * median / (count * PERIODS),
                count / least
            );
        }
    }
}

fn threads() {
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    let kernel = Kernel::of_this_machine();
    println!(
        "\nthreads   {kernel:?} with exits, 256 × 256 cells with all that a map does: s (least), cells/s"
    );
    let grid = MapGrid::even((0.6, 3.0, 256), (0.05, 3.0, 256));
    let mut count = 1;
    while count <= most {
        if let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(count).build() {
            let settings = MapSettings::default();
            let work = || black_box(region_map(&rig(), &grid, &settings).is_ok());
            let (least, _) = pool.install(|| measured(3, || assert!(work())));
            println!("{count:7}   {least:.3}   {:.0}", grid.len() as f64 / least);
        }
        count *= 2;
    }
}

fn closed_forms() {
    println!("\nclosed forms, ns per point (least, median), n = 1, η 1.05–1.95");
    let machine = rig();
    let etas: Vec<f64> = (0..10_000).map(|i| 1.05 + 9e-5 * f64::from(i)).collect();
    let print = |name: &str, of: &dyn Fn(f64) -> f64| {
        let work = || black_box(etas.iter().map(|&eta| of(eta)).sum::<f64>());
        let (least, median) = measured(9, || {
            work();
        });
        let per = 1e9 / etas.len() as f64;
        println!("{name:38} {:8.1} {:8.1}", least * per, median * per);
    };
    print("s2", &|eta| {
        s2_of_branch(&Branch::new(&machine, eta, 1), 0.9).0
    });
    print("s1", &|eta| {
        s1_of_branch(&machine, &Branch::new(&machine, eta, 1), 0.9).map_or(0.0, |p| p.0)
    });
    print("ρ'", &|eta| rho_grazing(&machine, eta));
    print("s2 with its orbit's existence checked", &|eta| {
        rho_s2(&machine, eta, 1).map_or(0.0, |p| p.rho)
    });
    print("s1 with its orbit's existence checked", &|eta| {
        rho_s1(&machine, eta, 1).map_or(0.0, |p| p.rho)
    });
}

fn whole_atlas() {
    let settings = AtlasSettings {
        grid: MapGrid::even((0.3, 5.0, 200), (-1.2, 8.0, 120)),
        largest_p: 4,
        largest_n: 6,
        map: MapSettings::default(),
    };
    let work = || black_box(atlas(&rig(), &settings).map_or(0, |a| a.curves.len()));
    let mut curves = 0;
    let (least, median) = measured(3, || curves = work());
    println!(
        "\natlas of Fig. 11, 200 × 120, p to 4, n to 6, all threads: {least:.2} s (median \
         {median:.2} s), {curves} curves"
    );
}
