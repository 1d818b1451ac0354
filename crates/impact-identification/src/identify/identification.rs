//! The result of an identification, `identification.json`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::identify::diagnostics::contact_law::ContactLaw;
use crate::identify::estimate::{Estimate, ParameterSet};
use crate::identify::evidence::structure::ImpactGroups;
use crate::identify::fit::parameters::Coordinate;
use crate::identify::fit::{Fit, FitReport, Prior};
use crate::identify::messages::{Finding, LeftOut, PairAgreement, Remark, Sentence};
use crate::identify::method::Method;
use crate::identify::residuals::MethodResiduals;
use crate::identify::uncertainty::Uncertainty;
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
    fn kind(&self) -> &'static str {
        match self.agree {
            None => "nothing_to_compare",
            Some(true) => "agreement",
            Some(false) => "pair",
        }
    }

    fn texts(&self) -> [&'static str; 2] {
        match (self.disagreement(), self.agree) {
            (Some(pair), _) => pair.texts(),
            (None, None) => [
                "there is nothing to compare",
                "es ist nichts zu vergleichen",
            ],
            (None, Some(_)) => [
                "none of the {count} comparisons differs by more than its uncertainty allows",
                "keiner der {count} Vergleiche weicht um mehr ab, als seine Unsicherheit erlaubt",
            ],
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

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&plain_all(&self.sentences))
    }
}

serialised_with_text!(Agreement, "summary");
serialised_with_text!(Verdict, "summary");

/// Result for one specimen of a campaign that holds several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpecimenResult {
    /// The verdict on it.
    pub verdict: Verdict,
    /// Its joint estimate.
    pub joint: MethodResult,
    /// Each method alone.
    pub methods: BTreeMap<Method, MethodResult>,
    /// Whether the methods agree.
    pub agreement: Agreement,
    /// The joint fit; `None` without one.
    #[serde(default)]
    pub joint_fit: Option<JointFit>,
}

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

/// A whole identification.
///
/// # Examples
///
/// What it states is typed; JSON adds the English sentence to each variant:
///
/// ```
/// use impact_identification::identify::published::{PublishedSpeed, Where, identify};
/// use impact_identification::identify::{Finding, Identification, Method};
///
/// let speed = |restitution, frequency_ratio, speed| PublishedSpeed {
///     restitution,
///     clearance_ratio: 3.0,
///     frequency_ratio,
///     closing_speed_ratio: speed,
///     printed_step: 0.01,
///     place: Where::Greatest,
/// };
/// let found = identify(&[speed(0.0, 1.19, 9.26), speed(0.3, 1.31, 9.53)], &[0.02]);
/// assert!(found.methods.contains_key(&Method::PublishedSpeeds));
/// assert!(!matches!(found.verdict.findings[0], Finding::PrintedDampingFits { .. }));
/// println!("{}", found.verdict);
///
/// let json = serde_json::to_value(&found)?;
/// let finding = &json["verdict"]["findings"][0];
/// assert_eq!(finding["printed"], 0.02);
/// assert_eq!(finding["text"], found.verdict.findings[0].to_string());
/// let back: Identification = serde_json::from_value(json)?;
/// assert_eq!(back.verdict, found.verdict);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Identification {
    /// The verdict.
    pub verdict: Verdict,
    /// The joint estimate over all methods.
    pub joint: MethodResult,
    /// Each method alone.
    pub methods: BTreeMap<Method, MethodResult>,
    /// Whether the methods agree.
    pub agreement: Agreement,
    /// What each method contributed; profiles and bootstrap on request.
    #[serde(default)]
    pub uncertainty: Uncertainty,
    /// Mistakes of the laboratory that the data give away.
    #[serde(default)]
    pub suspicions: Vec<Finding>,
    /// What was left out of the fits, and why.
    #[serde(default)]
    pub left_out: Vec<LeftOut>,
    /// The records that each method's fit used: their indices in the order of acquisition (the rows
    /// of records.parquet, from 0), rising.
    #[serde(default)]
    pub used_by: BTreeMap<Method, Vec<usize>>,
    /// The joint fit; `None` without one.
    #[serde(default)]
    pub joint_fit: Option<JointFit>,
    /// The residuals of the methods in the joint fit; none where each specimen was fitted by itself.
    /// They have a file of their own.
    #[serde(skip)]
    pub residuals: Vec<MethodResiduals>,
    /// Results for each specimen, if the campaign holds several.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    pub specimens: BTreeMap<String, SpecimenResult>,
}

impl Identification {
    /// The methods whose fit used a record, by its index.
    pub fn methods_using(&self, record: usize) -> impl Iterator<Item = Method> + '_ {
        let using = self.used_by.iter();
        using
            .filter(move |(_, records)| records.binary_search(&record).is_ok())
            .map(|(method, _)| *method)
    }
}

/// Where an identification comes from.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// The resolved settings.
    pub settings: serde_json::Value,
    /// Versions of program and formats.
    pub versions: BTreeMap<String, String>,
    /// SHA-256 of every input file, by path as written.
    pub inputs_sha256: BTreeMap<String, String>,
}
