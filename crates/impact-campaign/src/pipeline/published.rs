//! A campaign of published speeds instead of records.

use std::path::Path;

use crate::campaign::resolved::ResolvedCampaign;
use crate::campaign::sections::published::Published;
use crate::pipeline::identify::{IdentificationFile, provenance};
use crate::pipeline::report::ReportFile;
use crate::pipeline::{PipelineError, report, store};
use impact_fit::methods::published::{PublishedSpeed, Where, predicted};
use impact_identification::identify::Identification;
use impact_identification::identify::published::identify;
use impact_identification::replay::Compared;
use impact_report::{CampaignFacts, DataTable, ReportContent, Subject};
use impact_report::{Phrase, Text};
use labfiles::ReadError;
use labfiles_write::output::WrittenBeside;

/// Identify from published speeds and write identification.json and report.pdf; with the parameters, the files of the report
/// that are beside one that another program holds.
///
/// # Errors
/// Where the table cannot be read or an output cannot be written.
pub fn run(
    campaign: &ResolvedCampaign,
    published: &Published,
    out: &Path,
    command_line: &str,
) -> Result<(Identification, Vec<WrittenBeside>), PipelineError> {
    let speeds = read(&campaign.folder().join(&published.speeds))?;
    let found = IdentificationFile {
        identification: identify(&speeds, &published.damping_ratio_hypotheses),
        provenance: provenance(campaign)?,
    };
    let content = content(campaign, published, &speeds, &found, command_line);
    let report = report::render(&content, campaign, None)?;
    store::write_resolved(campaign, out)?;
    super::identify::write(&found, out)?;
    let beside = report::write(&report, out)?;
    Ok((found.identification, beside))
}

/// What published speeds say.
///
/// # Errors
/// Where the table cannot be read.
pub fn identified(
    campaign: &ResolvedCampaign,
    published: &Published,
) -> Result<Identification, PipelineError> {
    let speeds = read(&campaign.folder().join(&published.speeds))?;
    Ok(identify(&speeds, &published.damping_ratio_hypotheses))
}

/// The files of a report of what was identified from published speeds.
///
/// # Errors
/// Where the table cannot be read, or the document cannot be set.
pub fn report_files(
    campaign: &ResolvedCampaign,
    published: &Published,
    found: &IdentificationFile,
    command_line: &str,
) -> Result<Vec<ReportFile>, PipelineError> {
    let speeds = read(&campaign.folder().join(&published.speeds))?;
    let content = content(campaign, published, &speeds, found, command_line);
    report::render(&content, campaign, None)
}

/// What the report shows.
fn content(
    campaign: &ResolvedCampaign,
    published: &Published,
    speeds: &[PublishedSpeed],
    found: &IdentificationFile,
    command_line: &str,
) -> ReportContent {
    let damping_ratio = found_damping(&found.identification);
    ReportContent {
        title: campaign.report.title.clone(),
        campaign: CampaignFacts {
            name: campaign.about.name.clone(),
            subject: Subject::PublishedSpeeds,
            ..CampaignFacts::default()
        },
        identification: found.identification.clone(),
        provenance: found.provenance.clone(),
        compared: Compared::default(),
        proposals: Vec::new(),
        tables: vec![table(speeds, damping_ratio, published)],
        command_line: command_line.to_owned(),
        date: campaign.report.date.clone(),
    }
}

fn found_damping(found: &Identification) -> Option<f64> {
    found.joint.parameters.damping_ratio.as_ref()?.value
}

/// Each published speed beside the model's for the damping ratio found and those printed.
fn table(speeds: &[PublishedSpeed], found: Option<f64>, published: &Published) -> DataTable {
    let printed = &published.damping_ratio_hypotheses;
    let dampings: Vec<f64> = found.into_iter().chain(printed.iter().copied()).collect();
    let symbols = ["$R$", "$ρ$", "$η$"].map(Text::from);
    let texts = symbols.into_iter().chain([Phrase::PublishedSpeed.into()]);
    let heads = dampings.iter().map(|b| Text::from(format!("$β$ = {b:.4}")));
    let row = |s: &PublishedSpeed| {
        let eta = match s.place {
            Where::At => s.frequency_ratio.to_string(),
            Where::Greatest => format!("greatest near {}", s.frequency_ratio),
        };
        let given = [
            s.restitution.to_string(),
            s.clearance_ratio.to_string(),
            eta,
        ];
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small whole number, not negative"
        )]
        let decimals = (-s.printed_step.log10().floor()).max(0.0) as usize;
        let model = dampings.iter().map(|b| match predicted(s, *b) {
            Some(speed) => format!("{speed:.0$}", decimals + 1),
            None => "no such motion".to_owned(),
        });
        let printed = format!("{:.decimals$}", s.closing_speed_ratio);
        given.into_iter().chain([printed]).chain(model).collect()
    };
    DataTable {
        caption: Phrase::TablePublished,
        heads: texts.chain(heads).collect(),
        rows: speeds.iter().map(row).collect(),
    }
}

/// Read the table of speeds.
fn read(path: &Path) -> Result<Vec<PublishedSpeed>, PipelineError> {
    let wrong = |found: String| {
        ReadError::new(
            path,
            "a CSV table of published speeds, one row a speed",
            found,
            "write its columns as docs/campaign.md lists them under [published]",
        )
    };
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|e| wrong(e.to_string()))?;
    let rows: Result<Vec<PublishedSpeed>, csv::Error> = reader.deserialize().collect();
    let rows = rows.map_err(|e| wrong(e.to_string()))?;
    if rows.is_empty() {
        return Err(wrong("no row".into()).into());
    }
    Ok(rows)
}
