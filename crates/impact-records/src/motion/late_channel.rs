//! A channel that is later than stated.

use serde::{Deserialize, Serialize};

use crate::record::{LowPass, Role};

/// A channel that is later than stated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LateChannel {
    /// The channel.
    pub role: Role,
    /// By how much it is later than stated, s, beside the delay of the low-pass.
    pub delay_s: f64,
    /// The low-pass that its jumps show and that is not stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low_pass: Option<LowPass>,
    /// What is not known of how much that low-pass lowers an amplitude at the frequency f, over ½(f/`f_c`)²: all of
    /// it where its order is not known.
    #[serde(default = "all")]
    pub order_share: f64,
}

impl LateChannel {
    /// A channel that is later by a time, s, and shows no low-pass.
    pub fn by(role: Role, delay_s: f64) -> Self {
        Self {
            role,
            delay_s,
            low_pass: None,
            order_share: all(),
        }
    }
}

fn all() -> f64 {
    1.0
}
