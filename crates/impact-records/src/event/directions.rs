//! In which direction the velocity of each mass jumps: an impact takes speed toward the other mass from both, so
//! that each velocity that is positive toward it jumps down.

use serde::{Deserialize, Serialize};

use crate::event::jumps::JumpSearch;
use crate::event::kinematics::{Body, Kinematics};
use crate::record::Role;

/// Ways in which a channel's velocity jumps in a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct JumpDirections {
    /// The channel.
    pub role: Role,
    /// Jumps up.
    pub up: usize,
    /// Jumps down, as impacts make them.
    pub down: usize,
}

/// The directions of the jumps of each mass, with windows of `width` samples beside a jump.
pub(super) fn jump_directions(kinematics: &Kinematics, width: usize) -> Vec<JumpDirections> {
    let of = |body: &Body| {
        let velocity = body.velocity.as_ref()?;
        let (up, down) = JumpSearch::new(velocity, width).directions();
        Some(JumpDirections {
            role: velocity.role,
            up,
            down,
        })
    };
    kinematics.bodies().filter_map(of).collect()
}
