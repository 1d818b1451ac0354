//! One figure by itself, as SVG, PNG and PDF.

use typst_layout::PagedDocument;
use typst_pdf::PdfOptions;

use super::ReportError;
use super::document::world::MemoryWorld;
use super::figures::Figure;

/// A page as large as the figure.
const PAGE: &str = r#"#set page(width: auto, height: auto, margin: 3pt)
#image("figure.svg")
"#;

/// The files of a figure: `NAME.svg`, `NAME.png`, `NAME.pdf`.
///
/// # Errors
/// [`ReportError::Picture`] where a renderer refuses the figure.
pub fn pictures(figure: &Figure) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
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
/// As [`pictures`].
pub fn pdf(figure: &Figure) -> Result<Vec<u8>, ReportError> {
    let failed = |why: &str| ReportError::Picture {
        name: figure.name.clone(),
        why: why.to_owned(),
    };
    let files = [("figure.svg".to_owned(), figure.svg.clone().into_bytes())];
    let world = MemoryWorld::new(PAGE, files).ok_or(ReportError::FileName)?;
    let first = |errors: &[typst::diag::SourceDiagnostic]| {
        let message = errors.first().map(|e| e.message.to_string());
        failed(&message.unwrap_or_default())
    };
    let paged: PagedDocument = typst::compile(&world).output.map_err(|e| first(&e))?;
    let options = PdfOptions {
        ident: typst::foundations::Smart::Custom(figure.title.clone()),
        creator: typst::foundations::Smart::Custom(Some("impactid".into())),
        ..PdfOptions::default()
    };
    let bytes = typst_pdf::pdf(&paged, &options).map_err(|e| first(&e))?;
    typst::comemo::evict(0);
    Ok(bytes)
}
