//! Campaigns of the virtual laboratory, identified and compared, for tests here and in `report`.

#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::sync::OnceLock;

use rayon::prelude::*;

use super::{Compared, Input, replay};
use crate::identify::{Identification, identify_campaign};
use impact_fit::evidence::{Evidence, Nominal};
use impact_records::event::DetectSettings;
use impact_records::event::RigKind;
use impact_records::motion::{ClassifySettings, brackets, observe, scale_drives};
use impact_records::record::{Channel, Excitation, Record, Role, Setting};
use labfiles::units::Dimension;
use simulated_rig::run::calibrated;
use simulated_rig::{Differences, Faults, Laboratory, Plan, RigEffects, Truth, records};

/// A campaign identified and compared.
pub struct Identified {
    /// What was identified.
    pub identification: Identification,
    /// The fitted model beside the records.
    pub compared: Compared,
}

/// The paper's setting: R = 0.9, f0 = 12.6 Hz, β = 0.07, `x_st` = 1.25 mm, two gaps up and down.
pub fn whole() -> &'static Identified {
    static CAMPAIGN: OnceLock<Identified> = OnceLock::new();
    CAMPAIGN.get_or_init(|| identified(&laboratory(), RigKind::Double))
}

/// The same rig with its gap so wide that nothing touches: R cannot be identified.
pub fn nothing_touches() -> &'static Identified {
    static CAMPAIGN: OnceLock<Identified> = OnceLock::new();
    CAMPAIGN.get_or_init(|| {
        let mut records = laboratory();
        let widest = records[0].setting.clearance_m;
        records.retain(|r| r.setting.clearance_m == widest);
        identified(&records, RigKind::Double)
    })
}

/// The same two masses, of which only x has a velocity, and no displacement is measured.
pub fn one_of_two() -> &'static Identified {
    static CAMPAIGN: OnceLock<Identified> = OnceLock::new();
    CAMPAIGN.get_or_init(|| {
        let mut records = laboratory();
        let kept = [Role::Drive, Role::Contact, Role::VelocityX];
        for record in &mut records {
            record.channels.retain(|c| kept.contains(&c.role));
        }
        identified(&records, RigKind::Double)
    })
}

/// Nine free decays of three masses on one spring, the last filed under the wrong mass.
pub fn decays() -> &'static Identified {
    static CAMPAIGN: OnceLock<Identified> = OnceLock::new();
    CAMPAIGN.get_or_init(|| {
        let masses = [11.0, 11.05, 10.96, 14.0, 14.06, 13.97, 17.2, 17.1, 14.01];
        let record = |(i, f0): (usize, f64)| decay(&format!("test{}", i + 1), i / 3, f0);
        let records: Vec<Record> = masses.into_iter().enumerate().map(record).collect();
        identified(&records, RigKind::Single)
    })
}

fn laboratory() -> Vec<Record> {
    let truth = Truth::symmetric(0.9, 12.6, 0.07, 1.25e-3).with_differences(&Differences {
        force: 0.01,
        stiffness: -0.005,
        ..Differences::default()
    });
    let laboratory = Laboratory {
        truth,
        faults: Faults::default(),
        effects: RigEffects::default(),
        clearance_uncertainty_m: None,
        plan: Plan::for_rig(12.6, 0.07, 1.25e-3, 120),
        rig_seed: 2026,
        seed: 2026,
    };
    let raw = records(&laboratory).expect("a campaign");
    let Laboratory { truth, faults, .. } = &laboratory;
    raw.iter().map(|r| calibrated(r, truth, faults)).collect()
}

/// Two seconds of a decay a(t) = 3 e^(−βΩt) cos(√(1−β²)Ωt) m/s² with β = 0.02, after 0.05 s of rest.
pub fn decay(id: &str, mass: usize, f0_hz: f64) -> Record {
    let (rate_hz, beta) = (800.0, 0.02);
    let omega = std::f64::consts::TAU * f0_hz;
    let value = |i: usize| {
        // a deterministic ripple in place of noise
        let ripple = 0.01 * ((i * 7919) % 1000) as f64 / 1000.0;
        let t = i as f64 / rate_hz - 0.05;
        let moving = f64::from(t >= 0.0);
        let damped = omega * (1.0f64 - beta * beta).sqrt();
        ripple + moving * 3.0 * (-beta * omega * t).exp() * (damped * t).cos()
    };
    Record {
        id: id.to_owned(),
        sample_rate_hz: rate_hz,
        channels: vec![Channel {
            role: Role::AccelerationX,
            name: "a".into(),
            dimension: Dimension::Acceleration,
            values: (0..1640).map(value).collect(),
            high_pass_hz: None,
            low_pass: None,
            smoothing: None,
            threshold: None,
        }],
        setting: Setting {
            specimen: Some(format!("mass {}", mass + 1)),
            excitation: Excitation::FreeDecay,
            ..Setting::default()
        },
        listed: Default::default(),
        flags: Vec::new(),
    }
}

fn identified(records: &[Record], rig: RigKind) -> Identified {
    let (detecting, classifying) = (DetectSettings::default(), ClassifySettings::default());
    let observed = records
        .par_iter()
        .map(|r| observe(r, rig, &detecting, &classifying));
    let mut observations: Vec<_> = observed.collect();
    scale_drives(&mut observations);
    let brackets = brackets(&observations);
    let identification = identify_campaign(&Evidence {
        rig,
        observations: &observations,
        brackets: &brackets,
        nominal: Nominal {
            gain_uncertainty: 5e-3,
            corner_uncertainty: 2e-2,
            ..Nominal::default()
        },
        uncertainty: Default::default(),
        progress: None,
    });
    let compared = replay(&Input {
        rig,
        observations: &observations,
        brackets: &brackets,
        identification: &identification,
        points: &[],
        proposals: &[],
        read: &|i| records.get(i).cloned(),
    });
    Identified {
        identification,
        compared,
    }
}
