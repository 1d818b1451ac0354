//! Campaigns on impact oscillators: campaign.toml, the stages from records to the report, and their files.
//!
//! [`campaign`] reads campaign.toml and gives a campaign with every default made explicit, or every
//! problem at once; it also proposes a campaign.toml for a folder of records. [`pipeline`] runs the
//! stages (observe, identify, report), keeps what each leaves, and watches campaigns whose records are
//! still arriving. Neither prints.
//!
//! ```
//! use impact_campaign::campaign::load;
//! use impact_campaign::pipeline::Observed;
//! use impact_campaign::pipeline::synthesise::{Recipe, write_campaign};
//! use simulated_rig::{Faults, RigSpec, Truth};
//!
//! // a simulated campaign as files: R = 0.9, f0 = 12.6 Hz, β = 0.07, x_st = 1 mm
//! let folder = tempfile::tempdir()?;
//! let recipe = Recipe {
//!     truth: Truth::symmetric(0.9, 12.6, 0.07, 1e-3),
//!     faults: Faults::default(),
//!     rig: RigSpec::exact(),
//!     records: 12,
//!     beats: false,
//!     seed: 5,
//!     rig_seed: None,
//! };
//! write_campaign(&recipe, folder.path())?;
//!
//! let loaded = load(&folder.path().join("campaign.toml"), &labfiles::open);
//! let campaign = loaded.campaign.ok_or("campaign.toml has problems")?;
//! assert_eq!(campaign.records.len(), 12);
//! let observed = Observed::of(&campaign, &|_stage, _done, _of| {})?;
//! assert_eq!(observed.observations.len(), 12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod campaign;
pub mod pipeline;

/// The example of the README, checked as the others are.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
