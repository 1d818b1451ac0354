//! The report: its content as plain data first, then the figures, then the document.
//!
//! No result is computed here; what is drawn was found in the rooms to the left.

pub mod assemble;
pub mod content;
pub mod document;
pub mod figures;
mod html;
pub mod parameters;
pub mod picture;
mod png;
pub mod theory;
pub mod words;

pub use content::{ProposedPoint, ReportContent};

use figures::Figure;
use figures::look::NumberLook;
use rayon::prelude::*;
use words::Words;

/// Paper of the document.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Paper {
    /// 210 mm × 297 mm.
    #[default]
    A4,
    /// 8.5 in × 11 in.
    Letter,
}

impl Paper {
    /// The name the template knows.
    pub fn name(self) -> &'static str {
        match self {
            Self::A4 => "a4",
            Self::Letter => "us-letter",
        }
    }
}

/// What a report can be written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Format {
    /// The document as PDF.
    Pdf,
    /// The document as one self-contained HTML page.
    Html,
    /// Each figure as SVG.
    Svg,
    /// Each figure as PNG.
    Png,
    /// Each figure's data as CSV.
    Csv,
}

impl Format {
    /// All formats.
    pub const ALL: [Format; 5] = [
        Format::Pdf,
        Format::Html,
        Format::Svg,
        Format::Png,
        Format::Csv,
    ];

    /// The format's name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pdf => "pdf",
            Self::Html => "html",
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Csv => "csv",
        }
    }
}

impl std::str::FromStr for Format {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|f| f.name() == name);
        found.ok_or_else(|| format!("unknown format '{name}'; known are pdf, html, svg, png, csv"))
    }
}

/// A logo for the first page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Logo {
    /// The image file.
    pub bytes: Vec<u8>,
    /// Its kind by file extension: `svg`, `png`, `jpg`, `webp`, `gif` or `pdf`.
    pub extension: String,
}

/// What the reader chose about the report's look.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RenderOptions {
    /// Paper.
    pub paper: Paper,
    /// Language that a template of the user's own may go by, as ISO 639-1 writes it.
    pub language: String,
    /// The report's own words in another language than English.
    pub words: Option<Words>,
    /// Whether numbers have a decimal comma.
    pub decimal_comma: bool,
    /// A typst template instead of the built-in one; it reads `report.json` and the figures.
    pub template: Option<String>,
    /// A logo.
    pub logo: Option<Logo>,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            paper: Paper::default(),
            language: "en".to_owned(),
            words: None,
            decimal_comma: false,
            template: None,
            logo: None,
        }
    }
}

impl RenderOptions {
    fn numbers(&self) -> NumberLook<'_> {
        NumberLook {
            decimal_comma: self.decimal_comma,
            table: self.words.as_ref(),
        }
    }

    /// The language that the report's own words are in.
    fn spoken(&self) -> &str {
        let words = self.words.as_ref();
        words.map_or("en", |w| w.language.as_deref().unwrap_or(&self.language))
    }
}

/// Why a report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The template is wrong, or an image could not be read.
    #[error(
        "the report's template cannot be set: {0}. Check the file given as template, or leave it out to use the built-in one"
    )]
    Template(String),
    /// The PDF could not be written.
    #[error("the report cannot be exported as PDF: {0}. A logo in another format may help")]
    Pdf(String),
    /// The content cannot be written as JSON.
    #[error("the report's content cannot be written as JSON: {0}")]
    Data(#[source] serde_json::Error),
    /// A figure could not be turned into a picture.
    #[error("figure '{name}' cannot be turned into a PNG: {why}. Ask for svg instead")]
    Picture {
        /// The figure.
        name: String,
        /// What the renderer said.
        why: String,
    },
    /// A file name is not fit for the document.
    #[error("the logo's file extension is not fit for the document; use svg, png or jpg")]
    FileName,
}

/// A report with its figures drawn, ready for every format.
pub struct Report {
    /// The document's data.
    pub document: document::model::Document,
    /// The figures.
    pub figures: Vec<Figure>,
    options: RenderOptions,
}

impl Report {
    /// Draws the figures of a content and builds the document's data.
    pub fn new(content: &ReportContent, options: &RenderOptions) -> Self {
        let numbers = options.numbers();
        let figures = figures::draw_all(content, numbers);
        let document = document::document(content, &figures, numbers);
        Self {
            document,
            figures,
            options: options.clone(),
        }
    }

    /// The report as PDF. The same content gives the same bytes.
    pub fn pdf(&self) -> Result<Vec<u8>, ReportError> {
        document::pdf(&self.document, &self.figures, &self.options)
    }

    /// The report as one self-contained HTML page.
    pub fn html(&self) -> Result<String, ReportError> {
        html::html(&self.document, &self.figures, &self.options)
    }

    /// The files of a format, by their paths relative to the report's folder: the document itself,
    /// or each figure under `figures/`.
    pub fn files(&self, format: Format) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
        let each = |ending: &str, of: &(dyn Fn(&Figure) -> Result<Vec<u8>, ReportError> + Sync)| {
            let path = |f: &Figure| format!("figures/{}.{ending}", f.name);
            self.figures
                .par_iter()
                .map(|f| Ok((path(f), of(f)?)))
                .collect()
        };
        match format {
            Format::Pdf => Ok(vec![("report.pdf".into(), self.pdf()?)]),
            Format::Html => Ok(vec![("report.html".into(), self.html()?.into_bytes())]),
            Format::Svg => each("svg", &|f| Ok(f.svg.clone().into_bytes())),
            Format::Png => each("png", &png::png),
            Format::Csv => each("csv", &|f| Ok(f.csv.clone().into_bytes())),
        }
    }
}

/// Draws a content and gives its PDF.
pub fn render_pdf(
    content: &ReportContent,
    options: &RenderOptions,
) -> Result<Vec<u8>, ReportError> {
    Report::new(content, options).pdf()
}

#[cfg(test)]
mod example;
#[cfg(test)]
mod tests;

/// The map of motions by itself, with the settings that are proposed: plan.svg, .png and .pdf.
/// Nothing where the records have no place in a plane.
///
/// # Errors
/// [`ReportError::Picture`] where a renderer refuses the figure.
pub fn plan_map(
    content: &ReportContent,
    decimal_comma: bool,
) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let numbers = NumberLook {
        decimal_comma,
        table: None,
    };
    let Some(mut figure) = figures::map::draw(content, figures::map::MapSize::Full, numbers) else {
        return Ok(Vec::new());
    };
    figure.name = "plan".into();
    picture::pictures(&figure)
}
