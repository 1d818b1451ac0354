//! Phrases of the template and of the page, translated.

use std::collections::BTreeMap;

use crate::locale::Locale;
use crate::phrase::Phrase;

/// Those of template.typ, of the page and of its script.
const PHRASES: [Phrase; 14] = [
    Phrase::Contents,
    Phrase::SyntheticData,
    Phrase::MethodsAgree,
    Phrase::MethodsDisagree,
    Phrase::AgreementUnknown,
    Phrase::WhatWasMeasured,
    Phrase::Figure,
    Phrase::WeaklyIdentified,
    Phrase::NotIdentifiable,
    Phrase::NotDetermined,
    Phrase::ZoomIn,
    Phrase::ZoomOut,
    Phrase::WholeFigure,
    Phrase::SaveAsSVG,
];

/// From each phrase to what is printed for it.
pub(super) fn words(locale: Locale<'_>) -> BTreeMap<&'static str, String> {
    let each = PHRASES.into_iter();
    each.map(|phrase| (phrase.english(), locale.translate(phrase)))
        .collect()
}
