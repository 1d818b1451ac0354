//! What a comparison states of itself: why a nuisance is shared or not, and what to keep in mind.

use serde::{Deserialize, Serialize};
use strum::IntoEnumIterator;

use crate::identify::VerdictKind;
use crate::identify::parameters::coordinate::Coordinate;
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
pub enum Remark {
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
pub enum Outcome {
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

messages!(WhyShared, NotShared, Remark, Outcome);

message_table! { Outcome;
    Self::NothingChanged => "No change found", "Keine Änderung gefunden";
    Self::Changed { parameters } =>
        "Changed: {parameters}",
        "Geändert: {parameters}",
        parameters = Value::list(parameters);
    Self::ChangedTogether =>
        "Something changed, though no parameter alone shows it",
        "Etwas hat sich geändert, auch wenn es kein Parameter allein zeigt";
    Self::Undetermined =>
        "Whether anything changed cannot be determined",
        "Ob sich etwas geändert hat, ist nicht zu entscheiden";
}

message_table! { WhyShared;
    Self::StatedAsShared => "stated under shared", "unter shared angegeben";
    Self::SameInstrument { instrument } =>
        "the same instrument: {instrument}",
        "dasselbe Gerät: {instrument}",
        instrument = Value::Name(instrument);
    Self::OneCampaign => "measured in one campaign", "in einer Messreihe gemessen";
}

message_table! { NotShared;
    Self::OtherInstrument { first, second } =>
        "the instruments differ: {first}, {second}",
        "verschiedene Geräte: {first}, {second}",
        first = Value::Name(first), second = Value::Name(second);
    Self::OtherRig { first, second } =>
        "the rigs differ: {first}, {second}",
        "verschiedene Prüfstände: {first}, {second}",
        first = Value::Name(first), second = Value::Name(second);
    Self::StatedOtherwise =>
        "the value that it is an error of is stated otherwise",
        "der Wert, dessen Fehler es ist, ist verschieden angegeben";
    Self::StatedByOne =>
        "stated under shared by one of the campaigns alone",
        "nur von einer der Messreihen unter shared angegeben";
}

message_table! { Remark;
    Self::CampaignDoesNotFit { campaign, .. } =>
        "the model does not describe the data of {campaign}: its differences may be off by more \
         than their intervals; read its own report first",
        "das Modell beschreibt die Daten von {campaign} nicht: die Unterschiede können um mehr als \
         ihre Intervalle falsch sein; zuerst den Bericht dazu lesen",
        campaign = Value::Name(campaign);
    Self::NoJointFit { campaign } =>
        "{campaign} rests on no joint fit: its errors are taken as independent",
        "{campaign} beruht auf keiner gemeinsamen Anpassung: die Fehler gelten als unabhängig",
        campaign = Value::Name(campaign);
    Self::NothingShared =>
        "nothing is shared, so the campaigns' errors add: state shared under [rig] what stayed the \
         same, or the instruments' serial numbers",
        "nichts ist gemeinsam, daher addieren sich die Fehler der Messreihen: unter [rig] mit \
         shared angeben, was gleich geblieben ist, oder die Seriennummern der Geräte";
}

/// One message of each kind of a comparison, its values at their defaults.
pub fn kinds() -> Vec<Box<dyn Message>> {
    boxed(WhyShared::iter())
        .chain(boxed(NotShared::iter()))
        .chain(boxed(Remark::iter()))
        .chain(boxed(Outcome::iter()))
        .collect()
}
