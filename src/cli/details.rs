//! What `-v` and `-vv` print of records and fits.

use super::Verbosity;
use impact_fit::Estimator;
use impact_identification::identify::Identification;
use impact_records::motion::Observation;

/// Print how each fit ended, with `-v`.
pub(super) fn print_fits(identification: &Identification, verbosity: Verbosity) {
    let methods = identification.methods.iter();
    let methods = methods.map(|(method, result)| (Estimator::Method(*method), result));
    for (estimator, result) in methods.chain([(Estimator::Joint, &identification.joint)]) {
        if let Some(report) = &result.fit_report {
            verbosity.detail(&format!("fit of {}: {report}", estimator.name()));
        }
    }
}

/// Print the classification of each record, with `-vv`.
pub(super) fn print_records(observations: &[Observation], verbosity: Verbosity) {
    if verbosity.is_everything() {
        let lines = observations.iter().map(record_line);
        lines.for_each(|line| verbosity.everything(&line));
    }
}

/// One record: setting, motion with its confidence, impacts and flags.
fn record_line(o: &Observation) -> String {
    let frequency = o.frequency_hz().map(|f| format!(" {f:.4} Hz,"));
    let clearance = o
        .setting
        .clearance_m
        .map(|c| format!(" {:.4} mm,", 1e3 * c));
    let mut line = format!(
        "{}:{}{} motion {}, confidence {:.2}, impacts: {}",
        o.record,
        frequency.unwrap_or_default(),
        clearance.unwrap_or_default(),
        o.classification.motion.label(),
        o.classification.confidence,
        o.impacts.len()
    );
    for flag in &o.flags {
        let channel = flag.channel.as_deref().map(|c| format!(" ({c})"));
        line += &format!(
            "; {}{}: {}",
            flag.code,
            channel.unwrap_or_default(),
            flag.message()
        );
    }
    if o.excluded() {
        line += "; left out";
    }
    line
}
