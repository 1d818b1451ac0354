//! What an atlas covers.

use serde::{Deserialize, Serialize};

use super::grid::{MapGrid, MapSettings};

/// What an atlas covers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtlasSettings {
    /// Columns (η) along which regions are followed, and rows of the brute-force map.
    pub grid: MapGrid,
    /// Greatest number of impacts in a period of the motion.
    pub largest_p: u32,
    /// Greatest number of drive periods in a period of the motion.
    pub largest_n: u32,
    /// How the brute-force maps are marched.
    #[serde(default)]
    pub map: MapSettings,
}
