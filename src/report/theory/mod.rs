//! Figures of the theory alone: motions, characteristics, basins, regions.

pub(crate) mod basins;
mod keys;
pub(crate) mod motion;
pub(crate) mod regions;
pub(crate) mod sweep;

use super::locale::Locale;

/// The figures of the theory are in English.
const ENGLISH: Locale<'static> = Locale {
    decimal_comma: false,
    catalog: None,
};
