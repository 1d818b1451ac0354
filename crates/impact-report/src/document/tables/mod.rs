//! The tables of the document.

mod brackets;
mod budget;
mod campaigns;
mod estimates;
mod records;

pub(super) use brackets::brackets;
pub(super) use budget::budget;
pub use budget::budget_source;
pub(super) use campaigns::{campaigns, differences, p_equals, separate, shared};
pub(super) use estimates::{agreement, methods, specimen_methods, specimens};
pub(super) use records::records;

use crate::content::ReportContent;
use crate::document::model::{Align, Rich, Table};
use crate::locale::Locale;
use crate::phrase::{Phrase, Text};
use impact_identification::identify::Item;
use impact_identification::replay::{Unusable, UnusableReason};
use impact_records::record::Sweep;

/// A column of a table.
struct Column {
    /// Its head, with markup.
    head: Text,
    align: Align,
    /// Relative width; 0: as wide as its content.
    width: u16,
}

impl Column {
    /// As wide as its content, left-aligned.
    fn left(head: impl Into<Text>) -> Self {
        Self::wide(head, 0)
    }

    /// With a share of the width that the others leave, left-aligned.
    fn wide(head: impl Into<Text>, width: u16) -> Self {
        Self::aligned(head, Align::Left, width)
    }

    /// As wide as its content, right-aligned: numbers.
    fn right(head: impl Into<Text>) -> Self {
        Self::aligned(head, Align::Right, 0)
    }

    /// As wide as its content, centred: signs.
    fn center(head: impl Into<Text>) -> Self {
        Self::aligned(head, Align::Center, 0)
    }

    fn aligned(head: impl Into<Text>, align: Align, width: u16) -> Self {
        let head = head.into();
        Self { head, align, width }
    }
}

/// A table of columns whose heads are phrases; `None` if it has no rows.
fn table(
    caption: impl Into<Text>,
    columns: Vec<Column>,
    rows: Vec<Vec<Rich>>,
    locale: Locale<'_>,
) -> Option<Table> {
    let heads = columns.iter().map(|c| Rich::from(locale.text(&c.head)));
    let table = Table {
        caption: Rich::from(locale.text(&caption.into())),
        heads: heads.collect(),
        align: columns.iter().map(|c| c.align).collect(),
        widths: columns.iter().map(|c| c.width).collect(),
        ..Table::of(rows)
    };
    (!table.rows.is_empty()).then(|| without_empty_columns(table))
}

/// Without the columns that are empty in all rows; the first column is kept.
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

/// Further tables of the content.
pub(super) fn further<'a>(
    content: &'a ReportContent,
    locale: Locale<'a>,
) -> impl Iterator<Item = Table> + 'a {
    let with_rows = content.tables.iter().filter(|t| !t.rows.is_empty());
    with_rows.map(move |t| {
        let rows = t
            .rows
            .iter()
            .map(|row| row.iter().map(Rich::from).collect());
        let heads = t.heads.iter().map(|h| Rich::from(locale.text(h)));
        Table {
            caption: Rich::from(locale.translate(t.caption)),
            heads: heads.collect(),
            align: vec![Align::Right; t.heads.len()],
            widths: vec![0; t.heads.len()],
            ..Table::of(rows.collect())
        }
    })
}

fn arrow(sweep: Sweep) -> &'static str {
    match sweep {
        Sweep::Up => "↑",
        Sweep::Down => "↓",
        Sweep::Unknown => "",
    }
}

/// Records that no method could use, by reason, and what the fits left out.
pub(super) fn left_out(content: &ReportContent, locale: Locale<'_>) -> Option<Table> {
    let records = content.compared.unusable.iter().map(|u| {
        let count = Some(u.records.len()).filter(|n| *n > 1);
        (
            first_few(&u.records),
            count,
            Rich::verbatim(unusable(u, locale)),
        )
    });
    // impacts are in a remark of their method
    let fits = content.identification.left_out.iter();
    let fits = fits.filter(|l| !matches!(l.item, Item::Impact { .. }));
    let fits = fits.map(|l| {
        let why = Rich::from(locale.message(&l.reason));
        (locale.message(&l.item), None, why)
    });
    let rows = records.chain(fits).map(|(what, count, why)| {
        let count = count.map_or(String::new(), |c| c.to_string());
        vec![Rich::verbatim(what), Rich::from(count), why]
    });
    let columns = vec![
        Column::wide(Phrase::LeftOut, 2),
        Column::right(Phrase::Count),
        Column::wide(Phrase::Why, 5),
    ];
    table("", columns, rows.collect(), locale)
}

/// The first few names.
fn first_few(records: &[String]) -> String {
    match records {
        [a, b, c, _, ..] => format!("{a}, {b}, {c} …"),
        few => few.join(", "),
    }
}

/// Why records are unusable: the flag, then its details in English, or why the motion is undetermined.
fn unusable(unusable: &Unusable, locale: Locale<'_>) -> String {
    let (what, details) = match &unusable.reason {
        UnusableReason::Flag(code, details) => (locale.message(code), details.clone()),
        UnusableReason::Undetermined(why) => {
            let what = locale.translate(Phrase::MotionUndetermined);
            (what, locale.message(why))
        }
    };
    let of = unusable.channel.as_ref().map(|c| format!(" ({c})"));
    let text = format!("{what}{}: {details}", of.unwrap_or_default());
    match unusable.records.first().filter(|_| unusable.differ) {
        Some(record) => {
            let values = [("details", text.as_str()), ("record", record.as_str())];
            locale.translate_with(Phrase::DetailsOfOne, &values)
        }
        None => text,
    }
}

/// SHA-256 of the inputs.
pub(super) fn hashes(content: &ReportContent, locale: Locale<'_>) -> Option<Table> {
    let inputs = &content.provenance.inputs_sha256;
    let rows = inputs
        .iter()
        .map(|(k, v)| vec![Rich::verbatim(k.clone()), Rich::verbatim(v.clone())])
        .collect();
    let columns = vec![Column::wide(Phrase::Input, 2), Column::left("SHA-256")];
    table(Phrase::TableHashes, columns, rows, locale).map(|t| Table { size: 6.2, ..t })
}
