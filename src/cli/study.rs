//! `impactid study`: studies of the theory from small TOML files that can be replayed.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};

use super::coverage::Coverage;
use super::out_folder::COPY;
use super::pairs::Pairs;
use super::theory::in_folder;
use super::{Exit, Failure, Verbosity, interrupt};
use impact_workbench::theory::{self, Study as Written};
use labfiles_write::output::write_bytes;

/// Arguments of `impactid study`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct Study {
    #[command(subcommand)]
    kind: Option<Kind>,
    /// The studies; a folder means all *.toml in it
    #[arg(value_name = "STUDY.TOML", required = true)]
    files: Vec<PathBuf>,
    /// Folder for the results, one folder in it for each study
    #[arg(long, short, value_name = "DIR", required = true)]
    out: Option<PathBuf>,
    /// Resume an interrupted run: skip studies whose results exist
    #[arg(long)]
    resume: bool,
}

/// Studies that have no file.
#[derive(Debug, Subcommand)]
enum Kind {
    /// Bias, error and coverage of the identification over many synthetic campaigns
    Coverage(Coverage),
    /// Coverage and width of the differences between two campaigns on one synthetic rig
    Pairs(Pairs),
}

const EXAMPLE: &str = "\
Example:
  impactid study data-samples/studies --out studies/

replays the studies of the paper's Figs. 2 to 6, 8 and 11, and of soft contact. Each writes \
its tables (CSV, Parquet) and figures (SVG, PNG, PDF) in a folder of its own. `impactid \
simulate`, `sweep`, `basins` and `atlas` write the study.toml of what they did, to be replayed \
in the same way.";

impl Study {
    /// Run all studies.
    ///
    /// # Errors
    /// [`Failure`] where a study cannot be read, a parameter is out of range or a file cannot
    /// be written.
    pub(super) fn run(self, verbosity: Verbosity) -> Result<Exit, Failure> {
        match self.kind {
            Some(Kind::Coverage(verb)) => return verb.run(verbosity),
            Some(Kind::Pairs(verb)) => return verb.run(verbosity),
            None => {}
        }
        let out = self.out.unwrap_or_default();
        let files = all_files(&self.files)?;
        let studies = files
            .iter()
            .map(|file| read(file))
            .collect::<Result<Vec<_>, _>>()?;
        let _lock = interrupt::lock(&out)?;
        for (file, (study, text)) in files.iter().zip(studies) {
            let name = name(file);
            let folder = out.join(&name);
            let there = fs::read_to_string(folder.join(COPY)).is_ok_and(|copy| copy == text);
            if self.resume && there {
                verbosity.info(&format!("{name}: results exist"));
                continue;
            }
            verbosity.info(&format!("{name}: {}", study.title));
            in_folder(&folder, &text, self.resume, "study", verbosity, |context| {
                Ok(theory::run(&study, context)?)
            })?;
            write_bytes(&folder.join(COPY), text.as_bytes())?;
        }
        Ok(Exit::Done)
    }
}

/// The results' folder: the study's own name, or its folder's where it is a verb's own.
fn name(file: &Path) -> String {
    let own = file.file_name().is_some_and(|n| n == COPY);
    let parent = file.parent().and_then(Path::file_name);
    let name = if own { parent } else { None };
    name.or(file.file_stem())
        .map_or("study".into(), |n| n.to_string_lossy().into_owned())
}

fn all_files(given: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    for path in given {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let entries = fs::read_dir(path).map_err(|e| Failure::io(path, &e))?;
        let mut found: Vec<PathBuf> = entries
            .filter_map(|e| Some(e.ok()?.path()))
            .filter(|p| p.extension().is_some_and(|e| e == "toml"))
            .collect();
        if found.is_empty() {
            return Err(Failure::new(
                format!("{}: no study (*.toml) in it", path.display()),
                "name a folder with studies, such as data-samples/studies",
            ));
        }
        found.sort();
        files.extend(found);
    }
    Ok(files)
}

fn read(file: &Path) -> Result<(Written, String), Failure> {
    let text = fs::read_to_string(file).map_err(|e| Failure::io(file, &e))?;
    let study = toml::from_str(&text).map_err(|e| {
        let remedy = "correct the place named; the studies shipped are examples";
        Failure::new(format!("{}: {e}", file.display()), remedy)
    })?;
    Ok((study, text))
}
