//! From which record on a change of parameters explains most, by the rows of the records at the optimum of a fit.

use nalgebra::{DMatrix, DVector};

use super::found::FEWEST;
use super::search::Search;
use impact_fit::methods::thinning::every;
use impact_fit::parameters::Coordinate;
use impact_fit::solver::normal::{Normal, inverse};
use impact_fit::solver::placed_rows::PlacedRows;

/// Records whose rows are looked at for the moment of a change; of more, every second, third …
const MOST: usize = 128;
/// χ² of a change of all four parameters from which a moment is looked at: noise reaches it, the moment being
/// free, in one of some thousand campaigns of a hundred records.
const SUSPECT: f64 = 30.0;

/// What all records say: the inverse of their information and the step to their optimum.
pub(super) struct Whole {
    inverse: DMatrix<f64>,
    step: DVector<f64>,
}

/// A change of some coordinates from a record on.
pub(in crate::identify::diagnostics) struct Step {
    /// The record's place in the order of acquisition, from 0.
    pub(in crate::identify::diagnostics) rank: usize,
    /// How much the change explains.
    pub(in crate::identify::diagnostics) chi2: f64,
    /// The changes.
    pub(in crate::identify::diagnostics) change: DVector<f64>,
    /// By how much the coordinates of all records are others with it.
    pub(in crate::identify::diagnostics) shift: DVector<f64>,
}

impl Whole {
    pub(super) fn of(all: &Normal) -> Option<Self> {
        let inverse = inverse(&all.matrix)?;
        let step = -(&inverse * &all.gradient);
        Some(Self { inverse, step })
    }

    /// A change of the coordinates at these places in the records of `after`, all others being fitted to all:
    /// with S = C − BᵀA⁻¹B of what is left of their information, δ = −S⁻¹(h − BᵀA⁻¹g), χ² = δᵀSδ and the shift of the
    /// others −A⁻¹Bδ.
    pub(super) fn step(&self, after: &Normal, places: &[usize], rank: usize) -> Option<Step> {
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

impl Search<'_> {
    /// What a change of all four parameters explains, if it is beyond chance.
    pub(in crate::identify::diagnostics) fn by_rows(
        &self,
        ranks: &[usize],
    ) -> Option<(f64, usize)> {
        let step = self.most(ranks, |c| Coordinate::PHYSICAL.contains(&c))?;
        Some((step.chi2, step.rank))
    }

    /// The rank from which on a change of some coordinates explains most, by the records' rows: with A
    /// and g the information and the gradient of all, B the columns of the coordinates in the information of the
    /// records after it, C their own block of that and h their part of its gradient, the change is δ of
    /// [A B; Bᵀ C] [θ; δ] = −[g; h]. Of very many records every second, third … is looked at.
    pub(in crate::identify::diagnostics) fn most(
        &self,
        ranks: &[usize],
        of: impl Fn(Coordinate) -> bool,
    ) -> Option<Step> {
        let problem = self.fitted.problem;
        let mut records: Vec<(usize, &PlacedRows)> = self
            .rows
            .iter()
            .map(|(i, rows)| (ranks[*i], rows))
            .collect();
        records.sort_by_key(|(rank, _)| *rank);
        let records = every(&records, MOST);
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
