//! The methods of identification.

use serde::{Deserialize, Serialize};

use crate::message::{Language, Message, Value, kind_of};

/// A method of identification.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Brackets of s2, s1 and grazing.
    Boundaries,
    /// Multiple shooting: records followed from impact to impact.
    Flights,
    /// Times between impacts under a constant force.
    FlightTimes,
    /// Free decays.
    FreeDecay,
    /// Speeds at impacts.
    Impacts,
    /// Approach speeds as a paper prints them.
    PublishedSpeeds,
    /// The resonance curve of the records without impacts.
    Resonance,
    /// Waveforms of periodic records.
    Trajectories,
}

impl Method {
    /// The methods that a joint fit may use, in the order of its blocks.
    pub const FITTED: [Self; 5] = [
        Self::Resonance,
        Self::Trajectories,
        Self::Boundaries,
        Self::Impacts,
        Self::Flights,
    ];

    /// Name in `identification.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Boundaries => "boundaries",
            Self::Flights => "flights",
            Self::FlightTimes => "flight_times",
            Self::FreeDecay => "free_decay",
            Self::Impacts => "impacts",
            Self::PublishedSpeeds => "published_speeds",
            Self::Resonance => "resonance",
            Self::Trajectories => "trajectories",
        }
    }
}

impl Message for Method {
    fn kind(&self) -> String {
        kind_of(self)
    }

    fn template(&self, language: Language) -> &'static str {
        use Language::{English, German};
        match (self, language) {
            (Self::Boundaries, English) => "Boundaries",
            (Self::Boundaries, German) => "Grenzen",
            (Self::Flights, English) => "Multiple shooting",
            (Self::Flights, German) => "Mehrfachschießen",
            (Self::FlightTimes, English) => "Flight times",
            (Self::FlightTimes, German) => "Flugzeiten",
            (Self::FreeDecay, English) => "Free decay",
            (Self::FreeDecay, German) => "Ausschwingen",
            (Self::Impacts, English) => "Speeds at impact",
            (Self::Impacts, German) => "Einzelne Stöße",
            (Self::PublishedSpeeds, English) => "Published speeds",
            (Self::PublishedSpeeds, German) => "Veröffentlichte Geschwindigkeiten",
            (Self::Resonance, English) => "Resonance curve",
            (Self::Resonance, German) => "Resonanzkurve",
            (Self::Trajectories, English) => "Trajectories",
            (Self::Trajectories, German) => "Verläufe",
        }
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        Vec::new()
    }
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.template(Language::English))
    }
}
