//! Campaigns that hold several specimens (rigs, masses, bumpers): each identified by itself.

use std::collections::{BTreeMap, BTreeSet};

use crate::identify::identification::{Identification, SpecimenResult};
use crate::identify::run::identify;
use impact_fit::estimate;
use impact_fit::estimate::Status;
use impact_fit::evidence::Evidence;
use impact_fit::messages::{Finding, Item, LeftOut, Note, Sentence};
use impact_fit::method::Method;
use impact_fit::methods::answer::{MethodResult, Verdict, VerdictKind};
use impact_fit::methods::decays;
use impact_fit::parameters::Coordinate;
use impact_records::motion::{Bracket, Observation};

/// Identify a campaign: as a whole if it holds one specimen, else each specimen by itself.
///
/// Records that look misfiled are noted and left out.
pub fn identify_campaign(evidence: &Evidence<'_>) -> Identification {
    let names: BTreeSet<&str> = evidence
        .observations
        .iter()
        .filter_map(|o| o.setting.specimen.as_deref())
        .collect();
    if names.len() < 2 {
        return identify(evidence);
    }
    let misfiled = decays::misfiled(evidence.observations);
    let mut whole = Whole {
        left_out: misfiled.clone(),
        ..Whole::default()
    };
    for name in names {
        let part = Part::of(evidence, name, &misfiled);
        let found = identify(&Evidence {
            observations: &part.observations,
            brackets: &part.brackets,
            ..*evidence
        });
        whole.add(name, &part, found);
    }
    whole.identification(&misfiled)
}

/// The observations and brackets of one specimen, with their indices in the campaign.
struct Part {
    records: Vec<usize>,
    observations: Vec<Observation>,
    bracket_indices: Vec<usize>,
    brackets: Vec<Bracket>,
}

impl Part {
    fn of(evidence: &Evidence<'_>, name: &str, misfiled: &[LeftOut]) -> Self {
        let is_misfiled = |record: usize| {
            let mut items = misfiled.iter().map(|m| &m.item);
            items.any(|item| matches!(item, Item::Record { index, .. } if *index == record))
        };
        let of_specimen = |(i, o): &(usize, &Observation)| {
            o.setting.specimen.as_deref() == Some(name) && !is_misfiled(*i)
        };
        let indexed = evidence.observations.iter().enumerate();
        let (records, observations): (Vec<usize>, Vec<Observation>) = indexed
            .filter(of_specimen)
            .map(|(i, o)| (i, o.clone()))
            .unzip();
        let within = |b: &Bracket| observations.iter().any(|o| b.records.contains(&o.record));
        let indexed = evidence.brackets.iter().enumerate();
        let (bracket_indices, brackets) = indexed
            .filter(|(_, b)| within(b))
            .map(|(i, b)| (i, b.clone()))
            .unzip();
        Self {
            records,
            observations,
            bracket_indices,
            brackets,
        }
    }

    /// What was left out, with the indices of the campaign.
    fn in_campaign(&self, mut left: LeftOut) -> LeftOut {
        match &mut left.item {
            Item::Record { index, .. } | Item::Impact { index, .. } => {
                *index = self.records[*index];
            }
            Item::Bracket { index, .. } => *index = self.bracket_indices[*index],
        }
        left
    }
}

/// What all specimens together give.
#[derive(Default)]
struct Whole {
    results: BTreeMap<String, SpecimenResult>,
    left_out: Vec<LeftOut>,
    used_by: BTreeMap<Method, Vec<usize>>,
}

impl Whole {
    fn add(&mut self, name: &str, part: &Part, found: Identification) {
        let left_out = found.left_out.into_iter();
        self.left_out.extend(left_out.map(|l| part.in_campaign(l)));
        for (method, records) in found.used_by {
            let all = self.used_by.entry(method).or_default();
            all.extend(records.into_iter().map(|i| part.records[i]));
            all.sort_unstable();
        }
        let result = SpecimenResult {
            verdict: found.verdict,
            joint: found.joint,
            methods: found.methods,
            agreement: found.agreement,
            joint_fit: found.joint_fit,
        };
        self.results.insert(name.to_owned(), result);
    }

    /// How many specimens the model fits, and in how many each parameter is poorly known.
    fn judged(&self) -> Vec<Sentence> {
        let fits = |r: &&SpecimenResult| {
            matches!(r.verdict.kind, VerdictKind::Identified | VerdictKind::Weak)
        };
        let fitting = self.results.values().filter(fits).count();
        let poorly = Coordinate::PHYSICAL.into_iter().filter_map(|parameter| {
            let weak = |r: &&SpecimenResult| {
                let estimate = r.joint.parameters.get(parameter);
                estimate.is_some_and(|e| e.status == Status::Weak)
            };
            let count = self.results.values().filter(fits).filter(weak).count();
            (count > 0).then_some(Sentence::SpecimensPoorlyKnown { parameter, count })
        });
        let count = self.results.len();
        std::iter::once(Sentence::SpecimensFit { fitting, count })
            .chain(poorly)
            .collect()
    }

    /// The campaign's own result: the worst of the verdicts, no parameters.
    fn identification(self, misfiled: &[LeftOut]) -> Identification {
        let kinds = self.results.values().map(|r| r.verdict.kind);
        let mut sentences = vec![Sentence::Specimens {
            count: self.results.len(),
        }];
        sentences.extend(self.judged());
        if !misfiled.is_empty() {
            let count = misfiled.len();
            sentences.push(Sentence::MisfiledRecords { count });
        }
        let of_specimens = self.results.iter().map(|(name, r)| Finding::Specimen {
            specimen: name.clone(),
            verdict: r.verdict.sentences.clone(),
        });
        let of_records = misfiled.iter().filter_map(|m| match &m.item {
            Item::Record { record, .. } => Some(Finding::MisfiledRecord {
                record: record.clone(),
                reason: m.reason.clone(),
            }),
            Item::Bracket { .. } | Item::Impact { .. } => None,
        });
        let verdict = Verdict {
            kind: kinds.max().unwrap_or(VerdictKind::NotIdentifiable),
            sentences,
            findings: of_specimens.chain(of_records).collect(),
        };
        let mut joint = MethodResult::default();
        let unknown = || Some(estimate::not_identifiable(Note::SeveralSpecimens));
        joint.parameters.restitution = unknown();
        joint.parameters.natural_frequency_hz = unknown();
        joint.parameters.damping_ratio = unknown();
        Identification {
            verdict,
            joint,
            left_out: self.left_out,
            used_by: self.used_by,
            specimens: self.results,
            ..Identification::default()
        }
    }
}
