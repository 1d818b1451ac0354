//! What a report is written as, and what the reader chose about its look.

use super::catalog::Catalog;
use super::locale::Locale;

/// Paper of the document.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Paper {
    /// 210 mm × 297 mm.
    #[default]
    A4,
    /// 8.5 in × 11 in.
    #[serde(alias = "letter")]
    UsLetter,
}

impl Paper {
    /// Its name in campaign.toml and in the template.
    pub fn name(self) -> &'static str {
        match self {
            Self::A4 => "a4",
            Self::UsLetter => "us-letter",
        }
    }
}

/// What a report can be written as.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    serde::Serialize,
    serde::Deserialize,
    strum::IntoStaticStr,
    strum::VariantArray,
    strum::VariantNames,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Format {
    /// The document as PDF.
    Pdf,
    /// The document as one self-contained HTML page.
    Html,
    /// Each figure as SVG.
    Svg,
    /// Each figure as PNG.
    Png,
    /// Each figure as PDF of its size, for papers.
    FigurePdf,
    /// Each table as LaTeX.
    Tex,
    /// Each figure's data as CSV.
    Csv,
}

impl Format {
    /// All formats.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// The format's name on the command line.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

impl std::str::FromStr for Format {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let name = name.trim();
        let is_named = |f: &&Self| f.name().eq_ignore_ascii_case(name);
        let found = Self::ALL.iter().find(is_named).copied();
        let known = <Self as strum::VariantNames>::VARIANTS.join(", ");
        found.ok_or_else(|| format!("unknown format '{name}'; known are {known}"))
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
pub struct ReportOptions {
    /// Paper.
    pub paper: Paper,
    /// Language that a template of the user's own may go by, as ISO 639-1 writes it.
    pub language: String,
    /// Phrases and messages in another language than English.
    pub catalog: Option<Catalog>,
    /// Whether numbers have a decimal comma.
    pub decimal_comma: bool,
    /// A typst template instead of the built-in one; it reads `report.json`, `layout.json` and the figures.
    pub template: Option<String>,
    /// A logo.
    pub logo: Option<Logo>,
    /// How a page finds out that a newer one was written, while records are still arriving.
    pub live: Option<LivePage>,
}

/// A page that reloads itself when a newer one is there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LivePage {
    /// The script beside the page that calls `impactidLive` with the version of the newest page.
    pub state: String,
    /// The version of this page.
    pub version: String,
    /// Number of records that can be used so far.
    pub records: usize,
}

impl Default for ReportOptions {
    fn default() -> Self {
        Self {
            paper: Paper::default(),
            language: "en".to_owned(),
            catalog: None,
            decimal_comma: false,
            template: None,
            logo: None,
            live: None,
        }
    }
}

impl ReportOptions {
    /// How texts and numbers are printed.
    pub fn locale(&self) -> Locale<'_> {
        Locale {
            decimal_comma: self.decimal_comma,
            catalog: self.catalog.as_ref(),
        }
    }

    /// The language of the report's texts, as ISO 639-1 writes it.
    pub(super) fn spoken(&self) -> &str {
        let catalog = self.catalog.as_ref();
        catalog.map_or("en", |c| c.language.as_deref().unwrap_or(&self.language))
    }
}
