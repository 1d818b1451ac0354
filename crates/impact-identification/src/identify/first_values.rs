//! Where fits start, and what a part of a campaign tells by itself.

use std::collections::BTreeMap;

use impact_fit::evidence::Evidence;
use impact_fit::methods::fit::FitResult;
use impact_fit::methods::fits::Fits;
use impact_fit::methods::identifier::Identifier;
use impact_fit::methods::impacts::{self, Impacts, block::ImpactBlock};
use impact_fit::methods::registry::REGISTRY;
use impact_fit::methods::resonance::Resonance;
use impact_fit::methods::selection::Selection;
use impact_fit::methods::trajectories::Trajectories;
use impact_fit::parameters::{Coordinate, Parameters};
use impact_fit::statistics::scatter::Spread;
use impact_records::motion::Observation;

/// First values: those of the resonance curve, with R of the speeds at impacts.
pub(super) fn first_values(selection: &Selection<'_>, resonance: Option<FitResult>) -> Fits {
    let (blocks, nominal) = (&selection.blocks, &selection.evidence.nominal);
    let begin = start(selection.evidence, resonance.as_ref());
    let impacts = impacts::fit::from(blocks, nominal, begin);
    let mut found = Fits::new(with_restitution(begin, &impacts, &blocks.impact));
    found.set(Resonance.method(), resonance);
    found.set(Impacts.method(), impacts);
    found
}

/// Where waveforms start but for R: the resonance curve's, else the stated values, else guesses of scale.
pub(super) fn start(evidence: &Evidence<'_>, resonance: Option<&FitResult>) -> Parameters {
    if let Some(Ok(found)) = resonance {
        return found.fit.parameters;
    }
    let nominal = &evidence.nominal;
    let frequencies: Vec<f64> = evidence
        .observations
        .iter()
        .filter_map(Observation::frequency_hz)
        .collect();
    let clearances: Vec<f64> = evidence
        .observations
        .iter()
        .filter_map(|o| o.setting.clearance_m)
        .collect();
    let median =
        |v: &[f64], default: f64| impact_records::signal::robust::median(v).unwrap_or(default);
    nominal.applied(Parameters::symmetric(
        nominal.restitution.unwrap_or(0.8),
        nominal
            .natural_frequency_hz
            .unwrap_or_else(|| median(&frequencies, 10.0) / 1.2),
        nominal.damping_ratio.unwrap_or(0.05),
        nominal
            .static_deflection_m
            .unwrap_or_else(|| median(&clearances, 1e-3).abs() / 2.0),
    ))
}

/// R as the impacts tell it, if only by ratios that give a first value.
fn with_restitution(
    start: Parameters,
    impacts: &Option<FitResult>,
    block: &ImpactBlock,
) -> Parameters {
    let told = impacts.as_ref().and_then(|i| i.as_ref().ok());
    let told = told.map(|found| found.fit.parameters.restitution);
    let told = told.or(block
        .typical_ratio()
        .filter(|_| block.first_value_only.is_some()));
    match told {
        Some(restitution) => Parameters {
            restitution: restitution.clamp(0.0, 1.0),
            ..start
        },
        None => start,
    }
}

/// What waveforms, resonance curve and impacts of some records alone tell of each parameter, the first of
/// them that tells it: the coordinate and how far it may be off; `None` where nothing does.
pub(super) fn part_alone(
    evidence: &Evidence<'_>,
    within: &dyn Fn(usize) -> bool,
) -> Option<BTreeMap<Coordinate, (f64, Spread)>> {
    let indexed = evidence.observations.iter().enumerate();
    let observations: Vec<Observation> = indexed
        .filter(|(i, _)| within(*i))
        .map(|(_, o)| o.clone())
        .collect();
    let evidence = Evidence {
        observations: &observations,
        brackets: &[],
        ..*evidence
    };
    let mut selection = Selection::new(&evidence);
    let resonance = selection.fit_resonance();
    let mut found = first_values(&selection, resonance);
    Trajectories.fit(&mut selection, &mut found);
    let mut told = BTreeMap::new();
    for found in REGISTRY.iter().filter_map(|of| found.of(of.method())) {
        for (_, parameter) in found.fit.estimated() {
            let value = found.fit.parameters.coordinate(parameter);
            if let Some(spread) = found.spread(parameter) {
                told.entry(parameter).or_insert((value, spread));
            }
        }
    }
    (!told.is_empty()).then_some(told)
}
