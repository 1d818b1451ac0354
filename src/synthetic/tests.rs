//! The detector on simulated rigs whose impacts last.

use super::acquisition::RATE_HZ;
use super::run::calibrated;
use super::{Effects, Faults, Laboratory, Plan, Truth, records};
use crate::event::{DetectSettings, Impact, RigKind, detect};
use crate::signal::robust;

/// Impacts of a campaign of forty records with R = 0.7, as detected.
fn impacts(effects: &Effects) -> Vec<Impact> {
    let laboratory = Laboratory {
        truth: Truth::symmetric(0.7, 12.0, 0.06, 1e-3),
        faults: Faults::default(),
        effects: effects.clone(),
        clearance_uncertainty_m: None,
        plan: Plan::for_rig(12.0, 0.06, 1e-3, 40),
        rig_seed: 3,
        seed: 3,
    };
    let raw = records(&laboratory).unwrap();
    let found = raw.iter().flat_map(|raw| {
        let record = calibrated(raw, &laboratory.truth, &laboratory.faults);
        detect(&record, RigKind::Double, &DetectSettings::default()).impacts
    });
    found.filter(|i| i.dead_zone_s == 0.0).collect()
}

/// Median of the separation speed, less what springs and drive add, over the approach speed.
fn restitution(impacts: &[Impact]) -> f64 {
    let ratio = |i: &Impact| {
        let push = i.external_push_m_s.unwrap_or(0.0);
        Some((-i.approach_speed_after_m_s? - push) / i.approach_speed_before_m_s?)
    };
    let ratios: Vec<f64> = impacts.iter().filter_map(ratio).collect();
    robust::median(&ratios).unwrap()
}

#[test]
fn valid_contacts_of_finite_duration_keep_their_restitution() {
    for duration_s in [0.3e-3, 0.6e-3, 1e-3] {
        let impacts = impacts(&Effects {
            contact_duration_s: duration_s,
            ..Effects::default()
        });
        let durations: Vec<f64> = impacts
            .iter()
            .filter_map(|i| i.contact_duration_s)
            .collect();
        let r = restitution(&impacts);
        assert!(
            3 * durations.len() > 2 * impacts.len(),
            "{duration_s}: {} of {}",
            durations.len(),
            impacts.len()
        );
        // Below a sample the samples within the contact are too few: there the duration comes out
        // too long, by up to a third of a sample.
        let found = robust::median(&durations).unwrap();
        let allowed_s = if duration_s < 1.0 / RATE_HZ {
            0.4 / RATE_HZ
        } else {
            0.15 * duration_s
        };
        assert!(
            (found - duration_s).abs() < allowed_s,
            "{duration_s}: {found}"
        );
        assert!((r / 0.7 - 1.0).abs() < 0.01, "{duration_s}: R = {r}");
    }
}

#[test]
fn instantaneous_contacts_are_instants() {
    let impacts = impacts(&Effects::default());
    assert!(impacts.iter().all(|i| i.contact_duration_s.is_none()));
    assert!((restitution(&impacts) / 0.7 - 1.0).abs() < 3e-3);
}

#[test]
fn valid_delayed_velocities_keep_their_restitution() {
    let mut effects = Effects::default();
    // x a quarter of a sample late, y a quarter early
    (effects.delays_s[2], effects.delays_s[3]) = (0.125e-3, -0.125e-3);
    let r = restitution(&impacts(&effects));
    assert!((r / 0.7 - 1.0).abs() < 0.01, "R = {r}");
}

#[test]
fn valid_channels_that_are_late_by_different_delays_keep_their_restitution() {
    // velocities before, one displacement after the drive: kinks and jumps up to 0.7 samples apart
    for delays_ms in [
        [-0.118, -0.121, 0.236, -0.055],
        [0.163, 0.189, 0.05, 0.03],
        [-0.25, 0.25, 0.2, -0.2],
    ] {
        let mut effects = Effects::default();
        effects.delays_s[2..6].copy_from_slice(&delays_ms.map(|ms| 1e-3 * ms));
        let r = restitution(&impacts(&effects));
        assert!((r / 0.7 - 1.0).abs() < 0.01, "{delays_ms:?}: R = {r}");
    }
}
