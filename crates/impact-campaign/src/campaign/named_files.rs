//! Which files campaign.toml and its run table name, without opening any of them.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::diagnostic::{Code, Diagnostics, FaultCollector};
use super::discovery::expand;
use super::values::value;
use super::{read, run_table};

/// Where the records of a campaign are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedFiles {
    folder: PathBuf,
    patterns: Vec<String>,
    /// The run table, where there is one.
    pub run_table: Option<PathBuf>,
    rows: Vec<PathBuf>,
}

impl NamedFiles {
    /// Read campaign.toml and its run table. What is wrong with the table is reported when the campaign is
    /// loaded: here it names the files that can be read from it.
    ///
    /// # Errors
    /// Everything that is wrong with the form of campaign.toml, or that it states published speeds
    /// instead of records.
    pub fn read(campaign: &Path) -> Result<Self, Diagnostics> {
        let mut faults = FaultCollector::new(campaign);
        let text = read::text(campaign, &mut faults).unwrap_or_default();
        let written = read::read(&text, &mut faults).unwrap_or_default();
        if written.published.is_some() {
            faults.fault(
                Code::Conflict,
                None,
                "published",
                "the campaign states published speeds: there are no records to wait for".to_owned(),
                "use `impactid run`",
            );
        }
        if faults.blocks() {
            return Err(faults.into_diagnostics());
        }
        let folder = campaign.parent().unwrap_or(Path::new("")).to_path_buf();
        let table = value(&written.records.run_table);
        let run_table = table.as_ref().map(|name| folder.join(name));
        let rows = table.map_or(Vec::new(), |name| {
            run_table::read(
                &folder,
                &name,
                &mut FaultCollector::new(&folder.join(&name)),
            )
        });
        Ok(Self {
            patterns: value(&written.records.files).map_or(Vec::new(), |f| f.0),
            rows: rows.into_iter().map(|row| folder.join(row.file)).collect(),
            run_table,
            folder,
        })
    }

    /// The files named now, each once: those of the run table whether they are there or not, and
    /// those that match a pattern.
    pub fn files(&self) -> BTreeSet<PathBuf> {
        let matching = self.patterns.iter();
        let matching = matching.flat_map(|pattern| expand(&self.folder, pattern));
        self.rows.iter().cloned().chain(matching).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_those_of_the_patterns_or_of_the_run_table() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("b.csv"), "").unwrap();
        std::fs::write(at("a.csv"), "").unwrap();
        let toml = at("campaign.toml");
        std::fs::write(&toml, "[records]\nfiles = [\"*.csv\", \"a*\"]\n").unwrap();
        let named = NamedFiles::read(&toml).unwrap();
        assert_eq!(named.run_table, None);
        let files: Vec<PathBuf> = named.files().into_iter().collect();
        assert_eq!(files, [at("a.csv"), at("b.csv")]);
        // a pattern is matched again each time
        std::fs::write(at("c.csv"), "").unwrap();
        assert_eq!(named.files().len(), 3);

        std::fs::write(&toml, "[records]\nrun_table = \"runs.csv\"\n").unwrap();
        assert!(NamedFiles::read(&toml).unwrap().files().is_empty());
        std::fs::write(at("runs.csv"), "file\nz.csv\n").unwrap();
        let named = NamedFiles::read(&toml).unwrap();
        assert_eq!(named.run_table, Some(at("runs.csv")));
        assert_eq!(named.files(), BTreeSet::from([at("z.csv")]));
        std::fs::write(&toml, "[recorts]\n").unwrap();
        assert!(NamedFiles::read(&toml).is_err());
    }
}
