//! Records of impact oscillators: what was acquired, its impacts, and its motion.
//!
//! [`record`] holds a record's channels in SI on one time axis with its setting and flags, and turns
//! what `labfiles` reads into it. [`event`] finds the impacts, their speeds and the drive. [`motion`]
//! names the motion z = p/n with the evidence for it, and brackets the boundaries between motions.
//! [`signal`] is the arithmetic on plain slices that they share; [`message`] is how this and the
//! crates that build on it state findings as values, with the text of the reader's [`language`] made
//! where it is printed. No
//! parameter of the oscillator enters.
//!
//! A contact that closes once in each of ten drive periods is the motion z = 1:
//!
//! ```
//! use impact_records::event::{DetectSettings, RigKind, detect};
//! use impact_records::motion::{ClassifySettings, classify};
//! use impact_records::record::{Channel, Record, Role, Setting, Sweep};
//! use labfiles::units::Dimension;
//!
//! let channel = |role: Role, values: Vec<f64>| Channel {
//!     role,
//!     name: role.name().into(),
//!     dimension: Dimension::Voltage,
//!     values,
//!     high_pass_hz: None,
//!     low_pass: None,
//!     smoothing: None,
//!     threshold: (role == Role::Contact).then_some(2.5),
//! };
//! let phase = |i: usize| std::f64::consts::TAU * i as f64 / 200.0;
//! let closed = |i: usize| if (20..23).contains(&(i % 200)) { 5.0 } else { 0.0 };
//! let record = Record {
//!     id: "r1".into(),
//!     sample_rate_hz: 2000.0,
//!     channels: vec![
//!         channel(Role::Drive, (0..2000).map(|i| phase(i).cos()).collect()),
//!         channel(Role::Contact, (0..2000).map(closed).collect()),
//!     ],
//!     setting: Setting {
//!         stated_frequency_hz: Some(10.0),
//!         clearance_m: Some(1e-3),
//!         sweep: Sweep::Up,
//!         drive_amplitude: 1.0,
//!         sequence: 0,
//!         specimen: None,
//!         ..Setting::default()
//!     },
//!     listed: Default::default(),
//!     flags: Vec::new(),
//! };
//! let found = detect(&record, RigKind::Double, &DetectSettings::default());
//! let motion = classify(&found, record.duration_s(), &ClassifySettings::default());
//! assert_eq!(motion.motion.label(), "1");
//! assert_eq!(motion.impacts_and_periods(), Some((1, 1)));
//! ```

pub mod event;
pub mod language;
pub mod message;
pub mod motion;
pub mod record;
pub mod signal;

/// The examples of the README, checked as the others are.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
