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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_beyond_the_footer_are_refused() {
        // Field 2 of thrift's compact protocol is the schema: a list that claims 2^31 − 1 structures.
        assert!(check(&[0x15, 4, 0x19, 0xFC, 0xFF, 0xFF, 0xFF, 0xFF, 0x07]).is_err());
        // A text of 100 bytes in a field that is not known, of which one is there.
        assert!(check(&[0x18, 100, b'a']).is_err());
        // The end within a value.
        assert!(check(&[0x15]).is_err());
        // Structures nested without an end.
        assert!(check(&[0x1C; 100]).is_err());
        assert!(check(&vec![0x1C; 1 << 20]).is_err());
    }

    #[test]
    fn a_first_page_claims_its_unpacked_bytes_or_its_dictionary() {
        // Fields 1 to 3: kind 2, 3 unpacked and 2 packed bytes; 7: a dictionary of 500 values.
        let dictionary = [
            0x15, 0x04, 0x15, 0x06, 0x15, 0x04, 0x4C, 0x15, 0xE8, 0x07, 0x15, 0x00, 0x00, 0x00,
        ];
        assert_eq!(first_claim(&dictionary), Some(500));
        assert_eq!(first_claim(&dictionary[..5]), None);
    }
}
