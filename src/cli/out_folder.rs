//! A folder holds the results of one kind of work: files of two would lie beside each other, and none would say which
//! belong together.

use std::path::Path;

use super::{Failure, interrupt};
use impact_campaign::campaign::resolved::ResolvedCampaign;
use impact_campaign::pipeline::resolved_file::read_resolved;
use impact_campaign::pipeline::{campaigns, identify, plan};
use labfiles_write::output::Lock;

/// Work that writes into a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Work {
    /// The identification of a campaign.
    Identification,
    /// The comparison of campaigns.
    Comparison,
    /// A plan of further settings.
    Plan,
    /// The simulation of a campaign.
    Simulation,
    /// A study of the theory.
    Study,
}

/// Name of the study beside its results; it is written last, so its presence marks complete results.
pub(super) const COPY: &str = "study.toml";

/// The file that marks the results of each work.
const MARKS: [(Work, &str); 4] = [
    (Work::Identification, identify::FILE),
    (Work::Comparison, campaigns::COMPARISON),
    (Work::Plan, plan::FILE),
    (Work::Study, COPY),
];

/// The right to write into a folder for a work.
///
/// # Errors
/// [`Failure`] where the folder holds results of other work or is written into.
pub(super) fn take(folder: &Path, work: Work) -> Result<Lock, Failure> {
    let lock = interrupt::lock(folder)?;
    let others = MARKS.iter().filter(|(of, _)| *of != work);
    let mut held = others.map(|(_, mark)| folder.join(mark));
    match held.find(|mark| mark.exists()) {
        Some(held) => Err(of_other_work(folder, &held)),
        None => Ok(lock),
    }
}

/// The right to write results of a campaign into a folder.
///
/// # Errors
/// [`Failure`] where the folder holds results of other work or of another campaign, or is written into.
pub(super) fn take_for(folder: &Path, campaign: &ResolvedCampaign) -> Result<Lock, Failure> {
    let lock = take(folder, Work::Identification)?;
    match read_resolved(folder) {
        Ok(held) if is_other(&held.file, &campaign.file) => Err(of_other_work(folder, &held.file)),
        _ => Ok(lock),
    }
}

/// Whether the description of a campaign whose results are held is there, and is not that of another one.
fn is_other(held: &Path, own: &Path) -> bool {
    let real = |path: &Path| path.canonicalize().ok();
    real(held).is_some_and(|held| Some(held) != real(own))
}

/// That a folder holds results of other work, by the file that marks them.
pub(super) fn of_other_work(folder: &Path, held: &Path) -> Failure {
    Failure::new(
        format!(
            "{} holds results of other work ({})",
            folder.display(),
            held.display()
        ),
        "name another folder with --out, or remove this one first",
    )
}
