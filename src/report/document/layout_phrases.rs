//! Phrases of the template and of the page, translated.

use std::collections::BTreeMap;

use crate::report::locale::Locale;

/// Those of template.typ, of the page and of its script.
const PHRASES: [&str; 13] = [
    "Synthetic data: simulated records, not a measurement.",
    "The methods agree.",
    "The methods disagree.",
    "Agreement cannot be judged.",
    "What was measured",
    "Figure",
    "weakly identified",
    "not identifiable",
    "not determined by these data",
    "zoom in",
    "zoom out",
    "whole figure",
    "save as SVG",
];

/// From each phrase to what is printed for it.
pub(super) fn words(locale: Locale<'_>) -> BTreeMap<&'static str, String> {
    let each = PHRASES.into_iter();
    each.map(|phrase| (phrase, locale.translate(phrase)))
        .collect()
}
