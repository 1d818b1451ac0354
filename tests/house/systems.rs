//! What only some systems have is asked for on those alone.

use std::fs;
use std::path::PathBuf;

use super::sources::{packages, root, rust_files};

/// What exists on unix or on Linux only.
const OF_UNIX: [&str; 9] = [
    "std::os::unix",
    "std::os::fd",
    "libc::",
    "rustix::",
    "\"/dev/",
    "\"/proc/",
    "\"/tmp/",
    "Command::new(\"sh\")",
    "Command::new(\"bash\")",
];

#[test]
fn what_only_unix_has_is_under_cfg() {
    let mut paths: Vec<PathBuf> = Vec::new();
    for folder in packages().values() {
        rust_files(&folder.join("src"), &mut paths);
        rust_files(&folder.join("tests"), &mut paths);
    }
    let house = root().join("tests").join("house");
    let mut faults = Vec::new();
    for path in paths.iter().filter(|p| !p.starts_with(&house)) {
        let text = fs::read_to_string(path).expect("a source is text");
        let place = path.strip_prefix(root()).unwrap_or(path).display();
        let lines: Vec<&str> = text.lines().collect();
        let bare = (0..lines.len()).filter(|at| of_unix(lines[*at]) && !under_cfg(&lines, *at));
        faults.extend(bare.map(|at| format!("{place}:{}: {}", at + 1, lines[at].trim())));
    }
    assert!(
        faults.is_empty(),
        "without #[cfg(unix)] or #[cfg(target_os)]:\n{}",
        faults.join("\n")
    );
}

fn of_unix(line: &str) -> bool {
    let code = !line.trim_start().starts_with("//");
    code && OF_UNIX.iter().any(|u| line.contains(u))
}

/// Whether a line, an item around it or the file is for some systems alone.
fn under_cfg(lines: &[&str], at: usize) -> bool {
    let names_a_system = |l: &str| {
        let attribute = l.trim_start();
        let cfg = attribute.starts_with("#[cfg(") || attribute.starts_with("#![cfg(");
        cfg && ["unix", "windows", "target_os"]
            .iter()
            .any(|s| attribute.contains(s))
    };
    let first_code = lines
        .iter()
        .position(|l| !l.starts_with("//") && !l.is_empty());
    if first_code.is_some_and(|f| lines[f].starts_with("#![") && names_a_system(lines[f])) {
        return true;
    }
    let mut head = Some(at);
    while let Some(line) = head {
        let above = lines[..line].iter().rev();
        let mut attributes = above.take_while(|l| l.trim_start().starts_with(['#', '/']));
        if attributes.any(|l| names_a_system(l)) {
            return true;
        }
        head = outer(lines, line);
    }
    false
}

/// The line that begins what a line is in: the nearest above that is indented less; of a list or a
/// signature over several lines, its first.
fn outer(lines: &[&str], at: usize) -> Option<usize> {
    let indent = |l: &str| l.len() - l.trim_start().len();
    let own = indent(lines[at]);
    let closes = lines[at].trim_start().starts_with([')', ']', '}']);
    let before = |l: &&str| !l.trim().is_empty() && indent(l) < own + usize::from(closes);
    lines[..at].iter().rposition(before)
}

#[test]
fn a_condition_holds_for_all_that_is_in_its_item() {
    let guarded = [
        "#[cfg(unix)]\nuse std::os::unix::fs::MetadataExt;",
        "//! Signals.\n#![cfg(unix)]\n\nuse rustix::process::Signal;",
        "#[cfg(target_os = \"linux\")]\n/// Words.\nfn f(\n    a: u8,\n) -> u8 {\n    if a > 0 {\n\n        g(\"/proc/self\");\n    }\n}",
        "#[cfg(windows)]\nmod m {\n    fn f() {\n        libc::f();\n    }\n}",
    ];
    let bare = [
        "use std::os::unix::fs::MetadataExt;",
        "#[cfg(unix)]\nfn f() {}\n\nfn g() {\n    h(\"/dev/null\");\n}",
        "#[cfg(test)]\nmod m {\n    fn f() {\n        libc::f();\n    }\n}",
    ];
    let found = |text: &str| {
        let lines: Vec<&str> = text.lines().collect();
        let at = lines.iter().position(|l| of_unix(l)).expect("a line");
        under_cfg(&lines, at)
    };
    for text in guarded {
        assert!(found(text), "{text}");
    }
    for text in bare {
        assert!(!found(text), "{text}");
    }
}
