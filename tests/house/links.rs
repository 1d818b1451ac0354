//! What the documents point to is there: the file and the heading of a link, the module or the item
//! of a path like `model::orbit`, the file of a path; and they list every format.

use std::fs;
use std::path::{Path, PathBuf};

use super::sources::{packages, root};

fn documents() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let entries = [root.to_path_buf(), root.join("docs")].map(fs::read_dir);
    entries
        .into_iter()
        .flat_map(|folder| folder.expect("a folder"))
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "md"))
        .collect()
}

/// Lines outside fenced code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut fenced = false;
    text.lines().filter(move |line| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        !fenced && !fence
    })
}

/// Targets of `[text](target)`.
fn targets(text: &str) -> Vec<&str> {
    let after = prose(text).flat_map(|line| line.split("](").skip(1));
    after.filter_map(|rest| rest.split(')').next()).collect()
}

/// Anchors of the headings, as the usual viewers make them.
fn anchors(text: &str) -> Vec<String> {
    let headings = prose(text).filter(|line| line.starts_with('#'));
    headings
        .map(|line| {
            let words = line.trim_start_matches('#').trim().to_lowercase();
            let kept = words
                .chars()
                .filter(|c| c.is_alphanumeric() || "-_ ".contains(*c));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect()
        })
        .collect()
}

/// What is wrong with a link from a document; `None` where it leads somewhere.
fn fault(document: &Path, target: &str) -> Option<String> {
    if target.contains("://") || target.starts_with("mailto:") {
        return None;
    }
    let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
    let path = match file {
        "" => document.to_path_buf(),
        _ => document.parent().expect("a folder").join(file),
    };
    if !path.exists() {
        return Some(format!("{target} is not there"));
    }
    let known = || anchors(&fs::read_to_string(&path).expect("a document"));
    (!anchor.is_empty() && !known().contains(&anchor.to_owned()))
        .then(|| format!("{target}: no such heading"))
}

#[test]
fn every_link_of_the_documents_leads_somewhere() {
    let mut seen = 0;
    for document in documents() {
        let text = fs::read_to_string(&document).expect("a document");
        for target in targets(&text) {
            seen += 1;
            let fault = fault(&document, target);
            assert_eq!(fault, None, "in {}", document.display());
        }
    }
    assert!(seen > 10, "{seen} links only");
}

/// Markdown files of a folder.
fn pages(folder: &Path) -> Vec<PathBuf> {
    let all = fs::read_dir(folder).expect("a folder");
    let paths = all.map(|entry| entry.expect("an entry").path());
    paths
        .filter(|path| path.extension().is_some_and(|e| e == "md"))
        .collect()
}

#[cfg(unix)]
#[test]
fn the_book_has_every_document_and_no_link_out_of_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("a folder");
    let made = std::process::Command::new(root.join("scripts/make-book"))
        .arg("--source")
        .arg(folder.path())
        .status();
    assert!(made.expect("sh").success());
    let docs = folder.path().join("docs");
    let summary = fs::read_to_string(docs.join("SUMMARY.md")).expect("a summary");
    let listed = targets(&summary);
    for page in pages(&docs) {
        let name = page.file_name().expect("a name").to_string_lossy();
        assert!(
            name == "SUMMARY.md" || listed.contains(&name.as_ref()),
            "{name} is not in docs/SUMMARY.md"
        );
        for target in targets(&fs::read_to_string(&page).expect("a page")) {
            let out_of_it = target.starts_with("..").then(|| target.to_owned());
            let fault = fault(&page, target).or(out_of_it);
            assert_eq!(fault, None, "in {name} of the book");
        }
    }
}

#[test]
fn a_broken_link_is_seen() {
    let readme = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    assert!(fault(&readme, "docs/none.md").is_some());
    assert!(fault(&readme, "docs/theory.md#no-such-heading").is_some());
    assert_eq!(
        targets("a [b](c) d [e](f#g)\n```\n[h](i)\n```\n"),
        ["c", "f#g"]
    );
    assert_eq!(anchors("## How good: R, f0\n"), ["how-good-r-f0"]);
}

/// The source folder that has the first part of a path like `module::file::Item`, and the path's
/// parts; a crate's own name may come first.
fn source_of(path: &str) -> Option<(PathBuf, Vec<&str>)> {
    let mut parts: Vec<&str> = path.split("::").collect();
    let mut folders = packages();
    let named = folders.remove(&parts[0].replace('_', "-"));
    if let Some(folder) = named {
        parts.remove(0);
        folders = [(String::new(), folder)].into();
    }
    let first = *parts.first()?;
    let has = |folder: &PathBuf| {
        folder.join(first).is_dir() || folder.join(format!("{first}.rs")).is_file()
    };
    let folder = folders.values().map(|f| f.join("src")).find(has)?;
    Some((folder, parts))
}

/// Whether the source has what a path like `module::file::Item` names.
fn is_in_source(path: &str) -> bool {
    let Some((mut at, parts)) = source_of(path) else {
        return false;
    };
    for (i, part) in parts.iter().enumerate() {
        let (folder, file) = (at.join(part), at.join(format!("{part}.rs")));
        if !folder.is_dir() && !file.is_file() {
            // An item of the module so far.
            let module = [at.with_extension("rs"), at.join("mod.rs")];
            let text = module.iter().find_map(|m| fs::read_to_string(m).ok());
            return i > 0 && text.is_some_and(|t| t.contains(&format!(" {}", parts[i])));
        }
        at = folder;
    }
    true
}

#[test]
fn modules_that_the_documents_name_exist() {
    let mut seen = 0;
    for document in documents() {
        let text = fs::read_to_string(&document).expect("a document");
        let quoted = prose(&text).flat_map(|line| line.split('`').skip(1).step_by(2));
        let paths = quoted.filter(|q| {
            let named =
                |p: &str| !p.is_empty() && p.chars().all(|c| c.is_alphanumeric() || c == '_');
            q.contains("::") && q.split("::").all(named)
        });
        let ours = paths.filter(|p| source_of(p).is_some());
        for path in ours {
            seen += 1;
            assert!(is_in_source(path), "{path} in {}", document.display());
        }
    }
    assert!(seen > 20, "{seen} paths only");
    assert!(!is_in_source("model::nothing_of_the_kind"));
}

/// Paths of all files and folders of the repository below one, from the root and with `/`.
fn all_paths(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let entry = entry.expect("an entry");
        let name = entry.file_name();
        if name == "target" || name.to_string_lossy().starts_with('.') {
            continue;
        }
        let path = entry.path();
        if path.is_dir() {
            all_paths(&path, found);
        }
        let below = path.strip_prefix(root()).expect("below the root");
        let parts = below.iter().map(|part| part.to_string_lossy());
        found.push(parts.collect::<Vec<_>>().join("/"));
    }
}

/// Whether a text between backticks is the path of a file or a folder of the repository, or the end of one; with a
/// word in capitals it is that of a file to be written.
fn is_path(quoted: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || "_-./".contains(c);
    let stem = quoted.rsplit('/').next().and_then(|n| n.split('.').next());
    let to_be_written = stem.is_some_and(|s| s.len() > 1 && s.chars().all(char::is_uppercase));
    let ends = [".rs", ".toml", ".md", ".py", ".yml"];
    let is_file = ends.iter().any(|end| quoted.ends_with(end));
    quoted.chars().all(plain)
        && (quoted.contains('/') || is_file)
        && !quoted.starts_with(['.', '/'])
        && !quoted.starts_with("target/")
        && !to_be_written
}

#[test]
fn every_path_that_the_pages_for_contributors_name_exists() {
    let mut all = Vec::new();
    all_paths(root(), &mut all);
    let exists = |path: &str| {
        let end = format!("/{path}");
        all.iter()
            .any(|known| known == path || known.ends_with(&end))
    };
    let mut seen = 0;
    for page in ["CONTRIBUTING.md", "ARCHITECTURE.md"] {
        let text = fs::read_to_string(root().join(page)).expect("a page");
        let quoted = prose(&text).flat_map(|line| line.split('`').skip(1).step_by(2));
        for path in quoted.filter(|q| is_path(q)) {
            seen += 1;
            assert!(exists(path), "{path} in {page}");
        }
    }
    assert!(seen > 40, "{seen} paths only");
    assert!(is_path("parameters/none.rs") && !exists("parameters/none.rs"));
    assert!(!is_path("src/NAME.rs") && !is_path("z = p/n") && !is_path("../shared/data"));
}

#[test]
fn pages_name_every_format_that_is_read() {
    let read = |page: &str| fs::read_to_string(root().join(page)).expect("a page");
    for page in ["docs/formats.md", "crates/labfiles/README.md"] {
        let text = read(page);
        for title in labfiles::format_titles() {
            assert!(text.contains(title), "{title} is not in {page}");
        }
    }
}
