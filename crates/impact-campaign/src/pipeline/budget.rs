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
        for c in &row.contributions {
            csv.row().texts(&[
                row.source.into(),
                &item(row.source),
                &format!("{:?}", row.evaluation),
                &number(row.standard_uncertainty),
                &number(row.degrees_of_freedom),
                c.parameter.name(),
                &number(c.sensitivity),
                &number(Some(c.uncertainty)),
            ]);
        }
    }
    for c in &budget.combined {
        let standard = number(Some(c.standard_uncertainty));
        csv.row().texts(&[
            "combined",
            "",
            "",
            &standard,
            &number(c.degrees_of_freedom),
            c.parameter.name(),
            "",
            &standard,
            &format!("{:.6}", c.coverage_factor),
            &number(Some(c.expanded_uncertainty)),
        ]);
    }
    csv.finish()
}

/// A number with seven digits; nothing for one that is missing.
fn number(value: Option<f64>) -> String {
    value.map(|v| format!("{v:.6e}")).unwrap_or_default()
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
