//! One figure by itself, as SVG, PNG and PDF.

use super::document::breaks::Layout;
use super::document::world::{MemoryWorld, Unset};
use super::error::ReportError;
use super::kit::Figure;

/// A page as large as its figure.
const PAGE: &str = r#"#set page(width: auto, height: auto, margin: 3pt)
#image("figure.svg")
"#;

/// The files of a figure whose texts are English: `NAME.svg`, `NAME.png`, `NAME.pdf`.
///
/// # Errors
/// [`ReportError::Picture`] where a renderer refuses the figure.
pub fn pictures(figure: &Figure) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let name = |ending: &str| format!("{}.{ending}", figure.name);
    Ok(vec![
        (name("svg"), figure.svg().into_bytes()),
        (name("png"), super::png::png(figure)?),
        (name("pdf"), pdf(figure, "en")?),
    ])
}

/// A figure as a PDF of one page, its texts marked as of a language (ISO 639-1). The same figure
/// gives the same bytes.
///
/// # Errors
/// [`ReportError::Picture`] where the renderer refuses the figure.
pub(super) fn pdf(figure: &Figure, language: &str) -> Result<Vec<u8>, ReportError> {
    // names that studies give need not be paths
    let shown = [Figure {
        name: "figure".into(),
        ..figure.clone()
    }];
    let world = MemoryWorld::new(PAGE, &shown, language, []).ok_or(ReportError::FileName)?;
    world
        .pdf(&figure.title, Layout::default())
        .map_err(|e| match e {
            Unset::Template(why) | Unset::Pages(why) => ReportError::Picture {
                name: figure.name.clone(),
                why,
            },
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kit::canvas::{Canvas, Stroke};

    #[test]
    fn a_figure_whose_name_is_no_path_is_set() {
        let mut canvas = Canvas::new(100.0, 50.0);
        let ink = Stroke::solid(plotters::style::BLACK, 0.5);
        canvas.segment((0.0, 0.0), (50.0, 50.0), ink);
        let figure = Figure::new("a \"b\\c#", "a line", canvas, String::new());
        let bytes = pdf(&figure, "en").expect("a PDF");
        assert!(bytes.starts_with(b"%PDF"));
    }
}
