//! The sections after the first page, each only where there is something to show.

use super::drawn::Drawn;
use super::model::{Block, Placement, Rich, Section};
use super::settings::settings;
use super::tables;
use super::{captions, conventions};
use crate::content::ReportContent;
use crate::figures::comparison;
use crate::figures::plane::Plane;
use crate::locale::Locale;
use crate::parameters::{method_inline, parameter, short};
use crate::phrase::Phrase;
use impact_fit::methods::answer::found_by;
use impact_fit::parameters::Coordinate;
use impact_fit::{Finding, Method, MethodResult};
use impact_records::motion::BoundaryKind;

/// All sections in their order.
pub(super) fn sections(content: &ReportContent, drawn: &Drawn<'_>) -> Vec<Section> {
    let mut sections: Vec<Section> = [
        regions(content, drawn),
        comparisons(content, drawn),
        methods(content, drawn),
        uncertainty(content, drawn),
        specimens(content, drawn),
        left_out(content, drawn),
        records(content, drawn),
        conventions(content, drawn),
        provenance(content, drawn),
    ]
    .into_iter()
    .flatten()
    .collect();
    letter_appendices(&mut sections, drawn.locale);
    sections
}

/// Letters before the titles of the appendices, in the order in which they come.
fn letter_appendices(sections: &mut [Section], locale: Locale<'_>) {
    let appendices = sections.iter_mut().filter(|s| s.appendix);
    for (section, letter) in appendices.zip('A'..='Z') {
        let (letter, title) = (letter.to_string(), section.title.plain());
        let values = [("letter", letter.as_str()), ("title", title.as_str())];
        section.title = Rich::from(locale.translate_with(Phrase::Appendix, &values));
    }
}

fn appendix(title: String, blocks: Vec<Block>) -> Option<Section> {
    section(title, false, blocks).map(|s| Section {
        appendix: true,
        ..s
    })
}

pub(super) fn section(title: String, new_page: bool, blocks: Vec<Block>) -> Option<Section> {
    (!blocks.is_empty()).then(|| Section {
        title: Rich::from(title),
        level: 1,
        new_page,
        appendix: false,
        blocks,
    })
}

pub(super) fn paragraph(text: impl AsRef<str>) -> Block {
    Block::Paragraph {
        text: Rich::from(text),
    }
}

fn regions(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    blocks.extend(drawn.figures_block(&[("map", &map_caption(content, drawn.locale))]));
    blocks.extend(boundaries_alone(content, drawn.locale).map(paragraph));
    // above their table, which may end where a page does
    blocks.extend(edges(content, drawn.locale).map(paragraph));
    blocks.extend(far_brackets(content, drawn.locale).map(paragraph));
    blocks.extend(tables::brackets(content, drawn.locale).map(|t| t.block("brackets")));
    section(
        drawn.locale.translate(Phrase::RegionsOfMotion),
        true,
        blocks,
    )
}

/// What the table of brackets calls an edge, where it has one.
fn edges(content: &ReportContent, locale: Locale<'_>) -> Option<String> {
    let mut kinds = content.compared.brackets.iter().map(|b| b.kind);
    let has_edge = kinds.any(|kind| kind == BoundaryKind::Other);
    has_edge.then(|| locale.translate(Phrase::EdgeMeans))
}

/// Why brackets may be far off the simulated boundary, where some that are used are.
fn far_brackets(content: &ReportContent, locale: Locale<'_>) -> Option<String> {
    let brackets = content.compared.brackets.iter();
    let far = brackets.filter(|b| {
        let (low, high) = (b.frequency_low_hz, b.frequency_high_hz);
        let off = b.simulated_hz.map(|f| (low - f).max(f - high));
        b.left_out.is_none() && off > Some(high - low)
    });
    let count = far.count();
    let values = [("count", &*count.to_string())];
    (count > 0).then(|| locale.translate_with(Phrase::FarBrackets, &values))
}

/// R of the boundaries beside that of all methods together.
fn boundaries_alone(content: &ReportContent, locale: Locale<'_>) -> Option<String> {
    let id = &content.identification;
    let look = parameter(Coordinate::Restitution)?;
    let of = |result: &MethodResult| {
        let estimate = result.parameters.restitution.as_ref();
        let known = estimate.filter(|e| e.value.is_some());
        known.map(|e| short(look, Some(e), locale))
    };
    let boundaries = of(found_by(&id.methods, Method::observes_boundaries)?)?;
    let joint = of(&id.joint)?;
    let values = [("boundaries", boundaries.as_str()), ("joint", &joint)];
    Some(locale.translate_with(Phrase::CaptionBoundariesAlone, &values))
}

fn map_caption(content: &ReportContent, locale: Locale<'_>) -> String {
    let mut text = locale.translate(Phrase::CaptionMap);
    let mut add = |sentence: &str| text.push_str(&format!(" {sentence}"));
    let strips = Plane::of(content).map(|p| p.view(content).strips);
    if strips.is_some_and(|s| !s.is_empty()) {
        add(&locale.translate(Phrase::CaptionStrips));
    }
    if content.compared.region_map.is_some() {
        add(&locale.translate(Phrase::CaptionRegions));
        add(&locale.translate(Phrase::CaptionCells));
    }
    if content.compared.curves.iter().any(|c| !c.band95.is_empty()) {
        add(&locale.translate(Phrase::CaptionBands));
    }
    if !content.compared.comparisons.is_empty() {
        add(&locale.translate(Phrase::CaptionLetters));
    }
    text.extend(in_doubt(content, locale));
    text
}

/// That what is drawn at the stated clearances is in doubt, where the records contradict them.
fn in_doubt(content: &ReportContent, locale: Locale<'_>) -> Option<String> {
    let doubted = content.identification.verdict.doubts_clearances();
    doubted.then(|| format!(" {}", locale.translate(Phrase::CaptionClearancesInDoubt)))
}

fn comparisons(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    for comparison in &content.compared.comparisons {
        let name = comparison::name(comparison);
        let mut caption = captions::comparison(comparison, drawn.locale);
        caption.extend(in_doubt(content, drawn.locale));
        blocks.extend(drawn.figures_block(&[(&name, &caption)]));
    }
    if !blocks.is_empty() {
        let keys = Phrase::CaptionComparisons;
        blocks.insert(0, paragraph(drawn.locale.translate(keys)));
    }
    section(
        drawn.locale.translate(Phrase::SimulatedAndMeasuredMotions),
        false,
        blocks,
    )
}

/// What was found of each specimen, by method.
fn specimens(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let table =
        tables::specimen_methods(content, drawn.locale).map(|t| t.block("specimen_methods"));
    let mut blocks: Vec<Block> = table.into_iter().collect();
    for (specimen, result) in &content.identification.specimens {
        for (method, result) in &result.methods {
            let name = method_inline(*method, drawn.locale);
            blocks.extend(result.remarks.iter().map(|r| {
                let text = drawn.locale.sentence(r);
                paragraph(format!("{specimen}, {name}: {text}"))
            }));
        }
    }
    section(
        drawn.locale.translate(Phrase::SpecimenBySpecimen),
        false,
        blocks,
    )
}

fn methods(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    if content.identification.specimens.is_empty() {
        blocks.extend(tables::methods(content, drawn.locale).map(|t| t.block("methods")));
    }
    blocks.extend(tables::agreement(content, drawn.locale).map(|t| t.block("agreement")));
    let remarks = content
        .identification
        .methods
        .iter()
        .flat_map(|(name, method)| {
            let name = drawn.locale.message(name);
            method
                .remarks
                .iter()
                .map(move |r| paragraph(format!("{name}: {}", drawn.locale.sentence(r))))
        });
    blocks.extend(remarks);
    blocks.extend(tables::further(content, drawn.locale).map(|t| t.block("further")));
    let captioned = captions::method_figures(content, drawn.locale);
    let named: Vec<(&str, &str)> = captioned
        .iter()
        .map(|(n, c)| (n.as_str(), c.as_str()))
        .collect();
    blocks.extend(drawn.placed(&named, Placement::Filling));
    // Pages that begin anew are set beside each other.
    section(
        drawn.locale.translate(Phrase::MethodByMethod),
        comparisons_fill_pages(content, drawn),
        blocks,
    )
}

/// Height of a comparison of which three leave little of a page, points.
const THIRD_OF_A_PAGE: f64 = 150.0;

/// Whether the comparisons fill their pages, so that nothing has room below the last one.
fn comparisons_fill_pages(content: &ReportContent, drawn: &Drawn<'_>) -> bool {
    let comparisons = content.compared.comparisons.iter();
    let figures = comparisons.filter_map(|c| drawn.figure(&comparison::name(c), ""));
    let heights: Vec<f64> = figures.map(|f| f.height).collect();
    let (count, all) = (heights.len(), heights.iter().sum::<f64>());
    count > 0 && count.is_multiple_of(3) && all > THIRD_OF_A_PAGE * count as f64
}

/// What the rig has beyond the model, and the uncertainty budget.
fn uncertainty(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let findings = content.identification.verdict.findings.iter();
    let beyond = findings.filter(|f| matches!(f, Finding::BeyondModel { .. }));
    let mut blocks: Vec<Block> = beyond
        .map(|finding| paragraph(drawn.locale.sentence(finding)))
        .collect();
    if let Some(table) = tables::budget(content, drawn.locale) {
        blocks.push(table.block("budget"));
        blocks.push(paragraph(drawn.locale.translate(Phrase::ExpandedMeans)));
    }
    let title = Phrase::UncertaintyAndEffects;
    section(drawn.locale.translate(title), false, blocks)
}

fn left_out(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let table = tables::left_out(content, drawn.locale).map(|t| t.block("left_out"));
    let title = drawn.locale.translate(Phrase::WhatWasLeftOut);
    section(title, false, table.into_iter().collect())
}

fn records(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let table = tables::records(content, drawn.locale).map(|t| t.block("records"));
    appendix(
        drawn.locale.translate(Phrase::AllRecords),
        table.into_iter().collect(),
    )
}

fn conventions(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let records = &content.compared.records;
    let driven = records.is_empty() || records.iter().any(|r| r.frequency_hz.is_some());
    let intervals = Phrase::IntervalsAndUnits;
    let blocks = vec![
        Block::Definitions {
            entries: conventions::entries(driven, drawn.locale),
        },
        paragraph(drawn.locale.translate(intervals)),
    ];
    appendix(drawn.locale.translate(Phrase::Conventions), blocks)
}

/// Versions of program and formats.
fn versions(content: &ReportContent, locale: Locale<'_>) -> Option<Block> {
    let versions = &content.provenance.versions;
    let each: Vec<String> = versions.iter().map(|(k, v)| format!("{k} {v}")).collect();
    let list = each.join(", ");
    let text = locale.translate_with(Phrase::Versions, &[("list", &list)]);
    (!each.is_empty()).then(|| Block::Paragraph {
        text: Rich::verbatim(text),
    })
}

fn provenance(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    if !content.command_line.is_empty() {
        blocks.push(paragraph(drawn.locale.translate(Phrase::CommandAgain)));
        blocks.push(Block::Verbatim {
            text: content.command_line.clone(),
            columns: 1,
        });
    }
    blocks.extend(versions(content, drawn.locale));
    let inputs = &content.provenance.inputs_sha256;
    blocks.extend(tables::hashes(inputs, drawn.locale).map(|t| t.block("hashes")));
    if !content.provenance.settings.is_null() {
        blocks.push(paragraph(
            drawn.locale.translate(Phrase::SettingsAsResolved),
        ));
        blocks.push(settings(&content.provenance.settings));
    }
    appendix(
        drawn.locale.translate(Phrase::SettingsVersionsInputs),
        blocks,
    )
}
