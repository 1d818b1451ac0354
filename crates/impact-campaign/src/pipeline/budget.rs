//! `uncertainty_budget.csv`: what each source of uncertainty contributes to the joint estimate.

use impact_identification::identify::uncertainty::budget::{Budget, UncertaintySource};
use impact_report::kit::csv::Csv;

/// Name of the table.
pub const FILE: &str = "uncertainty_budget.csv";

/// A line for each source and parameter, then one for each parameter's sum.
pub(super) fn csv(budget: &Budget) -> String {
    let mut csv = Csv::new(&[
        "source",
        "item",
        "type",
        "standard_uncertainty",
        "degrees_of_freedom",
        "parameter",
        "sensitivity",
        "contribution",
        "coverage_factor",
        "expanded_uncertainty",
    ]);
    for row in &budget.rows {
        let kind = format!("{:?}", row.evaluation);
        for c in &row.contributions {
            csv.row()
                .texts(&[row.source.into(), &item(row.source), &kind])
                .numbers(&[row.standard_uncertainty, row.degrees_of_freedom])
                .texts(&[c.parameter.name()])
                .numbers(&[c.sensitivity, Some(c.uncertainty)]);
        }
    }
    for c in &budget.combined {
        let standard = Some(c.standard_uncertainty);
        csv.row()
            .texts(&["combined", "", ""])
            .numbers(&[standard, c.degrees_of_freedom])
            .texts(&[c.parameter.name()])
            .numbers(&[
                None,
                standard,
                Some(c.coverage_factor),
                Some(c.expanded_uncertainty),
            ]);
    }
    csv.finish()
}

/// Which of its kind a source is.
fn item(source: UncertaintySource) -> String {
    match source {
        UncertaintySource::Noise { method } => method.name().to_owned(),
        UncertaintySource::BetweenGroups { groups } => groups.to_string(),
        UncertaintySource::Stated {
            coordinate,
            clearance_m,
        } => {
            let at = clearance_m.map(|m| format!(" at {:.6} mm", 1e3 * m));
            coordinate.name().to_owned() + &at.unwrap_or_default()
        }
        _ => String::new(),
    }
}
