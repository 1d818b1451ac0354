//! Whether a campaign is of one rig: R, f0, β and `x_st` before and after some moment.
//!
//! First it is looked for where in the campaign, if anywhere, the fit of all would gain most by a change: by
//! the rows of the records at the fit's optimum (a score test: no fit is made), by the records that the fit
//! lost, and by R of the records' impacts. The two parts about that moment are then fitted each by itself,
//! with allowances of their own, and compared. So are the records of each clearance with all others, and those
//! of both directions of the sweep.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use crate::identify::first_values::part_alone;
use impact_fit::estimate::{Estimate, Status, estimate_within};
use impact_fit::evidence::Evidence;
use impact_fit::messages::{Finding, Note, StatedValue};
use impact_fit::method::Method;
use impact_fit::methods::answer::MethodResult;
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::impacts::block::SpeedPair;
use impact_fit::methods::selection::Selection;
use impact_fit::parameters::effect::Effect;
use impact_fit::parameters::{Coordinate, Parameters};
use impact_fit::solver::Problem;
use impact_fit::solver::normal::{Normal, inverse};
use impact_fit::solver::placed_rows::PlacedRows;
use impact_fit::statistics::distribution::student_tail;
use impact_fit::statistics::scatter::Spread;
use impact_records::motion::Observation;
use impact_records::record::Sweep;
use impact_records::signal::robust;

/// Records that either part has at least.
const FEWEST: usize = 6;
/// Records whose rows are looked at for the moment of a change; of more, every second, third …
const MOST: usize = 128;
/// χ² of a change of all four parameters from which a moment is looked at: noise reaches it, the moment being
/// free, in one of some thousand campaigns of a hundred records.
const SUSPECT: f64 = 30.0;
/// Standard deviations from which two parts differ in their lost records or in R of their impacts.
const APART: f64 = 5.0;
/// Level of the comparison of both parts; shared by the four parameters.
const LEVEL: f64 = 1e-4;
/// What the extrapolation of speeds and the length of contacts leave open in R of either part.
const LEAST_OF_R: f64 = 5e-3;

/// The least change that is one of the rig: the mean of a part moves by 3/4 of an accepted drift's
/// deviations over the campaign where that is 1.5 deviations in size; twice that, three deviations, is
/// beyond what a good laboratory accepts. R absolute, the others relative.
fn least(parameter: Coordinate) -> f64 {
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
    of: Other,
    /// What each part says of each parameter that both determine: the coordinate and how far it may be off.
    parts: Parts,
}

/// The records that are of another rig than all others.
#[derive(Debug, Clone, PartialEq)]
enum Other {
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
}

impl Other {
    /// Whether it holds a record, by its place in the order of acquisition.
    fn holds(&self, observation: &Observation, at: usize) -> bool {
        match self {
            Self::From { rank, .. } => at >= *rank,
            Self::Clearance(gap_m) => observation.setting.clearance_m == Some(*gap_m),
            Self::SweepsDown => observation.setting.sweep == Sweep::Down,
        }
    }
}

/// What two parts of a campaign say of each parameter that both determine.
type Parts = BTreeMap<Coordinate, [(f64, Spread); 2]>;

/// A joint fit: what it was made of, its problem with the methods in its order, its optimum and variance factor.
#[derive(Clone, Copy)]
pub struct Fitted<'a> {
    /// What was fitted.
    pub selection: &'a Selection<'a>,
    /// The problem.
    pub problem: &'a Problem<'a>,
    /// The methods in it.
    pub present: &'a [Method],
    /// The optimum.
    pub at: &'a Parameters,
    /// Its variance factor.
    pub factor: f64,
}

/// What tells where the records of a fit would most be of two rigs.
pub struct Search<'a> {
    pub(super) evidence: &'a Evidence<'a>,
    pub(super) fitted: Fitted<'a>,
    /// The rows of the records at the optimum, with their places among the observations.
    rows: Vec<(usize, PlacedRows)>,
}

impl<'a> Search<'a> {
    /// In the records of a fit.
    pub fn new(evidence: &'a Evidence<'a>, fitted: Fitted<'a>) -> Self {
        let mut rows: Vec<(usize, PlacedRows)> = Vec::new();
        for ((block, weight), method) in fitted.problem.blocks.iter().zip(fitted.present) {
            if !Method::BY_RECORD.contains(method) {
                continue;
            }
            let owners = fitted.selection.blocks.owners(*method);
            let own = fitted.problem.rows_of(*block, *weight, fitted.at);
            if own.len() == owners.len() {
                rows.extend(owners.into_iter().zip(own));
            }
        }
        Self {
            evidence,
            fitted,
            rows,
        }
    }

    /// From which record on they are of another rig; `None` of one rig.
    pub fn in_time(&self) -> Option<Change> {
        let (observations, selection) = (self.evidence.observations, self.fitted.selection);
        let ranks = ranks(observations);
        let suspects = [
            self.by_rows(&ranks).map(|(_, rank)| rank),
            by_impacts(&ranks, observations, &selection.blocks),
            by_lost_records(&ranks, selection),
        ];
        let found = suspects.into_iter().flatten().filter_map(|rank| {
            let first = ranks.iter().position(|r| *r == rank)?;
            let record = observations[first].record.clone();
            self.apart(Other::From { rank, record })
        });
        let found: Vec<Change> = found.collect();
        let most = found.iter().map(Change::chi2).fold(0.0, f64::max);
        // Parts that begin a few records apart differ about as much: the first suspect then weighs most records.
        found.into_iter().find(|change| change.chi2() >= 0.5 * most)
    }

    /// The clearance or the direction of the sweep whose records are of another rig than all others; `None` of one
    /// rig. The speed at impacts goes with the clearance: where R over it explains the impacts as well, there is no
    /// other rig.
    pub fn between_groups(&self) -> Option<Change> {
        let observations = self.evidence.observations;
        let pairs = &self.fitted.selection.blocks.impact.pairs;
        let tried = groups(observations).into_iter().filter_map(|of| {
            let inside = observations.iter().map(|o| usize::from(of.holds(o, 0)));
            let inside: Vec<usize> = inside.collect();
            if !explains_more_than_speed(&inside, pairs) {
                return None;
            }
            self.by_rows(&inside).map(|(chi2, _)| (chi2, of))
        });
        let (_, of) = tried.max_by(|a, b| a.0.total_cmp(&b.0))?;
        self.apart(of)
    }

    /// Both parts of a campaign, each fitted by itself, where they differ by more than R over the speed explains.
    fn apart(&self, of: Other) -> Option<Change> {
        let observations = self
            .evidence
            .observations
            .iter()
            .zip(ranks(self.evidence.observations));
        let second: Vec<bool> = observations.map(|(o, rank)| of.holds(o, rank)).collect();
        let both = [false, true].map(|part| part_alone(self.evidence, &|i| second[i] == part));
        let [Some(first), Some(other)] = both else {
            return None;
        };
        // amplitudes alone of half of the records do not tell one resonance from another
        let phases = self.fitted.selection.blocks.resonance.has_phases();
        let compared = first.into_iter();
        let compared = compared.filter(|(c, _)| phases || *c == Coordinate::Restitution);
        let common = compared.filter_map(|(c, a)| Some((c, [a, *other.get(&c)?])));
        let change = Change {
            of,
            parts: common.collect(),
        };
        let pairs = &self.fitted.selection.blocks.impact.pairs;
        let differing: Vec<Coordinate> = change.differing().map(|(c, _)| *c).collect();
        let one_rig = match differing.as_slice() {
            [] => true,
            [Coordinate::Restitution] => change.is_of_speed(pairs, &second),
            _ => false,
        };
        (!one_rig).then_some(change)
    }

    /// What a change of all four parameters explains, if it is beyond chance.
    pub(super) fn by_rows(&self, ranks: &[usize]) -> Option<(f64, usize)> {
        let step = self.most(ranks, |c| Coordinate::PHYSICAL.contains(&c))?;
        Some((step.chi2, step.rank))
    }

    /// The rank from which on a change of some coordinates explains most, by the records' rows: with A
    /// and g the information and the gradient of all, B the columns of the coordinates in the information of the
    /// records after it, C their own block of that and h their part of its gradient, the change is δ of
    /// [A B; Bᵀ C] [θ; δ] = −[g; h]. Of very many records every second, third … is looked at.
    pub(super) fn most(&self, ranks: &[usize], of: impl Fn(Coordinate) -> bool) -> Option<Step> {
        let problem = self.fitted.problem;
        let mut records: Vec<(usize, &PlacedRows)> = self
            .rows
            .iter()
            .map(|(i, rows)| (ranks[*i], rows))
            .collect();
        records.sort_by_key(|(rank, _)| *rank);
        let stride = records.len().div_ceil(MOST).max(1);
        let records: Vec<(usize, &PlacedRows)> = records.into_iter().step_by(stride).collect();
        let free = problem.free.iter().enumerate();
        let places: Vec<usize> = free.filter(|(_, c)| of(**c)).map(|(i, _)| i).collect();
        let mut all = problem.priors_normal(self.fitted.at);
        records.iter().for_each(|(_, rows)| all.inform(rows));
        let whole = Whole::of(&all)?;
        let mut after = Normal::zeros(problem.free.len());
        let mut best: Option<Step> = None;
        for (k, (rank, rows)) in records.iter().enumerate().rev() {
            after.inform(rows);
            let enough = k >= FEWEST && records.len() - k >= FEWEST;
            // records of one rank stay together
            let begins = k > 0 && records[k - 1].0 < *rank;
            if let Some(step) = (enough && begins)
                .then(|| whole.step(&after, &places, *rank))
                .flatten()
                && best.as_ref().is_none_or(|most| step.chi2 > most.chi2)
            {
                best = Some(step);
            }
        }
        best.filter(|step| step.chi2 > SUSPECT * self.fitted.factor)
    }
}

/// Each clearance beside others, and the sweep down.
fn groups(observations: &[Observation]) -> Vec<Other> {
    let stated = observations.iter().filter_map(|o| o.setting.clearance_m);
    let mut gaps_m: Vec<f64> = stated.collect();
    gaps_m.sort_by(f64::total_cmp);
    gaps_m.dedup();
    let gaps = gaps_m.into_iter().map(Other::Clearance);
    gaps.chain([Other::SweepsDown]).collect()
}

/// By how much R of impacts of one speed is another in a part; `None` where all impacts are in one part.
fn apart_at_one_speed(pairs: &[SpeedPair], inside: &[bool]) -> Option<f64> {
    let part = |p: &SpeedPair| f64::from(inside[p.observation]);
    if pairs.iter().all(|p| inside[p.observation]) || !pairs.iter().any(|p| inside[p.observation]) {
        return None;
    }
    // what the speed does not explain of R, and of which part an impact is of
    let beyond_speed = |of: &dyn Fn(&SpeedPair) -> f64| {
        let points: Vec<[f64; 2]> = pairs.iter().map(|p| [p.before_m_s.ln(), of(p)]).collect();
        let slope = slope(&points);
        points.into_iter().map(move |[x, y]| y - slope * x)
    };
    let ratios = beyond_speed(&|p| p.after_m_s / p.before_m_s);
    let points = beyond_speed(&part).zip(ratios).map(<[f64; 2]>::from);
    Some(slope(&points.collect::<Vec<_>>()))
}

/// Whether impacts inside and outside a group differ in R by more than over their speeds.
fn explains_more_than_speed(inside: &[usize], pairs: &[SpeedPair]) -> bool {
    let left = |of: &dyn Fn(&SpeedPair) -> f64| {
        let ratio = |p: &SpeedPair| p.after_m_s / p.before_m_s;
        let points: Vec<[f64; 2]> = pairs.iter().map(|p| [of(p), ratio(p)]).collect();
        let slope = slope(&points);
        let rest: Vec<f64> = points.iter().map(|[x, y]| y - slope * x).collect();
        let mean = robust::mean(&rest);
        rest.iter().map(|r| (r - mean).powi(2)).sum::<f64>()
    };
    left(&|p| inside[p.observation] as f64) <= left(&|p| p.before_m_s)
}

/// Whether a parameter of two parts differs beyond chance and beyond what drifts.
fn differs(parameter: Coordinate, [(a, of_a), (b, of_b)]: &[(f64, Spread); 2]) -> bool {
    let apart = b - a;
    let variance = of_a.error.powi(2) + of_b.error.powi(2);
    let uncertain = of_a.error.powi(4) / of_a.freedom + of_b.error.powi(4) / of_b.freedom;
    let freedom = variance.powi(2) / uncertain;
    let level = LEVEL / Coordinate::PHYSICAL.len() as f64;
    apart.abs() > least(parameter) && student_tail(apart / variance.sqrt(), freedom) < level
}

/// The place of each record in the order of acquisition, from 0.
pub(super) fn ranks(observations: &[Observation]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..observations.len()).collect();
    order.sort_by_key(|i| observations[*i].setting.sequence);
    let mut ranks = vec![0; order.len()];
    for (rank, i) in order.into_iter().enumerate() {
        ranks[i] = rank;
    }
    ranks
}

/// What all records say: the inverse of their information and the step to their optimum.
struct Whole {
    inverse: DMatrix<f64>,
    step: DVector<f64>,
}

/// A change of some coordinates from a record on.
pub(super) struct Step {
    /// The record's place in the order of acquisition, from 0.
    pub(super) rank: usize,
    /// How much the change explains.
    pub(super) chi2: f64,
    /// The changes.
    pub(super) change: DVector<f64>,
    /// By how much the coordinates of all records are others with it.
    pub(super) shift: DVector<f64>,
}

impl Whole {
    fn of(all: &Normal) -> Option<Self> {
        let inverse = inverse(&all.matrix)?;
        let step = -(&inverse * &all.gradient);
        Some(Self { inverse, step })
    }

    /// A change of the coordinates at these places in the records of `after`, all others being fitted to all:
    /// with S = C − BᵀA⁻¹B of what is left of their information, δ = −S⁻¹(h − BᵀA⁻¹g), χ² = δᵀSδ and the shift of the
    /// others −A⁻¹Bδ.
    fn step(&self, after: &Normal, places: &[usize], rank: usize) -> Option<Step> {
        let columns = after.matrix.select_columns(places);
        let pulled = &self.inverse * &columns;
        let own = columns.select_rows(places) - columns.tr_mul(&pulled);
        let gradient = after.gradient.select_rows(places) + columns.tr_mul(&self.step);
        let change = -(inverse(&own)? * &gradient);
        Some(Step {
            rank,
            chi2: -gradient.dot(&change),
            shift: -(pulled * &change),
            change,
        })
    }
}

/// The rank from which on most of the periodic records are lost, or before which they are.
fn by_lost_records(ranks: &[usize], selection: &Selection<'_>) -> Option<usize> {
    let kept = selection.blocks.trajectory.records.iter();
    let mut records: Vec<(usize, f64)> = kept.map(|r| (ranks[r.observation], 0.0)).collect();
    records.extend(selection.lost.iter().map(|r| (ranks[r.observation], 1.0)));
    // a proportion's variance is at least that of one half record
    let share = records.iter().map(|r| r.1).sum::<f64>() / records.len().max(1) as f64;
    furthest(&mut records, (share * (1.0 - share)).sqrt(), 0.0)
}

/// The rank from which on R of the records' impacts is another, by their medians. What its line over the speed
/// explains of masses without a drive, which hit as fast as a hand pushes them, is no change of the rig.
fn by_impacts(ranks: &[usize], observations: &[Observation], blocks: &Blocks) -> Option<usize> {
    let mut of_records: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    let pairs = &blocks.impact.pairs;
    let driven = |i: usize| observations[i].drive.is_some();
    let speeds: Vec<[f64; 2]> = pairs
        .iter()
        .filter(|p| !driven(p.observation))
        .map(|p| [p.before_m_s, p.after_m_s / p.before_m_s])
        .collect();
    let slope = slope(&speeds);
    for pair in pairs {
        let own = of_records.entry(ranks[pair.observation]).or_default();
        let by_speed = if driven(pair.observation) {
            0.0
        } else {
            slope * pair.before_m_s
        };
        own.push(pair.after_m_s / pair.before_m_s - by_speed);
    }
    let medians = of_records.into_iter();
    let mut records: Vec<(usize, f64)> = medians
        .filter_map(|(rank, ratios)| Some((rank, robust::median(&ratios)?)))
        .collect();
    records.sort_by_key(|r| r.0);
    let mut records = without_lone_ones(&records);
    // the scatter of neighbours, which a change in one place does not widen
    let steps: Vec<f64> = records
        .windows(2)
        .map(|w| (w[1].1 - w[0].1).abs())
        .collect();
    let typical = 1.4826 * robust::median(&steps)? / std::f64::consts::SQRT_2;
    furthest(
        &mut records,
        typical.max(0.5 * LEAST_OF_R),
        0.5 * LEAST_OF_R,
    )
}

/// Values in order, each the median of it and its neighbours: one record of few impacts is no change.
fn without_lone_ones(records: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let near = |i: usize| {
        let last = (i + 1).min(records.len() - 1);
        let mut near: Vec<f64> = records[i.saturating_sub(1)..=last]
            .iter()
            .map(|r| r.1)
            .collect();
        near.sort_by(f64::total_cmp);
        near[near.len() / 2]
    };
    let smoothed = records.iter().enumerate().map(|(i, r)| (r.0, near(i)));
    smoothed.collect()
}

/// Slope of the line of least squares through points; zero where all have one place.
fn slope(points: &[[f64; 2]]) -> f64 {
    let count = points.len().max(1) as f64;
    let [x, y] = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / count);
    let width: f64 = points.iter().map(|p| (p[0] - x).powi(2)).sum();
    let along: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    if width > 0.0 { along / width } else { 0.0 }
}

/// The rank from which on the mean of values differs most from that before, if that is beyond chance, the
/// values having a standard deviation, and more than a least difference.
fn furthest(records: &mut [(usize, f64)], deviation: f64, least: f64) -> Option<usize> {
    records.sort_by_key(|r| r.0);
    let count = records.len();
    let all: f64 = records.iter().map(|r| r.1).sum();
    let (mut before, mut best) = (0.0, None);
    for (k, (rank, value)) in records.iter().enumerate() {
        if k >= FEWEST && count - k >= FEWEST {
            let (a, b) = (k as f64, (count - k) as f64);
            let apart = ((all - before) / b - before / a).abs();
            let z_score = apart / (deviation * (a.recip() + b.recip()).sqrt());
            let beyond = apart > least && z_score > APART;
            if beyond && best.is_none_or(|(most, _)| z_score > most) {
                best = Some((z_score, *rank));
            }
        }
        before += value;
    }
    best.map(|(_, rank)| rank)
}

impl Change {
    /// How far the parts are apart: where a part has records of the other rig, they differ less.
    fn chi2(&self) -> f64 {
        let of = |[(a, of_a), (b, of_b)]: &[(f64, Spread); 2]| {
            (b - a).powi(2) / (of_a.half95().powi(2) + of_b.half95().powi(2))
        };
        self.parts.values().map(of).sum()
    }

    /// The parameters that differ, with what both parts say of them.
    fn differing(&self) -> impl Iterator<Item = (&Coordinate, &[(f64, Spread); 2])> + Clone {
        self.parts.iter().filter(|(c, both)| differs(**c, both))
    }

    /// Whether R of impacts of one speed is nearer to one value in both parts than to the values of the parts:
    /// then R differs with the speed, and the speed with the part.
    fn is_of_speed(&self, pairs: &[SpeedPair], second: &[bool]) -> bool {
        let restitution = self.parts.get(&Coordinate::Restitution);
        let apart = restitution.map(|[(a, _), (b, _)]| b - a);
        let at_one_speed = apart_at_one_speed(pairs, second);
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

fn stated(parameter: Coordinate, (value, spread): (f64, Spread)) -> Estimate {
    estimate_within(parameter, value, spread, None)
}

/// The weighted mean of two values; its error is at least that of the better one, as both share errors of
/// instruments.
fn mean([(a, of_a), (b, of_b)]: &[(f64, Spread); 2]) -> (f64, Spread) {
    let weights = [of_a, of_b].map(|s| s.half95().powi(-2));
    let value = (weights[0] * a + weights[1] * b) / (weights[0] + weights[1]);
    let better = if of_a.half95() < of_b.half95() {
        of_a
    } else {
        of_b
    };
    (value, *better)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::run::identify;
    use impact_fit::VerdictKind;
    use impact_fit::fixture::{evidence, observed, recorded};
    use impact_records::record::Record;

    /// A measurement of the first of two numbers, or of their sum, with a unit error.
    fn measured(value: f64, both: bool) -> PlacedRows {
        PlacedRows {
            places: vec![0, 1],
            slopes: DMatrix::from_row_slice(1, 2, &[-1.0, if both { -1.0 } else { 0.0 }]),
            residuals: DVector::from_element(1, value),
        }
    }

    #[test]
    fn valid_the_gain_of_a_change_is_that_of_two_means() {
        // The first number is 0 in 8 measurements and 3 in 12 more; the second is known from as many, and
        // does not differ. At the mean of all, 1.8:
        let rows = |shift: f64, count: usize| {
            (0..count)
                .flat_map(move |_| [measured(shift - 1.8, false), measured(shift - 1.8, true)])
        };
        let (mut all, mut after) = (Normal::zeros(2), Normal::zeros(2));
        rows(0.0, 8).for_each(|row| all.inform(&row));
        for row in rows(3.0, 12) {
            all.inform(&row);
            after.inform(&row);
        }
        // Two measurements in each of 8 and of 12, their difference 3: 9/(1/16 + 1/24).
        let whole = Whole::of(&all).expect("regular");
        let chi2 = whole.step(&after, &[0], 0).expect("regular").chi2;
        assert!(
            (chi2 - 9.0 / (1.0 / 16.0 + 1.0 / 24.0)).abs() < 1e-9,
            "{chi2}"
        );
    }

    #[test]
    fn valid_the_moment_of_a_step_is_found_and_none_where_chance_explains_it() {
        let values = |step: f64| -> Vec<(usize, f64)> {
            let scatter = [0.3, -0.9, 1.1, -0.2, 0.6, -1.0];
            let value = |k: usize| scatter[k % 6] + if k >= 17 { step } else { 0.0 };
            (0..40).map(|k| (k, value(k))).collect()
        };
        assert_eq!(furthest(&mut values(3.0), 1.0, 0.0), Some(17));
        assert_eq!(furthest(&mut values(-3.0), 1.0, 0.0), Some(17));
        assert_eq!(furthest(&mut values(0.0), 1.0, 0.0), None);
    }

    #[test]
    fn a_parameter_differs_where_its_change_is_beyond_chance_and_beyond_what_drifts() {
        let of = |parameter: Coordinate, apart: f64, error: f64| {
            differs(parameter, &[0.0, apart].map(|v| (v, Spread::known(error))))
        };
        assert!(of(Coordinate::Restitution, 0.02, 1e-3));
        assert!(!of(Coordinate::Restitution, 0.02, 6e-3));
        assert!(!of(Coordinate::Restitution, 0.004, 1e-4));
        // f0 may drift by 0.3 %
        assert!(of(Coordinate::Frequency, 0.01, 1e-4));
        assert!(!of(Coordinate::Frequency, 0.003, 1e-4));
    }

    #[test]
    fn valid_a_campaign_of_two_rigs_is_named_where_the_rig_changes_and_one_of_one_is_not() {
        let one = |(restitution, f0), seed| recorded(restitution, f0, 36, seed);
        let half = one((0.8, 12.0), 11);
        let of = |other: Vec<Record>| {
            let observations = observed(&[half.clone(), other].concat());
            let found = identify(&evidence(&observations));
            let changed = found
                .suspicions
                .into_iter()
                .find_map(|finding| match finding {
                    Finding::RigChanged {
                        number,
                        before,
                        after,
                        ..
                    } => Some((number, before, after)),
                    _ => None,
                });
            (found.verdict.kind, changed)
        };
        let (kind, changed) = of(one((0.8, 12.0), 12));
        assert_eq!((kind, changed), (VerdictKind::Identified, None));
        let (kind, changed) = of(one((0.77, 12.1), 12));
        assert_eq!(kind, VerdictKind::DoesNotFit);
        let (number, before, after) = changed.expect("a change");
        assert!((35..=39).contains(&number), "{number}");
        for (values, truth) in [(before, [0.8, 12.0]), (after, [0.77, 12.1])] {
            let named: Vec<Coordinate> = values.iter().map(|v| v.parameter).collect();
            assert_eq!(named, [Coordinate::Restitution, Coordinate::Frequency]);
            for (value, truth) in values.iter().zip(truth) {
                let apart = (value.value - truth).abs();
                assert!(apart < 1.5 * value.half_width, "{values:?}");
            }
        }
    }

    #[test]
    fn valid_f0_of_parts_is_not_compared_where_no_phase_is_measured() {
        let both = [(12.0, 11), (12.3, 12)].map(|(f0, seed)| recorded(0.8, f0, 36, seed));
        let mut observations = observed(&both.concat());
        for o in &mut observations {
            let Some(drive) = o.drive.take() else {
                continue;
            };
            o.setting.stated_frequency_hz = Some(drive.frequency_hz);
            o.motion_tone = Some(drive);
        }
        let found = identify(&evidence(&observations));
        let other_rig = |f: &Finding| matches!(f, Finding::RigChanged { .. });
        assert!(
            !found.suspicions.iter().any(other_rig),
            "{:?}",
            found.suspicions
        );
    }

    #[test]
    fn valid_sweeps_down_on_another_rig_are_named() {
        let records = recorded(0.8, 12.0, 72, 11);
        let of = |down: &[Record]| {
            let mixed = records.iter().zip(down).enumerate().map(|(i, (up, down))| {
                let mut record = if i % 2 == 0 { up } else { down }.clone();
                record.setting.sweep = if i % 2 == 0 { Sweep::Up } else { Sweep::Down };
                record
            });
            let observations = observed(&mixed.collect::<Vec<_>>());
            let found = identify(&evidence(&observations));
            let named = found
                .suspicions
                .into_iter()
                .find_map(|finding| match finding {
                    Finding::SweepsDownOnOtherRig { own, .. } => Some(own),
                    _ => None,
                });
            (found.verdict.kind, named)
        };
        assert_eq!(of(&records), (VerdictKind::Identified, None));
        let (kind, named) = of(&recorded(0.76, 12.1, 72, 11));
        assert_eq!(kind, VerdictKind::DoesNotFit);
        let truth = [
            (Coordinate::Restitution, 0.76),
            (Coordinate::Frequency, 12.1),
        ];
        for (value, (parameter, truth)) in named.expect("a finding").iter().zip(truth) {
            assert_eq!(value.parameter, parameter);
            let apart = (value.value - truth).abs();
            assert!(apart < 1.5 * value.half_width, "{value:?}");
        }
    }

    #[test]
    fn speeds_that_go_with_the_part_are_told_from_a_change_of_the_rig() {
        // the second part hits at half the speed; R falls with the logarithm of the speed, or is another there
        let pairs = |by_speed: f64, changed: f64| -> Vec<SpeedPair> {
            let impact = |i: usize| {
                let second = i % 2 == 1;
                let before = (0.2 + 0.01 * i as f64) / if second { 2.0 } else { 1.0 };
                let ratio = 0.8 - by_speed * before.ln() + if second { changed } else { 0.0 };
                SpeedPair {
                    observation: i % 2,
                    before_m_s: before,
                    after_m_s: ratio * before,
                    ..SpeedPair::default()
                }
            };
            (0..40).map(impact).collect()
        };
        let second = [false, true];
        let alone =
            |by_speed: f64, changed: f64| apart_at_one_speed(&pairs(by_speed, changed), &second);
        assert!(alone(0.03, 0.0).expect("both parts").abs() < 1e-12);
        assert!((alone(0.03, -0.02).expect("both parts") + 0.02).abs() < 1e-12);
        assert_eq!(apart_at_one_speed(&pairs(0.03, 0.0), &[false; 2]), None);
        let change = |[a, b]: [f64; 2]| Change {
            of: Other::SweepsDown,
            parts: BTreeMap::from([(
                Coordinate::Restitution,
                [a, b].map(|r| (r, Spread::known(1e-3))),
            )]),
        };
        assert!(change([0.84, 0.86]).is_of_speed(&pairs(0.03, 0.0), &second));
        assert!(!change([0.84, 0.82]).is_of_speed(&pairs(0.0, -0.02), &second));
    }

    #[test]
    fn one_record_of_few_impacts_is_no_change() {
        let with = |odd: &[usize]| -> Vec<(usize, f64)> {
            let all = (0..40).map(|i| (i, if odd.contains(&i) { 0.7 } else { 0.9 }));
            all.collect()
        };
        assert!(furthest(&mut with(&[30]), 2.5e-3, 0.0).is_some());
        assert!(furthest(&mut without_lone_ones(&with(&[30])), 2.5e-3, 0.0).is_none());
        let changed: Vec<usize> = (20..40).collect();
        let found = furthest(&mut without_lone_ones(&with(&changed)), 2.5e-3, 2.5e-3);
        assert_eq!(found, Some(20));
    }

    #[test]
    fn both_values_stand_in_the_result_and_in_the_finding() {
        let known = |value: f64| (value, Spread::known(1e-3));
        let f0 = 12f64.ln();
        let change = Change {
            of: Other::From {
                rank: 36,
                record: "r37".into(),
            },
            parts: BTreeMap::from([
                (Coordinate::Restitution, [known(0.8), known(0.76)]),
                (Coordinate::Frequency, [known(f0), known(f0 + 1e-4)]),
            ]),
        };
        let mut joint = MethodResult::default();
        assert_eq!(change.tell(&mut joint).len(), 2);
        let r = joint.parameters.restitution.expect("R");
        assert_eq!((r.status, r.note), (Status::Weak, Some(Note::Changes)));
        let [low, high] = r.interval95.expect("an interval");
        assert!((low - 0.758_04).abs() < 1e-5 && (high - 0.801_96).abs() < 1e-5);
        let f0 = joint.parameters.natural_frequency_hz.expect("f0");
        assert_eq!(f0.status, Status::Identified);
        assert_eq!(
            change.finding(72).to_string(),
            "the records are not of one rig: before r37 (number 37 of 72) they have R = 0.8000 ± \
             0.0020, from it on R = 0.7600 ± 0.0020: look for what was changed there (masses, \
             springs, clamps, bumpers, amplifier, sensors), and identify both parts by themselves"
        );
    }
}
