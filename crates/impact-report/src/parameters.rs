//! Parameters and methods as printed: names, symbols, units, digits.

use super::locale::Locale;
use crate::phrase::Phrase;
use impact_fit::parameters::Coordinate;
use impact_fit::{Estimate, Method};
pub(super) use impact_records::signal::digits::decimals_for;

/// How a parameter is named and printed.
#[derive(Debug, Clone, Copy)]
pub(super) struct ParameterLook {
    /// Which one.
    pub parameter: Coordinate,
    /// Its symbol, with markup.
    pub symbol: &'static str,
    /// Its name in words.
    pub name: Phrase,
    /// Its unit as printed.
    pub unit: &'static str,
    /// Multiply an SI value by this.
    pub factor: f64,
}

impl ParameterLook {
    /// Title of its axis: symbol and unit.
    pub(super) fn axis_title(&self) -> String {
        let unit = if self.unit.is_empty() { "1" } else { self.unit };
        format!("{} ({unit})", self.symbol)
    }
}

/// The four parameters of the oscillator.
pub(super) const PARAMETERS: [ParameterLook; 4] = [
    ParameterLook {
        parameter: Coordinate::Restitution,
        symbol: "$R$",
        name: Phrase::CoefficientOfRestitution,
        unit: "",
        factor: 1.0,
    },
    ParameterLook {
        parameter: Coordinate::Frequency,
        symbol: "$f_0$",
        name: Phrase::NaturalFrequency,
        unit: "Hz",
        factor: 1.0,
    },
    ParameterLook {
        parameter: Coordinate::Damping,
        symbol: "$β$",
        name: Phrase::DampingRatio,
        unit: "",
        factor: 1.0,
    },
    ParameterLook {
        parameter: Coordinate::Deflection,
        symbol: "$x_{st}$",
        name: Phrase::StaticDeflection,
        unit: "mm",
        factor: 1e3,
    },
];

/// The look of a parameter; `None` of what is fitted beside them.
pub(super) fn parameter(coordinate: Coordinate) -> Option<&'static ParameterLook> {
    PARAMETERS.iter().find(|p| p.parameter == coordinate)
}

/// Name of a method inside a sentence or a list.
pub(super) fn method_inline(method: Method, locale: Locale<'_>) -> String {
    let name = locale.message(&method);
    match locale.language() {
        Some(language) if !language.capital_nouns() => name.to_lowercase(),
        _ => name,
    }
}

/// Standard errors from the middle of a normal distribution to either end of its 95 % interval.
pub(super) const NORMAL_95: f64 = 1.96;

/// Half the 95 % interval, SI: from the interval, else from the standard error.
pub(super) fn half_width(estimate: &Estimate) -> Option<f64> {
    match (estimate.interval95, estimate.standard_error) {
        (Some([low, high]), _) => Some(0.5 * (high - low)),
        (None, Some(error)) => Some(NORMAL_95 * error),
        (None, None) => None,
    }
}

/// The 95 % interval of an estimate that has a value, SI: as stated, else about the value from the
/// standard error, else the value alone.
pub(super) fn interval95(estimate: &Estimate) -> Option<(f64, f64)> {
    let value = estimate.value?;
    Some(match estimate.interval95 {
        Some([low, high]) => (low, high),
        None => {
            let half = half_width(estimate).unwrap_or(0.0);
            (value - half, value + half)
        }
    })
}

/// `value ± half width` with unit, `not identifiable` where there is no value, `–` where the
/// parameter was not asked for.
pub(super) fn short(
    look: &ParameterLook,
    estimate: Option<&Estimate>,
    locale: Locale<'_>,
) -> String {
    let Some(estimate) = estimate else {
        return "–".into();
    };
    let Some(value) = estimate.value else {
        return locale.translate(Phrase::NotIdentifiable);
    };
    let half = half_width(estimate).map(|h| h * look.factor);
    let decimals = decimals_for(half.unwrap_or(0.0));
    let mut text = locale.fixed(value * look.factor, decimals);
    if let Some(half) = half {
        text.push_str(&format!(" ± {}", locale.fixed(half, decimals)));
    }
    if !look.unit.is_empty() {
        text.push_str(&format!("\u{2009}{}", look.unit));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::Status;

    fn estimate(value: f64, half: f64) -> Estimate {
        Estimate {
            value: Some(value),
            standard_error: Some(half / 1.96),
            interval95: Some([value - half, value + half]),
            status: Status::Identified,
            note: None,
        }
    }

    #[test]
    fn estimates_show_two_digits_of_their_uncertainty() {
        let locale = Locale::default();
        let r = estimate(0.901_34, 0.002_41);
        assert_eq!(short(&PARAMETERS[0], Some(&r), locale), "0.9013 ± 0.0024");
        let x = estimate(0.001_234_5, 0.000_009_96);
        assert_eq!(
            short(&PARAMETERS[3], Some(&x), locale),
            "1.234 ± 0.010\u{2009}mm"
        );
        let comma = Locale {
            decimal_comma: true,
            catalog: None,
        };
        assert_eq!(short(&PARAMETERS[0], Some(&r), comma), "0,9013 ± 0,0024");
    }
}
