//! The document: from content and figures to plain document data, and from there to PDF.

pub(super) mod breaks;
mod campaigns;
mod captions;
mod conventions;
mod drawn;
mod facts;
mod front;
mod layout_phrases;
pub(super) mod model;
mod pdf;
mod placed;
mod sections;
mod settings;
mod tables;
mod verdict;
pub(super) mod world;

pub(super) use campaigns::campaigns;
pub(super) use pdf::pdf;
pub use tables::budget_source;

use std::iter;

use drawn::Drawn;
use model::{Document, Rich};

use crate::content::ReportContent;
use crate::kit::Figure;
use crate::locale::Locale;
use crate::phrase::Phrase;

/// Builds the document's data.
pub(super) fn document(
    content: &ReportContent,
    figures: &[Figure],
    locale: Locale<'_>,
) -> Document {
    let drawn = Drawn { figures, locale };
    Document {
        title: content.title.clone(),
        subtitle: Rich::from(subtitle(content, locale)),
        footer: Rich::from(footer(content)),
        front: front::front(content, &drawn),
        sections: sections::sections(content, &drawn),
        words: layout_phrases::words(locale),
    }
    .with_numbers()
}

fn subtitle(content: &ReportContent, locale: Locale<'_>) -> String {
    let campaign = &content.campaign;
    let dates = facts::dates(campaign, locale);
    let stated = campaign.stated.iter();
    let laboratory = stated.filter(|(label, _)| *label == Phrase::Laboratory);
    let parts: Vec<String> = iter::once(campaign.name.clone())
        .chain(laboratory.map(|(_, words)| words.clone()))
        .chain([dates])
        .filter(|p| !p.is_empty() && *p != content.title)
        .collect();
    parts.join(" · ")
}

fn footer(content: &ReportContent) -> String {
    let version = content.provenance.versions.get("impactid");
    version.map_or("impactid".into(), |v| format!("impactid {v}"))
}
