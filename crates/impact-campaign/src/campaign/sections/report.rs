//! `[report]`: how the report looks.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::campaign::context::ResolveContext;
use crate::campaign::diagnostic::Code;
use crate::campaign::keys::keys;
use crate::campaign::slashes;
use crate::campaign::values::{Format, LanguageCode, Paper, Placed, value};
use impact_records::language::Language;
use impact_report::catalog::Catalog;

keys! {
    /// `[report]`.
    #[serde(default)]
    pub struct ReportTable {
        /// on the first page
        title: Placed<String>, default "the campaign's name";
        /// `"a4"` or `"letter"` (`"us-letter"` is the same)
        paper: Placed<Paper>, default "`\"a4\"`",
            init r#"paper = "a4"                 # or "letter""#;
        /// {languages}; another code of ISO 639-1, such as `"cs"`, is for a template or a table of words of
        /// your own; without one the report is in English
        language: Placed<LanguageCode>, default "`\"en\"`",
            init r#"language = "en"              # {languages}"#;
        /// numbers with a decimal comma
        decimal_comma: Placed<bool>, default "as the language has it",
            init "# decimal_comma = true       # numbers with a decimal comma; as the language has it";
        /// any of `"pdf"`, `"html"`, `"svg"`, `"png"`, `"figure-pdf"` (each figure as PDF), `"tex"` (each table as
        /// LaTeX, in `tables/`), `"csv"` (the data of the figures alone, no document); the data of the figures are
        /// always written as CSV
        formats: Placed<Vec<Format>>, default "`[\"pdf\"]`",
            init r#"formats = ["pdf"]            # any of pdf, html, svg, png, figure-pdf, tex, csv (the data of the figures alone, which are always written)"#;
        /// records whose time series and phase portraits are drawn
        points: Placed<Vec<String>>, default "the best record of each type of motion, at most eight",
            init r#"# points = ["record_12"]     # records to draw; chosen by the program if not given"#;
        /// an image for the first page (SVG, PNG, JPEG), relative to the folder of campaign.toml
        logo: Placed<String>, default "none",
            init r#"# logo = "logo.svg"          # an image for the first page (svg, png or jpg)"#;
        /// a typst template instead of the built-in one (`crates/impact-report/src/template.typ`), relative to the
        /// folder of campaign.toml; it reads `report.json` (and `layout.json`: which marked parts begin a page) and places a
        /// figure as `image("NAME.svg")`; while the
        /// pages are set, that file has the figure's size alone
        template: Placed<String>, default "built in",
            init r#"# template = "report.typ"    # a typst template instead of the built-in one"#;
        /// a table of the report's words in another language, see below; relative to the folder of campaign.toml
        words: Placed<String>, default "those of `language`",
            init r#"# words = "words.toml"       # the report's words in another language"#;
    }
}

/// Settings of the report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReportSettings {
    /// Title.
    pub title: String,
    /// Records whose time series and phase portraits are drawn; empty: chosen by the program.
    pub points: Vec<String>,
    /// Paper size.
    pub paper: Paper,
    /// Language.
    pub language: LanguageCode,
    /// Whether numbers are printed with a decimal comma.
    pub decimal_comma: bool,
    /// Formats; the data of the figures are always written.
    #[serde(default)]
    pub formats: Vec<Format>,
    /// A typst template instead of the built-in one.
    #[serde(default, serialize_with = "slashes::serialize_option")]
    pub template: Option<PathBuf>,
    /// A table of the report's words in another language.
    #[serde(default, serialize_with = "slashes::serialize_option")]
    pub words: Option<PathBuf>,
    /// An image for the first page.
    #[serde(default, serialize_with = "slashes::serialize_option")]
    pub logo: Option<PathBuf>,
    /// Day that is printed as that of the report.
    #[serde(skip)]
    pub date: Option<String>,
}

impl ReportSettings {
    /// That the report has no texts in its language and stays English, unless a table of words or a template has them.
    pub fn without_texts(&self) -> Option<String> {
        let code = &self.language.0;
        let has_texts =
            Language::of_code(code).is_some() || self.words.is_some() || self.template.is_some();
        (!has_texts).then(|| {
            format!("there are no texts in the language \"{code}\" of [report]: the report is in English")
        })
    }
}

/// What to do about a language without texts.
fn with_texts() -> String {
    let codes = Language::all().map(|language| format!("\"{}\"", language.code()));
    let codes = codes.collect::<Vec<_>>().join(" or ");
    format!(
        "write {codes}, or name a table of your own as words; `impactid report --list-words` prints one to translate"
    )
}

/// What the report of a campaign refers to.
pub(crate) struct Around<'a> {
    /// The campaign's name.
    pub(crate) name: &'a str,
    /// The folder of campaign.toml.
    pub(crate) folder: &'a Path,
    /// Names of the records.
    pub(crate) records: &'a [&'a str],
    /// Whether these are all.
    pub(crate) all: bool,
}

/// The settings, defaults included.
pub(crate) fn resolve(
    table: &ReportTable,
    around: &Around<'_>,
    context: &mut ResolveContext<'_>,
) -> ReportSettings {
    let known = |point: &String| around.records.contains(&point.as_str());
    if let Some(points) = table.points.as_ref().filter(|_| around.all) {
        for point in points.get_ref() {
            if !known(point) && !around.records.is_empty() {
                context.unknown_record(points, "report.points", point, around.records);
            }
        }
    }
    let language = value(&table.language).unwrap_or_default();
    let comma = Language::of_code(&language.0).is_some_and(Language::decimal_comma);
    let folder = around.folder;
    let settings = ReportSettings {
        title: value(&table.title).unwrap_or_else(|| around.name.to_owned()),
        points: value(&table.points)
            .unwrap_or_default()
            .into_iter()
            .filter(|point| around.all || known(point))
            .collect(),
        paper: value(&table.paper).unwrap_or(Paper::A4),
        language,
        decimal_comma: value(&table.decimal_comma).unwrap_or(comma),
        date: None,
        formats: value(&table.formats)
            .filter(|formats| !formats.is_empty())
            .unwrap_or_else(|| vec![Format::Pdf]),
        template: beside(&table.template, "report.template", folder, context),
        words: words_file(&table.words, folder, context),
        logo: beside(&table.logo, "report.logo", folder, context),
    };
    if let (Some(placed), Some(what)) = (&table.language, settings.without_texts()) {
        context.note(placed, "report.language", what, &with_texts());
    }
    settings
}

/// A table of words that campaign.toml names; a fault where it cannot be used.
fn words_file(
    placed: &Placed<String>,
    folder: &Path,
    context: &mut ResolveContext<'_>,
) -> Option<PathBuf> {
    let key = "report.words";
    let path = beside(placed, key, folder, context)?;
    if let (Some(placed), Ok(text)) = (placed, labfiles::read_text(&path))
        && let Err(error) = Catalog::read(&text)
    {
        let what = format!("{}: {error}", path.display());
        context.fault(
            Code::UnreadableFile,
            placed,
            key,
            what,
            "fix the table, or remove the line",
        );
    }
    Some(path)
}

/// A file that campaign.toml names; a fault where it is not there.
fn beside(
    placed: &Placed<String>,
    key: &str,
    folder: &Path,
    context: &mut ResolveContext<'_>,
) -> Option<PathBuf> {
    let placed = placed.as_ref()?;
    let path = folder.join(placed.get_ref());
    if !path.is_file() {
        let what = format!("{} is not a file", path.display());
        let remedy = "write its path as seen from campaign.toml's folder, or remove the line";
        context.fault(Code::UnreadableFile, placed, key, what, remedy);
    }
    Some(path)
}
