//! Tests of the report in other languages: every word of it is the reader's.

use std::path::Path;

use super::contents::{kind, kinds};
use crate::compare::{BracketRow, Correlation};
use crate::identify::fit::parameters::Coordinate;
use crate::identify::{Method, Reason};
use crate::motion::Motion;
use crate::record::calibrate::{ChannelKey, ChannelSetup};
use crate::record::{Role, Sweep};
use crate::report::{NominalValue, Report, ReportContent, ReportOptions, Subject, document, words};

/// A table that prints each phrase as its number in brackets, with the values that it carries.
fn marks_for_phrases() -> words::Words {
    let mut text = String::from("[words]\n");
    for (i, phrase) in words::Words::phrases().enumerate() {
        let values: String = words::places(phrase)
            .iter()
            .map(|n| format!("{{{n}}}"))
            .collect();
        let key = toml::Value::from(phrase);
        text.push_str(&format!("{key} = \"⟦{i}⟧{values}\"\n"));
    }
    words::Words::read(&text).expect("a table of words")
}

/// A campaign to which all happened that the others were spared.
fn unlucky() -> ReportContent {
    let mut content = kind("small").clone();
    let campaign = &mut content.campaign;
    campaign.files = 1;
    campaign.subject = Subject::OneMass;
    let channels = Role::ALL.map(|role| ChannelSetup {
        high_pass_hz: Some(0.5),
        ..ChannelSetup::plain(role, ChannelKey::Name("channel".into()))
    });
    campaign.channels = channels.into();
    let names = [
        "static deflection $x_st$",
        "uncertainty of the gains",
        "restitution $R$",
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
    ];
    compared.correlation = Some(Correlation {
        parameters: fitted.into(),
        matrix: vec![vec![0.5; 5]; 5],
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
    compared.records[2].excluded = Some("it is short".into());
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
    compared.unusable.clear();
    content.identification.left_out.clear();
    content
}

/// All kinds of report with a mark for each phrase.
fn marked() -> Vec<Report> {
    let options = ReportOptions {
        words: Some(marks_for_phrases()),
        ..ReportOptions::default()
    };
    let each = kinds().iter().map(|(_, content)| content);
    each.chain([&unlucky()])
        .map(|content| Report::new(content, &options))
        .collect()
}

/// The source of the report's rooms with every text on one line.
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
    let mut pieces = text.split("\\\n");
    let first = pieces.next().unwrap_or_default().to_owned();
    pieces.fold(first, |all, piece| all + piece.trim_start())
}

/// A phrase and the source as they can be compared: a remark gets its capital and full stop, and a
/// name loses its underscores, only when it is said; what stands in braces goes by other names.
fn plainly(text: &str) -> String {
    let text = text.replace('\u{2009}', "\\u{2009}");
    let mut pieces = text.trim_end_matches('.').split('{');
    let mut plain = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        match piece.split_once('}') {
            Some((name, rest)) if !name.contains(char::is_whitespace) => {
                plain.push_str("{}");
                plain.push_str(rest);
            }
            _ => plain.push_str(piece),
        }
    }
    plain.replace('_', " ").to_lowercase()
}

/// Every phrase is said by one of the examples, or at least stands in the source.
#[test]
fn valid_no_phrase_of_the_words_is_idle() {
    let mut said = String::new();
    for report in marked() {
        let document = serde_json::to_string(&report.document).expect("JSON");
        said.push_str(&document);
        for figure in &report.figures {
            said.push_str(&figure.svg);
            said.extend(figure.spots.iter().map(|s| s.text.as_str()));
        }
    }
    let source = plainly(&source(Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/src"
    ))));
    let (mut unsaid, mut idle) = (Vec::new(), Vec::new());
    for (i, phrase) in words::Words::phrases().enumerate() {
        if !said.contains(&format!("⟦{i}⟧")) {
            unsaid.push(phrase);
            if !source.contains(&plainly(phrase)) {
                idle.push(phrase);
            }
        }
    }
    assert!(idle.is_empty(), "nothing says {idle:#?}");
    assert!(
        unsaid.len() < 15,
        "{} are not said: {unsaid:#?}",
        unsaid.len()
    );
}

/// Texts of a drawing.
fn texts_of(svg: &str) -> impl Iterator<Item = &str> {
    let texts = svg.split("<text").skip(1);
    texts.filter_map(|t| Some(t.split_once('>')?.1.split("</text>").next()?.trim()))
}

/// Whether a text says something in letters: more than symbols, units and names of records.
fn speaks(text: &str) -> bool {
    const DATA: [&str; 4] = ["kHz", "spring", "bumper", "xst"];
    let mut words = text.split(|c: char| c.is_whitespace() || "(),:;=±⟦⟧".contains(c));
    words.any(|w| {
        let letters = w.chars().all(|c| c.is_ascii_alphabetic());
        letters && w.len() > 2 && !DATA.contains(&w)
    })
}

/// With a mark for each phrase no English is left in figures, headings, heads and captions.
#[test]
fn valid_all_words_of_figures_and_headings_are_the_reader_s() {
    let mut english = std::collections::BTreeSet::new();
    for report in marked() {
        for figure in &report.figures {
            let texts = texts_of(&figure.svg).filter(|t| speaks(t));
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
fn valid_a_german_report_speaks_german() {
    let options = ReportOptions {
        words: Some(words::Words::german().clone()),
        ..ReportOptions::default()
    };
    for (name, content) in kinds().iter().filter(|k| k.0 != "whole") {
        let report = Report::new(content, &options);
        for figure in &report.figures {
            assert!(figure.overfull.is_empty(), "{name}: {:?}", figure.overfull);
        }
        if let Some(map) = report.figures.iter().find(|f| f.name == "map") {
            let texts: Vec<&str> = texts_of(&map.svg).collect();
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
