//! Whether a deviation is high or low, as a word.

use impact_records::message::Value;
use impact_records::message_table;

/// Whether something is too high or too low.
#[derive(Debug, Clone, Copy, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub(super) enum Direction {
    High,
    Low,
}

/// The direction of a deviation.
pub(super) fn direction(deviation: f64) -> Value<'static> {
    if deviation > 0.0 {
        Value::Message(&Direction::High)
    } else {
        Value::Message(&Direction::Low)
    }
}

message_table! { "direction": Direction; }
