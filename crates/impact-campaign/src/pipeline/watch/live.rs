//! The answer of the records so far, and the page that shows it.

use std::path::Path;
use std::time::Duration;

use sha2::{Digest, Sha256};

use super::processor_time::Meter;
use crate::campaign::resolved::ResolvedCampaign;
use crate::pipeline::identify::{self, IdentificationFile};
use crate::pipeline::json::write_json;
use crate::pipeline::{Observed, PipelineError, inputs, report};
use impact_identification::identify::plan::{Proposal, propose};
use impact_report::LivePage;
use labfiles_write::output::write_bytes;

/// The records taken so far with their fit.
#[derive(Debug, Clone)]
pub struct Live {
    /// The campaign with these records.
    pub campaign: ResolvedCampaign,
    /// What was observed.
    pub observed: Observed,
    /// What was identified.
    pub found: IdentificationFile,
    /// The setting to measure next; `None` where none can be proposed.
    pub next: Option<Proposal>,
}

impl Live {
    /// Fit what was observed, and propose the next setting; with the processor time after the fit.
    ///
    /// # Errors
    /// Where the settings cannot be written as JSON.
    pub(super) fn of(
        campaign: ResolvedCampaign,
        observed: Observed,
        meter: Meter,
    ) -> Result<(Self, Duration), PipelineError> {
        let found = identify::identify(&campaign, &observed, None)?;
        let identified = meter.read();
        let evidence = observed.evidence(&campaign);
        let next = propose(&evidence, found.identification.joint_fit.as_ref(), 1);
        let next = next.ok().and_then(|mut all| all.pop());
        let live = Self {
            campaign,
            observed,
            found,
            next,
        };
        Ok((live, identified))
    }

    /// Whether the fit is that of these records.
    pub(super) fn is_of(&self, campaign: &ResolvedCampaign, observed: &Observed) -> bool {
        let mut own = self.campaign.clone();
        own.report.clone_from(&campaign.report);
        own == *campaign && self.observed.observations == observed.observations
    }
}

/// Name of the page.
const PAGE: &str = "report.html";

/// Write the page, which reloads itself when a newer one is there, and identification.json.
///
/// # Errors
/// If the page cannot be made, or a file cannot be written.
pub fn write_live(live: &Live, command_line: &str, out: &Path) -> Result<(), PipelineError> {
    let version = version(&live.found);
    let usable = live.observed.observations.iter();
    let page = LivePage {
        state: report::LIVE_STATE.to_owned(),
        version: version.clone(),
        records: usable.filter(|o| !o.excluded()).count(),
    };
    let content = report::content(&live.campaign, &live.observed, &live.found, command_line)?;
    let html = report::page(&content, &live.campaign, page)?;
    write_bytes(&out.join(PAGE), html.as_bytes())?;
    write_json(&out.join(identify::FILE), &live.found)?;
    let state = format!("impactidLive(\"{version}\");\n");
    Ok(write_bytes(
        &out.join(report::LIVE_STATE),
        state.as_bytes(),
    )?)
}

/// What distinguishes an answer from another one: all that it was made from.
fn version(found: &IdentificationFile) -> String {
    let mut hash = Sha256::new();
    hash.update(found.provenance.settings.to_string());
    for (name, input) in &found.provenance.inputs_sha256 {
        hash.update(format!("{name} {input}\n"));
    }
    inputs::hexadecimal(hash)
}
