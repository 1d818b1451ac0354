//! Estimates in a line of the terminal.

use impact_fit::{Estimate, Status};
use impact_records::signal::digits::decimals_for;

/// A value with half of its 95 % interval.
pub(super) fn with_error(estimate: &Estimate) -> String {
    let (Some(value), Some([low, high])) = (estimate.value, estimate.interval95) else {
        return "not identifiable".to_owned();
    };
    let half = 0.5 * (high - low);
    let decimals = decimals_for(half);
    let weak = match estimate.status {
        Status::Weak => " (weak)",
        Status::Identified | Status::NotIdentifiable => "",
    };
    format!("{value:.decimals$} ± {half:.decimals$}{weak}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_has_as_many_decimals_as_its_uncertainty() {
        let estimate = |value, half: f64, status| Estimate {
            value: Some(value),
            standard_error: Some(0.5 * half),
            interval95: Some([value - half, value + half]),
            status,
            note: None,
        };
        let text = |value, half, status| with_error(&estimate(value, half, status));
        assert_eq!(text(0.9, 0.0123, Status::Identified), "0.900 ± 0.012");
        assert_eq!(text(12.6, 2.0, Status::Weak), "12.6 ± 2.0 (weak)");
        assert_eq!(text(0.9, 0.0, Status::Identified), "0.9000 ± 0.0000");
        let open = Estimate {
            value: None,
            interval95: None,
            ..estimate(0.0, 1.0, Status::NotIdentifiable)
        };
        assert_eq!(with_error(&open), "not identifiable");
    }
}
