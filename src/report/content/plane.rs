//! What the report shows in the (η, ρ) plane: boundaries, brackets and regions.

use serde::{Deserialize, Serialize};

use crate::motion::Motion;
use crate::record::Sweep;

/// Kind of a boundary in the (η, ρ) plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BoundaryKind {
    /// Period doubling of a z = 1/n motion.
    S1,
    /// Saddle-node of a z = 1/n motion.
    S2,
    /// Grazing of the impactless motion, ρ'.
    Grazing,
    /// Any other edge between two motions.
    Edge,
}

impl BoundaryKind {
    /// The name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::S1 => "s1",
            Self::S2 => "s2",
            Self::Grazing => "grazing",
            Self::Edge => "edge",
        }
    }

    /// The paper's symbol in the report's markup.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::S1 => "$s_1$",
            Self::S2 => "$s_2$",
            Self::Grazing => "$ρ$′",
            Self::Edge => "edge",
        }
    }
}

/// A boundary as measured: it lies between two neighbouring records.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BracketRow {
    /// Which boundary.
    pub kind: BoundaryKind,
    /// The impact motion that ends or begins there.
    pub motion: Motion,
    /// Clearance r, m.
    pub clearance_m: f64,
    /// ρ, where x_st is known.
    pub rho: Option<f64>,
    /// The last record on the low side, Hz.
    pub frequency_low_hz: f64,
    /// The first record on the high side, Hz.
    pub frequency_high_hz: f64,
    /// η of the low side.
    pub eta_low: Option<f64>,
    /// η of the high side.
    pub eta_high: Option<f64>,
    /// Direction of the sweep that met it.
    pub direction: Sweep,
    /// The boundary as the fitted model has it, Hz.
    pub simulated_hz: Option<f64>,
    /// Names of the two records, low and high.
    #[serde(default)]
    pub records: Option<[String; 2]>,
    /// Why it was not used in the fit, where it was not.
    #[serde(default)]
    pub left_out: Option<String>,
}

/// A simulated boundary in the (η, ρ) plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BoundaryCurve {
    /// Which boundary.
    pub kind: BoundaryKind,
    /// n of the z = 1/n motion it bounds; 1 for grazing.
    pub periods_n: u32,
    /// Points (η, ρ) in order along the curve.
    pub points: Vec<[f64; 2]>,
    /// (η, lowest ρ, highest ρ) of the 95 % band; empty where none was computed.
    #[serde(default)]
    pub band95: Vec<[f64; 3]>,
}

/// Simulated regions of motion on a grid of the (η, ρ) plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RegionMap {
    /// η of the columns, ascending and evenly spaced.
    pub eta: Vec<f64>,
    /// ρ of the rows, ascending and evenly spaced.
    pub rho: Vec<f64>,
    /// The motions met; `cells` point into it.
    pub motions: Vec<Motion>,
    /// Index into `motions`, row by row: cell of (η_i, ρ_j) at j · eta.len() + i.
    pub cells: Vec<u16>,
    /// The same from other initial conditions: where it differs lies hysteresis. May be empty.
    #[serde(default)]
    pub second: Vec<u16>,
    /// How the map was made (start, number of periods), in words.
    #[serde(default)]
    pub note: String,
}

impl RegionMap {
    /// A map from the motion of each cell, row by row as in `cells`, and, where `second` is not
    /// empty, from its motion from other initial conditions.
    pub fn of_motions(
        eta: Vec<f64>,
        rho: Vec<f64>,
        first: &[Motion],
        second: &[Motion],
        note: &str,
    ) -> Self {
        let mut motions = Vec::new();
        let (cells, second) = (indices(first, &mut motions), indices(second, &mut motions));
        Self {
            eta,
            rho,
            motions,
            cells,
            second,
            note: note.to_owned(),
        }
    }
}

/// Motions as indices into those met so far.
fn indices(motions: &[Motion], met: &mut Vec<Motion>) -> Vec<u16> {
    let mut index = |motion: &Motion| {
        let known = met.iter().position(|m| m == motion);
        known.unwrap_or_else(|| {
            met.push(motion.clone());
            met.len() - 1
        }) as u16
    };
    motions.iter().map(&mut index).collect()
}

/// A setting proposed for measuring next.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ProposedPoint {
    /// η with the fitted f0.
    pub eta: f64,
    /// ρ with the fitted x_st.
    pub rho: f64,
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Half the gap, m.
    pub clearance_m: f64,
}
