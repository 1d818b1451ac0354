//! Several campaigns: their results read, compared, and written as tables and documents.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use crate::campaign::resolved::ResolvedCampaign;
use crate::pipeline::identify::{FILE, IdentificationFile, versions};
use crate::pipeline::report::ReportFile;
use crate::pipeline::{PipelineError, layout};
use impact_fit::parameters::Coordinate;
use impact_fit::{JointFit, ParameterSet, VerdictKind};
use impact_identification::compare::{Campaign, Comparison, Difference};
use impact_identification::identify::Identification;
use impact_report::kit::csv::Csv;
use impact_report::{CampaignsContent, Format, Report, ReportOptions};

/// Name of the result's file.
pub const COMPARISON: &str = "comparison.json";
/// Name of the table of estimates and differences.
pub const TABLE: &str = "comparison.csv";

/// The campaigns that a folder of results holds, one for each specimen; `measurement` is its number among
/// those given.
///
/// # Errors
/// [`PipelineError::NoResults`] if the folder holds no results, [`PipelineError::Layout`] if they are of
/// another version.
pub fn read(folder: &Path, measurement: usize) -> Result<Vec<Campaign>, PipelineError> {
    let file = if folder.is_dir() {
        folder.join(FILE)
    } else {
        folder.to_path_buf()
    };
    let unusable = |reason: String, remedy: String| PipelineError::NoResults {
        path: file.display().to_string(),
        reason,
        remedy,
    };
    let text = std::fs::read_to_string(&file)
        .map_err(|e| unusable(labfiles::said(&e), missing(folder)))?;
    let again = || {
        format!(
            "identify the campaign again into another folder than {}: impactid run CAMPAIGN.TOML --out DIR",
            folder.display()
        )
    };
    let json: serde_json::Value =
        serde_json::from_str(&text).map_err(|e| unusable(e.to_string(), again()))?;
    let stated = serde_json::from_value(json["versions"].clone()).unwrap_or_default();
    layout::check_versions(&file, FILE, &stated)?;
    let found: IdentificationFile =
        serde_json::from_value(json).map_err(|e| unusable(e.to_string(), again()))?;
    let campaign: ResolvedCampaign = serde_json::from_value(found.provenance.settings)
        .map_err(|e| unusable(e.to_string(), again()))?;
    Ok(campaigns(&campaign, found.identification, measurement))
}

/// What to do where there are no results.
fn missing(folder: &Path) -> String {
    let campaign = folder.join("campaign.toml");
    if campaign.is_file() {
        format!(
            "this folder holds records, not results: give {}",
            campaign.display()
        )
    } else {
        "give folders that `impactid run` or `impactid identify` has written, or campaign.toml \
                  files"
            .to_owned()
    }
}

/// The campaigns that an identification holds, one for each specimen.
pub fn campaigns(
    campaign: &ResolvedCampaign,
    found: Identification,
    measurement: usize,
) -> Vec<Campaign> {
    let one =
        |name: String, verdict: VerdictKind, parameters: ParameterSet, fit: Option<JointFit>| {
            Campaign {
                name,
                measurement,
                machine: campaign.about.machine,
                flight: campaign.about.flight,
                measured: campaign.about.measured.clone(),
                synthetic: campaign.about.synthetic,
                verdict,
                parameters,
                fit,
                rig: campaign.rig.name.clone(),
                shared: campaign.rig.shared.clone(),
                channels: campaign.channels.clone(),
            }
        };
    if found.specimens.is_empty() {
        let (name, joint) = (campaign.about.name.clone(), found.joint.parameters);
        return vec![one(name, found.verdict.kind, joint, found.joint_fit)];
    }
    let specimens = found.specimens.into_iter();
    specimens
        .map(|(specimen, result)| {
            let name = format!("{}, {specimen}", campaign.about.name);
            let joint = result.joint.parameters;
            one(name, result.verdict.kind, joint, result.joint_fit)
        })
        .collect()
}

/// Give campaigns of one name the places that they came from.
pub fn tell_apart(campaigns: &mut [Campaign], places: &[String]) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for campaign in campaigns.iter() {
        *counts.entry(campaign.name.clone()).or_default() += 1;
    }
    for campaign in campaigns {
        let several = counts.get(&campaign.name).is_some_and(|n| *n > 1);
        if let Some(place) = places.get(campaign.measurement).filter(|_| several) {
            campaign.name = format!("{} ({place})", campaign.name);
        }
    }
}

/// comparison.json: whether anything changed in words, the p-value by which that is decided, the comparison, and
/// versions.
#[derive(Serialize)]
struct Written<'a> {
    outcome: impact_identification::compare::ComparisonOutcome,
    p_value: Option<f64>,
    #[serde(flatten)]
    comparison: &'a Comparison,
    versions: BTreeMap<String, String>,
}

/// The files of a comparison: comparison.json, comparison.csv, the data of the figure, and the documents
/// that are wanted.
///
/// # Errors
/// If a document cannot be set or the result is no JSON.
pub fn files(
    content: &CampaignsContent,
    formats: &[Format],
    options: &ReportOptions,
) -> Result<Vec<ReportFile>, PipelineError> {
    let comparison = &content.comparison;
    let report = Report::of_campaigns(content, options);
    let written = Written {
        outcome: comparison.outcome(),
        p_value: comparison.p_value(),
        comparison,
        versions: versions(),
    };
    let json =
        serde_json::to_string_pretty(&written).map_err(PipelineError::in_table(COMPARISON))?;
    let mut files = vec![
        (COMPARISON.to_owned(), (json + "\n").into_bytes()),
        (TABLE.to_owned(), table(comparison).into_bytes()),
    ];
    files.extend(report.all_files(formats)?);
    Ok(files)
}

/// The estimates of all campaigns and their differences against the first, SI, as CSV.
fn table(comparison: &Comparison) -> String {
    let mut csv = Csv::new(&[
        "campaign",
        "measured",
        "parameter",
        "value",
        "low95",
        "high95",
        "difference",
        "difference_low95",
        "difference_high95",
        "independent_low95",
        "independent_high95",
        "p_value",
    ]);
    for (number, campaign) in comparison.campaigns.iter().enumerate() {
        for parameter in Coordinate::PHYSICAL {
            let Some(estimate) = campaign.parameters.get(parameter) else {
                continue;
            };
            let mut all = comparison.differences.iter();
            let found = all.find(|d| d.campaign == number && d.parameter == parameter);
            let of = |pick: fn(&Difference) -> f64| found.map(pick);
            let measured = campaign.measured.as_deref().unwrap_or_default();
            csv.row()
                .texts(&[&campaign.name, measured, parameter.name()])
                .exact(&[
                    estimate.value,
                    estimate.interval95.map(|i| i[0]),
                    estimate.interval95.map(|i| i[1]),
                    of(|d| d.value),
                    of(|d| d.interval95[0]),
                    of(|d| d.interval95[1]),
                    of(|d| d.independent_interval95[0]),
                    of(|d| d.independent_interval95[1]),
                    of(|d| d.p_value),
                ]);
        }
    }
    csv.finish()
}
