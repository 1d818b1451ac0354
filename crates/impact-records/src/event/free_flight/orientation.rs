//! Records whose channels are positive the other way round.

use crate::event::contact::Closed;
use crate::event::kinematics::{Body, Kinematics, RigKind, Series};
use crate::record::{Flag, FlagCode, Problem};

use super::search::{FreeFlights, Search};

/// The impacts of a record that is measured the other way round; `None` if it has none then either.
///
/// Where falls of the approach of all bodies were `seen` as it is measured, which only lack a flight, its signs are right.
pub(super) fn search(
    kinematics: &Kinematics,
    rig: RigKind,
    closed: &[Closed],
    seen: bool,
) -> Option<FreeFlights> {
    let with = |signs: [f64; 2]| {
        let turned = turned(kinematics, rig, signs);
        let found = Search::new(&turned, rig).impacts(closed);
        (!found.impacts.is_empty() || is_separate(&found)).then_some(found)
    };
    if let Some(mut found) = with([-1.0, -1.0]) {
        if !is_separate(&found) {
            found.flags.insert(0, away(rig));
        }
        return Some(found);
    }
    if rig == RigKind::Single || seen {
        return None;
    }
    let meet = |signs| with(signs).is_some_and(|found| !is_separate(&found));
    let along_one_axis = meet([1.0, -1.0]) || meet([-1.0, 1.0]);
    along_one_axis.then(|| FreeFlights {
        flags: vec![same_direction()],
        jump_samples: 1,
        ..FreeFlights::default()
    })
}

/// Whether two bodies do not meet each other.
fn is_separate(found: &FreeFlights) -> bool {
    let mut flags = found.flags.iter();
    flags.any(|f| f.code == FlagCode::SeparateBodies)
}

fn away(rig: RigKind) -> Flag {
    let problem = match rig {
        RigKind::Single => Problem::AwayFromStop,
        RigKind::Double => Problem::AwayFromMass,
    };
    Flag::new(None, problem).excluding(false)
}

fn same_direction() -> Flag {
    Flag::new(None, Problem::SpeedsAlongOneAxis)
}

fn turned(kinematics: &Kinematics, rig: RigKind, [x, y]: [f64; 2]) -> Kinematics {
    let mut turned = kinematics.clone();
    turn(&mut turned.x, x);
    turn(&mut turned.y, y);
    turned.update_relative(rig);
    turned
}

fn turn(body: &mut Body, sign: f64) {
    let turn = |series: &mut Series| series.values.iter_mut().for_each(|v| *v *= sign);
    body.velocity.iter_mut().for_each(turn);
    body.displacement.iter_mut().for_each(turn);
}
