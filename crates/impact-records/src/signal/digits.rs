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

/// A number to so many significant digits, without an exponent and without zeros at its end.
///
/// ```
/// use impact_records::signal::digits::significant;
///
/// assert_eq!([-10.707_03, 0.000_125, 1.2e7].map(|v| significant(v, 4)), ["-10.71", "0.000125", "12000000"]);
/// ```
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = decimal_exponent(value, digits);
    let decimals = usize::try_from(digits - 1 - exponent).unwrap_or(0);
    let text = format!("{value:.decimals$}");
    if decimals == 0 {
        return text;
    }
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
