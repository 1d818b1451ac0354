//! The identification of what a paper prints: its approach speeds are the only method.

use std::collections::BTreeMap;

use crate::identify::identification::Identification;
use impact_fit::methods::published::{METHOD, PublishedSpeed, fit};

/// Identify β from published speeds and test printed values of it.
pub fn identify(speeds: &[PublishedSpeed], printed: &[f64]) -> Identification {
    let (result, verdict) = fit(speeds, printed);
    Identification {
        verdict,
        joint: result.clone(),
        methods: BTreeMap::from([(METHOD, result)]),
        ..Identification::default()
    }
}
