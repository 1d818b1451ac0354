//! What an identification states: notes on parameters, remarks of methods, reasons why something was
//! left out, findings, and the sentences of the verdict; each a variant with its numbers in SI.

pub mod cause;
mod damping;
mod direction;
mod finding;
mod kinds;
mod note;
mod pair;
mod reason;
mod remark;
mod sentence;

pub use damping::DampingPoint;
pub use finding::{Finding, PublishedSetting};
pub use kinds::{kinds, labels};
pub use note::Note;
pub use pair::PairAgreement;
pub use reason::{Item, LeftOut, Reason};
pub use remark::{GroupPoint, Remark, SpeedPoint};
pub use sentence::{Sentence, StatedValue};

use crate::parameters::Coordinate;
use crate::parameters::effect::{Effect, EffectKind};
use impact_records::language::Language;
use impact_records::message::Message;
use impact_records::message_table;

impl Message for Coordinate {
    fn table(&self) -> &'static str {
        "coordinate"
    }

    fn kind(&self) -> &'static str {
        self.name()
    }

    /// Its symbol, or its name, in every language.
    fn template(&self, _: Language) -> &'static str {
        self.symbol()
    }
}

message_table! { "effect": Effect; }

message_table! { "effect_kind": EffectKind; }
