//! Simulated campaigns as observed, for tests here and in `impact-identification`.

#![allow(
    clippy::expect_used,
    clippy::missing_panics_doc,
    reason = "a test fails by panicking"
)]

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::evidence::{Evidence, Nominal};
use crate::method_fit::MethodFit;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::{Fit, FitReport};
use crate::statistics::scatter::Scatter;
use impact_oscillator::model::boundary::{rho_grazing, rho_s1, rho_s2};
use impact_records::event::{DetectSettings, RigKind};
use impact_records::motion::{BoundaryKind, Bracket, ClassifySettings, Observation, observe};
use impact_records::record::{Record, Sweep};
use simulated_rig::run::calibrated;
use simulated_rig::{Faults, Laboratory, Plan, RigEffects, Truth, records};

/// A fit that ended at parameters with a covariance of the free coordinates, its residuals of unit size.
pub fn fitted(
    parameters: Parameters,
    free: Vec<Coordinate>,
    covariance: DMatrix<f64>,
) -> MethodFit {
    MethodFit {
        fit: Fit {
            parameters,
            free,
            covariance,
            cost: 1.0,
            residuals: 1,
            report: FitReport::default(),
        },
        factor: 1.0,
        reduced: 1.0,
        scatter: Scatter::default(),
        shared_gains: Vec::new(),
        parts: Vec::new(),
    }
}

/// Records of a rig without effects: two equal masses with R, f0 in Hz, β = 0.06 and `x_st` = 1 mm.
pub fn recorded(restitution: f64, f0: f64, count: usize, seed: u64) -> Vec<Record> {
    let laboratory = Laboratory {
        truth: Truth::symmetric(restitution, f0, 0.06, 1e-3),
        faults: Faults::default(),
        effects: RigEffects::default(),
        clearance_uncertainty_m: None,
        plan: Plan::for_rig(12.0, 0.06, 1e-3, count),
        rig_seed: seed,
        seed,
    };
    let raw = records(&laboratory).expect("a campaign");
    let Laboratory { truth, faults, .. } = &laboratory;
    raw.iter().map(|r| calibrated(r, truth, faults)).collect()
}

/// Records as observed, in their order.
pub fn observed(records: &[Record]) -> Vec<Observation> {
    let (detect, classify) = (DetectSettings::default(), ClassifySettings::default());
    let observe = |record| observe(record, RigKind::Double, &detect, &classify);
    let mut all: Vec<Observation> = records.par_iter().map(observe).collect();
    for (sequence, o) in all.iter_mut().enumerate() {
        o.setting.sequence = sequence;
    }
    all
}

/// What an identification of two masses without brackets starts from.
pub fn evidence(observations: &[Observation]) -> Evidence<'_> {
    Evidence {
        rig: RigKind::Double,
        observations,
        brackets: &[],
        nominal: Nominal {
            gain_uncertainty: 5e-3,
            corner_uncertainty: 2e-2,
            clearance_uncertainty_m: 1e-5,
            ..Nominal::default()
        },
        uncertainty: Default::default(),
        progress: None,
    }
}

/// A bracket 2 % wide about the boundary of a kind at η, as the model itself has it; `off_middle`: how far
/// its middle lies below, in half widths.
pub fn bracket(kind: BoundaryKind, eta: f64, p: &Parameters, off_middle: f64) -> Bracket {
    let machine = p.machine(RigKind::Double);
    let rho = match kind {
        BoundaryKind::SaddleNode => rho_s2(&machine, eta, 1).expect("an s2").rho,
        BoundaryKind::PeriodDoubling => rho_s1(&machine, eta, 1).expect("an s1").rho,
        _ => rho_grazing(&machine, eta),
    };
    let frequency_hz = eta * p.natural_frequency_hz;
    Bracket {
        kind,
        periods_n: 1,
        clearance_m: rho * p.static_deflection_m,
        drive_amplitude: 1.0,
        frequency_low_hz: frequency_hz * (1.0 - 0.01 * (1.0 + off_middle)),
        frequency_high_hz: frequency_hz * (1.0 + 0.01 * (1.0 - off_middle)),
        sweep: Sweep::Up,
        place: 0.0,
        from: "1".into(),
        to: "0".into(),
        records: ["a".into(), "b".into()],
    }
}
