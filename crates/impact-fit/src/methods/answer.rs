//! What a method, and the methods together, answer.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::estimate::{Estimate, ParameterSet};
use crate::messages::{Finding, GroupPoint, PairAgreement, Remark, Sentence};
use crate::method::Method;
use crate::methods::impacts::contact_law::ContactLaw;
use crate::methods::impacts::structure::{Grouping, ImpactGroups};
use crate::parameters::Coordinate;
use crate::solver::{Fit, FitReport, Prior};
use impact_records::message::{Message, Value, plain, plain_all, sentence};
use impact_records::serialised_with_text;

/// What one method found.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct MethodResult {
    /// Its estimates.
    #[serde(flatten)]
    pub parameters: ParameterSet,
    /// Number of observations used.
    pub observations: usize,
    /// Number of records that gave them.
    pub records: usize,
    /// Root mean square of the weighted residuals (1: as the stated noise).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub reduced_residual: Option<f64>,
    /// Whether the model fits this method's data; `None`: cannot be judged.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub fits: Option<bool>,
    /// What it noticed.
    #[serde(default)]
    pub remarks: Vec<Remark>,
    /// How R depends on the approach speed; of impacts alone.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub contact_law: Option<ContactLaw>,
    /// R of each bounce and of each record; of records without a drive alone.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub impact_groups: Option<ImpactGroups>,
    /// R by plain least squares on the midpoints of the saddle-node brackets; of boundaries alone.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub restitution_by_midpoints: Option<Estimate>,
    /// How its fit ended; printed by the command line, not written.
    #[serde(skip)]
    pub fit_report: Option<FitReport>,
    /// Estimates of what is fitted beside the parameters: gains, corners, asymmetries.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    pub further: BTreeMap<Coordinate, Estimate>,
}

/// The result of the first method with a property.
pub fn found_by(
    methods: &BTreeMap<Method, MethodResult>,
    property: impl Fn(Method) -> bool,
) -> Option<&MethodResult> {
    let mut with = methods.iter().filter(|(method, _)| property(**method));
    with.next().map(|(_, result)| result)
}

impl MethodResult {
    /// R that differs between bounces or records is not one number, whatever interval would hold it.
    pub fn judge_structure(&mut self, grouping: Grouping) {
        let Some(groups) = &self.impact_groups else {
            return;
        };
        let by = match grouping {
            Grouping::Bounce => &groups.by_bounce,
            Grouping::Record => &groups.by_record,
        };
        let points: Vec<GroupPoint> = by.iter().map(GroupPoint::from).collect();
        let values: Vec<f64> = by.iter().map(|g| g.restitution).collect();
        self.fits = Some(false);
        // A law over the speed, if there is one, has been named already; it is the same structure.
        let named = |r: &Remark| matches!(r, Remark::LongContact { .. });
        if !self.remarks.iter().any(named) {
            self.remarks
                .retain(|r| !matches!(r, Remark::RestitutionConstant { .. }));
            self.remarks.push(match grouping {
                Grouping::Bounce => Remark::RestitutionByBounce { points },
                Grouping::Record => Remark::RecordsDiffer { points },
            });
        }
        if let Some(estimate) = &mut self.parameters.restitution {
            estimate.is_not_one_number(&values);
        }
    }
}

/// Whether the methods agree.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub struct Agreement {
    /// `None` if fewer than two methods determine a common parameter.
    pub agree: Option<bool>,
    /// Pair by pair.
    pub pairs: Vec<PairAgreement>,
}

impl Agreement {
    /// The pair that is furthest apart, if the methods do not agree.
    pub fn disagreement(&self) -> Option<&PairAgreement> {
        let pairs = self.pairs.iter().filter(|_| self.agree == Some(false));
        pairs.max_by(|a, b| a.z_score.abs().total_cmp(&b.z_score.abs()))
    }
}

impl Message for Agreement {
    fn table(&self) -> &'static str {
        "agreement"
    }

    fn kind(&self) -> &'static str {
        match (self.disagreement(), self.agree) {
            (Some(pair), _) => pair.kind(),
            (None, None) => "nothing_to_compare",
            (None, Some(_)) => "agreement",
        }
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        match (self.disagreement(), self.agree) {
            (Some(pair), _) => pair.values(),
            (None, Some(_)) => vec![("count", Value::Count(self.pairs.len()))],
            (None, None) => Vec::new(),
        }
    }
}

impl std::fmt::Display for Agreement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.agree.is_some() {
            write!(f, "{} ", Sentence::on_agreement(self.agree))?;
        }
        f.write_str(&sentence(&plain(self)))
    }
}

/// The overall answer in one word.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VerdictKind {
    /// Parameters are identified and the model fits.
    Identified,
    /// Some parameters only weakly.
    Weak,
    /// Something essential cannot be determined from these data.
    #[default]
    NotIdentifiable,
    /// The model does not describe these data.
    DoesNotFit,
}

impl VerdictKind {
    /// Name in `identification.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Identified => "identified",
            Self::Weak => "weak",
            Self::NotIdentifiable => "not_identifiable",
            Self::DoesNotFit => "does_not_fit",
        }
    }
}

/// The verdict: one word, plain sentences (its `Display`, `summary` in JSON), and the findings.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub struct Verdict {
    /// The word.
    pub kind: VerdictKind,
    /// The sentences.
    pub sentences: Vec<Sentence>,
    /// Reasons and findings, one each.
    pub findings: Vec<Finding>,
}

impl Verdict {
    /// Whether the records contradict the stated clearances, so that none of them is used.
    pub fn doubts_clearances(&self) -> bool {
        let doubt = |finding: &Finding| {
            matches!(
                finding,
                Finding::WholeGapsStated { .. }
                    | Finding::ClearancesOffAlike { .. }
                    | Finding::ClearancesShifted { .. }
            )
        };
        self.findings.iter().any(doubt)
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&plain_all(&self.sentences))
    }
}

serialised_with_text!(Agreement, "summary");
serialised_with_text!(Verdict, "summary");

/// The joint fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointFit {
    /// Parameters, coordinates and their covariance for unit variance of the weighted residuals.
    #[serde(flatten)]
    pub fit: Fit,
    /// Factor on the covariance.
    pub variance_factor: f64,
    /// Weight of each method's squared residuals.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    pub weights: BTreeMap<Method, f64>,
    /// What was known of the coordinates beforehand.
    #[serde(default)]
    pub priors: Vec<Prior>,
    /// Stated clearances whose errors are coordinates, m, by the numbers of those coordinates.
    #[serde(default)]
    pub gaps_m: Vec<f64>,
    /// How far R, f0, β and `x_st` may be off by all that the intervals allow for.
    #[serde(default)]
    pub allowed: Vec<Allowed>,
}

impl JointFit {
    /// Take the clearances as they were stated, m, where the fit was with the `meant` ones: what they differ by is part of
    /// their errors.
    pub fn count_from_stated(&mut self, stated_m: &[f64], meant: impl Fn(f64) -> f64) {
        self.gaps_m = stated_m.to_vec();
        for (i, stated_m) in stated_m.iter().enumerate() {
            let off_m = meant(*stated_m) - stated_m;
            let errors = &mut self.fit.parameters.gap_errors_m;
            errors.set(i, errors.of(i) + off_m);
            let own = self.priors.iter_mut();
            for prior in own.filter(|p| p.coordinate == Coordinate::Gap(i)) {
                prior.centre += 1e3 * off_m;
            }
        }
    }
}

/// How far a parameter may be off by all that its interval allows for: covariance, scatter between
/// groups, first order of the effects, disagreement of methods.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Allowed {
    /// The parameter.
    pub parameter: Coordinate,
    /// Standard uncertainty: of R absolute, of the others relative.
    pub standard_uncertainty: f64,
    /// Degrees of freedom with which it is known; `None`: infinitely many.
    pub degrees_of_freedom: Option<f64>,
}
