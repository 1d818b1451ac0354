//! What may make R of heights change with the height.

use serde::{Deserialize, Serialize};

use impact_records::message::Value;
use impact_records::message_table;

/// What may make R of heights change with the height.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Serialize,
    Deserialize,
    strum::EnumIter,
    strum::IntoStaticStr,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum HeightsCause {
    /// R that depends on the speed.
    #[default]
    Speed,
    /// Drag of the air, or R that falls with the speed.
    Air {
        /// Half the density of air times area and coefficient of drag over the mass, 1/m.
        drag_per_m: f64,
    },
    /// All heights contain too much, or too little.
    Offset {
        /// How much too much, m.
        offset_m: f64,
    },
}

message_table! { "heights_cause": HeightsCause;
    Self::Air { drag_per_m } => drag = Value::Number(*drag_per_m, 3);
    Self::Offset { offset_m } => offset = Value::Number(1e3 * offset_m, 0);
}
