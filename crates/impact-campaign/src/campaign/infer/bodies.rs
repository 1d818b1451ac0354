//! Channels that move beside that of a mass: a second body, the same one once more, or something that only the user knows.

use std::collections::BTreeSet;

use super::found::{FolderContents, InferredChannel};
use super::look::{self, Detected};
use super::place::Place;
use super::roles;
use impact_records::event::RigKind;
use impact_records::record::{Record, Role};
use impact_records::signal::robust;

/// Give the channel that moves beside the only mass the role of the second one, where the records show that the two
/// strike each other.
pub(super) fn take_second(some: &[Place<'_>], found: &mut FolderContents) {
    let Some((index, role)) = only_other(&found.channels) else {
        return;
    };
    let mut with = found.channels.clone();
    with[index].role = Some(role);
    let mut records: Vec<Record> = some.iter().map(|p| look::read(*p, &with)).collect();
    if records.iter().all(look::sees_same) {
        return;
    }
    let strike =
        |records: &[Record]| Detected::of(records, RigKind::Double).most(look::strikes_once);
    let mut struck = strike(&records);
    if !struck {
        records.iter_mut().for_each(turn_second);
        struck = strike(&records);
    }
    if struck {
        found.channels = with;
    }
}

/// That two bodies do not meet, of which the first alone is used.
pub(super) fn apart(channels: &[InferredChannel]) -> String {
    let of = |y: bool| {
        let moving = channels.iter().filter(move |c| {
            c.role
                .is_some_and(|role| role.is_motion() && role.is_of_y() == y)
        });
        moving
            .map(|c| c.name.as_str())
            .collect::<Vec<_>>()
            .join(", ")
    };
    let (first, second) = (of(false), of(true));
    format!(
        "{second} does not meet {first}: it needs a campaign of its own, and {first} alone is used here, against a stop"
    )
}

/// Ask for the machine where a channel without a role moves as that of the mass does, unless it shows the same motion.
pub(super) fn ask_or_note(some: &[Place<'_>], rig: RigKind, found: &mut FolderContents) {
    let mut others = others(&found.channels);
    match rig {
        RigKind::Single => {
            others.retain(|(index, role)| !is_same(some, &found.channels, *index, *role));
        }
        RigKind::Double => {
            others.retain(|(index, _)| leaves_line(some, &found.channels, *index));
        }
    }
    if others.is_empty() {
        return;
    }
    let name = |index: usize| found.channels[index].name.clone();
    let axes = others.iter().all(|(i, _)| {
        roles::is_other_axis(&found.channels, *i) || is_named_as_axis(&found.channels, *i)
    });
    let names: Vec<String> = others.iter().map(|(index, _)| name(*index)).collect();
    let moves = if names.len() == 1 { "moves" } else { "move" };
    let names = names.join(", ");
    let note = match rig {
        RigKind::Single if axes => {
            format!("{names}: taken for other coordinates of the same body, and not used")
        }
        RigKind::Single => {
            found.asks_machine = true;
            format!(
                "{names} {moves} too: if it is a second body, write machine = \"double\" and give it the role of mass y; if it \
                 shows the same body, or one that is not struck, write machine = \"single\""
            )
        }
        RigKind::Double if axes => {
            found.asks_machine = true;
            format!(
                "{names} {moves} too: the bodies do not meet along one axis, and R is that along the line of impact; give \
                 coordinates along that line, or write machine = \"double\" if the bodies meet along the axis of the channels above"
            )
        }
        RigKind::Double => {
            format!("{names} {moves} too without a role: check which two bodies collide")
        }
    };
    found.notes.push(note);
}

/// Whether a channel shows a motion beside the line along which a body moves: a line across the axes shows in both of them, and R
/// along either is that along the line.
fn leaves_line(some: &[Place<'_>], channels: &[InferredChannel], index: usize) -> bool {
    let moving = channels.iter().enumerate();
    let moving = moving.filter(|(_, c)| c.role.is_some_and(Role::is_motion));
    let own: Vec<usize> = moving.map(|(i, _)| i).collect();
    let beside = |place: &Place<'_>| -> Option<f64> {
        let of = |i: usize| Some(place.numbers(channels[i].find(place.set())?));
        let values = of(index)?;
        let shares = own
            .iter()
            .filter_map(|i| Some(share_beside(&of(*i)?, &values)));
        shares.reduce(f64::min)
    };
    let shares = some.iter().filter_map(beside);
    shares.fold(0.0, f64::max) > roles::MOVES
}

/// What a channel shows beside the line of another, over how far that moves.
fn share_beside(own: &[f64], other: &[f64]) -> f64 {
    let pairs = own.iter().zip(other);
    let known = pairs.filter(|(a, b)| a.is_finite() && b.is_finite());
    let (own, other): (Vec<f64>, Vec<f64>) = known.map(|(a, b)| (*a, *b)).unzip();
    let [size, of_other] = [&own, &other].map(|v| robust::rms_about_mean(v));
    let along = look::correlation(&own, &other);
    (1.0 - along * along).max(0.0).sqrt() * of_other / size.max(f64::MIN_POSITIVE)
}

/// Whether a channel is called as one with a role is but for the letter of the axis: `y1` beside `x1`.
fn is_named_as_axis(channels: &[InferredChannel], index: usize) -> bool {
    let name = channels[index].name.to_lowercase();
    let along_x = ["y", "z"].map(|axis| name.replacen(axis, "x", 1));
    let with_role = channels.iter().filter(|c| c.role.is_some());
    let mut names = with_role.map(|c| c.name.to_lowercase());
    names.any(|own| own != name && along_x.contains(&own))
}

/// Ask for the machine of a driven rig where channels without a role are alike, and no mass y is known.
pub(super) fn ask_of_driven(found: &mut FolderContents) {
    let of_y = |c: &InferredChannel| c.role.is_some_and(Role::is_on_y_side);
    if found.channels.iter().any(of_y) {
        return;
    }
    let moving = others(&found.channels).into_iter().map(|(index, _)| index);
    let moving = moving.filter(|i| !roles::is_other_axis(&found.channels, *i));
    let free: BTreeSet<usize> = moving
        .chain(roles::alike_without_role(&found.channels))
        .collect();
    if free.is_empty() {
        found.notes.extend(one_of_a_driven_rig(&found.channels));
        return;
    }
    let names: Vec<&str> = free
        .iter()
        .map(|i| found.channels[*i].name.as_str())
        .collect();
    found.asks_machine = true;
    found.notes.push(format!(
        "no role is known for {}: if two masses strike each other, write machine = \"double\" and give each of these \
         channels its role; if it is one mass against a stop, machine = \"single\"",
        names.join(", ")
    ));
}

/// That the motion of one mass of a driven rig is recorded, which may strike a second one.
fn one_of_a_driven_rig(channels: &[InferredChannel]) -> Option<String> {
    let has = |is: &dyn Fn(Role) -> bool| channels.iter().any(|c| c.role.is_some_and(is));
    let recorded = has(&|role| role == Role::Drive) && has(&Role::is_motion);
    recorded.then(|| {
        "the motion of one mass is recorded: taken for one mass against a stop that does not move; if it strikes a second \
         mass, write machine = \"double\""
            .to_owned()
    })
}

/// Channels without a role that move and show a quantity of motion that the first mass has, with that of the second.
fn others(channels: &[InferredChannel]) -> Vec<(usize, Role)> {
    let pairs = [
        (Role::VelocityX, Role::VelocityY),
        (Role::DisplacementX, Role::DisplacementY),
    ];
    let free = channels
        .iter()
        .enumerate()
        .filter(|(_, c)| c.role.is_none());
    free.filter_map(|(index, channel)| {
        let like = |(x, _): &&(Role, Role)| {
            let own = channels.iter().find(|c| c.role == Some(*x));
            own.is_some_and(|own| roles::moves_like(own, channel))
        };
        pairs.iter().find(like).map(|(_, y)| (index, *y))
    })
    .collect()
}

/// The only channel that may be a second body; none where it may be another coordinate of the first.
fn only_other(channels: &[InferredChannel]) -> Option<(usize, Role)> {
    let of_y = |c: &InferredChannel| c.role.is_some_and(Role::is_on_y_side);
    if channels.iter().any(of_y) {
        return None;
    }
    match others(channels)[..] {
        [one] if !roles::is_other_axis(channels, one.0) => Some(one),
        _ => None,
    }
}

/// Whether a channel shows the same motion as that of the mass in all records.
fn is_same(some: &[Place<'_>], channels: &[InferredChannel], index: usize, role: Role) -> bool {
    let mut with = channels.to_vec();
    with[index].role = Some(role);
    some.iter()
        .all(|place| look::sees_same(&look::read(*place, &with)))
}

/// Turn the motion of the second mass around.
fn turn_second(record: &mut Record) {
    let of_y = record.channels.iter_mut().filter(|c| c.role.is_of_y());
    of_y.flat_map(|c| c.values.iter_mut())
        .for_each(|v| *v = -*v);
}
