//! All stages in one run.

use std::path::Path;

use super::error::{PipelineError, Progress};
use super::observed::Observed;
use super::{checkpoint, identify, published, report, store, tables};
use crate::campaign::resolved::ResolvedCampaign;
use crate::identify::Identification;
use crate::identify::fit::FitProgress;
use crate::motion::Observation;

/// Where a run's results go.
#[derive(Debug, Clone, Copy)]
pub struct Destination<'a> {
    /// The output folder.
    pub out: &'a Path,
    /// Whether to resume an interrupted run there.
    pub resume: bool,
    /// Least number of records for which checkpoints are written;
    /// [`checkpoint::FEWEST`] is where that pays.
    pub keep_from: usize,
    /// The command line for the report.
    pub command_line: &'a str,
    /// Counts the iterations of the fits.
    pub fits: &'a FitProgress,
}

/// What a run found, all of it written already.
#[derive(Debug, Clone)]
pub struct Completed {
    /// The records; none for published speeds.
    pub observations: Vec<Observation>,
    /// The parameters.
    pub identification: Identification,
}

/// Run everything: campaign to report, all results into a folder.
///
/// # Errors
/// [`PipelineError`] if no record is usable or an output cannot be written; bad records are only
/// flagged.
pub fn run(
    campaign: &ResolvedCampaign,
    destination: &Destination<'_>,
    progress: Progress<'_>,
) -> Result<Completed, PipelineError> {
    let Destination {
        out, command_line, ..
    } = *destination;
    if let Some(published) = &campaign.published {
        return Ok(Completed {
            observations: Vec::new(),
            identification: published::run(campaign, published, out, command_line)?,
        });
    }
    let observed = match campaign.records.len() < destination.keep_from {
        true => Observed::of(campaign, progress)?,
        false => Observed::resumable(campaign, (out, destination.resume), progress)?,
    };
    progress("identify", 0, 1);
    let found = identify::identify(campaign, &observed, Some(destination.fits))?;
    progress("report", 0, 1);
    let report = report::files(campaign, &observed, &found, command_line)?;
    progress("write", 0, 1);
    store::write_resolved(campaign, out)?;
    tables::write_all(&observed, out)?;
    identify::write(&found, out)?;
    report::write(&report, out)?;
    checkpoint::remove(out);
    Ok(Completed {
        observations: observed.observations,
        identification: found.identification,
    })
}
