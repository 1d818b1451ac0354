//! What the operating system says of an error.

use std::io;

/// What the system says of an error, without the error's number.
///
/// ```
/// let missing = std::fs::read("no such file").unwrap_err();
/// assert!(missing.to_string().starts_with(&labfiles::said(&missing)));
/// assert!(!labfiles::said(&missing).contains("os error"));
/// ```
pub fn said(error: &io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error ")
        .next()
        .unwrap_or_default()
        .to_owned()
}
