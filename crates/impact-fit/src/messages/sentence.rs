//! The sentences of a verdict.

use serde::{Deserialize, Serialize};

use crate::parameters::Coordinate;
use impact_records::message::{Message, Value};
use impact_records::signal::digits::decimals_for;
use impact_records::{message_table, messages};

/// A parameter with its value as a sentence states it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StatedValue {
    /// The parameter.
    pub parameter: Coordinate,
    /// Its value, SI.
    pub value: f64,
    /// Half its 95 % interval, SI.
    pub half_width: f64,
}

impl Message for StatedValue {
    fn table(&self) -> &'static str {
        "value"
    }

    fn kind(&self) -> &'static str {
        "stated_value"
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        let (scale, unit) = printed_in(self.parameter);
        let (value, half) = (scale * self.value, scale * self.half_width);
        let decimals = decimals_for(half);
        vec![
            ("parameter", Value::Message(&self.parameter)),
            ("value", Value::Number(value, decimals)),
            ("half", Value::Number(half, decimals)),
            ("unit", Value::Name(unit)),
        ]
    }
}

/// By what a parameter in SI is multiplied where it is printed, and the unit behind it.
pub(super) fn printed_in(parameter: Coordinate) -> (f64, &'static str) {
    match parameter {
        Coordinate::Frequency => (1.0, " Hz"),
        Coordinate::Deflection => (1e3, " mm"),
        _ => (1.0, ""),
    }
}

/// A sentence of a verdict.
#[derive(
    Debug, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum Sentence {
    /// All parameters are identified.
    Identified {
        /// Their values.
        values: Vec<StatedValue>,
    },
    /// Some parameters are identified only weakly.
    Weak {
        /// All values.
        values: Vec<StatedValue>,
        /// The weak parameters.
        parameters: Vec<Coordinate>,
    },
    /// Some parameters are not identifiable.
    PartlyIdentifiable {
        /// The values of the others.
        values: Vec<StatedValue>,
        /// The parameters without a value.
        parameters: Vec<Coordinate>,
    },
    /// No parameter is identifiable.
    NotIdentifiable {
        /// The parameters that were asked for.
        parameters: Vec<Coordinate>,
    },
    /// No record is usable for any method.
    NothingUsable,
    /// The model does not describe the data.
    DoesNotFit,
    /// The methods agree.
    MethodsAgree,
    /// They do not.
    MethodsDoNotAgree,
    /// Each parameter is determined by one method only.
    OneMethod,
    /// The campaign holds several specimens.
    Specimens {
        /// How many.
        count: usize,
    },
    /// How many specimens the model fits.
    SpecimensFit {
        /// How many it fits.
        fitting: usize,
        /// Of how many.
        count: usize,
    },
    /// A parameter is only weakly identified in some specimens.
    SpecimensPoorlyKnown {
        /// The parameter.
        parameter: Coordinate,
        /// In how many specimens.
        count: usize,
    },
    /// Records look misfiled.
    MisfiledRecords {
        /// How many.
        count: usize,
    },
    /// Published speeds belong to a damping ratio.
    PublishedDamping {
        /// The damping ratio.
        damping_ratio: f64,
    },
    /// No damping ratio gives the published speeds.
    NoPublishedDamping,
}

messages!(Sentence);

message_table! { "sentence": Sentence;
    Self::Identified { values } => values = Value::list(values);
    Self::Weak { values, parameters } =>
        values = Value::list(values),
        parameters = Value::list(parameters);
    Self::PartlyIdentifiable { values, parameters } =>
        values = Value::list(values),
        parameters = Value::list(parameters);
    Self::NotIdentifiable { parameters } => parameters = Value::list(parameters);
    Self::Specimens { count } => count = Value::Count(*count);
    Self::SpecimensFit { fitting, count } =>
        some = Value::Count(*fitting),
        count = Value::Count(*count);
    Self::SpecimensPoorlyKnown { parameter, count } =>
        parameter = Value::Message(parameter),
        count = Value::Count(*count);
    Self::MisfiledRecords { count } => count = Value::Count(*count);
    Self::PublishedDamping { damping_ratio } => value = Value::Number(*damping_ratio, 4);
}

impl Sentence {
    /// Whether the methods agree; `None` if there is nothing to compare.
    pub fn on_agreement(agree: Option<bool>) -> Self {
        match agree {
            Some(true) => Self::MethodsAgree,
            Some(false) => Self::MethodsDoNotAgree,
            None => Self::OneMethod,
        }
    }
}
