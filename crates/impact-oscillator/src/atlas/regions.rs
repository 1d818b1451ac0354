//! The complete atlas: regions of existence and stability of all motions z = p/n in the (η, ρ)
//! plane, column by column, each followed to both its edges; with the boundaries as curves and
//! a brute-force map beside it.

use std::collections::BTreeMap;

use super::agreement::{Agreement, compare};
use super::brute::{Maps, brute_maps};
use super::continuation::Along;
use super::curves::{Curve, curves};
use super::line::{Line, Slice, Span};
use super::map::{End, MapGrid, march_grid};
use super::resting::{RestingSlice, resting_slices};
use super::settings::AtlasSettings;
use crate::model::{Machine, ModelError, SettledMotion};
use crate::parallel;

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
    pub maps: [Vec<SettledMotion>; 3],
    /// How curves and maps agree.
    pub agreement: Agreement,
}

impl Atlas {
    /// A motion of each cell beside the one from the start, where there is another: continued
    /// in rising or falling η, else by the regions of the curves.
    pub fn other_motions(&self, grid: &MapGrid) -> Vec<SettledMotion> {
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
///
/// ```
/// use impact_oscillator::atlas::{AtlasSettings, EdgeKind, MapGrid, MapSettings, atlas};
/// use impact_oscillator::Machine;
///
/// let settings = AtlasSettings {
///     grid: MapGrid::even((1.2, 1.3, 2), (0.5, 5.0, 19)),
///     largest_p: 1,
///     largest_n: 1,
///     map: MapSettings::default(),
/// };
/// let atlas = atlas(&Machine::symmetric(0.07, 0.9), &settings)?;
/// let slice = atlas.slices.iter().find(|s| s.eta == 1.3).expect("z = 1 at η = 1.3");
/// assert_eq!(slice.high.kind, EdgeKind::SaddleNode);
/// assert!((slice.high.orbit.rho - 4.151_754).abs() < 1e-6);
/// assert!(atlas.agreement.differing.is_empty());
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
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
    let chosen: Vec<usize> = chosen.collect();
    parallel::map(&chosen, |&i| column(machine, settings, maps, i))
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
    let resting = resting_slices(machine, grid, most, settings.map.kernel, maps);
    let rows = (grid.rho.first(), grid.rho.last());
    let range = (
        rows.0.copied().unwrap_or(0.0),
        rows.1.copied().unwrap_or(0.0),
    );
    let largest_n = settings.largest_n;
    let curves = curves(machine, &grid.eta, range, largest_n, &columns, &resting);
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
pub(super) fn slices_at(
    machine: &Machine,
    eta: f64,
    settings: &AtlasSettings,
) -> Result<Vec<Slice>, ModelError> {
    let mut settings = settings.clone();
    settings.grid.eta = vec![eta];
    let map = march_grid(machine, &settings.grid, &settings.map)?;
    Ok(column(machine, &settings, &[map], 0))
}

/// All slices of one column.
fn column(machine: &Machine, settings: &AtlasSettings, maps: &[Vec<End>], i: usize) -> Vec<Slice> {
    let line = Line {
        machine,
        settings,
        along: Along::Clearance,
        number: i,
    };
    let eta = settings.grid.eta[i];
    let slice = |span: Span| Slice {
        eta,
        p: span.p,
        n: span.n,
        low: span.low,
        high: span.high,
    };
    line.spans(maps).into_iter().map(slice).collect()
}

/// All motions at one ρ with their edges along η: see [`atlas`]; the settings' rows are ignored.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range.
pub(super) fn spans_at_clearance(
    machine: &Machine,
    rho: f64,
    settings: &AtlasSettings,
) -> Result<Vec<Span>, ModelError> {
    let mut settings = settings.clone();
    settings.grid.rho = vec![rho];
    let maps = brute_maps(machine, &settings.grid, &settings.map)?;
    let line = Line {
        machine,
        settings: &settings,
        along: Along::FrequencyRatio,
        number: 0,
    };
    Ok(line.spans(&maps))
}
