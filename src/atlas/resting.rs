//! Motions that rest in a dead zone: after each release from the contact the motion is the
//! same, so they are found by one flight from the release, and their edges by bisection.
//!
//! At the release of one mass (or of two equal ones) the displacement is ρ, the velocity 0 and
//! the drive's phase arccos ρ, falling; one such start at every ρ in (−1, 1).

use serde::{Deserialize, Serialize};

use super::map::UnitMass;
use crate::model::{ImpactKind, Initial, Machine, ModelImpact, Setting, Simulator};

/// What bounds a motion with a dead zone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RestingEdge {
    /// ρp: the masses stay together for ever below.
    Joined,
    /// The dead zone closes, or the number of impacts between two of them changes.
    DeadZone,
}

impl RestingEdge {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Joined => "joined",
            Self::DeadZone => "dead_zone",
        }
    }
}

/// A resting motion's interval along ρ at one η.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RestingSlice {
    /// η
    pub eta: f64,
    /// Impacts in a period of the motion; 1 where they are a complete chatter.
    pub p: u32,
    /// Drive periods in a period of the motion.
    pub n: u32,
    /// Rows that show it, first and last.
    pub interval: (f64, f64),
    /// Its lower edge; `None` where the search's bound comes first.
    pub low: Option<(f64, RestingEdge)>,
    /// Its upper edge.
    pub high: Option<(f64, RestingEdge)>,
}

impl RestingSlice {
    /// Whether it is the motion of p impacts in n periods.
    pub fn is(&self, p: u32, n: u32) -> bool {
        (self.p, self.n) == (p, n)
    }

    /// Whether a clearance lies in it.
    pub fn holds(&self, rho: f64) -> bool {
        let low = self.low.map_or(self.interval.0, |e| e.0);
        let high = self.high.map_or(self.interval.1, |e| e.0);
        (low..=high).contains(&rho)
    }
}

/// (p, n) of the motion that starts at the release; `None`: it does not rest again within
/// `longest` drive periods.
fn from_release(machine: &Machine, eta: f64, rho: f64, longest: u32) -> Option<(u32, u32)> {
    if !(-1.0..1.0).contains(&rho) {
        return None;
    }
    let setting = Setting {
        phase: rho.acos(),
        ..Setting::new(eta, rho)
    };
    let start = Initial {
        x: rho,
        ..Initial::rest()
    };
    let mut simulator = Simulator::new(machine, setting, start).ok()?;
    let (mut impacts, mut rested) = (0, None);
    for _ in 0..longest {
        simulator.advance(setting.period(), &mut |i: &ModelImpact| {
            if rested.is_none() {
                impacts += 1;
                if i.dead_zone > 0.0 {
                    rested = Some((i.tau + i.dead_zone, i.kind));
                }
            }
        });
        if let Some((released, kind)) = rested {
            let n = (released / setting.period()).round().max(1.0) as u32;
            let p = if kind == ImpactKind::ChatterEnd {
                1
            } else {
                impacts
            };
            return Some((p, n));
        }
    }
    None
}

/// All resting motions of at most `longest` drive periods along ρ at one η, from the rows of a
/// grid; edges to 1e-7. Empty for
/// machines whose release is not one state (asymmetric ones).
pub fn resting_slices(
    machine: &Machine,
    eta: f64,
    rows: &[f64],
    longest: u32,
) -> Vec<RestingSlice> {
    let Some(unit) = UnitMass::of(machine) else {
        return Vec::new();
    };
    let (length, rate) = unit.scales();
    let single = unit.machine();
    let label = |rho: f64| from_release(&single, eta / rate, rho / length, longest);
    let labels: Vec<Option<(u32, u32)>> = rows.iter().map(|&rho| label(rho)).collect();
    let mut slices = Vec::new();
    let mut first = 0;
    for k in 1..=rows.len() {
        if k < rows.len() && labels[k] == labels[first] {
            continue;
        }
        if let Some((p, n)) = labels[first] {
            let same = |rho: f64| label(rho) == labels[first];
            let low = (first > 0).then(|| {
                let rho = edge(&same, rows[first], rows[first - 1]);
                let joined = rho / length < -1.0 + 1e-6;
                (
                    rho,
                    if joined {
                        RestingEdge::Joined
                    } else {
                        RestingEdge::DeadZone
                    },
                )
            });
            let high = (k < rows.len())
                .then(|| (edge(&same, rows[k - 1], rows[k]), RestingEdge::DeadZone));
            let interval = (rows[first], rows[k - 1]);
            slices.push(RestingSlice {
                eta,
                p,
                n,
                interval,
                low,
                high,
            });
        }
        first = k;
    }
    slices
}

/// Last argument with a property, between one that has it and one that has not.
fn edge(same: &impl Fn(f64) -> bool, mut inside: f64, mut outside: f64) -> f64 {
    while (outside - inside).abs() > 1e-7 {
        let middle = 0.5 * (inside + outside);
        if same(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}
