//! The tables of campaigns compared: their estimates, the differences, what they share.

use super::column::{Column, table};
use super::estimates::estimate_cells;
use crate::differences::PrintedDifference;
use crate::document::model::{Rich, Table};
use crate::document::verdict::headline;
use crate::figures::correlation::name;
use crate::locale::Locale;
use crate::parameters;
use crate::phrase::Phrase;
use impact_fit::parameters::Coordinate;
use impact_identification::compare::{AcrossCampaigns, Comparison, Difference};
use impact_records::message::Message;

/// The campaigns with their joint estimates.
pub(crate) fn campaigns(comparison: &Comparison, locale: Locale<'_>) -> Option<Table> {
    let rows = comparison.campaigns.iter().enumerate().map(|(i, c)| {
        let mut row = vec![
            Rich::from((i + 1).to_string()),
            Rich::verbatim(c.name.clone()),
            Rich::verbatim(c.measured.clone().unwrap_or_default()),
        ];
        row.extend(estimate_cells(&c.parameters, locale));
        row.push(Rich::from(locale.translate(headline(c.verdict, true))));
        row
    });
    let columns = vec![
        Column::right(""),
        Column::wide(Phrase::Campaign, 2),
        Column::left(Phrase::Measured),
        Column::left("$R$"),
        Column::left("$f_0$"),
        Column::left("$β$"),
        Column::left("$x_{st}$"),
        Column::wide(Phrase::Verdict, 2),
    ];
    let table = table(Phrase::TableCampaigns, columns, rows.collect(), locale)?;
    Some(Table { size: 7.5, ..table })
}

/// The differences from the first campaign.
pub(crate) fn differences(comparison: &Comparison, locale: Locale<'_>) -> Option<Table> {
    let rows = comparison.differences.iter().map(|d| row(d, locale));
    let columns = vec![
        Column::right(Phrase::Campaign),
        Column::left(Phrase::Parameter),
        Column::right(Phrase::DifferenceOf),
        Column::right(Phrase::RelativeDifference),
        Column::right(Phrase::IfNothingWereShared),
        Column::right(Phrase::DegreesOfFreedom),
        Column::right(Phrase::PValue),
    ];
    table(Phrase::TableDifferences, columns, rows.collect(), locale)
}

fn row(d: &Difference, locale: Locale<'_>) -> Vec<Rich> {
    let Some(printed) = PrintedDifference::of(d, locale) else {
        return vec![Rich::default(); 7];
    };
    let [relative, low, high] = d.relative.map(|r| 100.0 * r);
    let relative_half = 0.5 * (high - low);
    let few = parameters::decimals_for(relative_half);
    let relative = format!(
        "{} ± {} %",
        locale.fixed(relative, few),
        locale.fixed(relative_half, few)
    );
    let freedom = d.degrees_of_freedom.filter(|n| *n < 1000.0);
    [
        printed.campaign,
        printed.parameter.to_owned(),
        printed.value,
        relative,
        printed.independent,
        freedom.map_or("∞".into(), |n| locale.fixed(n, 0)),
        printed.p_value,
    ]
    .map(Rich::from)
    .to_vec()
}

/// What is one unknown of several campaigns.
pub(crate) fn shared(comparison: &Comparison, locale: Locale<'_>) -> Option<Table> {
    nuisances(Phrase::TableShared, &comparison.shared, locale)
}

/// What two campaigns do not share although something suggests it.
pub(crate) fn separate(comparison: &Comparison, locale: Locale<'_>) -> Option<Table> {
    nuisances(Phrase::TableNotShared, &comparison.separate, locale)
}

fn nuisances<Why: Message>(
    caption: Phrase,
    all: &[AcrossCampaigns<Why>],
    locale: Locale<'_>,
) -> Option<Table> {
    let columns = vec![
        Column::wide(Phrase::UncertaintySource, 3),
        Column::left(Phrase::SharedBy),
        Column::wide(Phrase::Why, 4),
    ];
    let rows = all.iter().map(|n| {
        vec![
            Rich::from(nuisance(n.coordinate, n.clearance_m, locale)),
            Rich::from(numbers(&n.campaigns)),
            Rich::from(locale.message(&n.why)),
        ]
    });
    table(caption, columns, rows.collect(), locale)
}

/// Campaigns by their numbers from 1.
fn numbers(campaigns: &[usize]) -> String {
    let each: Vec<String> = campaigns.iter().map(|c| (c + 1).to_string()).collect();
    each.join(", ")
}

fn nuisance(coordinate: Coordinate, clearance_m: Option<f64>, locale: Locale<'_>) -> String {
    match clearance_m {
        Some(m) => {
            let clearance = locale.significant(1e3 * m, 4);
            locale.translate_with(Phrase::StatedClearance, &[("clearance", &clearance)])
        }
        None => name(coordinate, locale),
    }
}
