//! Which records and brackets the fits rest on; the others are named with the reason.

use std::cmp::Reverse;
use std::collections::BTreeSet;

use rayon::prelude::*;

use crate::identify::evidence::Nominal;
use crate::identify::evidence::influence;
use crate::identify::evidence::resonance::ResonancePoint;
use crate::identify::evidence::trajectory_record::TrajectoryRecord;
use crate::identify::evidence::weighing::Bulk;
use crate::identify::evidence::{Blocks, Evidence, boundary};
use crate::identify::flight_times;
use crate::identify::messages::{Item, LeftOut, Reason};
use crate::identify::method::Method;
use crate::identify::methods::{self, FitResult};
use crate::identify::parameters::{Coordinate, Parameters};
use crate::identify::solver::{FitError, Precision, Problem, mean_squares};
use crate::identify::starts;
use impact_records::motion::{Bracket, Observation};

/// Slowest multiplier's distance from 1 at which a motion is at its end.
const END: f64 = 2e-3;
/// That at which a fit may pull it there.
const NEAR_END: f64 = 0.1;

/// Rounds of leaving outlying records out and fitting again.
const ROUNDS: usize = 2;
/// Relative change of the error allowed beside the noise below which another round changes nothing.
const SETTLED: f64 = 0.1;

/// Halvings of the gains' uncertainty, by roots of two, from which a record's own error is looked for.
const OWN_STEPS: i32 = 16;

/// Relative changes of f0, β and `x_st` from which two fits are not of one minimum.
const FAR: [(Coordinate, f64); 3] = [
    (Coordinate::Frequency, 0.03),
    (Coordinate::Damping, 0.3),
    (Coordinate::Deflection, 0.1),
];

/// Whether two fits are so far apart that they may be in different minima.
fn is_far(a: &Parameters, b: &Parameters) -> bool {
    let apart = |c: Coordinate| (a.coordinate(c) - b.coordinate(c)).abs();
    FAR.iter().any(|(c, limit)| apart(*c) > *limit)
}

/// Records of methods by their places in the methods' blocks.
pub type Places = Vec<(Method, usize)>;

/// What is fitted, and what was left out of it.
pub struct Selection<'a> {
    evidence: &'a Evidence<'a>,
    /// The observations that the fits rest on.
    pub blocks: Blocks,
    /// Records or brackets left out, each with the reason.
    pub left_out: Vec<LeftOut>,
    /// Impactless records whose responses are unlike those of the others.
    unlike: Vec<ResonancePoint>,
    /// Periodic records that the trajectories' fit lost.
    pub lost: Vec<TrajectoryRecord>,
    /// The typical mean square of the records that it kept.
    pub typical: f64,
}

impl<'a> Selection<'a> {
    /// Everything that may be used.
    pub fn new(evidence: &'a Evidence<'a>) -> Self {
        Self {
            evidence,
            blocks: Blocks::new(evidence),
            left_out: Vec::new(),
            unlike: Vec::new(),
            lost: Vec::new(),
            typical: 1.0,
        }
    }

    /// Note a record that is left out, with the reason.
    fn note(&mut self, index: usize, reason: Reason) {
        let record = self.evidence.observations[index].record.clone();
        let item = Item::Record { index, record };
        self.left_out.push(LeftOut { item, reason });
    }

    /// Note a bracket that is left out, with the reason.
    fn note_bracket(&mut self, bracket: &Bracket, reason: Reason) {
        let all = self.evidence.brackets;
        if let Some(index) = all.iter().position(|b| b == bracket) {
            let item = Item::bracket(index, bracket);
            self.left_out.push(LeftOut { item, reason });
        }
    }

    /// Fit the impactless records; those that fit far worse than the bulk are named and left out.
    pub fn resonance(&mut self) -> Option<FitResult> {
        let first = match methods::resonance(&self.blocks, &self.evidence.nominal)? {
            Ok(first) => first,
            failed => return Some(failed),
        };
        let parameters = first.fit.parameters;
        self.keep_like_responses(&parameters);
        methods::resonance_from(&self.blocks, &self.evidence.nominal, parameters)
    }

    /// Weigh the impactless records at good parameters, keep those that fit like the bulk, and name the
    /// others. A record that deviates by less than the gains are uncertain is no other one: it is allowed as
    /// much more error as it shows. At resonance responses are so great, and so well measured, that
    /// any effect beyond the model exceeds their noise.
    fn keep_like_responses(&mut self, parameters: &Parameters) {
        for point in &mut self.blocks.resonance.points {
            point.own_relative_error = 0.0;
        }
        self.blocks.weigh_resonance(parameters);
        let scores = self.response_scores(parameters);
        let bulk = Bulk::of(&scores);
        let most = self.evidence.nominal.gain_uncertainty;
        let mut left = scores.clone();
        for step in 0..=OWN_STEPS {
            if left.iter().all(|score| *score <= bulk.limit) {
                break;
            }
            let own = most * 2f64.powf(0.5 * f64::from(step - OWN_STEPS));
            let block = &mut self.blocks.resonance;
            for (point, score) in block.points.iter_mut().zip(&left) {
                if *score > bulk.limit {
                    point.own_relative_error = own;
                }
            }
            block.allow(block.relative_error());
            left = self.response_scores(parameters);
        }
        let points = std::mem::take(&mut self.blocks.resonance.points);
        for (point, (score, left)) in points.into_iter().zip(scores.into_iter().zip(left)) {
            if left <= bulk.limit {
                self.blocks.resonance.points.push(point);
            } else {
                let times_worse = bulk.times_worse(score);
                let reason = Reason::ResponseUnlikeOthers { times_worse };
                self.note(point.observation, reason);
                self.unlike.push(point);
            }
        }
    }

    /// Mean squares of the impactless records.
    fn response_scores(&self, parameters: &Parameters) -> Vec<f64> {
        let scores = mean_squares(&self.blocks.resonance, parameters);
        scores.into_iter().map(|s| s.unwrap_or(0.0)).collect()
    }

    /// The resonance curve's fit, again from where the waveforms are, if it is far from there or left
    /// records out: few points tell f0 and `x_st` only together, and then also which of them is odd. The better
    /// one of the fits from there and from where it was.
    pub fn resonance_again(
        &mut self,
        found: Option<FitResult>,
        waveforms: &Parameters,
    ) -> Option<FitResult> {
        let before = match found {
            Some(Ok(found)) => found,
            other => return other,
        };
        let parameters = before.fit.parameters;
        if self.unlike.is_empty() && !is_far(&parameters, waveforms) {
            return Some(Ok(before));
        }
        let unlike = |reason: &Reason| matches!(reason, Reason::ResponseUnlikeOthers { .. });
        self.left_out.retain(|left| !unlike(&left.reason));
        self.blocks.resonance.points.append(&mut self.unlike);
        let points = &mut self.blocks.resonance.points;
        points.sort_by_key(|p| p.observation);
        self.keep_like_responses(waveforms);
        let nominal = &self.evidence.nominal;
        let starts = [*waveforms, parameters];
        let fits = starts.map(|start| methods::resonance_from(&self.blocks, nominal, start));
        let fits = fits.into_iter().flatten().filter_map(Result::ok);
        let best = fits.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost));
        Some(Ok(best.unwrap_or(before)))
    }

    /// Fit the folded records, first as if the rig were ideal, then with all that may add to it; those
    /// without an orbit at the start are tried again, and those that fit far worse than the bulk are left out and named.
    pub fn trajectories(&mut self, start: Parameters) -> Option<FitResult> {
        let nominal = self.evidence.nominal;
        let start = starts::best(&self.blocks, &nominal, start);
        let all = self.blocks.trajectory.records.clone();
        self.keep_those_with_orbits(&start);
        let first =
            match self.trajectories_with_orbits(&nominal.ideal(), start, Precision::Start)? {
                Ok(first) => first.fit.parameters,
                failed => return Some(failed),
            };
        self.blocks.trajectory.records.clone_from(&all);
        self.keep_those_with_orbits(&first);
        self.blocks.weigh_trajectories(&first);
        self.blocks.trajectory.reduce(&first);
        let mut found = match self.trajectories_with_orbits(&nominal, first, Precision::Start)? {
            Ok(found) => found,
            failed => return Some(failed),
        };
        self.blocks.trajectory.records = all;
        self.blocks.trajectory.find_changes(&found.fit.parameters);
        for _ in 0..ROUNDS {
            let parameters = found.fit.parameters;
            let allowed = self.blocks.trajectory.relative_error();
            let lost = self.lost.len();
            self.keep_fitting(&parameters);
            self.blocks.weigh_trajectories(&parameters);
            self.blocks.trajectory.reduce(&parameters);
            self.keep_those_with_orbits(&parameters);
            found = match self.trajectories_without_ends(parameters)? {
                Ok(found) => found,
                failed => return Some(failed),
            };
            let change = self.blocks.trajectory.relative_error() / allowed - 1.0;
            if self.lost.len() == lost && change.abs() < SETTLED {
                break;
            }
        }
        Some(Ok(found))
    }

    /// Fit the folded records that have an orbit where the fit begins.
    fn trajectories_with_orbits(
        &mut self,
        nominal: &Nominal,
        start: Parameters,
        precision: Precision,
    ) -> Option<FitResult> {
        loop {
            let found = methods::trajectories(&self.blocks, nominal, start, precision)?;
            match &found {
                Err(FitError::NoModel(missing)) if !missing.is_empty() => {
                    let without: Vec<usize> = missing.iter().map(|(_, item)| *item).collect();
                    let mut item = 0..;
                    let records = &mut self.blocks.trajectory.records;
                    records.retain(|_| item.next().is_some_and(|i| !without.contains(&i)));
                }
                _ => return Some(found),
            }
        }
    }

    /// Fit the folded records. Where one is pulled onto its saddle-node, where its slopes are infinite and
    /// the fit is singular, the worst of those near theirs is named, left out, and all others are fitted; so
    /// are those that have no orbit where the fit begins.
    fn trajectories_without_ends(&mut self, start: Parameters) -> Option<FitResult> {
        loop {
            let nominal = &self.evidence.nominal;
            let found = methods::trajectories(&self.blocks, nominal, start, Precision::Result)?;
            let (item, reason) = match &found {
                Err(FitError::Singular) => match self.worst_near_its_end(&start) {
                    Some((item, times_worse)) => {
                        (item, Reason::WaveformUnlikeOthers { times_worse })
                    }
                    None => return Some(found),
                },
                Err(FitError::NoModel(missing)) => match missing.last() {
                    Some((_, item)) => (*item, Reason::NoSuchMotion),
                    None => return Some(found),
                },
                _ => return Some(found),
            };
            let record = self.blocks.trajectory.records.remove(item);
            self.note(record.observation, reason);
            self.lost.push(record);
        }
    }

    /// The periodic record near its end at the parameters that fits worst, and how many times worse than
    /// is typical; `None` if none fits worse.
    fn worst_near_its_end(&self, at: &Parameters) -> Option<(usize, f64)> {
        let scores = mean_squares(&self.blocks.trajectory, at);
        let near = self.near_their_end(at, NEAR_END);
        let scores = near.into_iter().filter_map(|item| {
            let times_worse = scores[item]? / self.typical;
            (times_worse > 1.0).then_some((item, times_worse))
        });
        scores.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Keep the periodic records that have an orbit at given parameters.
    fn keep_those_with_orbits(&mut self, parameters: &Parameters) {
        let at_start = mean_squares(&self.blocks.trajectory, parameters);
        let mut has_orbit = at_start.iter().map(Option::is_some);
        let records = &mut self.blocks.trajectory.records;
        records.retain(|_| has_orbit.next().unwrap_or(false));
    }

    /// Keep the records that fit like the bulk, and name the others.
    fn keep_fitting(&mut self, parameters: &Parameters) {
        let scores = mean_squares(&self.blocks.trajectory, parameters);
        let known: Vec<f64> = scores.iter().flatten().copied().collect();
        let bulk = Bulk::of(&known);
        self.typical = bulk.typical;
        let ended = self.near_their_end(parameters, END);
        let records = std::mem::take(&mut self.blocks.trajectory.records);
        for (item, (record, score)) in records.into_iter().zip(scores).enumerate() {
            let reason = match score.filter(|_| !ended.contains(&item)) {
                Some(s) if s <= bulk.limit => {
                    self.blocks.trajectory.records.push(record);
                    continue;
                }
                Some(s) => Reason::WaveformUnlikeOthers {
                    times_worse: bulk.times_worse(s),
                },
                None => Reason::NoSuchMotion,
            };
            self.note(record.observation, reason);
            self.lost.push(record);
        }
    }

    /// Choose the brackets: those that no boundary reaches, or that lie far from it, are left out and named.
    pub fn choose_brackets(&mut self, start: &Parameters) {
        let rig = self.evidence.rig;
        let far = |bracket: &mut Bracket| {
            let predicted = boundary::predicted_hz(bracket, start, rig);
            !predicted.is_some_and(|f| {
                (f - bracket.middle_hz()).abs() <= 3.0 * bracket.width_hz() + 0.02 * f
            })
        };
        let brackets = &mut self.blocks.boundary.brackets;
        for bracket in brackets.extract_if(.., far).collect::<Vec<_>>() {
            self.note_bracket(&bracket, Reason::FarFromBoundary);
        }
        self.blocks.boundary.fit_early_scale(start);
    }

    /// Leave the records and brackets of one gap out; false where nothing would remain.
    pub fn leave_out_gap(&mut self, clearance_m: f64) -> bool {
        let records = &mut self.blocks.trajectory.records;
        if records.iter().all(|r| r.clearance_m == clearance_m) {
            return false;
        }
        let gone = records.extract_if(.., |r| r.clearance_m == clearance_m);
        for record in gone.collect::<Vec<_>>() {
            self.note(record.observation, Reason::GapNotAsStated);
        }
        self.lost.retain(|r| r.clearance_m != clearance_m);
        let brackets = &mut self.blocks.boundary.brackets;
        let gone = brackets.extract_if(.., |b| b.clearance_m == clearance_m);
        for bracket in gone.collect::<Vec<_>>() {
            self.note_bracket(&bracket, Reason::GapNotAsStated);
        }
        true
    }

    /// Fit the records that are shot from impact to impact; those that fit far worse than the bulk,
    /// as where an impact was missed, are left out and named.
    pub fn flights(&mut self, start: Parameters) -> Option<FitResult> {
        let mut parameters = start;
        let mut found = None;
        for _ in 0..=ROUNDS {
            let scores = mean_squares(&self.blocks.flight, &parameters);
            let known: Vec<f64> = scores.iter().flatten().copied().collect();
            let limit = Bulk::of(&known).limit;
            let follows = |score: &Option<f64>| score.is_some_and(|s| s <= limit);
            if found.is_some() && scores.iter().all(follows) {
                break;
            }
            let mut scores = scores.iter();
            let records = &mut self.blocks.flight.records;
            let gone = records.extract_if(.., |_| !scores.next().is_some_and(follows));
            for record in gone.collect::<Vec<_>>() {
                self.note(record.observation, Reason::ImpactsDoNotFollow);
            }
            match methods::flights(&self.blocks, &self.evidence.nominal, parameters)? {
                Ok(fit) => {
                    parameters = fit.fit.parameters;
                    found = Some(Ok(fit));
                }
                failed => return Some(failed),
            }
        }
        found
    }

    /// The records that draw a joint fit away from what all others state, `most` of them at most. After
    /// each batch the others are judged again at the optimum without it, to first order. The flag tells
    /// whether another batch would exceed `most`.
    pub fn influential(
        &self,
        problem: &Problem<'_>,
        present: &[Method],
        (at, most): (&Parameters, usize),
    ) -> (Places, bool) {
        let (mut owners, mut records) = (Vec::new(), Vec::new());
        let mut others = problem.priors_normal(at);
        for ((block, weight), method) in problem.blocks.iter().zip(present) {
            if matches!(method, Method::Resonance | Method::Trajectories) {
                let rows = problem.rows_of(*block, *weight, at);
                owners.extend((0..rows.len()).map(|i| (*method, i)));
                records.extend(rows);
            } else {
                others.add(&problem.block_normal(*block, *weight, at));
            }
        }
        let mut doubtful: Vec<bool> = owners
            .par_iter()
            .map(|(method, i)| *method == Method::Trajectories && self.settles_slowly(*i, at))
            .collect();
        let ended = self.near_their_end(at, END);
        let has_ended = |(method, item): &(Method, usize)| {
            *method == Method::Trajectories && ended.contains(item)
        };
        let mut ends: Vec<usize> = (0..owners.len())
            .filter(|k| has_ended(&owners[*k]))
            .collect();
        let mut found = Vec::new();
        while let Some(influences) = influence::influences(&records, &others) {
            let batch = if ends.is_empty() {
                influence::strongest(&influences, &doubtful)
            } else {
                std::mem::take(&mut ends)
            };
            if batch.is_empty() {
                break;
            }
            if found.len() + batch.len() > most {
                return (found, true);
            }
            for i in batch.into_iter().rev() {
                records.remove(i);
                doubtful.remove(i);
                found.push(owners.remove(i));
            }
            if influence::without_gradient(&mut records, &mut others).is_none() {
                break;
            }
        }
        (found, false)
    }

    /// Whether a periodic record's motion, once disturbed, decays by less than a factor e while it
    /// is recorded, as near a boundary: then it need not be settled.
    fn settles_slowly(&self, item: usize, at: &Parameters) -> bool {
        let block = &self.blocks.trajectory;
        let observation = block.records[item].observation;
        let evidence = &self.evidence.observations[observation]
            .classification
            .evidence;
        let slowest = block.slowest_multiplier(item, at).unwrap_or(1.0);
        slowest.powf(evidence.cycles_observed) > (-1f64).exp()
    }

    /// The periodic records whose slowest multiplier is within a distance of 1, or beyond it. At 1, the
    /// saddle-node, a motion ends: it moves without bound for the least change of the setting, so that
    /// no fit by slopes can use it.
    fn near_their_end(&self, at: &Parameters, distance: f64) -> Vec<usize> {
        let block = &self.blocks.trajectory;
        let is_near = |item: &usize| {
            let slowest = block.slowest_multiplier(*item, at);
            slowest.is_some_and(|m| m > 1.0 - distance)
        };
        let items = (0..block.records.len()).into_par_iter();
        items.filter(is_near).collect()
    }

    /// Number of records whose influence is judged.
    pub fn judged(&self) -> usize {
        self.blocks.resonance.points.len() + self.blocks.trajectory.records.len()
    }

    /// Leave influential records out, and note them.
    pub fn leave_out(&mut self, mut influential: Places) {
        // the last first, so that the places of the others stay
        influential.sort_unstable_by_key(|(method, place)| (*method, Reverse(*place)));
        for (method, place) in influential {
            let observation = match method {
                Method::Resonance => self.blocks.resonance.points.remove(place).observation,
                _ => self.blocks.trajectory.records.remove(place).observation,
            };
            self.note(observation, Reason::Influential { method });
        }
    }

    /// The records that a method's fit uses, by their indices; one may come several times.
    pub fn records_of(&self, method: Method) -> Vec<usize> {
        let blocks = &self.blocks;
        let those = |of: &dyn Fn(&Observation) -> bool| {
            let indexed = self.evidence.observations.iter().enumerate();
            indexed.filter(|(_, o)| of(o)).map(|(i, _)| i).collect()
        };
        match method {
            Method::Resonance => {
                let points = &blocks.resonance.points;
                points.iter().map(|p| p.observation).collect()
            }
            Method::Trajectories => {
                let records = &blocks.trajectory.records;
                records.iter().map(|r| r.observation).collect()
            }
            Method::Boundaries => {
                let brackets = blocks.boundary.brackets.iter();
                let names: BTreeSet<&String> = brackets.flat_map(|b| &b.records).collect();
                those(&|o| names.contains(&o.record))
            }
            Method::Impacts => blocks.impact.pairs.iter().map(|p| p.observation).collect(),
            Method::Flights => {
                let records = &blocks.flight.records;
                records.iter().map(|r| r.observation).collect()
            }
            Method::FlightTimes => those(&|o| !o.excluded() && flight_times::is_timed(o)),
            Method::FreeDecay => those(&|o| !o.excluded() && !o.decays.is_empty()),
            Method::PublishedSpeeds => Vec::new(),
        }
    }
}
