//! What a comparison is called, what stands under it, and its data.

use crate::report::content::Comparison;
use crate::report::figures::csv::Csv;
use crate::report::figures::look::NumberLook;

/// What stands under a comparison, with markup.
pub fn caption(comparison: &Comparison, numbers: NumberLook) -> String {
    let mut text = format!("Point ({})", comparison.letter);
    if comparison.drive_period_s.is_some() {
        text.push_str(&format!(", $z$ = {}", comparison.motion.label()));
    }
    if let (Some(eta), Some(rho)) = (comparison.eta, comparison.rho) {
        let (eta, rho) = (numbers.fixed(eta, 3), numbers.fixed(rho, 3));
        text.push_str(&format!(", at $η$ = {eta}, $ρ$ = {rho}"));
    }
    text.push_str(&format!("; record {}.", comparison.record));
    let simulated = comparison.simulated_motion.as_ref();
    if let Some(other) = simulated.filter(|m| **m != comparison.motion) {
        text.push_str(&format!(" The simulated motion is {}.", other.label()));
    }
    if !comparison.note.is_empty() {
        text.push_str(&format!(" {}", comparison.note));
    }
    text
}

/// Name of a comparison's figure.
pub fn name(comparison: &Comparison) -> String {
    let letter = comparison.letter.chars();
    let letter: String = letter
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' })
        .collect();
    format!("comparison_{letter}")
}

/// All traces as CSV.
pub fn csv(comparison: &Comparison) -> String {
    let mut csv = Csv::new(&["channel", "source", "time_s", "value_si"]);
    for trace in &comparison.traces {
        let sources = [
            ("measured", &trace.measured),
            ("simulated", &trace.simulated),
            ("residual", &trace.residual),
        ];
        for (source, signal) in sources {
            let Some(signal) = signal else { continue };
            for (t, v) in signal.time_s.iter().zip(&signal.values) {
                csv.row()
                    .texts(&[trace.role.name(), source])
                    .numbers(&[Some(*t), Some(*v)]);
            }
        }
    }
    csv.finish()
}
