//! The result of an identification, `identification.json`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::identify::residuals::MethodResiduals;
use crate::identify::uncertainty::Uncertainty;
use impact_fit::messages::{Finding, LeftOut};
use impact_fit::method::Method;
use impact_fit::methods::answer::{Agreement, JointFit, MethodResult, Verdict};

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

/// A whole identification.
///
/// # Examples
///
/// What it states is typed; JSON adds the English sentence to each variant:
///
/// ```
/// use impact_fit::methods::published::{PublishedSpeed, Where};
/// use impact_fit::{Finding, Method};
/// use impact_identification::identify::Identification;
/// use impact_identification::identify::published::identify;
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
