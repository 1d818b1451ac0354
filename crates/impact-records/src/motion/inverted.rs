//! Channels of a campaign that are positive away from the other mass, as the jumps of the velocities have it.

use super::late_channel::LateChannel;
use super::observation::Observation;
use crate::event::JumpDirections;
use crate::record::Role;

/// Jumps up from which a channel is of the other sign, and so many of them for each one down.
const FEWEST: usize = 8;
const FOR_EACH_DOWN: usize = 4;

/// The channels whose velocities jump up at impacts: those that are positive away from the other mass.
pub fn inverted_channels(observations: &[Observation]) -> Vec<LateChannel> {
    let all: Vec<&JumpDirections> = observations.iter().flat_map(|o| &o.directions).collect();
    let mut roles: Vec<Role> = all.iter().map(|d| d.role).collect();
    roles.sort_unstable();
    roles.dedup();
    let points_away = |role: &Role| {
        let own = all.iter().filter(|d| d.role == *role);
        let (up, down) = own.fold((0, 0), |(up, down), d| (up + d.up, down + d.down));
        up >= FEWEST && up > FOR_EACH_DOWN * down
    };
    let inverted = roles.into_iter().filter(points_away);
    inverted.map(LateChannel::inverted).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
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
}
