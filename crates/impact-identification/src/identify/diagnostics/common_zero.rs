//! Clearances that are all off by one length: counted from another zero than where the masses touch.

use impact_fit::messages::{Finding, Note};
use impact_fit::parameters::{Coordinate, Parameters};
use impact_records::signal::columns::dot;
use impact_records::signal::robust;

use super::doubt::{Doubt, Suspicion};

/// Stated uncertainties that each clearance has in the fit that tells it.
pub const OPEN: f64 = 20.0;
/// Fewest gaps that tell a common zero from their own errors.
const FEWEST_GAPS: usize = 3;
/// Standard deviations of what is stated, of a gap and of the zero of all, from which it is named.
const NAMED: f64 = 4.0;
/// Greatest distance of a gap's error from the common one, over that.
const ALIKE: f64 = 0.4;

/// What is stated of the clearances' errors and of what takes their part.
#[derive(Debug, Clone, Copy)]
pub struct Stated {
    /// Standard uncertainty of each clearance, m.
    pub clearance_m: f64,
    /// Relative one of a gain: gains that are off show as errors in proportion to the gaps.
    pub gain: f64,
}

/// That all `gaps_m` are off alike, by a fit in which each has [`OPEN`] times the stated uncertainty, or more.
pub fn common_zero(open: &Parameters, gaps_m: &[f64], stated: Stated) -> Option<Suspicion> {
    let errors = (0..gaps_m.len()).map(|i| open.screw_zero_m + open.gap_errors_m.of(i));
    let errors: Vec<f64> = errors.collect();
    if errors.len() < FEWEST_GAPS {
        return None;
    }
    let slope = slope(gaps_m, &errors, stated);
    let shares = gaps_m.iter().zip(&errors).map(|(gap, e)| e - slope * gap);
    let shares: Vec<f64> = shares.collect();
    let added_m = mean(&shares);
    let alike = shares
        .iter()
        .all(|e| (e - added_m).abs() < ALIKE * added_m.abs());
    let left: f64 = shares.iter().map(|share| (share - added_m).powi(2)).sum();
    let by_gains = slope.abs() < NAMED * stated.gain && left < left_by_a_factor(gaps_m, &errors);
    let named = added_m.abs() > NAMED * std::f64::consts::SQRT_2 * stated.clearance_m;
    let relative = (added_m / robust::median(gaps_m)?).abs();
    (alike && by_gains && named).then(|| Suspicion {
        finding: Finding::CommonZero { added_m },
        doubts: vec![Doubt {
            parameter: Coordinate::Deflection,
            by: relative,
            note: Note::InstrumentOff,
        }],
    })
}

/// Slope of errors over gaps, whose standard uncertainties are as stated, by a line with a free intercept.
fn slope(gaps_m: &[f64], errors_m: &[f64], stated: Stated) -> f64 {
    let (gap, error) = (mean(gaps_m), mean(errors_m));
    let apart = gaps_m
        .iter()
        .zip(errors_m)
        .map(|(g, e)| (g - gap, e - error));
    let sums = apart.fold((0.0, 0.0), |(xx, xy), (x, y)| (xx + x * x, xy + x * y));
    let known = (stated.clearance_m / stated.gain.max(f64::MIN_POSITIVE)).powi(2);
    sums.1 / (sums.0 + known)
}

/// Sum of the squares that a factor common to all gaps leaves of their errors.
fn left_by_a_factor(gaps_m: &[f64], errors_m: &[f64]) -> f64 {
    let factor = dot(gaps_m, errors_m) / dot(gaps_m, gaps_m);
    let left = gaps_m.iter().zip(errors_m).map(|(g, e)| e - factor * g);
    left.map(|left| left * left).sum()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_that_are_off_alike_have_another_zero_and_one_that_is_off_has_not() {
        let gaps_m = [0.4e-3, 0.8e-3, 1.4e-3];
        let of = |errors_m: [f64; 3]| {
            let mut fitted = Parameters::symmetric(0.8, 12.0, 0.05, 1e-3);
            fitted.screw_zero_m = 5e-6;
            for (i, error_m) in errors_m.into_iter().enumerate() {
                fitted.gap_errors_m.set(i, error_m);
            }
            let stated = Stated {
                clearance_m: 1e-6,
                gain: 5e-3,
            };
            common_zero(&fitted, &gaps_m, stated)
        };
        let found = of([14e-6, 16e-6, 12e-6]).expect("a common zero");
        let Finding::CommonZero { added_m } = found.finding else {
            panic!("{found:?}");
        };
        // 19e-6 in the mean, and what gains may add to a gap of 0.87 mm: 2.2e-3 of it
        assert!((added_m - 20.9e-6).abs() < 0.1e-6, "{added_m}");
        assert!((found.doubts[0].by - added_m / 800e-6).abs() < 1e-12);
        assert_eq!(of([14e-6, -4e-6, -5e-6]), None);
        // a factor of 1.1
        assert_eq!(of([35e-6, 75e-6, 135e-6]), None);
        assert_eq!(of([-4e-6, -3e-6, -5e-6]), None);
        // gains that are off beside another zero
        let found = of([18e-6, 20e-6, 23e-6]).expect("a common zero");
        let Finding::CommonZero { added_m } = found.finding else {
            panic!("{found:?}");
        };
        // 5e-6 + 16e-6 with 5e-3 of the gaps, which the prior of the gains takes a part of
        assert!((added_m - 21.7e-6).abs() < 0.3e-6, "{added_m}");
    }
}
