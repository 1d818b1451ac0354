//! A part of an atlas, as `impactid atlas --shard` and the ranks of an MPI run compute it.

use super::Failure;
use super::machine::refused;
use super::theory::study_text;
use impact_oscillator::atlas::shard::{AtlasPart, AtlasRequest, part};
use impact_workbench::theory::Study;
use impact_workbench::theory::plan::RegionsPlan;

/// The atlas' name in its study and its files.
pub(super) const NAME: &str = "atlas";

/// A part of an atlas, with the study of the whole.
///
/// # Errors
/// [`Failure`] where a parameter is out of range.
pub(super) fn computed(
    study: &Study,
    plan: &RegionsPlan,
    number: usize,
    of: usize,
) -> Result<AtlasPart, Failure> {
    let request = AtlasRequest::new(study.machine(), plan.settings());
    let part = part(&request, number, of).map_err(|e| refused(&e))?;
    Ok(AtlasPart {
        study: study_text(study)?,
        ..part
    })
}
