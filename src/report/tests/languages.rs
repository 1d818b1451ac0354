//! Tests of the report in other languages: every word of it is the reader's.

use std::path::Path;

use super::{kind, kinds};
use crate::report::content::{self, ReportContent};
use crate::report::{RenderOptions, Report, document, words};

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
    use crate::motion::Motion;
    use crate::record::{Role, Sweep};
    let mut content = kind("small").clone();
    let summary = &mut content.summary;
    summary.files_total = 1;
    summary.rig = "one mass against a stop".into();
    summary.notes.push("a remark".into());
    let channel = summary.channels[0].clone();
    let roles = [
        Role::VelocityY,
        Role::DisplacementY,
        Role::AccelerationX,
        Role::AccelerationY,
        Role::FrameX,
        Role::FrameY,
    ];
    summary
        .channels
        .extend(roles.map(|role| content::ChannelRow {
            role,
            high_pass_hz: Some(0.5),
            ..channel.clone()
        }));
    for name in ["static deflection $x_st$", "uncertainty of the gains"] {
        let mut value = summary.nominal[0].clone();
        value.name = name.into();
        summary.nominal.push(value);
    }
    let fitted = ["restitution", "gain_velocity_x", "corner_velocity_y"];
    let others = ["drive_asymmetry", "stiffness_asymmetry"];
    content.correlation = Some(content::Correlation {
        parameters: fitted.iter().chain(&others).map(|p| (*p).into()).collect(),
        matrix: vec![vec![0.5; 5]; 5],
    });
    for (record, motion) in content
        .records
        .iter_mut()
        .zip([Motion::Beat, Motion::Sticking])
    {
        record.motion = motion;
        record.sweep = Sweep::Unknown;
        record.used_by = ["boundaries", "resonance", "impacts", "flights"]
            .map(String::from)
            .into();
    }
    content.records[2].used_by.clear();
    content.records[2].left_out = Some("it is short".into());
    for (bracket, off) in content.brackets.iter_mut().zip([-1.0, 1.0]) {
        bracket.left_out = None;
        let middle = 0.5 * (bracket.frequency_low_hz + bracket.frequency_high_hz);
        bracket.simulated_hz = Some(middle + off * bracket.frequency_low_hz);
    }
    content.brackets.push(content::BracketRow {
        left_out: Some("it jumped".into()),
        ..content.brackets[0].clone()
    });
    content.comparisons[0].simulated_motion = Some(Motion::Beat);
    content.resonance[0].fits = Some(false);
    content.free_decays = kind("decays").free_decays.clone();
    content.free_decays[0].natural_frequency_hz = None;
    content.free_decays[0].damping_ratio = None;
    if let Some(map) = &mut content.region_map {
        map.second.clear();
    }
    content.remarks.push("a remark".into());
    content.left_out.clear();
    content
}

/// All kinds of report with a mark for each phrase.
fn marked() -> Vec<Report> {
    let options = RenderOptions {
        words: Some(marks_for_phrases()),
        ..RenderOptions::default()
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
    let options = RenderOptions {
        words: Some(words::Words::german().clone()),
        ..RenderOptions::default()
    };
    for (name, content) in kinds().iter().filter(|k| k.0 != "large") {
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
