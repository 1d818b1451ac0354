//! All campaigns as one Gaussian, with one unknown for each nuisance that is shared.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{DMatrix, DVector};

use crate::compare::chart::Chart;
use crate::compare::share::{Nuisance, Sharing};
use crate::compare::{Campaign, chart};
use impact_fit::JointFit;
use impact_fit::parameters::coordinate::Coordinate;
use impact_fit::solver::normal::inverse;

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
        let relative = chart::relative(campaigns, sharing);
        let places = campaigns
            .iter()
            .enumerate()
            .map(|(number, campaign)| sum.campaign(number, campaign, sharing, &relative))
            .collect::<Option<Vec<_>>>()?;
        for prior in std::mem::take(&mut sum.priors).into_values() {
            sum.prior(&prior);
        }
        let count = sum.vector.len();
        let mut information = DMatrix::zeros(count, count);
        for ((row, column), value) in sum.information {
            information[(row, column)] += value;
        }
        let covariance = inverse(&information)?;
        Some(Self {
            mean: DVector::from_vec(sum.reference) + &covariance * DVector::from_vec(sum.vector),
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

/// The prior of a shared nuisance: the widest that a campaign states, times the greatest factor on their
/// covariances, so that it says no more than in any of their own fits.
#[derive(Debug)]
struct SharedPrior {
    /// Places of the unknowns whose sum of multiples it is on.
    row: Vec<(usize, f64)>,
    /// Of their deviations.
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
    /// Values near those of all unknowns. What is known of them is summed as deviations from these: the
    /// values themselves, times information about directions known a million times better than others,
    /// would cancel to nothing but rounding.
    reference: Vec<f64>,
    /// Information times deviations.
    vector: Vec<f64>,
    /// Places of the shared unknowns, by their numbers among the shared ones.
    shared: BTreeMap<usize, usize>,
    /// Their priors by the same numbers.
    priors: BTreeMap<usize, SharedPrior>,
}

impl Sum {
    fn add(&mut self, row: usize, column: usize, value: f64) {
        *self.information.entry((row, column)).or_default() += value;
    }

    /// Add a prior of a shared nuisance.
    fn prior(&mut self, prior: &SharedPrior) {
        let information = prior.information();
        for (i, slope) in &prior.row {
            self.vector[*i] += slope * information * prior.centre;
            for (k, other) in &prior.row {
                self.add(*i, *k, slope * information * other);
            }
        }
    }

    /// A new unknown near a value.
    fn next(&mut self, value: f64) -> usize {
        self.vector.push(0.0);
        self.reference.push(value);
        self.vector.len() - 1
    }

    /// The place of a shared unknown by its number, or the next one.
    fn place_of(&mut self, class: Option<usize>, value: f64) -> usize {
        let known = class.and_then(|class| self.shared.get(&class).copied());
        let place = known.unwrap_or_else(|| self.next(value));
        if let Some(class) = class {
            self.shared.insert(class, place);
        }
        place
    }

    /// Add a campaign; gives the places of its parameters.
    fn campaign(
        &mut self,
        number: usize,
        campaign: &Campaign,
        sharing: &Sharing,
        relative: &BTreeSet<Nuisance>,
    ) -> Option<BTreeMap<Coordinate, usize>> {
        let mut places = BTreeMap::new();
        if let Some(joint) = &campaign.fit {
            let shared = |nuisance| number_of(sharing, nuisance, number);
            self.fit(joint, shared, relative, &mut places)?;
        }
        for parameter in Coordinate::PHYSICAL {
            let Some(known) = campaign.known(parameter) else {
                continue;
            };
            if places.contains_key(&parameter) || !(known.variance > 0.0) {
                continue;
            }
            // what rests on no fit is separate
            let place = self.next(known.value);
            self.add(place, place, known.variance.recip());
            places.insert(parameter, place);
        }
        Some(places)
    }

    /// Add a joint fit, without the priors of what it shares.
    fn fit(
        &mut self,
        joint: &JointFit,
        shared: impl Fn(Nuisance) -> Option<usize>,
        relative: &BTreeSet<Nuisance>,
        places: &mut BTreeMap<Coordinate, usize>,
    ) -> Option<()> {
        let (fit, factor) = (&joint.fit, joint.variance_factor);
        let chart = Chart::new(joint, relative);
        let mut information = chart.information(&inverse(&fit.covariance)?) / factor;
        let classes: Vec<Option<usize>> = fit
            .free
            .iter()
            .map(|coordinate| Nuisance::of(*coordinate, joint).and_then(&shared))
            .collect();
        let values = chart.values();
        let own: Vec<usize> = classes
            .iter()
            .zip(values)
            .map(|(class, value)| self.place_of(*class, *value))
            .collect();
        let reference = DVector::from_iterator(own.len(), own.iter().map(|k| self.reference[*k]));
        let mut vector = &information * (values - &reference);
        for (i, class) in classes.iter().enumerate() {
            let mut priors = joint.priors.iter();
            let prior = priors.find(|p| p.coordinate == fit.free[i]);
            let Some((class, prior)) = class.zip(prior) else {
                continue;
            };
            let variance = prior.deviation.powi(2);
            let (row, centre) = chart.prior(i, prior.centre, &reference);
            for (k, slope) in &row {
                vector[*k] -= slope * centre / (variance * factor);
                for (l, other) in &row {
                    information[(*k, *l)] -= slope * other / (variance * factor);
                }
            }
            let all = self.priors.entry(class).or_insert_with(|| SharedPrior {
                row: row.iter().map(|(k, slope)| (own[*k], *slope)).collect(),
                centre,
                variance,
                factor,
            });
            all.variance = all.variance.max(variance);
            all.factor = all.factor.max(factor);
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
