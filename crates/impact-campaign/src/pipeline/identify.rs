//! The identification of a campaign, with settings, versions and fingerprints.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::campaign::resolved::ResolvedCampaign;
use crate::pipeline::json::write_json;
use crate::pipeline::{Observed, PipelineError, budget, inputs};
use impact_fit::evidence::Evidence;
use impact_fit::solver::FitProgress;
use impact_identification::identify::{Identification, Provenance, identify_campaign};
use labfiles_write::output::write_bytes;

/// Name of the result's file.
pub const FILE: &str = "identification.json";

/// An identification with its provenance: identification.json.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct IdentificationFile {
    /// The result.
    #[serde(flatten)]
    pub identification: Identification,
    /// Settings, versions and inputs.
    #[serde(flatten)]
    pub provenance: Provenance,
}

/// Identify what was observed; `progress` counts the iterations of the fits.
///
/// # Errors
/// Where the settings cannot be written as JSON.
pub fn identify(
    campaign: &ResolvedCampaign,
    observed: &Observed,
    progress: Option<&FitProgress>,
) -> Result<IdentificationFile, PipelineError> {
    let evidence = Evidence {
        progress,
        ..observed.evidence(campaign)
    };
    // the fit does not need the hashes of the inputs, which take a pass over all files
    let (identification, provenance) =
        rayon::join(|| identify_campaign(&evidence), || provenance(campaign));
    Ok(IdentificationFile {
        identification,
        provenance: provenance?,
    })
}

/// Where an identification of a campaign comes from.
///
/// # Errors
/// Where the settings cannot be written as JSON.
pub(super) fn provenance(campaign: &ResolvedCampaign) -> Result<Provenance, PipelineError> {
    Ok(Provenance {
        settings: settings(campaign)?,
        versions: versions(),
        inputs_sha256: inputs::hashes(campaign),
    })
}

/// The resolved settings without the list of records, which has its own table.
pub(super) fn settings(campaign: &ResolvedCampaign) -> Result<serde_json::Value, PipelineError> {
    let short = ResolvedCampaign {
        records: Vec::new(),
        ..campaign.clone()
    };
    serde_json::to_value(short).map_err(PipelineError::in_table("settings"))
}

/// Versions of the program and of what it writes.
pub fn versions() -> BTreeMap<String, String> {
    [
        ("impactid", env!("CARGO_PKG_VERSION")),
        ("identification.json", "6"),
        ("records.parquet", "1"),
    ]
    .into_iter()
    .map(|(name, version)| (name.to_owned(), version.to_owned()))
    .collect()
}

/// Write identification.json and the uncertainty budget.
///
/// # Errors
/// Where it cannot be written.
pub fn write(identification: &IdentificationFile, out: &Path) -> Result<(), PipelineError> {
    let budget = &identification.identification.uncertainty.budget;
    if !budget.rows.is_empty() {
        write_bytes(&out.join(budget::FILE), budget::csv(budget).as_bytes())?;
    }
    write_json(&out.join(FILE), identification)
}
