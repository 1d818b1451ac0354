//! Curves against brute force: every cell of the maps is looked up in the regions of the curves.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::map::{CellMotion, End};
use super::regions::{AtlasSettings, Slice};
use super::resting::RestingSlice;
use crate::model::{Machine, rho_grazing};

/// How well the curves and the brute-force maps agree.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Cells whose motion the curves can judge.
    pub compared: usize,
    /// Cells whose motion lies in no region of the curves: (η, ρ, motion).
    pub differing: Vec<(f64, f64, CellMotion)>,
    /// Periodic cells beyond the largest p or n.
    pub beyond: usize,
    /// Cells without a period.
    pub aperiodic: usize,
}

/// Look every cell of the maps up in the regions of the curves.
pub fn compare(
    machine: &Machine,
    settings: &AtlasSettings,
    maps: &[Vec<End>],
    slices: &[Slice],
    resting: &[RestingSlice],
) -> Agreement {
    let mut by_eta: BTreeMap<u64, Vec<&Slice>> = BTreeMap::new();
    for s in slices {
        by_eta.entry(s.eta.to_bits()).or_default().push(s);
    }
    let mut rest_by_eta: BTreeMap<u64, Vec<&RestingSlice>> = BTreeMap::new();
    for s in resting {
        rest_by_eta.entry(s.eta.to_bits()).or_default().push(s);
    }
    let mut agreement = Agreement::default();
    for (i, end) in maps.iter().flat_map(|map| map.iter().enumerate()) {
        let (eta, rho) = settings.grid.at(i);
        let found = match end.motion {
            CellMotion::Impactless => rho >= rho_grazing(machine, eta) * (1.0 - 1e-9),
            CellMotion::Joined => rho < 0.0,
            CellMotion::Beat | CellMotion::Chaotic => {
                agreement.aperiodic += 1;
                continue;
            }
            CellMotion::Periodic { p, n, .. }
                if u32::from(p) > settings.largest_p || u32::from(n) > settings.largest_n =>
            {
                agreement.beyond += 1;
                continue;
            }
            CellMotion::Periodic {
                p,
                n,
                dead_zone: true,
                ..
            } => rest_by_eta
                .get(&eta.to_bits())
                .is_some_and(|l| l.iter().any(|s| s.is(p.into(), n.into()) && s.holds(rho))),
            CellMotion::Periodic { p, n, .. } => by_eta.get(&eta.to_bits()).is_some_and(|l| {
                l.iter()
                    .any(|s| s.p == u32::from(p) && s.n == u32::from(n) && s.holds(rho))
            }),
        };
        agreement.compared += 1;
        if !found {
            agreement.differing.push((eta, rho, end.motion));
        }
    }
    agreement
}
