//! The sections after the first page, each only where there is something to show.

use super::drawn::Drawn;
use super::model::{Block, Rich, Section};
use super::prose::{prose, sentence};
use super::settings::settings;
use super::tables;
use super::{captions, conventions};
use crate::identify::Remark;
use crate::report::content::ReportContent;
use crate::report::figures::comparison;
use crate::report::figures::plane::Plane;
use crate::report::parameters::method_name;
use crate::report::speech::Speech;

/// All sections in their order.
pub fn sections(content: &ReportContent, drawn: &Drawn<'_>) -> Vec<Section> {
    let mut sections: Vec<Section> = [
        regions(content, drawn),
        comparisons(content, drawn),
        methods(content, drawn),
        specimens(content, drawn),
        left_out(content, drawn),
        records(content, drawn),
        conventions(content, drawn),
        provenance(content, drawn),
    ]
    .into_iter()
    .flatten()
    .collect();
    letter_appendices(&mut sections, drawn.speech);
    for section in &mut sections {
        localise(&mut section.blocks, drawn.speech);
    }
    sections
}

/// Paragraphs and captions with the decimal sign of the reader's choice.
fn localise(blocks: &mut [Block], speech: Speech) {
    for block in blocks {
        match block {
            Block::Paragraph { text } => *text = std::mem::take(text).localised(speech),
            Block::Figures { figures } => {
                for figure in figures {
                    figure.caption = std::mem::take(&mut figure.caption).localised(speech);
                }
            }
            _ => {}
        }
    }
}

/// Letters before the titles of the appendices, in the order in which they come.
fn letter_appendices(sections: &mut [Section], speech: Speech) {
    let appendices = sections.iter_mut().filter(|s| s.appendix);
    for (section, letter) in appendices.zip('A'..='Z') {
        let (letter, title) = (letter.to_string(), section.title.plain());
        let values = [("letter", letter.as_str()), ("title", title.as_str())];
        section.title = Rich::from(speech.say_with("Appendix {letter}. {title}", &values));
    }
}

fn appendix(title: String, blocks: Vec<Block>) -> Option<Section> {
    section(title, false, blocks).map(|s| Section {
        appendix: true,
        ..s
    })
}

fn section(title: String, new_page: bool, blocks: Vec<Block>) -> Option<Section> {
    (!blocks.is_empty()).then(|| Section {
        title: Rich::from(title),
        level: 1,
        new_page,
        appendix: false,
        blocks,
    })
}

fn paragraph(text: impl AsRef<str>) -> Block {
    Block::Paragraph {
        text: Rich::from(text),
    }
}

/// A paragraph of words that carry no markup.
fn remark(text: &str) -> Block {
    Block::Paragraph { text: prose(text) }
}

fn regions(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    blocks.extend(drawn.figures_block(&[("map", &map_caption(content, drawn.speech))]));
    blocks.extend(tables::brackets(content, drawn.speech).map(Block::Table));
    section(drawn.speech.say("Regions of motion"), true, blocks)
}

fn map_caption(content: &ReportContent, speech: Speech) -> String {
    let mut text = speech.say(
        "Measured motions in the plane of frequency and clearance. Each mark is a record; marks of \
         an upward sweep stand a little above their clearance, those of a downward sweep a little \
         below.",
    );
    let mut add = |sentence: &str| text.push_str(&format!(" {sentence}"));
    let strips = Plane::of(content).map(|p| p.view(content).strips);
    if strips.is_some_and(|s| !s.is_empty()) {
        add(&speech.say("Clearances far above all impacts stand in a strip of their own."));
    }
    if content.compared.region_map.is_some() {
        add(&speech.say(
            "Tinted regions: simulated with the fitted parameters, labelled by $z$ = $p$/$n$; \
             hatched, with two labels, where two motions are possible (hysteresis).",
        ));
        add(&speech.say(
            "Every cell simulated from rest and from a lively start, and the stable orbits z = 1/n \
             in closed form; where they differ, both motions exist.",
        ));
    }
    if content.compared.curves.iter().any(|c| !c.band95.is_empty()) {
        add(&speech.say("Grey bands: 95 % bands of the simulated boundaries."));
    }
    if !content.compared.comparisons.is_empty() {
        add(&speech.say("Letters: the points compared in the next figures."));
    }
    text
}

fn comparisons(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    for comparison in &content.compared.comparisons {
        let name = comparison::name(comparison);
        let caption = captions::comparison(comparison, drawn.speech);
        blocks.extend(drawn.figures_block(&[(&name, &caption)]));
    }
    if !blocks.is_empty() {
        let keys = "Each point as simulated with the fitted parameters (left) and as measured \
                    (middle), on the same scales, with the residual (measured less simulated) and \
                    the phase portraits (simulated: broad and pale; measured: thin and dark). Mass \
                    $x$ is blue, mass $y$ vermilion; dotted lines are impacts.";
        blocks.insert(0, paragraph(drawn.speech.say(keys)));
    }
    section(
        drawn.speech.say("Simulated and measured motions"),
        false,
        blocks,
    )
}

/// What was found of each specimen, by method.
fn specimens(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let told = |remark: &Remark| sentence(&drawn.speech.tell(&remark.to_string()));
    let table = tables::specimen_methods(content, drawn.speech).map(Block::Table);
    let mut blocks: Vec<Block> = table.into_iter().collect();
    for (specimen, result) in &content.identification.specimens {
        for (method, result) in &result.methods {
            let name = drawn.speech.say(&method_name(method.name()).to_lowercase());
            blocks.extend(
                result
                    .remarks
                    .iter()
                    .map(|r| remark(&format!("{specimen}, {name}: {}", told(r)))),
            );
        }
    }
    section(drawn.speech.say("Specimen by specimen"), false, blocks)
}

fn methods(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let told = |remark: &Remark| sentence(&drawn.speech.tell(&remark.to_string()));
    let mut blocks = Vec::new();
    if content.identification.specimens.is_empty() {
        blocks.extend(tables::methods(content, drawn.speech).map(Block::Table));
    }
    blocks.extend(tables::agreement(content, drawn.speech).map(Block::Table));
    let remarks = content
        .identification
        .methods
        .iter()
        .flat_map(|(name, method)| {
            let name = drawn.speech.say(&method_name(name.name()));
            method
                .remarks
                .iter()
                .map(move |r| remark(&format!("{name}: {}", told(r))))
        });
    blocks.extend(remarks);
    blocks.extend(tables::further(content, drawn.speech).map(Block::Table));
    for group in captions::method_figures(content, drawn.speech) {
        let named: Vec<(&str, &str)> = group
            .iter()
            .map(|(n, c)| (n.as_str(), c.as_str()))
            .collect();
        blocks.extend(drawn.figures_block(&named));
    }
    section(drawn.speech.say("Method by method"), false, blocks)
}

fn left_out(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let table = tables::left_out(content, drawn.speech).map(Block::Table);
    let title = drawn.speech.say("What was left out, and why");
    section(title, false, table.into_iter().collect())
}

fn records(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let table = tables::records(content, drawn.speech).map(Block::Table);
    appendix(drawn.speech.say("All records"), table.into_iter().collect())
}

fn conventions(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let records = &content.compared.records;
    let driven = records.is_empty() || records.iter().any(|r| r.frequency_hz.is_some());
    let intervals = "Intervals are at 95 % confidence; a number after ± is half of that interval. \
                     All quantities are in SI units.";
    let blocks = vec![
        Block::Definitions {
            entries: conventions::entries(driven, drawn.speech),
        },
        paragraph(drawn.speech.say(intervals)),
    ];
    appendix(drawn.speech.say("Conventions"), blocks)
}

/// Versions of program and formats.
fn versions(content: &ReportContent, speech: Speech) -> Option<Block> {
    let versions = &content.provenance.versions;
    let each: Vec<String> = versions.iter().map(|(k, v)| format!("{k} {v}")).collect();
    let list = each.join(", ");
    let text = speech.say_with("Versions of program and files: {list}.", &[("list", &list)]);
    (!each.is_empty()).then(|| Block::Paragraph {
        text: tables::verbatim(text),
    })
}

fn provenance(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    if !content.command_line.is_empty() {
        blocks.push(paragraph(
            drawn
                .speech
                .say("The command that makes this report again:"),
        ));
        blocks.push(Block::Verbatim {
            text: content.command_line.clone(),
            columns: 1,
        });
    }
    blocks.extend(versions(content, drawn.speech));
    blocks.extend(tables::hashes(content, drawn.speech).map(Block::Table));
    if !content.provenance.settings.is_null() {
        blocks.push(paragraph(drawn.speech.say("Settings, as resolved:")));
        blocks.push(settings(&content.provenance.settings));
    }
    appendix(drawn.speech.say("Settings, versions, inputs"), blocks)
}
