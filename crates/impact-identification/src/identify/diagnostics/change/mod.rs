//! Whether a campaign is of one rig: R, f0, β and `x_st` before and after some moment.
//!
//! First it is looked for where in the campaign, if anywhere, the fit of all would gain most by a change: by
//! the rows of the records at the fit's optimum (a score test: no fit is made), by the records that the fit
//! lost, and by R of the records' impacts. The two parts about that moment are then fitted each by itself,
//! with allowances of their own, and compared. So are the records of each clearance with all others, those
//! of both directions of the sweep, and two groups of records in whatever order that differ in what each record tells.

mod found;
mod mixture;
mod moment;
mod rows;
mod search;
mod speeds;

pub use found::Change;
use found::{Other, is_stated};
pub(super) use rows::Step;
pub use search::{Fitted, Search};

use crate::identify::first_values::part_alone;
use impact_fit::parameters::Coordinate;
use impact_records::motion::Observation;
use moment::{by_impacts, by_lost_records};
use speeds::explains_more_than_speed;

impl Search<'_> {
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
        let impacts = &self.fitted.selection.blocks.impact;
        let tried = groups(observations).into_iter().filter_map(|of| {
            let inside = observations.iter().map(|o| usize::from(of.holds(o, 0)));
            let inside: Vec<usize> = inside.collect();
            if !explains_more_than_speed(&inside, impacts) {
                return None;
            }
            self.by_rows(&inside).map(|(chi2, _)| (chi2, of))
        });
        let (_, of) = tried.max_by(|a, b| a.0.total_cmp(&b.0))?;
        self.apart(of)
    }

    /// The records, in whatever order, that are of another rig than all others; `None` of one rig.
    pub fn in_no_order(&self) -> Option<Change> {
        self.apart(self.mixed()?)
    }

    /// Both parts of a campaign, each fitted by itself, where they differ by more than R over the speed explains.
    fn apart(&self, of: Other) -> Option<Change> {
        let (observations, selection) = (self.evidence.observations, self.fitted.selection);
        let ranked = observations.iter().zip(ranks(observations));
        let second: Vec<bool> = ranked.map(|(o, rank)| of.holds(o, rank)).collect();
        let both = [false, true].map(|part| {
            let within =
                |i: usize| second[i] == part && !selection.is_of_a_gap_left_out(&observations[i]);
            part_alone(self.evidence, &within)
        });
        let [Some(first), Some(other)] = both else {
            return None;
        };
        // amplitudes alone of half of the records do not tell one resonance from another
        let phases = self.fitted.selection.blocks.resonance.has_phases();
        let compared = first.into_iter();
        let compared = compared.filter(|(c, _)| phases || *c == Coordinate::Restitution);
        let common = compared.filter_map(|(c, a)| Some((c, [a, *other.get(&c)?])));
        let common = common.filter(|(c, both)| both.iter().all(|part| is_stated(*c, *part)));
        let change = Change {
            of,
            parts: common.collect(),
        };
        let impacts = &self.fitted.selection.blocks.impact;
        let differing: Vec<Coordinate> = change.differing().map(|(c, _)| *c).collect();
        let one_rig = match differing.as_slice() {
            [] => true,
            [Coordinate::Restitution] => change.is_of_speed(impacts, &second),
            _ => false,
        };
        (!one_rig).then_some(change)
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

#[cfg(test)]
mod tests;
