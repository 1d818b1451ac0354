//! Maps beyond one machine: a part computes every N-th cell, exactly as the whole map has it,
//! and a merge refuses what does not make up the whole.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::map::{CellMotion, Kernel, MapGrid, MapSettings, RegionMap, map_cells};
use crate::model::{Machine, ModelError};

/// Everything that determines a map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapRequest {
    /// The machine.
    pub machine: Machine,
    /// The grid.
    pub grid: MapGrid,
    /// How it is marched; the kernel is named, for rounding differs between kernels.
    pub settings: MapSettings,
}

impl MapRequest {
    /// A request with the kernel of this machine where none is named.
    pub fn new(machine: Machine, grid: MapGrid, mut settings: MapSettings) -> Self {
        settings.kernel = Some(settings.kernel.unwrap_or_else(Kernel::of_this_machine));
        Self {
            machine,
            grid,
            settings,
        }
    }
}

/// One part of a map: the cells number, number + of, number + 2·of …
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapPart {
    /// The whole map's request.
    pub request: MapRequest,
    /// This part's number, 0 ≤ number < of.
    pub number: usize,
    /// Number of parts.
    pub of: usize,
    /// Its cells' motions, in the order of the cells' numbers.
    pub cells: Vec<CellMotion>,
}

/// Why parts do not make up a map.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum MergeError {
    /// There is no part.
    #[error("there is no part to merge")]
    Nothing,
    /// A part belongs to another map, or to another division of it.
    #[error(
        "part {number} of {of} belongs to another map: machine, grid, settings or kernel differ from the first part's"
    )]
    Foreign {
        /// The part's number.
        number: usize,
        /// Its number of parts.
        of: usize,
    },
    /// A part is there twice.
    #[error("part {number} is there twice")]
    Doubled {
        /// The part's number.
        number: usize,
    },
    /// Parts are missing.
    #[error("missing parts: {numbers:?} of {of}")]
    Missing {
        /// Their numbers.
        numbers: Vec<usize>,
        /// Number of parts.
        of: usize,
    },
    /// A part has too few or too many cells.
    #[error("part {number} has {found} cells instead of {expected}")]
    Damaged {
        /// The part's number.
        number: usize,
        /// Cells that it has.
        found: usize,
        /// Cells that it should have.
        expected: usize,
    },
}

fn numbers(cells: usize, number: usize, of: usize) -> Vec<usize> {
    (number..cells).step_by(of.max(1)).collect()
}

/// Compute one part.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range, or the part's number is not below `of`.
pub fn part(request: &MapRequest, number: usize, of: usize) -> Result<MapPart, ModelError> {
    if number >= of {
        return Err(ModelError::Unsupported(
            "a part's number lies below the number of parts",
        ));
    }
    let available = request.settings.kernel.is_none_or(Kernel::is_available);
    if !available {
        return Err(ModelError::Unsupported(
            "this processor does not run the map's kernel: name one that all machines run",
        ));
    }
    let chosen = numbers(request.grid.len(), number, of);
    let cells = map_cells(&request.machine, &request.grid, &request.settings, &chosen)?;
    Ok(MapPart {
        request: request.clone(),
        number,
        of,
        cells,
    })
}

/// Put the parts together.
///
/// # Errors
/// [`MergeError`] where a part is missing, doubled, damaged or of another map.
pub fn merge(parts: &[MapPart]) -> Result<RegionMap, MergeError> {
    let first = parts.first().ok_or(MergeError::Nothing)?;
    let (grid, of) = (&first.request.grid, first.of);
    let mut whole: Vec<Option<CellMotion>> = vec![None; grid.len()];
    let mut seen = vec![false; of];
    for part in parts {
        let number = part.number;
        if part.request != first.request || part.of != of || number >= of {
            return Err(MergeError::Foreign {
                number,
                of: part.of,
            });
        }
        if std::mem::replace(&mut seen[number], true) {
            return Err(MergeError::Doubled { number });
        }
        let chosen = numbers(grid.len(), number, of);
        let (found, expected) = (part.cells.len(), chosen.len());
        if found != expected {
            return Err(MergeError::Damaged {
                number,
                found,
                expected,
            });
        }
        for (i, cell) in chosen.into_iter().zip(&part.cells) {
            whole[i] = Some(*cell);
        }
    }
    let missing: Vec<usize> = (0..of).filter(|&k| !seen[k]).collect();
    if !missing.is_empty() {
        return Err(MergeError::Missing {
            numbers: missing,
            of,
        });
    }
    let cells = whole.into_iter().flatten().collect();
    Ok(RegionMap {
        eta: grid.eta.clone(),
        rho: grid.rho.clone(),
        cells,
    })
}
