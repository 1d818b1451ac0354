//! The table of measured brackets.

use super::column::{Column, arrow, table};
use crate::content::ReportContent;
use crate::document::model::{Rich, Table};
use crate::locale::Locale;
use crate::phrase::{Phrase, Text};
use impact_identification::replay::BracketRow;

/// From how many brackets on their table is set small and in two columns.
const MANY_BRACKETS: usize = 14;

/// The measured brackets beside the simulated boundary; many of them small and in two columns.
pub(crate) fn brackets(content: &ReportContent, locale: Locale<'_>) -> Option<Table> {
    let many = content.compared.brackets.len() > MANY_BRACKETS;
    let rows = content
        .compared
        .brackets
        .iter()
        .map(|b| bracket_row(b, many, locale))
        .collect();
    let unless_many = |head: Phrase| if many { Text::from("") } else { head.into() };
    let columns = vec![
        Column::left(unless_many(Phrase::Boundary)),
        Column::left("$z$"),
        Column::right("$r$ (mm)"),
        Column::right("$ρ$"),
        Column::center(unless_many(Phrase::Sweep)),
        Column::center((Phrase::MeasuredBetween, "Hz")),
        Column::right((Phrase::Simulated, "Hz")),
        Column::wide(unless_many(Phrase::Remark), 1),
    ];
    let caption = if many {
        Phrase::TableManyBrackets
    } else {
        Phrase::TableBrackets
    };
    let table = table(caption, columns, rows, locale)?;
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

fn bracket_row(b: &BracketRow, many: bool, locale: Locale<'_>) -> Vec<Rich> {
    let (low, high) = (b.frequency_low_hz, b.frequency_high_hz);
    vec![
        Rich::from(locale.message(&b.kind)),
        Rich::from(locale.motion(&b.motion)),
        Rich::from(locale.clearance(b.clearance_m)),
        Rich::from(b.rho.map_or("–".into(), |r| locale.fixed(r, 3))),
        Rich::from(arrow(b.sweep)),
        Rich::from(format!(
            "{} … {}",
            locale.fixed(low, 3),
            locale.fixed(high, 3)
        )),
        Rich::from(b.simulated_hz.map_or("–".into(), |f| locale.fixed(f, 3))),
        Rich::from(if many {
            bracket_sign(b).into()
        } else {
            bracket_remark(b, locale)
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

fn bracket_remark(b: &BracketRow, locale: Locale<'_>) -> String {
    let by = |phrase: Phrase, distance: f64| {
        locale.translate_with(phrase, &[("distance", &locale.fixed(distance, 3))])
    };
    let (low, high) = (b.frequency_low_hz, b.frequency_high_hz);
    match (&b.left_out, b.simulated_hz) {
        (Some(why), _) => {
            let why = locale.message(why);
            locale.translate_with(Phrase::NotUsedBecause, &[("why", &why)])
        }
        (None, Some(f)) if f < low => by(Phrase::BelowBy, low - f),
        (None, Some(f)) if f > high => by(Phrase::AboveBy, f - high),
        (None, Some(_)) => locale.translate(Phrase::Within),
        (None, None) => String::new(),
    }
}
