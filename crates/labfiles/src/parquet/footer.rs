//! The footer and the pages' headers of a Parquet file, read with a limit before the library reads
//! them: a list that claims more entries than there are bytes would be given memory first and
//! refused later.

use polars_parquet_format::thrift::protocol::TCompactInputProtocol;
use polars_parquet_format::{FileMetaData, PageHeader, thrift};

/// Go through a footer.
///
/// # Errors
/// If a length or a count exceeds what the footer may hold, or the structure does not end.
pub(super) fn check(footer: &[u8]) -> thrift::Result<()> {
    let limit = 2 * footer.len() + 1024;
    FileMetaData::read_from_in_protocol(&mut TCompactInputProtocol::new(footer, limit)).map(drop)
}

/// Unpacked bytes, or values of a dictionary where they are more, that a column's first page
/// claims.
pub(super) fn first_claim(bytes: &[u8]) -> Option<u64> {
    let mut protocol = TCompactInputProtocol::new(bytes, bytes.len());
    let header = PageHeader::read_from_in_protocol(&mut protocol).ok()?;
    let values = header.dictionary_page_header.map_or(0, |d| d.num_values);
    let claim = |n: i32| u64::try_from(n).unwrap_or(u64::MAX);
    Some(claim(header.uncompressed_page_size).max(claim(values)))
}
