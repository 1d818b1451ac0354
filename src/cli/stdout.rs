//! Results on the standard output.

use std::io::Write;
use std::path::Path;

use super::Failure;

/// Write a result as JSON to the standard output.
///
/// # Errors
/// As [`print()`].
pub(super) fn print_json(result: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(result)
        .map_err(|e| Failure::new(e.to_string(), "please report it with the command line"))?;
    print(&format!("{text}\n"))
}

/// Write a JSON file that was written to the standard output too.
///
/// # Errors
/// As [`print()`], and where the file cannot be read.
pub(super) fn print_json_file(path: &Path) -> Result<(), Failure> {
    let text = std::fs::read_to_string(path).map_err(|e| Failure::io(path, &e))?;
    print(&text)
}

/// Write a result to the standard output; a reader that has closed it ends the program quietly.
///
/// # Errors
/// If it cannot be written, as on a full disk.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::io(Path::new("standard output"), &e))
        }
        _ => Ok(()),
    }
}
