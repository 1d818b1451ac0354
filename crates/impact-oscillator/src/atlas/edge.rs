//! What ends a motion.

use serde::{Deserialize, Serialize};

use crate::model::PeriodicOrbit;

/// What ends a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeKind {
    /// Multiplier +1: s2, the orbit meets its unstable twin.
    SaddleNode,
    /// Multiplier −1: s1, the period doubles.
    PeriodDoubling,
    /// A pair of complex multipliers on the unit circle.
    Torus,
    /// The flight touches the contact: a further impact begins.
    Grazing,
    /// An impact's approach speed falls to zero.
    ImpactVanishes,
    /// The masses begin to stay together after an impact (1 | 1j); of a motion with a dead zone: it closes,
    /// or the number of impacts between two of them changes.
    DeadZone,
    /// ρ': the impactless motion touches the contact.
    ImpactlessGrazing,
    /// ρp: the masses stick together for all time below.
    Sticking,
    /// A motion with a dead zone loses its stability (asymmetric machines).
    Unstable,
    /// The search's bound: the motion goes on.
    Bound,
    /// The continuation broke off.
    Lost,
}

impl EdgeKind {
    /// The name in tables; s1 and s2 as in the paper, joined is ρp.
    pub fn name(self) -> &'static str {
        match self {
            Self::SaddleNode => "s2",
            Self::PeriodDoubling => "s1",
            Self::Torus => "torus",
            Self::Grazing => "grazing",
            Self::ImpactVanishes => "impact_vanishes",
            Self::DeadZone => "dead_zone",
            Self::ImpactlessGrazing => "rho_grazing",
            Self::Sticking => "joined",
            Self::Unstable => "stability_lost",
            Self::Bound => "bound",
            Self::Lost => "lost",
        }
    }
}

/// Where a motion ends, and the orbit there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Edge {
    /// What ends it.
    pub kind: EdgeKind,
    /// The last orbit.
    pub orbit: PeriodicOrbit,
}
