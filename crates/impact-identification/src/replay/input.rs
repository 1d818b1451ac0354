//! What a comparison starts from.

use crate::identify::plan::Proposal;
use std::collections::BTreeMap;

use crate::identify::Identification;
use impact_fit::parameters::Parameters;
use impact_fit::{Item, Reason};
use impact_records::event::RigKind;
use impact_records::motion::{Bracket, Observation};
use impact_records::record::Record;

/// A campaign as observed and identified.
pub struct Input<'a> {
    /// One or two masses.
    pub rig: RigKind,
    /// All records as observed, in the order of acquisition.
    pub observations: &'a [Observation],
    /// All brackets of boundaries.
    pub brackets: &'a [Bracket],
    /// The answer.
    pub identification: &'a Identification,
    /// Names of the records to be replayed; empty: the surest of each type of motion.
    pub points: &'a [String],
    /// Settings that are proposed: the plane reaches to them too.
    pub proposals: &'a [Proposal],
    /// Reads a record by its index among the observations; `None` if it cannot be read.
    pub read: &'a (dyn Fn(usize) -> Option<Record> + Sync),
}

impl<'a> Input<'a> {
    /// The fitted parameters.
    pub(super) fn parameters(&self) -> Option<&'a Parameters> {
        let joint = self.identification.joint_fit.as_ref();
        joint.map(|joint| &joint.fit.parameters)
    }

    /// Why the fits left records out, by index; the first reason of several.
    pub(super) fn record_reasons(&self) -> BTreeMap<usize, &'a Reason> {
        let left_out = self.identification.left_out.iter().rev();
        let records = left_out.filter_map(|l| match &l.item {
            Item::Record { index, .. } => Some((*index, &l.reason)),
            Item::Bracket { .. } | Item::Impact { .. } => None,
        });
        records.collect()
    }

    /// Why the fits left brackets out, by index; the first reason of several.
    pub(super) fn bracket_reasons(&self) -> BTreeMap<usize, &'a Reason> {
        let left_out = self.identification.left_out.iter().rev();
        let brackets = left_out.filter_map(|l| match &l.item {
            Item::Bracket { index, .. } => Some((*index, &l.reason)),
            Item::Record { .. } | Item::Impact { .. } => None,
        });
        brackets.collect()
    }

    /// η and ρ of a record's setting with the fitted parameters, as far as they are known.
    pub(super) fn place(&self, o: &Observation) -> (Option<f64>, Option<f64>) {
        self.parameters().map_or((None, None), |p| place(p, o))
    }
}

/// η and ρ of a record's setting with parameters, as far as they are known.
pub(super) fn place(parameters: &Parameters, o: &Observation) -> (Option<f64>, Option<f64>) {
    let eta = o
        .frequency_hz()
        .map(|f| f / parameters.natural_frequency_hz);
    let scale = parameters.static_deflection_m * o.setting.drive_amplitude;
    (eta, o.setting.clearance_m.map(|c| c / scale))
}
