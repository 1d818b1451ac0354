//! The command line: one file per command; the only module that prints or exits.

mod atlas;
mod atlas_part;
mod basins;
mod boundary;
mod check;
mod compare;
mod completions;
mod convert;
mod coverage;
mod cut;
mod details;
mod estimate_text;
mod exit;
mod explore;
mod failure;
mod init;
mod inspect;
mod interrupt;
mod left_out;
mod live_text;
mod load;
mod machine;
mod merge;
#[cfg(feature = "mpi")]
mod mpi;
mod out_folder;
mod outputs;
mod pairs;
mod patterns;
mod plan;
mod premises;
mod progress;
mod read_log;
mod report_args;
mod run;
mod run_one;
mod run_several;
mod screen;
mod selftest;
mod simulate;
mod sparkline;
mod speech;
mod stage;
mod stdout;
mod study;
mod sweep;
mod theory;
mod verbosity;
mod watch;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use clap::error::{ContextKind, ContextValue};
use clap::{Args, CommandFactory, Parser, Subcommand};

pub(crate) use exit::Exit;
pub(crate) use failure::Failure;
pub(crate) use progress::Progress;
pub(crate) use verbosity::Verbosity;

use impact_campaign::pipeline;

/// From a laboratory campaign on an impact oscillator to restitution, natural frequency,
/// damping and a comparison report.
#[derive(Debug, Parser)]
#[command(name = "impactid", version, about, max_term_width = 100, after_help = EXAMPLE)]
pub(crate) struct Cli {
    #[command(flatten)]
    common: Common,
    #[command(subcommand)]
    command: Command,
}

const EXAMPLE: &str = "\
Example:
  impactid init  records/             write records/campaign.toml to fill in
  impactid check records/campaign.toml
  impactid run   records/campaign.toml --out results/

Exit codes: 0 success; 1 the model does not fit or a parameter is not identifiable; 2 bad \
input or output; 130 interrupted.";

/// Heading of the options of every command.
const GENERAL: &str = "General";

/// Options of every command.
#[derive(Debug, Clone, Args)]
pub(crate) struct Common {
    /// Print errors only
    #[arg(long, short, global = true, help_heading = GENERAL)]
    quiet: bool,
    /// Print versions, files, stage times and how each fit ended; -vv also every record and the notes
    /// of the readers
    #[arg(
        long,
        short,
        global = true,
        help_heading = GENERAL,
        action = clap::ArgAction::Count,
        conflicts_with = "quiet"
    )]
    verbose: u8,
    /// Number of threads [default: all processors]
    #[arg(long, short = 'j', global = true, help_heading = GENERAL, value_name = "N", value_parser = machine::at_least::<1>)]
    threads: Option<usize>,
}

/// Defines the commands; each runs itself.
macro_rules! commands {
    ($($(#[$doc:meta])* $name:ident($command:ty),)*) => {
        #[derive(Debug, Subcommand)]
        enum Command {
            $($(#[$doc])* $name($command),)*
        }

        impl Command {
            fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
                match self {
                    $(Self::$name(command) => command.run(verbosity),)*
                }
            }
        }
    };
}

// in the order in which they are needed
commands! {
    /// Write a commented campaign.toml for the files in a folder
    Init(init::Init),
    /// Read all records and list every problem; change nothing
    Check(check::Check),
    /// Run all stages, from campaign.toml to identification.json and report.pdf
    Run(run::Run),
    /// Watch a campaign while its records arrive: the answer grows
    Watch(watch::Watch),
    /// Stage 1: read and calibrate the records
    Ingest(stage::Ingest),
    /// Stage 2: detect the impacts and classify the motion of each record
    Classify(stage::Classify),
    /// Stage 3: fit the parameters
    Identify(stage::Identify),
    /// Stage 4: write the report
    Report(stage::Report),
    /// Compare campaigns: before and after, or one rig a year
    Compare(compare::Compare),
    /// Propose the settings to measure next
    Plan(plan::Plan),
    /// Explore regions, motions and a campaign live in the browser
    Explore(explore::Explore),
    /// List the channels of record files: units, rates, ranges
    Inspect(inspect::Inspect),
    /// Convert record files to HDF5, Parquet, CSV or universal files
    Convert(convert::Convert),
    /// Compute regions and boundaries of all motions in the (η, ρ) plane
    Atlas(atlas::Atlas),
    /// Merge the parts of an atlas
    Merge(merge::Merge),
    /// Compute a single point of a boundary
    Boundary(boundary::Boundary),
    /// Sweep η or ρ in both directions (quasi-stationary)
    Sweep(sweep::Sweep),
    /// Compute basins of attraction in the plane of initial states
    Basins(basins::Basins),
    /// Run studies from TOML files (time series, sweeps, basins, maps, regions), or measure coverage
    Study(study::Study),
    /// Simulate a motion, or a campaign with known parameters
    Simulate(simulate::Simulate),
    /// Reproduce the paper's published numbers on this machine
    Selftest(selftest::SelfTest),
    /// Print shell completions
    Completions(completions::Completions<Cli>),
    /// Write manual pages
    Man(completions::Man<Cli>),
}

/// Run the program on the process's own arguments.
pub(crate) fn main() -> ExitCode {
    failure::hush_caught_panics();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(mut error) => {
            if let Some(command) = meant(&error) {
                let suggested = ContextValue::Strings(vec![command]);
                error.insert(ContextKind::SuggestedSubcommand, suggested);
            }
            let _ = error.print();
            return if error.use_stderr() {
                Exit::BadInput
            } else {
                Exit::Done
            }
            .into();
        }
    };
    let verbosity = Verbosity::new(cli.common.quiet, cli.common.verbose);
    if let Err(error) = start_threads(cli.common.threads) {
        verbosity.detail(&format!("the number of threads is unchanged: {error}"));
    }
    let begin = Instant::now();
    verbosity.detail(&versions());
    let exit = cli.command.run(verbosity).unwrap_or_else(|failure| {
        interrupt::give_way();
        failure.print(verbosity);
        Exit::BadInput
    });
    verbosity.detail(&format!("total: {:.2} s", begin.elapsed().as_secs_f64()));
    exit.into()
}

/// The command that was probably meant by one that does not exist, and that clap does not name itself: one of the
/// program, or one below the command that was typed first.
fn meant(error: &clap::Error) -> Option<String> {
    let typed = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(typed)) => typed.clone(),
        _ => return below(std::env::args().skip(1)),
    };
    if error.get(ContextKind::SuggestedSubcommand).is_some() {
        return None;
    }
    nearest_of(&Cli::command(), &typed)
}

/// The command below another that was probably meant: `study coverag` is read as a file otherwise.
fn below(mut typed: impl Iterator<Item = String>) -> Option<String> {
    let (command, verb) = (typed.next()?, typed.next()?);
    let program = Cli::command();
    let command = program.find_subcommand(command)?;
    let is_file = verb.starts_with('-') || Path::new(&verb).exists();
    let is_one = command.find_subcommand(&verb).is_some();
    if is_file || is_one {
        return None;
    }
    nearest_of(command, &verb)
}

fn nearest_of(command: &clap::Command, typed: &str) -> Option<String> {
    let names: Vec<&str> = command
        .get_subcommands()
        .map(clap::Command::get_name)
        .collect();
    impact_campaign::campaign::nearest(typed, &names).map(str::to_owned)
}

/// Starts the threads that all work is shared among: as many as stated, else one for each core.
fn start_threads(stated: Option<usize>) -> Result<(), rayon::ThreadPoolBuildError> {
    /// As much as a main thread has: nested templates take it.
    const STACK_BYTES: usize = 8 << 20;
    let pool = rayon::ThreadPoolBuilder::new().stack_size(STACK_BYTES);
    // 0: one for each core
    pool.num_threads(stated.unwrap_or(0)).build_global()
}

/// Versions of the program and of the layouts that it writes.
fn versions() -> String {
    let versions = pipeline::identify::versions();
    let named: Vec<String> = versions.iter().map(|(n, v)| format!("{n} {v}")).collect();
    format!("versions: {}", named.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_that_was_mistyped_is_named() {
        for (typed, command) in [("rnu", "run"), ("inpsect", "inspect"), ("chekc", "check")] {
            let error = Cli::try_parse_from(["impactid", typed]).unwrap_err();
            let told =
                error.to_string().contains(command) || meant(&error).as_deref() == Some(command);
            assert!(told, "{error}");
        }
        let error = Cli::try_parse_from(["impactid", "xyzzy"]).unwrap_err();
        assert_eq!(meant(&error), None);
        let below = |typed: &[&str]| below(typed.iter().map(|&word| word.to_owned()));
        assert_eq!(below(&["study", "coverag"]).as_deref(), Some("coverage"));
        for typed in [
            &["study", "pairs"][..],
            &["study", "."],
            &["run", "pairs"],
            &["study"],
        ] {
            assert_eq!(below(typed), None, "{typed:?}");
        }
    }

    #[test]
    fn the_command_line_is_consistent_and_every_command_shows_an_example() {
        let command = Cli::command();
        command.clone().debug_assert();
        for sub in command.get_subcommands() {
            let help = sub
                .get_after_help()
                .map(ToString::to_string)
                .unwrap_or_default();
            assert!(
                help.contains("Example:"),
                "{} shows no example",
                sub.get_name()
            );
            assert!(
                sub.get_about().is_some(),
                "{} has no description",
                sub.get_name()
            );
        }
    }
}
