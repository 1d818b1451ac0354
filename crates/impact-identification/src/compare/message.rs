//! What a comparison states of itself: why a nuisance is shared or not, and what to keep in mind.

use serde::{Deserialize, Serialize};
use strum::IntoEnumIterator;

use impact_fit::VerdictKind;
use impact_fit::parameters::coordinate::Coordinate;
use impact_records::message::{Message, Value, boxed};
use impact_records::{message_table, messages};

/// Why a nuisance is one unknown of several campaigns.
#[derive(
    Debug, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum WhyShared {
    /// All of them state it.
    StatedAsShared,
    /// The channels have the same instrument.
    SameInstrument {
        /// The instrument as stated.
        instrument: String,
    },
    /// They are specimens of one campaign.
    OneCampaign,
}

/// Why a nuisance that might have been shared is an unknown of each campaign.
#[derive(
    Debug, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum NotShared {
    /// Stated as shared, but the instruments differ.
    OtherInstrument {
        /// The one's.
        first: String,
        /// The other's.
        second: String,
    },
    /// Stated as shared, but of rigs of different names.
    OtherRig {
        /// The one's.
        first: String,
        /// The other's.
        second: String,
    },
    /// The scale, the corner, the delay or the masses are stated otherwise, so that the errors about
    /// them differ.
    StatedOtherwise,
    /// One campaign states it, the other does not.
    StatedByOne,
}

/// What to keep in mind about the differences.
#[derive(
    Debug, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum ComparisonRemark {
    /// The model does not describe a campaign's data.
    CampaignDoesNotFit {
        /// The campaign.
        campaign: String,
        /// The verdict on it.
        verdict: VerdictKind,
    },
    /// A campaign has no joint fit, so that nothing of it is shared.
    NoJointFit {
        /// The campaign.
        campaign: String,
    },
    /// Nothing is shared although the campaigns might.
    NothingShared,
}

/// Whether anything changed.
#[derive(
    Debug, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum ComparisonOutcome {
    /// The differences are no greater than chance makes them.
    NothingChanged,
    /// These parameters did.
    Changed {
        /// Those that show it alone.
        parameters: Vec<Coordinate>,
    },
    /// Something did, though no parameter alone shows it.
    ChangedTogether,
    /// It cannot be determined.
    Undetermined,
}

messages!(WhyShared, NotShared, ComparisonRemark, ComparisonOutcome);

message_table! { "outcome": ComparisonOutcome;
    Self::Changed { parameters } => parameters = Value::list(parameters);
}

message_table! { "why_shared": WhyShared;
    Self::SameInstrument { instrument } => instrument = Value::Name(instrument);
}

message_table! { "not_shared": NotShared;
    Self::OtherInstrument { first, second } =>
        first = Value::Name(first),
        second = Value::Name(second);
    Self::OtherRig { first, second } => first = Value::Name(first), second = Value::Name(second);
}

message_table! { "compare_remark": ComparisonRemark;
    Self::CampaignDoesNotFit { campaign, .. } => campaign = Value::Name(campaign);
    Self::NoJointFit { campaign } => campaign = Value::Name(campaign);
}

/// One message of each kind of a comparison, its values at their defaults.
pub fn kinds() -> Vec<Box<dyn Message>> {
    boxed(WhyShared::iter())
        .chain(boxed(NotShared::iter()))
        .chain(boxed(ComparisonRemark::iter()))
        .chain(boxed(ComparisonOutcome::iter()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::message::faults;

    #[test]
    fn every_message_has_its_texts() {
        assert_eq!(faults(&kinds()), Vec::<String>::new());
    }
}
