//! `impactid init`: write a commented campaign.toml for the files in a folder.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{Exit, Failure, Verbosity};
use impact_campaign::campaign::infer::{self, FolderContents, InferredChannel, RefusedFile};
use impact_campaign::campaign::template;
use impact_records::message::counted;
use labfiles::open;
use labfiles_write::output;

/// Arguments of `impactid init`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Init {
    /// Folder with the records
    #[arg(value_name = "DIR", default_value = ".")]
    folder: PathBuf,
    /// Overwrite an existing campaign.toml
    #[arg(long)]
    force: bool,
}

const EXAMPLE: &str = "\
Example:
  impactid init records/      writes records/campaign.toml, and records/runs.csv where the names of the
                              files state frequencies and gaps";

impl Init {
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        if !self.folder.is_dir() {
            let message = format!("{} is not a folder", self.folder.display());
            return Err(Failure::new(
                message,
                "name the folder that holds the records",
            ));
        }
        let path = self.folder.join("campaign.toml");
        if path.exists() && !self.force {
            return Err(Failure::new(
                format!("{} exists already", path.display()),
                "add --force to overwrite it",
            ));
        }
        let found = infer::inspect_folder(&self.folder, &open);
        if found.files == 0 {
            return Err(none_found(&self.folder, &found));
        }
        let text = template::campaign_toml(&name_of(&self.folder), &found);
        // there is no --out: the description lies beside its records
        let refused = |error: output::OutputError| {
            let remedy = "allow writing into the folder, or copy the records into one that you may write into";
            Failure::new(error.to_string(), remedy)
        };
        let table = found.run_table.as_ref().zip(found.table_of_names.as_ref());
        if let Some((name, table)) = table {
            output::write_bytes(&self.folder.join(name), table.as_bytes()).map_err(refused)?;
        }
        output::write_bytes(&path, text.as_bytes()).map_err(refused)?;
        print_summary(&path, &found, verbosity);
        Ok(Exit::Done)
    }
}

fn name_of(folder: &Path) -> String {
    let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.to_path_buf());
    whole.file_name().map_or_else(
        || "campaign".to_owned(),
        |n| n.to_string_lossy().into_owned(),
    )
}

/// What to do where no reader states it.
fn name_records() -> String {
    let titles = labfiles::format_titles().join(", ");
    format!("name the folder that holds files of {titles} or other text tables")
}

/// No record: each file with the reason, and the remedies of the readers that refused them.
fn none_found(folder: &Path, found: &FolderContents) -> Failure {
    let refused = found.refused.iter();
    let refused = refused.map(|r| format!("; {}: {}", r.file, r.reason));
    let others = found.others.iter().map(|file| {
        format!(
            "; {file} was read, but is neither a series of 16 samples or more nor a list of times or heights"
        )
    });
    let mut faults: String = refused.chain(others).take(NAMED).collect();
    let all = found.refused.len() + found.others.len();
    if let Some(more) = all.checked_sub(NAMED).filter(|n| *n > 0) {
        faults += &format!("; {}", counted(more, "more file"));
    }
    let remedy = remedies(&found.refused);
    let of_lists = || (!found.others.is_empty()).then(name_columns);
    Failure::new(
        format!("no record found in {}{faults}", folder.display()),
        remedy.or_else(of_lists).unwrap_or_else(name_records),
    )
}

/// What to do with refused files, each way once: behind the first file of each where there are several.
fn remedies(refused: &[RefusedFile]) -> Option<String> {
    let mut unlike: Vec<&RefusedFile> = Vec::new();
    for file in refused.iter().take(NAMED) {
        if !unlike.iter().any(|known| known.remedy == file.remedy) {
            unlike.push(file);
        }
    }
    match unlike[..] {
        [] => None,
        [only] => Some(only.remedy.clone()),
        _ => {
            let each = unlike.iter().map(|r| format!("{}: {}", r.file, r.remedy));
            Some(each.collect::<Vec<_>>().join("; "))
        }
    }
}

/// How the columns of a list are recognised.
fn name_columns() -> String {
    "name the columns of a list by what they contain, with their units: heights as drop height (cm) and rebound height (cm), \
     times of impacts as time (s), times from an impact to the next as flight 1 (s), flight 2 (s)"
        .to_owned()
}

/// Files that the summary and an error name.
const NAMED: usize = 5;

fn print_summary(path: &Path, found: &FolderContents, verbosity: Verbosity) {
    for refused in found.refused.iter().take(NAMED) {
        verbosity.info(&format!(
            "{} is not a record: {}",
            refused.file, refused.reason
        ));
    }
    if let Some(more) = found.refused.len().checked_sub(NAMED).filter(|n| *n > 0) {
        verbosity.info(&format!("{} more are no records", counted(more, "file")));
    }
    for other in found.others.iter().take(NAMED) {
        verbosity.info(&format!(
            "{other} is not a record: it is a table of notes or settings, and not used"
        ));
    }
    if let Some(more) = found.others.len().checked_sub(NAMED).filter(|n| *n > 0) {
        let are = if more == 1 { "is" } else { "are" };
        let tables = counted(more, "more table");
        verbosity.info(&format!("{tables} {are} not used either"));
    }
    for note in &found.notes {
        verbosity.info(note);
    }
    let of_role = found.channels.iter().filter(|c| c.role.is_some()).count();
    let assigned = of_role + found.then.len();
    let mut left_over = without_role(found);
    left_over.retain(|name| !found.then.iter().any(|then| then == name));
    verbosity.info(&format!(
        "{}: {} with {} ({}), {assigned} of {} signals assigned to a role{}. Complete it, then run: impactid \
         check {}",
        path.display(),
        counted(found.files, "file"),
        counted(found.records, "record"),
        found.format,
        assigned + left_over.len(),
        named(&left_over),
        path.display()
    ));
}

/// The signals without a role: neither the time nor single values.
fn without_role(found: &FolderContents) -> Vec<&str> {
    let signal = |c: &&InferredChannel| c.role.is_none() && !c.is_time && c.samples > 1;
    let names = found.channels.iter().filter(signal);
    names.map(|c| c.name.as_str()).collect()
}

/// The signals left over, as the end of a sentence.
fn named(names: &[&str]) -> String {
    if names.is_empty() {
        return String::new();
    }
    format!(" (not {})", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_there_is_no_record_each_refused_file_is_named_with_the_readers_remedy() {
        let refused = |k: usize| RefusedFile {
            file: format!("t{k}.mat"),
            reason: "it holds a table T".to_owned(),
            remedy: format!("save table2struct(T) of {k}"),
        };
        let mut found = FolderContents {
            refused: (1..=2).map(refused).collect(),
            others: vec!["a.csv".to_owned()],
            ..FolderContents::default()
        };
        let only = |found: &FolderContents| {
            let mut problems = none_found(Path::new("r"), found).problems();
            problems.remove(0)
        };
        let (message, remedy) = only(&found);
        assert_eq!(
            message,
            "no record found in r; t1.mat: it holds a table T; t2.mat: it holds a table T; a.csv was read, but \
             is neither a series of 16 samples or more nor a list of times or heights"
        );
        assert_eq!(
            remedy,
            "t1.mat: save table2struct(T) of 1; t2.mat: save table2struct(T) of 2"
        );
        found.refused[1].remedy = found.refused[0].remedy.clone();
        assert_eq!(only(&found).1, "save table2struct(T) of 1");
        let list = FolderContents {
            others: found.others.clone(),
            ..FolderContents::default()
        };
        assert_eq!(only(&list).1, name_columns());
        found.refused = (1..=6).map(refused).collect();
        let (message, _) = only(&found);
        assert!(
            message.ends_with("t5.mat: it holds a table T; 2 more files"),
            "{message}"
        );
        assert_eq!(only(&FolderContents::default()).1, name_records());
    }
}
