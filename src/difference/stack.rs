//! All campaigns as one Gaussian, with one unknown for each nuisance that is shared.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use crate::difference::Campaign;
use crate::difference::share::{Nuisance, Sharing};
use crate::identify::JointFit;
use crate::identify::fit::coordinate::Coordinate;
use crate::identify::fit::normal::inverse;

/// The most probable values of all unknowns of all campaigns and their covariance.
#[derive(Debug)]
pub(super) struct Stack {
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    /// Places of the parameters, campaign by campaign.
    places: Vec<BTreeMap<Coordinate, usize>>,
}

impl Stack {
    /// Combine campaigns by what they share; `None` where their information is singular.
    pub(super) fn new(campaigns: &[Campaign], sharing: &Sharing) -> Option<Self> {
        let mut sum = Sum::default();
        let places = campaigns
            .iter()
            .enumerate()
            .map(|(number, campaign)| sum.campaign(number, campaign, sharing))
            .collect::<Option<Vec<_>>>()?;
        let shared = sum.priors.clone();
        for (place, prior) in shared {
            sum.add(place, place, prior.information());
            sum.vector[place] += prior.information() * prior.centre;
        }
        let count = sum.vector.len();
        let mut information = DMatrix::zeros(count, count);
        for ((row, column), value) in sum.information {
            information[(row, column)] += value;
        }
        let covariance = inverse(&information)?;
        Some(Self {
            mean: &covariance * DVector::from_vec(sum.vector),
            covariance,
            places,
        })
    }

    /// Number of unknowns.
    pub(super) fn unknowns(&self) -> usize {
        self.mean.len()
    }

    /// Place of a campaign's parameter.
    pub(super) fn place(&self, campaign: usize, parameter: Coordinate) -> Option<usize> {
        self.places.get(campaign)?.get(&parameter).copied()
    }

    /// The most probable value of an unknown.
    pub(super) fn value(&self, place: usize) -> f64 {
        self.mean[place]
    }

    /// The covariance of linear combinations of the unknowns, one in each row.
    pub(super) fn covariance_of(&self, rows: &DMatrix<f64>) -> DMatrix<f64> {
        rows * &self.covariance * rows.transpose()
    }
}

/// The prior of a shared unknown: the widest that a campaign states, times the greatest factor on their
/// covariances, so that it says no more than in any of their own fits.
#[derive(Debug, Clone, Copy)]
struct SharedPrior {
    centre: f64,
    variance: f64,
    factor: f64,
}

impl SharedPrior {
    fn information(&self) -> f64 {
        1.0 / (self.variance * self.factor)
    }
}

/// The information of all campaigns while it is summed.
#[derive(Debug, Default)]
struct Sum {
    information: BTreeMap<(usize, usize), f64>,
    /// Information times values.
    vector: Vec<f64>,
    /// Places of the shared unknowns, by their numbers among the shared ones.
    shared: BTreeMap<usize, usize>,
    /// Their priors by their places.
    priors: BTreeMap<usize, SharedPrior>,
}

impl Sum {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        *self.information.entry((row, column)).or_default() += value;
    }

    fn next(&mut self) -> usize {
        self.vector.push(0.0);
        self.vector.len() - 1
    }

    /// Add a campaign; gives the places of its parameters.
    fn campaign(
        &mut self,
        number: usize,
        campaign: &Campaign,
        sharing: &Sharing,
    ) -> Option<BTreeMap<Coordinate, usize>> {
        let mut places = BTreeMap::new();
        if let Some(joint) = &campaign.fit {
            self.fit(
                joint,
                |nuisance| number_of(sharing, nuisance, number),
                &mut places,
            )?;
        }
        for parameter in Coordinate::PHYSICAL {
            let Some(known) = campaign.known(parameter) else {
                continue;
            };
            if places.contains_key(&parameter) || !(known.variance > 0.0) {
                continue;
            }
            // what rests on no fit is separate
            let place = self.next();
            self.add(place, place, known.variance.recip());
            self.vector[place] += known.value / known.variance;
            places.insert(parameter, place);
        }
        Some(places)
    }

    /// Add a joint fit, without the priors of what it shares.
    fn fit(
        &mut self,
        joint: &JointFit,
        shared: impl Fn(Nuisance) -> Option<usize>,
        places: &mut BTreeMap<Coordinate, usize>,
    ) -> Option<()> {
        let (fit, factor) = (&joint.fit, joint.variance_factor);
        let mut information = inverse(&fit.covariance)? / factor;
        let at = |c: &Coordinate| fit.parameters.coordinate(*c);
        let values = DVector::from_iterator(fit.free.len(), fit.free.iter().map(at));
        let mut vector = &information * values;
        let mut own = Vec::with_capacity(fit.free.len());
        for (i, coordinate) in fit.free.iter().enumerate() {
            let class = Nuisance::of(*coordinate, joint).and_then(&shared);
            let Some(class) = class else {
                own.push(self.next());
                continue;
            };
            let known = self.shared.get(&class).copied();
            let place = known.unwrap_or_else(|| self.next());
            self.shared.insert(class, place);
            let mut priors = joint.priors.iter().filter(|p| p.coordinate == *coordinate);
            if let Some(prior) = priors.next() {
                let variance = prior.deviation.powi(2);
                information[(i, i)] -= 1.0 / (variance * factor);
                vector[i] -= prior.centre / (variance * factor);
                let all = self.priors.entry(place).or_insert(SharedPrior {
                    centre: prior.centre,
                    variance,
                    factor,
                });
                all.variance = all.variance.max(variance);
                all.factor = all.factor.max(factor);
            }
            own.push(place);
        }
        for (i, row) in own.iter().enumerate() {
            self.vector[*row] += vector[i];
            for (k, column) in own.iter().enumerate() {
                self.add(*row, *column, information[(i, k)]);
            }
        }
        let parameters = fit.free.iter().zip(own);
        let parameters = parameters.filter(|(c, _)| Coordinate::PHYSICAL.contains(c));
        places.extend(parameters.map(|(c, place)| (*c, place)));
        Some(())
    }
}

/// Number among the shared ones of a campaign's nuisance.
fn number_of(sharing: &Sharing, nuisance: Nuisance, campaign: usize) -> Option<usize> {
    let mut shared = sharing.shared.iter();
    shared.position(|(of, shared)| *of == nuisance && shared.campaigns.contains(&campaign))
}
