//! `impactid run`: all stages, from campaign.toml to the report.

use std::path::PathBuf;

use clap::Args;

use super::details::{print_fits, print_records};
use super::load::load_campaign;
use super::progress::{LATER, Progress};
use super::report_args::{ReportArgs, print_report_paths, quoted};
use super::{Exit, Failure, Verbosity, interrupt};
use crate::pipeline::{self, Destination, checkpoint};
use labfiles::output::Lock;

/// Arguments of `impactid run`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Run {
    /// The campaign's description
    #[arg(value_name = "CAMPAIGN.TOML")]
    campaign: PathBuf,
    /// Folder for the results; created if it does not exist
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Resume an interrupted run in DIR
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    options: ReportArgs,
}

const EXAMPLE: &str = "\
Example:
  impactid run data-samples/double-oscillator/campaign.toml --out results/
  impactid run campaign.toml --out results/ --format pdf,html,svg,png --paper letter

Outputs: report.pdf, the data of the figures in figures/, identification.json, records.parquet, impacts.parquet, boundaries.csv.
Outputs are written atomically.
Exit codes: 0 success; 1 the model does not fit or a parameter is not identifiable; 2 bad input.";

/// From how many records on checkpoints are written; `IMPACTID_KEEP_FROM` sets another number, for
/// trials with small campaigns.
fn keep_from() -> usize {
    let set = std::env::var("IMPACTID_KEEP_FROM").ok();
    set.and_then(|n| n.parse().ok())
        .unwrap_or(checkpoint::FEWEST)
}

impl Run {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let mut campaign = load_campaign(&self.campaign, verbosity)?;
        self.options.apply(&mut campaign.report, verbosity)?;
        let _lock = Lock::take(&self.out)?;
        interrupt::watch(self.out.clone());
        let records = campaign.records.len() as u64;
        let bar = Progress::new(verbosity, "observe", records).with_later(LATER);
        let progress = |stage: &'static str, done: u64, total: u64| {
            bar.stage(stage);
            bar.set(done, total);
        };
        let command = format!(
            "impactid run {} --out {}{}",
            quoted(&self.campaign),
            quoted(&self.out),
            self.options.typed()
        );
        let destination = Destination {
            out: &self.out,
            resume: self.resume,
            keep_from: keep_from(),
            command_line: &command,
            fits: bar.fits(),
        };
        let done = pipeline::run(&campaign, &destination, &progress)?;
        drop(bar);
        print_records(&done.observations, verbosity);
        print_fits(&done.identification, verbosity);
        let verdict = &done.identification.verdict;
        verbosity.info(&verdict.to_string());
        for finding in &verdict.findings {
            verbosity.info(&format!("  - {finding}"));
        }
        print_report_paths(&campaign, &self.out, verbosity);
        Ok(Exit::of(verdict.kind))
    }
}
