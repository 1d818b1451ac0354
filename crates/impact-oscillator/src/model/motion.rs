//! Types of motion z = p/n: p impacts in n drive periods.

use serde::{Deserialize, Serialize};

/// The motion that a simulation settles on.
///
/// It follows from exact impacts, so it is never undetermined as a motion measured in a laboratory
/// may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum SettledMotion {
    /// No impact: z = 0.
    Impactless,
    /// Periodic, z = p/n.
    Periodic {
        /// Impacts in a period of the motion; of complete chatters, each of which has infinitely
        /// many impacts, each counts as one.
        p: u32,
        /// Drive periods in a period of the motion.
        n: u32,
        /// Whether a dead zone follows impacts.
        dead_zone: bool,
        /// Whether impacts accumulate in complete chatters.
        chatter: bool,
    },
    /// Impacts whose speeds grow and decay again, with many impactless drive periods between.
    Beat,
    /// Impacts that do not recur within the observed time, while variations of the motion grow.
    Chaotic,
    /// Impacts that do not recur within the observed time, though variations of the motion do not grow: it settles
    /// too slowly to be told.
    NotSettled,
    /// The masses stick together all the time.
    #[serde(rename = "joined")]
    Sticking,
}

impl SettledMotion {
    /// z = p/n without a dead zone.
    #[must_use]
    pub fn periodic(p: u32, n: u32) -> Self {
        Self::Periodic {
            p,
            n,
            dead_zone: false,
            chatter: false,
        }
    }

    /// p and n of a periodic motion with a dead zone, or of one without.
    pub(crate) fn numbers(self, with_dead_zone: bool) -> Option<(u32, u32)> {
        match self {
            Self::Periodic {
                p, n, dead_zone, ..
            } if dead_zone == with_dead_zone => Some((p, n)),
            _ => None,
        }
    }

    /// Whether it repeats itself after a whole number of drive periods.
    #[must_use]
    pub fn is_periodic(self) -> bool {
        !matches!(self, Self::Beat | Self::Chaotic | Self::NotSettled)
    }

    /// The paper's label: `0`, `1`, `1j`, `1/2`, `2/2`, `2/1`, `beat`, `chaotic`, `not settled`, `joined`.
    #[must_use]
    pub fn label(self) -> String {
        match self {
            Self::Impactless => "0".into(),
            Self::Periodic {
                p, n, dead_zone, ..
            } => periodic_label(p, n, dead_zone),
            Self::Beat => "beat".into(),
            Self::Chaotic => "chaotic".into(),
            Self::NotSettled => "not settled".into(),
            Self::Sticking => "joined".into(),
        }
    }
}

impl std::fmt::Display for SettledMotion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.label())
    }
}

/// The paper's label of p impacts in n drive periods, with j where a dead zone follows impacts.
///
/// ```
/// use impact_oscillator::periodic_label;
///
/// assert_eq!(periodic_label(1, 1, false), "1");
/// assert_eq!(periodic_label(2, 1, true), "2j");
/// assert_eq!(periodic_label(3, 2, false), "3/2");
/// ```
#[must_use]
pub fn periodic_label(p: u32, n: u32, dead_zone: bool) -> String {
    let j = if dead_zone { "j" } else { "" };
    match (p, n) {
        (1, 1) => format!("1{j}"),
        (p, 1) if dead_zone => format!("{p}j"),
        (p, n) => format!("{p}/{n}{j}"),
    }
}

/// A count of impacts or drive periods that is held as a number of f64.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts are whole, not negative and far below 2³²; beyond that `as` saturates"
)]
pub(crate) fn count(whole: f64) -> u32 {
    whole as u32
}
