//! `impactid selftest`: the paper's published numbers on the user's machine.

use clap::Args;

use super::stdout::{print, print_json};
use super::{Exit, Failure, Verbosity};
use impact_workbench::selftest::{Check, checks};

/// Arguments of `impactid selftest`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct SelfTest {
    /// Print JSON instead of a table
    #[arg(long)]
    json: bool,
}

const EXAMPLE: &str = "\
Example:
  impactid selftest

Exit codes: 0 all numbers are reproduced; 1 some are not.";

impl SelfTest {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        let all = checks().map_err(|e| {
            Failure::new(
                e.to_string(),
                "please report it with the version of the program",
            )
        })?;
        if self.json {
            print_json(&all)?;
        } else if !verbosity.is_quiet() {
            print(&table(&all))?;
        }
        let missed = all.iter().filter(|c| !c.agrees()).count();
        verbosity.info(&format!(
            "{} of {} published numbers are reproduced.",
            all.len() - missed,
            all.len()
        ));
        Ok(if missed == 0 {
            Exit::Done
        } else {
            Exit::AnswerIsNo
        })
    }
}

fn table(all: &[Check]) -> String {
    let mut text = format!(
        "{:44} {:>10} {:>11} {:>9}\n",
        "", "published", "computed", "allowed"
    );
    for check in all {
        let mark = if check.agrees() { "" } else { "  MISSED" };
        text += &format!(
            "{:44} {:>10} {:>11.5} {:>9.5}{mark}\n",
            check.what, check.published, check.computed, check.tolerance
        );
    }
    text
}
