//! The tables of the document.

use super::model::{Rich, Table};
use crate::motion::Motion;
use crate::record::Sweep;
use crate::report::content::{BracketRow, RecordRow, ReportContent};
use crate::report::figures::fonts::{self, Face};
use crate::report::figures::look::{self, NumberLook};
use crate::report::parameters::{self, PARAMETERS, method_name};

/// From how many records on the table is set small and in two columns.
const MANY_RECORDS: usize = 45;

/// From how many brackets on their table is set small and in two columns.
const MANY_BRACKETS: usize = 14;

/// A column: head, alignment, relative width (0: as wide as its content).
type Column = (&'static str, &'static str, u16);

fn table(caption: &str, columns: &[Column], rows: Vec<Vec<Rich>>) -> Option<Table> {
    let table = (!rows.is_empty()).then(|| Table {
        caption: Rich::from(caption),
        heads: columns.iter().map(|c| Rich::from(c.0)).collect(),
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

/// What each method found, and the joint estimate.
pub fn methods(content: &ReportContent, numbers: NumberLook) -> Option<Table> {
    let id = &content.identification;
    let all = id.methods.iter().map(|(k, m)| (method_name(k), m));
    let all = all.chain([(method_name("joint"), &id.joint)]);
    let rows = all.map(|(name, method)| {
        let mut row = vec![Rich::from(name)];
        row.extend(PARAMETERS.iter().map(|look| {
            Rich::from(parameters::short(
                look,
                (look.pick)(&method.parameters),
                numbers,
            ))
        }));
        let observations = method.observations;
        row.push(Rich::from(if observations == 0 {
            "–".into()
        } else {
            observations.to_string()
        }));
        row.push(Rich::from(
            method
                .reduced_residual
                .map_or("–".into(), |r| numbers.significant(r, 2)),
        ));
        row.push(Rich::from(match method.fits {
            Some(true) => "yes",
            Some(false) => "no",
            None => "–",
        }));
        row
    });
    let columns: [Column; 8] = [
        ("method", "left", 0),
        ("$R$", "left", 1),
        ("$f_0$", "left", 1),
        ("$β$", "left", 1),
        ("$x_{st}$", "left", 1),
        ("obs.", "right", 0),
        ("residual", "right", 0),
        ("fits", "center", 0),
    ];
    let caption = "Estimates with half their 95 % interval, number of observations, root mean \
                   square of the weighted residuals (1: as the stated noise), and whether the \
                   model fits.";
    table(caption, &columns, rows.collect()).map(|t| Table { size: 7.5, ..t })
}

/// Whether the methods agree, pair by pair.
pub fn agreement(content: &ReportContent, numbers: NumberLook) -> Option<Table> {
    let rows = content.identification.agreement.pairs.iter().map(|pair| {
        let symbol =
            parameters::parameter(&pair.parameter).map_or(pair.parameter.as_str(), |p| p.symbol);
        let p = if pair.p_value < 1e-3 {
            format!("< {}", numbers.fixed(1e-3, 3))
        } else {
            numbers.fixed(pair.p_value, 3)
        };
        vec![
            Rich::from(symbol),
            Rich::from(method_name(&pair.methods[0])),
            Rich::from(method_name(&pair.methods[1])),
            Rich::from(numbers.fixed(pair.z_score, 2)),
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
    )
}

/// The measured brackets beside the simulated boundary; many of them small and in two columns.
pub fn brackets(content: &ReportContent, numbers: NumberLook) -> Option<Table> {
    let many = content.brackets.len() > MANY_BRACKETS;
    let rows = content
        .brackets
        .iter()
        .map(|b| bracket_row(b, many, numbers))
        .collect();
    let columns: [Column; 8] = [
        (if many { "" } else { "boundary" }, "left", 0),
        ("$z$", "left", 0),
        ("$r$ (mm)", "right", 0),
        ("$ρ$", "right", 0),
        (if many { "" } else { "sweep" }, "center", 0),
        ("measured between (Hz)", "center", 0),
        ("simulated (Hz)", "right", 0),
        (if many { "" } else { "remark" }, "left", 1),
    ];
    let caption = if many {
        "Measured brackets of the boundaries, and the boundary of the fitted model: = within the \
         bracket, < below, > above it; × not used in the fit."
    } else {
        "Measured brackets of the boundaries, and the boundary of the fitted model."
    };
    let table = table(caption, &columns, rows)?;
    Some(if many {
        Table {
            size: 6.8,
            side_by_side: 2,
            ..table
        }
    } else {
        Table { size: 8.0, ..table }
    })
}

fn bracket_row(b: &BracketRow, many: bool, numbers: NumberLook) -> Vec<Rich> {
    let (low, high) = (b.frequency_low_hz, b.frequency_high_hz);
    vec![
        Rich::from(b.kind.symbol()),
        Rich::from(b.motion.label()),
        Rich::from(numbers.significant(1e3 * b.clearance_m, 3)),
        Rich::from(b.rho.map_or("–".into(), |r| numbers.fixed(r, 3))),
        Rich::from(arrow(b.direction)),
        Rich::from(format!(
            "{} … {}",
            numbers.fixed(low, 3),
            numbers.fixed(high, 3)
        )),
        Rich::from(b.simulated_hz.map_or("–".into(), |f| numbers.fixed(f, 3))),
        Rich::from(if many {
            bracket_sign(b).into()
        } else {
            bracket_remark(b, numbers)
        }),
    ]
}

fn bracket_sign(b: &BracketRow) -> &'static str {
    match (&b.left_out, b.simulated_hz) {
        (Some(_), _) => "×",
        (None, Some(f)) if f < b.frequency_low_hz => "<",
        (None, Some(f)) if f > b.frequency_high_hz => ">",
        (None, Some(_)) => "=",
        (None, None) => "",
    }
}

fn bracket_remark(b: &BracketRow, numbers: NumberLook) -> String {
    let (low, high) = (b.frequency_low_hz, b.frequency_high_hz);
    match (&b.left_out, b.simulated_hz) {
        (Some(why), _) => format!("not used: {why}"),
        (None, Some(f)) if f < low => format!("below by {} Hz", numbers.fixed(low - f, 3)),
        (None, Some(f)) if f > high => format!("above by {} Hz", numbers.fixed(f - high, 3)),
        (None, Some(_)) => "within".into(),
        (None, None) => String::new(),
    }
}

fn arrow(sweep: Sweep) -> &'static str {
    match sweep {
        Sweep::Up => "↑",
        Sweep::Down => "↓",
        Sweep::Unknown => "",
    }
}

/// What was left out and why.
pub fn left_out(content: &ReportContent) -> Option<Table> {
    let rows = content.left_out.iter().map(|l| {
        let count = l.count.map_or(String::new(), |c| c.to_string());
        vec![Rich::from(&l.what), Rich::from(count), Rich::from(&l.why)]
    });
    let columns: [Column; 3] = [
        ("left out", "left", 2),
        ("count", "right", 0),
        ("why", "left", 5),
    ];
    table("", &columns, rows.collect())
}

/// All records; many of them small and in two columns.
pub fn records(content: &ReportContent, numbers: NumberLook) -> Option<Table> {
    let many = content.records.len() > MANY_RECORDS;
    let planar = content
        .records
        .iter()
        .any(|r| r.eta.is_some() && r.rho.is_some());
    let mut columns: Vec<Column> = vec![("record", "left", 0)];
    columns.extend([
        ("", "center", 0),
        ("$f$ (Hz)", "right", 0),
        ("$r$ (mm)", "right", 0),
    ]);
    if planar {
        columns.extend([("$η$", "right", 0), ("$ρ$", "right", 0)]);
    }
    columns.extend([("$z$", "center", 0), ("conf.", "right", 0)]);
    columns.push(if many {
        ("", "left", 0)
    } else {
        ("used by; flags", "left", 1)
    });
    let row = |r: &RecordRow| record_row(r, planar, many, numbers);
    let rows = content.records.iter().map(row).collect();
    let caption = if many {
        "All records: sweep, measured drive frequency, clearance, motion, confidence. \
         ? undetermined; • used in the identification; ! flagged. Reasons and flags in full are in \
         records.parquet."
    } else {
        "All records: sweep, measured drive frequency, clearance, motion and confidence."
    };
    let table = table(caption, &columns, rows)?;
    Some(if many {
        crowded(table)
    } else {
        Table { size: 7.5, ..table }
    })
}

/// Many rows: small type, whole columns at once, two tables beside each other where they fit.
fn crowded(table: Table) -> Table {
    const SIZE: f64 = 6.2;
    const PADDING: f64 = 0.9 * SIZE;
    const GUTTER: f64 = 14.0;
    let mut table = table;
    let width = |cell: &Rich| fonts::width(&cell.plain(), Face::Bold, SIZE);
    let need = |table: &Table, i: usize| {
        let cells = table.rows.iter().map(|row| width(&row[i]));
        (cells.fold(width(&table.heads[i]), f64::max) + PADDING).ceil()
    };
    let rest: f64 = (1..table.heads.len()).map(|i| need(&table, i)).sum();
    let half = 0.5 * (look::FULL_WIDTH - GUTTER);
    let side_by_side = if need(&table, 0) + rest <= half { 2 } else { 1 };
    let room = if side_by_side == 2 {
        half
    } else {
        look::FULL_WIDTH
    } - rest
        - PADDING;
    for row in &mut table.rows {
        row[0] = shortened(&row[0], room, SIZE);
    }
    let widths = (0..table.heads.len())
        .map(|i| need(&table, i) as u16)
        .collect();
    Table {
        size: SIZE,
        side_by_side,
        widths,
        ..table
    }
    .densely()
}

/// A name cut at its front where it is wider than the room: a wrapped line would shift the rows.
fn shortened(name: &Rich, room: f64, size: f64) -> Rich {
    let plain = name.plain();
    let wide = |text: &str| fonts::width(text, Face::Bold, size) > room;
    if !wide(&plain) {
        return name.clone();
    }
    let starts = plain.char_indices().map(|(i, _)| i).skip(1);
    let fitting = starts
        .map(|i| format!("…{}", &plain[i..]))
        .find(|text| !wide(text));
    verbatim(fitting.unwrap_or_else(|| "…".into()))
}

fn record_row(r: &RecordRow, planar: bool, many: bool, numbers: NumberLook) -> Vec<Rich> {
    let number = |v: Option<f64>, decimals| v.map_or("–".into(), |v| numbers.fixed(v, decimals));
    let mut row: Vec<String> = vec![
        r.id.clone(),
        arrow(r.sweep).into(),
        number(r.frequency_hz, 3),
        r.clearance_m
            .map_or("–".into(), |c| numbers.fixed(1e3 * c, 3)),
    ];
    if planar {
        row.extend([number(r.eta, 4), number(r.rho, 3)]);
    }
    row.extend([motion_label(r, many), number(r.confidence, 2)]);
    row.push(if many {
        short_remark(r)
    } else {
        long_remark(r)
    });
    row.into_iter().map(verbatim).collect()
}

fn motion_label(r: &RecordRow, many: bool) -> String {
    match &r.motion {
        Motion::Undetermined { .. } if r.frequency_hz.is_none() => "–".into(),
        Motion::Undetermined { .. } if many => "?".into(),
        motion => motion.label(),
    }
}

/// A cell whose text has no markup, whatever signs it holds.
fn verbatim(text: String) -> Rich {
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

fn short_remark(r: &RecordRow) -> String {
    let used = if r.used_by.is_empty() { "" } else { "•" };
    let flagged = if r.flags.is_empty() { "" } else { "!" };
    format!("{used}{flagged}")
}

fn long_remark(r: &RecordRow) -> String {
    let used = if r.used_by.is_empty() {
        r.left_out.as_ref().map(|why| format!("not used: {why}"))
    } else {
        Some(
            r.used_by
                .iter()
                .map(|m| method_name(m).to_lowercase())
                .collect::<Vec<_>>()
                .join(", "),
        )
    };
    let flags = (!r.flags.is_empty()).then(|| r.flags.join(", "));
    [used, flags]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join("; ")
}

/// Versions of program and formats.
pub fn versions(content: &ReportContent) -> Option<Table> {
    let rows = content.identification.versions.iter();
    let rows = rows
        .map(|(k, v)| vec![verbatim(k.clone()), verbatim(v.clone())])
        .collect();
    table(
        "Versions.",
        &[("what", "left", 1), ("version", "left", 3)],
        rows,
    )
}

/// SHA-256 of the inputs.
pub fn hashes(content: &ReportContent) -> Option<Table> {
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
    )
    .map(|t| Table { size: 6.2, ..t })
}
