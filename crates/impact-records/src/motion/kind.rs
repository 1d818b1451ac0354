//! Types of motion z = p/n: p impacts in n drive periods.

use impact_oscillator::{SettledMotion, periodic_label};
use serde::{Deserialize, Serialize};

use super::undetermined::Undetermined;

/// The type of motion that a record shows.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Motion {
    /// No impact, steady: z = 0.
    Impactless,
    /// Periodic with impacts: z = p/n; `dead_zone` where the bodies stay together after an
    /// impact (written 1j, 2j).
    Periodic {
        /// Impacts in one period of the motion.
        impacts_p: u32,
        /// Drive periods in one period of the motion.
        periods_n: u32,
        /// Whether a dead zone follows impacts.
        dead_zone: bool,
    },
    /// Impacts whose speeds grow and decay again, with impactless drive periods between.
    Beat,
    /// Impacts without a period, irregular.
    Chaotic,
    /// The bodies stick together all the time.
    #[serde(rename = "joined")]
    Sticking,
    /// The record does not determine the motion.
    Undetermined {
        /// Why it does not.
        reason: Undetermined,
    },
}

impl Motion {
    /// Periodic motion z = p/n without dead zone.
    pub fn periodic(impacts_p: u32, periods_n: u32) -> Self {
        Self::Periodic {
            impacts_p,
            periods_n,
            dead_zone: false,
        }
    }

    /// The paper's label: `0`, `1`, `1j`, `1/2`, `2/2`, `2/1`, `beat`, `chaotic`, `joined`,
    /// `undetermined`. One impact in one period is `1`, otherwise p/n is written in full.
    pub fn label(&self) -> String {
        match self {
            Self::Impactless => "0".into(),
            Self::Periodic {
                impacts_p,
                periods_n,
                dead_zone,
            } => periodic_label(*impacts_p, *periods_n, *dead_zone),
            Self::Beat => "beat".into(),
            Self::Chaotic => "chaotic".into(),
            Self::Sticking => "joined".into(),
            Self::Undetermined { .. } => "undetermined".into(),
        }
    }

    /// Whether the motion repeats itself after a whole number of drive periods.
    pub fn is_periodic(&self) -> bool {
        matches!(
            self,
            Self::Impactless | Self::Periodic { .. } | Self::Sticking
        )
    }
}

impl std::fmt::Display for Motion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.label())
    }
}

impl From<SettledMotion> for Motion {
    fn from(m: SettledMotion) -> Self {
        match m {
            SettledMotion::Impactless => Self::Impactless,
            SettledMotion::Periodic {
                p, n, dead_zone, ..
            } => Self::Periodic {
                impacts_p: p,
                periods_n: n,
                dead_zone,
            },
            SettledMotion::Beat => Self::Beat,
            SettledMotion::Chaotic => Self::Chaotic,
            SettledMotion::NotSettled => Self::Undetermined {
                reason: Undetermined::NotSettled,
            },
            SettledMotion::Sticking => Self::Sticking,
        }
    }
}
