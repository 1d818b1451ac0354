//! Clearances that are all off by one length: counted from another zero than where the masses touch.

use impact_fit::messages::{Finding, Note};
use impact_fit::parameters::{Coordinate, Parameters};
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

/// That all `gaps_m` are off alike, by a fit in which each has [`OPEN`] times the stated uncertainty.
pub fn common_zero(open: &Parameters, gaps_m: &[f64], uncertainty_m: f64) -> Option<Suspicion> {
    let errors = (0..gaps_m.len()).map(|i| open.screw_zero_m + open.gap_errors_m.of(i));
    let errors: Vec<f64> = errors.collect();
    let added_m = robust::median(&errors).filter(|_| errors.len() >= FEWEST_GAPS)?;
    let alike = errors
        .iter()
        .all(|e| (e - added_m).abs() < ALIKE * added_m.abs());
    let named = added_m.abs() > NAMED * std::f64::consts::SQRT_2 * uncertainty_m;
    let relative = (added_m / robust::median(gaps_m)?).abs();
    (alike && named).then(|| Suspicion {
        finding: Finding::CommonZero { added_m },
        doubts: vec![Doubt {
            parameter: Coordinate::Deflection,
            by: relative,
            note: Note::InstrumentOff,
        }],
    })
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
            common_zero(&fitted, &gaps_m, 1e-6)
        };
        let found = of([14e-6, 16e-6, 12e-6]).expect("a common zero");
        let Finding::CommonZero { added_m } = found.finding else {
            panic!("{found:?}");
        };
        assert!((added_m - 19e-6).abs() < 1e-9);
        assert!((found.doubts[0].by - 19.0 / 800.0).abs() < 1e-9);
        assert_eq!(of([14e-6, -4e-6, -5e-6]), None);
        assert_eq!(of([-4e-6, -3e-6, -5e-6]), None);
    }
}
