//! The report as one self-contained page: the same document, figures that can be zoomed, points
//! that show their record.

mod parts;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;

use super::document::model::Document;
use super::error::ReportError;
use super::kit::Figure;
use super::kit::escape;
use super::kit::fonts::{self, FAMILY, Face};
use super::options::ReportOptions;
use super::phrase::Phrase;

/// The page's look.
const STYLE: &str = include_str!("style.css");
/// What the page does: zooming, hovering, saving.
const SCRIPT: &str = include_str!("script.js");

/// What a page does while records are still arriving: it reloads itself.
const LIVE: &str = include_str!("live.js");

/// The page. The same input gives the same bytes; nothing is loaded from elsewhere.
pub(super) fn html(
    document: &Document,
    figures: &[Figure],
    options: &ReportOptions,
) -> Result<String, ReportError> {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n",
        escape(options.spoken())
    );
    page.push_str("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    page.push_str(&format!(
        "<title>{}</title>\n<style>\n",
        escape(&document.title)
    ));
    for (face, style, weight) in FACES {
        page.push_str(&font_face(face, style, weight));
    }
    page.push_str(STYLE);
    page.push_str("</style>\n</head>\n<body>\n");
    page.push_str(&logo(options));
    page.push_str(&live(options));
    let parts = parts::Parts::new(document, figures);
    page.push_str(&parts.body()?);
    let words = serde_json::to_string(&document.words).map_err(ReportError::Data)?;
    page.push_str(&format!(
        "<div id=\"tip\" role=\"status\"></div>\n\
         <script id=\"words\" type=\"application/json\">{}</script>\n<script>\n",
        words.replace("</", "<\\/")
    ));
    page.push_str(SCRIPT);
    page.push_str("</script>\n</body>\n</html>\n");
    Ok(page)
}

/// The faces that the page carries, with their CSS style and weight.
const FACES: [(Face, &str, &str); 3] = [
    (Face::Regular, "normal", "400"),
    (Face::Italic, "italic", "400"),
    (Face::Bold, "normal", "700"),
];

fn font_face(face: Face, style: &str, weight: &str) -> String {
    let Some(bytes) = fonts::face_bytes(face) else {
        return String::new();
    };
    format!(
        "@font-face {{ font-family: \"{FAMILY}\"; font-style: {style}; font-weight: {weight}; \
         src: url(data:font/otf;base64,{}) format(\"opentype\"); }}\n",
        BASE64_STANDARD.encode(bytes)
    )
}

/// What shows that records are still arriving, with the script that reloads the page.
fn live(options: &ReportOptions) -> String {
    let Some(live) = &options.live else {
        return String::new();
    };
    let count = live.records.to_string();
    let text = options.locale();
    let text = text.translate_with(Phrase::RecordsAreArriving, &[("count", &count)]);
    format!(
        "<p style=\"border-left:5px solid var(--warn);padding-left:0.7rem\" role=\"status\">{}</p>\n\
         <script data-state=\"{}\" data-version=\"{}\">\n{LIVE}</script>\n",
        escape(&text),
        escape(&live.state),
        escape(&live.version)
    )
}

fn logo(options: &ReportOptions) -> String {
    let Some(logo) = &options.logo else {
        return String::new();
    };
    let kind = match logo.extension.as_str() {
        "svg" => "image/svg+xml",
        "jpg" | "jpeg" => "image/jpeg",
        "webp" => "image/webp",
        "gif" => "image/gif",
        "pdf" => return String::new(),
        _ => "image/png",
    };
    let data = BASE64_STANDARD.encode(&logo.bytes);
    format!(
        "<img alt=\"logo\" style=\"float:right;height:3.4rem\" src=\"data:{kind};base64,{data}\">\n"
    )
}
