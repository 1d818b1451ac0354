//! Which records and brackets the fits rest on; the others are named with the reason.

use crate::evidence::Evidence;
use crate::messages::{Item, LeftOut, Reason};
use crate::methods::blocks::Blocks;
use crate::methods::resonance::block::ResonancePoint;
use crate::methods::trajectories::record::TrajectoryRecord;
use impact_records::motion::{Bracket, Observation};

/// Rounds of leaving outlying records out and fitting again.
pub(super) const ROUNDS: usize = 2;

/// What is fitted, and what was left out of it.
#[derive(Clone)]
pub struct Selection<'a> {
    /// What the identification starts from.
    pub evidence: &'a Evidence<'a>,
    /// The observations that the fits rest on.
    pub blocks: Blocks,
    /// Records or brackets left out, each with the reason.
    pub left_out: Vec<LeftOut>,
    /// Impactless records whose responses are unlike those of the others.
    pub(super) unlike: Vec<ResonancePoint>,
    /// Periodic records that the trajectories' fit lost.
    pub lost: Vec<TrajectoryRecord>,
    /// The typical mean square of the records that it kept.
    pub typical: f64,
    /// The stated clearances of the gaps that were left out, m.
    gone_m: Vec<f64>,
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
            gone_m: Vec::new(),
        }
    }

    /// Note a record that is left out, with the reason.
    pub(super) fn note(&mut self, index: usize, reason: Reason) {
        let record = self.evidence.observations[index].record.clone();
        let item = Item::Record { index, record };
        self.left_out.push(LeftOut { item, reason });
    }

    /// Note a bracket that is left out, with the reason.
    pub(super) fn note_bracket(&mut self, bracket: &Bracket, reason: Reason) {
        let all = self.evidence.brackets;
        if let Some(index) = all.iter().position(|b| b == bracket) {
            let item = Item::bracket(index, bracket);
            self.left_out.push(LeftOut { item, reason });
        }
    }

    /// The indices of the observations that pass a test.
    pub(super) fn observed(&self, test: impl Fn(&Observation) -> bool) -> Vec<usize> {
        let indexed = self.evidence.observations.iter().enumerate();
        indexed.filter(|(_, o)| test(o)).map(|(i, _)| i).collect()
    }

    /// The waveforms of one gap, those that fits have lost among them.
    pub fn of_gap(&self, clearance_m: f64) -> Vec<TrajectoryRecord> {
        let records = self.blocks.trajectory.records.iter().chain(&self.lost);
        let own = records.filter(|r| r.clearance_m == clearance_m);
        own.cloned().collect()
    }

    /// Leave the records and brackets of one gap out; false where nothing would remain.
    pub fn leave_out_gap(&mut self, clearance_m: f64) -> bool {
        let records = &mut self.blocks.trajectory.records;
        if records.iter().all(|r| r.clearance_m == clearance_m) {
            return false;
        }
        let gone = records.extract_if(.., |r| r.clearance_m == clearance_m);
        let mut gone: Vec<usize> = gone.map(|r| r.observation).collect();
        let flown = &mut self.blocks.flight.records;
        let flown = flown.extract_if(.., |r| r.clearance_m == clearance_m);
        gone.extend(flown.map(|r| r.observation));
        for observation in gone {
            self.note(observation, Reason::GapNotAsStated);
        }
        self.lost.retain(|r| r.clearance_m != clearance_m);
        self.gone_m.push(clearance_m);
        let brackets = &mut self.blocks.boundary.brackets;
        let gone = brackets.extract_if(.., |b| b.clearance_m == clearance_m);
        for bracket in gone.collect::<Vec<_>>() {
            self.note_bracket(&bracket, Reason::GapNotAsStated);
        }
        true
    }

    /// Whether an observation is of impacts across a gap that was left out.
    pub fn is_of_a_gap_left_out(&self, observation: &Observation) -> bool {
        let stated_m = observation.setting.clearance_m;
        let gone = stated_m.is_some_and(|own_m| self.gone_m.contains(&own_m));
        gone && !observation.impacts.is_empty()
    }
}
