//! What the sentences about problems of a record have in common.

use serde::{Deserialize, Serialize};

use strum::IntoEnumIterator;

use crate::message::{Message, Value, boxed};
use crate::message_table;
use labfiles::units::Dimension;

/// What a channel measures or should measure.
#[derive(
    Debug, Clone, Copy, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(rename_all = "snake_case")]
pub enum MeasuredQuantity {
    /// A quantity of a dimension.
    Of(Dimension),
    /// How fast something turns.
    AngularRate,
    /// Times of impacts.
    Times,
    /// One that the role accepts.
    Accepted,
    /// The one of its threshold.
    OfThreshold(Dimension),
}

impl Default for MeasuredQuantity {
    fn default() -> Self {
        Self::Of(Dimension::default())
    }
}

message_table! { "quantity": MeasuredQuantity;
    Self::Of(dimension) => dimension = Value::Message(dimension);
    Self::OfThreshold(dimension) => dimension = Value::Message(dimension);
}

impl Message for Dimension {
    fn table(&self) -> &'static str {
        "dimension"
    }

    fn kind(&self) -> &'static str {
        self.name()
    }

    fn key(&self) -> String {
        self.name().replace(' ', "_")
    }
}

/// Units or conventions that are often mistaken for each other.
#[derive(
    Debug,
    Default,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::EnumIter,
    strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(rename_all = "snake_case")]
pub enum MistakenUnits {
    /// m and mm.
    #[default]
    MetresMillimetres,
    /// Hz and kHz.
    HertzKilohertz,
    /// Hz and rad/s.
    HertzRadians,
    /// g and m/s².
    GravityMetres,
    /// RMS and peak.
    RmsPeak,
    /// inch and mm.
    InchMillimetres,
    /// RMS and peak to peak.
    RmsPeakToPeak,
}

message_table! { "mistaken_units": MistakenUnits; }

/// Every dimension.
const DIMENSIONS: [Dimension; 10] = [
    Dimension::Length,
    Dimension::Velocity,
    Dimension::Acceleration,
    Dimension::Force,
    Dimension::Voltage,
    Dimension::Frequency,
    Dimension::Time,
    Dimension::Mass,
    Dimension::Angle,
    Dimension::Number,
];

/// One message of each part of the sentences about problems.
pub fn parts() -> Vec<Box<dyn Message>> {
    boxed(DIMENSIONS.into_iter())
        .chain(boxed(MeasuredQuantity::iter()))
        .chain(boxed(MistakenUnits::iter()))
        .collect()
}
