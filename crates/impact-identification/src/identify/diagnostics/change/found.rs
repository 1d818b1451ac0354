//! A campaign of two rigs: what both parts of it say, and in what they differ.

use std::collections::{BTreeMap, BTreeSet};

use super::speeds::apart_at_one_speed;
use impact_fit::estimate::{Estimate, Status, estimate_within};
use impact_fit::messages::{Finding, Note, StatedValue};
use impact_fit::methods::answer::MethodResult;
use impact_fit::methods::impacts::block::ImpactBlock;
use impact_fit::parameters::Coordinate;
use impact_fit::parameters::effect::Effect;
use impact_fit::statistics::distribution::student_tail;
use impact_fit::statistics::scatter::Spread;
use impact_records::motion::Observation;
use impact_records::record::Sweep;

/// Records that either part has at least.
pub(super) const FEWEST: usize = 6;
/// Level of the comparison of both parts; shared by the four parameters.
const LEVEL: f64 = 1e-4;
/// What the extrapolation of speeds and the length of contacts leave open in R of either part.
pub(super) const LEAST_OF_R: f64 = 5e-3;

/// The least change that is one of the rig: the mean of a part moves by 3/4 of an accepted drift's
/// deviations over the campaign where that is 1.5 deviations in size; twice that, three deviations, is
/// beyond what a good laboratory accepts. R absolute, the others relative.
pub(super) fn least(parameter: Coordinate) -> f64 {
    match parameter {
        Coordinate::Restitution => LEAST_OF_R,
        Coordinate::Frequency => 1.5 * Effect::FrequencyDrift.accepted(),
        Coordinate::Damping => 1.5 * Effect::DampingDrift.accepted(),
        _ => 1.5 * Effect::DeflectionDrift.accepted(),
    }
}

/// A campaign of two rigs.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// Which records are of the second rig.
    pub(super) of: Other,
    /// What each part says of each parameter that both determine: the coordinate and how far it may be off.
    pub(super) parts: Parts,
}

/// The records that are of another rig than all others.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Other {
    /// Those from one on.
    From {
        /// Its place in the order of acquisition, from 0.
        rank: usize,
        /// Its name.
        record: String,
    },
    /// Those of a clearance, m.
    Clearance(f64),
    /// Those of sweeps down.
    SweepsDown,
    /// Some in no order.
    Mixed {
        /// Their places in the order of acquisition, from 0.
        ranks: BTreeSet<usize>,
        /// Their names.
        records: Vec<String>,
    },
}

impl Other {
    /// Whether it holds a record, by its place in the order of acquisition.
    pub(super) fn holds(&self, observation: &Observation, at: usize) -> bool {
        match self {
            Self::From { rank, .. } => at >= *rank,
            Self::Clearance(gap_m) => observation.setting.clearance_m == Some(*gap_m),
            Self::SweepsDown => observation.setting.sweep == Sweep::Down,
            Self::Mixed { ranks, .. } => ranks.contains(&at),
        }
    }
}

/// What two parts of a campaign say of each parameter that both determine.
pub(super) type Parts = BTreeMap<Coordinate, [(f64, Spread); 2]>;

impl Change {
    /// How far the parts are apart: where a part has records of the other rig, they differ less.
    pub(super) fn chi2(&self) -> f64 {
        let of = |[(a, of_a), (b, of_b)]: &[(f64, Spread); 2]| {
            (b - a).powi(2) / (of_a.half95().powi(2) + of_b.half95().powi(2))
        };
        self.parts.values().map(of).sum()
    }

    /// The parameters that differ, with what both parts say of them.
    pub(super) fn differing(
        &self,
    ) -> impl Iterator<Item = (&Coordinate, &[(f64, Spread); 2])> + Clone {
        self.parts.iter().filter(|(c, both)| differs(**c, both))
    }

    /// Whether R of impacts of one speed is nearer to one value in both parts than to the values of the parts:
    /// then R differs with the speed, and the speed with the part.
    pub(super) fn is_of_speed(&self, impacts: &ImpactBlock, second: &[bool]) -> bool {
        let restitution = self.parts.get(&Coordinate::Restitution);
        let apart = restitution.map(|[(a, _), (b, _)]| b - a);
        let at_one_speed = apart_at_one_speed(impacts, second);
        apart
            .zip(at_one_speed)
            .is_some_and(|(apart, own)| own / apart < 0.5)
    }

    /// What changed.
    pub fn finding(&self, of: usize) -> Finding {
        let changed = self.differing();
        let of_part = |part: usize| {
            let values = changed.clone().filter_map(|(c, both)| {
                let estimate = stated(*c, both[part]);
                let [low, high] = estimate.interval95?;
                Some(StatedValue {
                    parameter: *c,
                    value: estimate.value?,
                    half_width: 0.5 * (high - low),
                })
            });
            values.collect()
        };
        let [others, own] = [of_part(0), of_part(1)];
        match &self.of {
            Other::From { rank, record } => Finding::RigChanged {
                record: record.clone(),
                number: rank + 1,
                of,
                before: others,
                after: own,
            },
            Other::Clearance(clearance_m) => Finding::ClearanceOnOtherRig {
                clearance_m: *clearance_m,
                own,
                others,
            },
            Other::SweepsDown => Finding::SweepsDownOnOtherRig { own, others },
            Other::Mixed { records, .. } => Finding::RigsMixed {
                records: records.clone(),
                of,
                own,
                others,
            },
        }
    }

    /// Put into a joint result what both parts say: of a parameter that differs both values, of another one
    /// their mean.
    pub fn tell(&self, joint: &mut MethodResult) -> Vec<Coordinate> {
        for (parameter, both) in &self.parts {
            let Some(slot) = joint.parameters.slot(*parameter) else {
                continue;
            };
            *slot = Some(if differs(*parameter, both) {
                between(*parameter, both)
            } else {
                stated(*parameter, mean(both))
            });
        }
        self.parts.keys().copied().collect()
    }
}

/// Whether a value of a part is one that can be stated: a fit of few records may leave it open by orders of magnitude.
pub(super) fn is_stated(parameter: Coordinate, part: (f64, Spread)) -> bool {
    let estimate = stated(parameter, part);
    estimate.value.is_some_and(f64::is_finite) && estimate.interval95.is_some()
}

fn stated(parameter: Coordinate, (value, spread): (f64, Spread)) -> Estimate {
    estimate_within(parameter, value, spread, None)
}

/// The weighted mean of two values; its error is at least that of the better one, as both share errors of
/// instruments, and as much as they differ by more than their errors.
fn mean([(a, of_a), (b, of_b)]: &[(f64, Spread); 2]) -> (f64, Spread) {
    let weights = [of_a, of_b].map(|s| s.half95().powi(-2));
    let value = (weights[0] * a + weights[1] * b) / (weights[0] + weights[1]);
    let better = if of_a.half95() < of_b.half95() {
        of_a
    } else {
        of_b
    };
    let beyond = (b - a).powi(2) - of_a.error.powi(2) - of_b.error.powi(2);
    let error = better.error.hypot(0.5 * beyond.max(0.0).sqrt());
    (value, Spread { error, ..*better })
}

/// An estimate that holds both of two values, and is neither.
fn between(parameter: Coordinate, both: &[(f64, Spread); 2]) -> Estimate {
    let half = |spread: &Spread| spread.half95();
    let low = both
        .iter()
        .map(|(v, s)| v - half(s))
        .fold(f64::INFINITY, f64::min);
    let high = both
        .iter()
        .map(|(v, s)| v + half(s))
        .fold(f64::NEG_INFINITY, f64::max);
    let value = parameter.physical(0.5 * (low + high));
    let interval = [low, high].map(|v| parameter.physical(v));
    let error = 0.5 * (both[1].0 - both[0].0).abs();
    Estimate {
        value: Some(value),
        standard_error: Some(error * parameter.slope(value)),
        interval95: Some(match parameter {
            Coordinate::Restitution => [interval[0].max(0.0), interval[1].min(1.0)],
            _ => interval,
        }),
        status: Status::Weak,
        note: Some(Note::Changes),
    }
}

/// Whether a parameter of two parts differs beyond chance and beyond what drifts.
pub(super) fn differs(parameter: Coordinate, [(a, of_a), (b, of_b)]: &[(f64, Spread); 2]) -> bool {
    let apart = b - a;
    let variance = of_a.error.powi(2) + of_b.error.powi(2);
    let uncertain = of_a.error.powi(4) / of_a.freedom + of_b.error.powi(4) / of_b.freedom;
    let freedom = variance.powi(2) / uncertain;
    let level = LEVEL / Coordinate::PHYSICAL.len() as f64;
    apart.abs() > least(parameter) && student_tail(apart / variance.sqrt(), freedom) < level
}
