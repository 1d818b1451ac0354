//! The measurement on the first page: labels and values.

use super::model::Rich;
use crate::content::{CampaignFacts, NominalValue, ReportContent, Subject};
use crate::locale::Locale;
use crate::phrase::Phrase;
use impact_identification::replay::Overview;
use impact_records::record::calibrate::ChannelSetup;

/// What was measured, when, with what: labels and values, those that are known.
pub(super) fn facts(content: &ReportContent, locale: Locale<'_>) -> Vec<(Rich, Rich)> {
    let (campaign, overview) = (&content.campaign, &content.compared.overview);
    let mut facts: Vec<(String, String)> = Vec::new();
    let mut add = |label: Phrase, value: String| {
        if !value.is_empty() {
            facts.push((locale.translate(label), value));
        }
    };
    add(Phrase::Campaign, campaign.name.clone());
    let rig = [
        campaign.rig.clone(),
        Some(subject(campaign.subject, locale)),
    ];
    let rig: Vec<String> = rig.into_iter().flatten().collect();
    add(Phrase::Rig, rig.join(", "));
    let shared: Vec<&str> = campaign.shared.iter().map(|c| c.name()).collect();
    add(Phrase::ErrorsOfTheRig, shared.join(", "));
    for (label, words) in &campaign.stated {
        add(*label, words.clone());
    }
    add(Phrase::Measured, dates(campaign, locale));
    add(Phrase::ReportOf, content.date.clone().unwrap_or_default());
    add(Phrase::Records, records(overview, campaign.files, locale));
    add(Phrase::Sampling, sampling(campaign, overview, locale));
    add(Phrase::Drive, drive(overview, locale));
    add(Phrase::Clearances, clearances(overview, locale));
    add(Phrase::NominalValues, nominal(&campaign.nominal, locale));
    add(Phrase::Channels, channels(&campaign.channels, locale));
    facts
        .into_iter()
        .map(|(l, v)| (Rich::from(l), Rich::from(v)))
        .collect()
}

fn subject(subject: Subject, locale: Locale<'_>) -> String {
    match subject {
        Subject::TwoMasses => locale.translate(Phrase::TwoMasses),
        Subject::OneMass => locale.translate(Phrase::OneMass),
        Subject::PublishedSpeeds => locale.translate(Phrase::PublishedSpeeds),
    }
}

/// When it was measured.
pub(super) fn dates(campaign: &CampaignFacts, locale: Locale<'_>) -> String {
    match &campaign.dates {
        Some([first, last]) if first == last => first.clone(),
        Some([first, last]) => locale.range(first, last),
        None => String::new(),
    }
}

fn records(overview: &Overview, files: usize, locale: Locale<'_>) -> String {
    if overview.records == 0 {
        return String::new();
    }
    let read = overview.records.to_string();
    let used = overview.records_used.to_string();
    let mut text = locale.translate_with(Phrase::ReadAndUsed, &[("read", &read), ("used", &used)]);
    let mut add = |phrase: Phrase, count: usize| {
        if count > 0 {
            text.push_str(&locale.translate_with(phrase, &[("count", &count.to_string())]));
        }
    };
    match files {
        1 => add(Phrase::FromOneFile, 1),
        files => add(Phrase::FromFiles, files),
    }
    add(Phrase::ImpactsDetected, overview.impacts);
    text
}

/// Rate and length of the records; lists of times have no rate.
fn sampling(campaign: &CampaignFacts, overview: &Overview, locale: Locale<'_>) -> String {
    let lists = campaign.channels.iter().any(|c| c.content.is_list());
    let rate = overview.sample_rate_hz.filter(|_| !lists).map(|r| {
        if r >= 1e3 {
            let rate = trimmed(&locale.significant(r / 1e3, 4));
            format!("{rate}\u{2009}kHz")
        } else {
            format!("{}\u{2009}Hz", locale.significant(r, 4))
        }
    });
    let length = overview.record_length_s.map(|l| {
        locale.translate_with(
            Phrase::RecordLength,
            &[("length", &locale.significant(l, 3))],
        )
    });
    [rate, length]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(", ")
}

fn drive(overview: &Overview, locale: Locale<'_>) -> String {
    overview
        .frequency_range_hz
        .map_or(String::new(), |[low, high]| {
            let (low, high) = (locale.fixed(low, 2), locale.fixed(high, 2));
            let values = [("low", low.as_str()), ("high", high.as_str())];
            locale.translate_with(Phrase::MeasuredFrequencies, &values)
        })
}

fn clearances(overview: &Overview, locale: Locale<'_>) -> String {
    let all: Vec<String> = overview
        .clearances_m
        .iter()
        .map(|r| locale.clearance(*r))
        .collect();
    match all.as_slice() {
        [] if overview.frequency_range_hz.is_none() => String::new(),
        [] => locale.translate(Phrase::NoClearanceStated),
        [one] => format!("$r$ = {one}\u{2009}mm"),
        few if few.len() <= 8 => format!("$r$ = {}\u{2009}mm", few.join("; ")),
        many => {
            let (first, last) = (&many[0], &many[many.len() - 1]);
            let count = many.len().to_string();
            locale.translate_with(
                Phrase::ManyClearances,
                &[("count", &count), ("first", first), ("last", last)],
            )
        }
    }
}

fn nominal(values: &[NominalValue], locale: Locale<'_>) -> String {
    let each = values.iter().map(|n| {
        let (value, unit) = match n.unit {
            "m" if n.value.abs() < 1.0 => (n.value * 1e3, "mm"),
            unit => (n.value, unit),
        };
        let space = if unit.is_empty() { "" } else { "\u{2009}" };
        let value = trimmed(&locale.significant(value, 4));
        let equals = if n.name.english().ends_with('$') {
            " ="
        } else {
            ""
        };
        let name = locale.translate(n.name);
        format!("{name}{equals} {value}{space}{unit}")
    });
    each.collect::<Vec<_>>().join(", ")
}

/// Without trailing zeros.
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

fn channels(channels: &[ChannelSetup], locale: Locale<'_>) -> String {
    let each = channels.iter().map(|c| {
        let role = locale.role(c.role);
        let unit = match c.role.dimension().map_or("", |d| d.si_symbol()) {
            "" => String::new(),
            unit => format!(" ({unit})"),
        };
        let corner = c.high_pass_hz.map(|f| {
            let frequency = locale.digits(&f.to_string());
            let value = [("frequency", frequency.as_str())];
            locale.translate_with(Phrase::HighPassAt, &value)
        });
        let instrument = c.instrument.clone().filter(|i| !i.is_empty());
        let parts = [Some(format!("{role}{unit}")), instrument, corner];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    });
    each.collect::<Vec<_>>().join("; ")
}
