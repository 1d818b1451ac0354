//! The text of a run table: how it is decoded and read.

/// A row of cells.
#[derive(Debug)]
pub(super) struct Line {
    /// Its line in the table, from 1.
    pub(super) number: usize,
    /// What is in it.
    pub(super) cells: csv::StringRecord,
}

/// A reader of a text's rows.
pub(super) fn reader(text: &str, separator: u8) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new()
        .delimiter(separator)
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes())
}

/// By its byte-order mark, else UTF-8, else Windows-1252.
pub(super) fn decode(bytes: &[u8]) -> String {
    let without_mark = match std::str::from_utf8(bytes) {
        Ok(_) => encoding_rs::UTF_8,
        Err(_) => encoding_rs::WINDOWS_1252,
    };
    // the lines' numbers are counted by line feeds
    let text = without_mark.decode(bytes).0;
    text.replace("\r\n", "\n").replace('\r', "\n")
}
