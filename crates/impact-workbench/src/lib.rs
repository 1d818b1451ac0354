//! The theory of impact oscillators at work: studies that a file describes, a live explorer in the
//! browser, and studies of what the identification's intervals are worth.
//!
//! [`theory`] runs studies (regions of motion, characteristics along a line, basins of attraction, time
//! series) and [`figures`] draws them. [`explore`] serves the explorer on loopback. [`coverage`] and
//! [`pairs`] identify simulated campaigns and count how often the truth is held. [`selftest`] compares
//! with published numbers.
//!
//! ```
//! use impact_campaign::pipeline::block_cache::BlockCache;
//! use impact_workbench::theory::{Pictures, Study, StudyContext, run};
//! use std::sync::Mutex;
//!
//! let study: Study = toml::from_str(
//!     r#"
//!     title = "two periods of z = 1"
//!     damping_ratio = 0.07
//!     restitution = 0.9
//!     [time_series.z1]
//!     setting = { frequency_ratio = 1.3, clearance = 1.0 }
//!     skip_periods = 200.0
//!     periods = 2.0
//!     "#,
//! )?;
//! let files = Mutex::new(Vec::new());
//! run(&study, &StudyContext {
//!     output: &|name, bytes| {
//!         files.lock().expect("one writer").push((name.to_owned(), bytes.len()));
//!         Ok(())
//!     },
//!     pictures: Pictures::None,
//!     blocks: &BlockCache::none(),
//!     progress: &|_done, _of| {},
//!     inform: &|_message| {},
//! })?;
//! let files = files.into_inner()?;
//! assert!(files.iter().any(|(name, _)| name == "z1.csv"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod coverage;
pub mod explore;
pub mod figures;
pub mod pairs;
pub mod selftest;
pub mod theory;

/// The example of the README, checked as the others are.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
