//! What an answer rests on without being stated, and why there may be none: the notes of `impactid check` that the
//! commands that identify print too.

use super::Verbosity;
use super::failure::print_diagnostics;
use super::speech::Speech;
use impact_campaign::campaign::check;
use impact_campaign::campaign::diagnostic::{Diagnostic, Diagnostics};
use impact_campaign::campaign::resolved::ResolvedCampaign;
use impact_records::motion::Observation;
use impact_records::record::FlagCode;

/// Print that a unit of time was assumed, that no clearance is stated, and that nothing is by which the records could be
/// identified.
pub(super) fn print_premises(
    campaign: &ResolvedCampaign,
    observations: &[Observation],
    speech: &Speech,
    verbosity: Verbosity,
) {
    if !verbosity.is_quiet() {
        print_diagnostics(
            &premises(campaign, observations),
            speech.words().as_ref(),
            verbosity,
        );
    }
}

fn premises(campaign: &ResolvedCampaign, observations: &[Observation]) -> Diagnostics {
    let each = campaign.records.iter().zip(observations);
    let assumed = each.flat_map(|(entry, o)| {
        let flags = o.flags.iter();
        let assumed = flags.filter(|f| f.code == FlagCode::TimeUnitAssumed);
        assumed.map(|f| Diagnostic::of_flag(&entry.file, &o.record, f))
    });
    let nothing = check::nothing_stated(campaign, observations);
    let clearance = check::clearance_unstated(campaign, observations);
    Diagnostics(assumed.chain(nothing).chain(clearance).collect())
}
