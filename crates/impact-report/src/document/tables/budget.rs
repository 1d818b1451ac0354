//! The uncertainty budget of the joint estimate.

use super::column::{Column, table};
use crate::content::ReportContent;
use crate::document::model::{Rich, Table};
use crate::figures::correlation::name;
use crate::kit::richtext::plain;
use crate::locale::Locale;
use crate::parameters::{PARAMETERS, ParameterLook, decimals_for};
use crate::phrase::Phrase;
use impact_fit::parameters::Coordinate;
use impact_identification::identify::uncertainty::budget::{
    Budget, Combined, Contribution, Row, UncertaintySource,
};

/// Size of the table's type, points.
const SIZE: f64 = 7.5;
/// Least share of a parameter's variance from which a source has a row of its own.
const LEAST_SHARE: f64 = 0.01;
/// Degrees of freedom below which a tenth shows in the coverage factor.
const FEW: f64 = 10.0;
/// More degrees of freedom than this are printed as infinitely many.
const MANY: f64 = 1e4;

/// A row for each source that matters, one for all others, and what they amount to.
pub(crate) fn budget(content: &ReportContent, locale: Locale<'_>) -> Option<Table> {
    let budget = &content.identification.uncertainty.budget;
    if budget.rows.is_empty() {
        return None;
    }
    let units = Units::of(content);
    let (mut main, minor): (Vec<&Row>, Vec<&Row>) =
        budget.rows.iter().partition(|row| matters(row, budget));
    main.sort_by(|a, b| greatest_share(b, budget).total_cmp(&greatest_share(a, budget)));
    let mut rows: Vec<Vec<Rich>> = main
        .iter()
        .map(|row| source_row(row, &units, locale))
        .collect();
    if !minor.is_empty() {
        rows.push(others(&minor, &units, locale));
    }
    rows.extend(sums(budget, &units, locale));
    let columns = [
        Column::wide(Phrase::UncertaintySource, 1),
        Column::center(Phrase::EvaluationType),
        Column::right(Phrase::StandardUncertainty),
    ];
    let columns = columns.into_iter().chain(units.columns());
    let columns = columns
        .chain([Column::right(Phrase::DegreesOfFreedom)])
        .collect();
    table(Phrase::UncertaintyBudget, columns, rows, locale).map(|t| Table { size: SIZE, ..t })
}

/// The units in which the contributions to the parameters are printed, and with how many decimals.
struct Units(Vec<(&'static ParameterLook, f64, usize)>);

impl Units {
    /// Those in which the joint estimate is printed: a contribution to R is absolute, to the others relative.
    fn of(content: &ReportContent) -> Self {
        let id = &content.identification;
        let combined = &id.uncertainty.budget.combined;
        let unit = |look: &'static ParameterLook| {
            let value = id
                .joint
                .parameters
                .get(look.parameter)
                .and_then(|e| e.value);
            let factor = match look.parameter {
                Coordinate::Restitution => 1.0,
                _ => look.factor * value.unwrap_or(f64::NAN).abs(),
            };
            let sum = combined.iter().find(|c| c.parameter == look.parameter);
            let size = sum.map_or(f64::NAN, |c| factor * c.standard_uncertainty);
            (look, factor, decimals_for(size) + 1)
        };
        Self(PARAMETERS.iter().map(unit).collect())
    }

    fn columns(&self) -> impl Iterator<Item = Column> {
        self.0.iter().map(|(look, ..)| match look.unit {
            "" => Column::right(look.symbol),
            unit => Column::right(format!("{} ({unit})", look.symbol)),
        })
    }

    /// What is known of each parameter, in its unit.
    fn cells(&self, of: impl Fn(Coordinate) -> Option<f64>, locale: Locale<'_>) -> Vec<Rich> {
        let cell = |(look, factor, decimals): &(&ParameterLook, f64, usize)| {
            let size = of(look.parameter).map(|u| u * factor);
            let size = size.filter(|u| u.is_finite());
            Rich::from(size.map_or("–".into(), |u| locale.fixed(u, *decimals)))
        };
        self.0.iter().map(cell).collect()
    }
}

fn matters(row: &Row, budget: &Budget) -> bool {
    greatest_share(row, budget) >= LEAST_SHARE
}

/// The greatest share that a source has in the variance of a parameter.
fn greatest_share(row: &Row, budget: &Budget) -> f64 {
    let share = |c: &Combined| {
        let own = contribution(row, c.parameter).unwrap_or(0.0);
        (own / c.standard_uncertainty).powi(2)
    };
    budget.combined.iter().map(share).fold(0.0, f64::max)
}

fn contribution(row: &Row, parameter: Coordinate) -> Option<f64> {
    let mut all = row.contributions.iter();
    all.find(|c| c.parameter == parameter)
        .map(|c: &Contribution| c.uncertainty)
}

fn source_row(row: &Row, units: &Units, locale: Locale<'_>) -> Vec<Rich> {
    let mut cells = vec![
        Rich::from(source(row.source, locale)),
        Rich::from(format!("{:?}", row.evaluation)),
        Rich::from(stated(row, locale)),
    ];
    cells.extend(units.cells(|c| contribution(row, c), locale));
    cells.push(Rich::from(freedom(row.degrees_of_freedom, locale)));
    cells
}

fn source(source: UncertaintySource, locale: Locale<'_>) -> String {
    match source {
        UncertaintySource::Noise { method } => {
            let method = locale.message(&method);
            locale.translate_with(Phrase::NoiseOf, &[("method", &method)])
        }
        UncertaintySource::BetweenGroups { groups } => locale.translate_with(
            Phrase::ScatterBetweenGroups,
            &[("count", &groups.to_string())],
        ),
        UncertaintySource::Stated {
            clearance_m: Some(m),
            ..
        } => {
            let clearance = locale.clearance(m);
            locale.translate_with(Phrase::StatedClearance, &[("clearance", &clearance)])
        }
        UncertaintySource::Stated { coordinate, .. } => name(coordinate, locale),
        UncertaintySource::FirstOrder => locale.translate(Phrase::BeyondFirstOrder),
        UncertaintySource::SharedGains => locale.translate(Phrase::SharedGains),
        UncertaintySource::RestitutionOverSpeed => locale.translate(Phrase::ChangeOverSpeed),
        UncertaintySource::BetweenMethods => locale.translate(Phrase::DisagreementOfMethods),
        UncertaintySource::Clock => locale.translate(Phrase::ClockOfSampler),
        UncertaintySource::InstrumentOff => locale.translate(Phrase::InstrumentThatIsOff),
    }
}

/// The name of a source of uncertainty, without markup.
pub fn budget_source(of: UncertaintySource, locale: Locale<'_>) -> String {
    plain(&source(of, locale))
}

/// The standard uncertainty of a source in its own unit.
fn stated(row: &Row, locale: Locale<'_>) -> String {
    let Some(u) = row.standard_uncertainty else {
        return "–".into();
    };
    let coordinate = match row.source {
        UncertaintySource::Stated { coordinate, .. } => coordinate,
        UncertaintySource::Clock => return format!("{} ppm", locale.significant(1e6 * u, 2)),
        _ => return "–".into(),
    };
    let (factor, unit) = match coordinate {
        Coordinate::ScrewZero | Coordinate::Gap(_) => (1e3, "µm"),
        Coordinate::Delay(_) => (1.0, "ms"),
        Coordinate::Effect(effect) => (effect.unit().factor(), effect.unit().symbol()),
        _ => (1e2, "%"),
    };
    format!("{} {unit}", locale.significant(factor * u, 2))
}

fn freedom(freedom: Option<f64>, locale: Locale<'_>) -> String {
    let few = freedom.filter(|n| *n < MANY);
    let places = |n: f64| usize::from(n < FEW);
    few.map_or("∞".into(), |n| locale.fixed(n, places(n)))
}

/// The sources that matter little, together.
fn others(minor: &[&Row], units: &Units, locale: Locale<'_>) -> Vec<Rich> {
    let count = minor.len().to_string();
    let together = |c: Coordinate| {
        let squares = minor.iter().filter_map(|row| contribution(row, c));
        let sum: f64 = squares.map(|u| u * u).sum();
        Some(sum.sqrt())
    };
    let mut cells = vec![
        Rich::from(locale.translate_with(Phrase::FurtherSources, &[("count", &count)])),
        Rich::from("A, B"),
        Rich::from("–"),
    ];
    cells.extend(units.cells(together, locale));
    cells.push(Rich::from("–"));
    cells
}

/// Combined standard uncertainty, degrees of freedom, coverage factor, expanded uncertainty.
fn sums(budget: &Budget, units: &Units, locale: Locale<'_>) -> [Vec<Rich>; 4] {
    let of = |c: Coordinate| budget.combined.iter().find(|sum| sum.parameter == c);
    let line = |name: Phrase, cells: Vec<Rich>| {
        let head = [locale.translate(name), String::new(), "–".into()];
        let mut row: Vec<Rich> = head.into_iter().map(Rich::from).collect();
        row.extend(cells);
        row.push(Rich::from("–"));
        row
    };
    let texts = |text: &dyn Fn(&Combined) -> String| {
        let cell = |c| Rich::from(of(c).map_or("–".into(), text));
        Coordinate::PHYSICAL.into_iter().map(cell).collect()
    };
    [
        line(
            Phrase::CombinedUncertainty,
            units.cells(|c| of(c).map(|sum| sum.standard_uncertainty), locale),
        ),
        line(
            Phrase::EffectiveDegreesOfFreedom,
            texts(&|sum| freedom(sum.degrees_of_freedom, locale)),
        ),
        line(
            Phrase::CoverageFactor,
            texts(&|sum| locale.fixed(sum.coverage_factor, 2)),
        ),
        line(
            Phrase::ExpandedUncertainty,
            units.cells(|c| of(c).map(|sum| sum.expanded_uncertainty), locale),
        ),
    ]
}
