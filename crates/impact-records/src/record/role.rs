//! What a channel measures on the rig.

use serde::{Deserialize, Serialize};

use crate::signal::decay::MotionSignal;
use labfiles::units::Dimension;

/// What a channel measures on the rig.
#[derive(
    Debug,
    Default,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "snake_case")]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// The harmonic drive (generator voltage or force).
    #[default]
    Drive,
    /// The electric contact (or force) that shows the bodies touching.
    Contact,
    /// Velocity of mass x toward mass y (or toward the stop).
    VelocityX,
    /// Velocity of mass y toward mass x.
    VelocityY,
    /// Displacement of mass x toward mass y (or toward the stop).
    DisplacementX,
    /// Displacement of mass y toward mass x.
    DisplacementY,
    /// Acceleration of mass x toward mass y (or toward the stop).
    AccelerationX,
    /// Acceleration of mass y toward mass x.
    AccelerationY,
    /// Motion of the frame that carries mass x.
    FrameX,
    /// Motion of the frame that carries mass y.
    FrameY,
}

crate::message_table! { "role": Role; }

impl Role {
    /// The same quantity of both masses, x first.
    pub const OF_BOTH: [[Self; 2]; 3] = [
        [Self::VelocityX, Self::VelocityY],
        [Self::DisplacementX, Self::DisplacementY],
        [Self::AccelerationX, Self::AccelerationY],
    ];

    /// All roles, in the order of campaign.toml.
    pub const ALL: &[Self] = <Self as strum::VariantArray>::VARIANTS;

    /// The role's name as campaign.toml spells it.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Whether a channel of this role watches the second mass.
    pub fn is_of_y(self) -> bool {
        matches!(
            self,
            Self::VelocityY | Self::DisplacementY | Self::AccelerationY
        )
    }

    /// Whether a channel of this role is on the side of the second mass: that mass or its frame.
    pub fn is_on_y_side(self) -> bool {
        self.is_of_y() || self == Self::FrameY
    }

    /// Whether a channel of this role watches a frame.
    pub fn is_frame(self) -> bool {
        matches!(self, Self::FrameX | Self::FrameY)
    }

    /// Whether a channel of this role watches the motion of a mass.
    pub fn is_motion(self) -> bool {
        self.dimension().is_some()
    }

    /// How many times the displacement of a mass is differentiated to what a channel of this role watches; `None` of
    /// other channels.
    pub fn derivative(self) -> Option<u8> {
        match self {
            Self::Drive | Self::Contact | Self::FrameX | Self::FrameY => None,
            Self::DisplacementX | Self::DisplacementY => Some(0),
            Self::VelocityX | Self::VelocityY => Some(1),
            Self::AccelerationX | Self::AccelerationY => Some(2),
        }
    }

    /// The dimension a channel of this role must have once in SI; `None` if several are accepted
    /// (a drive in V or N, a contact in V or N, a frame in m, m/s or m/s²).
    pub fn dimension(self) -> Option<Dimension> {
        match self {
            Self::Drive | Self::Contact | Self::FrameX | Self::FrameY => None,
            Self::VelocityX | Self::VelocityY => Some(Dimension::Velocity),
            Self::DisplacementX | Self::DisplacementY => Some(Dimension::Length),
            Self::AccelerationX | Self::AccelerationY => Some(Dimension::Acceleration),
        }
    }

    /// What of a motion a channel of this role shows.
    pub fn motion_signal(self) -> MotionSignal {
        match self.dimension() {
            Some(Dimension::Velocity) => MotionSignal::Velocity,
            Some(Dimension::Acceleration) => MotionSignal::Acceleration,
            _ => MotionSignal::Displacement,
        }
    }
}
