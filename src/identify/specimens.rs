//! Campaigns that hold several specimens (rigs, masses, bumpers): each identified by itself.

use std::collections::BTreeMap;

use crate::identify::evidence::Evidence;
use crate::identify::run::{Outcome, identify};
use crate::identify::{
    Agreement, MethodResult, SpecimenResult, Verdict, VerdictKind, decay, estimate,
};
use crate::motion::{Bracket, Observation};

/// Identify a campaign: as a whole where it holds one specimen, else each specimen by itself.
///
/// Records that look misfiled are named and left out.
pub fn identify_campaign(evidence: &Evidence) -> (Outcome, BTreeMap<String, SpecimenResult>) {
    let misfiled = decay::misfiled(evidence.observations);
    let names: std::collections::BTreeSet<&str> = evidence
        .observations
        .iter()
        .filter_map(|o| o.setting.specimen.as_deref())
        .collect();
    if names.len() < 2 {
        return (identify(evidence), BTreeMap::new());
    }
    let mut results = BTreeMap::new();
    let mut left_out: Vec<(String, String)> = misfiled.clone();
    for name in names {
        let of_specimen = |o: &&Observation| {
            o.setting.specimen.as_deref() == Some(name)
                && !misfiled.iter().any(|(record, _)| *record == o.record)
        };
        let observations: Vec<Observation> = evidence
            .observations
            .iter()
            .filter(of_specimen)
            .cloned()
            .collect();
        let brackets: Vec<Bracket> = evidence
            .brackets
            .iter()
            .filter(|b| observations.iter().any(|o| b.records.contains(&o.record)))
            .cloned()
            .collect();
        let outcome = identify(&Evidence {
            observations: &observations,
            brackets: &brackets,
            ..*evidence
        });
        left_out.extend(outcome.left_out);
        results.insert(
            name.to_owned(),
            SpecimenResult {
                verdict: outcome.verdict,
                joint: outcome.joint,
                methods: outcome.methods,
                agreement: outcome.agreement,
            },
        );
    }
    (summary(&results, &misfiled, left_out), results)
}

/// The campaign's own outcome where each specimen has its own.
fn summary(
    results: &BTreeMap<String, SpecimenResult>,
    misfiled: &[(String, String)],
    left_out: Vec<(String, String)>,
) -> Outcome {
    let rank = |kind: VerdictKind| match kind {
        VerdictKind::Identified => 0,
        VerdictKind::Weak => 1,
        VerdictKind::NotIdentifiable => 2,
        VerdictKind::DoesNotFit => 3,
    };
    let kind = results
        .values()
        .map(|r| r.verdict.kind)
        .max_by_key(|k| rank(*k))
        .unwrap_or(VerdictKind::NotIdentifiable);
    let mut findings: Vec<String> = results
        .iter()
        .map(|(name, r)| format!("{name}: {}", r.verdict.summary))
        .collect();
    findings.extend(
        misfiled
            .iter()
            .map(|(record, why)| format!("{record}: {why}")),
    );
    let mut joint = MethodResult::default();
    let why = "the campaign holds several specimens; each has its own parameters";
    joint.parameters.restitution = Some(estimate::not_identifiable(why));
    joint.parameters.natural_frequency_hz = Some(estimate::not_identifiable(why));
    joint.parameters.damping_ratio = Some(estimate::not_identifiable(why));
    Outcome {
        verdict: Verdict {
            kind,
            summary: format!(
                "The campaign holds {} specimens; each is identified by itself.{}",
                results.len(),
                match misfiled.len() {
                    0 => String::new(),
                    1 => " One record looks misfiled.".to_owned(),
                    n => format!(" {n} records look misfiled."),
                }
            ),
            findings,
        },
        joint,
        methods: BTreeMap::new(),
        agreement: Agreement {
            agree: None,
            summary: "See each specimen.".into(),
            pairs: Vec::new(),
        },
        suspicions: Vec::new(),
        uncertainty: Default::default(),
        fit: None,
        factor: 1.0,
        left_out,
    }
}
