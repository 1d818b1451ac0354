//! The document: from content and figures to plain document data, and from there to PDF.

mod captions;
mod conventions;
mod facts;
mod front;
mod layout_phrases;
pub mod model;
mod pdf;
mod prose;
mod sections;
mod settings;
mod tables;
pub(super) mod world;

pub use pdf::pdf;

use model::{Block, Document, FigureRef, Rich};

use crate::report::content::ReportContent;
use crate::report::figures::{Figure, richtext};
use crate::report::speech::Speech;

/// The figures as drawn, to be referred to by name.
pub struct Drawn<'a> {
    figures: &'a [Figure],
    /// How numbers are printed.
    pub speech: Speech<'a>,
}

impl Drawn<'_> {
    /// Refers to a figure by its name; `None` where it was not drawn.
    pub fn figure(&self, name: &str, caption: &str) -> Option<FigureRef> {
        let figure = self.figures.iter().find(|f| f.name == name)?;
        Some(FigureRef {
            name: figure.name.clone(),
            width: figure.width,
            height: figure.height,
            caption: Rich::from(caption),
            alt: richtext::plain(&figure.title),
        })
    }

    /// A block of those of the named figures that were drawn.
    fn figures_block(&self, named: &[(&str, &str)]) -> Option<Block> {
        let figures: Vec<FigureRef> = named
            .iter()
            .filter_map(|(name, caption)| self.figure(name, caption))
            .collect();
        (!figures.is_empty()).then_some(Block::Figures { figures })
    }
}

/// Builds the document's data.
pub fn document(content: &ReportContent, figures: &[Figure], speech: Speech<'_>) -> Document {
    let drawn = Drawn { figures, speech };
    Document {
        title: content.title.clone(),
        subtitle: Rich::from(subtitle(content, speech)),
        footer: Rich::from(footer(content)),
        front: front::front(content, &drawn),
        sections: sections::sections(content, &drawn),
        words: layout_phrases::words(speech),
    }
}

fn subtitle(content: &ReportContent, speech: Speech) -> String {
    let campaign = &content.campaign;
    let dates = facts::dates(campaign, speech);
    let parts = [
        Some(campaign.name.clone()),
        campaign.laboratory.clone(),
        Some(dates),
    ];
    let parts: Vec<String> = parts
        .into_iter()
        .flatten()
        .filter(|p| !p.is_empty() && *p != content.title)
        .collect();
    parts.join(" · ")
}

fn footer(content: &ReportContent) -> String {
    let version = content.provenance.versions.get("impactid");
    version.map_or("impactid".into(), |v| format!("impactid {v}"))
}
