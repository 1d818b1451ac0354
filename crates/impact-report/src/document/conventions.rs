//! The quantities of the report, as the paper defines them.

use super::model::{Definition, Rich};
use crate::locale::Locale;
use crate::phrase::Phrase;

/// A quantity's definition.
struct Convention {
    /// Its formula as typst maths.
    formula: &'static str,
    /// The same as plain text.
    plain: &'static str,
    /// What it means, with markup.
    meaning: Phrase,
    /// Whether it takes a drive.
    driven: bool,
}

/// In the order in which they are printed.
const CONVENTIONS: [Convention; 8] = [
    Convention {
        formula: "R = - (X'_+ + Y'_+) / (X'_- + Y'_-)",
        plain: "R = −(X′₊ + Y′₊)/(X′₋ + Y′₋)",
        meaning: Phrase::MeaningOfRestitution,
        driven: false,
    },
    Convention {
        formula: "beta = b / (2 sqrt(k m))",
        plain: "β = b/(2√(km))",
        meaning: Phrase::MeaningOfDampingRatio,
        driven: false,
    },
    Convention {
        formula: "tau = Omega t",
        plain: "τ = Ωt",
        meaning: Phrase::MeaningOfTime,
        driven: false,
    },
    Convention {
        formula: "eta = omega / Omega = f / f_0",
        plain: "η = ω/Ω = f/f0",
        meaning: Phrase::MeaningOfFrequencyRatio,
        driven: true,
    },
    Convention {
        formula: "x_\"st\" = F_0 / k",
        plain: "x_st = F0/k",
        meaning: Phrase::MeaningOfStaticDeflection,
        driven: true,
    },
    Convention {
        formula: "rho = r / x_\"st\" = r k / F_0",
        plain: "ρ = r/x_st = rk/F0",
        meaning: Phrase::MeaningOfClearanceRatio,
        driven: true,
    },
    Convention {
        formula: "z = p / n",
        plain: "z = p/n",
        meaning: Phrase::MeaningOfMotion,
        driven: true,
    },
    Convention {
        formula: "X'' + 2 beta X' + X = cos(eta tau + phi)",
        plain: "X″ + 2βX′ + X = cos(ητ + φ)",
        meaning: Phrase::MeaningOfEquation,
        driven: true,
    },
];

/// The conventions in the reader's words; without a drive only those that need none.
pub(super) fn entries(driven: bool, locale: Locale<'_>) -> Vec<Definition> {
    let said = CONVENTIONS.iter().filter(|c| driven || !c.driven);
    said.map(|c| Definition {
        formula: c.formula,
        plain: c.plain,
        meaning: Rich::from(locale.translate(c.meaning)),
    })
    .collect()
}
