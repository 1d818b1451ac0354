//! The virtual rig's channels: what each watches, and what a volt of it stands for.

use crate::acquisition;
use crate::truth::Truth;
use impact_records::record::Role;
use labfiles::units::Dimension;

/// Role, dimension and whether an integrator filters it, of each channel of the virtual rig.
pub const ROLES: [(Role, Dimension, bool); 7] = [
    (Role::Drive, Dimension::Voltage, false),
    (Role::Contact, Dimension::Voltage, false),
    (Role::VelocityX, Dimension::Velocity, false),
    (Role::VelocityY, Dimension::Velocity, true),
    (Role::DisplacementX, Dimension::Length, true),
    (Role::DisplacementY, Dimension::Length, true),
    (Role::FrameX, Dimension::Length, true),
];

/// Sensitivity of a channel: what one volt stands for nominally.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorSensitivity {
    /// Name of the channel in the file.
    pub name: &'static str,
    /// SI units per volt.
    pub si_per_volt: f64,
}

/// The channels of the virtual rig with their nominal sensitivities, for a rig of this truth:
/// round numbers that put the largest motions well within the converter's range.
pub fn sensitivities(truth: &Truth) -> [SensorSensitivity; 7] {
    // The resonance amplitude x_st/(2β) must stay below four fifths of full scale.
    let reach = (0.5 / truth.damping_ratio() / (0.8 * acquisition::FULL_SCALE_V)).max(2.0);
    let length = round_up(truth.static_deflection_m() * reach);
    let speed = round_up(truth.static_deflection_m() * truth.natural_rate() * reach);
    let si_per_volt = [1.0, 1.0, speed, speed, length, length, 1e-2 * length];
    std::array::from_fn(|i| SensorSensitivity {
        name: NAMES[i],
        si_per_volt: si_per_volt[i],
    })
}

/// Names of the channels in the files, in the order of [`ROLES`].
const NAMES: [&str; 7] = [
    "generator",
    "contact",
    "laser_x",
    "integrator_vy",
    "integrator_x",
    "integrator_y",
    "frame_x",
];

fn round_up(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let leading = value / power;
    power
        * [1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .find(|s| *s >= leading)
            .unwrap_or(10.0)
}
