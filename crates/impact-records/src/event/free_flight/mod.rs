//! Impacts between free flights under a constant force: one mass against a stop, or two masses.
//!
//! The approach velocity falls at an impact. The flights beside the fall are the longest stretches
//! that the law of free flight explains, so that a push by hand before, or a catch after, does not
//! enter the speeds.

mod drag;
mod fall;
mod orientation;
mod search;
mod stretch;

use crate::event::contact::Closed;
use crate::event::kinematics::{Kinematics, RelativeSource, RigKind};
use crate::record::{Flag, Problem};

pub(super) use search::FreeFlights;
use search::Search;

/// Detect the impacts. Signs of the channels are taken as the impacts show them: masses cannot
/// attract each other, so a record whose velocity rises at its impacts is measured the other way round.
pub(super) fn detect(kinematics: &Kinematics, rig: RigKind, closed: &[Closed]) -> FreeFlights {
    if rig == RigKind::Double && kinematics.relative_from != Some(RelativeSource::Both) {
        return FreeFlights {
            flags: vec![one_mass_alone()],
            jump_samples: 1,
            ..FreeFlights::default()
        };
    }
    let search = Search::new(kinematics, rig);
    let plain = search.impacts(closed);
    if !plain.impacts.is_empty() {
        return plain;
    }
    let seen = !plain.flags.is_empty() && search.falls_of_all_bodies();
    orientation::search(kinematics, rig, closed, seen).unwrap_or(plain)
}

fn one_mass_alone() -> Flag {
    Flag::new(None, Problem::OtherMassNotMeasured)
}
