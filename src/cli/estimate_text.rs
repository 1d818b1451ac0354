//! Estimates in a line of the terminal.

use impact_fit::{Estimate, Status};
use impact_records::message::{Print, Value};
use impact_records::message_table;
use impact_records::signal::digits::decimals_for;

/// An estimate as a line has it.
#[derive(Debug, Clone, Copy, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
enum EstimateText {
    /// Its value, half of its 95 % interval, and their decimals.
    Known(f64, f64, usize),
    /// The same of a weak one.
    WeakValue(f64, f64, usize),
    /// None.
    NoValue,
}

message_table! { "estimate": EstimateText;
    Self::Known(value, half, decimals) | Self::WeakValue(value, half, decimals) =>
        value = Value::Number(*value, *decimals),
        half = Value::Number(*half, *decimals);
}

/// A value with half of its 95 % interval.
pub(super) fn with_error(estimate: &Estimate, words: &dyn Print) -> String {
    let (Some(value), Some([low, high])) = (estimate.value, estimate.interval95) else {
        return words.print(&EstimateText::NoValue);
    };
    let half = 0.5 * (high - low);
    let decimals = decimals_for(half);
    words.print(&match estimate.status {
        Status::Weak => EstimateText::WeakValue(value, half, decimals),
        Status::Identified | Status::NotIdentifiable => EstimateText::Known(value, half, decimals),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::message::{Typed, boxed, faults};

    #[test]
    fn every_form_of_an_estimate_has_its_texts() {
        let all = boxed(<EstimateText as strum::IntoEnumIterator>::iter());
        assert_eq!(faults(&all.collect::<Vec<_>>()), Vec::<String>::new());
    }

    #[test]
    fn a_value_has_as_many_decimals_as_its_uncertainty() {
        let estimate = |value, half: f64, status| Estimate {
            value: Some(value),
            standard_error: Some(0.5 * half),
            interval95: Some([value - half, value + half]),
            status,
            note: None,
        };
        let text = |value, half, status| with_error(&estimate(value, half, status), &Typed);
        assert_eq!(text(0.9, 0.0123, Status::Identified), "0.900 ± 0.012");
        assert_eq!(text(12.6, 2.0, Status::Weak), "12.6 ± 2.0 (weak)");
        assert_eq!(text(0.9, 0.0, Status::Identified), "0.9000 ± 0.0000");
        let open = Estimate {
            value: None,
            interval95: None,
            ..estimate(0.0, 1.0, Status::NotIdentifiable)
        };
        assert_eq!(with_error(&open, &Typed), "not identifiable");
    }
}
