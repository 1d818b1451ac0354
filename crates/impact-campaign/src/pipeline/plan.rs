//! Proposals of the settings to measure next, from the fit of a campaign, on the map of its motions.

use std::path::Path;

use serde::Serialize;

use crate::campaign::resolved::ResolvedCampaign;
use crate::pipeline::json::write_json;
use crate::pipeline::{Observed, PipelineError, Progress, identify, report};
use impact_identification::identify::boundary_plan::{BoundaryPlan, halving};
use impact_identification::identify::plan::{Obstacle, Proposal, propose};
use impact_records::message::plain;
use impact_records::motion::Motion;
use impact_report::kit::csv::Csv;
use labfiles_write::output::write_together;

/// What is written as plan.json.
#[derive(Debug, Clone, Serialize)]
pub struct MeasurementPlan {
    /// R as identified now; `None` if it is not identifiable.
    pub restitution: Option<f64>,
    /// Its standard error now.
    pub restitution_error_now: Option<f64>,
    /// The settings, the best first.
    pub proposals: Vec<Proposal>,
    /// Finer sweeps past the ends of z = 1, and R's interval from boundaries alone with them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundaries: Option<BoundaryPlan>,
    /// Why there are no proposals.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<Obstacle>,
}

/// Name of the result.
pub const FILE: &str = "plan.json";

/// Observe and identify a campaign, propose `count` settings, and write plan.json, plan.csv and the
/// map as SVG, PNG and PDF into a folder.
///
/// # Errors
/// If no record can be used or an output cannot be written.
pub fn plan(
    campaign: &ResolvedCampaign,
    count: usize,
    out: &Path,
    progress: Progress<'_>,
) -> Result<MeasurementPlan, PipelineError> {
    let observed = Observed::of(campaign, progress)?;
    progress("identify", 0, 1);
    let found = identify::identify(campaign, &observed, None)?;
    let evidence = observed.evidence(campaign);
    let proposals = propose(&evidence, found.identification.joint_fit.as_ref(), count);
    let (proposals, obstacle) = match proposals {
        Ok(proposals) => (proposals, None),
        Err(obstacle) => (Vec::new(), Some(obstacle)),
    };
    let fitted = found.identification.joint_fit.as_ref();
    let boundaries = fitted.and_then(|joint| halving(&evidence, &joint.fit.parameters));
    let now = found.identification.joint.parameters.restitution.as_ref();
    let plan = MeasurementPlan {
        restitution: now.and_then(|r| r.value),
        restitution_error_now: now.and_then(|r| r.standard_error),
        proposals,
        boundaries,
        obstacle,
    };
    progress("map", 0, 1);
    let proposals = plan.proposals.clone();
    let mut content = report::content_with(campaign, &observed, &found, "", proposals)?;
    content.compared.comparisons.clear();
    let mut files = impact_report::plan_map(&content, campaign.report.decimal_comma)?;
    files.push(("plan.csv".to_owned(), csv(&plan.proposals).into_bytes()));
    write_together(out, &files)?;
    write_json(&out.join(FILE), &plan)?;
    Ok(plan)
}

fn csv(proposals: &[Proposal]) -> String {
    let mut csv = Csv::new(&[
        "rank",
        "drive_frequency_hz",
        "clearance_m",
        "frequency_ratio",
        "clearance_ratio",
        "motion",
        "approach",
        "restitution_error_after",
    ]);
    for (i, p) in proposals.iter().enumerate() {
        let motion = Motion::periodic(1, p.periods_n).label();
        let setting = [
            p.frequency_hz,
            p.clearance_m,
            p.frequency_ratio,
            p.clearance_ratio,
        ];
        csv.row()
            .numbers(&[Some((i + 1) as f64)])
            .numbers(&setting.map(Some))
            .texts(&[&motion, &plain(&p.approach)])
            .numbers(&[Some(p.restitution_error_after)]);
    }
    csv.finish()
}
