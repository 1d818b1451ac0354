//! Maps: the vector kernel against the exact simulator, and invariants of maps.

use super::map::Kernel;
use super::*;

use crate::model::{Machine, Restitution};

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
fn valid_kernel_agrees_with_the_exact_simulator() {
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
