//! A channel that is later than stated, of the other sign, or at another time in each record.

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
            order_share: all(),
            inverted: false,
            unsteady_s: None,
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
