//! The sources of the workspace, and what they import.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A source file of a package.
pub(crate) struct SourceFile {
    /// Name of the package.
    pub(crate) package: String,
    /// Path below the package's `src`, with `/`.
    pub(crate) name: String,
    /// Path of its module in the package: `methods::impacts` of `methods/impacts/mod.rs`; empty for the root.
    pub(crate) module: String,
    pub(crate) text: String,
}

impl SourceFile {
    /// The code before the tests, without comments.
    pub(crate) fn code(&self) -> String {
        let code = self.text.split("#[cfg(test)]").next().unwrap_or("");
        let code = code.split("#[cfg(any(test").next().unwrap_or("");
        let lines = code.lines().map(|l| l.split("//").next().unwrap_or(""));
        lines.collect::<Vec<_>>().join("\n")
    }

    /// First part of the module's path.
    pub(crate) fn top(&self) -> &str {
        self.module.split("::").next().unwrap_or("")
    }

    /// Where it is in the repository.
    pub(crate) fn place(&self) -> String {
        match self.package.as_str() {
            "impactid" => format!("src/{}", self.name),
            package => format!("crates/{package}/src/{}", self.name),
        }
    }
}

pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The packages of the workspace and their folders, by name; the program is the root's.
pub(crate) fn packages() -> BTreeMap<String, PathBuf> {
    let entries = fs::read_dir(root().join("crates")).expect("crates can be read");
    let crates = entries.map(|e| e.expect("an entry").path());
    let named = crates.map(|path| {
        let name = path.file_name().expect("a name").to_string_lossy();
        (name.into_owned(), path)
    });
    named
        .chain([("impactid".to_owned(), root().to_path_buf())])
        .collect()
}

/// All `.rs` files below a folder.
pub(crate) fn rust_files(folder: &Path, all: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for path in entries.map(|e| e.expect("an entry").path()) {
        if path.is_dir() {
            rust_files(&path, all);
        } else if path.extension().is_some_and(|e| e == "rs") {
            all.push(path);
        }
    }
}

/// All source files of the workspace.
pub(crate) fn all_sources() -> Vec<SourceFile> {
    let mut all = Vec::new();
    for (package, folder) in packages() {
        let folder = folder.join("src");
        let mut paths = Vec::new();
        rust_files(&folder, &mut paths);
        for path in paths {
            let name = path.strip_prefix(&folder).expect("below src");
            let name = name.to_string_lossy().replace('\\', "/");
            let stem = name.trim_end_matches(".rs").trim_end_matches("/mod");
            let module = match stem {
                "lib" | "main" => String::new(),
                stem => stem.replace('/', "::"),
            };
            all.push(SourceFile {
                package: package.clone(),
                name,
                module,
                text: fs::read_to_string(&path).expect("a source is text"),
            });
        }
    }
    all
}

/// The paths of `a::{b, c::{d, e}}`, one by one.
fn expanded(tree: &str) -> Vec<String> {
    let tree = tree.trim();
    let Some((before, list)) = tree.split_once('{') else {
        let path = tree.split(" as ").next().unwrap_or(tree);
        return vec![path.split_whitespace().collect()];
    };
    let list = list.rsplit_once('}').map_or(list, |(list, _)| list);
    let mut depth = 0;
    let items = list.split(|c| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        c == ',' && depth == 0
    });
    items
        .filter(|item| !item.trim().is_empty())
        .flat_map(|item| expanded(&format!("{before}{}", item.trim())))
        .collect()
}

/// What a file uses: the paths of its `use` statements, and those that its code spells out.
fn used(code: &str) -> Vec<String> {
    let mut paths = Vec::new();
    let mut rest = String::new();
    let code = &without_visibility(code);
    for statement in code.split_inclusive(';') {
        let start = statement.rfind("use ").filter(|at| {
            let before = statement[..*at].trim_end();
            before.is_empty()
                || before.ends_with(['}', ';', ')', ']', '{', '"'])
                || before.ends_with("pub")
        });
        match start {
            Some(at) => paths.extend(expanded(statement[at + 4..].trim_end_matches(';'))),
            None => rest.push_str(statement),
        }
    }
    let word = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let spelt = rest.split(|c| !word(c)).filter(|w| w.contains("::"));
    paths.extend(spelt.map(str::to_owned));
    paths
}

/// Code without the paths of `pub(in path)`, which import nothing.
fn without_visibility(code: &str) -> String {
    let mut parts = code.split("pub(in ");
    let first = parts.next().unwrap_or("").to_owned();
    parts.fold(first, |text, part| {
        text + "pub " + part.split_once(')').map_or(part, |(_, rest)| rest)
    })
}

/// Modules that a file declares in files of their own.
fn children(code: &str) -> BTreeSet<&str> {
    let declared = code.split("mod ").skip(1);
    declared
        .filter_map(|rest| rest.split_once(';'))
        .map(|(name, _)| name.trim())
        .filter(|name| name.chars().all(|c| c.is_alphanumeric() || c == '_'))
        .collect()
}

/// The files of one package and what each imports from the others. A name that a file only passes on
/// (`pub use`) counts as imported from where it is defined.
pub(crate) struct Imports {
    /// From each module to the modules that it imports.
    pub(crate) of: BTreeMap<String, BTreeSet<String>>,
}

impl Imports {
    /// Of the files of one package.
    pub(crate) fn new(files: &[&SourceFile]) -> Self {
        let modules: BTreeSet<String> = files.iter().map(|f| f.module.clone()).collect();
        let named: BTreeMap<String, Vec<Vec<String>>> = files
            .iter()
            .filter(|f| !f.module.split("::").any(|part| part == "tests"))
            .map(|f| {
                let code = f.code();
                let children = children(&code);
                let full = |path: &String| in_full(path, &f.module, &children);
                (
                    f.module.clone(),
                    used(&code).iter().filter_map(full).collect(),
                )
            })
            .collect();
        let of = named.iter().map(|(module, paths)| {
            let defined = paths.iter().map(|p| defining(p.clone(), &modules, &named));
            let others = defined.filter(|other| other != module).collect();
            (module.clone(), others)
        });
        Self { of: of.collect() }
    }

    /// Modules that a module reaches by imports; itself only in a circle.
    fn reached(&self, from: &str) -> BTreeSet<&String> {
        let mut found = BTreeSet::new();
        let mut open: Vec<&String> = self.of.get(from).into_iter().flatten().collect();
        while let Some(next) = open.pop() {
            if found.insert(next) {
                open.extend(self.of.get(next).into_iter().flatten());
            }
        }
        found
    }

    /// Groups of modules that import from each other in a circle.
    pub(crate) fn circles(&self) -> BTreeSet<Vec<String>> {
        let reached: BTreeMap<&String, BTreeSet<&String>> =
            self.of.keys().map(|m| (m, self.reached(m))).collect();
        let in_circle = reached.keys().filter(|m| reached[**m].contains(**m));
        in_circle
            .map(|m| {
                let both = reached[m]
                    .iter()
                    .filter(|o| reached.get(**o).is_some_and(|r| r.contains(m)));
                both.map(|o| (**o).clone()).collect()
            })
            .collect()
    }
}

/// A path from the package's root, as its parts; `None` where it leads out of the package.
fn in_full(path: &str, module: &str, children: &BTreeSet<&str>) -> Option<Vec<String>> {
    let mut at: Vec<&str> = module.split("::").filter(|p| !p.is_empty()).collect();
    let mut parts: Vec<&str> = path.split("::").collect();
    match parts[0] {
        "crate" => at.clear(),
        "self" => {}
        "super" => {
            at.pop();
        }
        first if children.contains(first) => parts.insert(0, "self"),
        _ => return None,
    }
    parts.remove(0);
    while parts.first() == Some(&"super") {
        at.pop();
        parts.remove(0);
    }
    Some(at.into_iter().chain(parts).map(str::to_owned).collect())
}

/// The module that defines what a path names.
fn defining(
    mut path: Vec<String>,
    modules: &BTreeSet<String>,
    named: &BTreeMap<String, Vec<Vec<String>>>,
) -> String {
    // a name is passed on a few times at most
    for _ in 0..8 {
        let file = (0..=path.len())
            .rev()
            .find(|n| modules.contains(&path[..*n].join("::")))
            .unwrap_or(0);
        let module = path[..file].join("::");
        let passed_on = path.get(file).and_then(|item| {
            let mut others = named.get(&module)?.iter();
            others.find(|p| p.last() == Some(item) && **p != path)
        });
        let Some(other) = passed_on else {
            return module;
        };
        path = other.iter().chain(&path[file + 1..]).cloned().collect();
    }
    path.join("::")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(module: &str, text: &str) -> SourceFile {
        SourceFile {
            package: "p".into(),
            name: format!("{module}.rs"),
            module: module.into(),
            text: text.into(),
        }
    }

    fn circles(files: &[(&str, &str)]) -> Vec<Vec<String>> {
        let files: Vec<SourceFile> = files.iter().map(|(m, t)| file(m, t)).collect();
        let files: Vec<&SourceFile> = files.iter().collect();
        Imports::new(&files).circles().into_iter().collect()
    }

    #[test]
    fn circles_are_seen_whichever_way_a_path_is_written() {
        let root = ("", "mod a;\nmod b;\npub use a::A;\n");
        for b in [
            "use crate::a::A;",
            "use super::a::{self, A};",
            "use crate::{a::A};",
            "fn f() { crate::a::f() }",
        ] {
            let found = circles(&[root, ("a", "pub struct A;\nuse super::b::B;\n"), ("b", b)]);
            assert_eq!(found, [["a", "b"]], "{b}");
        }
        // a name that the root passes on is that of its module
        let found = circles(&[root, ("a", "use crate::b::B;"), ("b", "use crate::A;")]);
        assert_eq!(found, [["a", "b"]]);
        // a child that uses what its parent defines, and a parent that uses its child
        let found = circles(&[
            ("", "mod a;\nfn f() { a::g() }\n"),
            ("a", "use super::Item;"),
        ]);
        assert_eq!(found, [["", "a"]]);
        // visibility is no import
        let found = circles(&[
            root,
            ("a", "pub(in crate::b) fn f() {}"),
            ("b", "use crate::a::f;"),
        ]);
        assert!(found.is_empty());
        // tests and comments are no imports
        let found = circles(&[
            root,
            (
                "a",
                "// use crate::b::B;\n#[cfg(test)]\nmod tests { use crate::b::B; }",
            ),
            ("b", "use crate::a::A;"),
        ]);
        assert!(found.is_empty());
    }
}
