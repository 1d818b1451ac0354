//! What a motion channel picks up from the drive's generator: a share of its voltage, in phase with it at
//! every frequency, which no motion of a mass is.

use crate::parameters::effect::Effect;
use impact_records::motion::Observation;
use impact_records::record::Role;

/// The channel of each mass that may pick up the drive, with its greatest amplitude in the campaign, SI, to
/// which the strength of that effect refers: the velocity, else the displacement, else the acceleration.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pickups {
    channels: [Option<(Role, f64)>; 2],
}

/// The channels of a mass, that which tells most first.
const OF_MASS: [[Role; 3]; 2] = [
    [Role::VelocityX, Role::DisplacementX, Role::AccelerationX],
    [Role::VelocityY, Role::DisplacementY, Role::AccelerationY],
];

impl Pickups {
    /// Of a campaign.
    pub fn of(observations: &[Observation]) -> Self {
        let greatest = |role: Role| {
            let usable = observations.iter().filter(|o| !o.excluded());
            let own = usable.flat_map(|o| &o.amplitudes);
            let own = own.filter(|a| a.role == role).map(|a| a.half_range);
            own.reduce(f64::max).filter(|most| *most > 0.0)
        };
        let channels = OF_MASS.map(|roles| {
            let mut measured = roles.into_iter();
            measured.find_map(|role| Some((role, greatest(role)?)))
        });
        Self { channels }
    }

    /// What a channel shows per unit of an effect's strength where the drive is cos θ = 1, SI.
    pub fn unit(&self, effect: Effect, role: Role) -> f64 {
        let of = match effect {
            Effect::PickupX => self.channels[0],
            Effect::PickupY => self.channels[1],
            _ => None,
        };
        of.filter(|(own, _)| *own == role)
            .map_or(0.0, |(_, unit)| unit)
    }

    /// Whether an effect is what a channel picks up that is measured.
    pub fn has(&self, effect: Effect) -> bool {
        OF_MASS
            .iter()
            .flatten()
            .any(|role| self.unit(effect, *role) > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::motion::{Amplitude, Motion};

    #[test]
    fn the_velocity_of_a_mass_picks_up_a_share_of_its_greatest_amplitude() {
        let observed = |role, half_range| {
            let mut o = Observation::of("r", 12.0, Motion::Impactless);
            o.amplitudes = vec![Amplitude {
                role,
                half_range,
                rms: 0.0,
            }];
            o
        };
        let pickups = Pickups::of(&[
            observed(Role::VelocityX, 0.2),
            observed(Role::VelocityX, 0.3),
            observed(Role::DisplacementX, 1e-3),
        ]);
        assert_eq!(pickups.unit(Effect::PickupX, Role::VelocityX), 0.3);
        assert_eq!(pickups.unit(Effect::PickupX, Role::DisplacementX), 0.0);
        assert!(pickups.has(Effect::PickupX) && !pickups.has(Effect::PickupY));
    }
}
