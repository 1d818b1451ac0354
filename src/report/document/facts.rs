//! What the first page says of the measurement: labels and values.

use super::model::Rich;
use crate::report::content::CampaignSummary;
use crate::report::speech::Speech;

/// What was measured, when, with what: labels and values, those that are known.
pub(super) fn facts(summary: &CampaignSummary, speech: Speech) -> Vec<(Rich, Rich)> {
    let mut facts: Vec<(String, String)> = Vec::new();
    let mut add = |label: &str, value: String| {
        if !value.is_empty() {
            facts.push((speech.say(label), value));
        }
    };
    add("campaign", summary.name.clone());
    add("rig", speech.tell(&speech.say(&summary.rig)));
    add("laboratory", summary.laboratory.clone().unwrap_or_default());
    add("measured", dates(summary, speech));
    add("records", records(summary, speech));
    add("sampling", sampling(summary, speech));
    add("drive", drive(summary, speech));
    add("clearances", clearances(summary, speech));
    add("nominal values", nominal(summary, speech));
    add("channels", channels(summary, speech));
    for note in &summary.notes {
        add("note", speech.tell(note));
    }
    facts
        .into_iter()
        .map(|(l, v)| (Rich::from(l), Rich::from(v).localised(speech)))
        .collect()
}

/// When it was measured.
pub(super) fn dates(summary: &CampaignSummary, speech: Speech) -> String {
    match &summary.dates {
        Some([first, last]) if first == last => first.clone(),
        Some([first, last]) => speech.range(first, last),
        None => String::new(),
    }
}

fn records(summary: &CampaignSummary, speech: Speech) -> String {
    if summary.records_total == 0 {
        return String::new();
    }
    let read = summary.records_total.to_string();
    let used = summary.records_used.to_string();
    let mut text = speech.say_with(
        "{read} read, {used} used",
        &[("read", &read), ("used", &used)],
    );
    let mut add = |phrase: &str, count: usize| {
        if count > 0 {
            text.push_str(&speech.say_with(phrase, &[("count", &count.to_string())]));
        }
    };
    match summary.files_total {
        1 => add(", from {count} file", 1),
        files => add(", from {count} files", files),
    }
    add("; {count} impacts detected", summary.impacts_total);
    text
}

fn sampling(summary: &CampaignSummary, speech: Speech) -> String {
    let rate = summary.sample_rate_hz.map(|r| {
        if r >= 1e3 {
            format!(
                "{}\u{2009}kHz",
                speech
                    .significant(r / 1e3, 4)
                    .trim_end_matches('0')
                    .trim_end_matches(['.', ','])
            )
        } else {
            format!("{}\u{2009}Hz", speech.significant(r, 4))
        }
    });
    let length = summary.record_length_s.map(|l| {
        speech.say_with(
            "{length}\u{2009}s a record",
            &[("length", &speech.significant(l, 3))],
        )
    });
    [rate, length]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(", ")
}

fn drive(summary: &CampaignSummary, speech: Speech) -> String {
    summary
        .frequency_range_hz
        .map_or(String::new(), |[low, high]| {
            let (low, high) = (speech.fixed(low, 2), speech.fixed(high, 2));
            let values = [("low", low.as_str()), ("high", high.as_str())];
            speech.say_with("{low} to {high}\u{2009}Hz, as measured", &values)
        })
}

fn clearances(summary: &CampaignSummary, speech: Speech) -> String {
    let all: Vec<String> = summary
        .clearances_m
        .iter()
        .map(|r| speech.significant(1e3 * r, 3))
        .collect();
    match all.as_slice() {
        [] => String::new(),
        [one] => format!("$r$ = {one}\u{2009}mm"),
        few if few.len() <= 8 => format!("$r$ = {}\u{2009}mm", few.join("; ")),
        many => {
            let (first, last) = (&many[0], &many[many.len() - 1]);
            let count = many.len().to_string();
            speech.say_with(
                "{count} values of $r$ from {first} to {last}\u{2009}mm",
                &[("count", &count), ("first", first), ("last", last)],
            )
        }
    }
}

fn nominal(summary: &CampaignSummary, speech: Speech) -> String {
    let each = summary.nominal.iter().map(|n| {
        let (value, unit) = match n.unit.as_str() {
            "m" if n.value.abs() < 1.0 => (n.value * 1e3, "mm"),
            unit => (n.value, unit),
        };
        let space = if unit.is_empty() { "" } else { "\u{2009}" };
        let value = trimmed(&speech.significant(value, 4));
        let equals = if n.name.ends_with('$') { " =" } else { "" };
        let name = speech.say(&n.name);
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

fn channels(summary: &CampaignSummary, speech: Speech) -> String {
    let each = summary.channels.iter().map(|c| {
        let role = speech.say(&c.role.name().replace('_', " "));
        let unit = if c.unit.is_empty() {
            String::new()
        } else {
            format!(" ({})", c.unit)
        };
        let corner = c.high_pass_hz.map(|f| {
            let value = [("frequency", &*f.to_string())];
            speech.say_with("high-pass at {frequency} Hz", &value)
        });
        let note = Some(c.note.clone()).filter(|n| !n.is_empty());
        let parts = [Some(format!("{role}{unit}")), note, corner];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    });
    each.collect::<Vec<_>>().join("; ")
}
