//! A channel that is later than stated, of the other sign, behind a filter, or at another time in each record.

use serde::{Deserialize, Serialize};

use crate::record::{LowPass, Role};

/// A channel that is later than stated, or of the other sign.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LateChannel {
    /// The channel.
    pub role: Role,
    /// By how much it is later than stated, s, beside the delay of the low-pass.
    pub delay_s: f64,
    /// The low-pass that its jumps show and that is not stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low_pass: Option<LowPass>,
    /// The high-pass that it has passed and that is not stated, as the phases of the motion show it of a drive's channel,
    /// Hz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high_pass_hz: Option<f64>,
    /// What is not known of how much that low-pass lowers an amplitude at the frequency f, over ½(f/`f_c`)²: all of
    /// it where its order is not known.
    #[serde(default = "all")]
    pub order_share: f64,
    /// Whether its sign is the opposite of the stated one.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub inverted: bool,
    /// By how much its delay differs from record to record, s, where each has one of its own: the channel is left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unsteady_s: Option<f64>,
}

impl LateChannel {
    /// A channel that is later by a time, s, and shows no low-pass.
    pub fn by(role: Role, delay_s: f64) -> Self {
        Self {
            role,
            delay_s,
            low_pass: None,
            high_pass_hz: None,
            order_share: all(),
            inverted: false,
            unsteady_s: None,
        }
    }

    /// A channel behind a high-pass of a corner, Hz.
    pub fn behind(role: Role, high_pass_hz: f64) -> Self {
        Self {
            high_pass_hz: Some(high_pass_hz),
            ..Self::by(role, 0.0)
        }
    }

    /// A channel whose delay differs from record to record by a time, s.
    pub fn unsteady(role: Role, by_s: f64) -> Self {
        Self {
            unsteady_s: Some(by_s),
            ..Self::by(role, 0.0)
        }
    }

    /// A channel whose sign is the opposite of the stated one.
    pub fn inverted(role: Role) -> Self {
        Self {
            inverted: true,
            ..Self::by(role, 0.0)
        }
    }

    /// What is found of channels after `known` was corrected, together with that: one entry a channel.
    pub fn together(known: &[Self], found: Vec<Self>) -> Vec<Self> {
        let mut all = known.to_vec();
        for new in found {
            match all.iter_mut().find(|l| l.role == new.role) {
                Some(old) => {
                    old.delay_s += new.delay_s;
                    old.inverted ^= new.inverted;
                    old.low_pass = old.low_pass.or(new.low_pass);
                    old.high_pass_hz = old.high_pass_hz.or(new.high_pass_hz);
                    old.unsteady_s = old.unsteady_s.or(new.unsteady_s);
                }
                None => all.push(new),
            }
        }
        all
    }
}

fn all() -> f64 {
    1.0
}
