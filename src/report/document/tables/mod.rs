//! The tables of the document.

mod brackets;
mod records;

pub use brackets::brackets;
pub use records::records;

use std::collections::BTreeMap;

use crate::identify::{MethodResult, ParameterSet};
use crate::record::Sweep;
use crate::report::content::ReportContent;
use crate::report::document::model::{Rich, Table};
use crate::report::document::prose::prose;
use crate::report::parameters::{self, PARAMETERS, method_name};
use crate::report::speech::Speech;

/// A column: head, alignment, relative width (0: as wide as its content).
type Column = (&'static str, &'static str, u16);

fn table(caption: &str, columns: &[Column], rows: Vec<Vec<Rich>>, speech: Speech) -> Option<Table> {
    let table = (!rows.is_empty()).then(|| Table {
        caption: Rich::from(speech.say(caption)),
        heads: columns
            .iter()
            .map(|c| Rich::from(speech.say_title(c.0)))
            .collect(),
        align: columns.iter().map(|c| c.1).collect(),
        widths: columns.iter().map(|c| c.2).collect(),
        rows,
        size: 8.5,
        side_by_side: 1,
        dense: false,
        columns_text: Vec::new(),
    });
    table.map(without_empty_columns)
}

/// Without the columns in which no row says anything; the first column stays.
fn without_empty_columns(table: Table) -> Table {
    let says = |i: usize| {
        table
            .rows
            .iter()
            .any(|row| !matches!(row[i].plain().as_str(), "" | "–"))
    };
    let kept: Vec<usize> = (0..table.heads.len())
        .filter(|&i| i == 0 || says(i))
        .collect();
    let rows = table.rows.iter();
    let rows = rows
        .map(|row| kept.iter().map(|&i| row[i].clone()).collect())
        .collect();
    Table {
        heads: kept.iter().map(|&i| table.heads[i].clone()).collect(),
        align: kept.iter().map(|&i| table.align[i]).collect(),
        widths: kept.iter().map(|&i| table.widths[i]).collect(),
        rows,
        ..table
    }
}

const METHOD_COLUMNS: [Column; 8] = [
    ("method", "left", 0),
    ("$R$", "left", 1),
    ("$f_0$", "left", 1),
    ("$β$", "left", 1),
    ("$x_st$", "left", 1),
    ("obs.", "right", 0),
    ("residual", "right", 0),
    ("fits", "center", 0),
];

const METHODS_CAPTION: &str = "Estimates with half their 95 % interval, number of observations, \
     root mean square of the weighted residuals (1: as the stated noise), and whether the model \
     fits.";

/// What each method found, and the joint estimate.
pub fn methods(content: &ReportContent, speech: Speech) -> Option<Table> {
    let id = &content.identification;
    let rows = method_rows(&id.methods, &id.joint, speech);
    table(METHODS_CAPTION, &METHOD_COLUMNS, rows, speech).map(|t| Table { size: 7.5, ..t })
}

/// The same for each specimen of a campaign that holds several.
pub fn specimen_methods(content: &ReportContent, speech: Speech) -> Option<Table> {
    let specimens = content.identification.specimens.iter();
    let rows = specimens.flat_map(|(specimen, result)| {
        let rows = method_rows(&result.methods, &result.joint, speech);
        rows.into_iter().enumerate().map(move |(i, row)| {
            let name = if i == 0 {
                verbatim(specimen.clone())
            } else {
                Rich::default()
            };
            std::iter::once(name).chain(row).collect()
        })
    });
    let mut columns: Vec<Column> = vec![("specimen", "left", 0)];
    columns.extend(METHOD_COLUMNS);
    table(METHODS_CAPTION, &columns, rows.collect(), speech).map(|t| Table { size: 7.5, ..t })
}

/// The answer for each specimen of a campaign that holds several.
pub fn specimens(content: &ReportContent, speech: Speech) -> Option<Table> {
    let rows = content
        .identification
        .specimens
        .iter()
        .map(|(specimen, result)| {
            let mut row = vec![verbatim(specimen.clone())];
            row.extend(estimate_cells(&result.joint.parameters, speech));
            let headline = super::front::headline(result.verdict.kind).1;
            row.push(Rich::from(speech.say(headline)));
            row
        });
    let columns: [Column; 6] = [
        ("specimen", "left", 0),
        ("$R$", "left", 1),
        ("$f_0$", "left", 1),
        ("$β$", "left", 1),
        ("$x_st$", "left", 1),
        ("verdict", "left", 2),
    ];
    table("", &columns, rows.collect(), speech).map(|t| Table { size: 8.5, ..t })
}

fn estimate_cells(set: &ParameterSet, speech: Speech) -> Vec<Rich> {
    let cell = |look| Rich::from(parameters::short(look, (look.pick)(set), speech));
    PARAMETERS.iter().map(cell).collect()
}

/// Rows of the methods that say anything, the joint estimate last.
fn method_rows(
    methods: &BTreeMap<String, MethodResult>,
    joint: &MethodResult,
    speech: Speech,
) -> Vec<Vec<Rich>> {
    let all = methods.iter().map(|(k, m)| (method_name(k), m));
    let all = all.chain([(method_name("joint"), joint)]);
    let says = |m: &MethodResult| PARAMETERS.iter().any(|p| (p.pick)(&m.parameters).is_some());
    all.filter(|(_, m)| says(m))
        .map(|(name, m)| method_row(speech.say(&name), m, speech))
        .collect()
}

fn method_row(name: String, method: &MethodResult, speech: Speech) -> Vec<Rich> {
    let mut row = vec![Rich::from(name)];
    row.extend(estimate_cells(&method.parameters, speech));
    let observations = method.observations;
    let observations = if observations == 0 {
        "–".into()
    } else {
        observations.to_string()
    };
    let residual = method.reduced_residual;
    let residual = residual.map_or("–".into(), |r| speech.significant(r, 2));
    let fits = match method.fits {
        Some(true) => "yes",
        Some(false) => "no",
        None => "–",
    };
    row.extend([
        Rich::from(observations),
        Rich::from(residual),
        Rich::from(speech.say(fits)),
    ]);
    row
}

/// Whether the methods agree, pair by pair.
pub fn agreement(content: &ReportContent, speech: Speech) -> Option<Table> {
    let rows = content.identification.agreement.pairs.iter().map(|pair| {
        let symbol =
            parameters::parameter(&pair.parameter).map_or(pair.parameter.as_str(), |p| p.symbol);
        let p = if pair.p_value < 1e-3 {
            format!("< {}", speech.fixed(1e-3, 3))
        } else {
            speech.fixed(pair.p_value, 3)
        };
        vec![
            Rich::from(symbol),
            Rich::from(speech.say(&method_name(&pair.methods[0]))),
            Rich::from(speech.say(&method_name(&pair.methods[1]))),
            Rich::from(speech.fixed(pair.z_score, 2)),
            Rich::from(p),
        ]
    });
    let columns: [Column; 5] = [
        ("parameter", "left", 0),
        ("method", "left", 1),
        ("and method", "left", 1),
        ("difference / its error", "right", 0),
        ("p-value", "right", 0),
    ];
    table(
        "Agreement of the methods, pair by pair.",
        &columns,
        rows.collect(),
        speech,
    )
}

/// Further tables of the content, as they stand.
pub fn further<'a>(
    content: &'a ReportContent,
    speech: Speech<'a>,
) -> impl Iterator<Item = Table> + 'a {
    content.tables.iter().filter_map(move |t| {
        let columns: Vec<Column> = t.heads.iter().map(|_| ("", "right", 0)).collect();
        let rows = t.rows.iter();
        let rows = rows.map(|row| row.iter().map(Rich::from).collect());
        let heads = t.heads.iter().map(|h| Rich::from(speech.say_title(h)));
        (!t.rows.is_empty()).then(|| Table {
            caption: Rich::from(speech.say(&t.caption)),
            heads: heads.collect(),
            align: columns.iter().map(|c| c.1).collect(),
            widths: columns.iter().map(|c| c.2).collect(),
            rows: rows.collect(),
            size: 8.5,
            side_by_side: 1,
            dense: false,
            columns_text: Vec::new(),
        })
    })
}

fn arrow(sweep: Sweep) -> &'static str {
    match sweep {
        Sweep::Up => "↑",
        Sweep::Down => "↓",
        Sweep::Unknown => "",
    }
}

/// What was left out and why.
pub fn left_out(content: &ReportContent, speech: Speech) -> Option<Table> {
    let rows = content.left_out.iter().map(|l| {
        let count = l.count.map_or(String::new(), |c| c.to_string());
        vec![verbatim(l.what.clone()), Rich::from(count), prose(&l.why)]
    });
    let columns: [Column; 3] = [
        ("left out", "left", 2),
        ("count", "right", 0),
        ("why", "left", 5),
    ];
    table("", &columns, rows.collect(), speech)
}

/// A cell whose text has no markup, whatever signs it holds.
pub fn verbatim(text: String) -> Rich {
    use crate::report::figures::richtext::{Level, Run};
    if text.is_empty() {
        Rich::default()
    } else {
        Rich(vec![Run {
            text,
            italic: false,
            level: Level::Base,
        }])
    }
}

/// SHA-256 of the inputs.
pub fn hashes(content: &ReportContent, speech: Speech) -> Option<Table> {
    let inputs = &content.identification.inputs_sha256;
    let rows = inputs
        .iter()
        .map(|(k, v)| vec![verbatim(k.clone()), verbatim(v.clone())])
        .collect();
    let caption = "SHA-256 of every input.";
    table(
        caption,
        &[("input", "left", 2), ("SHA-256", "left", 0)],
        rows,
        speech,
    )
    .map(|t| Table { size: 6.2, ..t })
}
