//! The first page's data: the answer, the agreement, what was measured.

use super::model::{Answer, Front, Rich};
use super::prose::prose;
use super::{Drawn, captions, tables};
use crate::identify::{Estimate, VerdictKind};
use crate::report::content::{CampaignSummary, ReportContent};
use crate::report::figures::look::NumberLook;
use crate::report::parameters::{self, PARAMETERS, ParameterLook};

/// Builds the first page.
pub fn front(content: &ReportContent, drawn: &Drawn<'_>) -> Front {
    let id = &content.identification;
    let verdict = headline(id.verdict.kind).0;
    Front {
        synthetic: content.summary.synthetic,
        verdict,
        headline: campaign_headline(content, drawn.numbers),
        summary: prose(&id.verdict.summary).localised(drawn.numbers),
        findings: localised(findings(content, drawn.numbers), drawn.numbers),
        answers: answers(content, drawn.numbers),
        specimens: tables::specimens(content, drawn.numbers),
        agree: match id.agreement.agree {
            Some(true) => "yes",
            Some(false) => "no",
            None => "unknown",
        },
        agreement: match id.specimens.is_empty() {
            true => prose(&agreement(&id.agreement.summary)).localised(drawn.numbers),
            false => Rich::default(),
        },
        facts: facts(&content.summary, drawn.numbers),
        map: drawn.figure("map_small", ""),
        estimates: drawn.figure("estimates", ""),
    }
}

fn localised(texts: Vec<Rich>, numbers: NumberLook) -> Vec<Rich> {
    texts.into_iter().map(|t| t.localised(numbers)).collect()
}

/// The headline of the whole campaign.
fn campaign_headline(content: &ReportContent, numbers: NumberLook) -> String {
    let id = &content.identification;
    let specimens = id.specimens.len();
    let identified = id.specimens.values();
    let identified = identified
        .filter(|s| s.verdict.kind == VerdictKind::Identified)
        .count();
    match specimens - identified {
        _ if specimens == 0 => {
            let words = headline(id.verdict.kind).1;
            match content.records.is_empty() {
                true => numbers.say(words.trim_end_matches(" the rig")),
                false => numbers.say(words),
            }
        }
        0 => numbers.say_with(
            "Identified: the model fits each of the {count} specimens",
            &[("count", &specimens.to_string())],
        ),
        _ => numbers.say_with(
            "The model fits {some} of the {count} specimens",
            &[
                ("some", &identified.to_string()),
                ("count", &specimens.to_string()),
            ],
        ),
    }
}

/// Reasons and findings; where there are specimens, what was found of each in full.
fn findings(content: &ReportContent, numbers: NumberLook) -> Vec<Rich> {
    let id = &content.identification;
    let of = |finding: &String| {
        let specimen = id.specimens.iter().find(|(name, _)| {
            let rest = finding.strip_prefix(name.as_str());
            rest.is_some_and(|r| r.starts_with(':'))
        });
        let mut words = captions::spoken(finding, numbers);
        if let Some((_, result)) = specimen {
            for more in &result.verdict.findings {
                words.push_str(&format!(" {}", captions::spoken(more, numbers)));
            }
        }
        prose(&words)
    };
    id.verdict.findings.iter().map(of).collect()
}

/// The parameters' cards; none where only each specimen alone has an answer.
fn answers(content: &ReportContent, numbers: NumberLook) -> Vec<Answer> {
    let id = &content.identification;
    let estimates = PARAMETERS
        .iter()
        .map(|look| (look, (look.pick)(&id.joint.parameters)));
    let told = estimates
        .clone()
        .any(|(_, e)| e.is_some_and(|e| e.value.is_some()));
    if !told && !id.specimens.is_empty() {
        return Vec::new();
    }
    estimates
        .map(|(look, e)| answer(look, e, numbers))
        .collect()
}

/// The words on agreement without the headline that stands before them.
fn agreement(summary: &str) -> String {
    if let Some(rest) = summary.strip_prefix("The methods do not agree on ") {
        return captions::sentence(&format!("This concerns {rest}"));
    }
    let rest = summary.strip_prefix("The methods agree");
    let rest = rest.map_or(summary, |r| r.trim_start_matches([':', '.', ';', ',', ' ']));
    captions::sentence(rest)
}

/// A parameter ready to print.
fn answer(look: &ParameterLook, estimate: Option<&Estimate>, numbers: NumberLook) -> Answer {
    let half = estimate
        .and_then(parameters::half_width)
        .map(|h| h * look.factor);
    let decimals = parameters::decimals_for(half.unwrap_or(0.0));
    let print = |v: f64| numbers.fixed(v * look.factor, decimals);
    let value = estimate.and_then(|e| e.value);
    let interval = estimate
        .and_then(|e| e.interval95)
        .filter(|_| value.is_some());
    Answer {
        symbol: Rich::from(look.symbol),
        name: Rich::from(numbers.say(look.name)),
        value: value.map(print),
        plus_minus: half
            .filter(|_| value.is_some())
            .map(|h| numbers.fixed(h, decimals)),
        unit: look.unit.into(),
        interval: interval.map(|[low, high]| from_to(&print(low), &print(high), numbers)),
        status: estimate.map_or("not_asked", |e| parameters::status_name(e.status)),
        note: estimate
            .and_then(|e| e.note.as_ref())
            .map(|n| prose(n).localised(numbers)),
    }
}

/// Name of a verdict in the document, and its headline.
pub fn headline(kind: VerdictKind) -> (&'static str, &'static str) {
    match kind {
        VerdictKind::Identified => ("identified", "Identified: the model fits the rig"),
        VerdictKind::Weak => ("weak", "Identified in part"),
        VerdictKind::NotIdentifiable => ("not_identifiable", "Not identifiable from these data"),
        VerdictKind::DoesNotFit => ("does_not_fit", "The model does not fit the rig"),
    }
}

fn facts(summary: &CampaignSummary, numbers: NumberLook) -> Vec<(Rich, Rich)> {
    let mut facts: Vec<(String, String)> = Vec::new();
    let mut add = |label: &str, value: String| {
        if !value.is_empty() {
            facts.push((numbers.say(label), value));
        }
    };
    add("campaign", summary.name.clone());
    add("rig", numbers.say(&summary.rig));
    add("laboratory", summary.laboratory.clone().unwrap_or_default());
    add("measured", dates(summary, numbers));
    add("records", records(summary, numbers));
    add("sampling", sampling(summary, numbers));
    add("drive", drive(summary, numbers));
    add("clearances", clearances(summary, numbers));
    add("nominal values", nominal(summary, numbers));
    add("channels", channels(summary, numbers));
    for note in &summary.notes {
        add("note", note.clone());
    }
    facts
        .into_iter()
        .map(|(l, v)| (Rich::from(l), Rich::from(v).localised(numbers)))
        .collect()
}

/// A range in words.
fn from_to(first: &str, last: &str, numbers: NumberLook) -> String {
    numbers.say_with("{first} to {last}", &[("first", first), ("last", last)])
}

/// When it was measured.
pub fn dates(summary: &CampaignSummary, numbers: NumberLook) -> String {
    match &summary.dates {
        Some([first, last]) if first == last => first.clone(),
        Some([first, last]) => from_to(first, last, numbers),
        None => String::new(),
    }
}

fn records(summary: &CampaignSummary, numbers: NumberLook) -> String {
    if summary.records_total == 0 {
        return String::new();
    }
    let read = summary.records_total.to_string();
    let used = summary.records_used.to_string();
    let mut text = numbers.say_with(
        "{read} read, {used} used",
        &[("read", &read), ("used", &used)],
    );
    let mut add = |phrase: &str, count: usize| {
        if count > 0 {
            text.push_str(&numbers.say_with(phrase, &[("count", &count.to_string())]));
        }
    };
    match summary.files_total {
        1 => add(", from {count} file", 1),
        files => add(", from {count} files", files),
    }
    add("; {count} impacts detected", summary.impacts_total);
    text
}

fn sampling(summary: &CampaignSummary, numbers: NumberLook) -> String {
    let rate = summary.sample_rate_hz.map(|r| {
        if r >= 1e3 {
            format!(
                "{}\u{2009}kHz",
                numbers
                    .significant(r / 1e3, 4)
                    .trim_end_matches('0')
                    .trim_end_matches(['.', ','])
            )
        } else {
            format!("{}\u{2009}Hz", numbers.significant(r, 4))
        }
    });
    let length = summary.record_length_s.map(|l| {
        numbers.say_with(
            "{length}\u{2009}s a record",
            &[("length", &numbers.significant(l, 3))],
        )
    });
    [rate, length]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(", ")
}

fn drive(summary: &CampaignSummary, numbers: NumberLook) -> String {
    summary
        .frequency_range_hz
        .map_or(String::new(), |[low, high]| {
            let (low, high) = (numbers.fixed(low, 2), numbers.fixed(high, 2));
            let values = [("low", low.as_str()), ("high", high.as_str())];
            numbers.say_with("{low} to {high}\u{2009}Hz, as measured", &values)
        })
}

fn clearances(summary: &CampaignSummary, numbers: NumberLook) -> String {
    let all: Vec<String> = summary
        .clearances_m
        .iter()
        .map(|r| numbers.significant(1e3 * r, 3))
        .collect();
    match all.as_slice() {
        [] => String::new(),
        [one] => format!("$r$ = {one}\u{2009}mm"),
        few if few.len() <= 8 => format!("$r$ = {}\u{2009}mm", few.join("; ")),
        many => {
            let (first, last) = (&many[0], &many[many.len() - 1]);
            let count = many.len().to_string();
            numbers.say_with(
                "{count} values of $r$ from {first} to {last}\u{2009}mm",
                &[("count", &count), ("first", first), ("last", last)],
            )
        }
    }
}

fn nominal(summary: &CampaignSummary, numbers: NumberLook) -> String {
    let each = summary.nominal.iter().map(|n| {
        let (value, unit) = match n.unit.as_str() {
            "m" if n.value.abs() < 1.0 => (n.value * 1e3, "mm"),
            unit => (n.value, unit),
        };
        let space = if unit.is_empty() { "" } else { "\u{2009}" };
        let value = trimmed(&numbers.significant(value, 4));
        let equals = if n.name.ends_with('$') { " =" } else { "" };
        let name = numbers.say(&n.name);
        format!("{name}{equals} {value}{space}{unit}")
    });
    each.collect::<Vec<_>>().join(", ")
}

/// Without zeros at the end that a nominal value does not mean.
fn trimmed(number: &str) -> String {
    if number.contains(['.', ',']) && !number.contains('·') {
        number
            .trim_end_matches('0')
            .trim_end_matches(['.', ','])
            .to_owned()
    } else {
        number.to_owned()
    }
}

fn channels(summary: &CampaignSummary, numbers: NumberLook) -> String {
    let each = summary.channels.iter().map(|c| {
        let role = numbers.say(&c.role.name().replace('_', " "));
        let unit = if c.unit.is_empty() {
            String::new()
        } else {
            format!(" ({})", c.unit)
        };
        let corner = c.high_pass_hz.map(|f| {
            let value = [("frequency", &*f.to_string())];
            numbers.say_with("high-pass at {frequency} Hz", &value)
        });
        let note = Some(c.note.clone()).filter(|n| !n.is_empty());
        let parts = [Some(format!("{role}{unit}")), note, corner];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    });
    each.collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::Status;

    #[test]
    fn valid_what_is_not_identifiable_has_no_number() {
        let none = Estimate {
            value: None,
            standard_error: None,
            interval95: None,
            status: Status::NotIdentifiable,
            note: Some("no bracket".into()),
        };
        let answer = super::answer(&PARAMETERS[0], Some(&none), NumberLook::default());
        assert_eq!((answer.value, answer.interval), (None, None));
        assert_eq!(answer.status, "not_identifiable");
    }
}
