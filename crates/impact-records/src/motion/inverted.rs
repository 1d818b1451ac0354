//! Channels that are positive away from the other mass, as the jumps of the velocities have it: in all records of a
//! campaign, or in some.

use std::collections::BTreeMap;

use super::late_channel::LateChannel;
use super::observation::Observation;
use crate::record::Role;

/// Jumps up from which a channel is of the other sign, and so many of them for each one down.
const FEWEST: usize = 8;
const FOR_EACH_DOWN: usize = 4;
/// The same of one record.
const FEWEST_OF_RECORD: usize = 3;
/// Share of the records whose impacts tell it that have the usual sign, from which on a channel is turned in some records
/// and not in all.
const USUAL: f64 = 0.2;

/// The channels whose velocities jump up at impacts: those that are positive away from the other mass.
pub fn inverted_channels(observations: &[Observation]) -> Vec<LateChannel> {
    let inverted = roles(observations).into_iter().filter(|role| {
        let (up, down) = jumps(observations, *role);
        up >= FEWEST && up > FOR_EACH_DOWN * down && in_some(observations, *role).is_empty()
    });
    inverted.map(LateChannel::inverted).collect()
}

/// The records, by their places, in which channels are of the other sign than in others. A record without impacts is among
/// them where those before and after it are.
pub fn turned_channels(observations: &[Observation]) -> BTreeMap<usize, Vec<Role>> {
    let mut turned: BTreeMap<usize, Vec<Role>> = BTreeMap::new();
    for role in roles(observations) {
        for i in in_some(observations, role) {
            turned.entry(i).or_default().push(role);
        }
    }
    turned
}

/// The channels of which a record shows jumps up.
fn roles(observations: &[Observation]) -> Vec<Role> {
    let all = observations.iter().flat_map(|o| &o.directions);
    let mut roles: Vec<Role> = all.map(|d| d.role).collect();
    roles.sort_unstable();
    roles.dedup();
    roles
}

/// How often a channel's velocity jumps up and down in all records.
fn jumps(observations: &[Observation], role: Role) -> (usize, usize) {
    let all = observations.iter().flat_map(|o| &o.directions);
    let own = all.filter(|d| d.role == role);
    own.fold((0, 0), |(up, down), d| (up + d.up, down + d.down))
}

/// Whether a channel is of the other sign in a record; `None` where its impacts do not tell.
fn is_turned(o: &Observation, role: Role) -> Option<bool> {
    let told = o.directions.iter().find(|d| d.role == role);
    match told {
        Some(d) if d.up >= FEWEST_OF_RECORD && d.up > FOR_EACH_DOWN * d.down => Some(true),
        Some(d) if d.down >= FEWEST_OF_RECORD && d.down > FOR_EACH_DOWN * d.up => Some(false),
        Some(_) => None,
        None => (!o.excluded() && o.impacts.len() >= FEWEST_OF_RECORD).then_some(false),
    }
}

/// The records, by their places, in which a channel is of the other sign, if it is in some and not in all.
fn in_some(observations: &[Observation], role: Role) -> Vec<usize> {
    let mut order: Vec<usize> = (0..observations.len()).collect();
    order.sort_by_key(|i| observations[*i].setting.sequence);
    let told: Vec<Option<bool>> = order
        .iter()
        .map(|i| is_turned(&observations[*i], role))
        .collect();
    let usual = told.iter().filter(|t| **t == Some(false)).count() as f64;
    if usual < USUAL * told.iter().flatten().count() as f64 {
        return Vec::new();
    }
    let before = |k: usize| told[..k].iter().rev().flatten().next();
    let after = |k: usize| told[k..].iter().flatten().next();
    let both = |k: usize| {
        let sides = [before(k), after(k)];
        let mut sides = sides.into_iter().flatten().peekable();
        sides.peek().is_some() && sides.all(|turned| *turned)
    };
    let turned = (0..order.len()).filter(|k| told[*k].unwrap_or_else(|| both(*k)));
    turned.map(|k| order[k]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::{Impact, JumpDirections};
    use crate::motion::Motion;

    #[test]
    fn a_channel_is_inverted_whose_velocity_jumps_up() {
        let found = |[up, down]: [usize; 2]| {
            let one = |_| {
                let mut o = Observation::of("r", 12.0, Motion::Impactless);
                let of = |role, up, down| JumpDirections { role, up, down };
                o.directions = vec![of(Role::VelocityX, 0, 5), of(Role::DisplacementY, up, down)];
                o
            };
            inverted_channels(&(0..4).map(one).collect::<Vec<_>>())
        };
        assert_eq!(found([5, 1]), [LateChannel::inverted(Role::DisplacementY)]);
        // as many go down, or too few up
        assert_eq!(found([5, 2]), []);
        assert_eq!(found([1, 0]), []);
    }

    #[test]
    fn a_channel_that_is_turned_in_some_records_is_not_inverted_in_all() {
        let one = |i: usize| {
            let mut o = Observation::of("r", 12.0, Motion::Impactless);
            o.setting.sequence = i;
            // every third record has no impacts
            if !i.is_multiple_of(3) {
                o.impacts = (0..4)
                    .map(|k| Impact::at(0.1 * f64::from(k), 0.5))
                    .collect();
                if i >= 10 {
                    let (role, up, down) = (Role::VelocityX, 4, 0);
                    o.directions = vec![JumpDirections { role, up, down }];
                }
            }
            o
        };
        let all: Vec<Observation> = (0..20).map(one).collect();
        assert_eq!(inverted_channels(&all), []);
        let turned = turned_channels(&all);
        assert_eq!(
            Vec::from_iter(turned.keys().copied()),
            Vec::from_iter(10..20)
        );
        assert!(turned.values().all(|roles| *roles == [Role::VelocityX]));
        assert!(turned_channels(&all[10..]).is_empty());
        assert_eq!(
            inverted_channels(&all[10..]),
            [LateChannel::inverted(Role::VelocityX)]
        );
    }
}
