//! A method's fit and the errors of what it estimates.

use nalgebra::DMatrix;

use crate::parameters::Coordinate;
use crate::solver::normal::{Normal, inverse};
use crate::solver::{Fit, Precision, Problem};
use crate::statistics::scatter::{self, Scatter, Spread};
use crate::statistics::shared_gains::shared_gains;

/// A method's fit with its variance factor and the items left out.
#[derive(Debug, Clone)]
pub struct MethodFit {
    /// The fit.
    pub fit: Fit,
    /// Factor on the covariance: the reduced sum of squares, at least 1.
    pub factor: f64,
    /// Reduced sum of squares as it came out.
    pub reduced: f64,
    /// Scatter between groups of records beyond it; not looked for where the fit only starts another.
    pub scatter: Scatter,
    /// What gains of one mass leave open that may have been calibrated together, of R absolute, of the others
    /// relative; not looked for either.
    pub shared_gains: Vec<(Coordinate, f64)>,
    /// Normal equations at the optimum of each block, then those of all priors; none where the fit only
    /// starts another.
    pub parts: Vec<Normal>,
}

/// Share of an effect that its first order does not hold, of what it changes of a parameter: what
/// campaigns on rigs with all effects showed. f0 follows from phases and R from speeds at the same
/// impact, in which effects cancel; β and `x_st` follow from amplitudes.
fn beyond_first_order(parameter: Coordinate) -> f64 {
    match parameter {
        Coordinate::Frequency => 0.0028,
        Coordinate::Restitution => 0.011,
        Coordinate::Damping => 0.035,
        _ => 0.03,
    }
}

impl MethodFit {
    /// Of a fit of a problem, judged with degrees of freedom.
    pub fn of(problem: &Problem<'_>, fit: Fit, freedom: usize) -> Self {
        let reduced = fit.cost / freedom.max(1) as f64;
        let factor = reduced.max(1.0);
        let (scatter, shared_gains, parts) = match problem.precision {
            Precision::Result => (
                scatter::scatter(problem, &fit),
                shared_gains(problem, &fit, factor),
                problem.parts(&fit.parameters),
            ),
            Precision::Start => Default::default(),
        };
        Self {
            factor,
            reduced,
            scatter,
            shared_gains,
            parts,
            fit,
        }
    }

    /// Standard error of a coordinate by all that is allowed for; `None` where it was not free.
    pub fn spread(&self, coordinate: Coordinate) -> Option<Spread> {
        let spread = self.scatter.spread(&self.fit, self.factor, coordinate)?;
        let beyond = self.first_order(coordinate).unwrap_or(0.0);
        Some(spread.with(beyond).with(self.by_shared_gains(coordinate)))
    }

    /// Standard uncertainty of a parameter as gains of one mass may have been calibrated together.
    pub fn by_shared_gains(&self, coordinate: Coordinate) -> f64 {
        let own = self.shared_gains.iter().find(|(c, _)| *c == coordinate);
        own.map_or(0.0, |(_, by)| *by)
    }

    /// What the effects beyond the model leave open in a parameter as they are treated to first order:
    /// a share of what each would change of it if it were left out and R, f0, β and `x_st` alone were
    /// fitted again, −(`A_pp⁻¹A_pk`) times its strength.
    pub fn first_order(&self, coordinate: Coordinate) -> Option<f64> {
        let fit = &self.fit;
        let place = |c: &Coordinate| fit.free.iter().position(|f| f == c);
        let estimated: Vec<usize> = Coordinate::PHYSICAL.iter().filter_map(place).collect();
        let row = estimated.iter().position(|i| fit.free[*i] == coordinate)?;
        let information = inverse(&fit.covariance)?;
        let count = estimated.len();
        let own = DMatrix::from_fn(count, count, |i, k| {
            information[(estimated[i], estimated[k])]
        });
        let back = inverse(&own)?;
        let share = beyond_first_order(coordinate);
        let effects = fit.free.iter().enumerate();
        let effects = effects.filter(|(_, c)| matches!(c, Coordinate::Effect(_)));
        let change = |(k, c): (usize, &Coordinate)| {
            let pulled = estimated.iter().enumerate();
            let pulled = pulled.map(|(i, at)| back[(row, i)] * information[(*at, k)]);
            share * pulled.sum::<f64>() * fit.parameters.coordinate(*c)
        };
        Some(effects.map(change).map(|c| c * c).sum::<f64>().sqrt())
    }
}
