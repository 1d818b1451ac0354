//! What stands under the figures; and which figures the methods' section shows, in order.

use super::prose::sentence;
use crate::report::content::{Comparison, ReportContent};
use crate::report::figures::{decays, numbered};
use crate::report::parameters::{method_name, parameter};
use crate::report::speech::Speech;

/// A figure's name and its caption.
type Captioned = (String, String);

/// Groups of figures; those of one group stand side by side where they are narrow.
pub fn method_figures(content: &ReportContent, speech: Speech) -> Vec<Vec<Captioned>> {
    let mut groups = vec![narrow(content, speech)];
    let alone = |captioned: Vec<Captioned>| captioned.into_iter().map(|c| vec![c]);
    groups.extend(alone(impacts(content, speech)));
    groups.extend(alone(resonance(content, speech)));
    groups.extend(alone(free_decays(content, speech)));
    groups.push(vec![profiles(speech)]);
    groups.extend(alone(residuals(content, speech)));
    groups
}

/// What stands under a comparison, with markup.
pub fn comparison(comparison: &Comparison, speech: Speech) -> String {
    let mut text = speech.say_with("Point ({letter})", &[("letter", &comparison.letter)]);
    if comparison.drive_period_s.is_some() {
        let label = speech.say(&comparison.motion.label());
        text.push_str(&format!(", $z$ = {label}"));
    }
    if let (Some(eta), Some(rho)) = (comparison.eta, comparison.rho) {
        let (eta, rho) = (speech.fixed(eta, 3), speech.fixed(rho, 3));
        let values = [("eta", eta.as_str()), ("rho", rho.as_str())];
        text.push_str(&speech.say_with(", at $η$ = {eta}, $ρ$ = {rho}", &values));
    }
    let record = [("record", comparison.record.as_str())];
    text.push_str(&speech.say_with("; record {record}.", &record));
    let simulated = comparison.simulated_motion.as_ref();
    if let Some(other) = simulated.filter(|m| **m != comparison.motion) {
        let label = speech.say(&other.label());
        let said = speech.say_with("The simulated motion is {motion}.", &[("motion", &label)]);
        text.push_str(&format!(" {said}"));
    }
    if !comparison.note.is_empty() {
        text.push_str(&format!(" {}", speech.say(&comparison.note)));
    }
    text
}

fn narrow(content: &ReportContent, speech: Speech) -> Vec<Captioned> {
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
        true => format!("{} {}", speech.say(correlation), speech.say(others)),
        false => speech.say(correlation),
    };
    vec![
        ("boundary_fit".into(), speech.say(boundary)),
        ("correlation".into(), correlation),
    ]
}

/// A caption with what was found, in the reader's words.
fn with_note(text: &str, note: &str, speech: Speech) -> String {
    if note.is_empty() {
        text.to_owned()
    } else {
        format!("{text} {}", sentence(&speech.tell(note)))
    }
}

fn impacts(content: &ReportContent, speech: Speech) -> Vec<Captioned> {
    let text = "Speeds at impact: speed of parting over speed of closing (left) and their ratio, \
                the restitution, over the closing speed (right).";
    let text = speech.say(text);
    let each = content.impacts.iter().enumerate();
    each.map(|(i, s)| {
        let text = match s.name.as_str() {
            "" => text.clone(),
            name => format!("{name}. {text}"),
        };
        (numbered("impacts", i), with_note(&text, &s.note, speech))
    })
    .collect()
}

fn resonance(content: &ReportContent, speech: Speech) -> Vec<Captioned> {
    let text = "Resonance curve of the motion without impacts, measured and fitted.";
    let text = speech.say(text);
    let each = content.resonance.iter().enumerate();
    each.map(|(i, c)| (numbered("resonance", i), with_note(&text, &c.note, speech)))
        .collect()
}

fn free_decays(content: &ReportContent, speech: Speech) -> Vec<Captioned> {
    let each = content.free_decays.chunks(decays::PER_FIGURE).enumerate();
    each.map(|(i, few)| {
        let notes = few.iter().filter(|d| !d.note.is_empty());
        let notes: Vec<String> = notes.map(|d| format!("{}: {}", d.record, d.note)).collect();
        let text = "Free decays (black) and their fits (vermilion), with natural frequency and \
                    damping ratio ± standard error.";
        (
            numbered("free_decays", i),
            with_note(&speech.say(text), &notes.join(" "), speech),
        )
    })
    .collect()
}

fn profiles(speech: Speech) -> Captioned {
    let text = "Profile likelihoods: the rise of $χ$² when one parameter is held and the others \
                are fitted again. Tinted: 95 % intervals; dashed: the rise of 3.84 that bounds them.";
    ("profiles".into(), speech.say(text))
}

fn residuals(content: &ReportContent, speech: Speech) -> Vec<Captioned> {
    let each = content.residuals.iter().enumerate();
    each.map(|(i, set)| {
        let text = "{method}, residual diagnostics ({count} residuals over their standard errors): \
                    histogram with the normal curve, autocorrelation with the 95 % band of white \
                    noise, over frequency and over gap.";
        let method = speech.say(&method_name(&set.method));
        let count = set.count().to_string();
        let text = speech.say_with(text, &[("method", &method), ("count", &count)]);
        (
            numbered("residuals", i),
            with_note(&text, &set.note, speech),
        )
    })
    .collect()
}
