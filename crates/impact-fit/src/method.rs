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
    #[serde(rename = "multiple_shooting")]
    #[strum(serialize = "multiple_shooting")]
    Flights,
    /// Times between impacts under a constant force.
    FlightTimes,
    /// Free decays.
    FreeDecay,
    /// Speeds at impacts.
    #[serde(rename = "speeds_at_impact")]
    #[strum(serialize = "speeds_at_impact")]
    Impacts,
    /// Approach speeds as a paper prints them.
    PublishedSpeeds,
    /// The resonance curve of the records without impacts.
    #[serde(rename = "resonance_curve")]
    #[strum(serialize = "resonance_curve")]
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

    /// Those each item of whose block is one record, which can be left out or compared by itself.
    pub const BY_RECORD: [Self; 2] = [Self::Resonance, Self::Trajectories];

    /// Those whose residuals are kept: of records and of impacts.
    pub const WITH_RESIDUALS: [Self; 3] = [Self::Resonance, Self::Trajectories, Self::Impacts];

    /// Those whose R is that of single impacts, speeds before times.
    pub const OF_SINGLE_IMPACTS: [Self; 2] = [Self::Impacts, Self::FlightTimes];

    /// Whether impacts act on what it observes.
    pub fn observes_impacts(self) -> bool {
        !matches!(self, Self::Resonance | Self::FreeDecay)
    }

    /// Whether it takes a motion for settled: the others follow one from impact to impact, or from turn to turn,
    /// whether it has settled or not.
    pub fn observes_settled_motion(self) -> bool {
        matches!(
            self,
            Self::Resonance | Self::Trajectories | Self::Boundaries
        )
    }

    /// Whether its R is that of the bodies as a whole, not that at the contact.
    pub fn observes_whole_bodies(self) -> bool {
        matches!(self, Self::Trajectories | Self::Boundaries)
    }

    /// Whether it observes the response without impacts.
    pub fn observes_response(self) -> bool {
        self.observes_settled_motion() && !self.observes_impacts()
    }

    /// Whether it observes where motions end.
    pub fn observes_boundaries(self) -> bool {
        self == Self::Boundaries
    }

    /// Whether its R is that at the contact, by the speeds there.
    pub fn observes_contact(self) -> bool {
        self == Self::Impacts
    }

    /// Whether it has no effects beyond the model, so that it is no witness where the rig has any.
    pub fn takes_rig_for_ideal(self) -> bool {
        self == Self::Flights
    }

    /// Name in `identification.json`: that of the report.
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
