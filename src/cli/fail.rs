//! Errors as the user sees them: where, what, and what to do.

use std::path::Path;

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme};

use crate::campaign::faults::{Fault, Faults, Severity};
use crate::pipeline::PipelineError;
use labfiles::output::OutputError;
use labfiles::panic_is_caught;
use labfiles::ReadError;

/// Print no text for a panic of a library that a reader turns into an error: the error says it.
pub fn hush_caught_panics() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !panic_is_caught() {
            print(panic);
        }
    }));
}

/// Why a verb could not do its work.
#[derive(Debug)]
pub struct Failure(Vec<Trouble>);

/// One trouble, printed by miette.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
struct Trouble {
    message: String,
    remedy: String,
    severity: Severity,
}

impl Diagnostic for Trouble {
    fn severity(&self) -> Option<miette::Severity> {
        Some(match self.severity {
            Severity::Campaign => miette::Severity::Error,
            Severity::Record => miette::Severity::Warning,
            Severity::Note => miette::Severity::Advice,
        })
    }

    fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
        Some(Box::new(&self.remedy))
    }
}

impl Failure {
    /// One trouble with its remedy.
    pub fn new(message: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self(vec![Trouble {
            message: message.into(),
            remedy: remedy.into(),
            severity: Severity::Campaign,
        }])
    }

    /// All messages in one line.
    #[cfg(feature = "mpi")]
    pub fn text(&self) -> String {
        let messages: Vec<&str> = self.0.iter().map(|t| t.message.as_str()).collect();
        messages.join("; ")
    }

    /// A file that could not be read or written.
    pub fn io(path: &Path, error: &std::io::Error) -> Self {
        Self::new(
            format!("{}: {error}", path.display()),
            "look at the name and the rights",
        )
    }

    /// Print all troubles on the standard error stream.
    pub fn print(&self) {
        for trouble in &self.0 {
            eprint!("{}", rendered(trouble));
        }
    }
}

impl From<Faults> for Failure {
    fn from(faults: Faults) -> Self {
        Self(faults.0.iter().map(Trouble::from).collect())
    }
}

impl From<&Fault> for Trouble {
    fn from(fault: &Fault) -> Self {
        Self {
            message: format!("{}: {}", fault.place(), fault.what),
            remedy: fault.remedy.clone(),
            severity: fault.severity,
        }
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
            error => Self::new(error.to_string(), error.remedy()),
        }
    }
}

/// A fault as it is printed.
pub fn rendered_fault(fault: &Fault) -> String {
    rendered(&Trouble::from(fault))
}

fn rendered(trouble: &Trouble) -> String {
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(theme()).with_width(width());
    match handler.render_report(&mut text, trouble) {
        Ok(()) => text,
        Err(_) => format!("{}. {}\n", trouble.message, trouble.remedy),
    }
}

/// Colours on a terminal that wants them, none elsewhere or with NO_COLOR.
fn theme() -> GraphicalTheme {
    use std::io::IsTerminal;
    let plain = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
    match std::io::stderr().is_terminal() && !plain {
        true => GraphicalTheme::unicode(),
        false => GraphicalTheme::unicode_nocolor(),
    }
}

/// Width of lines: broken on a terminal, whole elsewhere, so that programs find their words.
fn width() -> usize {
    use std::io::IsTerminal;
    if std::io::stderr().is_terminal() {
        96
    } else {
        4096
    }
}
