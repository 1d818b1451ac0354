//! Filters, spectra, tones and local polynomials on plain slices; the only user of rustfft.
//!
//! Nothing here depends on records: every function takes samples at a uniform step.

pub mod columns;
pub mod decay;
pub mod digits;
pub mod drift;
pub mod echoes;
pub mod interpolation;
pub mod kalman;
pub mod local_fit;
pub mod onsets;
pub(crate) mod ringing;
pub mod robust;
pub(crate) mod smoothing;
pub mod spacing;
mod spectrum;
pub mod steps;
pub mod swings;
pub mod thinning;
pub mod tone;
pub(crate) mod turns;
pub mod whole;
pub mod wrapped;
