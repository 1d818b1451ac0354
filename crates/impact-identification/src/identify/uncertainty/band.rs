//! How far a curve in the (η, ρ) plane may be off: what the fit leaves open in R and β, on which alone
//! the boundaries of the symmetric machine depend there.

use impact_fit::parameters::Coordinate;
use impact_fit::solver::Fit;
use impact_fit::statistics::quantile::NORMAL_975;
use impact_oscillator::model::params::Machine;
use impact_records::event::RigKind;

/// The machines that a fit leaves possible, one standard error off in R and in β.
#[derive(Debug, Clone)]
pub struct Spread {
    /// One standard error below and above, of each that was fitted.
    ends: Vec<[Machine; 2]>,
    /// Correlation of the two.
    correlation: f64,
}

impl Spread {
    /// Of a fit with a factor on its covariance; asymmetries are left out.
    pub fn of(fit: &Fit, factor: f64, rig: RigKind) -> Self {
        let estimated = [Coordinate::Restitution, Coordinate::Damping];
        let ends = estimated
            .into_iter()
            .filter_map(|coordinate| {
                let error = fit.error(coordinate)? * factor.sqrt();
                let centre = fit.parameters.coordinate(coordinate);
                Some([-error, error].map(|by| {
                    let moved = fit.parameters.with(coordinate, centre + by);
                    moved.without_asymmetry().machine(rig)
                }))
            })
            .collect();
        Self {
            ends,
            correlation: fit.correlation(estimated[0], estimated[1]).unwrap_or(0.0),
        }
    }

    /// Half the 95 % interval of what a machine has, from its slopes; `None` where a machine nearby
    /// does not have it.
    pub fn half95(&self, has: impl Fn(&Machine) -> Option<f64>) -> Option<f64> {
        let per_error: Vec<f64> = self
            .ends
            .iter()
            .map(|[below, above]| Some(0.5 * (has(above)? - has(below)?)))
            .collect::<Option<_>>()?;
        let common = match per_error[..] {
            [a, b] => 2.0 * self.correlation * a * b,
            _ => 0.0,
        };
        let variance = per_error.iter().map(|s| s * s).sum::<f64>() + common;
        Some(NORMAL_975 * variance.max(0.0).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use impact_fit::parameters::Parameters;
    use impact_fit::solver::FitReport;

    #[test]
    fn valid_the_band_of_r_and_beta_themselves_is_their_interval() {
        let (r, beta, correlation) = (2e-3, 5e-3, -0.4);
        let common = correlation * r * beta;
        let fit = Fit {
            parameters: Parameters::symmetric(0.8, 12.0, 0.05, 1e-3),
            free: vec![Coordinate::Restitution, Coordinate::Damping],
            covariance: DMatrix::from_row_slice(2, 2, &[r * r, common, common, beta * beta]),
            cost: 0.0,
            residuals: 0,
            report: FitReport::default(),
        };
        let spread = Spread::of(&fit, 4.0, RigKind::Double);
        let of_r = spread.half95(|m| Some(m.restitution().at(1.0)));
        assert!((of_r.expect("a band") - 2.0 * NORMAL_975 * r).abs() < 1e-9);
        let of_beta = spread.half95(|m| Some(m.x.damping_ratio.ln()));
        assert!((of_beta.expect("a band") - 2.0 * NORMAL_975 * beta).abs() < 1e-9);
        let of_both = spread.half95(|m| Some(m.restitution().at(1.0) + m.x.damping_ratio.ln()));
        let want = 2.0 * NORMAL_975 * (r * r + beta * beta + 2.0 * common).sqrt();
        assert!((of_both.expect("a band") - want).abs() < 1e-9);
        assert_eq!(spread.half95(|_| None), None);
    }
}
