//! Tests of the report in other languages: every word of it is the reader's.

use std::path::Path;

use super::contents::{kind, kinds};
use crate::{
    DataTable, NominalValue, Phrase, Report, ReportContent, ReportOptions, Subject, catalog,
    document,
};
use impact_fit::parameters::Coordinate;
use impact_fit::parameters::effect::Effect;
use impact_fit::{Finding, Method, Reason};
use impact_identification::identify::Identification;
use impact_identification::identify::uncertainty::budget::{
    Budget, Combined, Contribution, Evaluation, Row, UncertaintySource,
};
use impact_identification::replay::{BracketRow, Correlation, Unusable, UnusableReason};
use impact_records::language::Language;
use impact_records::motion::{Motion, Undetermined};
use impact_records::record::calibrate::{ChannelKey, ChannelSetup};
use impact_records::record::{Problem, Role, Sweep};

fn german() -> catalog::Catalog {
    catalog::Catalog::of(Language::of_code("de").expect("German"))
}

/// A catalog that prints each phrase and each message as its number in brackets, with its values.
fn marks_for_phrases() -> catalog::Catalog {
    let mut text = String::from("[words]\n");
    for (i, phrase) in catalog::Catalog::phrases().into_iter().enumerate() {
        let values: String = impact_records::language::names(phrase)
            .map(|n| format!("{{{n}}}"))
            .collect();
        let key = toml::Value::from(phrase);
        text.push_str(&format!("{key} = \"⟦{i}⟧{values}\"\n"));
    }
    text.push_str("\n[findings]\n");
    let all = impact_fit::messages::kinds().into_iter();
    let all = all.chain(impact_identification::compare::kinds());
    for (i, message) in all.enumerate() {
        let names: String = message
            .values()
            .iter()
            .map(|(name, _)| format!("{{{name}}}"))
            .collect();
        text.push_str(&format!("{} = \"⟦{}⟧{names}\"\n", message.key(), 1000 + i));
    }
    catalog::Catalog::read(&text).expect("a catalog")
}

/// A campaign to which all happened that the others were spared.
#[expect(clippy::too_many_lines, reason = "one value for each field")]
fn unlucky() -> ReportContent {
    let mut content = kind("small").clone();
    let campaign = &mut content.campaign;
    campaign.files = 1;
    campaign.subject = Subject::OneMass;
    let channels = Role::ALL.iter().map(|&role| ChannelSetup {
        high_pass_hz: Some(0.5),
        ..ChannelSetup::plain(role, ChannelKey::Name("channel".into()))
    });
    campaign.channels = channels.collect();
    let names = [
        Phrase::StaticDeflectionSymbol,
        Phrase::UncertaintyOfTheGains,
        Phrase::Restitution,
    ];
    campaign.nominal = names
        .map(|name| NominalValue {
            name,
            value: 0.1,
            unit: "",
        })
        .into();
    let compared = &mut content.compared;
    let fitted = [
        Coordinate::Restitution,
        Coordinate::Gain(0),
        Coordinate::Corner(1),
        Coordinate::DriveAsymmetry,
        Coordinate::StiffnessAsymmetry,
        Coordinate::Delay(0),
        Coordinate::ScrewZero,
        Coordinate::Gap(0),
    ];
    compared.correlation = Some(Correlation {
        parameters: fitted.into(),
        matrix: vec![vec![0.5; 8]; 8],
    });
    for (record, motion) in compared
        .records
        .iter_mut()
        .zip([Motion::Beat, Motion::Sticking])
    {
        record.motion = motion;
        record.sweep = Sweep::Unknown;
        record.used_by = vec![
            Method::Boundaries,
            Method::Resonance,
            Method::Impacts,
            Method::Flights,
        ];
    }
    compared.records[2].used_by.clear();
    compared.records[2].excluded = Some(Problem::SingleSample);
    for (bracket, off) in compared.brackets.iter_mut().zip([-1.0, 1.0]) {
        bracket.left_out = None;
        let middle = 0.5 * (bracket.frequency_low_hz + bracket.frequency_high_hz);
        bracket.simulated_hz = Some(middle + off * bracket.frequency_low_hz);
    }
    compared.brackets.push(BracketRow {
        left_out: Some(Reason::FarFromBoundary),
        ..compared.brackets[0].clone()
    });
    compared.comparisons[0].motion = Motion::periodic(1, 1);
    compared.comparisons[0].simulated_motion = Some(Motion::Beat);
    compared.comparisons[1].motion = Motion::Chaotic;
    compared.resonance[0].points[0].used = false;
    if let Some(method) = content.identification.methods.get_mut(&Method::Resonance) {
        method.fits = Some(false);
    }
    compared.free_decays = kind("decays").compared.free_decays.clone();
    compared.unusable = vec![Unusable {
        channel: None,
        records: vec!["r1".into(), "r2".into()],
        reason: UnusableReason::Undetermined(Undetermined::NoDrive),
        differ: true,
    }];
    content.identification.left_out.clear();
    content.tables = vec![DataTable {
        caption: Phrase::TablePublished,
        heads: vec![Phrase::PublishedSpeed.into()],
        rows: vec![vec!["1".into()]],
    }];
    content
}

/// A campaign on a rig with effects beyond the model, with every kind of source in its budget.
fn real_rig() -> ReportContent {
    let mut content = kind("small").clone();
    let id = &mut content.identification;
    let effects = [
        Effect::SecondHarmonicCos,
        Effect::ForceSlope,
        Effect::Hardening,
        Effect::Friction,
        Effect::FrequencyDrift,
        Effect::ContactDuration,
        Effect::Drag,
        Effect::SpringAsymmetry,
        Effect::HystereticDamping,
        Effect::PickupX,
    ];
    let findings = effects.map(|effect| Finding::BeyondModel {
        effect,
        strength: 0.01,
        standard_error: 1e-3,
        z_score: 10.0,
        speed_m_s: 0.3,
    });
    id.verdict.findings.extend(findings);
    let doubted = Finding::WholeGapsStated {
        ratio: 0.5,
        records: 8,
    };
    id.verdict.findings.push(doubted);
    content.compared.overview.clearances_m.clear();
    let stated = |coordinate, clearance_m| UncertaintySource::Stated {
        coordinate,
        clearance_m,
    };
    let method = Method::Trajectories;
    let sources = [
        (UncertaintySource::Noise { method }, 1e-3),
        (UncertaintySource::BetweenGroups { groups: 9 }, 1e-3),
        (stated(Coordinate::Gap(0), Some(1e-3)), 1e-3),
        (UncertaintySource::FirstOrder, 1e-3),
        (UncertaintySource::SharedGains, 1e-3),
        (UncertaintySource::RestitutionOverSpeed, 1e-3),
        (UncertaintySource::BetweenMethods, 1e-3),
        (UncertaintySource::Clock, 1e-3),
        (UncertaintySource::InstrumentOff, 1e-3),
        (stated(Coordinate::Effect(Effect::PickupX), None), 1e-3),
        (stated(Coordinate::Effect(Effect::PickupY), None), 1e-3),
        (stated(Coordinate::ScrewZero, None), 1e-9),
    ];
    let rows = sources.map(|(source, uncertainty)| Row {
        source,
        evaluation: Evaluation::A,
        standard_uncertainty: Some(1e-3),
        degrees_of_freedom: None,
        contributions: Coordinate::PHYSICAL
            .map(|parameter| Contribution {
                parameter,
                sensitivity: None,
                uncertainty,
            })
            .into(),
    });
    id.uncertainty.budget = Budget {
        rows: rows.into(),
        combined: Coordinate::PHYSICAL
            .map(|parameter| Combined {
                parameter,
                standard_uncertainty: 2.3e-3,
                degrees_of_freedom: Some(30.0),
                coverage_factor: 2.04,
                expanded_uncertainty: 4.7e-3,
            })
            .into(),
    };
    content
}

/// All kinds of report with a mark for each phrase.
fn marked() -> Vec<Report> {
    let options = ReportOptions {
        catalog: Some(marks_for_phrases()),
        ..ReportOptions::default()
    };
    let each = kinds().iter().map(|(_, content)| content);
    let (unlucky, real) = (unlucky(), real_rig());
    let single = each.chain([&unlucky, &real]);
    let single = single.map(|content| Report::new(content, &options));
    let compared = Report::of_campaigns(&super::contents::compared(), &options);
    single.chain([compared]).collect()
}

/// The page of a report while records are arriving.
fn live_page() -> String {
    let live = crate::options::LivePage {
        state: String::new(),
        version: String::new(),
        records: 3,
    };
    let options = ReportOptions {
        catalog: Some(marks_for_phrases()),
        live: Some(live),
        ..ReportOptions::default()
    };
    Report::new(&unlucky(), &options).html().expect("a page")
}

/// All source files of a folder.
fn source(folder: &Path) -> String {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut text = String::new();
    for path in entries.map(|e| e.expect("an entry").path()) {
        if path.is_dir() {
            text.push_str(&source(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            text.push_str(&std::fs::read_to_string(&path).expect("a source file"));
        }
    }
    text
}

/// Every phrase is printed in one of the examples, or the source uses it.
#[test]
fn no_phrase_of_the_words_is_idle() {
    let mut printed = String::new();
    for report in marked() {
        let document = serde_json::to_string(&report.document).expect("JSON");
        printed.push_str(&document);
        for figure in &report.figures {
            printed.push_str(&figure.svg());
            printed.extend(figure.spots.iter().map(|s| s.text.as_str()));
        }
    }
    printed.push_str(&live_page());
    let source = source(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src")));
    let names: Vec<String> = catalog::Catalog::phrases()
        .iter()
        .map(|p| (*p).to_owned())
        .collect();
    let (mut unprinted, mut idle) = (Vec::new(), Vec::new());
    for phrase in Phrase::ALL {
        let number = names.iter().position(|n| n == phrase.english());
        if !printed.contains(&format!("⟦{}⟧", number.expect("a phrase"))) {
            unprinted.push(phrase);
            let name = format!("Phrase::{phrase:?}");
            let mut uses = source.split(&name).skip(1);
            if !uses.any(|rest| !rest.starts_with(char::is_alphanumeric)) {
                idle.push(phrase);
            }
        }
    }
    assert!(idle.is_empty(), "nothing prints {idle:#?}");
    assert!(
        unprinted.len() < 15,
        "{} are not printed: {unprinted:#?}",
        unprinted.len()
    );
}

/// Texts of a drawing.
fn texts_of(svg: &str) -> impl Iterator<Item = &str> {
    let texts = svg.split("<text").skip(1);
    texts.filter_map(|t| Some(t.split_once('>')?.1.split("</text>").next()?.trim()))
}

/// Whether a text says something in letters: more than symbols, units and names of records.
fn speaks(text: &str) -> bool {
    const DATA: [&str; 5] = ["kHz", "spring", "bumper", "xst", "mass"];
    let mut words = text.split(|c: char| c.is_whitespace() || "(),:;=±⟦⟧".contains(c));
    words.any(|w| {
        let letters = w.chars().all(|c| c.is_ascii_alphabetic());
        letters && w.len() > 2 && !DATA.contains(&w)
    })
}

/// With a mark for each phrase no English is left in figures, headings, heads and captions.
#[test]
fn all_words_of_figures_and_headings_are_the_reader_s() {
    let mut english = std::collections::BTreeSet::new();
    for report in marked() {
        for figure in &report.figures {
            let svg = figure.svg();
            let texts = texts_of(&svg).filter(|t| speaks(t));
            english.extend(texts.map(|t| format!("{}: {t}", figure.name)));
        }
        for section in &report.document.sections {
            let mut heads = vec![section.title.plain()];
            for block in &section.blocks {
                if let document::model::Block::Table(t) = block {
                    heads.extend(t.heads.iter().map(document::model::Rich::plain));
                    heads.push(t.caption.plain());
                }
            }
            english.extend(heads.into_iter().filter(|h| speaks(h)));
        }
    }
    assert!(english.is_empty(), "{english:#?}");
}

#[test]
fn a_german_report_is_german() {
    let options = ReportOptions {
        catalog: Some(german()),
        ..ReportOptions::default()
    };
    for (name, content) in kinds().iter().filter(|k| k.0 != "whole") {
        let report = Report::new(content, &options);
        for figure in &report.figures {
            assert!(figure.overfull.is_empty(), "{name}: {:?}", figure.overfull);
        }
        if let Some(map) = report.figures.iter().find(|f| f.name == "map") {
            let svg = map.svg();
            let texts: Vec<&str> = texts_of(&svg).collect();
            let has = |word: &str| {
                texts
                    .iter()
                    .any(|t| t.replace('\u{a0}', " ").contains(word))
            };
            assert!(has("Spiel") && has("Erregerfrequenz") && has("gemessen"));
            assert!(!has("clearance") && !has("drive frequency") && !has("measured"));
        }
        let page = report.html().expect("a page");
        assert!(page.contains("<html lang=\"de\">") && page.contains("Was gemessen wurde"));
        assert!(!page.contains("<h2>What was measured"));
    }
}

/// An identification as it would be read if each of its sentences were another.
fn with_other_sentences(identification: &Identification) -> Identification {
    fn replace(value: &mut serde_json::Value) {
        match value {
            serde_json::Value::Object(fields) => {
                for (key, field) in fields {
                    match field {
                        serde_json::Value::String(text) if key == "text" || key == "summary" => {
                            *text = "?".to_owned();
                        }
                        _ => replace(field),
                    }
                }
            }
            serde_json::Value::Array(items) => items.iter_mut().for_each(replace),
            _ => {}
        }
    }
    let mut json = serde_json::to_value(identification).expect("JSON");
    let before = json.clone();
    replace(&mut json);
    assert_ne!(json, before, "there are sentences");
    serde_json::from_value(json).expect("an identification")
}

/// Nothing in a report is taken from a sentence of identification.json, in any language.
#[test]
fn a_report_is_made_from_kinds_and_numbers_alone() {
    let german = ReportOptions {
        catalog: Some(german()),
        decimal_comma: true,
        ..ReportOptions::default()
    };
    for (name, content) in kinds().iter().filter(|k| k.0 != "whole") {
        let other = ReportContent {
            identification: with_other_sentences(&content.identification),
            ..content.clone()
        };
        for options in [&ReportOptions::default(), &german] {
            let (one, two) = (Report::new(content, options), Report::new(&other, options));
            let json = |r: &Report| serde_json::to_string(&r.document).expect("JSON");
            assert_eq!(json(&one), json(&two), "{name}");
            for (a, b) in one.figures.iter().zip(&two.figures) {
                assert!(
                    a.drawing == b.drawing && a.csv == b.csv,
                    "{name}: {}",
                    a.name
                );
            }
        }
    }
}

#[test]
fn a_german_report_has_german_findings_and_no_english_ones() {
    let mut content = kind("small").clone();
    let id = &mut content.identification;
    let findings: Vec<Finding> = <Finding as strum::IntoEnumIterator>::iter().collect();
    id.verdict.findings.clone_from(&findings);
    let german = ReportOptions {
        catalog: Some(german()),
        ..ReportOptions::default()
    };
    let text = |options: &ReportOptions| {
        let document = Report::new(&content, options).document;
        serde_json::to_string(&document.front).expect("JSON")
    };
    let (english, german) = (text(&ReportOptions::default()), text(&german));
    for finding in &findings {
        let words = |language| {
            let template = impact_records::message::Message::template(finding, language);
            let pieces = template.split(['{', '}', '$']).step_by(2);
            let longest = pieces.max_by_key(|p| p.len()).unwrap_or_default();
            // a sentence begins with a capital
            let rest: String = longest.chars().skip(1).collect();
            rest.replace('"', "\\\"")
        };
        let (en, de) = (
            words(Language::default()),
            words(Language::of_code("de").expect("German")),
        );
        // only templates with words of their own
        if en.len() > 12 {
            assert!(english.contains(&en) && german.contains(&de), "{en} {de}");
            assert!(!german.contains(&en), "{en}");
        }
    }
}
