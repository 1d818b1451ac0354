//! Differences between campaigns as printed, in the report and in the terminal.

use super::locale::Locale;
use super::parameters::{decimals_for, parameter};
use impact_identification::compare::{Difference, EqualityTest};

/// Smaller p-values are printed as smaller than this.
const LEAST_P: f64 = 1e-3;

/// A p-value to three decimals.
pub fn p_value(p: f64, locale: Locale<'_>) -> String {
    if p < LEAST_P {
        format!("< {}", locale.fixed(LEAST_P, 3))
    } else {
        locale.fixed(p, 3)
    }
}

/// A p-value as printed behind its name.
pub fn p_equals(p: f64, locale: Locale<'_>) -> String {
    let relation = if p < LEAST_P { "" } else { "= " };
    format!("{relation}{}", p_value(p, locale))
}

/// The statistic of the test that nothing has changed, as printed.
pub fn statistic(test: &EqualityTest, locale: Locale<'_>) -> String {
    locale.significant(test.statistic, 3)
}

/// A difference as printed, with markup, in the parameter's unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PrintedDifference {
    /// Number of the campaign, from 1.
    pub campaign: String,
    /// The parameter's symbol.
    pub parameter: &'static str,
    /// Value and half its 95 % interval.
    pub value: String,
    /// Ends of the interval.
    pub interval: String,
    /// Half the interval if nothing were shared.
    pub independent: String,
    /// The p-value of no difference.
    pub p_value: String,
}

impl PrintedDifference {
    /// `None` of what is fitted beside the oscillator's parameters.
    pub fn of(difference: &Difference, locale: Locale<'_>) -> Option<Self> {
        let look = parameter(difference.parameter)?;
        let half = |[low, high]: [f64; 2]| 0.5 * (high - low) * look.factor;
        let own = half(difference.interval95);
        let decimals = decimals_for(own);
        let print = |value: f64| locale.fixed(value * look.factor, decimals);
        let with_unit = |text: String| match look.unit {
            "" => text,
            unit => format!("{text}\u{2009}{unit}"),
        };
        let [low, high] = difference.interval95.map(print);
        let apart = locale.fixed(half(difference.independent_interval95), decimals);
        Some(Self {
            campaign: (difference.campaign + 1).to_string(),
            parameter: look.symbol,
            value: with_unit(format!(
                "{} ± {}",
                print(difference.value),
                locale.fixed(own, decimals)
            )),
            interval: with_unit(locale.range(&low, &high)),
            independent: with_unit(format!("± {apart}")),
            p_value: p_value(difference.p_value, locale),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_statistic_of_the_test_has_the_digits_that_it_has_in_the_report() {
        let test = EqualityTest {
            statistic: 2197.705,
            differences: 4,
            degrees_of_freedom: None,
            p_value: 0.0,
        };
        assert_eq!(statistic(&test, Locale::default()), "2198");
    }
}
