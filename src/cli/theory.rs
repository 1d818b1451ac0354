//! What the verbs of the theory share: a study, a folder, progress, an end that can be resumed.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;

use super::{Exit, Failure, Progress, Verbosity, interrupt};
use crate::pipeline::theory::kept::Kept;
use crate::pipeline::theory::{Desk, Study, StudyError, run};
use labfiles::output::{Lock, write_bytes};

/// Where results go.
#[derive(Debug, Clone, Args)]
pub struct OutArgs {
    /// Folder for the results; created if missing
    #[arg(long, short, value_name = "DIR", required = true)]
    pub out: Option<PathBuf>,
    /// Resume an interrupted run of the same work
    #[arg(long)]
    pub resume: bool,
}

/// Name of the study beside its results; it is written last, so its presence marks complete results.
pub const COPY: &str = "study.toml";

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        Self::new(error.to_string(), error.remedy())
    }
}

impl OutArgs {
    /// The folder.
    pub fn folder(&self) -> &Path {
        self.out.as_deref().unwrap_or(Path::new("."))
    }

    /// Do a study's work into the folder and write the study itself beside the results, to be
    /// replayed.
    ///
    /// # Errors
    /// [`Failure`] where a parameter is out of range or an output cannot be written.
    pub fn study(
        &self,
        study: &Study,
        what: &'static str,
        verbosity: Verbosity,
    ) -> Result<Exit, Failure> {
        let text = written(study)?;
        let _lock = Lock::take(self.folder())?;
        interrupt::watch(self.folder().to_path_buf());
        let work = Work {
            folder: self.folder(),
            text: &text,
            resume: self.resume,
        };
        work.run(verbosity, what, |desk| Ok(run(study, desk)?))?;
        self.leave_copy(&text, verbosity)?;
        Ok(Exit::Done)
    }

    /// Write the study beside its results and report it.
    ///
    /// # Errors
    /// [`Failure`] where it cannot be written.
    pub fn leave_copy(&self, text: &str, verbosity: Verbosity) -> Result<(), Failure> {
        write_bytes(&self.folder().join(COPY), text.as_bytes())?;
        verbosity.info(&format!(
            "{} holds the results; impactid study {} --out DIR replays them",
            self.folder().display(),
            self.folder().join(COPY).display()
        ));
        Ok(())
    }
}

/// A study as it is written.
///
/// # Errors
/// [`Failure`] where a number has no place in TOML.
pub fn written(study: &Study) -> Result<String, Failure> {
    toml::to_string(study)
        .map_err(|e| Failure::new(e.to_string(), "give numbers that can be written as TOML"))
}

/// Work in a folder that a text describes in full.
pub struct Work<'a> {
    /// The folder.
    pub folder: &'a Path,
    /// Everything that the results depend on.
    pub text: &'a str,
    /// Whether to reuse the blocks of an interrupted run.
    pub resume: bool,
}

impl Work<'_> {
    /// Do it, with a progress bar; its messages are printed at its end.
    ///
    /// # Errors
    /// [`Failure`] of the work.
    pub fn run(
        &self,
        verbosity: Verbosity,
        what: &'static str,
        work: impl FnOnce(&Desk<'_>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        labfiles::output::make_folder(self.folder)?;
        labfiles::output::clear_parts(self.folder);
        let kept = Kept::open(self.folder, self.text, self.resume)?;
        let progress = Progress::new(verbosity, what, 1);
        let said = Mutex::new(Vec::new());
        let done = work(&Desk {
            folder: self.folder,
            kept: &kept,
            progress: &|done, all| progress.set(done, all),
            say: &|text| {
                if let Ok(mut said) = said.lock() {
                    said.push(text.to_owned());
                }
            },
        });
        drop(progress);
        for text in said.into_inner().unwrap_or_default() {
            verbosity.info(&text);
        }
        done?;
        kept.remove();
        Ok(())
    }
}
