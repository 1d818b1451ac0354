//! Simulated campaigns as observed, for tests.

use rayon::prelude::*;

use crate::identify::evidence::{Evidence, Nominal};
use impact_records::event::{DetectSettings, RigKind};
use impact_records::motion::{ClassifySettings, Observation, observe};
use impact_records::record::Record;
use simulated_rig::run::calibrated;
use simulated_rig::{Faults, Laboratory, Plan, RigEffects, Truth, records};

/// Records of a rig without effects: two equal masses with R, f0 in Hz, β = 0.06 and `x_st` = 1 mm.
pub(super) fn recorded((restitution, f0): (f64, f64), count: usize, seed: u64) -> Vec<Record> {
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
pub(super) fn observed(records: &[Record]) -> Vec<Observation> {
    let (detect, classify) = (DetectSettings::default(), ClassifySettings::default());
    let observe = |record| observe(record, RigKind::Double, &detect, &classify);
    let mut all: Vec<Observation> = records.par_iter().map(observe).collect();
    for (sequence, o) in all.iter_mut().enumerate() {
        o.setting.sequence = sequence;
    }
    all
}

/// What an identification of two masses without brackets starts from.
pub(super) fn evidence(observations: &[Observation]) -> Evidence<'_> {
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
