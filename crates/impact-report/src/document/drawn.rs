//! The figures as drawn, to be referred to by name.

use super::model::{Block, FigureRef, Placement, Rich};
use crate::kit::{Figure, richtext};
use crate::locale::Locale;
use crate::phrase::Phrase;

/// The figures as drawn, to be referred to by name.
pub(super) struct Drawn<'a> {
    /// The figures.
    pub figures: &'a [Figure],
    /// How numbers are printed.
    pub locale: Locale<'a>,
}

impl Drawn<'_> {
    /// Refers to a figure by its name; `None` if it was not drawn.
    pub(super) fn figure(&self, name: &str, caption: &str) -> Option<FigureRef> {
        let figure = self.figures.iter().find(|f| f.name == name)?;
        let file = format!("figures/{name}.csv");
        let data = self
            .locale
            .translate_with(Phrase::CaptionData, &[("file", &file)]);
        let caption = if caption.is_empty() || figure.csv.is_empty() {
            caption.to_owned()
        } else {
            format!("{caption} {data}")
        };
        Some(FigureRef {
            name: figure.name.clone(),
            width: figure.drawing.width,
            height: figure.drawing.height,
            number: None,
            caption: Rich::from(caption),
            alt: richtext::plain(&figure.title),
        })
    }

    /// A block of those of the named figures that were drawn, where the text has them.
    pub(super) fn figures_block(&self, named: &[(&str, &str)]) -> Option<Block> {
        self.placed(named, Placement::InText)
    }

    /// A block of those of the named figures that were drawn.
    pub(super) fn placed(&self, named: &[(&str, &str)], placement: Placement) -> Option<Block> {
        let figures: Vec<FigureRef> = named
            .iter()
            .filter_map(|(name, caption)| self.figure(name, caption))
            .collect();
        (!figures.is_empty()).then_some(Block::Figures { figures, placement })
    }
}
