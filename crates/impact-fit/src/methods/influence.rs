//! Records that draw a joint fit away from what all others state.

use std::cmp::Reverse;

use rayon::prelude::*;

use crate::evidence::influence;
use crate::messages::Reason;
use crate::method::Method;
use crate::methods::registry::{BY_RECORD, by_record};
use crate::methods::selection::Selection;
use crate::parameters::Parameters;
use crate::solver::{Block, Problem};

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
        at: &Parameters,
        most: usize,
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
        let is_doubtful = |(method, i): &(Method, usize)| {
            by_record(*method).is_some_and(|of| of.is_doubtful(self, *i, at))
        };
        let mut doubtful: Vec<bool> = owners.par_iter().map(is_doubtful).collect();
        let unusable: Places = BY_RECORD
            .iter()
            .flat_map(|of| of.unusable(self, at).into_iter().map(|i| (of.method(), i)))
            .collect();
        let mut ends: Vec<usize> = (0..owners.len())
            .filter(|k| unusable.contains(&owners[*k]))
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
        let blocks = BY_RECORD
            .iter()
            .filter_map(|of| self.blocks.of(of.method()));
        blocks.map(Block::items).sum()
    }

    /// Leave influential records out, and note them.
    pub fn leave_out(&mut self, mut influential: Places) {
        // the last first, so that the places of the others stay
        influential.sort_unstable_by_key(|(method, place)| (*method, Reverse(*place)));
        for (method, place) in influential {
            let observation = self.blocks.owners(method)[place];
            if let Some(of) = by_record(method) {
                of.remove(&mut self.blocks, place);
            }
            self.note(observation, Reason::Influential { method });
        }
    }
}
