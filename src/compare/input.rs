//! What a comparison starts from.

use crate::event::Rig;
use crate::identify::Identification;
use crate::identify::fit::Fit;
use crate::identify::fit::parameters::Parameters;
use crate::motion::{Bracket, Observation};
use crate::record::Record;

/// A campaign as observed and identified.
pub struct Input<'a> {
    /// One or two masses.
    pub rig: Rig,
    /// All records as observed, in the order of acquisition.
    pub observations: &'a [Observation],
    /// All brackets of boundaries.
    pub brackets: &'a [Bracket],
    /// The answer.
    pub identification: &'a Identification,
    /// The joint fit; `None` without one.
    pub fit: Option<&'a Fit>,
    /// Factor on its covariance.
    pub factor: f64,
    /// What a fit left out, and why.
    pub left_out: &'a [(String, String)],
    /// Names of the records to be replayed; empty: the surest of each type of motion.
    pub points: &'a [String],
    /// Reads a record by its index among the observations; `None` if it cannot be read.
    pub read: &'a (dyn Fn(usize) -> Option<Record> + Sync),
}

impl Input<'_> {
    /// The fitted parameters.
    pub(super) fn parameters(&self) -> Option<&Parameters> {
        self.fit.map(|fit| &fit.parameters)
    }

    /// Why a fit left a record out; `None` if it did not.
    pub(super) fn reason(&self, record: &str) -> Option<&String> {
        let found = self.left_out.iter().find(|(name, _)| name == record);
        found.map(|(_, why)| why)
    }

    /// η and ρ of a record's setting with the fitted parameters, as far as they are known.
    pub(super) fn place(&self, o: &Observation) -> (Option<f64>, Option<f64>) {
        let Some(parameters) = self.parameters() else {
            return (None, None);
        };
        let eta = o
            .frequency_hz()
            .map(|f| f / parameters.natural_frequency_hz);
        let scale = parameters.static_deflection_m * o.setting.drive_amplitude;
        (eta, o.setting.clearance_m.map(|c| c / scale))
    }
}

/// Every second, third … of points that are more than `most`.
pub(super) fn thinned<T>(points: &[T], most: usize) -> impl Iterator<Item = &T> {
    points.iter().step_by(points.len().div_ceil(most).max(1))
}
