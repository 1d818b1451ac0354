//! campaign.toml as the commands load it.

use std::path::Path;

use super::failure::print_diagnostics;
use super::read_log::ReadLog;
use super::speech::Speech;
use super::{Failure, Verbosity};
use impact_campaign::campaign::diagnostic::{Diagnostics, Severity};
use impact_campaign::campaign::load;
use impact_campaign::campaign::resolved::ResolvedCampaign;

/// The resolved campaign; problems that stop it are an error, the others are printed (notes only
/// with `-v`).
///
/// # Errors
/// [`Failure::Campaign`] with every problem found.
pub(super) fn load_campaign(
    path: &Path,
    verbosity: Verbosity,
) -> Result<ResolvedCampaign, Failure> {
    let log = ReadLog::new(verbosity);
    let outcome = load(path, &|path| log.open(path));
    log.print();
    let Some(campaign) = outcome.campaign else {
        return Err(outcome.diagnostics.into());
    };
    let mut worth_printing = outcome.diagnostics.0;
    if !verbosity.is_detailed() {
        worth_printing.retain(|d| d.severity > Severity::Note);
    }
    if !verbosity.is_quiet() {
        let speech = Speech::of(&campaign.report).unwrap_or_default();
        print_diagnostics(
            &Diagnostics(worth_printing),
            speech.words().as_ref(),
            verbosity,
        );
    }
    Ok(campaign)
}
