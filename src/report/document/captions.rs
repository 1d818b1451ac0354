//! Which figures the methods' section shows, in order, and what stands under each.

use crate::report::content::ReportContent;
use crate::report::figures::look::NumberLook;
use crate::report::figures::{decays, numbered};
use crate::report::parameters::{method_name, parameter};

/// A figure's name and its caption.
type Captioned = (String, String);

/// Groups of figures; those of one group stand side by side where they are narrow.
pub fn method_figures(content: &ReportContent, numbers: NumberLook) -> Vec<Vec<Captioned>> {
    let mut groups = vec![narrow(content, numbers)];
    let alone = |captioned: Vec<Captioned>| captioned.into_iter().map(|c| vec![c]);
    groups.extend(alone(impacts(content, numbers)));
    groups.extend(alone(resonance(content, numbers)));
    groups.extend(alone(free_decays(content, numbers)));
    groups.push(vec![profiles(numbers)]);
    groups.extend(alone(residuals(content, numbers)));
    groups
}

fn narrow(content: &ReportContent, numbers: NumberLook) -> Vec<Captioned> {
    let boundary = "Boundary fit: each bracket, measured less simulated. A bracket that crosses \
                    zero agrees with the fit. Brackets of an upward sweep stand a little above \
                    their clearance, those of a downward sweep below.";
    let correlation = "Correlation of the joint estimates. Strong correlation means that the data \
                       tell a combination of the two better than either.";
    let others = "How the quantities that are fitted beside them hang together among themselves is \
                  in correlation.csv.";
    let shown = content.correlation.as_ref();
    let beside = shown.is_some_and(|c| c.parameters.iter().any(|p| parameter(p).is_none()));
    let correlation = match beside {
        true => format!("{} {}", numbers.say(correlation), numbers.say(others)),
        false => numbers.say(correlation),
    };
    vec![
        ("boundary_fit".into(), numbers.say(boundary)),
        ("correlation".into(), correlation),
    ]
}

fn with_note(text: &str, note: &str) -> String {
    if note.is_empty() {
        text.to_owned()
    } else {
        format!("{text} {}", sentence(note))
    }
}

/// A finding as a sentence, with the method that it begins with in words.
pub fn spoken(finding: &str, numbers: NumberLook) -> String {
    const KEYS: [&str; 5] = [
        "boundaries",
        "trajectories",
        "impacts",
        "resonance",
        "free_decay",
    ];
    match finding.split_once(": ") {
        Some((key, rest)) if KEYS.contains(&key) => {
            let method = numbers.say(&method_name(key));
            sentence(&format!("{method}: {rest}"))
        }
        Some((name, rest)) => format!("{name}: {}", sentence(rest)),
        None => sentence(finding),
    }
}

/// A remark as a sentence: a capital at its start, a full stop at its end.
pub fn sentence(remark: &str) -> String {
    let remark = remark.trim();
    let mut chars = remark.chars();
    // A symbol or a record's name keeps its small letter.
    let word = remark.split_whitespace().next().unwrap_or("");
    let plain = word.chars().count() > 1 && word.chars().all(|c| c.is_ascii_lowercase());
    let start = match chars.next() {
        Some(first) if plain => first.to_uppercase().chain(chars).collect(),
        _ => remark.to_owned(),
    };
    if start.ends_with(['.', '!', '?']) || start.is_empty() {
        start
    } else {
        format!("{start}.")
    }
}

fn impacts(content: &ReportContent, numbers: NumberLook) -> Vec<Captioned> {
    let text = "Speeds at impact: speed of parting over speed of closing (left) and their ratio, \
                the restitution, over the closing speed (right).";
    let text = numbers.say(text);
    let each = content.impacts.iter().enumerate();
    each.map(|(i, s)| {
        let text = match s.name.as_str() {
            "" => text.clone(),
            name => format!("{name}. {text}"),
        };
        (numbered("impacts", i), with_note(&text, &s.note))
    })
    .collect()
}

fn resonance(content: &ReportContent, numbers: NumberLook) -> Vec<Captioned> {
    let text = "Resonance curve of the motion without impacts, measured and fitted.";
    let text = numbers.say(text);
    let each = content.resonance.iter().enumerate();
    each.map(|(i, c)| (numbered("resonance", i), with_note(&text, &c.note)))
        .collect()
}

fn free_decays(content: &ReportContent, numbers: NumberLook) -> Vec<Captioned> {
    let each = content.free_decays.chunks(decays::PER_FIGURE).enumerate();
    each.map(|(i, few)| {
        let notes = few.iter().filter(|d| !d.note.is_empty());
        let notes: Vec<String> = notes.map(|d| format!("{}: {}", d.record, d.note)).collect();
        let text = "Free decays (black) and their fits (vermilion), with natural frequency and \
                    damping ratio ± standard error.";
        (
            numbered("free_decays", i),
            with_note(&numbers.say(text), &notes.join(" ")),
        )
    })
    .collect()
}

fn profiles(numbers: NumberLook) -> Captioned {
    let text = "Profile likelihoods: the rise of $χ$² when one parameter is held and the others \
                are fitted again. Tinted: 95 % intervals; dashed: the rise of 3.84 that bounds them.";
    ("profiles".into(), numbers.say(text))
}

fn residuals(content: &ReportContent, numbers: NumberLook) -> Vec<Captioned> {
    let each = content.residuals.iter().enumerate();
    each.map(|(i, set)| {
        let text = "{method}, residual diagnostics ({count} residuals over their standard errors): \
                    histogram with the normal curve, autocorrelation with the 95 % band of white \
                    noise, over frequency and over gap.";
        let method = numbers.say(&method_name(&set.method));
        let count = set.points.len().to_string();
        let text = numbers.say_with(text, &[("method", &method), ("count", &count)]);
        (numbered("residuals", i), with_note(&text, &set.note))
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::{NumberLook, sentence, spoken};

    #[test]
    fn valid_remarks_become_sentences() {
        assert_eq!(sentence("the responses follow"), "The responses follow.");
        assert_eq!(sentence("x is clipped."), "x is clipped.");
        assert_eq!(sentence("r0012 was left out"), "r0012 was left out.");
        assert_eq!(sentence(""), "");
        assert_eq!(
            spoken("free_decay: the fit is poor", NumberLook::default()),
            "Free decay: the fit is poor."
        );
        let odd = spoken("massa4: it is odd", NumberLook::default());
        assert_eq!(odd, "massa4: It is odd.");
    }
}
