//! The detector on simulated rigs whose impacts last.

use super::acquisition::RATE_HZ;
use super::run::calibrated;
use super::{Faults, Laboratory, Plan, RigEffects, Truth, records};
use impact_records::event::{DetectSettings, Impact, RigKind, detect};
use impact_records::motion::{ClassifySettings, LateChannel, late_channels, observe};
use impact_records::record::{Record, Role};
use impact_records::signal::robust;

/// A campaign of forty records with R = 0.7.
fn campaign(effects: &RigEffects) -> Vec<Record> {
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
    let calibrated = |raw| calibrated(raw, &laboratory.truth, &laboratory.faults);
    raw.iter().map(calibrated).collect()
}

/// Its impacts as detected.
fn impacts(effects: &RigEffects) -> Vec<Impact> {
    let records = campaign(effects);
    let found = records
        .iter()
        .flat_map(|record| detect(record, RigKind::Double, &DetectSettings::default()).impacts);
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
        let impacts = impacts(&RigEffects {
            contact_duration_s: duration_s,
            ..RigEffects::default()
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
    let impacts = impacts(&RigEffects::default());
    assert!(impacts.iter().all(|i| i.contact_duration_s.is_none()));
    assert!((restitution(&impacts) / 0.7 - 1.0).abs() < 3e-3);
}

#[test]
fn valid_delayed_velocities_keep_their_restitution() {
    let mut effects = RigEffects::default();
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
        let mut effects = RigEffects::default();
        effects.delays_s[2..6].copy_from_slice(&delays_ms.map(|ms| 1e-3 * ms));
        let r = restitution(&impacts(&effects));
        assert!((r / 0.7 - 1.0).abs() < 0.01, "{delays_ms:?}: R = {r}");
    }
}

/// The channels of a campaign that its jumps show to be late or filtered.
fn late(records: &[Record]) -> Vec<LateChannel> {
    let (detect, classify) = (DetectSettings::default(), ClassifySettings::default());
    let observed = records
        .iter()
        .map(|record| observe(record, RigKind::Double, &detect, &classify));
    late_channels(&observed.collect::<Vec<_>>())
}

#[test]
fn valid_a_velocity_that_is_late_by_three_samples_is_told_by_its_jumps() {
    assert_eq!(late(&campaign(&RigEffects::default())), []);
    let mut effects = RigEffects::default();
    effects.delays_s[2] = 1.5e-3;
    let [x] = late(&campaign(&effects))[..] else {
        panic!("one channel is late");
    };
    assert_eq!((x.role, x.low_pass), (Role::VelocityX, None));
    // within half a sample
    assert!((x.delay_s - 1.5e-3).abs() < 0.25e-3, "{}", x.delay_s);
}

#[test]
fn valid_a_contact_that_is_late_by_three_samples_is_told_by_the_jumps() {
    let mut effects = RigEffects::default();
    effects.delays_s[1] = 1.5e-3;
    let [contact] = late(&campaign(&effects))[..] else {
        panic!("the contact is late");
    };
    assert_eq!(contact.role, Role::Contact);
    // within half a sample
    let off_s = contact.delay_s - 1.5e-3;
    assert!(off_s.abs() < 0.25e-3, "{}", contact.delay_s);
}

#[test]
fn valid_velocities_behind_a_low_pass_are_told_by_their_jumps() {
    let mut records = campaign(&RigEffects::default());
    let decay = (-std::f64::consts::TAU * 200.0 / RATE_HZ).exp();
    for channel in records.iter_mut().flat_map(|r| &mut r.channels) {
        if matches!(channel.role, Role::VelocityX | Role::VelocityY) {
            let mut passed = channel.values[0];
            for value in &mut channel.values {
                passed = decay * passed + (1.0 - decay) * *value;
                *value = passed;
            }
        }
    }
    let found = late(&records);
    assert_eq!(found.len(), 2, "{found:?}");
    for channel in found {
        let filter = channel.low_pass.expect("a low-pass");
        assert!((100.0..400.0).contains(&filter.corner_hz), "{filter:?}");
    }
}
