//! The whole street: the only room that knows all others. It calls, it does not compute.
//!
//! `run` = [`observe`] every record → brackets → [`identify`] → [`report`]; the stages alone
//! go through [`store`].

pub mod checkpoint;
pub mod coverage;
pub mod identify;
pub mod inputs;
pub mod observe;
mod packed;
pub mod plan;
pub mod published;
pub mod report;
pub mod selftest;
pub mod store;
pub mod synthesise;
pub mod tables;
pub mod theory;

use std::path::Path;

use crate::campaign::resolved::ResolvedCampaign;
use crate::identify::Verdict;
use crate::motion::{Bracket, Observation, brackets, scale_drives};
use crate::pipeline::checkpoint::Checkpoint;
use labfiles::output::OutputError;
use labfiles::ReadError;

/// Told the stage, the steps done and the steps in all.
pub type Progress<'a> = &'a (dyn Fn(&'static str, u64, u64) + Sync);

/// Why the pipeline stopped.
#[derive(Debug, thiserror::Error)]
pub enum PipelineError {
    /// An output could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// An input could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A table could not be made or read.
    #[error("{table}: {reason}")]
    Table {
        /// Which table.
        table: String,
        /// What the library said.
        reason: String,
    },
    /// What a stage before should have left is missing or unreadable.
    #[error("{path}: {reason}")]
    Store {
        /// The file.
        path: String,
        /// What is wrong with it.
        reason: String,
    },
    /// No record of the campaign could be used.
    #[error("none of the {0} records can be used")]
    NothingUsable(usize),
    /// A file that the report's look needs could not be read.
    #[error("{path}: {reason}")]
    Look {
        /// The file.
        path: String,
        /// What the system said.
        reason: String,
    },
    /// The report could not be made.
    #[error(transparent)]
    Report(#[from] crate::report::ReportError),
    /// The simulation refused its parameters.
    #[error(transparent)]
    Model(#[from] impact_oscillator::model::params::ModelError),
    /// The HDF5 writer failed.
    #[error(transparent)]
    Hdf5(#[from] labfiles::hdf5_write::WriteError),
}

impl PipelineError {
    /// What the user can do.
    pub fn remedy(&self) -> String {
        match self {
            Self::Output(error) => error.remedy().to_owned(),
            Self::Read(error) => error.remedy.clone(),
            Self::Store { .. } => {
                "run the stage before again: ingest, classify, identify, report".to_owned()
            }
            Self::NothingUsable(_) => {
                "run `impactid check` on the campaign; it lists what is wrong with each record"
                    .to_owned()
            }
            Self::Look { .. } => {
                "name the template, the words and the logo as they lie on the disk, mend them, or \
                 leave them out"
                    .to_owned()
            }
            Self::Hdf5(error) => error.remedy().to_owned(),
            Self::Report(_) => "mend the template or the logo, or leave them out".to_owned(),
            Self::Model(_) => "choose parameters within the range that the message names".into(),
            _ => "this should not happen: please report it with the command line".to_owned(),
        }
    }
}

/// What is known after all records were looked at.
#[derive(Debug, Clone)]
pub struct Observed {
    /// One entry a record, in the order of acquisition.
    pub observations: Vec<Observation>,
    /// The brackets of boundaries.
    pub brackets: Vec<Bracket>,
}

impl Observed {
    /// Observe all records of a campaign.
    ///
    /// # Errors
    /// [`PipelineError::NothingUsable`] where no record can be used.
    pub fn of(campaign: &ResolvedCampaign, progress: Progress) -> Result<Self, PipelineError> {
        Self::from_observations(observe::observe_all(campaign, progress))
    }

    /// Observe all records of a campaign, keeping what is done where they are many.
    ///
    /// # Errors
    /// As [`Observed::of`], and where a checkpoint cannot be written.
    fn resumable(
        campaign: &ResolvedCampaign,
        destination: &Destination<'_>,
        progress: Progress,
    ) -> Result<Self, PipelineError> {
        if campaign.records.len() < destination.keep_from {
            return Self::of(campaign, progress);
        }
        let kept = Checkpoint::open(campaign, destination.out, destination.resume)?;
        let chunk = checkpoint::chunk_of(campaign.records.len());
        let observations = observe::observe_in_chunks(campaign, &kept, chunk, progress)?;
        Self::from_observations(observations)
    }

    fn from_observations(mut observations: Vec<Observation>) -> Result<Self, PipelineError> {
        scale_drives(&mut observations);
        if observations.iter().all(Observation::excluded) {
            return Err(PipelineError::NothingUsable(observations.len()));
        }
        let brackets = brackets(&observations);
        Ok(Self {
            observations,
            brackets,
        })
    }
}

/// Where a run's results go.
#[derive(Debug, Clone, Copy)]
pub struct Destination<'a> {
    /// The output folder.
    pub out: &'a Path,
    /// Whether to take over what a run that was broken off left there.
    pub resume: bool,
    /// Campaigns of so many records or more keep their observations while they are made;
    /// [`checkpoint::FEWEST`] is where that pays.
    pub keep_from: usize,
    /// The command as the report states it.
    pub command_line: &'a str,
}

/// Run everything: campaign to report, all results into a folder.
///
/// # Errors
/// [`PipelineError`] where no record is usable or an output cannot be written; single bad records
/// only flag themselves.
pub fn run(
    campaign: &ResolvedCampaign,
    destination: &Destination<'_>,
    progress: Progress,
) -> Result<Verdict, PipelineError> {
    let Destination {
        out, command_line, ..
    } = *destination;
    if let Some(published) = &campaign.published {
        return published::run(campaign, published, out, command_line);
    }
    let observed = Observed::resumable(campaign, destination, progress)?;
    progress("identify", 0, 1);
    let found = identify::identify(campaign, &observed)?;
    progress("report", 0, 1);
    let report = report::files(campaign, &observed, &found, command_line)?;
    progress("write", 0, 1);
    store::write_resolved(campaign, out)?;
    tables::write_all(&observed, out)?;
    identify::write(&found, out)?;
    report::write(&report, out)?;
    checkpoint::remove(out);
    Ok(found.identification.verdict)
}
