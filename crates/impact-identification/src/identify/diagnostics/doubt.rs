//! What a mistake that the data give away leaves open in the estimates.

use impact_fit::estimate;
use impact_fit::messages::{Finding, Note};
use impact_fit::method_fit::MethodFit;
use impact_fit::methods::answer::MethodResult;
use impact_fit::parameters::Coordinate;

/// How far a parameter may be off beside its own uncertainty.
#[derive(Debug, Clone, PartialEq)]
pub struct Doubt {
    /// The parameter.
    pub parameter: Coordinate,
    /// Standard uncertainty, of R absolute, of the others relative.
    pub by: f64,
    /// Why.
    pub note: Note,
}

/// A mistake that the data give away, and what it leaves open.
#[derive(Debug, Clone, PartialEq)]
pub struct Suspicion {
    /// The mistake.
    pub finding: Finding,
    /// What it leaves open.
    pub doubts: Vec<Doubt>,
}

impl From<Finding> for Suspicion {
    fn from(finding: Finding) -> Self {
        Self {
            finding,
            doubts: Vec::new(),
        }
    }
}

impl Doubt {
    /// Of a parameter of a fit, where it exceeds the fit's own standard error.
    pub fn material(found: &MethodFit, parameter: Coordinate, by: f64, note: Note) -> Option<Self> {
        let doubt = Self {
            parameter,
            by,
            note,
        };
        let error = found.spread(parameter)?.error;
        (by > error).then_some(doubt)
    }
}

/// The mistakes, and all that they leave open.
pub fn parted(suspicions: Vec<Suspicion>) -> (Vec<Finding>, Vec<Doubt>) {
    let (findings, doubts): (Vec<_>, Vec<_>) = suspicions
        .into_iter()
        .map(|s| (s.finding, s.doubts))
        .unzip();
    (findings, doubts.concat())
}

/// Widen a joint result by all that is in doubt.
pub fn widen(joint: &mut MethodResult, doubts: &[Doubt]) {
    for doubt in doubts {
        joint.parameters.change(doubt.parameter, |e| {
            estimate::in_doubt(doubt.parameter, e, doubt.by, doubt.note.clone())
        });
    }
}
