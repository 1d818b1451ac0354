//! The PDF: the template set with the document's data and figures.

use super::breaks::Layout;
use super::model::Document;
use super::world::{MemoryWorld, Unset};
use crate::error::ReportError;
use crate::kit::Figure;
use crate::options::ReportOptions;

/// The built-in layout.
const TEMPLATE: &str = include_str!("../template.typ");

/// Sets the document and exports it. The same input gives the same bytes.
///
/// # Errors
/// [`ReportError::FileName`] for a logo whose extension is none, [`ReportError::Template`] and
/// [`ReportError::Pdf`] where the document cannot be set or exported.
pub(crate) fn pdf(
    document: &Document,
    figures: &[Figure],
    options: &ReportOptions,
) -> Result<Vec<u8>, ReportError> {
    let template = options.template.as_deref().unwrap_or(TEMPLATE);
    let files = files(document, options)?;
    let world = MemoryWorld::new(template, figures, options.spoken(), files)
        .ok_or(ReportError::FileName)?;
    let layout = Layout::of(&document.sections);
    world.pdf(&document.title, layout).map_err(|e| match e {
        Unset::Template(why) => ReportError::Template(why),
        Unset::Pages(why) => ReportError::Pdf(why),
    })
}

fn files(
    document: &Document,
    options: &ReportOptions,
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
    Ok(files)
}
