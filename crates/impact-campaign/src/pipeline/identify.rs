//! The identification of a campaign, with settings, versions and fingerprints.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::campaign::resolved::ResolvedCampaign;
use crate::campaign::sections::rig::NominalValues;
use crate::pipeline::json::write_json;
use crate::pipeline::{Observed, PipelineError, inputs};
use impact_fit::evidence::options::UncertaintyOptions;
use impact_fit::evidence::{Evidence, Nominal};
use impact_fit::parameters::effect::Effects;
use impact_fit::parameters::gain_index;
use impact_fit::solver::FitProgress;
use impact_identification::identify::{Identification, Provenance, identify_campaign};
use impact_records::record::calibrate::ChannelSetup;
use impact_records::record::late::remainder_s;
use impact_records::signal::robust;
use labfiles::output::write_bytes;

/// Name of the result's file.
pub const FILE: &str = "identification.json";
/// Name of the table of the joint estimate's uncertainty budget.
pub const BUDGET: &str = "uncertainty_budget.csv";

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

/// What the campaign states about its rig.
pub fn nominal(campaign: &ResolvedCampaign) -> Nominal {
    Nominal {
        restitution: campaign.rig.restitution,
        natural_frequency_hz: campaign.rig.natural_frequency_hz,
        damping_ratio: campaign.rig.damping_ratio,
        static_deflection_m: campaign.rig.static_deflection_m,
        gain_uncertainty: campaign.rig.gain_uncertainty,
        corner_uncertainty: campaign.rig.corner_uncertainty,
        clock_uncertainty: campaign.rig.clock_uncertainty,
        clearance_uncertainty_m: campaign.rig.clearance_uncertainty_m,
        mass_asymmetry: mass_asymmetry(&campaign.rig),
        effects: match &campaign.rig.effects {
            Some(kinds) => Effects::of(kinds),
            None => Effects::all(),
        },
        flight: campaign.flight,
        ..delays(&campaign.channels)
    }
}

/// ln(`m_x`/`m_y`) of the stated masses, with its standard uncertainty; `None` unless both are stated.
fn mass_asymmetry(rig: &NominalValues) -> Option<[f64; 2]> {
    let (x, y) = rig.mass_x_kg.zip(rig.mass_y_kg)?;
    let deviation = rig.mass_uncertainty * std::f64::consts::SQRT_2;
    Some([(x / y).ln(), deviation])
}

/// The stated delays of the motion channels.
fn delays(channels: &[ChannelSetup]) -> Nominal {
    let mut nominal = Nominal::default();
    for channel in channels {
        if let Some(i) = gain_index(channel.role) {
            nominal.delays_s[i] = channel.delay_s;
            nominal.delay_uncertainties_s[i] = channel.delay_uncertainty_s;
        }
    }
    nominal
}

/// Uncertainty of the delay of a low-pass whose corner and order jumps told, relative.
const ROUGHLY: f64 = 0.5;

/// What is stated, with what is left of the delays of channels whose whole samples were removed.
fn nominal_of(campaign: &ResolvedCampaign, observed: &Observed) -> Nominal {
    let mut nominal = nominal(campaign);
    let late = observed.late();
    let campaign = campaign.with_late(late);
    let rates: Vec<f64> = observed
        .observations
        .iter()
        .map(|o| o.sample_rate_hz)
        .collect();
    if let Some(rate_hz) = robust::median(&rates) {
        for setup in &campaign.channels {
            if let Some(i) = gain_index(setup.role) {
                nominal.delays_s[i] = remainder_s(setup, rate_hz);
                let found = late.iter().find(|l| l.role == setup.role);
                if let Some(filter) = found.and_then(|l| l.low_pass) {
                    // its corner is known roughly, and with it its delay
                    nominal.delay_uncertainties_s[i] = Some(ROUGHLY * filter.delay_s());
                }
            }
        }
    }
    nominal
}

/// What an identification of a campaign starts from.
pub fn evidence<'a>(campaign: &ResolvedCampaign, observed: &'a Observed) -> Evidence<'a> {
    Evidence {
        rig: campaign.machine,
        observations: &observed.observations,
        brackets: &observed.brackets,
        nominal: nominal_of(campaign, observed),
        uncertainty: UncertaintyOptions {
            intervals: campaign.analysis.uncertainty,
            replicas: campaign.analysis.replicas,
            seed: campaign.analysis.seed,
        },
        progress: None,
    }
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
        ..evidence(campaign, observed)
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
        write_bytes(&out.join(BUDGET), budget.table().as_bytes())?;
    }
    write_json(&out.join(FILE), identification)
}
