//! `impactid completions` and `impactid man`.

use std::path::PathBuf;

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::stdout::print;
use super::{Cli, Exit, Failure, Verbosity};
use labfiles::output;

/// Arguments of `impactid completions`.
#[derive(Debug, Args)]
#[command(after_help = COMPLETIONS)]
pub(super) struct Completions {
    /// The shell
    shell: Shell,
}

const COMPLETIONS: &str = "\
Example:
  impactid completions bash > ~/.local/share/bash-completion/completions/impactid";

impl Completions {
    pub(super) fn run(self, _verbosity: Verbosity) -> Result<Exit, Failure> {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "impactid", &mut text);
        print(&String::from_utf8_lossy(&text))?;
        Ok(Exit::Done)
    }
}

/// Arguments of `impactid man`.
#[derive(Debug, Args)]
#[command(after_help = MAN)]
pub(super) struct Man {
    /// Folder for the pages; created if it does not exist
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
}

const MAN: &str = "\
Example:
  impactid man --out ~/.local/share/man/man1";

impl Man {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        output::make_folder(&self.out)?;
        let mut command = Cli::command();
        command.build();
        let mut pages = 0;
        self.write(&command, "impactid", &mut pages)?;
        verbosity.info(&format!("{pages} pages in {}", self.out.display()));
        Ok(Exit::Done)
    }

    /// Write the page of a command and of all below it.
    fn write(&self, command: &clap::Command, name: &str, pages: &mut usize) -> Result<(), Failure> {
        let path = self.out.join(format!("{name}.1"));
        output::write_whole(&path, |file| {
            clap_mangen::Man::new(command.clone()).render(file)
        })?;
        *pages += 1;
        for below in command.get_subcommands().filter(|c| c.get_name() != "help") {
            self.write(below, &format!("{name}-{}", below.get_name()), pages)?;
        }
        Ok(())
    }
}
