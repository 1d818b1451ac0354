//! Basins of attraction: on which motion every start (X(0), X'(0)) settles at one (η, ρ, φ)
//! (Fig. 5 of the paper).

use serde::{Deserialize, Serialize};

use super::grid::{MapSettings, Start, even};
use super::map::march_from;
use crate::model::{Initial, Machine, ModelError, Setting, SettledMotion};

/// Which masses take the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Starts {
    /// Both masses alike, as in Fig. 5.
    #[default]
    BothMasses,
    /// X alone; Y starts at rest at zero.
    OneMass,
}

/// The starts to try.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BasinGrid {
    /// X(0): first, last, count.
    pub x: (f64, f64, usize),
    /// X'(0): first, last, count.
    pub vx: (f64, f64, usize),
    /// Which masses take the start.
    #[serde(default)]
    pub starts: Starts,
}

/// Basins of attraction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Basins {
    /// X(0) of the columns.
    pub x: Vec<f64>,
    /// X'(0) of the rows.
    pub vx: Vec<f64>,
    /// Motions row by row; `None`: the start is beyond the contact.
    pub cells: Vec<Option<SettledMotion>>,
}

impl BasinGrid {
    /// Number of rows: X'(0).
    pub fn rows(&self) -> usize {
        self.vx.2
    }

    fn initial(&self, x: f64, vx: f64) -> Initial {
        match self.starts {
            Starts::BothMasses => Initial::both(x, vx),
            Starts::OneMass => Initial {
                x,
                vx,
                ..Initial::rest()
            },
        }
    }
}

/// Settle every start of a grid in a setting.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range.
///
/// ```
/// use impact_oscillator::atlas::{BasinGrid, Starts, basins};
/// use impact_oscillator::{Machine, MapSettings, Setting};
///
/// // Fig. 5 of the paper: z = 0 and z = 1 coexist at η = 1.19, ρ = 3 with R = 0
/// let machine = Machine::symmetric(0.005, 0.0);
/// let grid = BasinGrid {
///     x: (-12.0, 3.0, 11),
///     vx: (-12.0, 12.0, 11),
///     starts: Starts::BothMasses,
/// };
/// let basins = basins(&machine, Setting::new(1.19, 3.0), &grid, &MapSettings::default())?;
/// let count = |label: &str| basins.cells.iter().flatten().filter(|m| m.label() == label).count();
/// assert!(count("1") > 5 * count("0") && count("0") > 0);
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn basins(
    machine: &Machine,
    setting: Setting,
    grid: &BasinGrid,
    settings: &MapSettings,
) -> Result<Basins, ModelError> {
    Ok(Basins {
        x: even(grid.x),
        vx: even(grid.vx),
        cells: basin_rows(machine, setting, grid, settings, 0..grid.rows())?,
    })
}

/// The cells of some rows of a grid; they do not depend on the others.
///
/// # Errors
/// As [`basins`].
pub fn basin_rows(
    machine: &Machine,
    setting: Setting,
    grid: &BasinGrid,
    settings: &MapSettings,
    rows: std::ops::Range<usize>,
) -> Result<Vec<Option<SettledMotion>>, ModelError> {
    machine.check()?;
    setting.check()?;
    let (x, vx) = (even(grid.x), even(grid.vx));
    let vx = vx.get(rows).unwrap_or_default();
    let gap = machine.gap(setting.clearance);
    let clear = |s: &Initial| s.x + if machine.y.is_some() { s.y } else { 0.0 } <= gap;
    let start = |i: usize| Start {
        at: (setting.frequency_ratio, setting.clearance),
        initial: grid.initial(x[i % x.len()], vx[i / x.len()]),
        phase: setting.phase,
    };
    let (numbers, starts): (Vec<usize>, Vec<Start>) = (0..x.len() * vx.len())
        .map(|i| (i, start(i)))
        .filter(|(_, s)| clear(&s.initial))
        .unzip();
    let ends = march_from(machine, &starts, settings)?;
    let mut cells = vec![None; x.len() * vx.len()];
    for (i, end) in numbers.into_iter().zip(ends) {
        cells[i] = Some(end.motion);
    }
    Ok(cells)
}
