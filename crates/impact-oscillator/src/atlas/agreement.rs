//! Curves against brute force: every cell of the maps is looked up in the regions of the curves,
//! with the cause for each that is in none.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::brute::{SEEDINGS, Seeding};
use super::grid::End;
use super::line::{Slice, orbit_of_cell};
use super::resting::RestingSlice;
use super::settings::AtlasSettings;
use crate::model::{Existence, Machine, SettledMotion, rho_grazing};

/// How well the curves and the brute-force maps agree.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Cells whose motion the curves can judge.
    pub compared: usize,
    /// Cells whose motion is in no region of the curves.
    pub differing: Vec<Differing>,
    /// Periodic cells beyond the largest p or n.
    pub beyond: usize,
    /// Cells without a period.
    pub aperiodic: usize,
}

/// A cell whose motion is in no region of the curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Differing {
    /// η
    pub eta: f64,
    /// ρ
    pub rho: f64,
    /// The map that it belongs to.
    #[serde(rename = "way")]
    pub seeding: Seeding,
    /// What brute force took it for.
    pub motion: SettledMotion,
    /// Why.
    pub cause: Cause,
}

/// Why a cell's motion is in no region of the curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Cause {
    /// The motion exists and is stable: the curves miss a region.
    NoRegion,
    /// The motion converges to one of fewer impacts, too slowly for its watch: it is just
    /// before that one's period doubling.
    Converges {
        /// Impacts in a period of the motion that it converges to.
        p: u32,
        /// Drive periods in it.
        n: u32,
    },
    /// The orbit on which the cell closes is unstable: a transient that stays near it for longer
    /// than the watch.
    Unstable {
        /// Largest modulus of its multipliers.
        multiplier: f64,
    },
    /// No orbit exists where the cell closes: a transient.
    NoOrbit,
}

/// The slices by the bits of their η.
type ByEta<'a, T> = BTreeMap<u64, Vec<&'a T>>;

fn by_eta<T>(all: &[T], eta: impl Fn(&T) -> f64) -> ByEta<'_, T> {
    let mut sorted: ByEta<'_, T> = BTreeMap::new();
    for s in all {
        sorted.entry(eta(s).to_bits()).or_default().push(s);
    }
    sorted
}

/// All regions of the curves.
struct Regions<'a> {
    machine: &'a Machine,
    moving: ByEta<'a, Slice>,
    resting: ByEta<'a, RestingSlice>,
}

impl Regions<'_> {
    /// Whether a motion is in one of its regions; `None`: the curves do not judge it.
    fn hold(&self, (eta, rho): (f64, f64), motion: SettledMotion) -> Option<bool> {
        let (column, grazing) = (eta.to_bits(), rho_grazing(self.machine, eta));
        match motion {
            SettledMotion::Impactless => Some(rho >= grazing * (1.0 - 1e-9)),
            SettledMotion::Sticking => Some(rho < 0.0),
            SettledMotion::Beat | SettledMotion::Chaotic | SettledMotion::NotSettled => None,
            SettledMotion::Periodic {
                p,
                n,
                dead_zone: true,
                ..
            } => {
                let there = self.resting.get(&column).into_iter().flatten();
                Some(there.into_iter().any(|s| s.is(p, n) && s.holds(rho)))
            }
            SettledMotion::Periodic { p, n, .. } => {
                let there = self.moving.get(&column).into_iter().flatten();
                let is = |s: &Slice| (s.p, s.n) == (p, n);
                Some(there.into_iter().any(|s| is(s) && s.holds(rho)))
            }
        }
    }
}

/// Look every cell of the maps up in the regions of the curves.
pub(super) fn compare(
    machine: &Machine,
    settings: &AtlasSettings,
    maps: &[Vec<End>],
    slices: &[Slice],
    resting: &[RestingSlice],
) -> Agreement {
    let regions = Regions {
        machine,
        moving: by_eta(slices, |s| s.eta),
        resting: by_eta(resting, |s| s.eta),
    };
    let mut agreement = Agreement::default();
    for (map, seeding) in maps.iter().zip(SEEDINGS) {
        for (i, end) in map.iter().enumerate() {
            if is_beyond(settings, end.motion) {
                agreement.beyond += 1;
                continue;
            }
            let (eta, rho) = settings.grid.at(i);
            let Some(held) = regions.hold((eta, rho), end.motion) else {
                agreement.aperiodic += 1;
                continue;
            };
            agreement.compared += 1;
            if !held {
                agreement.differing.push(Differing {
                    eta,
                    rho,
                    seeding,
                    motion: end.motion,
                    cause: cause(machine, (eta, rho), end),
                });
            }
        }
    }
    agreement
}

fn is_beyond(settings: &AtlasSettings, motion: SettledMotion) -> bool {
    match motion {
        SettledMotion::Periodic { p, n, .. } => p > settings.largest_p || n > settings.largest_n,
        _ => false,
    }
}

/// Why a cell is in no region, by the orbit on which its last impacts close.
fn cause(machine: &Machine, at: (f64, f64), end: &End) -> Cause {
    let Some(motion) = end.motion.numbers(false) else {
        return Cause::NoRegion;
    };
    let orbit = orbit_of_cell(machine, at, end, motion);
    let Some(orbit) = orbit.filter(|o| o.existence(machine) == Existence::Exists) else {
        return Cause::NoOrbit;
    };
    let multiplier = orbit
        .multipliers(machine)
        .first()
        .map_or(f64::NAN, |m| m.norm());
    let found = (orbit.p(), orbit.n);
    if !(multiplier < 1.0) {
        Cause::Unstable { multiplier }
    } else if found != motion {
        let (p, n) = found;
        Cause::Converges { p, n }
    } else {
        Cause::NoRegion
    }
}
