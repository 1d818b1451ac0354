//! Pairs of synthetic campaigns on one rig, between which R may have changed: how often the interval of
//! a difference holds the truth, and how much narrower it is for what both share.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;

use crate::coverage::{Tally, identified};
use impact_campaign::pipeline::{PipelineError, Progress};
use impact_fit::GAIN_ROLES;
use impact_fit::parameters::Coordinate;
use impact_identification::compare::{self, Campaign, Common, Comparison, ComparisonOutcome};
use impact_identification::identify::Identification;
use impact_records::event::{FlightKind, RigKind};
use impact_records::record::calibrate::{ChannelKey, ChannelSetup};
use impact_records::signal::robust;
use simulated_rig::{Faults, Laboratory, Reach, RigSpec, Truth, draw};

/// What a study of pairs simulates.
#[derive(Debug, Clone)]
pub struct PairsPlan {
    /// Number of pairs.
    pub pairs: usize,
    /// Records of each campaign.
    pub records: usize,
    /// Seed of everything random.
    pub seed: u64,
    /// The rig's effects beyond the model.
    pub rig: RigSpec,
    /// Its instruments, as far as they are not drawn.
    pub instruments: Instruments,
}

/// What is set of the instruments of all rigs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Instruments {
    /// Noise of every channel, V; the converter then rounds nothing.
    pub noise_v: Option<f64>,
    /// Standard deviation of the gain errors, relative.
    pub gain_deviation: Option<f64>,
}

impl Instruments {
    /// Put them into a rig's faults.
    fn apply(self, faults: &mut Faults) {
        if let Some(noise_v) = self.noise_v {
            faults.noise_v = noise_v;
            faults.converter_bits = None;
        }
        if let Some(deviation) = self.gain_deviation {
            faults.gain_deviation = deviation;
        }
    }
}

/// How the differences of one parameter came out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct PairScore {
    /// Pairs that gave a difference.
    pub pairs: usize,
    /// Root-mean-square error: of R absolute, of the others relative.
    pub rms_error: f64,
    /// Share of the 95 % intervals that hold the true difference.
    pub coverage95: f64,
    /// The same of the intervals as they would be if nothing were shared.
    pub independent_coverage95: f64,
    /// Median of half the interval: of R absolute, of the others relative.
    pub half_width: f64,
    /// Median ratio of the interval's width if nothing were shared to that with sharing.
    pub width_ratio: f64,
}

/// What a study of pairs finds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Pairs {
    /// Number of pairs.
    pub pairs: usize,
    /// Records of each campaign.
    pub records: usize,
    /// Seed.
    pub seed: u64,
    /// The rig.
    pub rig: String,
    /// What was set of the instruments.
    pub instruments: Instruments,
    /// By parameter.
    pub parameters: BTreeMap<String, PairScore>,
    /// Pairs in which nothing changed: how often something was said to have (5 % of them at most).
    pub false_alarms: Tally,
    /// Pairs in which R changed: how often a change was found.
    pub changes_found: Tally,
    /// Pairs that could not be compared.
    pub refused: usize,
}

/// Greatest change of R, and of f0, β and `x_st` relative, in the pairs in which something changes.
const CHANGES: [f64; 4] = [0.05, 0.01, 0.1, 0.03];

/// Two campaigns with their truths.
struct Pair {
    truths: [Truth; 2],
    /// Whether the second's parameters differ.
    changed: bool,
    comparison: Option<Comparison>,
}

/// Simulate, identify and compare pairs; in every second one nothing changes.
///
/// # Errors
/// Where a simulation refuses its parameters.
pub fn study(plan: &PairsPlan, progress: Progress<'_>) -> Result<Pairs, PipelineError> {
    let done = AtomicU64::new(0);
    let pairs: Vec<Pair> = (0..plan.pairs as u64)
        .into_par_iter()
        .map(|index| {
            let found = pair(plan, index)?;
            let count = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress("pairs", count, plan.pairs as u64);
            Ok(found)
        })
        .collect::<Result<_, PipelineError>>()?;
    let parameters = Coordinate::PHYSICAL.into_iter();
    let scores = parameters.map(|p| (p.name().to_owned(), score(&pairs, p)));
    let tally = |changed: bool| {
        let chosen = pairs.iter().filter(|p| p.changed == changed);
        let outcomes = chosen.filter_map(|p| Some(p.comparison.as_ref()?.outcome()));
        let decided = outcomes.filter(|o| *o != ComparisonOutcome::Undetermined);
        let said: Vec<bool> = decided
            .map(|o| o != ComparisonOutcome::NothingChanged)
            .collect();
        Tally {
            found: said.iter().filter(|c| **c).count(),
            of: said.len(),
        }
    };
    Ok(Pairs {
        pairs: plan.pairs,
        records: plan.records,
        seed: plan.seed,
        rig: plan.rig.to_string(),
        instruments: plan.instruments,
        parameters: scores.collect(),
        false_alarms: tally(false),
        changes_found: tally(true),
        refused: pairs.iter().filter(|p| p.comparison.is_none()).count(),
    })
}

fn pair(plan: &PairsPlan, index: u64) -> Result<Pair, PipelineError> {
    let first = draw(plan.seed, index, Reach::Full, &plan.rig);
    let mut first = first.with_records(plan.records, &plan.rig);
    plan.instruments.apply(&mut first.faults);
    let changed = index % 2 == 1;
    let mut rng = ChaCha8Rng::seed_from_u64(plan.seed ^ 0x0DD5);
    rng.set_stream(index);
    let seed = rng.random();
    let truth = if changed {
        changed_truth(&first.truth, &mut rng)
    } else {
        first.truth.clone()
    };
    let second = first.again(truth, seed);
    let campaigns = [(&first, 0), (&second, 1)].map(|(draw, number)| {
        let found = identified(draw)?;
        Ok::<_, PipelineError>(campaign(draw, number, found))
    });
    let [before, after] = campaigns;
    Ok(Pair {
        changed,
        comparison: compare::compare(&[before?, after?]).ok(),
        truths: [first.truth, second.truth],
    })
}

fn changed_truth(truth: &Truth, rng: &mut ChaCha8Rng) -> Truth {
    let [r, f, b, x] = CHANGES.map(|most| rng.random_range(-most..most));
    let changed = truth.with_means(
        truth.natural_frequency_hz() * (1.0 + f),
        truth.damping_ratio() * (1.0 + b),
        truth.static_deflection_m() * (1.0 + x),
    );
    Truth {
        restitution: (truth.restitution + r).min(0.97),
        ..changed
    }
}

/// A simulated campaign as the laboratory would state it.
fn campaign(draw: &Laboratory, number: usize, found: Identification) -> Campaign {
    let channel = |role| ChannelSetup {
        instrument: Some(format!("simulated, no. {}", draw.rig_seed)),
        high_pass_hz: draw.faults.high_pass_hz,
        ..ChannelSetup::plain(role, ChannelKey::Index(0))
    };
    Campaign {
        name: (number + 1).to_string(),
        measurement: number,
        machine: RigKind::Double,
        flight: FlightKind::Harmonic,
        measured: None,
        synthetic: true,
        verdict: found.verdict.kind,
        parameters: found.joint.parameters,
        fit: found.joint_fit,
        rig: Some(draw.rig_seed.to_string()),
        shared: vec![
            Common::Clearances,
            Common::Delays,
            Common::Asymmetries,
            Common::Harmonics,
            Common::ForceFrequency,
        ],
        channels: GAIN_ROLES.map(channel).to_vec(),
    }
}

/// How the differences of a parameter came out.
fn score(pairs: &[Pair], parameter: Coordinate) -> PairScore {
    let (mut errors, mut halves, mut ratios) = (vec![], vec![], vec![]);
    let (mut covered, mut covered_alone) = (0, 0);
    for pair in pairs {
        let Some(comparison) = &pair.comparison else {
            continue;
        };
        let mut all = comparison.differences.iter();
        let Some(found) = all.find(|d| d.parameter == parameter) else {
            continue;
        };
        let [before, after] = pair.truths.each_ref().map(|t| true_value(t, parameter));
        let truth = after - before;
        let unit = parameter.slope(before);
        let holds = |[low, high]: [f64; 2]| usize::from(low <= truth && truth <= high);
        let width = |[low, high]: [f64; 2]| high - low;
        covered += holds(found.interval95);
        covered_alone += holds(found.independent_interval95);
        errors.push((found.value - truth) / unit);
        halves.push(0.5 * width(found.interval95) / unit);
        ratios.push(width(found.independent_interval95) / width(found.interval95));
    }
    let count = errors.len().max(1) as f64;
    PairScore {
        pairs: errors.len(),
        rms_error: robust::rms(&errors),
        coverage95: covered as f64 / count,
        independent_coverage95: covered_alone as f64 / count,
        half_width: robust::median(&halves).unwrap_or(0.0),
        width_ratio: robust::median(&ratios).unwrap_or(0.0),
    }
}

fn true_value(truth: &Truth, parameter: Coordinate) -> f64 {
    match parameter {
        Coordinate::Restitution => truth.restitution,
        Coordinate::Frequency => truth.natural_frequency_hz(),
        Coordinate::Damping => truth.damping_ratio(),
        _ => truth.static_deflection_m(),
    }
}
