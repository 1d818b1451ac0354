//! Identification: parameters fitted to what was measured, with uncertainty and a verdict.
//!
//! The result is plain data ([`Identification`]), written as `identification.json`. [`run`] leads from
//! [`evidence`] (what was measured, as residuals of the model) over [`fit`] (least squares) to
//! [`uncertainty`] and [`judgement`] (does the model fit, do the methods agree, was there a mistake).

pub mod decay;
pub mod estimate;
pub mod evidence;
pub mod fit;
pub mod joint;
pub mod judgement;
pub mod methods;
pub mod middles;
pub mod plan;
pub mod published;
pub mod replay;
pub mod residuals;
pub mod results;
pub mod run;
pub mod selection;
pub mod specimens;
pub mod uncertainty;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::identify::judgement::contact_law::ContactLaw;
use crate::identify::judgement::suspicion::Suspicion;
use crate::identify::uncertainty::Uncertainty;

/// How well the data tell a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The data tell it.
    Identified,
    /// The data tell it poorly; the note says on what it leans.
    Weak,
    /// The data cannot tell it: there is no value.
    NotIdentifiable,
}

/// An estimate of one parameter with its interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Best value in SI; `None` where not identifiable.
    pub value: Option<f64>,
    /// Standard error in the same unit.
    pub standard_error: Option<f64>,
    /// 95 % interval, low and high.
    pub interval95: Option<[f64; 2]>,
    /// How well the data tell it.
    pub status: Status,
    /// Why weak or not identifiable; on what it leans; which measurement would help.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub note: Option<String>,
}

/// The parameters of the oscillator, as far as a method tells them.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ParameterSet {
    /// Coefficient of restitution R.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub restitution: Option<Estimate>,
    /// Natural frequency f0, Hz.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub natural_frequency_hz: Option<Estimate>,
    /// Damping ratio β = b/(2√(km)).
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub damping_ratio: Option<Estimate>,
    /// Static deflection x_st = F0/k, m.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub static_deflection_m: Option<Estimate>,
}

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
    /// Remarks in words a user understands.
    #[serde(default)]
    pub remarks: Vec<String>,
    /// Impacts that lie far from the bulk and were left out; of impacts alone.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub outlying_impacts: Vec<OutlyingImpact>,
    /// How R depends on the closing speed; of impacts alone.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub contact_law: Option<ContactLaw>,
    /// Further numbers of the method (gains, asymmetries …), named with their unit.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    pub further: BTreeMap<String, Estimate>,
}

/// An impact whose speeds lie far from those of the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutlyingImpact {
    /// The record's name.
    pub record: String,
    /// Time since the record's first sample, s.
    pub time_s: f64,
    /// Closing speed before, m/s.
    pub before_m_s: f64,
    /// Parting speed after, m/s.
    pub after_m_s: f64,
}

/// Whether two methods agree on a parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PairAgreement {
    /// The parameter's name.
    pub parameter: String,
    /// The two methods.
    pub methods: [String; 2],
    /// Difference of the estimates over its standard error.
    pub z_score: f64,
    /// Two-sided p-value.
    pub p_value: f64,
}

/// Whether the methods agree, as a test and in words.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// `None` where fewer than two methods tell a common parameter.
    pub agree: Option<bool>,
    /// In words a user understands.
    pub summary: String,
    /// Pair by pair.
    pub pairs: Vec<PairAgreement>,
}

/// The overall answer in one word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VerdictKind {
    /// Parameters are identified and the model fits.
    Identified,
    /// Some parameters only weakly.
    Weak,
    /// Something essential cannot be told from these data.
    NotIdentifiable,
    /// The model does not describe these data.
    DoesNotFit,
}

/// The verdict: one word and two sentences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// The word.
    pub kind: VerdictKind,
    /// Plain sentences.
    pub summary: String,
    /// Reasons and findings, one each.
    pub findings: Vec<String>,
}

/// Result for one specimen of a campaign that holds several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpecimenResult {
    /// The verdict on it.
    pub verdict: Verdict,
    /// Its joint estimate.
    pub joint: MethodResult,
    /// Each method alone.
    pub methods: BTreeMap<String, MethodResult>,
    /// Whether the methods agree.
    pub agreement: Agreement,
}

/// The whole identification, `identification.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Identification {
    /// The verdict.
    pub verdict: Verdict,
    /// The joint estimate over all methods.
    pub joint: MethodResult,
    /// Each method alone: `boundaries`, `trajectories`, `impacts`, `resonance`, `free_decay`.
    pub methods: BTreeMap<String, MethodResult>,
    /// Whether the methods agree.
    pub agreement: Agreement,
    /// What each method contributed; profiles and bootstrap where asked for.
    #[serde(default)]
    pub uncertainty: Uncertainty,
    /// Mistakes of the laboratory that the data give away.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub suspicions: Vec<Suspicion>,
    /// Results for each specimen, where the campaign holds several.
    #[serde(skip_serializing_if = "BTreeMap::is_empty", default)]
    pub specimens: BTreeMap<String, SpecimenResult>,
    /// The resolved settings.
    pub settings: serde_json::Value,
    /// Versions of program and formats.
    pub versions: BTreeMap<String, String>,
    /// SHA-256 of every input file, by path as written.
    pub inputs_sha256: BTreeMap<String, String>,
}
