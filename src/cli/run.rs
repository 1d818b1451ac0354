//! `impactid run`: all stages, from campaign.toml to the report, of one campaign or of several.

use std::path::PathBuf;

use clap::Args;

use super::report_args::ReportArgs;
use super::run_one::RunOptions;
use super::stdout::print_json_file;
use super::{Exit, Failure, Verbosity, run_several};
use impact_campaign::pipeline::{identify, summary};

/// Arguments of `impactid run`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Run {
    /// The campaign's description; several are run one after the other
    #[arg(value_name = "CAMPAIGN.TOML", required = true)]
    campaigns: Vec<PathBuf>,
    /// Folder for the results; created if it does not exist. Of several campaigns each has a folder in it
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Resume an interrupted run in DIR (from 2,000 records on; a shorter one starts again)
    #[arg(long)]
    resume: bool,
    /// Print identification.json too; of several campaigns summary.json
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    options: ReportArgs,
}

const EXAMPLE: &str = "\
Example:
  impactid run data-samples/double-oscillator/campaign.toml --out results/
  impactid run campaign.toml --out results/ --format pdf,html,svg,png --paper letter
  impactid run */campaign.toml --out results/

Outputs: report.pdf (report.html, tables/ if the formats include them), the data of the \
figures in figures/, identification.json, uncertainty_budget.csv, records.parquet, \
impacts.parquet, boundaries.csv, campaign.resolved.json. Outputs are written atomically.
Several campaigns: each has the folder in DIR that is named after its own, as if it had been \
run alone with that folder as --out; summary.csv and summary.json in DIR list the answers. One \
that fails does not stop the others; where a path is no description of a campaign, none is run.
Exit codes: 0 success (also with a parameter that is only weak); 1 the model does not fit or a \
parameter is not identifiable; 2 bad input or output; 130 interrupted; of several campaigns \
the greatest.";

impl Run {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let options = RunOptions {
            resume: self.resume,
            report: &self.options,
        };
        let campaigns = run_several::campaigns(&self.campaigns)?;
        let (exit, file) = match &campaigns[..] {
            [alone] => {
                let done = options.run(alone, &self.out, verbosity)?;
                (Exit::of(done.identification.verdict.kind), identify::FILE)
            }
            several => {
                let exit = run_several::run(several, &self.out, options, verbosity)?;
                (exit, summary::JSON)
            }
        };
        if self.json {
            print_json_file(&self.out.join(file))?;
        }
        Ok(exit)
    }
}
