//! `impactid study coverage`: what the intervals are worth, over many synthetic campaigns.

use std::path::PathBuf;

use clap::Args;

use super::machine::at_least;
use super::simulate::within;
use super::stdout::{print, print_json};
use super::{Exit, Failure, Progress, Verbosity};
use impact_identification::identify::uncertainty::coverage::Score;
use impact_workbench::coverage::{self, CoveragePlan, MotionTally, Tallies, Tally};
use labfiles_write::output::write_bytes;
use simulated_rig::RigSpec;

/// Arguments of `impactid study coverage`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Coverage {
    /// Number of campaigns
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = at_least::<1>)]
    campaigns: usize,
    /// Sweep past the end of z = 1 at several gaps in steps of this share of f0, for R from the measured
    /// boundaries [default: campaigns of every motion]
    #[arg(long, value_name = "SHARE", value_parser = within(1e-3, 0.2))]
    step: Option<f64>,
    /// Number of further campaigns for each mistake of the laboratory [default: a fifth of --campaigns; none with
    /// --step]
    #[arg(long, value_name = "N")]
    mistakes: Option<usize>,
    /// Seed of everything random
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Rig that is simulated: exact, realistic, or EFFECT[=STRENGTH],… (see `simulate campaign`)
    #[arg(long, value_name = "RIG", default_value = "exact")]
    rig: RigSpec,
    /// Write every estimate of every campaign beside its truth into a CSV file
    #[arg(long, value_name = "FILE")]
    estimates: Option<PathBuf>,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

const EXAMPLE: &str = "\
Example:
  impactid study coverage --campaigns 300 --seed 1 --json
  impactid study coverage --campaigns 100 --rig realistic
  impactid study coverage --campaigns 100 --rig friction=0.015,contact=0.3
  impactid study coverage --campaigns 60 --rig realistic --step 0.01

Each campaign has a truth, noise and faults of its own. Errors of R are absolute, those of the \
other parameters relative. `bound` is the Cramér–Rao bound: no unbiased estimator errs less.";

impl Coverage {
    /// Simulate, identify, count.
    ///
    /// # Errors
    /// [`Failure`] where a simulation refuses its parameters.
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let bar = Progress::new(verbosity, "campaigns", self.campaigns as u64);
        let few = match self.step {
            Some(_) => 0,
            None => self.campaigns.div_ceil(5),
        };
        let plan = CoveragePlan {
            campaigns: self.campaigns,
            mistakes: self.mistakes.unwrap_or(few),
            seed: self.seed,
            rig: self.rig,
            step: self.step,
        };
        let found = coverage::study(&plan, &|_, done, total| {
            bar.set(done, total);
        })?;
        drop(bar);
        if let Some(path) = &self.estimates {
            write_bytes(path, found.estimates.as_bytes())?;
        }
        if self.json {
            print_json(&found)?;
        } else {
            print(&table(&found))?;
        }
        Ok(Exit::Done)
    }
}

fn table(found: &coverage::Coverage) -> String {
    let mut text = format!(
        "{:17} {:21} {:>4} {:>7} {:>10} {:>10} {:>10} {:>9} {:>8} {:>10}\n",
        "method",
        "parameter",
        "n",
        "refused",
        "bias",
        "rms error",
        "bound",
        "rms/bound",
        "coverage",
        "half width"
    );
    for (method, parameters) in &found.methods {
        for (parameter, score) in parameters {
            text += &score_line(method.name(), parameter, score);
        }
    }
    text += &tally_line("R refused where nothing touches", found.nothing_touches);
    for (name, tally) in &found.mistakes {
        text += &tally_line(&format!("found: {}", name.replace('_', " ")), *tally);
    }
    text + &tallies(&found.tallies)
}

fn tallies(found: &Tallies) -> String {
    let mut text = tally_line("false alarms", found.false_alarms);
    text += &tally_line(
        "  of them a correct gap reported as wrong",
        found.gaps_accused,
    );
    text += &tally_line("methods do not agree", found.methods_disagree);
    for (kind, count) in &found.verdicts {
        text += &format!("verdict {}: {count}\n", kind.name().replace('_', " "));
    }
    for (effect, tally) in &found.named_effects {
        text += &tally_line(&format!("named: {}", effect.replace('_', " ")), *tally);
    }
    let MotionTally {
        periodic,
        right,
        undetermined,
        doubtful,
        wrong,
        not_periodic,
        called_periodic,
    } = found.motions;
    text += &format!(
        "motion types of {periodic} periodic records: {right} right, {undetermined} undetermined, \
         {doubtful} wrong with a confidence below 0.9, {wrong} with 0.9 or more; of {not_periodic} \
         others {called_periodic} called periodic with 0.9 or more\n"
    );
    text
}

fn score_line(method: &str, parameter: &str, s: &Score) -> String {
    format!(
        "{method:17} {parameter:21} {:>4} {:>7} {:>10.2e} {:>10.2e} {:>10.2e} {:>9.2} {:>6.1} % {:>10.2e}\n",
        s.estimates,
        s.refused,
        s.bias,
        s.rms_error,
        s.bound,
        s.rms_error_over_bound,
        100.0 * s.coverage95,
        s.median_half_width95
    )
}

fn tally_line(what: &str, tally: Tally) -> String {
    format!("{what}: {} of {}\n", tally.found, tally.of)
}
