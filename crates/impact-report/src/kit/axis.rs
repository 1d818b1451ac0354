//! An axis: its range in data, its title, its ticks.

use crate::locale::Locale;
use crate::phrase::Text;
use impact_records::signal::robust::range;
use impact_records::signal::whole;

/// One axis: its range in data and its title with unit, in the report's markup.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Least value shown.
    pub low: f64,
    /// Greatest value shown.
    pub high: f64,
    /// Title with unit; empty for none.
    pub title: Text,
    /// Whether it counts in powers of ten.
    pub log: bool,
    /// Wanted number of ticks; none at all for 0.
    pub ticks: usize,
}

impl Axis {
    /// A linear axis.
    pub fn new(low: f64, high: f64, title: impl Into<Text>) -> Self {
        let (low, high) = if high > low {
            (low, high)
        } else {
            (low - 0.5, low + 0.5)
        };
        Self {
            low,
            high,
            title: title.into(),
            log: false,
            ticks: 5,
        }
    }

    /// An axis that shows all values with a margin (a share of their range) at either end.
    pub fn around(
        values: impl IntoIterator<Item = f64>,
        margin: f64,
        title: impl Into<Text>,
    ) -> Self {
        let (low, high) = range(values).unwrap_or((0.0, 1.0));
        let alone = if high == 0.0 { 1.0 } else { 0.05 * high.abs() };
        let pad = if high > low {
            margin * (high - low)
        } else {
            alone
        };
        Self::new(low - pad, high + pad, title)
    }

    /// With another wanted number of ticks.
    #[must_use]
    pub fn with_ticks(self, ticks: usize) -> Self {
        Self { ticks, ..self }
    }

    /// Counting in powers of ten; both ends must be positive.
    pub(crate) fn logarithmic(self) -> Self {
        let log = self.low > 0.0;
        Self { log, ..self }
    }

    /// Share of the way from low to high.
    pub(crate) fn share(&self, value: f64) -> f64 {
        if self.log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Values of the labelled ticks, and the decimals their labels need.
    pub(crate) fn major(&self) -> (Vec<f64>, usize) {
        if self.log {
            return (self.decades(), 0);
        }
        let span = self.high - self.low;
        let wanted = self.ticks.max(1);
        let tries = (wanted..=wanted + 4).map(|ticks| nice_step(span / ticks as f64));
        let ticks = tries.map(|step| (multiples(self.low, self.high, step), decimals_of(step)));
        // One number alone is no scale.
        let mut best = (Vec::new(), 0);
        for found in ticks {
            best = found;
            if best.0.len() >= 2 {
                break;
            }
        }
        best
    }

    fn decades(&self) -> Vec<f64> {
        let span = (self.high / self.low).log10();
        let per: &[f64] = if span > 3.0 {
            &[1.0]
        } else if span > 1.5 {
            &[1.0, 3.0]
        } else {
            &[1.0, 2.0, 5.0]
        };
        let first = whole::integer(self.low.log10().floor());
        let last = whole::integer(self.high.log10().ceil());
        (first..=last)
            .flat_map(|e| per.iter().map(move |m| m * 10f64.powi(e)))
            .filter(|v| *v >= self.low * (1.0 - 1e-9) && *v <= self.high * (1.0 + 1e-9))
            .collect()
    }

    /// Label of a tick.
    pub(crate) fn label(&self, value: f64, decimals: usize, locale: Locale<'_>) -> String {
        if self.log {
            locale.significant(value, 1)
        } else {
            locale.fixed(value, decimals)
        }
    }
}

/// The next of 1, 2, 5 times a power of ten.
fn nice_step(rough: f64) -> f64 {
    let power = 10f64.powf(rough.log10().floor());
    let multiple = rough / power;
    let nice = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|m| multiple <= m * 1.000_001)
        .unwrap_or(10.0);
    nice * power
}

fn multiples(low: f64, high: f64, step: f64) -> Vec<f64> {
    let slack = 1e-9 * (high - low);
    let first = whole::integer(((low - slack) / step).ceil());
    let last = whole::integer(((high + slack) / step).floor());
    (first..=last).map(|i| f64::from(i) * step).collect()
}

fn decimals_of(step: f64) -> usize {
    whole::index((-(step * 1.000_001).log10().floor()).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ticks_are_round_numbers() {
        let (ticks, decimals) = Axis::new(0.93, 2.07, "").major();
        assert_eq!(decimals, 1);
        let labels: Vec<_> = ticks.iter().map(|t| format!("{t:.1}")).collect();
        assert_eq!(labels, ["1.0", "1.5", "2.0"]);
    }

    proptest! {
        #[test]
        fn prop_ticks_lie_within_and_are_few(low in -1e3..1e3f64, span in 1e-6..1e4f64) {
            let axis = Axis::new(low, low + span, "");
            let (ticks, _) = axis.major();
            prop_assert!((2..=6).contains(&ticks.len()), "{ticks:?}");
            prop_assert!(ticks.iter().all(|t| *t >= low - 1e-6 * span && *t <= low + span * 1.000_001));
        }
    }
}
