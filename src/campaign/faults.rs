//! What is wrong with a campaign's description: every fault at once, each with its place and its
//! remedy.

use std::collections::HashMap;
use std::fmt;
use std::path::{Path, PathBuf};

/// How much a fault stops.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Worth saying; nothing is left out for it.
    Note,
    /// One record, or some, cannot be used; the others go on.
    Record,
    /// Nothing can be computed before it is mended.
    Campaign,
}

/// One fault: where, what, and what to do about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The file that holds it.
    pub file: PathBuf,
    /// Line in a text file, counted from 1.
    pub line: Option<usize>,
    /// Key, column, record or channel concerned; empty where the file itself is.
    pub key: String,
    /// What was found, and what was expected.
    pub what: String,
    /// What the user can do.
    pub remedy: String,
    /// How much it stops.
    pub severity: Severity,
}

impl Fault {
    /// The place as `file:line: key`.
    pub fn place(&self) -> String {
        let line = self.line.map(|l| format!(":{l}")).unwrap_or_default();
        let key = if self.key.is_empty() {
            String::new()
        } else {
            format!(": {}", self.key)
        };
        format!("{}{line}{key}", self.file.display())
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}. {}", self.place(), self.what, self.remedy)
    }
}

/// All faults found, in the order of the files and lines that hold them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Faults(pub Vec<Fault>);

impl Faults {
    /// Whether a fault stops the whole campaign.
    pub fn block(&self) -> bool {
        self.0.iter().any(|f| f.severity == Severity::Campaign)
    }

    /// The faults of one severity.
    pub fn of(&self, severity: Severity) -> impl Iterator<Item = &Fault> {
        self.0.iter().filter(move |f| f.severity == severity)
    }

    /// Groups of the same words at different places, in the order of their first.
    pub fn alike(&self) -> Vec<Vec<&Fault>> {
        let mut groups: Vec<Vec<&Fault>> = Vec::new();
        let mut index: HashMap<(&str, Severity), usize> = HashMap::new();
        for fault in &self.0 {
            let at = *index
                .entry((&fault.what, fault.severity))
                .or_insert_with(|| {
                    groups.push(Vec::new());
                    groups.len() - 1
                });
            groups[at].push(fault);
        }
        groups
    }

    /// Sort by severity (the gravest first), file and line, and drop repetitions.
    pub fn tidy(&mut self) {
        self.0.sort_by(|a, b| {
            (b.severity, &a.file, a.line, &a.key, &a.what)
                .cmp(&(a.severity, &b.file, b.line, &b.key, &b.what))
        });
        self.0.dedup();
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for fault in &self.0 {
            writeln!(f, "{fault}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Faults {}

/// Collects the faults of one file while it is read.
#[derive(Debug)]
pub struct Notebook {
    file: PathBuf,
    faults: Vec<Fault>,
}

impl Notebook {
    /// An empty one for a file.
    pub fn new(file: &Path) -> Self {
        Self {
            file: file.to_path_buf(),
            faults: Vec::new(),
        }
    }

    /// Note a fault that stops the campaign.
    pub fn fault(&mut self, line: Option<usize>, key: &str, what: String, remedy: &str) {
        self.push(Severity::Campaign, line, key, what, remedy);
    }

    /// Note a fault of the severity given.
    pub fn push(
        &mut self,
        severity: Severity,
        line: Option<usize>,
        key: &str,
        what: String,
        remedy: &str,
    ) {
        self.faults.push(Fault {
            file: self.file.clone(),
            line,
            key: key.to_owned(),
            what,
            remedy: remedy.to_owned(),
            severity,
        });
    }

    /// Take over the faults of another file.
    pub fn absorb(&mut self, other: Vec<Fault>) {
        self.faults.extend(other);
    }

    /// Whether a fault that stops the campaign was noted.
    pub fn blocks(&self) -> bool {
        self.faults.iter().any(|f| f.severity == Severity::Campaign)
    }

    /// The faults noted.
    pub fn into_faults(self) -> Vec<Fault> {
        self.faults
    }
}
