//! The table of all records.

use rayon::prelude::*;

use super::column::{Column, arrow, table};
use super::fitted::{fitted, shortened};
use crate::content::ReportContent;
use crate::document::model::{Rich, Table};
use crate::kit::fonts::{self, Face};
use crate::kit::look;
use crate::locale::Locale;
use crate::parameters::method_inline;
use crate::phrase::{Phrase, Text};
use impact_identification::replay::RecordRow;
use impact_records::motion::Motion;
use impact_records::signal::whole;

/// From how many records on the table is set small and in two columns.
const MANY_RECORDS: usize = 45;

/// All records; many of them small and in two columns.
pub(crate) fn records(content: &ReportContent, locale: Locale<'_>) -> Option<Table> {
    let many = content.compared.records.len() > MANY_RECORDS;
    let planar = content
        .compared
        .records
        .iter()
        .any(|r| r.eta.is_some() && r.rho.is_some());
    let mut columns = vec![Column::left(Phrase::Record), Column::left(Phrase::Specimen)];
    columns.extend([
        Column::center(""),
        Column::right("$f$ (Hz)"),
        Column::right("$r$ (mm)"),
    ]);
    if planar {
        columns.extend([Column::right("$η$"), Column::right("$ρ$")]);
    }
    columns.extend([
        Column::center("$z$"),
        Column::right(Phrase::ConfidenceShort),
        Column::right(Phrase::Impacts),
    ]);
    columns.push(if many {
        Column::left("")
    } else {
        Column::wide(Phrase::UsedByAndFlags, 1)
    });
    let row = |r: &RecordRow| record_row(r, planar, many, locale);
    let rows = content.compared.records.iter().map(row).collect();
    let caption: Text = if many {
        let signs = Phrase::TableManyRecords;
        locale
            .translate_with(signs, &[("records", &which(content, locale))])
            .into()
    } else {
        if content
            .compared
            .records
            .iter()
            .any(|r| r.frequency_hz.is_some())
        {
            Phrase::TableRecords
        } else {
            Phrase::TableRecordsByMethod
        }
        .into()
    };
    let table = table(caption, columns, rows, locale)?;
    Some(if many {
        crowded(table)
    } else {
        fitted(Table { size: 7.5, ..table })
    })
}

/// Which records the table lists: all, or an even choice of very many.
fn which(content: &ReportContent, locale: Locale<'_>) -> String {
    let (listed, all) = (
        content.compared.records.len(),
        content.compared.overview.records,
    );
    if listed < all {
        locale.translate_with(
            Phrase::SomeRecords,
            &[("some", &listed.to_string()), ("count", &all.to_string())],
        )
    } else {
        locale.translate(Phrase::AllRecords)
    }
}

/// Many rows: small type, whole columns at once, two tables beside each other where they fit.
fn crowded(table: Table) -> Table {
    /// Size of the type, points.
    const SIZE: f64 = 6.2;
    /// Room that a cell takes beside its text, points.
    const PADDING: f64 = 0.9 * SIZE;
    /// Room between the two tables, points, as the template has it.
    const GUTTER: f64 = 14.0;
    let mut table = table;
    let width = |cell: &Rich| fonts::width(&cell.plain(), Face::Bold, SIZE);
    let need = |table: &Table, i: usize| {
        let cells = table.rows.iter().map(|row| width(&row[i]));
        (cells.fold(width(&table.heads[i]), f64::max) + PADDING).ceil()
    };
    let columns = (0..table.heads.len()).into_par_iter();
    let mut needs: Vec<f64> = columns.map(|i| need(&table, i)).collect();
    let rest: f64 = needs.iter().skip(1).sum();
    let half = 0.5 * (look::FULL_WIDTH - GUTTER);
    let side_by_side = if needs[0] + rest <= half { 2 } else { 1 };
    let room = if side_by_side == 2 {
        half
    } else {
        look::FULL_WIDTH
    } - rest
        - PADDING;
    for row in &mut table.rows {
        row[0] = shortened(&row[0], room, SIZE);
    }
    needs[0] = need(&table, 0);
    let widths = needs.iter();
    let widths = widths.map(|need| u16::try_from(whole::count(*need)).unwrap_or(u16::MAX));
    let widths = widths.collect();
    Table {
        size: SIZE,
        side_by_side,
        widths,
        ..table
    }
    .densely()
}

fn record_row(r: &RecordRow, planar: bool, many: bool, locale: Locale<'_>) -> Vec<Rich> {
    let number = |v: Option<f64>, decimals| v.map_or("–".into(), |v| locale.fixed(v, decimals));
    let mut row: Vec<String> = vec![
        r.id.clone(),
        r.specimen.clone().unwrap_or_default(),
        arrow(r.sweep).into(),
        number(r.frequency_hz, 3),
        r.clearance_m.map_or("–".into(), |c| locale.clearance(c)),
    ];
    if planar {
        row.extend([number(r.eta, 4), number(r.rho, 3)]);
    }
    let driven = r.frequency_hz.is_some();
    row.extend([
        motion_label(r, many, locale),
        number(driven.then_some(r.confidence), 2),
    ]);
    if !driven && r.impacts > 0 {
        row.push(r.impacts.to_string());
    } else {
        row.push(String::new());
    }
    row.push(if many {
        short_remark(r)
    } else {
        long_remark(r, locale)
    });
    row.into_iter().map(Rich::verbatim).collect()
}

fn motion_label(r: &RecordRow, many: bool, locale: Locale<'_>) -> String {
    match &r.motion {
        Motion::Undetermined { .. } if r.frequency_hz.is_none() => "–".into(),
        Motion::Undetermined { .. } if many => "?".into(),
        motion => locale.motion(motion),
    }
}

fn short_remark(r: &RecordRow) -> String {
    let used = if r.used_by.is_empty() { "" } else { "•" };
    let flagged = if r.flags.is_empty() { "" } else { "!" };
    format!("{used}{flagged}")
}

fn long_remark(r: &RecordRow, locale: Locale<'_>) -> String {
    let used = if r.used_by.is_empty() {
        let reason = r.left_out.as_ref().map(|reason| locale.message(reason));
        let excluded = r.excluded.as_ref().map(|problem| locale.message(problem));
        let why = excluded.or(reason);
        why.map(|why| locale.translate_with(Phrase::NotUsedBecause, &[("why", &why)]))
    } else {
        Some(
            r.used_by
                .iter()
                .map(|m| method_inline(*m, locale))
                .collect::<Vec<_>>()
                .join(", "),
        )
    };
    let flags = (!r.flags.is_empty()).then(|| {
        let flags = r.flags.iter().map(|f| locale.message(f));
        flags.collect::<Vec<_>>().join(", ")
    });
    [used, flags]
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join("; ")
}
