//! The methods of identification.

use serde::{Deserialize, Serialize, Serializer};

use impact_records::language::Language;
use impact_records::message::Message;
use impact_records::message_table;

/// A method of identification.
#[derive(
    Debug,
    Default,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    strum::EnumIter,
    strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Brackets of s2, s1 and grazing.
    #[default]
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
        self.into()
    }
}

/// What gives an estimate: a method alone, or the joint fit of all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Estimator {
    /// One method.
    Method(Method),
    /// The joint fit.
    Joint,
}

impl Estimator {
    /// The method's name, or `joint`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Method(method) => method.name(),
            Self::Joint => "joint",
        }
    }
}

impl Serialize for Estimator {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

message_table! { "method": Method; }

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.template(Language::default()))
    }
}
