//! Why a report could not be made.

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
        /// The renderer's message.
        why: String,
    },
    /// A file name is not fit for the document.
    #[error("the logo's file extension is not fit for the document; use svg, png or jpg")]
    FileName,
}
