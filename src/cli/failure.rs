//! Errors as the user sees them: where, what, and what to do.

use std::path::Path;

use clap::builder::styling::{AnsiColor, Style};

use super::Verbosity;
use super::outputs::Output;
use impact_campaign::campaign::diagnostic::{Code, Diagnostic, Diagnostics, Place, Severity};
use impact_campaign::pipeline::{PipelineError, RefusedRecord};
use impact_records::message::{Print, Typed};
use labfiles::ReadError;
use labfiles::panic_is_caught;
use labfiles_write::output::OutputError;

/// Print no text for a panic of a library that a reader turns into an error: the error is printed.
pub(super) fn hush_caught_panics() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !panic_is_caught() {
            print(panic);
        }
    }));
}

/// Why a command could not do its work.
#[derive(Debug)]
pub(crate) enum Failure {
    /// What is wrong with the campaign.
    Campaign(Diagnostics),
    /// Anything else.
    Other {
        /// What happened.
        message: String,
        /// What the user can do.
        remedy: String,
    },
}

impl Failure {
    /// One error with its remedy.
    pub(crate) fn new(message: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Other {
            message: message.into(),
            remedy: remedy.into(),
        }
    }

    /// All messages in one line.
    #[cfg(feature = "mpi")]
    pub(super) fn text(&self) -> String {
        match self {
            Self::Campaign(all) => {
                let messages: Vec<&str> = all.0.iter().map(|d| d.message.as_str()).collect();
                messages.join("; ")
            }
            Self::Other { message, .. } => message.clone(),
        }
    }

    /// Every problem that stops the command: its message, with the place, and its remedy.
    pub(super) fn problems(&self) -> Vec<(String, String)> {
        match self {
            Self::Campaign(all) => {
                let gravest = all.0.iter().map(|d| d.severity).max();
                let stopping = all.0.iter().filter(|d| Some(d.severity) == gravest);
                let each =
                    |d: &Diagnostic| (format!("{}: {}", d.place, d.message), d.remedy.clone());
                stopping.map(each).collect()
            }
            Self::Other { message, remedy } => vec![(message.clone(), remedy.clone())],
        }
    }

    /// A file that could not be read or written.
    pub(crate) fn io(path: &Path, error: &std::io::Error) -> Self {
        Self::new(
            format!("{}: {}", path.display(), labfiles::said(error)),
            "check path and permissions",
        )
    }

    /// Print it on the standard error stream.
    pub(super) fn print(&self, verbosity: Verbosity) {
        match self {
            Self::Campaign(all) => print_diagnostics(all, &Typed, verbosity),
            Self::Other { message, remedy } => {
                let label = Typed.print(&Output::Help);
                eprint!("{}", rendered(message, remedy, &label, Severity::Campaign));
            }
        }
    }
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Campaign(diagnostics)
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Self::new(error.to_string(), error.remedy())
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        Self::new(error.fault(), error.remedy)
    }
}

impl From<PipelineError> for Failure {
    fn from(error: PipelineError) -> Self {
        match error {
            PipelineError::Read(error) => Self::from(error),
            PipelineError::NothingUsable(records) => Self::Campaign(nothing_usable(&records)),
            error => Self::new(error.to_string(), error.remedy()),
        }
    }
}

/// That no record can be used, and why each of them cannot.
fn nothing_usable(records: &[RefusedRecord]) -> Diagnostics {
    let error = PipelineError::NothingUsable(records.to_vec());
    let place = Place {
        item: "records".to_owned(),
        ..Place::default()
    };
    let kind = (Code::Missing, Severity::Campaign);
    let whole = Diagnostic::new(kind, place, error.to_string(), &error.remedy());
    let flags = records.iter().flat_map(|r| {
        let excluding = r.flags.iter().filter(|f| f.excludes);
        excluding.map(|f| Diagnostic::of_flag(&r.file, &r.record, f))
    });
    let mut all = Diagnostics(std::iter::once(whole).chain(flags).collect());
    all.sort();
    all
}

/// Problems that are alike are printed as one from this many on.
const MANY: usize = 3;

/// Print problems on the standard error stream in the words of a language, those alike as one unless details are asked for;
/// with `--quiet` no notes.
pub(super) fn print_diagnostics(all: &Diagnostics, words: &dyn Print, verbosity: Verbosity) {
    let all = all.said(words);
    let mut shortened = false;
    for group in all.groups() {
        let members = group.0.as_slice();
        let note = members.iter().all(|d| d.severity == Severity::Note);
        if note && verbosity.is_quiet() {
            continue;
        }
        match group.summary(words) {
            Some(summary) if members.len() >= MANY && !verbosity.is_detailed() => {
                shortened = true;
                print_one(&summary, words);
            }
            _ => members.iter().for_each(|one| print_one(one, words)),
        }
    }
    if shortened {
        verbosity.info(&words.print(&Output::SeeEach));
    }
}

fn print_one(one: &Diagnostic, words: &dyn Print) {
    let label = words.print(&Output::Help);
    let text = rendered(&one.headline(), &one.remedy, &label, one.severity);
    eprint!("{text}");
}

/// A problem with a sign of how grave it is and, below it, the remedy with its label.
fn rendered(message: &str, remedy: &str, label: &str, severity: Severity) -> String {
    let (sign, colour) = match severity {
        Severity::Campaign => ("×", AnsiColor::Red),
        Severity::Record => ("⚠", AnsiColor::Yellow),
        Severity::Note => ("☞", AnsiColor::Cyan),
    };
    let style = |colour: AnsiColor| {
        if coloured() {
            colour.on_default()
        } else {
            Style::new()
        }
    };
    let (of_sign, of_label) = (style(colour), style(AnsiColor::Cyan));
    let message = indented(
        message,
        &format!("  {of_sign}{sign}{of_sign:#} "),
        &format!("  {of_sign}│{of_sign:#} "),
        width(),
    );
    let start = format!("  {label}: ");
    let below = " ".repeat(start.chars().count());
    let remedy = indented(
        remedy,
        &format!("{of_label}{start}{of_label:#}"),
        &below,
        width(),
    );
    format!("{message}\n{remedy}\n")
}

/// Whether the standard error stream is a terminal that wants colours.
fn coloured() -> bool {
    use std::io::IsTerminal;
    let plain = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
    std::io::stderr().is_terminal() && !plain
}

/// Columns of the terminal, as it states them.
fn columns() -> Option<usize> {
    let size = terminal_size::terminal_size_of(std::io::stderr());
    size.map(|(width, _)| usize::from(width.0).max(20))
}

/// A sentence for people: broken between words on a terminal, further lines indented as the first is.
pub(super) fn wrapped(text: &str) -> String {
    broken(text, width())
}

fn broken(text: &str, width: usize) -> String {
    let words = text.trim_start();
    let indent = &text[..text.len() - words.len()];
    indented(words, indent, indent, width)
}

/// Words after what their first line and all others start with, broken at a width.
fn indented(words: &str, first: &str, others: &str, width: usize) -> String {
    let options = textwrap::Options::new(width)
        .initial_indent(first)
        .subsequent_indent(others)
        .break_words(false)
        .word_separator(textwrap::WordSeparator::AsciiSpace)
        .word_splitter(textwrap::WordSplitter::NoHyphenation)
        .wrap_algorithm(textwrap::WrapAlgorithm::FirstFit);
    textwrap::fill(words, options)
}

/// Width of lines: broken on a terminal, whole elsewhere, so that programs find their words.
fn width() -> usize {
    use std::io::IsTerminal;
    if std::io::stderr().is_terminal() {
        columns().unwrap_or(96)
    } else {
        4096
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_label_of_a_remedy_is_in_the_language_of_what_is_said() {
        let text = |label| rendered("no file", "name one", label, Severity::Record);
        assert_eq!(text("help"), "  ⚠ no file\n  help: name one\n");
        assert_eq!(text("Hilfe"), "  ⚠ no file\n  Hilfe: name one\n");
    }

    #[test]
    fn sentences_are_broken_between_words_at_the_width() {
        assert_eq!(broken("a bc def", 5), "a bc\ndef");
        assert_eq!(broken("  - a bc def", 8), "  - a bc\n  def");
        assert_eq!(broken("abcdefgh ij", 4), "abcdefgh\nij");
        assert_eq!(broken("a bc def", 4096), "a bc def");
    }
}
