//! Captions, and the figures of the methods' section in their order.

use crate::content::ReportContent;
use crate::figures::decays;
use crate::kit::numbered;
use crate::locale::Locale;
use crate::parameters::parameter;
use crate::phrase::Phrase;
use impact_fit::methods::answer::found_by;
use impact_fit::{Method, MethodResult};
use impact_identification::replay::ReplayedRecord;
use impact_records::message::sentence;
use impact_records::motion::Motion;

/// A figure's name and its caption.
type Captioned = (String, String);

/// The figures of the methods; narrow ones that follow each other are side by side.
pub(super) fn method_figures(content: &ReportContent, locale: Locale<'_>) -> Vec<Captioned> {
    let mut figures = vec![(
        "boundary_fit".into(),
        locale.translate(Phrase::CaptionBoundaryFit),
    )];
    // of the four parameters alone it is narrow
    let wide = has_others(content);
    let correlation = correlation(content, locale);
    if !wide {
        figures.push(correlation.clone());
    }
    figures.push(profiles(locale));
    figures.extend(impacts(content, locale));
    figures.extend(resonance(content, locale));
    figures.extend(free_decays(content, locale));
    figures.extend(wide.then_some(correlation));
    figures.extend(residuals(content, locale));
    figures
}

/// The caption of a comparison, with markup.
pub(super) fn comparison(comparison: &ReplayedRecord, locale: Locale<'_>) -> String {
    let letter = comparison.letter.to_string();
    let mut text = locale.translate_with(Phrase::CaptionPoint, &[("letter", &letter)]);
    let label = locale.motion(&comparison.motion);
    let symbol = if comparison.motion.is_periodic() {
        "$z$ = "
    } else {
        ""
    };
    text.push_str(&format!(", {symbol}{label}"));
    if let (Some(eta), Some(rho)) = (comparison.eta, comparison.rho) {
        let (eta, rho) = (locale.fixed(eta, 3), locale.fixed(rho, 3));
        let values = [("eta", eta.as_str()), ("rho", rho.as_str())];
        text.push_str(&locale.translate_with(Phrase::CaptionSetting, &values));
    }
    let record = [("record", comparison.record.as_str())];
    text.push_str(&locale.translate_with(Phrase::CaptionRecord, &record));
    let count = comparison.impacts_s.len();
    if let Some(missed) = comparison.missed_by_contact.filter(|m| *m > 0) {
        let (seen, count) = ((count - missed).to_string(), count.to_string());
        let values = [("seen", seen.as_str()), ("count", count.as_str())];
        let said = locale.translate_with(Phrase::CaptionMissedContacts, &values);
        text.push_str(&format!(" {said}"));
    }
    let simulated = comparison.simulated_motion.as_ref();
    if let Some(other) = simulated.filter(|m| **m != comparison.motion) {
        let label = locale.motion(other);
        let said = locale.translate_with(Phrase::CaptionSimulatedMotion, &[("motion", &label)]);
        text.push_str(&format!(" {said}"));
    }
    if let Some(note) = note(&comparison.motion, simulated) {
        text.push_str(&format!(" {}", locale.translate(note)));
    }
    text
}

/// Why a simulated motion may differ from the measured one.
fn note(measured: &Motion, simulated: Option<&Motion>) -> Option<Phrase> {
    let simulated = simulated?;
    if measured.is_periodic() {
        let note = Phrase::CaptionOtherMotion;
        return (simulated != measured).then_some(note);
    }
    matches!(measured, Motion::Chaotic | Motion::Beat).then_some(Phrase::CaptionAlikeInKind)
}

fn correlation(content: &ReportContent, locale: Locale<'_>) -> Captioned {
    let mut text = locale.translate(Phrase::CaptionCorrelation);
    if has_others(content) {
        text.push(' ');
        text.push_str(&locale.translate(Phrase::CaptionCorrelationOthers));
    }
    ("correlation".into(), text)
}

/// Whether the figure of the correlation shows others than the four parameters.
fn has_others(content: &ReportContent) -> bool {
    let shown = content.compared.correlation.as_ref();
    shown.is_some_and(|c| c.parameters.iter().any(|p| parameter(*p).is_none()))
}

/// A caption with the remarks on its method.
fn with_remarks(text: &str, method: Option<&MethodResult>, locale: Locale<'_>) -> String {
    let remarks = locale.sentences(method.into_iter().flat_map(|m| &m.remarks));
    match remarks.as_str() {
        "" => text.to_owned(),
        remarks => format!("{text} {remarks}"),
    }
}

fn impacts(content: &ReportContent, locale: Locale<'_>) -> Vec<Captioned> {
    let text = Phrase::CaptionImpacts;
    let text = locale.translate(text);
    let id = &content.identification;
    let each = content.compared.impacts.iter().enumerate();
    each.map(|(i, s)| {
        let (text, methods) = match &s.specimen {
            None => (text.clone(), Some(&id.methods)),
            Some(name) => {
                let methods = id.specimens.get(name).map(|s| &s.methods);
                (format!("{name}. {text}"), methods)
            }
        };
        let method = methods.and_then(|m| found_by(m, Method::observes_contact));
        (numbered("impacts", i), with_remarks(&text, method, locale))
    })
    .collect()
}

fn resonance(content: &ReportContent, locale: Locale<'_>) -> Vec<Captioned> {
    let text = Phrase::CaptionResonance;
    let text = locale.translate(text);
    let method = found_by(&content.identification.methods, Method::observes_response);
    let text = with_remarks(&text, method, locale);
    let curves = 0..content.compared.resonance.len();
    curves
        .map(|i| (numbered("resonance", i), text.clone()))
        .collect()
}

fn free_decays(content: &ReportContent, locale: Locale<'_>) -> Vec<Captioned> {
    let each = content
        .compared
        .free_decays
        .chunks(decays::PER_FIGURE)
        .enumerate();
    each.map(|(i, few)| {
        let reasons = few.iter().filter_map(|d| {
            let why = d.left_out.as_ref()?;
            let text = format!("{}: {}", decays::title(d), locale.message(why));
            Some(sentence(&text))
        });
        let reasons = reasons.collect::<Vec<_>>().join(" ");
        let text = Phrase::CaptionDecays;
        let text = match reasons.as_str() {
            "" => locale.translate(text),
            reasons => format!("{} {reasons}", locale.translate(text)),
        };
        (numbered("free_decays", i), text)
    })
    .collect()
}

fn profiles(locale: Locale<'_>) -> Captioned {
    let text = Phrase::CaptionProfiles;
    let rise = locale.fixed(3.84, 2);
    let text = locale.translate_with(text, &[("rise", &rise)]);
    ("profiles".into(), text)
}

fn residuals(content: &ReportContent, locale: Locale<'_>) -> Vec<Captioned> {
    let each = content.compared.residuals.iter().enumerate();
    each.map(|(i, set)| {
        let text = Phrase::CaptionResiduals;
        let method = locale.message(&set.method);
        let count = set.total.to_string();
        let mut text = locale.translate_with(text, &[("method", &method), ("count", &count)]);
        if set.points.len() < set.total {
            let drawn = set.points.len().to_string();
            let thinned = Phrase::CaptionResidualsThinned;
            text.push(' ');
            text.push_str(&locale.translate_with(thinned, &[("drawn", &drawn)]));
        }
        (numbered("residuals", i), text)
    })
    .collect()
}
