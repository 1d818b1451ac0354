//! What acts on a boundary beside R: the parameters that the resonance curve determines, the rig's asymmetry and
//! effects, the errors of its clearances, all as independent standard normal deviates.

use nalgebra::{DMatrix, DVector};

use crate::evidence::Nominal;
use crate::method_fit::MethodFit;
use crate::methods::blocks::Blocks;
use crate::methods::boundaries::block::{
    BoundaryBlock, BoundaryPlace, alternating_hz, predicted_hz,
};
use crate::parameters::effect::Effect;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::{Block, Prior};
use impact_records::motion::Bracket;

/// Where a boundary lies, and how far each deviate moves it.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedBoundary {
    /// Drive frequency with all deviates zero, Hz.
    pub frequency_hz: f64,
    /// Hz per unit of each deviate.
    pub direction: DVector<f64>,
    /// Up to how far from there records may still show the motion of the other side, Hz; negative below.
    pub alternating_hz: f64,
}

impl SimulatedBoundary {
    /// The middle of where records may show it, Hz.
    pub fn seen_hz(&self) -> f64 {
        self.frequency_hz + 0.5 * self.alternating_hz
    }
}

/// One independent standard normal deviate.
#[derive(Debug, Clone)]
enum Deviate {
    /// Changes coordinates of the fit, each by so much per unit.
    Coordinates(Vec<(Coordinate, f64)>),
    /// Changes one clearance by so much per unit, m.
    Clearance { clearance_m: f64, by_m: f64 },
}

/// The deviates about the parameters at which the boundaries are linear in them.
#[derive(Debug, Clone)]
pub struct Surroundings {
    about: Parameters,
    deviates: Vec<Deviate>,
    /// Place of the length of contacts among the deviates: it cannot be negative, and the boundaries are linear
    /// about its mean.
    length: Option<usize>,
}

/// Mean of a normal deviate that is positive, √(2/π).
const MEAN_OF_POSITIVE: f64 = 0.797_884_560_802_865_4;
/// Deviates by which a boundary's slope over each is taken.
const STEP: f64 = 0.5;
/// Share of the frequency by which its slope is taken.
const FREQUENCY_STEP: f64 = 1e-4;
/// Largest relative error of a coordinate over which a boundary counts as linear.
const LINEAR: f64 = 0.3;

impl Surroundings {
    /// As a fit of the resonance curve and the priors of all else that acts on boundaries have it.
    pub fn new(blocks: &Blocks, nominal: &Nominal, resonance: &MethodFit) -> Self {
        let covariance = resonance.fit.covariance.clone() * resonance.factor;
        let known = (resonance.fit.free.as_slice(), &covariance);
        Self::of(blocks, nominal, (&resonance.fit.parameters, known))
    }

    /// About parameters with the covariance of some coordinates, and the priors of the others.
    pub fn of(
        blocks: &Blocks,
        nominal: &Nominal,
        (about, (free, covariance)): (&Parameters, (&[Coordinate], &DMatrix<f64>)),
    ) -> Self {
        let block = &blocks.boundary;
        let (mut others, mut priors) = (Vec::new(), Vec::new());
        blocks.add_nuisances(nominal, &[(block, 1.0)], &mut others, &mut priors);
        priors.retain(|p| !free.contains(&p.coordinate));
        let correlated = correlated(block, free, covariance);
        let clearances = clearances(block, nominal.clearance_uncertainty_m);
        Self::with(about, correlated, &priors).and(clearances)
    }

    /// About parameters that are known, with priors of what else acts on boundaries.
    pub fn known(about: &Parameters, priors: &[Prior]) -> Self {
        Self::with(about, Vec::new(), priors)
    }

    fn with(about: &Parameters, mut deviates: Vec<Deviate>, priors: &[Prior]) -> Self {
        let mut about = *about;
        let mut length = None;
        for prior in priors {
            let coordinate = prior.coordinate;
            about = about.with(coordinate, prior.centre);
            if coordinate == Coordinate::Effect(Effect::ContactDuration) {
                about = about.with(coordinate, MEAN_OF_POSITIVE * prior.deviation);
                length = Some(deviates.len());
            }
            deviates.push(Deviate::Coordinates(vec![(coordinate, prior.deviation)]));
        }
        Self {
            about,
            deviates,
            length,
        }
    }

    fn and(mut self, more: Vec<Deviate>) -> Self {
        self.deviates.extend(more);
        self
    }

    /// Where the boundaries of all brackets lie at R; `None` of one that does not reach its clearance.
    pub fn boundaries(
        &self,
        block: &BoundaryBlock,
        restitution: f64,
    ) -> Vec<Option<SimulatedBoundary>> {
        let brackets = block.brackets.iter();
        brackets
            .map(|bracket| self.boundary(block, bracket, restitution))
            .collect()
    }

    /// Place of the length of contacts among the deviates, if it is one of them.
    pub fn length(&self) -> Option<usize> {
        self.length
    }

    /// The same with contacts without length.
    #[must_use]
    pub fn of_instants(&self) -> Self {
        let mut instants = self.clone();
        if let Some(length) = instants.length.take() {
            instants.deviates.remove(length);
            let duration = Coordinate::Effect(Effect::ContactDuration);
            instants.about = instants.about.with(duration, 0.0);
        }
        instants
    }

    /// The direction of the deviate that must be positive, if there is one.
    pub fn positive(&self) -> Option<DVector<f64>> {
        let mut direction = DVector::zeros(self.deviates.len());
        direction[self.length?] = 1.0;
        Some(direction)
    }

    /// Where the boundary of a bracket lies at R, along a known direction.
    pub fn boundary_along(
        &self,
        block: &BoundaryBlock,
        bracket: &Bracket,
        restitution: f64,
        direction: DVector<f64>,
    ) -> Option<SimulatedBoundary> {
        let about = &self.at(restitution);
        let frequency_hz = predicted_hz(bracket, about, block.rig)?;
        let alternating_hz = alternating_hz(bracket, about, block.rig, frequency_hz);
        Some(self.without_length(frequency_hz, direction, alternating_hz))
    }

    /// A boundary with all deviates zero, from where it lies with contacts of the mean length.
    fn without_length(
        &self,
        frequency_hz: f64,
        direction: DVector<f64>,
        alternating_hz: f64,
    ) -> SimulatedBoundary {
        let at_mean = self.length.map_or(0.0, |i| direction[i] * MEAN_OF_POSITIVE);
        SimulatedBoundary {
            frequency_hz: frequency_hz - at_mean,
            direction,
            alternating_hz,
        }
    }

    fn at(&self, restitution: f64) -> Parameters {
        Parameters {
            restitution,
            ..self.about
        }
    }

    /// Where the boundary of a bracket lies at R; `None` if it does not reach its clearance.
    pub fn boundary(
        &self,
        block: &BoundaryBlock,
        bracket: &Bracket,
        restitution: f64,
    ) -> Option<SimulatedBoundary> {
        let about = &self.at(restitution);
        let frequency_hz = predicted_hz(bracket, about, block.rig)?;
        let place = BoundaryPlace::of(bracket, about, block.rig);
        let step_hz = FREQUENCY_STEP * frequency_hz;
        let over_frequency = (place.excess(frequency_hz + step_hz)
            - place.excess(frequency_hz - step_hz))
            / (2.0 * step_hz);
        let acts = |deviate: &Deviate| match deviate {
            Deviate::Coordinates(_) => true,
            Deviate::Clearance { clearance_m, .. } => *clearance_m == bracket.clearance_m,
        };
        let moved = |deviate: &Deviate| {
            if !acts(deviate) {
                return 0.0;
            }
            let excess = |by: f64| match deviate {
                Deviate::Coordinates(list) => {
                    let shifted = list.iter().fold(*about, |p, (coordinate, per_unit)| {
                        p.with(*coordinate, p.coordinate(*coordinate) + by * per_unit)
                    });
                    BoundaryPlace::of(bracket, &shifted, block.rig).excess(frequency_hz)
                }
                Deviate::Clearance { by_m, .. } => {
                    let mut place = BoundaryPlace::of(bracket, about, block.rig);
                    place.clearance_error_m = by * by_m;
                    place.excess(frequency_hz)
                }
            };
            -(excess(STEP) - excess(-STEP)) / (2.0 * STEP * over_frequency)
        };
        let direction =
            DVector::from_iterator(self.deviates.len(), self.deviates.iter().map(moved));
        let known = direction.iter().all(|d| d.is_finite());
        known.then(|| {
            let alternating_hz = alternating_hz(bracket, about, block.rig, frequency_hz);
            self.without_length(frequency_hz, direction, alternating_hz)
        })
    }
}

/// Deviates of the coordinates that act on boundaries, from their covariance among all that are free.
fn correlated(
    block: &BoundaryBlock,
    free: &[Coordinate],
    covariance: &DMatrix<f64>,
) -> Vec<Deviate> {
    let acting = |c: &Coordinate| *c != Coordinate::Restitution && block.touches(*c);
    let places: Vec<usize> = (0..free.len()).filter(|i| acting(&free[*i])).collect();
    let scale: Vec<f64> = places
        .iter()
        .map(|i| covariance[(*i, *i)].max(1e-24).sqrt())
        .collect();
    // of the correlations: coordinates have different units
    let correlation = DMatrix::from_fn(places.len(), places.len(), |i, k| {
        let own = covariance[(places[i], places[k])] / (scale[i] * scale[k]);
        if i == k { 1.0 + 1e-9 } else { own }
    });
    let Some(cholesky) = correlation.cholesky() else {
        let alone = places.iter().zip(&scale);
        return alone
            .map(|(i, deviation)| Deviate::Coordinates(vec![(free[*i], deviation.min(LINEAR))]))
            .collect();
    };
    let lower = cholesky.l();
    (0..places.len())
        .map(|k| {
            let moved =
                (k..places.len()).map(|i| (free[places[i]], lower[(i, k)] * scale[i].min(LINEAR)));
            Deviate::Coordinates(moved.collect())
        })
        .collect()
}

/// A deviate for each clearance of the brackets.
fn clearances(block: &BoundaryBlock, uncertainty_m: f64) -> Vec<Deviate> {
    let mut stated: Vec<f64> = block.brackets.iter().map(|b| b.clearance_m).collect();
    stated.sort_by(f64::total_cmp);
    stated.dedup();
    let own = |clearance_m| Deviate::Clearance {
        clearance_m,
        by_m: uncertainty_m,
    };
    let uncertain = stated.into_iter().filter(|_| uncertainty_m > 0.0);
    uncertain.map(own).collect()
}
