//! All items of a problem at given parameters, folded together by groups.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex};

use rayon::prelude::*;

use crate::parameters::{Coordinate, Parameters};
use crate::solver::block::Block;
use crate::solver::factor::Factor;
use crate::solver::group::Group;
use crate::solver::normal::Normal;

/// The factors of all groups of some blocks at given parameters.
pub(super) struct Evaluation {
    at: Parameters,
    /// Of each block its groups; items that belong to none are one of their own.
    pub(super) blocks: Vec<Vec<(Option<Group>, Part)>>,
}

impl Evaluation {
    /// Of blocks with their weights over the free coordinates.
    pub(super) fn of(blocks: &[(&dyn Block, f64)], free: &[Coordinate], at: &Parameters) -> Self {
        let of_block = |block: &(&dyn Block, f64)| {
            let mut items: BTreeMap<Option<Group>, Vec<usize>> = BTreeMap::new();
            for i in 0..block.0.items() {
                items.entry(block.0.group(i)).or_default().push(i);
            }
            items
                .into_par_iter()
                .map(|(group, items)| (group, Part::of(*block, free, at, &items)))
                .collect()
        };
        Self {
            at: *at,
            blocks: blocks.par_iter().map(of_block).collect(),
        }
    }
}

/// The evaluations of a problem that were made last: a fit ends where its groups are asked for, or where a fit with other
/// priors begins.
#[derive(Default)]
pub(crate) struct LastEvaluations(Mutex<VecDeque<Arc<Evaluation>>>);

/// Where a fit began, or was before its last step, and where it ended.
const LAST: usize = 2;

impl LastEvaluations {
    /// That of the last which was made at these parameters, else a new one, which is kept.
    pub(super) fn at_or(
        &self,
        parameters: &Parameters,
        evaluate: impl FnOnce() -> Evaluation,
    ) -> Arc<Evaluation> {
        if let Some(known) = self.kept().into_iter().find(|e| e.at == *parameters) {
            return known;
        }
        let evaluation = Arc::new(evaluate());
        if let Ok(mut last) = self.0.lock() {
            last.truncate(LAST - 1);
            last.push_front(Arc::clone(&evaluation));
        }
        evaluation
    }

    fn kept(&self) -> VecDeque<Arc<Evaluation>> {
        self.0
            .lock()
            .map_or_else(|_| VecDeque::new(), |last| last.clone())
    }
}

impl Clone for LastEvaluations {
    fn clone(&self) -> Self {
        Self(Mutex::new(self.kept()))
    }
}

/// Items of a block that are folded together.
const SHARE: usize = 16;

/// Factor of some items of a block.
pub(super) struct Part {
    pub(super) factor: Factor,
    /// Places of its coordinates among the free ones.
    pub(super) places: Vec<usize>,
    /// Items without a model.
    pub(super) missing: Vec<usize>,
}

impl Part {
    /// Of some items of a block with its weight, over the coordinates that the block depends on. Items are
    /// folded together in shares of fixed size, so that the number of threads changes nothing.
    pub(super) fn of(
        (block, weight): (&dyn Block, f64),
        free: &[Coordinate],
        at: &Parameters,
        items: &[usize],
    ) -> Self {
        let (places, coordinates) = kept(free, |c| block.touches(c));
        let shares: Vec<(Factor, Vec<usize>)> = items
            .par_chunks(SHARE)
            .map(|items| {
                let (mut rows, mut missing) = (Vec::new(), Vec::new());
                for i in items {
                    let (own, touched) = kept(&coordinates, |c| block.item_touches(*i, c));
                    match block.rows(*i, at, &touched, weight) {
                        Some(found) => rows.push((found, own)),
                        None => missing.push(*i),
                    }
                }
                let mut share = Factor::empty(places.len());
                share.add(&Vec::from_iter(
                    rows.iter().map(|(rows, own)| (rows, own.as_slice())),
                ));
                (share, missing)
            })
            .collect();
        let (factors, missing): (Vec<Factor>, Vec<Vec<usize>>) = shares.into_iter().unzip();
        Self {
            factor: Factor::stacked(places.len(), factors),
            places,
            missing: missing.concat(),
        }
    }

    /// Its normal equations over all unknowns.
    pub(super) fn normal(&self, unknowns: usize) -> Normal {
        self.factor.rows().normal(&self.places, unknowns)
    }
}

/// The coordinates that are touched, with their places.
pub(super) fn kept(
    coordinates: &[Coordinate],
    touched: impl Fn(Coordinate) -> bool,
) -> (Vec<usize>, Vec<Coordinate>) {
    let room = coordinates.len();
    let mut kept = (Vec::with_capacity(room), Vec::with_capacity(room));
    let touched = |(_, c): &(usize, Coordinate)| touched(*c);
    kept.extend(coordinates.iter().copied().enumerate().filter(touched));
    kept
}
