//! `impactid run` with several campaigns: a folder for each, and their answers side by side.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::estimate_text::with_error;
use super::patterns::expanded;
use super::report_args::refuse_formats;
use super::run_one::RunOptions;
use super::{Exit, Failure, Verbosity, interrupt};
use impact_campaign::campaign::{
    self,
    diagnostic::{Diagnostic, Diagnostics},
};
use impact_campaign::pipeline::summary::{Fault, Found, RunOutcome, RunSummary, SummaryRow};
use impact_campaign::pipeline::{campaign_folders, layout, summary};
use impact_fit::VerdictKind;

/// The campaigns as typed, each once, patterns expanded.
///
/// # Errors
/// [`Failure`] where nothing matches a pattern, or one of several is no description of a campaign: then none is run.
pub(super) fn campaigns(typed: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let remedy = "name the campaign.toml of each campaign; `impactid init DIR` writes one";
    let mut all = expanded(typed, remedy)?;
    refuse_formats(&all)?;
    let mut seen = HashSet::new();
    all.retain(|path| seen.insert(path.canonicalize().unwrap_or_else(|_| path.clone())));
    if all.len() > 1 {
        let mistyped = all
            .iter()
            .flat_map(|path| campaign::not_a_description(path).0);
        let mistyped: Vec<Diagnostic> = mistyped.collect();
        if !mistyped.is_empty() {
            return Err(Diagnostics(mistyped).into());
        }
    }
    Ok(all)
}

/// Run every campaign into a folder of its own in `out`, and write the summary there.
///
/// # Errors
/// [`Failure`] where `out` holds a summary of another version or cannot be written into; a campaign
/// that fails is a row of the summary.
pub(super) fn run(
    campaigns: &[PathBuf],
    out: &Path,
    options: RunOptions<'_>,
    verbosity: Verbosity,
) -> Result<Exit, Failure> {
    let _lock = interrupt::lock(out)?;
    layout::check(out)?;
    let folders = campaign_folders::names(campaigns);
    let mut worst = Exit::Done;
    let mut rows = Vec::new();
    for (number, (campaign, folder)) in campaigns.iter().zip(folders).enumerate() {
        let count = campaigns.len();
        verbosity.info(&format!("[{}/{count}] {}", number + 1, campaign.display()));
        let (exit, outcome) = one(campaign, &out.join(&folder), options, verbosity);
        worst = worst.max(exit);
        rows.push(SummaryRow {
            campaign: campaign.display().to_string(),
            folder,
            exit_code: exit.code(),
            outcome,
        });
    }
    let summary = RunSummary::of(rows);
    summary.write(out)?;
    verbosity.info(&table(&summary));
    verbosity.info(&format!(
        "Summary: {} and {}",
        out.join(summary::CSV).display(),
        out.join(summary::JSON).display()
    ));
    Ok(worst)
}

/// Run one of them; what stops it is printed and noted.
fn one(
    campaign: &Path,
    folder: &Path,
    options: RunOptions<'_>,
    verbosity: Verbosity,
) -> (Exit, RunOutcome) {
    let checked = layout::check(folder).map_err(Failure::from);
    match checked.and_then(|()| options.run(campaign, folder, verbosity)) {
        Ok(done) => (
            Exit::of(done.identification.verdict.kind),
            RunOutcome::Result(Box::new(Found::of(&done))),
        ),
        Err(failure) => {
            interrupt::give_way();
            failure.print(verbosity);
            let problems = failure.problems().into_iter();
            let faults = problems.map(|(message, remedy)| Fault { message, remedy });
            (Exit::BadInput, RunOutcome::Errors(faults.collect()))
        }
    }
}

/// The summary as the terminal shows it.
fn table(summary: &RunSummary) -> String {
    let folders = summary.campaigns.iter().map(|r| r.folder.chars().count());
    let width = folders.max().unwrap_or(0).max("campaign".len());
    let mut text = format!(
        "\n{:<width$} {:>9} {:>23} {:>23} {:>23}  verdict\n",
        "campaign", "records", "R", "f0, Hz", "β"
    );
    for row in &summary.campaigns {
        let line = match &row.outcome {
            RunOutcome::Result(found) => found_line(found),
            RunOutcome::Errors(faults) => failed_line(faults),
        };
        text += &format!("{:<width$} {line}\n", row.folder);
    }
    text
}

fn found_line(found: &Found) -> String {
    let joint = &found.joint;
    let estimates = [
        &joint.restitution,
        &joint.natural_frequency_hz,
        &joint.damping_ratio,
    ];
    let cells = estimates.map(|e| format!("{:>23}", e.as_ref().map_or("–".into(), with_error)));
    let records = format!("{}/{}", found.usable_records, found.records);
    format!(
        "{records:>9} {}  {}",
        cells.join(" "),
        verdict(found.verdict)
    )
}

fn verdict(kind: VerdictKind) -> &'static str {
    match kind {
        VerdictKind::Identified => "identified",
        VerdictKind::Weak => "weak",
        VerdictKind::NotIdentifiable => "not identifiable",
        VerdictKind::DoesNotFit => "the model does not fit",
    }
}

fn failed_line(faults: &[Fault]) -> String {
    let first = faults.first().map_or("", |f| f.message.as_str());
    match faults.len() {
        0 | 1 => format!("failed: {first}"),
        n => format!("failed: {first} (and {} more)", n - 1),
    }
}
