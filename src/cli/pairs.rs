//! `impactid study pairs`: what the intervals of differences are worth, over pairs of synthetic campaigns.

use clap::Args;

use super::machine::at_least;
use super::stdout::{print, print_json};
use super::{Exit, Failure, Progress, Verbosity};
use impact_workbench::pairs::{self, Instruments, PairsPlan};
use simulated_rig::RigSpec;

/// Arguments of `impactid study pairs`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Pairs {
    /// Number of pairs
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = at_least::<1>)]
    pairs: usize,
    /// Records of each campaign
    #[arg(long, value_name = "N", default_value_t = 80, value_parser = at_least::<1>)]
    records: usize,
    /// Seed of everything random
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Rig that is simulated: exact, realistic, or EFFECT[=STRENGTH],… (see `simulate campaign`)
    #[arg(long, value_name = "RIG", default_value = "gaps,gap-offset")]
    rig: RigSpec,
    /// Noise of every channel, V, and a converter that rounds nothing [default: 1 to 8 mV, 12 bits]
    #[arg(long, value_name = "V")]
    noise_v: Option<f64>,
    /// Standard deviation of the channels' gain errors, relative [default: 0.005]
    #[arg(long, value_name = "SHARE")]
    gain_deviation: Option<f64>,
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

const EXAMPLE: &str = "\
Example:
  impactid study pairs --pairs 200
  impactid study pairs --pairs 200 --noise-v 1e-5 --gain-deviation 0.03    gains dominate
  impactid study pairs --pairs 50 --records 120 --rig realistic --json

Each pair is one rig with its own errors of gains, corners and gaps, measured twice and \
compared as `impactid compare` does; in every second pair R, f0, beta and x_st change between. \
`width ratio` is the width of the interval of the difference if nothing were shared over its \
width with sharing (median).";

impl Pairs {
    /// Simulate, identify, compare, count.
    ///
    /// # Errors
    /// [`Failure`] where a simulation refuses its parameters.
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let bar = Progress::new(verbosity, "pairs", self.pairs as u64);
        let plan = PairsPlan {
            pairs: self.pairs,
            records: self.records,
            seed: self.seed,
            rig: self.rig,
            instruments: Instruments {
                noise_v: self.noise_v,
                gain_deviation: self.gain_deviation,
            },
        };
        let found = pairs::study(&plan, &|_, done, total| bar.set(done, total))?;
        drop(bar);
        if self.json {
            print_json(&found)?;
        } else {
            print(&table(&found))?;
        }
        Ok(Exit::Done)
    }
}

fn table(found: &pairs::Pairs) -> String {
    let mut text = format!(
        "{:21} {:>5} {:>10} {:>10} {:>9} {:>11} {:>16}\n",
        "parameter",
        "pairs",
        "rms error",
        "half width",
        "coverage",
        "width ratio",
        "alone: coverage"
    );
    for (parameter, s) in &found.parameters {
        text += &format!(
            "{parameter:21} {:>5} {:>10.2e} {:>10.2e} {:>7.1} % {:>11.2} {:>14.1} %\n",
            s.pairs,
            s.rms_error,
            s.half_width,
            100.0 * s.coverage95,
            s.width_ratio,
            100.0 * s.independent_coverage95
        );
    }
    text += &format!(
        "changes reported where nothing changed: {} of {}\nchanges found: {} of {}\nnot comparable: {}\n",
        found.false_alarms.found,
        found.false_alarms.of,
        found.changes_found.found,
        found.changes_found.of,
        found.refused
    );
    text
}
