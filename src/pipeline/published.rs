//! A campaign of published speeds instead of records.

use std::path::Path;

use crate::campaign::resolved::ResolvedCampaign;
use crate::campaign::written::Published;
use crate::identify::published::{PublishedSpeed, identify, methods};
use crate::identify::{Identification, Verdict};
use crate::pipeline::identify::{settings, versions};
use crate::pipeline::{PipelineError, inputs, report, store};
use crate::report::ReportContent;

/// Identify from published speeds and write identification.json and report.pdf.
///
/// # Errors
/// Where the table cannot be read or an output cannot be written.
pub fn run(
    campaign: &ResolvedCampaign,
    published: &Published,
    out: &Path,
    command_line: &str,
) -> Result<Verdict, PipelineError> {
    let speeds = read(&campaign.folder().join(&published.speeds))?;
    let found = identify(&speeds, &published.damping_ratio_hypotheses);
    let (methods, agreement) = methods(&found);
    let identification = Identification {
        verdict: found.verdict.clone(),
        joint: found.result.clone(),
        methods,
        agreement,
        specimens: std::collections::BTreeMap::new(),
        settings: settings(campaign)?,
        versions: versions(),
        inputs_sha256: inputs::hashes(campaign),
    };
    let mut content = ReportContent::new(campaign.report.title.clone(), identification);
    content.summary.name = campaign.name.clone();
    content.summary.rig = "closing speeds as published; nothing was measured here".into();
    content.remarks = found.hypotheses;
    content.command_line = command_line.to_owned();
    let report = report::render(&content, campaign)?;
    store::write_resolved(campaign, out)?;
    super::identify::write(&content.identification, out)?;
    report::write(&report, out)?;
    Ok(found.verdict)
}

/// Read the table of speeds.
fn read(path: &Path) -> Result<Vec<PublishedSpeed>, PipelineError> {
    let wrong = |reason: String| PipelineError::Table {
        table: path.display().to_string(),
        reason,
    };
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|e| wrong(e.to_string()))?;
    let rows: Result<Vec<PublishedSpeed>, csv::Error> = reader.deserialize().collect();
    let rows = rows.map_err(|e| wrong(e.to_string()))?;
    if rows.is_empty() {
        return Err(wrong("it holds no speeds; write one row a speed".into()));
    }
    Ok(rows)
}
