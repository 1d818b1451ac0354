//! Which folded records the waveforms' fit rests on.

use rayon::prelude::*;

use crate::evidence::Nominal;
use crate::messages::Reason;
use crate::method_fit::MethodFit;
use crate::methods::fit::FitResult;
use crate::methods::selection::{ROUNDS, Selection};
use crate::methods::thinning::every;
use crate::methods::trajectories::{fit, starts};
use crate::methods::weighing::Bulk;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::{FitError, Precision, mean_squares};

/// Records that a rough fit rests on; of more, every second, third …
const FIRST: usize = 128;
/// Slowest multiplier's distance from 1 at which a motion is at its end.
pub(in crate::methods) const END: f64 = 2e-3;

/// That at which a fit may pull it there.
const NEAR_END: f64 = 0.1;

/// Relative change of the error allowed beside the noise below which another round changes nothing.
const SETTLED: f64 = 0.1;

/// Standard errors of a fit within which another one is near it.
const NEAR: f64 = 3.0;

/// Whether a fit is near another one, so that what was found of the records there holds here.
fn is_near(found: &MethodFit, other: &MethodFit) -> bool {
    let apart = |c: Coordinate| {
        let [a, b] = [found, other].map(|fit| fit.fit.parameters.coordinate(c));
        (a - b).abs()
    };
    let within = |c: &Coordinate| other.spread(*c).is_none_or(|s| apart(*c) < NEAR * s.error);
    Coordinate::PHYSICAL.iter().all(within)
}

impl Selection<'_> {
    /// Fit the folded records, first some of them as if the rig were ideal and with all that may add to it, then
    /// all; those that fit far worse than the bulk are left out and named.
    pub fn fit_trajectories(&mut self, start: Parameters) -> Option<FitResult> {
        let start = starts::best(&self.blocks, &self.evidence.nominal, start);
        let mut found = match self.roughly_fitted(start)? {
            Ok(found) => found,
            failed => return Some(failed),
        };
        self.blocks.trajectory.find_changes(&found.fit.parameters);
        for _ in 0..ROUNDS {
            let before = found;
            let parameters = before.fit.parameters;
            self.keep_fitting(&parameters);
            self.blocks.weigh_trajectories(&parameters);
            self.blocks.trajectory.reduce(&parameters);
            self.keep_those_with_orbits(&parameters);
            found = match self.trajectories_without_ends(parameters)? {
                Ok(found) => found,
                failed => return Some(failed),
            };
            if is_near(&found, &before) && self.all_fit_as_weighed(&found.fit.parameters) {
                break;
            }
        }
        Some(Ok(found))
    }

    /// A rough fit of the folded records, of many of every second, third …, those with an orbit where it begins;
    /// all records are as before.
    fn roughly_fitted(&mut self, start: Parameters) -> Option<FitResult> {
        let nominal = self.evidence.nominal;
        let all = std::mem::take(&mut self.blocks.trajectory.records);
        let some = || every(&all, FIRST);
        self.blocks.trajectory.records = some();
        self.keep_those_with_orbits(&start);
        let ideal = self.trajectories_with_orbits(&nominal.ideal(), start);
        let found = match ideal {
            Some(Ok(ideal)) => {
                let first = ideal.fit.parameters;
                self.blocks.trajectory.records = some();
                self.keep_those_with_orbits(&first);
                self.blocks.weigh_trajectories(&first);
                self.blocks.trajectory.reduce(&first);
                self.trajectories_with_orbits(&nominal, first)
            }
            none => none,
        };
        self.blocks.trajectory.records = all;
        found
    }

    /// Whether all folded records belong to the bulk at parameters, and the error that they are allowed beside the
    /// noise is what the residuals there ask for.
    fn all_fit_as_weighed(&self, at: &Parameters) -> bool {
        let fitting = self.fitting(at).1;
        fitting.iter().all(Result::is_ok) && self.blocks.allows_trajectories_the_least(at, SETTLED)
    }

    /// Fit the folded records that have an orbit where the fit begins.
    fn trajectories_with_orbits(
        &mut self,
        nominal: &Nominal,
        start: Parameters,
    ) -> Option<FitResult> {
        loop {
            let found = fit::from(&self.blocks, nominal, start, Precision::Start)?;
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
            let found = fit::from(&self.blocks, nominal, start, Precision::Result)?;
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
        let (typical, fitting) = self.fitting(parameters);
        self.typical = typical;
        let records = std::mem::take(&mut self.blocks.trajectory.records);
        for (record, fits) in records.into_iter().zip(fitting) {
            match fits {
                Ok(()) => self.blocks.trajectory.records.push(record),
                Err(reason) => {
                    self.note(record.observation, reason);
                    self.lost.push(record);
                }
            }
        }
    }

    /// The typical mean square of the folded records, and of each whether it fits like the bulk, else why not.
    fn fitting(&self, at: &Parameters) -> (f64, Vec<Result<(), Reason>>) {
        let scores = mean_squares(&self.blocks.trajectory, at);
        let known: Vec<f64> = scores.iter().flatten().copied().collect();
        let bulk = Bulk::of(&known);
        let ended = self.near_their_end(at, END);
        let fits = |(item, score): (usize, Option<f64>)| match score {
            Some(s) if !ended.contains(&item) => {
                let times_worse = bulk.times_worse(s);
                let unlike = Reason::WaveformUnlikeOthers { times_worse };
                if s <= bulk.limit { Ok(()) } else { Err(unlike) }
            }
            _ => Err(Reason::NoSuchMotion),
        };
        let fitting = scores.into_iter().enumerate().map(fits).collect();
        (bulk.typical, fitting)
    }

    /// Whether a periodic record's motion, once disturbed, decays by less than a factor e while it
    /// is recorded, as near a boundary: then it need not be settled.
    pub(in crate::methods) fn settles_slowly(&self, item: usize, at: &Parameters) -> bool {
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
    pub(in crate::methods) fn near_their_end(&self, at: &Parameters, distance: f64) -> Vec<usize> {
        let block = &self.blocks.trajectory;
        let is_near = |item: &usize| {
            let slowest = block.slowest_multiplier(*item, at);
            slowest.is_some_and(|m| m > 1.0 - distance)
        };
        let items = (0..block.records.len()).into_par_iter();
        items.filter(is_near).collect()
    }
}
