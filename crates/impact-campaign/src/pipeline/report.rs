//! The report of a campaign.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::campaign::resolved::ResolvedCampaign;
use crate::campaign::sections::report::ReportSettings as StatedOptions;
use crate::pipeline::identify::{IdentificationFile, settings};
use crate::pipeline::observe::read_one;
use crate::pipeline::{Observed, PipelineError};
use impact_identification::identify::Provenance;
use impact_identification::identify::plan::Proposal;
use impact_identification::replay::{self, Input};
use impact_records::event::RigKind;
use impact_records::language::Language;
use impact_report::Phrase;
use impact_report::catalog::Catalog;
use impact_report::{
    CampaignFacts, Format, LivePage, Logo, NominalValue, Report, ReportContent, ReportOptions,
    Subject,
};
use labfiles_write::output::{WrittenBeside, write_together_or_beside};

/// Name of the report's file.
pub const FILE: &str = "report.pdf";

/// Name of the file beside the page that states which page was written last; it is there while a
/// campaign is watched.
pub(super) const LIVE_STATE: &str = "report.live.js";

/// The records are complete: no page is newer than the one there.
pub(super) fn remove_live_state(out: &Path) {
    // one that stays makes a page look in vain, no more
    let _ = std::fs::remove_file(out.join(LIVE_STATE));
}

/// A file of the report: its path relative to the results' folder, and its bytes.
pub type ReportFile = (String, Vec<u8>);

/// Make the report of what was observed and identified, in every format that the campaign asks
/// for, with the figures' data.
///
/// # Errors
/// If the template or the logo cannot be read, or the document cannot be set.
pub fn files(
    campaign: &ResolvedCampaign,
    observed: &Observed,
    found: &IdentificationFile,
    command_line: &str,
) -> Result<Vec<ReportFile>, PipelineError> {
    let content = content(campaign, observed, found, command_line)?;
    render(&content, campaign, None)
}

/// Draw a content as the campaign asks for it, and in one format more.
///
/// # Errors
/// If the template or the logo cannot be read, or the document cannot be set.
pub fn render(
    content: &ReportContent,
    campaign: &ResolvedCampaign,
    also: Option<Format>,
) -> Result<Vec<ReportFile>, PipelineError> {
    in_formats(&drawn(content, campaign)?, campaign, also)
}

/// A content as document and figures, still to be set.
///
/// # Errors
/// If the template or the logo cannot be read.
pub(super) fn drawn(
    content: &ReportContent,
    campaign: &ResolvedCampaign,
) -> Result<Report, PipelineError> {
    Ok(Report::new(content, &options(&campaign.report)?))
}

/// A report as the campaign asks for it, and in one format more.
///
/// # Errors
/// If the document cannot be set.
pub(super) fn in_formats(
    report: &Report,
    campaign: &ResolvedCampaign,
    also: Option<Format>,
) -> Result<Vec<ReportFile>, PipelineError> {
    let mut formats = campaign.report.formats.clone();
    formats.extend(also.filter(|f| !formats.contains(f)));
    Ok(report.all_files(&formats)?)
}

/// The page of a campaign whose records are still arriving.
///
/// # Errors
/// As [`render`].
pub(super) fn page(
    content: &ReportContent,
    campaign: &ResolvedCampaign,
    live: LivePage,
) -> Result<String, PipelineError> {
    let options = ReportOptions {
        live: Some(live),
        ..options(&campaign.report)?
    };
    Ok(Report::new(content, &options).html()?)
}

/// Write the report's files into the results' folder: all appear, or none. Gives those that are beside one of their name
/// that another program holds, as a viewer does on Windows.
///
/// # Errors
/// If one cannot be written.
pub fn write(files: &[ReportFile], out: &Path) -> Result<Vec<WrittenBeside>, PipelineError> {
    Ok(write_together_or_beside(out, files)?)
}

/// What the report shows, as plain data.
///
/// # Errors
/// If the settings cannot be written as text.
pub fn content(
    campaign: &ResolvedCampaign,
    observed: &Observed,
    found: &IdentificationFile,
    command_line: &str,
) -> Result<ReportContent, PipelineError> {
    content_with(campaign, observed, found, command_line, Vec::new())
}

/// What the report shows, with settings that are proposed on its map.
pub(super) fn content_with(
    campaign: &ResolvedCampaign,
    observed: &Observed,
    found: &IdentificationFile,
    command_line: &str,
    proposals: Vec<Proposal>,
) -> Result<ReportContent, PipelineError> {
    let turned = observed.observations.iter().enumerate();
    let turned = turned.map(|(i, o)| (i, o.setting.turned.clone()));
    let aligned = campaign.with_late(observed.late()).with_turned(turned);
    let read = |index: usize| {
        let entry = aligned.records.get(index)?;
        Some(read_one(&aligned, entry))
    };
    let compared = replay::replay(&Input {
        rig: campaign.about.machine,
        observations: &observed.observations,
        brackets: &observed.brackets,
        identification: &found.identification,
        points: &campaign.report.points,
        proposals: &proposals,
        read: &read,
    });
    let facts = facts(campaign);
    campaign.sources.release();
    Ok(ReportContent {
        title: campaign.report.title.clone(),
        campaign: facts,
        identification: found.identification.clone(),
        provenance: Provenance {
            settings: settings(campaign)?,
            ..found.provenance.clone()
        },
        compared,
        proposals,
        tables: Vec::new(),
        command_line: command_line.to_owned(),
        date: campaign.report.date.clone(),
    })
}

/// The phrases of the report: those of the stated table, else those of the language that come with
/// the program.
///
/// # Errors
/// If the table cannot be read, or is none.
pub fn catalog(stated: &StatedOptions) -> Result<Option<Catalog>, PipelineError> {
    let Some(path) = &stated.words else {
        let language = Language::of_code(&stated.language.0);
        let translated = language.filter(|l| *l != Language::default());
        return Ok(translated.map(Catalog::of));
    };
    let unusable = |reason: String| PipelineError::ReportFile {
        path: path.display().to_string(),
        reason,
    };
    let text = labfiles::read_text(path).map_err(|error| unusable(labfiles::said(&error)))?;
    let catalog = Catalog::read(&text).map_err(|error| unusable(error.to_string()))?;
    Ok(Some(catalog))
}

fn options(stated: &StatedOptions) -> Result<ReportOptions, PipelineError> {
    let unreadable = |path: &Path, error: std::io::Error| PipelineError::ReportFile {
        path: path.display().to_string(),
        reason: labfiles::said(&error),
    };
    let template =
        |path: &PathBuf| labfiles::read_text(path).map_err(|error| unreadable(path, error));
    let logo = |path: &PathBuf| {
        let bytes = std::fs::read(path).map_err(|error| unreadable(path, error))?;
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        Ok::<_, PipelineError>(Logo {
            bytes,
            extension: extension.to_lowercase(),
        })
    };
    Ok(ReportOptions {
        catalog: catalog(stated)?,
        paper: stated.paper,
        decimal_comma: stated.decimal_comma,
        language: stated.language.0.clone(),
        template: stated.template.as_ref().map(template).transpose()?,
        logo: stated.logo.as_ref().map(logo).transpose()?,
        live: None,
    })
}

/// What the campaign states about itself.
fn facts(campaign: &ResolvedCampaign) -> CampaignFacts {
    let files: BTreeSet<_> = campaign.records.iter().map(|r| &r.file).collect();
    CampaignFacts {
        name: campaign.about.name.clone(),
        subject: match campaign.about.machine {
            RigKind::Double => Subject::TwoMasses,
            RigKind::Single => Subject::OneMass,
        },
        stated: campaign.about.stated(),
        dates: dates(campaign),
        files: files.len(),
        rig: campaign.rig.name.clone(),
        shared: campaign.rig.shared.clone(),
        nominal: nominal(campaign),
        channels: campaign.channels.clone(),
        synthetic: campaign.about.synthetic,
    }
}

fn nominal(campaign: &ResolvedCampaign) -> Vec<NominalValue> {
    let rig = &campaign.rig;
    let gain = (!campaign.channels.is_empty()).then_some(rig.gain_uncertainty);
    let stated = [
        (
            Phrase::NaturalFrequencySymbol,
            rig.natural_frequency_hz,
            "Hz",
        ),
        (Phrase::DampingRatioSymbol, rig.damping_ratio, ""),
        (Phrase::StaticDeflectionSymbol, rig.static_deflection_m, "m"),
        (Phrase::Restitution, rig.restitution, ""),
        (Phrase::UncertaintyOfTheGains, gain, ""),
    ];
    let value = |(name, value, unit)| {
        let value: Option<f64> = value;
        value.map(|value| NominalValue { name, value, unit })
    };
    stated.into_iter().filter_map(value).collect()
}

/// When it was measured: as stated in campaign.toml, else the days of the first and the last record,
/// if their files state them.
fn dates(campaign: &ResolvedCampaign) -> Option<[String; 2]> {
    if let Some(words) = &campaign.about.measured {
        return Some([words.clone(), words.clone()]);
    }
    let ends = [campaign.records.first(), campaign.records.last()];
    let ends = ends.into_iter().flatten();
    let mut days: Vec<String> = ends
        .filter_map(|r| day(campaign, &r.file, r.dataset?))
        .collect();
    days.sort();
    Some([days.first()?.clone(), days.last()?.clone()])
}

/// The day on which a dataset was acquired.
fn day(campaign: &ResolvedCampaign, file: &Path, dataset: usize) -> Option<String> {
    let source = campaign.sources.open(file).ok()?;
    let info = source.datasets().get(dataset)?;
    let time = info.channels.iter().find_map(|c| c.start_time.clone())?;
    let day = time.split(['T', ' ']).next()?;
    (!day.is_empty()).then(|| day.to_owned())
}
