//! Uncertainty beyond the covariance: profile likelihoods, a bootstrap over records, and what each
//! method contributed. Beside it: how far curves of the plane
//! may be off ([`band`]), the least error that any estimator can have ([`bound`]), and how often intervals
//! hold the truth ([`coverage`]).

pub mod band;
pub mod bound;
pub mod budget;
pub mod coverage;
pub mod profile;

pub use profile::ProfileCurve;

use std::collections::BTreeMap;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::identify::uncertainty::budget::Budget;
use crate::identify::uncertainty::profile::profile;
use impact_fit::evidence::options::{IntervalMethod, UncertaintyOptions};
use impact_fit::method::Method;
use impact_fit::method_fit::MethodFit;
use impact_fit::parameters::Coordinate;
use impact_fit::solver::normal::{Normal, inverse};
use impact_fit::solver::{Fit, Problem};
use impact_fit::statistics::scatter::Scatter;
use impact_records::signal::whole;

/// What a bootstrap over records gives for one parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bootstrapped {
    /// The parameter.
    pub parameter: Coordinate,
    /// Standard deviation over the replicas, SI.
    pub standard_error: f64,
    /// 2.5 and 97.5 percentiles over the replicas, SI.
    pub interval95: [f64; 2],
}

/// Uncertainty beside the covariance.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Uncertainty {
    /// Share of each method (and of `stated`, the laboratory's own knowledge of its instruments) in
    /// what is known of each parameter; the shares of a parameter add up to 1.
    pub information_share: BTreeMap<Coordinate, BTreeMap<InformationSource, f64>>,
    /// The sources of the joint estimate's uncertainty, and what they amount to.
    #[serde(default)]
    pub budget: Budget,
    /// Scatter between groups of records beyond noise and what is stated.
    #[serde(default)]
    pub scatter: Scatter,
    /// Profile likelihoods, where asked for.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub profiles: Vec<ProfileCurve>,
    /// Bootstrap, where asked for.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub bootstrap: Vec<Bootstrapped>,
}

impl Uncertainty {
    /// Without what it says of parameters whose estimates are not those of the joint fit.
    #[must_use]
    pub fn without(mut self, parameters: &[Coordinate]) -> Self {
        let stays = |parameter: &Coordinate| !parameters.contains(parameter);
        self.information_share.retain(|p, _| stays(p));
        self.budget.combined.retain(|c| stays(&c.parameter));
        for row in &mut self.budget.rows {
            row.contributions.retain(|c| stays(&c.parameter));
        }
        self.profiles.retain(|curve| stays(&curve.parameter));
        self.bootstrap.retain(|b| stays(&b.parameter));
        self
    }
}

/// What contains information on the parameters: a method, or the laboratory's own statements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InformationSource {
    /// What the laboratory states of its instruments.
    Stated,
    /// A method's observations.
    #[serde(untagged)]
    Method(Method),
}

/// All that is asked for, about a joint fit; `methods` are those of the problem's blocks.
pub fn uncertainty(
    problem: &Problem<'_>,
    methods: &[Method],
    found: &MethodFit,
    options: &UncertaintyOptions,
) -> Uncertainty {
    let (fit, factor) = (&found.fit, found.factor);
    let estimated = fit.estimated();
    Uncertainty {
        information_share: shares(methods, found, &estimated),
        profiles: match options.intervals {
            IntervalMethod::Profile => estimated
                .iter()
                .filter_map(|(_, c)| profile(problem, fit, factor, *c))
                .collect(),
            _ => Vec::new(),
        },
        bootstrap: match options.intervals {
            IntervalMethod::Bootstrap => bootstrap(problem, fit, options, &estimated),
            _ => Vec::new(),
        },
        ..Uncertainty::default()
    }
}

/// Share of each block in the information on each coordinate: (C F C)ᵢᵢ/Cᵢᵢ with the block's F.
fn shares(
    methods: &[Method],
    found: &MethodFit,
    estimated: &[(usize, Coordinate)],
) -> BTreeMap<Coordinate, BTreeMap<InformationSource, f64>> {
    let mut all: BTreeMap<Coordinate, BTreeMap<InformationSource, f64>> = BTreeMap::new();
    let methods = methods.iter().copied().map(InformationSource::Method);
    let sources = methods.chain([InformationSource::Stated]);
    let covariance = &found.fit.covariance;
    for (source, part) in sources.zip(&found.parts) {
        let spread = covariance * &part.matrix * covariance;
        for (i, coordinate) in estimated {
            let share = spread[(*i, *i)] / covariance[(*i, *i)];
            all.entry(*coordinate).or_default().insert(source, share);
        }
    }
    all
}

/// Bootstrap over the items of each block (records, impacts): drawn with replacement, each replica
/// fitted by one Newton step from the optimum; priors are drawn from their own distributions.
fn bootstrap(
    problem: &Problem<'_>,
    fit: &Fit,
    options: &UncertaintyOptions,
    estimated: &[(usize, Coordinate)],
) -> Vec<Bootstrapped> {
    let blocks = problem.item_parts(&fit.parameters);
    let replicas: Vec<Vec<f64>> = (0..options.replicas as u64)
        .into_par_iter()
        .filter_map(|i| replica(problem, fit, &blocks, options.seed, i))
        .collect();
    estimated
        .iter()
        .filter_map(|(i, coordinate)| {
            let best = fit.parameters.coordinate(*coordinate);
            let mut values: Vec<f64> = replicas.iter().map(|step| best + step[*i]).collect();
            values.sort_by(f64::total_cmp);
            summary(*coordinate, &values)
        })
        .collect()
}

fn replica(
    problem: &Problem<'_>,
    fit: &Fit,
    blocks: &[Vec<Normal>],
    seed: u64,
    index: u64,
) -> Option<Vec<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(index);
    let mut sum = Normal::zeros(fit.free.len());
    for items in blocks.iter().filter(|b| !b.is_empty()) {
        for _ in 0..items.len() {
            sum.add(&items[rng.random_range(0..items.len())]);
        }
    }
    for prior in &problem.priors {
        let mut part = problem.prior_normal(prior, &fit.parameters);
        let drawn: f64 = StandardNormal.sample(&mut rng);
        if let Some(i) = fit.free.iter().position(|c| *c == prior.coordinate) {
            part.gradient[i] += drawn / prior.deviation;
        }
        sum.add(&part);
    }
    let step = inverse(&sum.matrix)? * -&sum.gradient;
    Some(step.as_slice().to_vec())
}

fn summary(coordinate: Coordinate, sorted: &[f64]) -> Option<Bootstrapped> {
    let physical = |v: f64| coordinate.physical(v);
    let at = |share: f64| {
        let i = whole::index((share * (sorted.len().saturating_sub(1)) as f64).round());
        sorted.get(i).copied()
    };
    let mean = impact_records::signal::robust::mean(sorted);
    let apart: Vec<f64> = sorted
        .iter()
        .map(|v| physical(*v) - physical(mean))
        .collect();
    Some(Bootstrapped {
        parameter: coordinate,
        standard_error: impact_records::signal::robust::rms(&apart),
        interval95: [physical(at(0.025)?), physical(at(0.975)?)],
    })
}
