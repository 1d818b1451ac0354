//! Figures and documents of what was identified: PDF, HTML, LaTeX tables, SVG, PNG and the figures' data.
//!
//! A [`ReportContent`] is what a report shows, as plain data; [`Report`] draws its figures and sets the
//! document in the formats that are asked for. It formats what it is given and computes nothing: the
//! same content gives the same bytes.
//!
//! ```
//! use impact_identification::identify::Provenance;
//! use impact_identification::replay::fixture;
//! use impact_report::{CampaignFacts, Report, ReportContent, ReportOptions, Subject};
//!
//! // free decays of three masses, simulated and identified
//! let decays = fixture::decays();
//! let content = ReportContent {
//!     title: "Three masses on a blade spring".into(),
//!     campaign: CampaignFacts { subject: Subject::OneMass, ..CampaignFacts::default() },
//!     identification: decays.identification.clone(),
//!     provenance: Provenance {
//!         settings: serde_json::json!({}),
//!         versions: Default::default(),
//!         inputs_sha256: Default::default(),
//!     },
//!     compared: decays.compared.clone(),
//!     proposals: Vec::new(),
//!     tables: Vec::new(),
//!     command_line: String::new(),
//!     date: None,
//! };
//! let report = Report::new(&content, &ReportOptions::default());
//! let page = report.html()?;
//! assert!(page.contains("Three masses on a blade spring"));
//! # Ok::<(), impact_report::ReportError>(())
//! ```

pub mod catalog;
mod content;
pub mod differences;
mod document;
mod error;
pub mod figures;
mod html;
pub mod kit;
mod latex;
pub mod locale;
mod options;
mod parameters;
mod phrase;
pub mod picture;
mod png;
pub mod style;

pub use content::{
    CampaignFacts, CampaignsContent, DataTable, NominalValue, ReportContent, Subject,
};
pub use document::budget_source;
pub use error::ReportError;
pub use options::{Format, LivePage, Logo, Paper, ReportOptions};
pub use phrase::{Phrase, Text};

use kit::Figure;
use locale::Locale;
use rayon::prelude::*;

/// A report with its figures drawn, ready for every format.
pub struct Report {
    /// The document's data.
    document: document::model::Document,
    /// The figures.
    figures: Vec<Figure>,
    options: ReportOptions,
    /// Stem of the document's file name.
    name: &'static str,
}

impl Report {
    /// Draws the figures of a content and builds the document's data.
    pub fn new(content: &ReportContent, options: &ReportOptions) -> Self {
        let locale = options.locale();
        let figures = figures::draw_all(content, locale);
        let document = document::document(content, &figures, locale);
        Self {
            document,
            figures,
            options: options.clone(),
            name: "report",
        }
    }

    /// The same of several campaigns that were compared.
    pub fn of_campaigns(content: &CampaignsContent, options: &ReportOptions) -> Self {
        let locale = options.locale();
        let trend = figures::trend::draw(&content.comparison, locale);
        let figures: Vec<Figure> = trend.into_iter().collect();
        let document = document::campaigns(content, &figures, locale);
        Self {
            document,
            figures,
            options: options.clone(),
            name: "comparison",
        }
    }

    /// The report as PDF. The same content gives the same bytes.
    ///
    /// # Errors
    /// [`ReportError::FileName`] for a logo whose file has no usable extension, [`ReportError::Template`]
    /// and [`ReportError::Pdf`] if the document cannot be typeset or exported.
    pub fn pdf(&self) -> Result<Vec<u8>, ReportError> {
        document::pdf(&self.document, &self.figures, &self.options)
    }

    /// The report as one self-contained HTML page.
    ///
    /// # Errors
    /// [`ReportError::Data`] if its data cannot be written as JSON.
    pub fn html(&self) -> Result<String, ReportError> {
        html::html(&self.document, &self.figures, &self.options)
    }

    /// The files of a format, by their paths relative to the report's folder: the document itself,
    /// or each figure under `figures/`.
    ///
    /// # Errors
    /// Those of [`Self::pdf`] and [`Self::html`]; [`ReportError::Picture`] if a figure cannot be drawn.
    pub fn files(&self, format: Format) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
        let each = |ending: &str, of: &(dyn Fn(&Figure) -> Result<Vec<u8>, ReportError> + Sync)| {
            let path = |f: &Figure| format!("figures/{}.{ending}", f.name);
            self.figures
                .par_iter()
                .map(|f| Ok((path(f), of(f)?)))
                .collect()
        };
        match format {
            Format::Pdf => Ok(vec![(format!("{}.pdf", self.name), self.pdf()?)]),
            Format::Html => Ok(vec![(
                format!("{}.html", self.name),
                self.html()?.into_bytes(),
            )]),
            Format::Svg => each("svg", &|f| Ok(f.svg().into_bytes())),
            Format::Png => each("png", &png::png),
            Format::FigurePdf => each("pdf", &|f| picture::pdf(f, self.options.spoken())),
            Format::Tex => Ok(latex::tables(&self.document)),
            Format::Csv => {
                let mut files = each("csv", &|f| Ok(f.csv.clone().into_bytes()))?;
                files.retain(|(_, data)| !data.is_empty());
                Ok(files)
            }
        }
    }

    /// The files of some formats; the figures' data are always among them, last.
    ///
    /// # Errors
    /// Those of [`Self::files`].
    pub fn all_files(&self, formats: &[Format]) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
        let others = formats.iter().filter(|f| **f != Format::Csv);
        let each: Result<Vec<_>, _> = others
            .chain([&Format::Csv])
            .map(|f| self.files(*f))
            .collect();
        Ok(each?.concat())
    }
}

/// The map of motions by itself, with the settings that are proposed: plan.svg, .png and .pdf.
/// Nothing where the records have no place in a plane.
///
/// # Errors
/// [`ReportError::Picture`] where a renderer refuses the figure.
pub fn plan_map(
    content: &ReportContent,
    decimal_comma: bool,
) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let locale = Locale {
        decimal_comma,
        catalog: None,
    };
    let Some(mut figure) = figures::map::draw(content, figures::map::MapSize::Full, locale) else {
        return Ok(Vec::new());
    };
    figure.name = "plan".into();
    picture::pictures(&figure)
}

#[cfg(test)]
mod tests;

/// The example of the README, checked as the others are.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
