//! What an identification starts from, and what the blocks of residuals of several methods have in common.

pub mod direction;
pub mod forces;
pub mod high_pass;
pub mod influence;
pub mod options;
pub mod pickup;
pub mod shared_error;
pub mod unlike_drives;
pub mod waveform;

use crate::evidence::options::UncertaintyOptions;
use crate::parameters::effect::Effects;
use crate::parameters::{CHANNELS, Parameters};
use crate::solver::FitProgress;
use impact_records::event::{FlightKind, RigKind};
use impact_records::motion::{Bracket, Observation};

/// Gains that are left to the data, by their index: the logarithm of each over the stated one, as far as it is known.
pub type OpenGains = [Option<f64>; CHANNELS];

/// What the laboratory states about its rig.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Nominal {
    /// R
    pub restitution: Option<f64>,
    /// f0, Hz
    pub natural_frequency_hz: Option<f64>,
    /// β
    pub damping_ratio: Option<f64>,
    /// `x_st`, m
    pub static_deflection_m: Option<f64>,
    /// Standard uncertainty of the channels' gains, relative.
    pub gain_uncertainty: f64,
    /// Gains that are left to the data, as all that is stated contradicts them.
    pub open_gains: OpenGains,
    /// Standard uncertainty of the corners of the channels' high-pass, relative.
    pub corner_uncertainty: f64,
    /// Standard uncertainty of the sampler's clock, relative.
    pub clock_uncertainty: f64,
    /// Standard uncertainty of each stated clearance, and of the zero that all share, m.
    pub clearance_uncertainty_m: f64,
    /// Delay of the motion channels against the drive's, s, by the index of their gains.
    pub delays_s: [f64; CHANNELS],
    /// Standard uncertainties of those delays, s; `None`: half a sample.
    pub delay_uncertainties_s: [Option<f64>; CHANNELS],
    /// ln(`m_x`/`m_y`) with its standard uncertainty; `None`: masses that were made alike.
    pub mass_asymmetry: Option<[f64; 2]>,
    /// ln(`F_x`/`F_y`) per unit of mass with its standard uncertainty, where the records show that the drives are unlike;
    /// `None`: drives that were made alike.
    pub drive_asymmetry: Option<[f64; 2]>,
    /// Effects that the fit allows beyond the model.
    pub effects: Effects,
    /// What moves the masses between impacts.
    pub flight: FlightKind,
}

impl Nominal {
    /// Parameters with the stated delays, masses and drives.
    pub fn applied(&self, parameters: Parameters) -> Parameters {
        Parameters {
            delays_s: self.delays_s,
            drive_asymmetry: self.drive_asymmetry.map_or(0.0, |[centre, _]| centre),
            mass_asymmetry: self.mass_asymmetry.map_or(0.0, |[centre, _]| centre),
            ..parameters
        }
    }

    /// The same rig without errors of clearances, delays and effects beyond the model: for a first
    /// fit, whose result the changes by them are taken at.
    #[must_use]
    pub fn ideal(&self) -> Self {
        Self {
            clearance_uncertainty_m: 0.0,
            delay_uncertainties_s: [Some(0.0); CHANNELS],
            mass_asymmetry: self.mass_asymmetry.map(|[centre, _]| [centre, 0.0]),
            effects: Effects::none(),
            ..*self
        }
    }
}

/// Everything an identification starts from.
#[derive(Debug, Clone, Copy)]
pub struct Evidence<'a> {
    /// One or two masses.
    pub rig: RigKind,
    /// All records as observed.
    pub observations: &'a [Observation],
    /// All brackets.
    pub brackets: &'a [Bracket],
    /// What is stated.
    pub nominal: Nominal,
    /// What is asked for of the uncertainty.
    pub uncertainty: UncertaintyOptions,
    /// What counts the iterations of the fits, if anything shows them.
    pub progress: Option<&'a FitProgress>,
}

impl<'a> Evidence<'a> {
    /// The records without impacts.
    pub(crate) fn impactless(&self) -> Vec<Observation> {
        let all = self.observations.iter();
        all.filter(|o| !o.response.is_empty()).cloned().collect()
    }

    /// The same of other records, without brackets.
    pub(crate) fn of_records<'b>(&self, observations: &'b [Observation]) -> Evidence<'b>
    where
        'a: 'b,
    {
        Evidence {
            observations,
            brackets: &[],
            ..*self
        }
    }
}
