//! How much the program says, and where.

use std::io::Write;
use std::path::Path;

use super::Failure;

/// Prints on the standard error stream what `--quiet` and `-v` let through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Voice(i16);

impl Voice {
    /// From the flags of the command line.
    pub fn new(quiet: bool, verbose: u8) -> Self {
        Self(if quiet { -1 } else { i16::from(verbose) })
    }

    /// Whether nothing but errors is said.
    pub fn is_quiet(self) -> bool {
        self.0 < 0
    }

    /// Whether more than the usual is asked for.
    pub fn wants_detail(self) -> bool {
        self.0 >= 1
    }

    /// Say something that every user wants to know.
    pub fn say(self, text: &str) {
        if self.0 >= 0 {
            eprintln!("{text}");
        }
    }

    /// Say something for those who asked for more.
    pub fn detail(self, text: &str) {
        if self.0 >= 1 {
            eprintln!("{text}");
        }
    }
}

/// Write a result as JSON to the standard output.
///
/// # Errors
/// As [`print()`].
pub fn print_json(result: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(result)
        .map_err(|e| Failure::new(e.to_string(), "please report it with the command line"))?;
    print(&format!("{text}\n"))
}

/// Write a result to the standard output; a reader that has closed it ends the program quietly.
///
/// # Errors
/// Where it cannot be written, as on a full disk.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::io(Path::new("standard output"), &e))
        }
        _ => Ok(()),
    }
}
