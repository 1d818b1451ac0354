//! The state of the page: everything that what it shows depends on.
//!
//! As JSON it is the fragment of the page's address and part of every request; as TOML a step of a
//! demo; [`State::study`] makes the study that leaves the same numbers under `impactid study`.

use serde::{Deserialize, Serialize};

use super::ExploreError;
use super::limits::{self, Limit};
use crate::theory::Study;
use crate::theory::plan::{BasinPlan, MapPlan, RestitutionLaw, SweepPlan};
use impact_oscillator::atlas::portrait::PortraitPlan;
use impact_oscillator::atlas::{BasinGrid, MapSettings, Starts};
use impact_oscillator::model::params::Asymmetry;
use impact_oscillator::model::{ModelError, range};
use impact_oscillator::{Initial, Machine, Restitution, Setting, Watch};

/// The version of the state that this program reads and writes.
pub(super) const VERSION: u32 = 1;

/// Everything that the page shows follows from this.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// [`VERSION`].
    pub version: u32,
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
    /// The part of the (η, ρ) plane that is shown.
    pub view: Window,
    /// Start of every cell of the map.
    #[serde(default)]
    pub map_start: Initial,
    /// The motion that is shown.
    pub cursor: Cursor,
    /// Drive periods of its time series.
    #[serde(default = "eight")]
    pub periods: f64,
    /// Samples of it in a drive period.
    #[serde(default = "two_hundred")]
    pub samples_per_period: usize,
    /// Phase of the drive at which the Poincaré map is taken, rad.
    #[serde(default)]
    pub poincare_phase: f64,
    /// Settling and watch of the carried motion and of characteristics, in drive periods.
    #[serde(default)]
    pub watch: Watch,
    /// Where the characteristics are taken.
    #[serde(default)]
    pub line: Option<Line>,
    /// What the lowest picture of the characteristics shows.
    #[serde(default)]
    pub characteristic: Characteristic,
    /// Motions whose trajectories are set into the picture of the characteristics; each settles from its start.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub insets: Vec<Cursor>,
    /// The starts of the basins.
    #[serde(default)]
    pub basins: Option<Starting>,
    /// What is shown beside the map.
    #[serde(default)]
    pub panel: Panel,
    /// Scales of the campaign's rig at the sliders.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rig: Option<RigScale>,
    /// The campaign's record that is shown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub record: Option<String>,
}

fn eight() -> f64 {
    8.0
}

fn two_hundred() -> usize {
    200
}

/// Ranges of η and ρ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// Least and greatest η.
    pub eta: (f64, f64),
    /// Least and greatest ρ.
    pub rho: (f64, f64),
}

/// A motion: where, and from which start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cursor {
    /// η
    pub eta: f64,
    /// ρ
    pub rho: f64,
    /// Phase of the drive at the start, rad.
    #[serde(default)]
    pub phase: f64,
    /// The start.
    #[serde(default)]
    pub start: Initial,
}

impl Cursor {
    /// η, ρ and φ.
    pub fn setting(&self) -> Setting {
        Setting::new(self.eta, self.rho).at_phase(self.phase)
    }
}

/// A line in the (η, ρ) plane that a sweep goes along, there and back.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// First and last η.
    pub eta: (f64, f64),
    /// First and last ρ.
    pub rho: (f64, f64),
    /// Number of steps.
    pub steps: usize,
    /// Start of the sweep there and of the sweep back.
    #[serde(default)]
    pub start: Initial,
}

/// A characteristic of the motions along a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Characteristic {
    /// The greatest Lyapunov exponent.
    #[default]
    Lyapunov,
    /// The autocorrelation of X at a lag of one drive period.
    Autocorrelation,
    /// X' before impacts.
    ApproachOfX,
    /// How far X lags behind the drive where no impacts occur.
    ImpactlessPhase,
}

/// The starts of basins of attraction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Starting {
    /// First and last X(0).
    pub x: (f64, f64),
    /// First and last X'(0).
    pub vx: (f64, f64),
    /// Columns and rows.
    pub cells: (usize, usize),
    /// Which masses take the start.
    #[serde(default)]
    pub starts: Starts,
}

/// What is shown beside the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Panel {
    /// The motion at the cursor.
    #[default]
    Motion,
    /// Characteristics along a line.
    Line,
    /// Basins of attraction at the cursor.
    Basins,
    /// A record beside its simulation.
    Record,
}

/// What turns Hz and m into η and ρ.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RigScale {
    /// f0, Hz.
    pub natural_frequency_hz: f64,
    /// `x_st`, m.
    pub static_deflection_m: f64,
}

/// Columns and rows of the map that an exported study computes.
pub(super) const MAP_CELLS: (usize, usize) = (128, 96);
/// Most natural periods of a motion.
const MOST_NATURAL_PERIODS: f64 = 160_000.0;
/// Most trajectories in the picture of the characteristics.
const MOST_INSETS: usize = 12;

impl Default for State {
    fn default() -> Self {
        Self {
            version: VERSION,
            damping_ratio: 0.07,
            restitution: RestitutionLaw::Constant(0.9),
            single: false,
            asymmetry: Asymmetry::default(),
            view: Window {
                eta: (0.5, 3.5),
                rho: (0.0, 7.0),
            },
            map_start: Initial::rest(),
            cursor: Cursor {
                eta: 1.3,
                rho: 1.0,
                phase: 0.0,
                start: Initial::rest(),
            },
            periods: eight(),
            samples_per_period: two_hundred(),
            poincare_phase: 0.0,
            watch: Watch::default(),
            line: None,
            characteristic: Characteristic::default(),
            insets: Vec::new(),
            basins: None,
            panel: Panel::Motion,
            rig: None,
            record: None,
        }
    }
}

impl State {
    /// Read a state, and check it.
    ///
    /// # Errors
    /// [`ExploreError`] where it is of another version, malformed or out of range.
    pub fn read(value: serde_json::Value) -> Result<Self, ExploreError> {
        let version = value.get("version");
        if version.and_then(serde_json::Value::as_u64) != Some(u64::from(VERSION)) {
            return Err(ExploreError::Version {
                found: version.map_or("none".into(), ToString::to_string),
                expected: VERSION,
            });
        }
        let state: Self =
            serde_json::from_value(value).map_err(|e| ExploreError::malformed("state", e))?;
        state.check()?;
        Ok(state)
    }

    /// Check every range.
    ///
    /// # Errors
    /// [`ExploreError`] with the first value that is out of range.
    pub fn check(&self) -> Result<(), ExploreError> {
        self.check_machine()?;
        check_cursor("cursor", &self.cursor)?;
        check_start("map_start", &self.map_start)?;
        rising("view.eta", self.view.eta, &limits::ETA)?;
        rising("view.rho", self.view.rho, &limits::RHO)?;
        limits::PERIODS.check("periods", self.periods)?;
        limits::SAMPLES.check("samples_per_period", self.samples_per_period as f64)?;
        limits::PHASE.check("poincare_phase", self.poincare_phase)?;
        let watch = &self.watch;
        limits::SETTLE_PERIODS.check("watch.settle_periods", watch.settle_periods)?;
        limits::WATCH_PERIODS.check("watch.watch_periods", watch.watch_periods)?;
        limits::TOLERANCE.check("watch.tolerance", watch.tolerance)?;
        self.check_line()?;
        let count = self.insets.len();
        range("insets", count as f64, count <= MOST_INSETS, "at most 12")?;
        self.insets
            .iter()
            .try_for_each(|inset| check_cursor("insets", inset))?;
        self.check_basins()?;
        self.check_effort()?;
        if let Some(rig) = &self.rig {
            limits::FREQUENCY.check("rig.natural_frequency_hz", rig.natural_frequency_hz)?;
            limits::DEFLECTION.check("rig.static_deflection_m", rig.static_deflection_m)?;
        }
        Ok(())
    }

    fn check_machine(&self) -> Result<(), ModelError> {
        match self.restitution.restitution() {
            Restitution::Constant(r) => limits::RESTITUTION.check("restitution", r)?,
            Restitution::Table(rows) => {
                limits::ROWS.check("restitution.table's lines", rows.len() as f64)?;
            }
            _ => {}
        }
        limits::DAMPING_RATIO.check("damping_ratio", self.damping_ratio)?;
        let unlike = &self.asymmetry;
        limits::DRIVE_AMPLITUDE.check("asymmetry.drive_amplitude", unlike.drive_amplitude)?;
        limits::STIFFNESS.check("asymmetry.stiffness", unlike.stiffness)?;
        limits::MASS.check("asymmetry.mass", unlike.mass)?;
        self.machine().check()
    }

    fn check_line(&self) -> Result<(), ModelError> {
        let Some(line) = &self.line else {
            return Ok(());
        };
        limits::STEPS.check("line.steps", line.steps as f64)?;
        check_start("line.start", &line.start)?;
        for end in [line.eta.0, line.eta.1] {
            limits::ETA.check("line.eta", end)?;
        }
        for end in [line.rho.0, line.rho.1] {
            limits::RHO.check("line.rho", end)?;
        }
        let is_place = line.eta.0 == line.eta.1 && line.rho.0 == line.rho.1;
        range(
            "line.rho",
            line.rho.1,
            !is_place,
            "another one where η stays",
        )
    }

    fn check_basins(&self) -> Result<(), ModelError> {
        let Some(basins) = &self.basins else {
            return Ok(());
        };
        rising("basins.x", basins.x, &limits::START)?;
        rising("basins.vx", basins.vx, &limits::START)?;
        limits::CELLS.check("basins.cells", basins.cells.0 as f64)?;
        limits::CELLS.check("basins.cells", basins.cells.1 as f64)
    }

    /// That no motion goes through more natural periods than can be computed while somebody waits.
    fn check_effort(&self) -> Result<(), ExploreError> {
        let machine = self.machine();
        let natural = machine
            .y
            .map_or(1.0, |y| y.natural_frequency_ratio.max(1.0));
        let total = |watch: &Watch| watch.settle_periods + watch.watch_periods;
        let line = self.line.iter().flat_map(|l| [l.eta.0, l.eta.1]);
        let insets = self.insets.iter().map(|i| i.eta);
        let watched = std::iter::once(self.cursor.eta).chain(line).chain(insets);
        let slowest = watched.fold(f64::INFINITY, f64::min);
        let of_map = total(&Watch::default()) / self.view.eta.0;
        let most = (total(&self.watch) / slowest).max(of_map) * natural;
        if most > MOST_NATURAL_PERIODS {
            return Err(ExploreError::TooLong);
        }
        Ok(())
    }

    /// The machine.
    pub fn machine(&self) -> Machine {
        self.empty_study().machine()
    }

    fn empty_study(&self) -> Study {
        Study {
            single: self.single,
            asymmetry: self.asymmetry,
            ..Study::empty(
                "Seen in the explorer",
                self.damping_ratio,
                self.restitution.clone(),
            )
        }
    }

    /// How a motion at the cursor is looked at.
    pub fn portrait(&self) -> PortraitPlan {
        PortraitPlan {
            setting: self.cursor.setting(),
            start: self.cursor.start,
            skip_periods: 0.0,
            periods: self.periods,
            samples_per_period: self.samples_per_period,
            poincare_periods: 300,
            poincare_phase: self.poincare_phase,
            soft: None,
        }
    }

    /// The basins' grid.
    pub fn basin_grid(&self) -> BasinGrid {
        let default = self.basins.unwrap_or_else(|| self.own_starts());
        let Starting {
            x,
            vx,
            cells,
            starts,
        } = default;
        BasinGrid {
            x: (x.0, x.1, cells.0),
            vx: (vx.0, vx.1, cells.1),
            starts,
        }
    }

    /// The starts that are shown where none are chosen: about the motion's own size.
    fn own_starts(&self) -> Starting {
        let size = 4.0 * self.cursor.rho.abs().max(1.0);
        Starting {
            x: (-size, self.cursor.rho.max(0.1 * size - size)),
            vx: (-size, size),
            cells: (101, 101),
            starts: Starts::BothMasses,
        }
    }

    /// How the map's cells are marched.
    pub fn map_settings(&self) -> MapSettings {
        MapSettings {
            start: self.map_start,
            ..MapSettings::default()
        }
    }

    /// The map of a number of columns and rows.
    pub fn map_plan(&self, (columns, rows): (usize, usize)) -> MapPlan {
        let Window { eta, rho } = self.view;
        MapPlan {
            eta: (eta.0, eta.1, columns),
            rho: (rho.0, rho.1, rows),
            map: self.map_settings(),
        }
    }

    /// The study that reproduces what is shown: the map, and beside it the panel's picture.
    pub fn study(&self) -> Study {
        let mut study = self.empty_study();
        study.map.insert("map".into(), self.map_plan(MAP_CELLS));
        match (self.panel, &self.line) {
            (Panel::Line, Some(line)) => {
                let plan = SweepPlan {
                    eta: line.eta,
                    rho: line.rho,
                    steps: line.steps,
                    start: line.start,
                    watch: self.watch,
                };
                study.sweep.insert("characteristics".into(), plan);
            }
            (Panel::Basins, _) => {
                let plan = BasinPlan {
                    setting: self.cursor.setting(),
                    grid: self.basin_grid(),
                    restitution: None,
                    watch: self.watch,
                };
                study.basins.insert("basins".into(), plan);
            }
            (Panel::Record, _) => {}
            _ => {
                study.time_series.insert("motion".into(), self.portrait());
            }
        }
        study
    }
}

fn check_cursor(name: &'static str, cursor: &Cursor) -> Result<(), ModelError> {
    limits::ETA.check(name, cursor.eta)?;
    limits::RHO.check(name, cursor.rho)?;
    limits::PHASE.check(name, cursor.phase)?;
    check_start(name, &cursor.start)
}

fn check_start(name: &'static str, start: &Initial) -> Result<(), ModelError> {
    let all = [start.x, start.vx, start.y, start.vy];
    all.iter().try_for_each(|v| limits::START.check(name, *v))
}

fn rising(name: &'static str, ends: (f64, f64), limit: &Limit) -> Result<(), ModelError> {
    limit.check(name, ends.0)?;
    limit.check(name, ends.1)?;
    range(name, ends.1, ends.1 > ends.0, "above the range's lower end")
}
