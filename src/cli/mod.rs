//! The command line: one file per verb; the only room that prints or exits.

mod atlas;
mod basins;
mod boundary;
mod check;
mod completions;
mod convert;
mod coverage;
mod exit;
mod fail;
mod init;
mod inspect;
mod interrupt;
mod look;
mod machine;
mod merge;
mod plan;
mod progress;
#[cfg(feature = "mpi")]
mod ranks;
mod run;
mod selftest;
mod simulate;
mod sketch;
mod stage;
mod study;
mod sweep;
mod theory;
mod voice;

use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

pub use exit::Exit;
pub use fail::Failure;
pub use progress::Progress;
pub use voice::Voice;

/// From a laboratory campaign on an impact oscillator to restitution, natural frequency,
/// damping and a comparison report.
#[derive(Debug, Parser)]
#[command(name = "impactid", version, about, max_term_width = 100, after_help = EXAMPLE)]
pub struct Cli {
    #[command(flatten)]
    common: Common,
    #[command(subcommand)]
    verb: Verb,
}

const EXAMPLE: &str = "\
Example:
  impactid init  records/             write records/campaign.toml to fill in
  impactid check records/campaign.toml
  impactid run   records/campaign.toml --out results/

Exit codes: 0 done; 1 done, but the answer is \"does not fit\" or \"not identifiable\";
2 bad input.";

/// What every verb takes.
#[derive(Debug, Clone, Args)]
pub struct Common {
    /// Say nothing but errors
    #[arg(long, short, global = true)]
    quiet: bool,
    /// Say more; twice for everything
    #[arg(long, short, global = true, action = clap::ArgAction::Count, conflicts_with = "quiet")]
    verbose: u8,
    /// Number of threads; all processors where it is not given
    #[arg(long, short = 'j', global = true, value_name = "N")]
    threads: Option<std::num::NonZeroUsize>,
}

/// The verbs, in the order in which they are needed.
#[derive(Debug, Subcommand)]
enum Verb {
    /// Look at the files in a folder and write a commented campaign.toml to fill in
    Init(init::Init),
    /// Read everything, list every fault at once, change nothing
    Check(check::Check),
    /// All stages: from campaign.toml to identification.json and report.pdf
    Run(run::Run),
    /// First stage: read the records and keep them calibrated
    Ingest(stage::Ingest),
    /// Second stage: measure the drive, find the impacts, tell the motion of each record
    Classify(stage::Classify),
    /// Third stage: fit the parameters
    Identify(stage::Identify),
    /// Fourth stage: write the report
    Report(stage::Report),
    /// Propose the settings to measure next
    Plan(plan::Plan),
    /// What record files hold: channels, units, rates, ranges
    Inspect(inspect::Inspect),
    /// Write records of any format as HDF5, Parquet or CSV
    Convert(convert::Convert),
    /// Regions and boundaries of all motions in the (η, ρ) plane
    Atlas(atlas::Atlas),
    /// Put the parts of an atlas together
    Merge(merge::Merge),
    /// A single point of a boundary
    Boundary(boundary::Boundary),
    /// Quasi-stationary characteristics over η or ρ, there and back
    Sweep(sweep::Sweep),
    /// Basins of attraction in the plane of the starts
    Basins(basins::Basins),
    /// Studies of the theory from TOML files: time series, sweeps, basins, regions
    Study(study::Study),
    /// Simulate a motion, or a campaign with known truth
    Simulate(simulate::Simulate),
    /// Compute the paper's published numbers on this machine
    Selftest(selftest::SelfTest),
    /// Print the completions of a shell
    Completions(completions::Completions),
    /// Write the manual's pages
    Man(completions::Man),
}

impl Verb {
    fn go(self, voice: Voice) -> Result<Exit, Failure> {
        match self {
            Self::Init(verb) => verb.go(voice),
            Self::Check(verb) => verb.go(voice),
            Self::Run(verb) => verb.go(voice),
            Self::Ingest(verb) => verb.go(voice),
            Self::Classify(verb) => verb.go(voice),
            Self::Identify(verb) => verb.go(voice),
            Self::Report(verb) => verb.go(voice),
            Self::Plan(verb) => verb.go(voice),
            Self::Inspect(verb) => verb.go(voice),
            Self::Convert(verb) => verb.go(voice),
            Self::Atlas(verb) => verb.go(voice),
            Self::Merge(verb) => verb.go(voice),
            Self::Boundary(verb) => verb.go(voice),
            Self::Sweep(verb) => verb.go(voice),
            Self::Basins(verb) => verb.go(voice),
            Self::Study(verb) => verb.go(voice),
            Self::Simulate(verb) => verb.go(voice),
            Self::Selftest(verb) => verb.go(voice),
            Self::Completions(verb) => verb.go(voice),
            Self::Man(verb) => verb.go(voice),
        }
    }
}

/// Run the program on the process's own arguments.
pub fn main() -> ExitCode {
    fail::hush_caught_panics();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print();
            return if error.use_stderr() {
                Exit::BadInput
            } else {
                Exit::Done
            }
            .into();
        }
    };
    let voice = Voice::new(cli.common.quiet, cli.common.verbose);
    if let Some(threads) = cli.common.threads {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.get())
            .build_global();
        if let Err(error) = pool {
            voice.detail(&format!("the number of threads stays as it is: {error}"));
        }
    }
    match cli.verb.go(voice) {
        Ok(exit) => exit.into(),
        Err(failure) => {
            interrupt::give_way();
            failure.print();
            Exit::BadInput.into()
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn valid_the_command_line_is_consistent_and_every_verb_shows_an_example() {
        let command = Cli::command();
        command.clone().debug_assert();
        for verb in command.get_subcommands() {
            let help = verb
                .get_after_help()
                .map(ToString::to_string)
                .unwrap_or_default();
            assert!(
                help.contains("Example:"),
                "{} shows no example",
                verb.get_name()
            );
            assert!(
                verb.get_about().is_some(),
                "{} says nothing",
                verb.get_name()
            );
        }
    }
}
