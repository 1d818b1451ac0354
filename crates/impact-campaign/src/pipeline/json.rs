//! JSON files of the results' folder.

use std::path::Path;

use super::error::PipelineError;
use labfiles_write::output::write_bytes;

pub(super) fn store_error(path: &Path, reason: impl std::fmt::Display) -> PipelineError {
    PipelineError::Store {
        path: path.display().to_string(),
        reason: reason.to_string(),
    }
}

/// Write a value as JSON.
///
/// # Errors
/// If it cannot be written.
pub(super) fn write_json<T: serde::Serialize>(path: &Path, value: &T) -> Result<(), PipelineError> {
    let mut text = serde_json::to_string_pretty(value).map_err(|e| store_error(path, e))?;
    text.push('\n');
    Ok(write_bytes(path, text.as_bytes())?)
}

/// Read a value that [`write_json`] wrote.
///
/// # Errors
/// If the file is missing or not what is expected.
pub(super) fn read_json<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, PipelineError> {
    let text = std::fs::read_to_string(path).map_err(|e| store_error(path, labfiles::said(&e)))?;
    serde_json::from_str(&text).map_err(|e| store_error(path, e))
}
