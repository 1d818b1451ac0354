//! All stages in one run.

use std::path::Path;

use super::error::{PipelineError, Progress};
use super::identify::IdentificationFile;
use super::observed::Observed;
use super::{checkpoint, identify, memory, published, report, store, tables};
use crate::campaign::resolved::ResolvedCampaign;
use impact_fit::solver::FitProgress;
use impact_identification::identify::Identification;
use impact_records::motion::Observation;
use impact_report::Format;
use labfiles_write::output::WrittenBeside;

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
    /// A format of the report beside those that the campaign asks for.
    pub also: Option<Format>,
    /// Counts the iterations of the fits.
    pub fits: &'a FitProgress,
}

/// What a run found, all of it written already.
#[derive(Debug, Clone)]
pub struct Completed {
    /// The records without their waveforms; none for published speeds.
    pub observations: Vec<Observation>,
    /// The parameters.
    pub identification: Identification,
    /// Files of the report that are beside one of their name that another program holds.
    pub beside: Vec<WrittenBeside>,
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
        let (identification, beside) = published::run(campaign, published, out, command_line)?;
        return Ok(Completed {
            observations: Vec::new(),
            identification,
            beside,
        });
    }
    let observed = if campaign.records.len() < destination.keep_from {
        Observed::of(campaign, progress)?
    } else {
        Observed::resumable(campaign, out, destination.resume, progress)?
    };
    complete(campaign, observed, None, destination, progress)
}

/// Everything after observing: fits, unless they are made already, report, and all outputs.
///
/// # Errors
/// As [`run`].
pub(super) fn complete(
    campaign: &ResolvedCampaign,
    mut observed: Observed,
    found: Option<IdentificationFile>,
    destination: &Destination<'_>,
    progress: Progress<'_>,
) -> Result<Completed, PipelineError> {
    let out = destination.out;
    progress("identify", 0, 1);
    let found = match found {
        Some(found) => found,
        None => identify::identify(campaign, &observed, Some(destination.fits))?,
    };
    progress("report", 0, 1);
    let content = report::content(campaign, &observed, &found, destination.command_line)?;
    // nothing looks at the waveforms any more, and the document takes room
    observed.drop_waveforms();
    memory::release();
    let report = report::drawn(&content, campaign)?;
    // of the document a part is set on one thread alone
    let (report, tables) = rayon::join(
        || report::in_formats(&report, campaign, destination.also),
        || tables::files(&observed),
    );
    let (report, tables) = (report?, tables?);
    progress("write", 0, 1);
    let written = store::forget(out)
        .and_then(|()| store::write_resolved(campaign, out))
        .and_then(|()| tables::write(&tables, out))
        .and_then(|()| identify::write(&found, out))
        .and_then(|()| report::write(&report, out))
        .and_then(|beside| store::keep(&observed, &found, out).map(|()| beside));
    let beside = match written {
        Ok(beside) => beside,
        Err(error) => {
            return Err(PipelineError::AnswerUnwritten {
                answer: Box::new(found.identification),
                source: Box::new(error),
            });
        }
    };
    checkpoint::remove(out);
    report::remove_live_state(out);
    Ok(Completed {
        observations: observed.observations,
        identification: found.identification,
        beside,
    })
}
