//! What the results leave open beside their fits, in the order in which a run finds it: each step reads what those
//! before it made of the estimates.

use std::collections::BTreeMap;

use crate::identify::diagnostics::agreement::{
    agreement, between_methods, carried_on, which_restitution,
};
use crate::identify::diagnostics::doubt::{self, Doubt};
use crate::identify::diagnostics::{clock, missing, verdict};
use crate::identify::results;
use crate::identify::uncertainty::budget::{Further, UncertaintySource};
use impact_fit::estimate::{self, ParameterSet};
use impact_fit::evidence::Evidence;
use impact_fit::messages::Remark;
use impact_fit::method::Method;
use impact_fit::methods::answer::{Agreement, MethodResult};
use impact_fit::methods::fits::Fits;
use impact_fit::methods::impacts::Impacts;
use impact_fit::methods::selection::Selection;
use impact_fit::parameters::Coordinate;

/// The results of each method and of all, and what was added to the joint ones.
pub(super) struct Widened {
    /// Each method alone.
    pub(super) methods: BTreeMap<Method, MethodResult>,
    /// All together.
    pub(super) joint: MethodResult,
    /// What is open in the joint estimates beside the fit.
    pub(super) further: Vec<Further>,
}

impl Widened {
    /// The results as the fits have them.
    pub(super) fn new(selection: &Selection<'_>, found: &Fits) -> Self {
        let methods = results::alone(selection, found);
        Self {
            joint: results::joint(selection.evidence, found.joint.as_ref(), &methods),
            methods,
            further: Vec::new(),
        }
    }

    /// What is known before the methods are compared: without a drive R rests on the impacts alone; R that is not one
    /// number, or changes a little with the speed, is that for all methods.
    pub(super) fn by_impacts(&mut self, selection: &Selection<'_>) {
        if is_undriven(selection.evidence) {
            Impacts::widen_common(&mut self.joint, selection);
        }
        verdict::carry_over(&mut self.joint, &self.methods);
        self.by_speed();
    }

    /// Widen R of all methods and of the joint result by a small change with the speed.
    fn by_speed(&mut self) {
        let parameter = Coordinate::Restitution;
        let by = verdict::open_by_speed(&self.methods);
        for result in self.methods.values_mut().chain([&mut self.joint]) {
            let parameters = &mut result.parameters;
            if let Some(by) = by {
                parameters.change(parameter, |e| estimate::wider(parameter, e, by));
            }
        }
        let open = by.map(|by| (parameter, by));
        self.leave_open(UncertaintySource::RestitutionOverSpeed, open);
    }

    /// Note what a source leaves open in the joint estimates.
    fn leave_open(
        &mut self,
        source: UncertaintySource,
        open: impl IntoIterator<Item = (Coordinate, f64)>,
    ) {
        let open = open.into_iter().collect();
        self.further.push(Further::new(source, open));
    }

    /// Compare the methods, with estimates that are final but for what they share, and widen the joint ones by what
    /// they disagree on. Multiple shooting takes the rig for ideal: where it is not, it is no witness.
    pub(super) fn by_agreement(&mut self, found: &Fits, is_ideal: bool) -> Agreement {
        let compared = if is_ideal {
            agreement(&self.methods)
        } else {
            self.widen_ideal();
            let mut others = self.methods.clone();
            others.retain(|method, _| !method.takes_rig_for_ideal());
            agreement(&others)
        };
        let which = which_restitution(&compared);
        if let Some(impacts) = self.found_by(Method::observes_contact) {
            impacts.remarks.extend(which);
        }
        let apart = between_methods(&self.methods, &compared, &self.joint);
        let open = self.widen_apart(apart, found);
        self.leave_open(UncertaintySource::BetweenMethods, open);
        compared
    }

    /// The result of the method with a property.
    fn found_by(&mut self, property: impl Fn(Method) -> bool) -> Option<&mut MethodResult> {
        let mut methods = self.methods.iter_mut();
        let found = methods.find(|(method, _)| property(**method));
        found.map(|(_, result)| result)
    }

    /// Widen what a method that takes the rig for ideal is off the joint estimate.
    fn widen_ideal(&mut self) {
        let joint = self.joint.parameters.clone();
        let Some(ideal) = self.found_by(Method::takes_rig_for_ideal) else {
            return;
        };
        for coordinate in Coordinate::PHYSICAL {
            let value = |set: &ParameterSet| set.get(coordinate)?.value;
            let Some((own, all)) = value(&ideal.parameters).zip(value(&joint)) else {
                continue;
            };
            let unit = coordinate.slope(all);
            if let Some(Some(estimate)) = ideal.parameters.slot(coordinate) {
                *estimate = estimate::widened(coordinate, estimate, (own - all).abs() / unit);
                estimate.note = None;
            }
        }
        ideal.remarks.push(Remark::IdealRig);
    }

    /// Widen the joint estimates by what a disagreement of methods leaves open, and those that the methods agree on by
    /// what follows from it; gives what is open of all.
    fn widen_apart(
        &mut self,
        apart: Vec<(Coordinate, f64)>,
        found: &Fits,
    ) -> Vec<(Coordinate, f64)> {
        let fit = found.together().map(|f| &f.fit);
        let carried = fit.map_or_else(Vec::new, |fit| carried_on(fit, &apart));
        let parameters = &mut self.joint.parameters;
        for (parameter, by) in &apart {
            parameters.change(*parameter, |e| estimate::widened(*parameter, e, *by));
        }
        for (parameter, by) in &carried {
            parameters.change(*parameter, |e| estimate::wider(*parameter, e, *by));
        }
        [apart, carried].concat()
    }

    /// Widen what all methods share, so that it makes no two of them agree: the clock.
    pub(super) fn by_clock(&mut self, uncertainty: f64) {
        for result in self.methods.values_mut().chain([&mut self.joint]) {
            clock::widen(result, uncertainty);
        }
        let open = (uncertainty > 0.0).then_some((Coordinate::Frequency, uncertainty));
        self.leave_open(UncertaintySource::Clock, open);
    }

    /// Widen what instruments that may be off reach, once no greater cause has withdrawn it; then say what is missing.
    pub(super) fn by_doubts(&mut self, doubts: &[Doubt], evidence: &Evidence<'_>) {
        doubt::widen(&mut self.joint, doubts);
        let open = doubts.iter().map(|d| (d.parameter, d.by));
        self.leave_open(UncertaintySource::InstrumentOff, open);
        missing::say_missing(&mut self.joint, evidence);
    }
}

/// Whether no record has a drive.
fn is_undriven(evidence: &Evidence<'_>) -> bool {
    evidence.observations.iter().all(|o| o.drive.is_none())
}
