//! Many synthetic campaigns with random truths, noise and faults, identified like real ones: what
//! the intervals are worth, and whether mistakes of the laboratory are found.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use serde::Serialize;

use seen::Seen;

use impact_campaign::pipeline::table::Table;
use impact_campaign::pipeline::{PipelineError, Progress};
use impact_fit::Estimator;
use impact_fit::evidence::options::{IntervalMethod, UncertaintyOptions};
use impact_fit::evidence::{Evidence, Nominal};
use impact_fit::parameters::Parameters;
use impact_identification::identify::run::identify;
use impact_identification::identify::uncertainty::bound::bounds;
use impact_identification::identify::uncertainty::coverage::{
    Estimated, Score, Trial, all_estimates, scores,
};
use impact_identification::identify::{Identification, boundary_plan};
use impact_records::event::{DetectSettings, RigKind};
use impact_records::motion::{
    Bracket, ClassifySettings, Observation, brackets, observe, scale_drives,
};
use impact_records::record::Record;
use simulated_rig::run::calibrated;
use simulated_rig::{Laboratory, Reach, RigSpec, TrueMass, Truth, draw, records};

mod mistake;
mod seen;
mod tallies;

use mistake::Mistake;
use tallies::Statement;
pub use tallies::{MotionTally, Tallies, Tally};

/// What a coverage study finds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coverage {
    /// Campaigns of the main study.
    pub campaigns: usize,
    /// Seed of everything random.
    pub seed: u64,
    /// The rig: exact, realistic, or its effects with their strengths.
    pub rig: String,
    /// Every estimate of every campaign, as CSV.
    #[serde(skip)]
    pub estimates: String,
    /// Scores by method (`joint` among them) and name of the parameter.
    pub methods: BTreeMap<Estimator, BTreeMap<&'static str, Score>>,
    /// Campaigns in which nothing touches: how often R was called not identifiable, as it must.
    pub nothing_touches: Tally,
    /// Mistakes of the laboratory: how often each was found and named.
    pub mistakes: BTreeMap<&'static str, Tally>,
    /// What the campaigns without a mistake say otherwise.
    #[serde(flatten)]
    pub tallies: Tallies,
}

fn evidence<'a>(
    observations: &'a [Observation],
    brackets: &'a [Bracket],
    draw: &Laboratory,
) -> Evidence<'a> {
    Evidence {
        rig: RigKind::Double,
        observations,
        brackets,
        nominal: Nominal {
            gain_uncertainty: draw.faults.gain_deviation,
            corner_uncertainty: draw.faults.corner_deviation,
            clearance_uncertainty_m: draw.clearance_uncertainty_m.unwrap_or(0.0),
            ..Nominal::default()
        },
        // Nobody reads profiles of hundreds of campaigns.
        uncertainty: UncertaintyOptions {
            intervals: IntervalMethod::Covariance,
            ..UncertaintyOptions::default()
        },
        progress: None,
    }
}

/// Simulate, observe and identify a campaign, with a mistake or without.
fn campaign(draw: &Laboratory, mistake: Option<Mistake>) -> Result<Seen, PipelineError> {
    let Some(mistake) = mistake else {
        return spoilt(draw, |_| ());
    };
    let draw = mistake.stated(draw);
    let uncertainty_m = draw.clearance_uncertainty_m.unwrap_or(0.0);
    spoilt(&draw, |records| mistake.commit(records, uncertainty_m))
}

/// Simulate a campaign, change its records, observe and identify it.
fn spoilt(draw: &Laboratory, change: impl Fn(&mut [Record])) -> Result<Seen, PipelineError> {
    seen(draw, change, identify)
}

/// Simulate and observe a campaign, and identify R from its boundaries alone.
fn boundaries_alone(draw: &Laboratory) -> Result<Seen, PipelineError> {
    let identify = |evidence: &Evidence<'_>| Identification {
        methods: boundary_plan::restitution(evidence).into_iter().collect(),
        ..Identification::default()
    };
    seen(draw, |_| (), identify)
}

fn seen(
    draw: &Laboratory,
    change: impl Fn(&mut [Record]),
    identify: impl Fn(&Evidence<'_>) -> Identification,
) -> Result<Seen, PipelineError> {
    let raw = records(draw)?;
    let mut records: Vec<Record> = raw
        .iter()
        .map(|r| calibrated(r, &draw.truth, &draw.faults))
        .collect();
    change(&mut records);
    let motions = raw.into_iter().map(|r| r.motion).collect();
    let mut observations: Vec<Observation> = records
        .into_par_iter()
        .map(|mut record| {
            let found = impact_records::record::consistency::inspect(&record);
            record.flags.extend(found);
            let (detect, classify) = (DetectSettings::default(), ClassifySettings::default());
            observe(&record, RigKind::Double, &detect, &classify)
        })
        .collect();
    scale_drives(&mut observations);
    let brackets = brackets(&observations);
    let outcome = identify(&evidence(&observations, &brackets, draw));
    Ok(Seen {
        motions,
        observations,
        brackets,
        outcome,
    })
}

/// Simulate, observe and identify a campaign without a mistake.
///
/// # Errors
/// Where the simulation refuses its parameters.
pub(super) fn identified(draw: &Laboratory) -> Result<Identification, PipelineError> {
    Ok(campaign(draw, None)?.outcome)
}

/// What a campaign contributes to the scores.
fn trial(seen: &Seen, draw: &Laboratory) -> Trial {
    let truth = parameters(&draw.truth);
    let bounds = bounds(&evidence(&seen.observations, &seen.brackets, draw), &truth);
    Trial::new(truth, &seen.outcome.joint, &seen.outcome.methods, bounds)
}

fn parameters(truth: &Truth) -> Parameters {
    let [x, y] = truth.masses;
    let asymmetry = |of: fn(&TrueMass) -> f64| (of(&x) / of(&y)).ln();
    Parameters {
        drive_asymmetry: asymmetry(|m| m.force_n / m.mass_kg),
        stiffness_asymmetry: asymmetry(|m| m.stiffness_n_m / m.mass_kg),
        damping_asymmetry: asymmetry(|m| m.dashpot_n_s_m / m.mass_kg),
        mass_asymmetry: asymmetry(|m| m.mass_kg),
        ..Parameters::symmetric(
            truth.restitution,
            truth.natural_frequency_hz(),
            truth.damping_ratio(),
            truth.static_deflection_m(),
        )
    }
}

/// What a study simulates.
#[derive(Debug, Clone)]
pub struct CoveragePlan {
    /// Number of campaigns.
    pub campaigns: usize,
    /// Number of further campaigns for each mistake.
    pub mistakes: usize,
    /// Seed of everything random.
    pub seed: u64,
    /// Effects of the rig.
    pub rig: RigSpec,
    /// Step of the sweeps past the end of z = 1 as a share of f0; `None`: campaigns of every motion.
    pub step: Option<f64>,
}

/// Run a study.
///
/// # Errors
/// Where a simulation refuses its parameters.
pub fn study(plan: &CoveragePlan, progress: Progress<'_>) -> Result<Coverage, PipelineError> {
    let CoveragePlan {
        campaigns,
        mistakes: few,
        seed,
        ref rig,
        step: of_f0,
    } = *plan;
    let total = (campaigns + few * (1 + Mistake::ALL.len())) as u64;
    let done = AtomicU64::new(0);
    let step = || {
        progress("campaigns", done.fetch_add(1, Ordering::Relaxed) + 1, total);
    };
    let main: Vec<(Statement, Trial)> = (0..campaigns as u64)
        .into_par_iter()
        .map(|i| {
            let whole = draw(seed, i, Reach::Full, rig);
            let (seen, trial) = match of_f0 {
                Some(share) => {
                    let draw = whole.with_step(share, rig);
                    let seen = boundaries_alone(&draw)?;
                    let (truth, found) = (parameters(&draw.truth), &seen.outcome);
                    let trial = Trial::new(truth, &found.joint, &found.methods, BTreeMap::new());
                    (seen, trial)
                }
                None => {
                    let seen = campaign(&whole, None)?;
                    let trial = trial(&seen, &whole);
                    (seen, trial)
                }
            };
            step();
            Ok((Statement::of(&seen), trial))
        })
        .collect::<Result<_, PipelineError>>()?;
    let (statements, trials): (Vec<Statement>, Vec<Trial>) = main.into_iter().unzip();
    let count = |reach: Reach, mistake: Option<Mistake>, named: &(dyn Fn(&Seen) -> bool + Sync)| {
        let found: Vec<bool> = (0..few as u64)
            .into_par_iter()
            .map(|i| {
                let seen = campaign(&draw(seed ^ 0x00FA_0175, i, reach, rig), mistake)?;
                step();
                Ok(named(&seen))
            })
            .collect::<Result<_, PipelineError>>()?;
        Ok::<Tally, PipelineError>(Tally::count(found))
    };
    let nothing_touches = count(Reach::NothingTouches, None, &|seen| {
        let r = seen.outcome.joint.parameters.restitution.as_ref();
        r.is_none_or(|r| r.value.is_none())
    })?;
    let mut mistakes = BTreeMap::new();
    for &mistake in Mistake::ALL {
        let tally = count(Reach::Full, Some(mistake), &|seen| {
            mistake.is_named_by(seen)
        })?;
        mistakes.insert(mistake.name(), tally);
    }
    Ok(Coverage {
        campaigns,
        seed,
        rig: rig.to_string(),
        methods: scores(&trials),
        estimates: table(&all_estimates(&trials)).csv(),
        nothing_touches,
        mistakes,
        tallies: Tallies::of(&statements),
    })
}

/// A line for each estimate; of R interval and bound are absolute, of the others relative.
fn table(all: &[Estimated]) -> Table {
    let low_and_high = |i: usize| all.iter().map(move |e| e.interval95.map(|ends| ends[i]));
    Table::new()
        .counts("campaign", all.iter().map(|e| e.campaign))
        .texts("method", all.iter().map(|e| e.estimator.name()))
        .texts("parameter", all.iter().map(|e| e.coordinate.name()))
        .numbers("truth", all.iter().map(|e| e.truth))
        .missing("value", all.iter().map(|e| e.value))
        .missing("interval_low", low_and_high(0))
        .missing("interval_high", low_and_high(1))
        .missing("bound", all.iter().map(|e| e.bound))
}

#[cfg(test)]
mod tests {
    use super::mistake::widen_one_gap;
    use super::*;
    use impact_fit::{Finding, Method};

    /// The clearance as stated and as it fits of a gap that alone is named, m.
    fn named_gap(seen: &Seen) -> (f64, f64) {
        match seen.outcome.suspicions[..] {
            [
                Finding::WrongClearance {
                    stated_m,
                    fitting_m,
                    ..
                },
            ] => (stated_m, fitting_m),
            _ => panic!("{:?}", seen.outcome.suspicions),
        }
    }

    #[test]
    fn valid_a_gap_that_is_a_seventh_of_the_deflection_off_is_named_alone_with_its_true_value() {
        let rig = "exact".parse().expect("a rig");
        let draw = draw(0x00FA_0175 ^ 14_001, 11, Reach::Full, &rig);
        let seen = campaign(&draw, Some(Mistake::WrongClearance)).expect("a campaign");
        let (stated_m, fitting_m) = named_gap(&seen);
        assert!(draw.truth.static_deflection_m() < 7.0 * 0.05e-3);
        assert!((stated_m - 0.05e-3 - fitting_m).abs() < 1e-7, "{fitting_m}");
    }

    #[test]
    fn valid_a_gap_a_few_micrometres_off_is_named_where_no_uncertainty_is_stated() {
        let rig = "exact".parse().expect("a rig");
        let draw = draw(0x00FA_0175 ^ 14_001, 11, Reach::Full, &rig);
        assert_eq!(draw.clearance_uncertainty_m, None);
        let seen = spoilt(&draw, |records| widen_one_gap(records, 4e-6)).expect("a campaign");
        let (stated_m, fitting_m) = named_gap(&seen);
        assert!(
            (stated_m - 4e-6 - fitting_m).abs() < 2e-7,
            "{stated_m} {fitting_m}"
        );
    }

    #[test]
    fn regress_a_record_that_a_fit_pulls_onto_its_saddle_node_is_left_out() {
        let rig = "realistic".parse().expect("a rig");
        let draw = draw(61_001, 145, Reach::Full, &rig);
        let found = identified(&draw).expect("a campaign");
        let trajectories = &found.methods[&Method::Trajectories].parameters;
        let estimate = trajectories.restitution.as_ref().expect("R");
        assert_ne!(estimate.note, Some(impact_fit::Note::NotSeparable));
        let value = estimate
            .value
            .unwrap_or_else(|| panic!("{:?}", estimate.note));
        assert!((value - draw.truth.restitution).abs() < 1e-3, "{value}");
    }
}
