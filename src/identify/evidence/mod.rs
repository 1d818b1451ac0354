//! The evidence of a campaign sorted by what it tells, and the nuisances that come with it.
//!
//! Each kind is a block of residuals of its own: impactless records ([`resonance`]), periodic ones
//! ([`trajectory`]), brackets of boundaries ([`boundary`]), speeds at impacts ([`impacts`]) and records
//! that are followed from impact to impact ([`flights`]).

pub mod boundary;
pub mod direction;
pub mod flights;
pub mod high_pass;
pub mod impacts;
pub mod record_motion;
pub mod resonance;
pub mod shared_error;
pub mod trajectory;
pub mod waveform;
pub mod weighing;

use crate::event::RigKind;
use crate::identify::evidence::boundary::BoundaryBlock;
use crate::identify::evidence::flights::FlightBlock;
use crate::identify::evidence::impacts::{ImpactBlock, SpeedPair};
use crate::identify::evidence::resonance::ResonanceBlock;
use crate::identify::evidence::trajectory::TrajectoryBlock;
use crate::identify::fit::parameters::{Coordinate, gain_index};
use crate::identify::fit::{Block, Prior};
use crate::identify::uncertainty::Asked;
use crate::motion::{Bracket, Observation};

/// What the laboratory states about its rig.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Nominal {
    /// R
    pub restitution: Option<f64>,
    /// f0, Hz
    pub natural_frequency_hz: Option<f64>,
    /// β
    pub damping_ratio: Option<f64>,
    /// x_st, m
    pub static_deflection_m: Option<f64>,
    /// Standard uncertainty of the channels' gains, relative.
    pub gain_uncertainty: f64,
    /// Standard uncertainty of the corners of the channels' high-pass, relative.
    pub corner_uncertainty: f64,
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
    pub uncertainty: Asked,
}

/// Relative error of instruments and model that noise does not show.
const RELATIVE_ERROR: f64 = 3e-4;
/// Scatter of single impacts' ratios beside the noise.
const IMPACT_SCATTER: f64 = 1e-3;
/// What the extrapolation of speeds to the impact leaves open in R.
pub const IMPACT_BIAS: f64 = 2e-4;
/// Asymmetry that a well-made rig may have.
const ASYMMETRY: f64 = 0.05;

/// The observations sorted by what they tell.
#[derive(Debug, Clone)]
pub struct Blocks {
    /// Impactless records.
    pub resonance: ResonanceBlock,
    /// z = 1/n records.
    pub trajectory: TrajectoryBlock,
    /// Brackets of s2, s1 and grazing.
    pub boundary: BoundaryBlock,
    /// Speeds at impacts.
    pub impact: ImpactBlock,
    /// Records that are shot from impact to impact.
    pub flight: FlightBlock,
    /// Impacts left out as outliers.
    pub impact_outliers: Vec<SpeedPair>,
}

impl Blocks {
    /// Sort the evidence.
    pub fn new(evidence: &Evidence) -> Self {
        Self::with_errors(evidence, RELATIVE_ERROR, IMPACT_SCATTER)
    }

    /// The evidence without allowance for anything but noise.
    pub fn with_noise_alone(evidence: &Evidence) -> Self {
        Self::with_errors(evidence, 0.0, 0.0)
    }

    fn with_errors(evidence: &Evidence, relative_error: f64, impact_scatter: f64) -> Self {
        let Evidence {
            rig,
            observations,
            brackets,
            ..
        } = *evidence;
        let (impact, impact_outliers) =
            ImpactBlock::new(observations, impact_scatter).without_outliers(5.0);
        Self {
            resonance: ResonanceBlock::new(rig, observations, relative_error),
            trajectory: TrajectoryBlock::new(rig, observations, relative_error),
            boundary: BoundaryBlock::new(rig, brackets),
            impact,
            flight: FlightBlock::new(rig, observations),
            impact_outliers,
        }
    }

    /// Whether any channel of an index is measured whose corner passes a test.
    fn measures(&self, index: usize, test: impl Fn(Option<f64>) -> bool) -> bool {
        let mut channels = self.resonance.channels().chain(self.trajectory.channels());
        channels.any(|(role, corner_hz)| gain_index(role) == Some(index) && test(corner_hz))
    }

    /// Gains of which any channel is measured.
    fn gains(&self) -> impl Iterator<Item = Coordinate> {
        (0..4)
            .filter(|i| self.measures(*i, |_| true))
            .map(Coordinate::Gain)
    }

    /// Corners of the channels that have passed a high-pass.
    fn corners(&self) -> impl Iterator<Item = Coordinate> {
        let filtered = |i: &usize| {
            let speeds = self.impact.has_corner(*i) || self.flight.has_corner(*i);
            speeds || self.measures(*i, |corner_hz| corner_hz.is_some())
        };
        (0..4).filter(filtered).map(Coordinate::Corner)
    }

    /// Whether both masses are measured, so that asymmetries can be told.
    fn sees_both(&self) -> bool {
        let has = |i: usize| self.measures(i, |_| true);
        self.resonance.rig == RigKind::Double && (has(0) || has(2)) && (has(1) || has(3))
    }

    /// Add the nuisance coordinates on which a fit of some blocks depends, with their priors: the
    /// channels' gains and corners, and asymmetry.
    pub fn add_nuisances(
        &self,
        nominal: &Nominal,
        fitted: &[(&dyn Block, f64)],
        (free, priors): (&mut Vec<Coordinate>, &mut Vec<Prior>),
    ) {
        let touched = |c: &Coordinate| fitted.iter().any(|(block, _)| block.touches(*c));
        let gains = self.gains().map(|c| (c, nominal.gain_uncertainty));
        let corners = self.corners().map(|c| (c, nominal.corner_uncertainty));
        let asymmetries = [Coordinate::DriveAsymmetry, Coordinate::StiffnessAsymmetry];
        let asymmetries = asymmetries.into_iter().filter(|_| self.sees_both());
        let all = gains
            .chain(corners)
            .chain(asymmetries.map(|c| (c, ASYMMETRY)));
        for (coordinate, deviation) in all.filter(|(c, _)| touched(c)) {
            free.push(coordinate);
            priors.push(Prior {
                coordinate,
                centre: 0.0,
                deviation: deviation.max(1e-6),
            });
        }
    }
}
