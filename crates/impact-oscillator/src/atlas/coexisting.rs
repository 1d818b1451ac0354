//! Motions that coexist: beside the one that a cell settles on, another that is stable there.

use super::map::MapGrid;
use crate::model::boundary::rho_grazing;
use crate::model::orbit::Branch;
use crate::model::patience;
use crate::model::{Machine, ModelError, SettledMotion};
use crate::parallel;

/// Greatest n of the motions z = 1/n that are looked for.
pub const MOST_PERIODS: u32 = 5;

/// The motions of one η whose existence and stability have a closed form: z = 1/n and z = 0.
struct Column {
    grazing: f64,
    branches: Vec<Branch>,
}

impl Column {
    fn new(machine: &Machine, eta: f64) -> Self {
        let branch = |n| Branch::new(machine, eta, n);
        Self {
            grazing: rho_grazing(machine, eta),
            branches: (1..=MOST_PERIODS).map(branch).collect(),
        }
    }

    /// A stable motion at a clearance other than one.
    fn other(&self, machine: &Machine, rho: f64, than: SettledMotion) -> Option<SettledMotion> {
        let impactless = (SettledMotion::Impactless != than && rho > self.grazing)
            .then_some(SettledMotion::Impactless);
        impactless.or_else(|| {
            let motions = self.branches.iter();
            let motions = motions.map(|b| (b, SettledMotion::periodic(1, b.n)));
            let mut others = motions.filter(|(_, motion)| *motion != than);
            let found = others.find(|(branch, _)| branch.stable_orbit(machine, rho).is_some());
            found.map(|(_, motion)| motion)
        })
    }
}

/// Beside each cell's motion of the first map another one: that of a further map (from another start, or carried
/// from cell to cell) where it differs, else z = 0 or a stable z = 1/n by its closed form; the cell's own motion
/// where there is no other, or where it has not settled.
///
/// # Errors
/// [`ModelError`] where nobody wants them any longer.
///
/// ```
/// use impact_oscillator::atlas::coexisting::beside;
/// use impact_oscillator::{Machine, MapGrid, MapSettings, region_map};
///
/// // between grazing and the saddle-node of z = 1
/// let machine = Machine::symmetric(0.07, 0.9);
/// let grid = MapGrid::even((1.3, 1.4, 2), (2.0, 2.2, 2));
/// let rest = region_map(&machine, &grid, &MapSettings::default())?.cells;
/// let other = beside(&machine, &grid, &[&rest])?;
/// assert!(rest.iter().all(|m| m.label() == "0") && other.iter().all(|m| m.label() == "1"));
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn beside(
    machine: &Machine,
    grid: &MapGrid,
    maps: &[&[SettledMotion]],
) -> Result<Vec<SettledMotion>, ModelError> {
    let Some((first, others)) = maps.split_first() else {
        return Ok(Vec::new());
    };
    let columns: Vec<Column> = grid.eta.iter().map(|e| Column::new(machine, *e)).collect();
    let other = |&i: &usize| {
        let own = first[i];
        let is_known = |m: &SettledMotion| *m != SettledMotion::NotSettled;
        let mut simulated = others.iter().map(|map| map[i]);
        let found = simulated.find(|m| *m != own && is_known(m));
        let known = || columns[i % columns.len()].other(machine, grid.at(i).1, own);
        if patience::is_over() || !is_known(&own) {
            own
        } else {
            found.or_else(known).unwrap_or(own)
        }
    };
    let cells: Vec<usize> = (0..grid.len()).collect();
    let found = parallel::map(&cells, other);
    patience::still_wanted().map(|()| found)
}
