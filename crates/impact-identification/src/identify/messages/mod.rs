//! What an identification states: notes on parameters, remarks of methods, reasons why something was
//! left out, findings, and the sentences of the verdict; each a variant with its numbers in SI.

mod beyond;
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
pub use kinds::kinds;
pub use note::Note;
pub use pair::PairAgreement;
pub use reason::{Item, LeftOut, Reason};
pub use remark::{GroupPoint, Remark, SpeedPoint};
pub use sentence::{Sentence, StatedValue};

use crate::identify::parameters::Coordinate;
use impact_records::message::Message;

impl Message for Coordinate {
    fn kind(&self) -> &'static str {
        self.name()
    }

    fn texts(&self) -> [&'static str; 2] {
        let symbol = match self {
            Self::Restitution => "$R$",
            Self::Frequency => "$f_0$",
            Self::Damping => "$β$",
            Self::Deflection => "$x_st$",
            other => other.name(),
        };
        [symbol; 2]
    }
}
