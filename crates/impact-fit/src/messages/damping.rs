//! What changes a damping ratio along a decay.

use serde::{Deserialize, Serialize};

use crate::statistics::quantile::NORMAL_975;
use impact_records::message::{Message, Value};
use impact_records::signal::decay::PartOfDecay;
use impact_records::signal::digits::decimals_for;

/// The damping ratio of a part of a decay.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DampingPoint {
    /// Amplitude in the middle of the part over that of the first part.
    pub amplitude_ratio: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Half its 95 % interval.
    pub half_width: f64,
}

impl DampingPoint {
    /// Of the parts of a decay.
    pub fn of(parts: &[PartOfDecay]) -> Vec<Self> {
        let first = parts.first().map_or(1.0, |p| p.amplitude);
        let point = |part: &PartOfDecay| Self {
            amplitude_ratio: part.amplitude / first,
            damping_ratio: part.damping_ratio,
            half_width: NORMAL_975 * part.damping_ratio_error,
        };
        parts.iter().map(point).collect()
    }
}

impl Message for DampingPoint {
    fn table(&self) -> &'static str {
        "value"
    }

    fn kind(&self) -> &'static str {
        "damping_point"
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        let decimals = decimals_for(self.half_width);
        vec![
            ("value", Value::Number(self.damping_ratio, decimals)),
            ("half", Value::Number(self.half_width, decimals)),
            ("share", Value::Percent(self.amplitude_ratio, 0)),
        ]
    }
}
