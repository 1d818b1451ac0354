//! What changes a damping ratio along a decay.

use serde::{Deserialize, Serialize};

use crate::identify::uncertainty::quantile::NORMAL_975;
use crate::message::{Message, Value};
use crate::message_table;
use crate::signal::decay::{DampingLaw, PartOfDecay};

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
    fn kind(&self) -> &'static str {
        "damping_point"
    }

    fn texts(&self) -> [&'static str; 2] {
        ["{value} ± {half} ({share})"; 2]
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        vec![
            ("value", Value::Number(self.damping_ratio, 4)),
            ("half", Value::Number(self.half_width, 4)),
            ("share", Value::Percent(self.amplitude_ratio, 0)),
        ]
    }
}

message_table! { DampingLaw;
    Self::Friction =>
        "dry friction explains it, which adds to $β$ what grows as the amplitude falls",
        "trockene Reibung erklärt es; sie fügt $β$ hinzu, was mit fallender Amplitude wächst";
    Self::Drag =>
        "drag in proportion to the square of the velocity explains it, which adds to $β$ in \
         proportion to the amplitude",
        "ein Widerstand mit dem Quadrat der Geschwindigkeit erklärt es; er fügt $β$ etwas \
         proportional zur Amplitude hinzu";
    Self::Unknown =>
        "neither dry friction nor drag alone explains it: the damping depends on the amplitude or \
         on time in another way",
        "weder trockene Reibung noch Widerstand allein erklärt es: Die Dämpfung hängt anders von \
         der Amplitude oder der Zeit ab";
}
