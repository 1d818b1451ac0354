//! The complete atlas: regions of existence and stability of all motions z = p/n in the (η, ρ)
//! plane, column by column, each followed to both its edges; with the boundaries as curves and
//! a brute-force map beside it.

use std::collections::{BTreeMap, VecDeque};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::agreement::{Agreement, compare};
use super::brute::{Maps, Way, brute_map, brute_maps};
use super::continuation::{Along, Edge, EdgeKind, Walk, branch_at_doubling, follow};
use super::curves::{Curve, curves};
use super::map::{CellMotion, End, MapGrid, MapSettings, clear_of};
use super::resting::{RestingSlice, resting_slices};
use crate::model::orbit::stable_orbit;
use crate::model::{
    Existence, Initial, Machine, ModelError, ModelImpact, PeriodicOrbit, Setting, Simulator, rho_s2,
};

/// What an atlas covers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtlasSettings {
    /// Columns (η) along which regions are followed, and rows of the brute-force map.
    pub grid: MapGrid,
    /// Most impacts in a period of the motion.
    pub largest_p: u32,
    /// Most drive periods in a period of the motion.
    pub largest_n: u32,
    /// How the brute-force maps are marched.
    #[serde(default)]
    pub map: MapSettings,
}

/// One motion's interval of existence and stability along ρ at one η.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Slice {
    /// η
    pub eta: f64,
    /// Impacts in a period of the motion.
    pub p: u32,
    /// Drive periods in a period of the motion.
    pub n: u32,
    /// Its lower edge.
    pub low: Edge,
    /// Its upper edge.
    pub high: Edge,
}

impl Slice {
    /// The motion.
    pub fn motion(&self) -> CellMotion {
        CellMotion::Periodic {
            p: self.p as u16,
            n: self.n as u16,
            dead_zone: false,
            chatter: false,
        }
    }

    /// Whether a clearance lies in it.
    pub fn holds(&self, rho: f64) -> bool {
        self.low.orbit.rho <= rho && rho <= self.high.orbit.rho
    }
}

/// The atlas of a machine.
#[derive(Debug, Clone)]
pub struct Atlas {
    /// All slices, by η.
    pub slices: Vec<Slice>,
    /// Motions that rest in a dead zone, by η.
    pub resting: Vec<RestingSlice>,
    /// The boundaries.
    pub curves: Vec<Curve>,
    /// The brute-force maps: from the start, rising, falling.
    pub maps: [Vec<CellMotion>; 3],
    /// How curves and maps agree.
    pub agreement: Agreement,
}

impl Atlas {
    /// A motion of each cell beside the one from the start, where there is another: carried along
    /// rising or falling, else by the regions of the curves.
    pub fn other_motions(&self, grid: &MapGrid) -> Vec<CellMotion> {
        let mut by_eta: BTreeMap<u64, Vec<&Slice>> = BTreeMap::new();
        for s in &self.slices {
            by_eta.entry(s.eta.to_bits()).or_default().push(s);
        }
        let other = |i: usize| {
            let first = self.maps[0][i];
            let (eta, rho) = grid.at(i);
            let carried = [self.maps[1][i], self.maps[2][i]];
            let there = by_eta.get(&eta.to_bits()).into_iter().flatten();
            let by_curves = there
                .filter(|s| s.holds(rho))
                .min_by_key(|s| (s.p, s.n))
                .map(|s| s.motion());
            let all = carried.into_iter().chain(by_curves);
            all.into_iter().find(|m| *m != first).unwrap_or(first)
        };
        (0..grid.len()).map(other).collect()
    }
}

/// Compute the atlas of a machine.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range.
pub fn atlas(machine: &Machine, settings: &AtlasSettings) -> Result<Atlas, ModelError> {
    let maps = brute_maps(machine, &settings.grid, &settings.map)?;
    let columns = columns(machine, settings, &maps, 0..settings.grid.eta.len());
    Ok(assemble(machine, settings, &maps, columns))
}

/// The slices of some columns, each with its own list; see [`atlas`].
pub fn columns(
    machine: &Machine,
    settings: &AtlasSettings,
    maps: &Maps,
    chosen: std::ops::Range<usize>,
) -> Vec<Vec<Slice>> {
    chosen
        .into_par_iter()
        .map(|i| column(machine, settings, maps, i))
        .collect()
}

/// The atlas from its maps and the slices of all its columns.
pub fn assemble(
    machine: &Machine,
    settings: &AtlasSettings,
    maps: &Maps,
    columns: Vec<Vec<Slice>>,
) -> Atlas {
    let grid = &settings.grid;
    let most = (settings.largest_p, settings.largest_n);
    let resting = resting_slices(machine, grid, most, settings.map.kernel);
    let rows = (grid.rho.first(), grid.rho.last());
    let range = (
        rows.0.copied().unwrap_or(0.0),
        rows.1.copied().unwrap_or(0.0),
    );
    let along = (grid.eta.as_slice(), range);
    let curves = curves(machine, along, settings.largest_n, &columns, &resting);
    let slices: Vec<Slice> = columns.into_iter().flatten().collect();
    let resting: Vec<RestingSlice> = resting.into_iter().flatten().collect();
    let agreement = compare(machine, settings, maps, &slices, &resting);
    let maps = [0, 1, 2].map(|k| maps[k].iter().map(|end| end.motion).collect());
    Atlas {
        slices,
        resting,
        curves,
        maps,
        agreement,
    }
}

/// All slices at one η: see [`atlas`]; the settings' columns are ignored.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range.
pub fn slices_at(
    machine: &Machine,
    eta: f64,
    settings: &AtlasSettings,
) -> Result<Vec<Slice>, ModelError> {
    let mut settings = settings.clone();
    settings.grid.eta = vec![eta];
    let map = brute_map(machine, &settings.grid, &settings.map, Way::FromStart)?;
    Ok(column(machine, &settings, &[map], 0))
}

/// All slices of one column: from closed forms, from the maps' cells, from period doublings.
fn column(machine: &Machine, settings: &AtlasSettings, maps: &[Vec<End>], i: usize) -> Vec<Slice> {
    let eta = settings.grid.eta[i];
    let mut seeds: VecDeque<PeriodicOrbit> = closed_form_seeds(machine, eta, settings.largest_n);
    let cells = cell_seeds(settings, maps, i);
    let mut slices: Vec<Slice> = Vec::new();
    let mut cells = cells.into_iter();
    loop {
        let seed = match seeds.pop_front() {
            Some(seed) => seed,
            None => match cells.next() {
                Some((p, n, rho, end)) => {
                    if known(&slices, p, n, rho) {
                        continue;
                    }
                    match orbit_of_cell(machine, (eta, rho), &end, (p, n)) {
                        Some(orbit) => orbit,
                        None => continue,
                    }
                }
                None => return slices,
            },
        };
        if known(&slices, seed.p() as u32, seed.n, seed.rho) {
            continue;
        }
        if let Some(slice) = slice(machine, settings, &seed) {
            for edge in [&slice.low, &slice.high] {
                let fits = 2 * slice.p <= settings.largest_p && 2 * slice.n <= settings.largest_n;
                if edge.kind == EdgeKind::PeriodDoubling && fits {
                    seeds.extend(branch_at_doubling(machine, &edge.orbit, Along::Clearance));
                }
            }
            slices.push(slice);
        }
    }
}

fn known(slices: &[Slice], p: u32, n: u32, rho: f64) -> bool {
    slices.iter().any(|s| s.p == p && s.n == n && s.holds(rho))
}

/// z = 1/n just inside its saddle-node.
fn closed_form_seeds(machine: &Machine, eta: f64, largest_n: u32) -> VecDeque<PeriodicOrbit> {
    let seed = |n: u32| {
        let s2 = rho_s2(machine, eta, n)?;
        let setting = Setting::new(eta, s2.rho - 1e-4 * (0.1 + s2.rho.abs()));
        let orbit = stable_orbit(machine, setting, n).ok()??;
        let t = orbit.phase_at_impact / eta;
        let (times, speeds) = (vec![t], vec![orbit.closing_speed]);
        PeriodicOrbit {
            n,
            eta,
            rho: setting.clearance,
            times,
            speeds,
        }
        .solve(machine)
    };
    (1..=largest_n).filter_map(seed).collect()
}

type CellSeed = (u32, u32, f64, End);

/// The middle cell of every run of equal periodic cells in a column of each map.
fn cell_seeds(settings: &AtlasSettings, maps: &[Vec<End>], i: usize) -> Vec<CellSeed> {
    let (columns, rho) = (settings.grid.eta.len(), &settings.grid.rho);
    let mut seeds = Vec::new();
    for map in maps {
        let at = |k: usize| map[k * columns + i];
        let mut first = 0;
        for k in 1..=rho.len() {
            if k < rho.len() && at(k).motion == at(first).motion {
                continue;
            }
            let middle = (first + k - 1) / 2;
            if let CellMotion::Periodic {
                p,
                n,
                dead_zone: false,
                ..
            } = at(middle).motion
            {
                let (p, n) = (u32::from(p), u32::from(n));
                if p <= settings.largest_p && n <= settings.largest_n {
                    seeds.push((p, n, rho[middle], at(middle)));
                }
            }
            first = k;
        }
    }
    seeds
}

/// The orbit that a cell's end lies on.
fn orbit_of_cell(
    machine: &Machine,
    (eta, rho): (f64, f64),
    end: &End,
    (p, n): (u32, u32),
) -> Option<PeriodicOrbit> {
    let setting = Setting {
        phase: end.phase,
        ..Setting::new(eta, rho)
    };
    let initial: Initial = clear_of(machine, rho, end.initial);
    let mut simulator = Simulator::new(machine, setting, initial).ok()?;
    let mut impacts: Vec<ModelImpact> = Vec::new();
    let periods = f64::from(2 * n + 1);
    simulator.advance(periods * setting.period(), &mut |i: &ModelImpact| {
        impacts.push(*i);
    });
    let last = impacts.len().checked_sub(p as usize)?;
    let orbit = PeriodicOrbit::from_impacts(&impacts[last..], setting, n)?
        .solve(machine)?
        .reduced();
    let good = orbit.existence(machine) == Existence::Exists && orbit.is_stable(machine);
    good.then_some(orbit)
}

fn slice(machine: &Machine, settings: &AtlasSettings, seed: &PeriodicOrbit) -> Option<Slice> {
    let rho = &settings.grid.rho;
    let (first, last) = (rho.first()?, rho.last()?);
    let walk = Walk {
        least: *first,
        greatest: *last,
        resolution: 1e-7,
        ..Walk::default()
    };
    let edge = |direction| follow(machine, seed, Along::Clearance, direction, &walk);
    let (low, high) = (edge(-1.0), edge(1.0));
    let (eta, p, n) = (seed.eta, seed.p() as u32, seed.n);
    Some(if low.orbit.rho <= high.orbit.rho {
        Slice {
            eta,
            p,
            n,
            low,
            high,
        }
    } else {
        Slice {
            eta,
            p,
            n,
            low: high,
            high: low,
        }
    })
}
