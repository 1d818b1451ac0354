//! Paths as text that is the same on every system: separated by `/`.

use std::path::{MAIN_SEPARATOR, Path, PathBuf};

use serde::{Serialize, Serializer};

/// A path with `/` between its parts.
pub(crate) fn text(path: &Path) -> String {
    separated(&path.to_string_lossy(), MAIN_SEPARATOR)
}

/// `/` for a system's separator; elsewhere `\` is a character like others.
fn separated(path: &str, separator: char) -> String {
    match separator {
        '/' => path.to_owned(),
        other => path.replace(other, "/"),
    }
}

/// What to do about a name with a backslash.
pub(super) const REMEDY: &str = "write / between folders, as in \"sub/*.csv\", on Windows too";

/// Whether a name has a backslash that separates nothing here, or a control character: TOML reads `\r` as one.
pub(super) fn is_foreign(name: &str) -> bool {
    let backslash = |c: char| c == '\\' && MAIN_SEPARATOR != '\\';
    name.contains(|c: char| backslash(c) || c.is_control())
}

/// A name without control characters, which a terminal obeys.
pub(super) fn shown(name: &str) -> String {
    let shown = |c: char| {
        let escaped = c.is_control().then(|| c.escape_default().to_string());
        escaped.unwrap_or_else(|| c.to_string())
    };
    name.chars().map(shown).collect()
}

/// Write a path with `/`; one that is no Unicode has no text.
pub(super) fn serialize<S: Serializer>(path: &Path, to: S) -> Result<S::Ok, S::Error> {
    match path.to_str() {
        Some(_) => text(path).serialize(to),
        // with serde's own message
        None => path.serialize(to),
    }
}

/// Write a path, where there is one.
pub(crate) fn serialize_option<S: Serializer>(
    path: &Option<PathBuf>,
    to: S,
) -> Result<S::Ok, S::Error> {
    match path {
        Some(path) => serialize(path, to),
        None => to.serialize_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_shown_as_typed() {
        assert_eq!(shown("sub\r*.csv"), r"sub\r*.csv");
        assert!(is_foreign("sub\r*.csv") && !is_foreign("sub/r*.csv"));
        assert_eq!(is_foreign(r"sub\r.csv"), MAIN_SEPARATOR == '/');
    }

    #[test]
    fn a_path_of_windows_is_written_as_elsewhere() {
        assert_eq!(separated(r"lab\day 1\run.h5", '\\'), "lab/day 1/run.h5");
        assert_eq!(separated(r"lab/run\1.h5", '/'), r"lab/run\1.h5");
        let path: PathBuf = ["lab", "day 1", "run.h5"].iter().collect();
        assert_eq!(text(&path), "lab/day 1/run.h5");
    }
}
