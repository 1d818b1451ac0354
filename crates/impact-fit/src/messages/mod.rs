//! What an identification states: notes on parameters, remarks of methods, reasons why something was
//! left out, findings, and the sentences of the verdict; each a variant with its numbers in SI.

pub mod cause;
mod damping;
mod direction;
mod finding;
mod heights_cause;
mod kinds;
mod note;
mod pair;
mod reason;
mod remark;
mod sentence;

pub use damping::DampingPoint;
pub use finding::{Finding, PublishedSetting};
pub use heights_cause::HeightsCause;
pub use kinds::{kinds, labels};
pub use note::Note;
pub use pair::PairAgreement;
pub use reason::{Item, LeftOut, Reason};
pub(crate) use remark::ONE_DEGREE_OF_FREEDOM;
pub use remark::{GroupPoint, Remark, SpeedPoint};
pub use sentence::{Sentence, StatedValue};

use crate::parameters::effect::{Effect, EffectKind};
use crate::parameters::{Coordinate, GAIN_ROLES};
use impact_records::language::Language;
use impact_records::message::{Message, Value};
use impact_records::message_table;

impl Message for Coordinate {
    fn table(&self) -> &'static str {
        match self {
            Self::Effect(effect) => effect.table(),
            _ => "coordinate",
        }
    }

    fn kind(&self) -> &'static str {
        self.name()
    }

    fn key(&self) -> String {
        let name = match self {
            Self::Gain(_) => "gain",
            Self::Corner(_) => "corner",
            Self::Delay(_) => "delay",
            Self::Gap(_) => "clearance_error",
            Self::Effect(effect) => return effect.key(),
            other => other.name(),
        };
        name.to_owned()
    }

    /// Its symbol, which is that of every language, or its name.
    fn template(&self, language: Language) -> &'static str {
        let text = |of: Language| of.own_text(self.table(), &self.key());
        let named = || text(language).or_else(|| text(Language::default()));
        self.symbol().or_else(named).unwrap_or(self.name())
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        match self {
            Self::Gain(i) | Self::Corner(i) | Self::Delay(i) => {
                let role = GAIN_ROLES.get(*i).unwrap_or(&GAIN_ROLES[0]);
                vec![("channel", Value::Message(role))]
            }
            Self::Gap(i) => vec![("number", Value::Count(i + 1))],
            _ => Vec::new(),
        }
    }
}

message_table! { "effect": Effect; }

message_table! { "effect_kind": EffectKind; }
