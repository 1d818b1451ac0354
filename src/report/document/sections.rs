//! The sections after the first page, each only where there is something to show.

use super::Drawn;
use super::model::{Block, Definition, Rich, Section};
use super::tables;
use crate::report::content::ReportContent;

/// All sections in their order.
pub fn sections(content: &ReportContent, drawn: &Drawn<'_>) -> Vec<Section> {
    [
        regions(content, drawn),
        comparisons(content, drawn),
        methods(content, drawn),
        left_out(content),
        records(content, drawn),
        conventions(),
        provenance(content),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn section(title: &str, new_page: bool, blocks: Vec<Block>) -> Option<Section> {
    (!blocks.is_empty()).then(|| Section {
        title: Rich::from(title),
        level: 1,
        new_page,
        blocks,
    })
}

fn paragraph(text: impl AsRef<str>) -> Block {
    Block::Paragraph {
        text: Rich::from(text),
    }
}

fn regions(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    blocks.extend(drawn.figures_block(&[("map", &map_caption(content))]));
    blocks.extend(tables::brackets(content, drawn.numbers).map(Block::Table));
    section("Regions of motion", true, blocks)
}

fn map_caption(content: &ReportContent) -> String {
    let mut text = String::from(
        "Measured motions in the plane of frequency and clearance. Each mark is a record; marks of \
         an upward sweep stand a little above their clearance, those of a downward sweep a little \
         below.",
    );
    if let Some(map) = &content.region_map {
        text.push_str(
            " Tinted regions: simulated with the fitted parameters, labelled by $z$ = $p$/$n$",
        );
        if !map.second.is_empty() {
            text.push_str(
                "; hatched, with two labels, where two motions are possible (hysteresis)",
            );
        }
        text.push('.');
        if !map.note.is_empty() {
            text.push(' ');
            text.push_str(&map.note);
        }
    }
    if content.curves.iter().any(|c| !c.band95.is_empty()) {
        text.push_str(" Grey bands: 95 % bands of the simulated boundaries.");
    }
    if !content.comparisons.is_empty() {
        text.push_str(" Letters: the points compared in the next figures.");
    }
    text
}

fn comparisons(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    for comparison in &content.comparisons {
        let name = crate::report::figures::comparison::name(comparison);
        blocks.extend(drawn.figures_block(&[(&name, &comparison.note)]));
    }
    if !blocks.is_empty() {
        let keys = "Each point as simulated with the fitted parameters (left) and as measured \
                    (middle), on the same scales, with the residual (measured less simulated) and \
                    the phase portraits (simulated: broad and pale; measured: thin and dark). Mass \
                    $x$ is blue, mass $y$ vermilion; dotted lines are impacts.";
        blocks.insert(0, paragraph(keys));
    }
    section("Simulated and measured motions", true, blocks)
}

fn methods(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let mut blocks = Vec::new();
    blocks.extend(tables::methods(content, drawn.numbers).map(Block::Table));
    blocks.extend(tables::agreement(content, drawn.numbers).map(Block::Table));
    let remarks = content
        .identification
        .methods
        .iter()
        .flat_map(|(name, method)| {
            let name = tables::method_name(name);
            method
                .remarks
                .iter()
                .map(move |r| paragraph(format!("{name}: {r}")))
        });
    blocks.extend(remarks);
    for (name, caption) in drawn.method_figures(content) {
        blocks.extend(drawn.figures_block(&[(&name, &caption)]));
    }
    section("Method by method", true, blocks)
}

fn left_out(content: &ReportContent) -> Option<Section> {
    let mut blocks: Vec<Block> = tables::left_out(content)
        .map(Block::Table)
        .into_iter()
        .collect();
    blocks.extend(content.remarks.iter().map(paragraph));
    section("What was left out, and why", false, blocks)
}

fn records(content: &ReportContent, drawn: &Drawn<'_>) -> Option<Section> {
    let table = tables::records(content, drawn.numbers).map(Block::Table);
    section("Appendix A. All records", true, table.into_iter().collect())
}

fn conventions() -> Option<Section> {
    let entry = |formula, plain, meaning: &str| Definition {
        formula,
        plain,
        meaning: Rich::from(meaning),
    };
    let entries = vec![
        entry(
            "tau = Omega t",
            "τ = Ωt",
            "time counted in natural angle, Ω = √($k$/$m$) = 2π$f_0$",
        ),
        entry(
            "beta = b / (2 sqrt(k m))",
            "β = b/(2√(km))",
            "damping ratio of one mass on its spring",
        ),
        entry(
            "eta = omega / Omega = f / f_0",
            "η = ω/Ω = f/f0",
            "frequency ratio of the drive",
        ),
        entry(
            "x_\"st\" = F_0 / k",
            "x_st = F0/k",
            "static deflection under the drive's amplitude",
        ),
        entry(
            "rho = r / x_\"st\" = r k / F_0",
            "ρ = r/x_st = rk/F0",
            "clearance ratio; the gap between the masses is 2$r$",
        ),
        entry(
            "z = p / n",
            "z = p/n",
            "$p$ impacts in $n$ drive periods; 1j: a dead zone follows the impact",
        ),
        entry(
            "R = - (X'_+ + Y'_+) / (X'_- + Y'_-)",
            "R = −(X′₊ + Y′₊)/(X′₋ + Y′₋)",
            "coefficient of restitution: speed of parting over speed of closing",
        ),
        entry(
            "X'' + 2 beta X' + X = cos(eta tau + phi)",
            "X″ + 2βX′ + X = cos(ητ + φ)",
            "motion of each mass between impacts, $X$ = $x$/$x_{st}$; impact where $X$ + $Y$ ≥ 2$ρ$",
        ),
    ];
    let intervals = "Intervals are at 95 % confidence; a number after ± is half of that interval. \
                     All quantities are in SI units; frequencies are as measured from the drive \
                     channel.";
    section(
        "Appendix B. Conventions",
        true,
        vec![Block::Definitions { entries }, paragraph(intervals)],
    )
}

fn provenance(content: &ReportContent) -> Option<Section> {
    let mut blocks = Vec::new();
    if !content.command_line.is_empty() {
        blocks.push(paragraph("The command that makes this report again:"));
        blocks.push(Block::Verbatim {
            text: content.command_line.clone(),
        });
    }
    blocks.extend(tables::versions(content).map(Block::Table));
    blocks.extend(tables::hashes(content).map(Block::Table));
    if !content.settings_text.is_empty() {
        blocks.push(paragraph("Settings, as resolved:"));
        blocks.push(Block::Verbatim {
            text: content.settings_text.clone(),
        });
    }
    section("Appendix C. Settings, versions, inputs", false, blocks)
}
