//! Records that draw a joint fit away from what all others state.

use std::cmp::Reverse;

use rayon::prelude::*;

use crate::evidence::influence;
use crate::messages::Reason;
use crate::method::Method;
use crate::methods::selection::Selection;
use crate::methods::trajectories::select::END;
use crate::parameters::Parameters;
use crate::solver::Problem;

/// Records of methods by their places in the methods' blocks.
pub type Places = Vec<(Method, usize)>;

impl Selection<'_> {
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
            if Method::BY_RECORD.contains(method) {
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

    /// Number of records whose influence is judged.
    pub fn judged(&self) -> usize {
        self.blocks.resonance.points.len() + self.blocks.trajectory.records.len()
    }

    /// Leave influential records out, and note them.
    pub fn leave_out(&mut self, mut influential: Places) {
        // the last first, so that the places of the others stay
        influential.sort_unstable_by_key(|(method, place)| (*method, Reverse(*place)));
        for (method, place) in influential {
            let observation = self.blocks.owners(method)[place];
            self.blocks.remove(method, place);
            self.note(observation, Reason::Influential { method });
        }
    }
}
