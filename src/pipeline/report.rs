//! The report of a campaign.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::campaign::resolved::{Report as Look, ResolvedCampaign};
use crate::campaign::written::{Language, Paper as WrittenPaper};
use crate::pipeline::identify::IdentificationFile;
use crate::pipeline::observe::read_one;
use crate::pipeline::{Observed, PipelineError};
use crate::record::Record;
use crate::report::assemble::{
    CampaignFacts, ChannelFacts, Gathered, assemble, chosen_records, shown_decays,
};
use crate::report::words::Words;
use crate::report::{Format, Logo, Paper, RenderOptions, Report, ReportContent};
use labfiles::open;
use labfiles::output::{make_folder, write_bytes};

/// Name of the report's file.
pub const FILE: &str = "report.pdf";

/// A file of the report: its path relative to the results' folder, and its bytes.
pub type ReportFile = (String, Vec<u8>);

/// Make the report of what was observed and identified, in every format that the campaign asks
/// for, with the figures' data.
///
/// # Errors
/// Where the template or the logo cannot be read, or the document cannot be set.
pub fn files(
    campaign: &ResolvedCampaign,
    observed: &Observed,
    found: &IdentificationFile,
    command_line: &str,
) -> Result<Vec<ReportFile>, PipelineError> {
    render(&content(campaign, observed, found, command_line)?, campaign)
}

/// Draw a content as the campaign asks for it.
///
/// # Errors
/// Where the template or the logo cannot be read, or the document cannot be set.
pub fn render(
    content: &ReportContent,
    campaign: &ResolvedCampaign,
) -> Result<Vec<ReportFile>, PipelineError> {
    let report = Report::new(content, &options(&campaign.report)?);
    let mut formats = campaign.report.formats.clone();
    formats.retain(|f| *f != Format::Csv);
    formats.push(Format::Csv);
    let mut out = Vec::new();
    for format in formats {
        out.extend(report.files(format)?);
    }
    Ok(out)
}

/// Write the report's files into the results' folder.
///
/// # Errors
/// Where one cannot be written.
pub fn write(files: &[ReportFile], out: &Path) -> Result<(), PipelineError> {
    for (name, bytes) in files {
        let path = out.join(name);
        if let Some(folder) = path.parent() {
            make_folder(folder)?;
        }
        write_bytes(&path, bytes)?;
    }
    Ok(())
}

/// What the report shows, as plain data.
///
/// # Errors
/// Where the settings cannot be written as text.
pub fn content(
    campaign: &ResolvedCampaign,
    observed: &Observed,
    found: &IdentificationFile,
    command_line: &str,
) -> Result<ReportContent, PipelineError> {
    let chosen = chosen_records(&observed.observations, &campaign.report.points);
    let decays = shown_decays(&observed.observations);
    Ok(assemble(&Gathered {
        campaign: &facts(campaign)?,
        observations: &observed.observations,
        brackets: &observed.brackets,
        identification: &found.identification,
        provenance: &found.provenance,
        chosen: &chosen,
        chosen_records: &records(campaign, &chosen),
        decays: &decays,
        decay_records: &records(campaign, &decays),
        command_line,
    }))
}

fn records(campaign: &ResolvedCampaign, indices: &[usize]) -> Vec<Record> {
    let entries = indices.par_iter().filter_map(|i| campaign.records.get(*i));
    entries.map(|entry| read_one(campaign, entry)).collect()
}

/// The words of the report: of the table that is named, else of the language where the program
/// has them.
///
/// # Errors
/// Where the table cannot be read, or is none.
pub fn words(look: &Look) -> Result<Option<Words>, PipelineError> {
    let Some(path) = &look.words else {
        let german = look.language == Language::De;
        return Ok(german.then(|| Words::german().clone()));
    };
    let unusable = |reason: String| PipelineError::Look {
        path: path.display().to_string(),
        reason,
    };
    let text = std::fs::read_to_string(path).map_err(|error| unusable(error.to_string()))?;
    let words = Words::read(&text).map_err(|error| unusable(error.to_string()))?;
    Ok(Some(words))
}

fn options(look: &Look) -> Result<RenderOptions, PipelineError> {
    let unreadable = |path: &Path, error: std::io::Error| PipelineError::Look {
        path: path.display().to_string(),
        reason: error.to_string(),
    };
    let template =
        |path: &PathBuf| std::fs::read_to_string(path).map_err(|error| unreadable(path, error));
    let logo = |path: &PathBuf| {
        let bytes = std::fs::read(path).map_err(|error| unreadable(path, error))?;
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        Ok::<_, PipelineError>(Logo {
            bytes,
            extension: extension.to_lowercase(),
        })
    };
    Ok(RenderOptions {
        words: words(look)?,
        paper: match look.paper {
            WrittenPaper::A4 => Paper::A4,
            WrittenPaper::UsLetter => Paper::Letter,
        },
        decimal_comma: look.decimal_comma,
        language: match look.language {
            Language::En => "en",
            Language::Cs => "cs",
            Language::De => "de",
        }
        .to_owned(),
        template: look.template.as_ref().map(template).transpose()?,
        logo: look.logo.as_ref().map(logo).transpose()?,
    })
}

/// What the report says of the campaign itself.
fn facts(campaign: &ResolvedCampaign) -> Result<CampaignFacts, PipelineError> {
    Ok(CampaignFacts {
        title: campaign.report.title.clone(),
        name: campaign.name.clone(),
        rig: campaign.machine,
        synthetic: campaign.synthetic,
        laboratory: campaign.laboratory.clone(),
        dates: dates(campaign),
        nominal: nominal(campaign),
        channels: campaign
            .channels
            .iter()
            .map(|c| ChannelFacts {
                role: c.role,
                name: c.source.text(),
                high_pass_hz: c.high_pass_hz,
                instrument: c.instrument.clone(),
            })
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
        .map_err(|e| PipelineError::Table {
            table: "the settings".to_owned(),
            reason: e.to_string(),
        })?,
    })
}

fn nominal(campaign: &ResolvedCampaign) -> Vec<(String, f64, String)> {
    let rig = &campaign.rig;
    let gain = (!campaign.channels.is_empty()).then_some(rig.gain_uncertainty);
    [
        ("natural frequency $f_0$", rig.natural_frequency_hz, "Hz"),
        ("damping ratio $β$", rig.damping_ratio, ""),
        ("static deflection $x_st$", rig.static_deflection_m, "m"),
        ("restitution $R$", rig.restitution, ""),
        ("uncertainty of the gains", gain, ""),
    ]
    .into_iter()
    .filter_map(|(name, value, unit)| Some((name.to_owned(), value?, unit.to_owned())))
    .collect()
}

/// When it was measured: as campaign.toml says, else the days of the first and the last record,
/// where their files tell.
fn dates(campaign: &ResolvedCampaign) -> Option<[String; 2]> {
    if let Some(words) = &campaign.measured {
        return Some([words.clone(), words.clone()]);
    }
    let ends = [campaign.records.first(), campaign.records.last()];
    let ends = ends.into_iter().flatten();
    let mut days: Vec<String> = ends.filter_map(|r| day(&r.file, r.dataset?)).collect();
    days.sort();
    Some([days.first()?.clone(), days.last()?.clone()])
}

/// The day on which a dataset was acquired.
fn day(file: &Path, dataset: usize) -> Option<String> {
    let source = open(file).ok()?;
    let info = source.datasets().get(dataset)?;
    let time = info.channels.iter().find_map(|c| c.start_time.clone())?;
    let day = time.split(['T', ' ']).next()?;
    (!day.is_empty()).then(|| day.to_owned())
}
