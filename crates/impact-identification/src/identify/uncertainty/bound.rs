//! The Cramér–Rao bound: what noise alone leaves open in the parameters, for each method on the
//! evidence it has.
//!
//! The information is that of the residuals' noise at given parameters; instruments' gains and
//! corners and the asymmetries are nuisances with their priors. Allowances for what the model
//! leaves open do not enter: no unbiased estimator does better than this.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use impact_fit::evidence::{Evidence, Nominal};
use impact_fit::method::{Estimator, Method};
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::boundaries::posterior::{self, Posterior};
use impact_fit::methods::boundaries::surroundings::Surroundings;
use impact_fit::methods::joint;
use impact_fit::parameters::{Coordinate, Parameters};

/// Least standard errors of the coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Bound {
    free: Vec<Coordinate>,
    covariance: DMatrix<f64>,
}

impl Bound {
    /// Least standard error of a coordinate: R absolute, the others relative.
    pub fn error(&self, coordinate: Coordinate) -> Option<f64> {
        let i = self.free.iter().position(|c| *c == coordinate)?;
        Some(self.covariance[(i, i)].max(0.0).sqrt())
    }

    /// Brackets have no information in Fisher's sense (their likelihood is flat inside): for R
    /// the posterior's deviation stands in.
    fn take_intervals(&mut self, posterior: Option<Posterior>) {
        let at = self.free.iter().position(|c| *c == Coordinate::Restitution);
        if let (Some(i), Some(found)) = (at, posterior) {
            self.covariance[(i, i)] = found.restitution.1.powi(2);
        }
    }
}

/// Bounds of every method on the evidence and of the joint fit, at given parameters.
pub fn bounds(evidence: &Evidence<'_>, at: &Parameters) -> BTreeMap<Estimator, Bound> {
    let mut blocks = Blocks::with_noise_alone(evidence);
    blocks.resonance.find_changes(at);
    blocks.trajectory.find_changes(at);
    let blocks = blocks;
    use Method::{Boundaries, Flights, Impacts, Resonance, Trajectories};
    let methods: [(Estimator, &[Method]); 6] = [
        (Estimator::Method(Resonance), &[Resonance]),
        (Estimator::Method(Trajectories), &[Trajectories]),
        (Estimator::Method(Boundaries), &[Boundaries, Resonance]),
        (Estimator::Method(Impacts), &[Impacts]),
        (Estimator::Method(Flights), &[Flights]),
        (
            Estimator::Joint,
            &[Resonance, Trajectories, Boundaries, Impacts],
        ),
    ];
    let mut bounds: BTreeMap<Estimator, Bound> = methods
        .into_iter()
        .filter_map(|(estimator, methods)| {
            Some((estimator, bound(&blocks, methods, &evidence.nominal, at)?))
        })
        .collect();
    let curve = bounds.get(&Estimator::Method(Resonance));
    let posterior = curve.and_then(|curve| {
        let known = (curve.free.as_slice(), &curve.covariance);
        let surroundings = Surroundings::of(&blocks, &evidence.nominal, (at, known));
        posterior::of_brackets(&blocks.boundary, &surroundings, None)
    });
    if let Some(found) = bounds.get_mut(&Estimator::Method(Boundaries)) {
        found.take_intervals(posterior);
    }
    bounds
}

fn bound(blocks: &Blocks, methods: &[Method], nominal: &Nominal, at: &Parameters) -> Option<Bound> {
    let weights = methods.iter().map(|method| (*method, 1.0)).collect();
    let problem = joint::problem(blocks, *at, &weights, nominal, None)?;
    let covariance = problem.covariance_at(at)?;
    Some(Bound {
        free: problem.free,
        covariance,
    })
}
