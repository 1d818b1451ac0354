//! Digits of numbers whose uncertainty is known: the one place that decides how many are printed.

use super::whole;

/// Most decimals of a number with an uncertainty.
const MOST_DECIMALS: usize = 9;
/// Decimals of a number whose uncertainty is not known.
const USUAL_DECIMALS: usize = 4;

/// Decimals at which an uncertainty shows two significant digits: those of a value and of half its 95 % interval wherever
/// they are printed.
///
/// ```
/// use impact_records::signal::digits::decimals_for;
///
/// assert_eq!([0.0123, 0.00996, 2.0].map(decimals_for), [3, 3, 1]);
/// ```
pub fn decimals_for(uncertainty: f64) -> usize {
    if !(uncertainty.is_finite() && uncertainty > 0.0) {
        return USUAL_DECIMALS;
    }
    let exponent = decimal_exponent(uncertainty, 2);
    usize::try_from(1 - exponent).map_or(0, |decimals| decimals.min(MOST_DECIMALS))
}

/// Exponent of ten of a number once rounded to some digits (0.99996 to four digits is 1.000).
pub fn decimal_exponent(value: f64, digits: i32) -> i32 {
    let exponent = whole::integer(value.abs().log10().floor());
    let rounded = (value.abs() / 10f64.powi(exponent - digits + 1)).round();
    exponent + i32::from(rounded >= 10f64.powi(digits))
}
