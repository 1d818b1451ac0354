//! A study as it is written.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use impact_oscillator::atlas::portrait::PortraitPlan;
use impact_oscillator::atlas::{AtlasSettings, BasinGrid, MapGrid, MapSettings};
use impact_oscillator::model::params::Asymmetry;
use impact_oscillator::model::{Initial, Machine, Restitution, Setting, Watch};

/// A study: a machine and the pieces of work to compute of it, each by its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// What it shows.
    pub title: String,
    /// β
    pub damping_ratio: f64,
    /// R, a number or a law R(v).
    pub restitution: RestitutionLaw,
    /// One mass against a fixed stop instead of two against each other.
    #[serde(default)]
    pub single: bool,
    /// How the second mass differs from the first.
    #[serde(default)]
    pub asymmetry: Asymmetry,
    /// Motions in full.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub time_series: BTreeMap<String, PortraitPlan>,
    /// Quasi-stationary sweeps.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sweep: BTreeMap<String, SweepPlan>,
    /// Basins of attraction.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub basins: BTreeMap<String, BasinPlan>,
    /// Region maps by brute force.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub map: BTreeMap<String, MapPlan>,
    /// Regions of existence and stability.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub regions: BTreeMap<String, RegionsPlan>,
}

/// R as a number or as a law R(v).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum RestitutionLaw {
    /// The same at every speed.
    Constant(f64),
    /// By the approach speed.
    Law(Restitution),
}

impl RestitutionLaw {
    /// The law as the model has it.
    pub fn restitution(&self) -> Restitution {
        match self {
            Self::Constant(r) => Restitution::Constant(*r),
            Self::Law(law) => law.clone(),
        }
    }
}

/// A quasi-stationary sweep along a straight line in the (η, ρ) plane, there and back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepPlan {
    /// First and last η.
    pub eta: (f64, f64),
    /// First and last ρ.
    pub rho: (f64, f64),
    /// Number of steps.
    pub steps: usize,
    /// Start of the sweep there and of the sweep back.
    #[serde(default)]
    pub start: Initial,
    /// Settling and watch at every step.
    #[serde(default)]
    pub watch: Watch,
}

/// Basins of attraction in the plane of the starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BasinPlan {
    /// η, ρ and φ.
    pub setting: Setting,
    /// The starts.
    pub grid: BasinGrid,
    /// R in place of the study's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// Settling and watch.
    #[serde(default)]
    pub watch: Watch,
}

/// The motion that each cell of a grid in the (η, ρ) plane settles on from one start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapPlan {
    /// First and last η, number of columns.
    pub eta: (f64, f64, usize),
    /// First and last ρ, number of rows.
    pub rho: (f64, f64, usize),
    /// Start, settling and watch of every cell.
    #[serde(default)]
    pub map: MapSettings,
}

/// Regions of all motions in the (η, ρ) plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegionsPlan {
    /// First and last η, number of columns.
    pub eta: (f64, f64, usize),
    /// First and last ρ, number of rows.
    pub rho: (f64, f64, usize),
    /// Greatest number of impacts in a period of the motion.
    pub largest_p: u32,
    /// Greatest number of drive periods in a period of the motion.
    pub largest_n: u32,
    /// How the brute-force maps are marched.
    #[serde(default)]
    pub map: MapSettings,
}

impl RegionsPlan {
    /// The atlas' settings.
    pub fn settings(&self) -> AtlasSettings {
        AtlasSettings {
            grid: MapGrid::even(self.eta, self.rho),
            largest_p: self.largest_p,
            largest_n: self.largest_n,
            map: self.map,
        }
    }
}

impl Study {
    /// A study of a machine without any work.
    pub fn empty(title: &str, damping_ratio: f64, restitution: RestitutionLaw) -> Self {
        Self {
            title: title.to_owned(),
            damping_ratio,
            restitution,
            single: false,
            asymmetry: Asymmetry::default(),
            time_series: BTreeMap::new(),
            sweep: BTreeMap::new(),
            basins: BTreeMap::new(),
            map: BTreeMap::new(),
            regions: BTreeMap::new(),
        }
    }

    /// The machine.
    pub fn machine(&self) -> Machine {
        let machine = if self.single {
            Machine::single(self.damping_ratio, 0.0)
        } else if self.asymmetry == Asymmetry::default() {
            Machine::symmetric(self.damping_ratio, 0.0)
        } else {
            Machine::asymmetric(self.damping_ratio, 0.0, self.asymmetry)
        };
        machine.with_restitution(self.restitution.restitution())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_study_is_the_same_after_writing_and_reading() {
        let mut study = Study::empty(
            "R(v)",
            0.07,
            RestitutionLaw::Law(Restitution::Table(vec![(0.0, 0.9)])),
        );
        study.asymmetry.mass = 1.1;
        let plan = SweepPlan {
            eta: (0.9, 1.4),
            rho: (3.0, 3.0),
            steps: 11,
            start: Initial::both(-0.1, 0.2),
            watch: Watch::default(),
        };
        study.sweep.insert("there and back".into(), plan);
        let text = toml::to_string(&study).unwrap();
        assert_eq!(toml::from_str::<Study>(&text).unwrap(), study);
        assert!(toml::from_str::<Study>(&text.replace("steps", "stesp")).is_err());
    }
}
