//! Columns, and the table that they make.

use crate::document::model::{Align, Rich, Table};
use crate::locale::Locale;
use crate::phrase::Text;
use impact_records::record::Sweep;

/// A column of a table.
pub(super) struct Column {
    /// Its head, with markup.
    head: Text,
    align: Align,
    /// Relative width; 0: as wide as its content.
    width: u16,
}

impl Column {
    /// As wide as its content, left-aligned.
    pub(super) fn left(head: impl Into<Text>) -> Self {
        Self::wide(head, 0)
    }

    /// With a share of the width that the others leave, left-aligned.
    pub(super) fn wide(head: impl Into<Text>, width: u16) -> Self {
        Self::aligned(head, Align::Left, width)
    }

    /// As wide as its content, right-aligned: numbers.
    pub(super) fn right(head: impl Into<Text>) -> Self {
        Self::aligned(head, Align::Right, 0)
    }

    /// As wide as its content, centred: signs.
    pub(super) fn center(head: impl Into<Text>) -> Self {
        Self::aligned(head, Align::Center, 0)
    }

    fn aligned(head: impl Into<Text>, align: Align, width: u16) -> Self {
        let head = head.into();
        Self { head, align, width }
    }
}

/// A table of columns whose heads are phrases; `None` if it has no rows.
pub(super) fn table(
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

/// The sign of a sweep.
pub(super) fn arrow(sweep: Sweep) -> &'static str {
    match sweep {
        Sweep::Up => "↑",
        Sweep::Down => "↓",
        Sweep::Unknown => "",
    }
}
