//! One figure by itself, as SVG, PNG and PDF.

use super::document::world::{MemoryWorld, Unset};
use super::error::ReportError;
use super::figures::Figure;

/// A page as large as the figure.
const PAGE: &str = r#"#set page(width: auto, height: auto, margin: 3pt)
#image("figure.svg")
"#;

/// The files of a figure: `NAME.svg`, `NAME.png`, `NAME.pdf`.
///
/// # Errors
/// [`ReportError::Picture`] where a renderer refuses the figure.
pub(crate) fn pictures(figure: &Figure) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let name = |ending: &str| format!("{}.{ending}", figure.name);
    Ok(vec![
        (name("svg"), figure.svg.clone().into_bytes()),
        (name("png"), super::png::png(figure)?),
        (name("pdf"), pdf(figure)?),
    ])
}

/// A figure as a PDF of one page. The same figure gives the same bytes.
///
/// # Errors
/// [`ReportError::Picture`] where the renderer refuses the figure.
pub(super) fn pdf(figure: &Figure) -> Result<Vec<u8>, ReportError> {
    let files = [("figure.svg".to_owned(), figure.svg.clone().into_bytes())];
    let world = MemoryWorld::new(PAGE, files).ok_or(ReportError::FileName)?;
    world.pdf(&figure.title).map_err(|e| match e {
        Unset::Template(why) | Unset::Pages(why) => ReportError::Picture {
            name: figure.name.clone(),
            why,
        },
    })
}
