//! One figure by itself, as SVG, PNG and PDF.

use super::document::world::{MemoryWorld, Unset};
use super::error::ReportError;
use super::figures::Figure;

/// A page as large as its figure.
const PAGE: &str = "#set page(width: auto, height: auto, margin: 3pt)\n";

/// The files of a figure whose texts are English: `NAME.svg`, `NAME.png`, `NAME.pdf`.
///
/// # Errors
/// [`ReportError::Picture`] where a renderer refuses the figure.
pub(crate) fn pictures(figure: &Figure) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let name = |ending: &str| format!("{}.{ending}", figure.name);
    Ok(vec![
        (name("svg"), figure.svg().into_bytes()),
        (name("png"), super::png::png(figure)?),
        (name("pdf"), pdf(figure, "en")?),
    ])
}

/// A figure as a PDF of one page, its texts marked as of a language (ISO 639-1). The same figure gives the same bytes.
///
/// # Errors
/// [`ReportError::Picture`] where the renderer refuses the figure.
pub(super) fn pdf(figure: &Figure, language: &str) -> Result<Vec<u8>, ReportError> {
    let template = format!("{PAGE}#image(\"{}.svg\")\n", figure.name);
    let figures = std::slice::from_ref(figure);
    let world = MemoryWorld::new(&template, figures, language, []).ok_or(ReportError::FileName)?;
    world.pdf(&figure.title).map_err(|e| match e {
        Unset::Template(why) | Unset::Pages(why) => ReportError::Picture {
            name: figure.name.clone(),
            why,
        },
    })
}
