//! The first page's data: the verdict, the answer, the agreement, what was measured.

use std::collections::BTreeSet;

use super::drawn::Drawn;
use super::facts::facts;
use super::model::{Answer, Front, Rich};
use super::tables;
use super::verdict::headline;
use crate::content::ReportContent;
use crate::locale::Locale;
use crate::parameters::{self, PARAMETERS, ParameterLook};
use crate::phrase::Phrase;
use impact_fit::parameters::effect::EffectKind;
use impact_fit::{Estimate, Finding, VerdictKind};

/// Builds the first page.
pub(super) fn front(content: &ReportContent, drawn: &Drawn<'_>) -> Front {
    let id = &content.identification;
    Front {
        synthetic: content.campaign.synthetic,
        verdict: id.verdict.kind.name(),
        headline: Rich::from(campaign_headline(content, drawn.locale)),
        summary: Rich::from(drawn.locale.sentences(&id.verdict.sentences)),
        findings: findings(content, drawn.locale),
        answers: answers(content, drawn.locale),
        specimens: tables::specimens(content, drawn.locale).map(|t| t.named("specimens")),
        agree: match id.agreement.agree {
            Some(true) => "yes",
            Some(false) => "no",
            None => "unknown",
        },
        agreement: if id.specimens.is_empty() {
            Rich::from(drawn.locale.sentence(&id.agreement))
        } else {
            Rich::default()
        },
        facts: facts(content, drawn.locale),
        map: drawn.figure("map_small", ""),
        estimates: drawn.figure("estimates", ""),
    }
}

/// The headline of the whole campaign.
fn campaign_headline(content: &ReportContent, locale: Locale<'_>) -> String {
    let id = &content.identification;
    let specimens = id.specimens.len();
    let identified = id.specimens.values();
    let identified = identified
        .filter(|s| matches!(s.verdict.kind, VerdictKind::Identified | VerdictKind::Weak))
        .count();
    match specimens - identified {
        _ if specimens == 0 && id.verdict.doubts_clearances() => {
            locale.translate(Phrase::ClearancesInDoubt)
        }
        _ if specimens == 0 => locale.translate(headline(
            id.verdict.kind,
            !content.compared.records.is_empty(),
        )),
        0 => locale.translate_with(
            Phrase::IdentifiedEachSpecimen,
            &[("count", &specimens.to_string())],
        ),
        _ => locale.translate_with(
            Phrase::FitsSomeSpecimens,
            &[
                ("some", &identified.to_string()),
                ("count", &specimens.to_string()),
            ],
        ),
    }
}

/// Reasons and findings; of each specimen what was found beside its values, which are in the table.
fn findings(content: &ReportContent, locale: Locale<'_>) -> Vec<Rich> {
    let id = &content.identification;
    let of = |finding: &Finding| {
        let Finding::Specimen { specimen, .. } = finding else {
            return Some(locale.sentence(finding));
        };
        let found = &id.specimens.get(specimen)?.verdict.findings;
        let name = Finding::Specimen {
            specimen: specimen.clone(),
            verdict: Vec::new(),
        };
        let text = format!(
            "{} {}",
            locale.message(&name).trim_end(),
            locale.sentences(found)
        );
        (!found.is_empty()).then_some(text)
    };
    let all = id.verdict.findings.iter();
    let (beyond, others): (Vec<&Finding>, Vec<&Finding>) =
        all.partition(|f| matches!(f, Finding::BeyondModel { .. }));
    let mut texts: Vec<String> = others.into_iter().filter_map(of).collect();
    match beyond[..] {
        [] => {}
        [alone] => texts.push(locale.sentence(alone)),
        _ => texts.push(beyond_model(&beyond, locale)),
    }
    texts.into_iter().map(Rich::from).collect()
}

/// The significant effects beyond the model by their kinds, in one sentence.
fn beyond_model(findings: &[&Finding], locale: Locale<'_>) -> String {
    let kinds: BTreeSet<EffectKind> = findings
        .iter()
        .filter_map(|finding| match finding {
            Finding::BeyondModel { effect, .. } => Some(effect.kind()),
            _ => None,
        })
        .collect();
    let names = kinds.iter().map(|kind| locale.message(kind));
    let names: Vec<String> = names.collect();
    locale.translate_with(Phrase::BeyondTheModel, &[("effects", &names.join(", "))])
}

/// The parameters' cards; none where only each specimen alone has an answer.
fn answers(content: &ReportContent, locale: Locale<'_>) -> Vec<Answer> {
    let id = &content.identification;
    let estimates = PARAMETERS
        .iter()
        .map(|look| (look, id.joint.parameters.get(look.parameter)));
    let known = estimates
        .clone()
        .any(|(_, e)| e.is_some_and(|e| e.value.is_some()));
    if !known && !id.specimens.is_empty() {
        return Vec::new();
    }
    estimates.map(|(look, e)| answer(look, e, locale)).collect()
}

/// A parameter ready to print.
fn answer(look: &ParameterLook, estimate: Option<&Estimate>, locale: Locale<'_>) -> Answer {
    let half = estimate
        .and_then(parameters::half_width)
        .map(|h| h * look.factor);
    let decimals = parameters::decimals_for(half.unwrap_or(0.0));
    let print = |v: f64| locale.fixed(v * look.factor, decimals);
    let value = estimate.and_then(|e| e.value);
    let interval = estimate
        .and_then(|e| e.interval95)
        .filter(|_| value.is_some());
    Answer {
        symbol: Rich::from(look.symbol),
        name: Rich::from(locale.translate(look.name)),
        value: value.map(print),
        plus_minus: half
            .filter(|_| value.is_some())
            .map(|h| locale.fixed(h, decimals)),
        unit: look.unit.into(),
        interval: interval.map(|[low, high]| locale.range(&print(low), &print(high))),
        status: estimate.map_or("not_asked", |e| e.status.name()),
        note: estimate
            .and_then(|e| e.note.as_ref())
            .map(|n| Rich::from(locale.message(n))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::Status;

    #[test]
    fn what_is_not_identifiable_has_no_number() {
        let none = Estimate {
            value: None,
            standard_error: None,
            interval95: None,
            status: Status::NotIdentifiable,
            note: Some(impact_fit::Note::NotSeparable),
        };
        let answer = super::answer(&PARAMETERS[0], Some(&none), Locale::default());
        assert_eq!((answer.value, answer.interval), (None, None));
        assert_eq!(answer.status, "not_identifiable");
    }
}
