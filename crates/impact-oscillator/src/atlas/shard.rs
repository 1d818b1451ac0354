//! Atlases beyond one machine: a part computes every N-th row of the three brute-force maps,
//! exactly as the whole has it, and a merge refuses what does not make up the whole.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::brute::{Maps, brute_maps};
use super::map::{End, Kernel, MapGrid};
use super::settings::AtlasSettings;
use crate::model::{Machine, ModelError};

/// Everything that determines an atlas.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtlasRequest {
    /// The machine.
    pub machine: Machine,
    /// Grid and march; the kernel is named, for rounding differs between kernels.
    pub settings: AtlasSettings,
}

impl AtlasRequest {
    /// A request with the kernel of this machine where none is named.
    pub fn new(machine: Machine, mut settings: AtlasSettings) -> Self {
        let named = settings.map.kernel;
        settings.map.kernel = Some(named.unwrap_or_else(Kernel::of_this_machine));
        Self { machine, settings }
    }
}

/// One part of an atlas: the rows number, number + of, number + 2·of …
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtlasPart {
    /// Version of the program that computed it.
    pub version: String,
    /// The whole atlas' request.
    pub request: AtlasRequest,
    /// The whole as a study to be replayed, as it is written; empty where there is none.
    pub study: String,
    /// This part's number, 0 ≤ number < of.
    pub number: usize,
    /// Number of parts.
    pub of: usize,
    /// What its cells settle on in the three maps, row by row.
    pub maps: Maps,
}

/// Why parts do not make up an atlas.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum MergeError {
    /// There is no part.
    #[error("there is no part to merge")]
    Nothing,
    /// A part belongs to another atlas, or to another division of it.
    #[error(
        "part {number} of {of} belongs to another atlas: program, machine, grid, settings or kernel differ from the first part's"
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

fn rows(count: usize, number: usize, of: usize) -> Vec<usize> {
    (number..count).step_by(of.max(1)).collect()
}

/// Compute one part; what study it belongs to is left to the caller.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range, or the part's number is not below `of`.
pub fn part(request: &AtlasRequest, number: usize, of: usize) -> Result<AtlasPart, ModelError> {
    if number >= of {
        return Err(ModelError::Unsupported(
            "a part's number lies below the number of parts",
        ));
    }
    let (grid, map) = (&request.settings.grid, &request.settings.map);
    if !map.kernel.is_none_or(Kernel::is_available) {
        return Err(ModelError::Unsupported(
            "this processor does not run the atlas' kernel: name one that all machines run",
        ));
    }
    let chosen = rows(grid.rho.len(), number, of);
    let own = MapGrid {
        eta: grid.eta.clone(),
        rho: chosen.iter().map(|&k| grid.rho[k]).collect(),
    };
    Ok(AtlasPart {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        request: request.clone(),
        study: String::new(),
        number,
        of,
        maps: brute_maps(&request.machine, &own, map)?,
    })
}

/// Put the parts together to the whole's maps.
///
/// # Errors
/// [`MergeError`] where a part is missing, doubled, damaged or of another atlas.
///
/// ```
/// use impact_oscillator::atlas::shard::{AtlasRequest, merge, part};
/// use impact_oscillator::atlas::{AtlasSettings, MapGrid, MapSettings, brute_maps};
/// use impact_oscillator::Machine;
///
/// let machine = Machine::symmetric(0.07, 0.9);
/// let settings = AtlasSettings {
///     grid: MapGrid::even((0.9, 1.5, 5), (0.5, 3.0, 4)),
///     largest_p: 2,
///     largest_n: 2,
///     map: MapSettings::default(),
/// };
/// let request = AtlasRequest::new(machine.clone(), settings.clone());
/// let parts = [part(&request, 0, 2)?, part(&request, 1, 2)?];
/// let whole = brute_maps(&machine, &settings.grid, &settings.map)?;
/// assert_eq!(merge(&parts), Ok(whole));
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn merge(parts: &[AtlasPart]) -> Result<Maps, MergeError> {
    let first = parts.first().ok_or(MergeError::Nothing)?;
    let (grid, of) = (&first.request.settings.grid, first.of);
    let columns = grid.eta.len();
    let mut whole: [Vec<Option<End>>; 3] = [0, 1, 2].map(|_| vec![None; grid.len()]);
    let mut seen = vec![false; of];
    for part in parts {
        let number = part.number;
        let alike = part.request == first.request && part.study == first.study;
        let same = alike && part.version == first.version;
        if !same || part.of != of || number >= of {
            return Err(MergeError::Foreign {
                number,
                of: part.of,
            });
        }
        if std::mem::replace(&mut seen[number], true) {
            return Err(MergeError::Doubled { number });
        }
        let chosen = rows(grid.rho.len(), number, of);
        let expected = chosen.len() * columns;
        for (map, own) in whole.iter_mut().zip(&part.maps) {
            if own.len() != expected {
                return Err(MergeError::Damaged {
                    number,
                    found: own.len(),
                    expected,
                });
            }
            for (i, end) in own.iter().enumerate() {
                map[chosen[i / columns] * columns + i % columns] = Some(*end);
            }
        }
    }
    let missing: Vec<usize> = (0..of).filter(|&k| !seen[k]).collect();
    if !missing.is_empty() {
        return Err(MergeError::Missing {
            numbers: missing,
            of,
        });
    }
    Ok(whole.map(|map| map.into_iter().flatten().collect()))
}
