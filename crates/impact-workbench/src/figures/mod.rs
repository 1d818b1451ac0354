//! Figures of the theory alone: motions, characteristics, basins, regions.

pub mod basins;
mod keys;
pub mod motion;
pub mod regions;
pub mod sweep;

use impact_report::locale::Locale;

/// The figures of the theory are in English.
const ENGLISH: Locale<'static> = Locale {
    decimal_comma: false,
    catalog: None,
};
