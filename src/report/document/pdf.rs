//! The PDF: the template set with the document's data and figures.

use typst::WorldExt;
use typst::diag::SourceDiagnostic;
use typst_layout::PagedDocument;
use typst_pdf::PdfOptions;

use super::model::Document;
use super::world::MemoryWorld;
use crate::report::figures::Figure;
use crate::report::{RenderOptions, ReportError};

const TEMPLATE: &str = include_str!("../template.typ");

/// Sets the document and exports it. The same input gives the same bytes.
pub fn pdf(
    document: &Document,
    figures: &[Figure],
    options: &RenderOptions,
) -> Result<Vec<u8>, ReportError> {
    let template = options.template.as_deref().unwrap_or(TEMPLATE);
    let files = files(document, figures, options)?;
    let world = MemoryWorld::new(template, files).ok_or(ReportError::FileName)?;
    let paged: PagedDocument = typst::compile(&world)
        .output
        .map_err(|e| ReportError::Template(first(&e, &world)))?;
    let pdf_options = PdfOptions {
        ident: typst::foundations::Smart::Custom(document.title.clone()),
        creator: typst::foundations::Smart::Custom(Some("impactid".into())),
        ..PdfOptions::default()
    };
    let bytes =
        typst_pdf::pdf(&paged, &pdf_options).map_err(|e| ReportError::Pdf(first(&e, &world)))?;
    typst::comemo::evict(0);
    Ok(bytes)
}

fn files(
    document: &Document,
    figures: &[Figure],
    options: &RenderOptions,
) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let mut data = serde_json::to_value(document).map_err(ReportError::Data)?;
    data["paper"] = options.paper.name().into();
    data["language"] = options.language.clone().into();
    data["spoken"] = options.spoken().into();
    data["logo"] = options
        .logo
        .as_ref()
        .map(|l| format!("logo.{}", l.extension))
        .into();
    let data = serde_json::to_vec(&data).map_err(ReportError::Data)?;
    let mut files = vec![("report.json".to_owned(), data)];
    if let Some(logo) = &options.logo {
        files.push((format!("logo.{}", logo.extension), logo.bytes.clone()));
    }
    files.extend(
        figures
            .iter()
            .map(|f| (format!("{}.svg", f.name), f.svg.clone().into_bytes())),
    );
    Ok(files)
}

/// The first complaint with its line in the template and its hints.
fn first(errors: &[SourceDiagnostic], world: &MemoryWorld) -> String {
    let Some(error) = errors.first() else {
        return String::new();
    };
    let mut text = error.message.to_string();
    if let Some(range) = world.range(error.span) {
        let line = world.lines_before(range.start) + 1;
        text.push_str(&format!(", line {line}"));
    }
    for hint in &error.hints {
        text.push_str(&format!("; {}", hint.v));
    }
    text
}
