//! How much residuals may be trusted: what is allowed beside the noise, and which records do not
//! belong to the bulk.

use rayon::prelude::*;

use crate::methods::blocks::Blocks;
use crate::methods::flights::block::FlightBlock;
use crate::methods::trajectories::block::TrajectoryBlock;
use crate::methods::trajectories::record::Misfit;
use crate::parameters::Parameters;
use crate::solver::mean_squares;
use crate::solver::scalar::least;
use crate::statistics::quantile::chi_squared_99;
use impact_records::signal::robust;

impl Blocks {
    /// Weigh resonance curve and trajectories as the fit that led to these parameters did.
    pub fn weigh(&mut self, parameters: &Parameters) {
        self.weigh_resonance(parameters);
        self.weigh_trajectories(parameters);
    }

    /// Allow impactless and periodic records the least error beside the noise, with the changes by effects as they
    /// are at parameters.
    pub fn allow_least(&mut self, at: &Parameters) {
        self.resonance.find_changes(at);
        self.trajectory.find_changes(at);
        self.resonance.allow(LEAST_ALLOWANCE);
        self.trajectory.allow(LEAST_ALLOWANCE);
    }

    /// Leave out periodic records without an orbit at parameters.
    pub fn keep_those_with_an_orbit(&mut self, at: &Parameters) {
        let has_orbit = mean_squares(&self.trajectory, at);
        let mut has_orbit = has_orbit.iter().map(Option::is_some);
        let records = &mut self.trajectory.records;
        records.retain(|_| has_orbit.next().unwrap_or(false));
    }

    /// Find what the errors of the drive's frequency change in the impactless records, and allow them
    /// the least relative error that explains the rest.
    pub fn weigh_resonance(&mut self, parameters: &Parameters) {
        let block = &mut self.resonance;
        block.find_changes(parameters);
        let allowed = least_allowance(|allowance| {
            block.allow(allowance);
            mean_squares(block, parameters)
                .into_iter()
                .flatten()
                .collect()
        });
        block.allow(allowed);
    }

    /// Find what the points of each periodic record share and what effects beyond the model change
    /// in them, and allow all the least relative error that explains the rest.
    pub fn weigh_trajectories(&mut self, parameters: &Parameters) {
        let block = &mut self.trajectory;
        block.find_changes(parameters);
        let differences = block.differences(parameters);
        let misfits = misfits(block, &differences);
        let allowed = least_allowance(|allowance| mean_squares_with(&misfits, allowance));
        block.allow(allowed);
    }

    /// Allow R the scatter from impact to impact that is most likely by the records that are shot from impact to
    /// impact; tells whether it is another than before.
    pub fn weigh_flights(&mut self, at: &Parameters) -> bool {
        let before = self.flight.scatter().max(LEAST_ALLOWANCE);
        let allowed = most_likely_scatter(&self.flight, at);
        self.flight.allow(allowed);
        (allowed / before).ln().abs() > SAME_ALLOWANCE
    }

    /// Whether the relative error that periodic records are allowed is, but for a share of it, the least
    /// that explains what is left at parameters.
    pub fn allows_trajectories_the_least(&self, at: &Parameters, share: f64) -> bool {
        let differences = self.trajectory.differences(at);
        let misfits = misfits(&self.trajectory, &differences);
        let allowed = self.trajectory.relative_error();
        let explains = |allowance: f64| is_explained(&mean_squares_with(&misfits, allowance));
        let less = allowed * (1.0 - share);
        explains(allowed * (1.0 + share)) && (less < LEAST_ALLOWANCE || !explains(less))
    }
}

/// The scatter of R with the greatest likelihood at parameters; next to none where chance explains it.
pub fn most_likely_scatter(block: &FlightBlock, at: &Parameters) -> f64 {
    let ends = [LEAST_ALLOWANCE, MOST_ALLOWANCE].map(f64::ln);
    let deviance = |scatter: f64| block.deviance(at, scatter);
    let found = least(|ln| deviance(ln.exp()), ends, 0.1 * SAME_ALLOWANCE).map(f64::exp);
    let none = deviance(LEAST_ALLOWANCE);
    let shown = found.filter(|scatter| none - deviance(*scatter) > chi_squared_99(1.0));
    shown.unwrap_or(LEAST_ALLOWANCE)
}

/// What the model leaves of each periodic record that it has.
fn misfits<'a>(block: &'a TrajectoryBlock, differences: &'a [Option<Vec<f64>>]) -> Vec<Misfit<'a>> {
    let pairs = block.records.par_iter().zip(differences);
    let known = pairs.filter_map(|(record, apart)| Some(Misfit::new(record, apart.as_ref()?)));
    known.collect()
}

/// The mean square of each with a relative error allowed beside the noise.
fn mean_squares_with(misfits: &[Misfit<'_>], allowance: f64) -> Vec<f64> {
    let all = misfits.par_iter();
    all.map(|misfit| misfit.mean_square(allowance)).collect()
}

/// Relative error that is always allowed, so that weights stay finite on noiseless data.
pub const LEAST_ALLOWANCE: f64 = 1e-6;
/// Logarithm of the ratio of two allowances that weigh alike.
const SAME_ALLOWANCE: f64 = 0.1;
/// Greatest relative error that instruments and model may be allowed.
const MOST_ALLOWANCE: f64 = 0.1;

/// The least relative error beside the noise with which residuals are of unit size; next to none where
/// the noise alone explains them.
fn least_allowance(mut scores: impl FnMut(f64) -> Vec<f64>) -> f64 {
    let mut explains = |allowance: f64| is_explained(&scores(allowance));
    if explains(LEAST_ALLOWANCE) {
        return LEAST_ALLOWANCE;
    }
    let (mut low, mut high) = (LEAST_ALLOWANCE, MOST_ALLOWANCE);
    for _ in 0..14 {
        let middle = (low * high).sqrt();
        if explains(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

/// Whether residuals are at most of unit size. The median of the items' mean squares is judged, so that a few
/// records that do not belong change nothing.
fn is_explained(mean_squares: &[f64]) -> bool {
    robust::median(mean_squares).unwrap_or(0.0) <= 1.0
}

/// What mean squares of records that belong together look like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bulk {
    /// The typical one, at least 1.
    pub typical: f64,
    /// The greatest that still belongs.
    pub limit: f64,
}

/// How many times the typical mean square a record of the bulk may have at most.
const OUTLYING: f64 = 25.0;
/// And how many times it may always have.
const SCATTER: f64 = 1.6;

impl Bulk {
    /// The bulk of mean squares: up to six robust deviations of their logarithm above their
    /// median, so that records of one quality do not hide one that is worse.
    pub fn of(scores: &[f64]) -> Self {
        let logs: Vec<f64> = scores.iter().map(|s| s.max(1e-12).ln()).collect();
        let typical = robust::median(scores).unwrap_or(1.0).max(1.0);
        let spread = robust::robust_deviation(&logs).unwrap_or(1.0);
        Self {
            typical,
            limit: typical * (6.0 * spread).exp().clamp(SCATTER, OUTLYING),
        }
    }

    /// How many times worse than the typical record one fits.
    pub fn times_worse(self, score: f64) -> f64 {
        (score / self.typical).sqrt()
    }
}
