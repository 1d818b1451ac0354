//! The report of a campaign.

use crate::campaign::resolved::ResolvedCampaign;
use crate::campaign::written::Paper as WrittenPaper;
use crate::pipeline::identify::Found;
use crate::pipeline::observe::read_one;
use crate::pipeline::{Observed, PipelineError};
use crate::report::assemble::{Gathered, assemble, chosen_records};
use crate::report::{Paper, RenderOptions, render_pdf};

/// Name of the report's file.
pub const FILE: &str = "report.pdf";

/// Make the report of what was observed and identified.
///
/// # Errors
/// Where the document cannot be set.
pub fn pdf(
    campaign: &ResolvedCampaign,
    observed: &Observed,
    found: &Found,
    command_line: &str,
) -> Result<Vec<u8>, PipelineError> {
    let chosen = chosen_records(&observed.observations, &campaign.report.points);
    let records: Vec<_> = chosen
        .iter()
        .filter_map(|index| campaign.records.get(*index))
        .map(|entry| read_one(campaign, entry))
        .collect();
    let content = assemble(&Gathered {
        campaign: &facts(campaign),
        observations: &observed.observations,
        brackets: &observed.brackets,
        identification: &found.identification,
        fit: found.outcome.fit.as_ref(),
        factor: found.outcome.factor,
        left_out: &found.outcome.left_out,
        chosen: &chosen,
        chosen_records: &records,
        command_line,
    });
    let options = RenderOptions {
        paper: match campaign.report.paper {
            WrittenPaper::A4 => Paper::A4,
            WrittenPaper::UsLetter => Paper::Letter,
        },
        decimal_comma: campaign.report.decimal_comma,
        ..RenderOptions::default()
    };
    Ok(render_pdf(&content, &options)?)
}

/// What the report says of the campaign itself.
fn facts(campaign: &ResolvedCampaign) -> crate::report::assemble::CampaignFacts {
    crate::report::assemble::CampaignFacts {
        title: campaign.report.title.clone(),
        name: campaign.name.clone(),
        rig: campaign.machine,
        nominal: [
            (
                "natural frequency $f_0$",
                campaign.rig.natural_frequency_hz,
                "Hz",
            ),
            ("damping ratio $β$", campaign.rig.damping_ratio, ""),
            (
                "static deflection $x_st$",
                campaign.rig.static_deflection_m,
                "m",
            ),
            ("restitution $R$", campaign.rig.restitution, ""),
            ("gain uncertainty", Some(campaign.rig.gain_uncertainty), ""),
        ]
        .into_iter()
        .filter_map(|(name, value, unit)| Some((name.to_owned(), value?, unit.to_owned())))
        .collect(),
        channels: campaign
            .channels
            .iter()
            .map(|c| (c.role, c.source.text(), c.high_pass_hz))
            .collect(),
        files: {
            let mut files: Vec<_> = campaign.records.iter().map(|r| &r.file).collect();
            files.sort();
            files.dedup();
            files.len()
        },
        settings: serde_json::to_string_pretty(&ResolvedCampaign {
            records: Vec::new(),
            ..campaign.clone()
        })
        .unwrap_or_default(),
    }
}
