//! What the verbs of the theory share: a study, a folder, progress, an end that can be resumed.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;

use super::out_folder::{self, COPY, Work};
use super::{Exit, Failure, Progress, Verbosity};
use impact_campaign::pipeline::block_cache::BlockCache;
use impact_workbench::theory::{Pictures, Study, StudyContext, run};
use labfiles_write::output::write_bytes;

/// Where results go.
#[derive(Debug, Clone, Args)]
pub(super) struct OutArgs {
    /// Folder for the results; created if missing
    #[arg(long, short, value_name = "DIR", required = true)]
    pub out: Option<PathBuf>,
    /// Resume an interrupted run of the same work
    #[arg(long)]
    pub resume: bool,
}

impl OutArgs {
    /// The folder.
    pub(super) fn folder(&self) -> &Path {
        self.out.as_deref().unwrap_or(Path::new("."))
    }

    /// Do a study's work into the folder.
    ///
    /// # Errors
    /// [`Failure`] where a parameter is out of range or an output cannot be written.
    pub(super) fn study(
        &self,
        study: &Study,
        what: &'static str,
        verbosity: Verbosity,
    ) -> Result<Exit, Failure> {
        let text = study_text(study)?;
        self.complete(&text, &text, what, verbosity, |context| {
            Ok(run(study, context)?)
        })
    }

    /// Do work that a key describes in full, and write the study that replays it beside the
    /// results.
    ///
    /// # Errors
    /// [`Failure`] of the work, or where an output cannot be written.
    pub(super) fn complete(
        &self,
        key: &str,
        study: &str,
        what: &'static str,
        verbosity: Verbosity,
        work: impl FnOnce(&StudyContext<'_>) -> Result<(), Failure>,
    ) -> Result<Exit, Failure> {
        let folder = self.folder();
        let _lock = out_folder::take(folder, Work::Study)?;
        refuse_other_study(folder, study)?;
        in_folder(folder, key, self.resume, what, verbosity, work)?;
        let copy = folder.join(COPY);
        write_bytes(&copy, study.as_bytes())?;
        verbosity.info(&format!(
            "{} holds the results; impactid study {} --out DIR replays them",
            folder.display(),
            copy.display()
        ));
        Ok(Exit::Done)
    }
}

/// Refuse a folder that holds results of another study, or of other parameters: what is written would take the place of
/// results that cannot be told from it.
///
/// # Errors
/// [`Failure`] that names the folder.
fn refuse_other_study(folder: &Path, study: &str) -> Result<(), Failure> {
    let copy = folder.join(COPY);
    match std::fs::read_to_string(&copy) {
        Ok(held) if held.parse::<toml::Table>().ok() != study.parse().ok() => {
            Err(out_folder::of_other_work(folder, &copy))
        }
        _ => Ok(()),
    }
}

/// A study as it is written.
///
/// # Errors
/// [`Failure`] where a number has no place in TOML.
pub(super) fn study_text(study: &Study) -> Result<String, Failure> {
    toml::to_string(study)
        .map_err(|e| Failure::new(e.to_string(), "give numbers that can be written as TOML"))
}

/// Do work that a key describes in full into a folder, with a progress bar; its messages are printed
/// at its end. With `resume` the blocks of an interrupted run are reused.
///
/// # Errors
/// [`Failure`] of the work, or where the folder cannot be written into.
pub(super) fn in_folder(
    folder: &Path,
    key: &str,
    resume: bool,
    what: &'static str,
    verbosity: Verbosity,
    work: impl FnOnce(&StudyContext<'_>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    labfiles_write::output::make_folder(folder)?;
    labfiles_write::output::clear_parts(folder);
    let blocks = BlockCache::open(folder, key, resume)?;
    let progress = Progress::new(verbosity, what, 1);
    let messages = Mutex::new(Vec::new());
    let done = work(&StudyContext {
        output: &|name, bytes| write_bytes(&folder.join(name), bytes),
        pictures: Pictures::All,
        blocks: &blocks,
        progress: &|done, all| progress.set(done, all),
        inform: &|text| {
            if let Ok(mut messages) = messages.lock() {
                messages.push(text.to_owned());
            }
        },
    });
    drop(progress);
    for text in messages.into_inner().unwrap_or_default() {
        verbosity.info(&text);
    }
    done?;
    blocks.remove();
    Ok(())
}
