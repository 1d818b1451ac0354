//! `impactid run` with several campaigns: a folder for each, and their answers side by side.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::estimate_text::with_error;
use super::out_folder::Work;
use super::patterns::expanded;
use super::report_args::refuse_formats;
use super::run_one::RunOptions;
use super::speech::Speech;
use super::{Exit, Failure, Verbosity, interrupt, out_folder};
use impact_campaign::campaign::sections::report::ReportSettings;
use impact_campaign::campaign::{
    self,
    diagnostic::{Diagnostic, Diagnostics},
};
use impact_campaign::pipeline::summary::{Fault, Found, RunOutcome, RunSummary, SummaryRow};
use impact_campaign::pipeline::{campaign_folders, layout, store, summary};
use impact_fit::VerdictKind;
use impact_records::message::{Print, Value};
use impact_records::message_table;

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
    let _lock = out_folder::take(out, Work::Comparison)?;
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
    let speech = speech(&summary, out);
    let words = speech.words();
    verbosity.info(&table(&summary, words.as_ref()));
    let [csv, json] =
        [summary::CSV, summary::JSON].map(|name| out.join(name).display().to_string());
    verbosity.info(&words.print(&TableText::Written { csv, json }));
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

/// What the table says.
#[derive(Debug, Clone, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
enum TableText {
    /// Head of the column of campaigns.
    Campaign,
    /// Head of the column of records.
    Records,
    /// Head of the column of verdicts.
    Verdict,
    IsIdentified,
    IsWeak,
    IsNotIdentifiable,
    IsUnfit,
    /// Why a campaign failed.
    Failed {
        fault: String,
    },
    /// Why one failed, and how many faults it has beside.
    FailedAndMore {
        fault: String,
        more: usize,
    },
    /// The files with the summary.
    Written {
        csv: String,
        json: String,
    },
}

message_table! { "several_campaigns": TableText;
    Self::Failed { fault } => fault = Value::Name(fault);
    Self::FailedAndMore { fault, more } => fault = Value::Name(fault), count = Value::Count(*more);
    Self::Written { csv, json } => csv = Value::Name(csv), json = Value::Name(json);
}

/// The language of the reports, if all campaigns that have one have the same; else English.
fn speech(summary: &RunSummary, out: &Path) -> Speech {
    let folders = summary.campaigns.iter().map(|row| out.join(&row.folder));
    let reports = folders.filter_map(|folder| Some(store::read_resolved(&folder).ok()?.report));
    let reports: Vec<ReportSettings> = reports.collect();
    let first = reports.first().filter(|first| {
        let mut others = reports.iter();
        others.all(|r| r.language == first.language && r.words == first.words)
    });
    let speech = first.map(Speech::of).and_then(Result::ok);
    speech.unwrap_or_default()
}

/// The summary as the terminal shows it.
fn table(summary: &RunSummary, words: &dyn Print) -> String {
    let heads = [TableText::Campaign, TableText::Records, TableText::Verdict];
    let [campaign, records, verdict] = heads.map(|head| words.print(&head));
    let folders = summary.campaigns.iter().map(|r| r.folder.chars().count());
    let width = folders.max().unwrap_or(0).max(campaign.chars().count());
    let records_width = RECORDS_WIDTH.max(records.chars().count());
    let mut text = format!(
        "\n{campaign:<width$} {records:>records_width$} {:>23} {:>23} {:>23}  {verdict}\n",
        "R", "f0, Hz", "β"
    );
    for row in &summary.campaigns {
        let line = match &row.outcome {
            RunOutcome::Result(found) => found_line(found, records_width, words),
            RunOutcome::Errors(faults) => failed_line(faults, words),
        };
        text += &format!("{:<width$} {line}\n", row.folder);
    }
    text
}

/// Width of the column of records in the narrowest table.
const RECORDS_WIDTH: usize = 9;

fn found_line(found: &Found, records_width: usize, words: &dyn Print) -> String {
    let joint = &found.joint;
    let estimates = [
        &joint.restitution,
        &joint.natural_frequency_hz,
        &joint.damping_ratio,
    ];
    let cells = estimates.map(|e| {
        let cell = e.as_ref().map(|e| with_error(e, words));
        format!("{:>23}", cell.unwrap_or_else(|| "–".into()))
    });
    let records = format!("{}/{}", found.usable_records, found.records);
    format!(
        "{records:>records_width$} {}  {}",
        cells.join(" "),
        words.print(&verdict(found.verdict))
    )
}

fn verdict(kind: VerdictKind) -> TableText {
    match kind {
        VerdictKind::Identified => TableText::IsIdentified,
        VerdictKind::Weak => TableText::IsWeak,
        VerdictKind::NotIdentifiable => TableText::IsNotIdentifiable,
        VerdictKind::DoesNotFit => TableText::IsUnfit,
    }
}

fn failed_line(faults: &[Fault], words: &dyn Print) -> String {
    let fault = faults.first().map_or(String::new(), |f| f.message.clone());
    words.print(&match faults.len() {
        0 | 1 => TableText::Failed { fault },
        n => TableText::FailedAndMore { fault, more: n - 1 },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::message::{boxed, faults};

    #[test]
    fn the_table_has_its_texts() {
        let all = boxed(<TableText as strum::IntoEnumIterator>::iter());
        assert_eq!(faults(&all.collect::<Vec<_>>()), Vec::<String>::new());
    }
}
