//! How two methods agree on a parameter.

use serde::{Deserialize, Serialize};

use crate::messages::sentence::printed_in;
use crate::method::Method;
use crate::parameters::Coordinate;
use impact_records::message::{Message, Value};
use impact_records::signal::digits::decimals_for;

/// The estimates of a parameter by two methods, compared; as a message, how far they are apart.
#[derive(Debug, Default, Clone, PartialEq, Serialize, Deserialize)]
pub struct PairAgreement {
    /// The parameter.
    pub parameter: Coordinate,
    /// The two methods.
    pub methods: [Method; 2],
    /// Their estimates, SI.
    pub values: [f64; 2],
    /// Difference of the estimates over its standard error.
    pub z_score: f64,
    /// Two-sided p-value.
    pub p_value: f64,
}

impl Message for PairAgreement {
    fn table(&self) -> &'static str {
        "agreement"
    }

    fn kind(&self) -> &'static str {
        "pair"
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        let [first, second] = &self.methods;
        let (scale, unit) = printed_in(self.parameter);
        let [value, other] = self.values.map(|value| scale * value);
        // the standard error of their difference
        let decimals = decimals_for(((value - other) / self.z_score).abs());
        vec![
            ("parameter", Value::Message(&self.parameter)),
            ("first", Value::Message(first)),
            ("value", Value::Number(value, decimals)),
            ("second", Value::Message(second)),
            ("other", Value::Number(other, decimals)),
            ("unit", Value::Name(unit)),
            ("distance", Value::Number(self.z_score.abs(), 1)),
        ]
    }
}
