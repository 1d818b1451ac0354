//! The tables of estimates: by method, by specimen, and how the methods agree.

use std::collections::BTreeMap;

use super::column::{Column, table};
use super::fitted::fitted;
use crate::content::ReportContent;
use crate::differences::p_value;
use crate::document::model::{Rich, Table};
use crate::document::verdict::headline;
use crate::locale::Locale;
use crate::parameters::{self, PARAMETERS, ParameterLook};
use crate::phrase::{Phrase, Text};
use impact_fit::{Method, MethodResult, ParameterSet};
use impact_identification::identify::diagnostics::agreement::LEVEL;

/// Size of the type of the methods' tables, points.
const SIZE: f64 = 7.5;

/// The columns of the estimates, as [`estimate_cells`] fills them.
fn estimate_columns() -> impl Iterator<Item = Column> {
    let symbols = ["$R$", "$f_0$", "$β$", "$x_st$"];
    symbols.into_iter().map(|symbol| Column::wide(symbol, 1))
}

/// The columns of a method, as [`method_row`] fills them.
fn method_columns() -> Vec<Column> {
    let mut columns = vec![Column::left(Phrase::Method)];
    columns.extend(estimate_columns());
    columns.extend([
        Column::right(Phrase::ObservationsShort),
        Column::right(Phrase::Residual),
        Column::center(Phrase::Fits),
    ]);
    columns
}

/// What each method found, and the joint estimate.
pub(crate) fn methods(content: &ReportContent, locale: Locale<'_>) -> Option<Table> {
    let id = &content.identification;
    let rows = method_rows(&id.methods, &id.joint, locale);
    let columns = method_columns();
    table(Phrase::TableMethods, columns, rows, locale).map(|t| Table { size: SIZE, ..t })
}

/// The same for each specimen of a campaign that holds several.
pub(crate) fn specimen_methods(content: &ReportContent, locale: Locale<'_>) -> Option<Table> {
    let specimens = content.identification.specimens.iter();
    let rows = specimens.flat_map(|(specimen, result)| {
        let rows = method_rows(&result.methods, &result.joint, locale);
        rows.into_iter().enumerate().map(move |(i, row)| {
            let name = if i == 0 {
                Rich::verbatim(specimen.clone())
            } else {
                Rich::default()
            };
            std::iter::once(name).chain(row).collect()
        })
    });
    let mut columns = vec![Column::left(Phrase::Specimen)];
    columns.extend(method_columns());
    let table = table(Phrase::TableMethods, columns, rows.collect(), locale)?;
    Some(fitted(Table {
        size: SIZE,
        ..table
    }))
}

/// The answer for each specimen of a campaign that holds several.
pub(crate) fn specimens(content: &ReportContent, locale: Locale<'_>) -> Option<Table> {
    let rows = content
        .identification
        .specimens
        .iter()
        .map(|(specimen, result)| {
            let mut row = vec![Rich::verbatim(specimen.clone())];
            row.extend(estimate_cells(&result.joint.parameters, locale));
            let headline = headline(result.verdict.kind, true);
            row.push(Rich::from(locale.translate(headline)));
            row
        });
    let mut columns = vec![Column::left(Phrase::Specimen)];
    columns.extend(estimate_columns());
    columns.push(Column::wide(Phrase::Verdict, 2));
    table("", columns, rows.collect(), locale).map(fitted)
}

/// A cell for each of the four parameters.
pub(super) fn estimate_cells(set: &ParameterSet, locale: Locale<'_>) -> Vec<Rich> {
    let cell = |look: &ParameterLook| {
        let estimate = set.get(look.parameter);
        Rich::from(parameters::short(look, estimate, locale))
    };
    PARAMETERS.iter().map(cell).collect()
}

/// Rows of the methods that have an estimate, the joint one last.
fn method_rows(
    methods: &BTreeMap<Method, MethodResult>,
    joint: &MethodResult,
    locale: Locale<'_>,
) -> Vec<Vec<Rich>> {
    let all = methods.iter().map(|(k, m)| (locale.message(k), m));
    let all = all.chain([(locale.translate(Phrase::JointTitle), joint)]);
    let says = |m: &MethodResult| {
        PARAMETERS
            .iter()
            .any(|p| m.parameters.get(p.parameter).is_some())
    };
    all.filter(|(_, m)| says(m))
        .map(|(name, m)| method_row(name, m, locale))
        .collect()
}

fn method_row(name: String, method: &MethodResult, locale: Locale<'_>) -> Vec<Rich> {
    let mut row = vec![Rich::from(name)];
    row.extend(estimate_cells(&method.parameters, locale));
    let observations = method.observations;
    let observations = if observations == 0 {
        "–".into()
    } else {
        observations.to_string()
    };
    let residual = method.reduced_residual;
    let residual = residual.map_or("–".into(), |r| locale.significant(r, 2));
    let fits = match method.fits {
        Some(true) => Phrase::Yes.into(),
        Some(false) => Phrase::No.into(),
        None => Text::from("–"),
    };
    row.extend([
        Rich::from(observations),
        Rich::from(residual),
        Rich::from(locale.text(&fits)),
    ]);
    row
}

/// Whether the methods agree, pair by pair.
pub(crate) fn agreement(content: &ReportContent, locale: Locale<'_>) -> Option<Table> {
    let pairs = &content.identification.agreement.pairs;
    let rows = pairs.iter().map(|pair| {
        let look = parameters::parameter(pair.parameter);
        let symbol = look.map_or(pair.parameter.name(), |p| p.symbol);
        vec![
            Rich::from(symbol),
            Rich::from(locale.message(&pair.methods[0])),
            Rich::from(locale.message(&pair.methods[1])),
            Rich::from(locale.fixed(pair.z_score, 2)),
            Rich::from(p_value(pair.p_value, locale)),
        ]
    });
    let columns = vec![
        Column::left(Phrase::Parameter),
        Column::wide(Phrase::Method, 1),
        Column::wide(Phrase::AndMethod, 1),
        Column::right(Phrase::DifferenceOverError),
        Column::right(Phrase::PValue),
    ];
    let (level, count) = (locale.fixed(LEVEL, 2), pairs.len().to_string());
    let values = [("level", level.as_str()), ("count", &count)];
    let caption = locale.translate_with(Phrase::TableAgreement, &values);
    table(caption, columns, rows.collect(), locale)
}
