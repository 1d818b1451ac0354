//! What the report shows of each method: traces, curves, speeds, decays, residuals, profiles.

use serde::{Deserialize, Serialize};

use crate::motion::Motion;
use crate::record::Role;
use labfiles::units::Dimension;

/// A sampled signal on its own time axis.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Signal {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Values, SI, as many as times.
    pub values: Vec<f64>,
}

/// One channel of a comparison: measured, simulated, and their difference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trace {
    /// What the channel measures.
    pub role: Role,
    /// Its dimension, hence its SI unit.
    pub dimension: Dimension,
    /// As measured, where it was.
    #[serde(default)]
    pub measured: Option<Signal>,
    /// As simulated, where the model has it.
    #[serde(default)]
    pub simulated: Option<Signal>,
    /// Measured less simulated.
    #[serde(default)]
    pub residual: Option<Signal>,
}

/// Velocity over displacement of one mass: points (m, m/s) in order of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Portrait {
    /// Name of the mass, `x` or `y`.
    pub mass: String,
    /// As measured.
    #[serde(default)]
    pub measured: Vec<[f64; 2]>,
    /// As simulated.
    #[serde(default)]
    pub simulated: Vec<[f64; 2]>,
}

/// A record compared with its simulation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The point's letter in the map, `A`, `B` …
    pub letter: String,
    /// The record's name.
    pub record: String,
    /// η, where there is a drive and f0 is known.
    pub eta: Option<f64>,
    /// ρ, where x_st is known.
    pub rho: Option<f64>,
    /// Drive period, s: the time axis counts in it; `None` without a drive.
    pub drive_period_s: Option<f64>,
    /// Motion found in the record.
    pub motion: Motion,
    /// Motion of the simulation with the fitted parameters.
    pub simulated_motion: Option<Motion>,
    /// The channels.
    pub traces: Vec<Trace>,
    /// Phase portraits.
    #[serde(default)]
    pub portraits: Vec<Portrait>,
    /// Times of the impacts in the measured stretch, s on the traces' axis.
    #[serde(default)]
    pub impacts_s: Vec<f64>,
    /// Times of the impacts in the simulated stretch, s on the traces' axis.
    #[serde(default)]
    pub simulated_impacts_s: Vec<f64>,
    /// Why this record was chosen, and what is to be seen.
    #[serde(default)]
    pub note: String,
}

/// One point of a resonance curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResonancePoint {
    /// The record's name.
    pub record: String,
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Amplitude, SI unit of the curve's dimension (over unit drive where `per_drive`).
    pub amplitude: f64,
    /// Its standard error.
    #[serde(default)]
    pub amplitude_error: Option<f64>,
    /// Phase behind the drive, rad.
    #[serde(default)]
    pub phase_rad: Option<f64>,
    /// Its standard error, rad.
    #[serde(default)]
    pub phase_error_rad: Option<f64>,
    /// Whether the fit used it.
    pub used: bool,
}

/// An impactless resonance curve with its fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResonanceCurve {
    /// What was excited, where there are several.
    #[serde(default)]
    pub name: String,
    /// Dimension of the amplitude.
    pub dimension: Dimension,
    /// The amplitude's unit as printed, where it is not the dimension's own (m/N, for instance).
    #[serde(default)]
    pub unit: Option<String>,
    /// The measured points.
    pub points: Vec<ResonancePoint>,
    /// The fitted curve: (frequency Hz, amplitude, phase rad).
    #[serde(default)]
    pub fitted: Vec<[f64; 3]>,
    /// Whether one degree of freedom describes it.
    #[serde(default)]
    pub fits: Option<bool>,
    /// What was found, in words.
    #[serde(default)]
    pub note: String,
}

/// One impact's speeds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImpactPoint {
    /// The record's name.
    pub record: String,
    /// Closing speed before, m/s, positive.
    pub before_m_s: f64,
    /// Speed of parting after, m/s, positive (R times the speed before).
    pub after_m_s: f64,
    /// Standard error of either, m/s.
    #[serde(default)]
    pub error_m_s: Option<f64>,
    /// Whether the fit used it.
    pub used: bool,
}

/// Speeds after impact over speeds before, with the fitted restitution.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ImpactScatter {
    /// Which records, where there are several groups.
    pub name: String,
    /// The impacts; of very many every second, third …
    pub points: Vec<ImpactPoint>,
    /// Number of impacts, where `points` holds not all of them.
    pub total: usize,
    /// The fitted constant R.
    pub restitution: Option<f64>,
    /// Its 95 % interval.
    pub interval95: Option<[f64; 2]>,
    /// Fitted R over closing speed: (m/s, R), where R depends on the speed.
    pub restitution_of_speed: Vec<[f64; 2]>,
    /// What was found, in words.
    pub note: String,
}

impl ImpactScatter {
    /// Number of impacts that were used, drawn or not.
    pub fn used(&self) -> usize {
        let drawn = self.points.iter().filter(|p| p.used).count();
        drawn + self.total.saturating_sub(self.points.len())
    }
}

/// A free decay with its fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FreeDecay {
    /// The record's name.
    pub record: String,
    /// Dimension of the signal.
    pub dimension: Dimension,
    /// As measured.
    pub measured: Signal,
    /// The fitted decay.
    #[serde(default)]
    pub fitted: Option<Signal>,
    /// Fitted natural frequency, Hz (undamped).
    pub natural_frequency_hz: Option<f64>,
    /// Its standard error, Hz.
    #[serde(default)]
    pub natural_frequency_error_hz: Option<f64>,
    /// Fitted damping ratio.
    pub damping_ratio: Option<f64>,
    /// Its standard error.
    #[serde(default)]
    pub damping_ratio_error: Option<f64>,
    /// What was found, in words (a misfiled record, for instance).
    #[serde(default)]
    pub note: String,
}

/// One weighted residual: (measured − fitted) over its standard error.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ResidualPoint {
    /// The record's name.
    pub record: String,
    /// The weighted residual.
    pub residual: f64,
    /// Drive frequency, Hz.
    pub frequency_hz: Option<f64>,
    /// Clearance r, m.
    pub clearance_m: Option<f64>,
}

/// The residuals of one method.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ResidualSet {
    /// The method: `boundaries`, `trajectories`, `impacts`, `resonance`, `free_decay`.
    pub method: String,
    /// The residuals, in the order of the observations; of very many every second, third …
    pub points: Vec<ResidualPoint>,
    /// Number of residuals, where `points` holds not all of them.
    pub total: usize,
    /// Autocorrelation at lags 0, 1, 2 …
    pub autocorrelation: Vec<f64>,
    /// What the residuals say, in words.
    pub note: String,
}

impl ResidualSet {
    /// Number of residuals, drawn or not.
    pub fn count(&self) -> usize {
        self.total.max(self.points.len())
    }
}

/// Profile likelihood of one parameter.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Profile {
    /// The parameter: `restitution`, `natural_frequency_hz`, `damping_ratio`,
    /// `static_deflection_m`, or another name with its unit.
    pub parameter: String,
    /// The method, empty for the joint estimate.
    pub method: String,
    /// Values of the parameter, SI, ascending.
    pub values: Vec<f64>,
    /// Rise of χ² over its least value (twice the fall of the log-likelihood).
    pub delta_chi2: Vec<f64>,
    /// The best value.
    pub best: Option<f64>,
    /// Its 95 % interval.
    pub interval95: Option<[f64; 2]>,
}

/// Correlation of the estimated parameters.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Correlation {
    /// Names of the parameters.
    pub parameters: Vec<String>,
    /// The matrix, row by row.
    pub matrix: Vec<Vec<f64>>,
}
