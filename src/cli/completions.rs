//! `impactid completions` and `impactid man`.

use std::io::{self, Write};
use std::marker::PhantomData;
use std::path::PathBuf;

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::exit::Exit;
use super::failure::Failure;
use super::stdout::print;
use super::verbosity::Verbosity;
use labfiles_write::output;

/// Arguments of `impactid completions`, of the program whose command line is `P`.
#[derive(Debug, Args)]
#[command(after_help = COMPLETIONS)]
pub(super) struct Completions<P> {
    /// The shell
    shell: Shell,
    #[arg(skip)]
    program: PhantomData<P>,
}

const COMPLETIONS: &str = "\
Example:
  impactid completions bash > ~/.local/share/bash-completion/completions/impactid";

impl<P: CommandFactory> Completions<P> {
    pub(super) fn run(self, _verbosity: Verbosity) -> Result<Exit, Failure> {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut P::command(), "impactid", &mut text);
        print(&String::from_utf8_lossy(&text))?;
        Ok(Exit::Done)
    }
}

/// Arguments of `impactid man`, of the program whose command line is `P`.
#[derive(Debug, Args)]
#[command(after_help = MAN)]
pub(super) struct Man<P> {
    /// Folder for the pages; created if it does not exist
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    #[arg(skip)]
    program: PhantomData<P>,
}

const MAN: &str = "\
Example:
  impactid man --out ~/.local/share/man/man1";

impl<P: CommandFactory> Man<P> {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        output::make_folder(&self.out)?;
        let mut command = P::command();
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
            file.write_all(page(command, name)?.as_bytes())
        })?;
        *pages += 1;
        for below in command.get_subcommands().filter(|c| c.get_name() != "help") {
            self.write(below, &format!("{name}-{}", below.get_name()), pages)?;
        }
        Ok(())
    }
}

/// The manual page of a command; its help's examples are under a heading of their own.
fn page(command: &clap::Command, name: &str) -> io::Result<String> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command.clone())
        .title(name)
        .source(concat!("impactid ", env!("CARGO_PKG_VERSION")))
        .manual("User Commands")
        .render(&mut page)?;
    let text = String::from_utf8_lossy(&page).into_owned();
    let Some((before, extra)) = text.split_once("\n.SH EXTRA\n") else {
        return Ok(text);
    };
    let end = extra.find("\n.SH ").map_or(extra.len(), |at| at + 1);
    let (examples, after) = extra.split_at(end);
    Ok(format!("{before}\n.SH EXAMPLES\n{}{after}", set(examples)))
}

/// Lines of a help text for troff: those that are indented stay lines, each other one is a paragraph.
fn set(help: &str) -> String {
    let mut text = String::new();
    for lines in help.lines().collect::<Vec<_>>().chunk_by(|a, b| {
        let indented = |line: &str| line.starts_with(' ');
        indented(a) && indented(b)
    }) {
        let block = lines.join("\n");
        text += &match block.chars().next() {
            None => String::new(),
            Some(' ') => format!(".nf\n{block}\n.fi\n"),
            Some(_) => format!(".PP\n{block}\n"),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::Cli;

    #[test]
    fn a_page_has_its_name_and_its_examples_line_by_line() {
        let mut command = Cli::command();
        command.build();
        let run = command.find_subcommand("run").unwrap();
        let page = page(run, "impactid-run").unwrap();
        assert!(page.contains(".TH impactid-run 1"), "{page}");
        let (_, examples) = page.split_once("\n.SH EXAMPLES\n").unwrap();
        assert!(
            examples.starts_with(".PP\nExample:\n.nf\n  impactid run "),
            "{examples}"
        );
        assert!(examples.contains("\n.fi\n.PP\nOutputs: "), "{examples}");
        assert!(!page.contains(".SH EXTRA"));
    }
}
