//! The sections after the first page, each only where there is something to show.

use super::model::{Block, Definition, Rich, Section};
use super::prose::prose;
use super::settings::settings;
use super::tables;
use super::{Drawn, captions};
use crate::report::content::ReportContent;
use crate::report::figures::comparison;
use crate::report::figures::look::NumberLook;
use crate::report::figures::plane::Plane;
use crate::report::parameters::method_name;

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
    letter_appendices(&mut sections, drawn.numbers);
    for section in &mut sections {
        localise(&mut section.blocks, drawn.numbers);
    }
    sections
}

/// Paragraphs and captions with the decimal sign of the reader's choice.
fn localise(blocks: &mut [Block], numbers: NumberLook) {
    for block in blocks {
        match block {
            Block::Paragraph { text } => *text = std::mem::take(text).localised(numbers),
            Block::Figures { figures } => {
                for figure in figures {
                    figure.caption = std::mem::take(&mut figure.caption).localised(numbers);
                }
            }
            _ => {}
        }
    }
}

/// Letters before the titles of the appendices, in the order in which they come.
fn letter_appendices(sections: &mut [Section], numbers: NumberLook) {
    let appendices = sections.iter_mut().filter(|s| s.appendix);
    for (section, letter) in appendices.zip('A'..='Z') {
        let (letter, title) = (letter.to_string(), section.title.plain());
        let values = [("letter", letter.as_str()), ("title", title.as_str())];
        section.title = Rich::from(numbers.say_with("Appendix {letter}. {title}", &values));
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
    blocks.extend(drawn.figures_block(&[("map", &map_caption(content, drawn.numbers))]));
    blocks.extend(tables::brackets(content, drawn.numbers).map(Block::Table));
    section(drawn.numbers.say("Regions of motion"), true, blocks)
}

fn map_caption(content: &ReportContent, numbers: NumberLook) -> String {
    let mut text = numbers.say(
        "Measured motions in the plane of frequency and clearance. Each mark is a record; marks of \
         an upward sweep stand a little above their clearance, those of a downward sweep a little \
         below.",
    );
    let mut add = |sentence: &str| text.push_str(&format!(" {sentence}"));
    let strips = Plane::of(content).map(|p| p.view(content).strips);
    if strips.is_some_and(|s| !s.is_empty()) {
        add(&numbers.say("Clearances far above all impacts stand in a strip of their own."));
    }
    if let Some(map) = &content.region_map {
        add(&numbers.say(match map.second.is_empty() {
            true => {
                "Tinted regions: simulated with the fitted parameters, labelled by $z$ = $p$/$n$."
            }
            false => {
                "Tinted regions: simulated with the fitted parameters, labelled by $z$ = $p$/$n$; \
                 hatched, with two labels, where two motions are possible (hysteresis)."
            }
        }));
        if !map.note.is_empty() {
            add(&numbers.say(&captions::sentence(&map.note)));
        }
    }
    if content.curves.iter().any(|c| !c.band95.is_empty()) {
        add(&numbers.say("Grey bands: 95 % bands of the simulated boundaries."));
    }
    if !content.comparisons.is_empty() {
        add(&numbers.say("Letters: the points compared in the next figures."));
    }
    text
}

fn comparisons(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    for comparison in &content.comparisons {
        let name = comparison::name(comparison);
        let caption = comparison::caption(comparison, drawn.numbers);
        blocks.extend(drawn.figures_block(&[(&name, &caption)]));
    }
    if !blocks.is_empty() {
        let keys = "Each point as simulated with the fitted parameters (left) and as measured \
                    (middle), on the same scales, with the residual (measured less simulated) and \
                    the phase portraits (simulated: broad and pale; measured: thin and dark). Mass \
                    $x$ is blue, mass $y$ vermilion; dotted lines are impacts.";
        blocks.insert(0, paragraph(drawn.numbers.say(keys)));
    }
    section(
        drawn.numbers.say("Simulated and measured motions"),
        false,
        blocks,
    )
}

/// What was found of each specimen, by method.
fn specimens(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let table = tables::specimen_methods(content, drawn.numbers).map(Block::Table);
    let mut blocks: Vec<Block> = table.into_iter().collect();
    for (specimen, result) in &content.identification.specimens {
        for (method, result) in &result.methods {
            let name = drawn.numbers.say(&method_name(method).to_lowercase());
            blocks.extend(
                result
                    .remarks
                    .iter()
                    .map(|r| remark(&format!("{specimen}, {name}: {}", captions::sentence(r)))),
            );
        }
    }
    section(drawn.numbers.say("Specimen by specimen"), false, blocks)
}

fn methods(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    if content.identification.specimens.is_empty() {
        blocks.extend(tables::methods(content, drawn.numbers).map(Block::Table));
    }
    blocks.extend(tables::agreement(content, drawn.numbers).map(Block::Table));
    let remarks = content
        .identification
        .methods
        .iter()
        .flat_map(|(name, method)| {
            let name = drawn.numbers.say(&method_name(name));
            method
                .remarks
                .iter()
                .map(move |r| remark(&format!("{name}: {}", captions::sentence(r))))
        });
    blocks.extend(remarks);
    blocks.extend(tables::further(content, drawn.numbers).map(Block::Table));
    for group in captions::method_figures(content, drawn.numbers) {
        let named: Vec<(&str, &str)> = group
            .iter()
            .map(|(n, c)| (n.as_str(), c.as_str()))
            .collect();
        blocks.extend(drawn.figures_block(&named));
    }
    section(drawn.numbers.say("Method by method"), false, blocks)
}

fn left_out(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks: Vec<Block> = tables::left_out(content, drawn.numbers)
        .map(Block::Table)
        .into_iter()
        .collect();
    let remarks = content.remarks.iter().map(|r| remark(r));
    let title = match blocks.is_empty() {
        true => "Remarks",
        false => "What was left out, and why",
    };
    blocks.extend(remarks);
    section(drawn.numbers.say(title), false, blocks)
}

fn records(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let table = tables::records(content, drawn.numbers).map(Block::Table);
    appendix(
        drawn.numbers.say("All records"),
        table.into_iter().collect(),
    )
}

/// Formula as typst maths, as plain text, what it means, and whether it takes a drive.
type Convention = (&'static str, &'static str, &'static str, bool);

const CONVENTIONS: [Convention; 8] = [
    (
        "R = - (X'_+ + Y'_+) / (X'_- + Y'_-)",
        "R = −(X′₊ + Y′₊)/(X′₋ + Y′₋)",
        "coefficient of restitution: speed of parting over speed of closing",
        false,
    ),
    (
        "beta = b / (2 sqrt(k m))",
        "β = b/(2√(km))",
        "damping ratio of a mass $m$ on a spring $k$ with viscous damping $b$",
        false,
    ),
    (
        "tau = Omega t",
        "τ = Ωt",
        "time counted in natural angle, Ω = √($k$/$m$) = 2π$f_0$",
        false,
    ),
    (
        "eta = omega / Omega = f / f_0",
        "η = ω/Ω = f/f0",
        "frequency ratio of the drive",
        true,
    ),
    (
        "x_\"st\" = F_0 / k",
        "x_st = F0/k",
        "static deflection under the drive's amplitude $F_0$",
        true,
    ),
    (
        "rho = r / x_\"st\" = r k / F_0",
        "ρ = r/x_st = rk/F0",
        "clearance ratio; the gap between the masses is 2$r$",
        true,
    ),
    (
        "z = p / n",
        "z = p/n",
        "$p$ impacts in $n$ drive periods; 1j: a dead zone follows the impact",
        true,
    ),
    (
        "X'' + 2 beta X' + X = cos(eta tau + phi)",
        "X″ + 2βX′ + X = cos(ητ + φ)",
        "motion of each mass between impacts, $X$ = $x$/$x_st$; impact where $X$ + $Y$ ≥ 2$ρ$",
        true,
    ),
];

fn conventions(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let records = &content.records;
    let driven = records.is_empty() || records.iter().any(|r| r.frequency_hz.is_some());
    let entries = CONVENTIONS
        .into_iter()
        .filter(|c| driven || !c.3)
        .map(|c| Definition {
            formula: c.0,
            plain: c.1,
            meaning: Rich::from(drawn.numbers.say(c.2)),
        });
    let entries = entries.collect();
    let intervals = "Intervals are at 95 % confidence; a number after ± is half of that interval. \
                     All quantities are in SI units.";
    let blocks = vec![
        Block::Definitions { entries },
        paragraph(drawn.numbers.say(intervals)),
    ];
    appendix(drawn.numbers.say("Conventions"), blocks)
}

/// Versions of program and formats.
fn versions(content: &ReportContent, numbers: NumberLook) -> Option<Block> {
    let versions = &content.identification.versions;
    let each: Vec<String> = versions.iter().map(|(k, v)| format!("{k} {v}")).collect();
    let list = each.join(", ");
    let text = numbers.say_with("Versions of program and files: {list}.", &[("list", &list)]);
    (!each.is_empty()).then(|| Block::Paragraph {
        text: tables::verbatim(text),
    })
}

fn provenance(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    if !content.command_line.is_empty() {
        blocks.push(paragraph(
            drawn
                .numbers
                .say("The command that makes this report again:"),
        ));
        blocks.push(Block::Verbatim {
            text: content.command_line.clone(),
            columns: 1,
        });
    }
    blocks.extend(versions(content, drawn.numbers));
    blocks.extend(tables::hashes(content, drawn.numbers).map(Block::Table));
    if !content.settings_text.is_empty() {
        blocks.push(paragraph(drawn.numbers.say("Settings, as resolved:")));
        blocks.push(settings(&content.settings_text));
    }
    appendix(drawn.numbers.say("Settings, versions, inputs"), blocks)
}
