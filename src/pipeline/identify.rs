//! The identification of a campaign, with settings, versions and fingerprints.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::campaign::resolved::ResolvedCampaign;
use crate::identify::Identification;
use crate::identify::evidence::{Evidence, Nominal};
use crate::identify::fit::Fit;
use crate::identify::specimens::identify_campaign;
use crate::identify::uncertainty::Asked;
use crate::pipeline::store::write_json;
use crate::pipeline::{Observed, PipelineError, inputs};

/// Name of the result's file.
pub const FILE: &str = "identification.json";

/// An identification with what the report needs beside it.
#[derive(Debug, Clone)]
pub struct Found {
    /// What is written.
    pub identification: Identification,
    /// Fit and records left out.
    pub outcome: Kept,
}

/// What of an outcome the report needs beside identification.json.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Kept {
    /// The joint fit.
    pub fit: Option<Fit>,
    /// Factor on its covariance.
    pub factor: f64,
    /// What a fit left out, and why.
    pub left_out: Vec<(String, String)>,
}

/// What the campaign states about its rig.
pub fn nominal(campaign: &ResolvedCampaign) -> Nominal {
    Nominal {
        restitution: campaign.rig.restitution,
        natural_frequency_hz: campaign.rig.natural_frequency_hz,
        damping_ratio: campaign.rig.damping_ratio,
        static_deflection_m: campaign.rig.static_deflection_m,
        gain_uncertainty: campaign.rig.gain_uncertainty,
        corner_uncertainty: campaign.rig.corner_uncertainty,
        clearance_uncertainty_m: campaign.rig.clearance_uncertainty_m,
        ..Nominal::default()
    }
}

/// What an identification of a campaign starts from.
pub fn evidence<'a>(campaign: &ResolvedCampaign, observed: &'a Observed) -> Evidence<'a> {
    Evidence {
        rig: campaign.machine,
        observations: &observed.observations,
        brackets: &observed.brackets,
        nominal: nominal(campaign),
        uncertainty: Asked {
            way: campaign.analysis.uncertainty,
            replicas: campaign.analysis.replicas,
            seed: campaign.analysis.seed,
        },
    }
}

/// Identify what was observed.
///
/// # Errors
/// Where the settings cannot be written as JSON.
pub fn identify(campaign: &ResolvedCampaign, observed: &Observed) -> Result<Found, PipelineError> {
    let (outcome, specimens) = identify_campaign(&evidence(campaign, observed));
    let identification = Identification {
        verdict: outcome.verdict,
        joint: outcome.joint,
        methods: outcome.methods,
        agreement: outcome.agreement,
        suspicions: outcome.suspicions,
        uncertainty: outcome.uncertainty,
        specimens,
        settings: settings(campaign)?,
        versions: versions(),
        inputs_sha256: inputs::hashes(campaign),
    };
    let outcome = Kept {
        fit: outcome.fit,
        factor: outcome.factor,
        left_out: outcome.left_out,
    };
    Ok(Found {
        identification,
        outcome,
    })
}

/// The resolved settings without the list of records, which has its own table.
pub(super) fn settings(campaign: &ResolvedCampaign) -> Result<serde_json::Value, PipelineError> {
    let short = ResolvedCampaign {
        records: Vec::new(),
        ..campaign.clone()
    };
    serde_json::to_value(short).map_err(|e| PipelineError::Table {
        table: "settings".into(),
        reason: e.to_string(),
    })
}

/// Versions of the program and of what it writes.
pub fn versions() -> BTreeMap<String, String> {
    [
        ("impactid", env!("CARGO_PKG_VERSION")),
        ("identification.json", "1"),
        ("records.parquet", "1"),
    ]
    .into_iter()
    .map(|(name, version)| (name.to_owned(), version.to_owned()))
    .collect()
}

/// Write identification.json.
///
/// # Errors
/// Where it cannot be written.
pub fn write(identification: &Identification, out: &Path) -> Result<(), PipelineError> {
    write_json(&out.join(FILE), identification)
}
