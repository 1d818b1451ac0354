//! Characters of MATLAB arrays, and the short values that serve as attributes.

use super::tree::{Content, Encoding, Leaf, Part};
use crate::bytes::to_usize;
use crate::numbers::{self, ByteOrder};

/// Longest text that is kept as an attribute, bytes.
const SHORT: u64 = 512;

/// The characters that the bytes encode; what is no character becomes U+FFFD.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "codes of characters, which files hold as numbers of any type"
)]
fn characters(bytes: &[u8], part: Part, encoding: Encoding, order: ByteOrder) -> Vec<char> {
    let codes = || {
        let mut codes = Vec::new();
        numbers::decode(part.number, order, bytes, &mut codes);
        codes.into_iter().map(|c| c as u32)
    };
    match encoding {
        Encoding::Utf8 => String::from_utf8_lossy(bytes).chars().collect(),
        Encoding::Utf16 => char::decode_utf16(codes().map(|c| c as u16))
            .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect(),
        Encoding::Codes | Encoding::Utf32 => codes()
            .map(|c| char::from_u32(c).unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect(),
    }
}

/// The rows of a text array as strings.
pub(crate) fn rows(leaf: &Leaf, bytes: &[u8], order: ByteOrder) -> Vec<String> {
    let Content::Text(part, encoding) = leaf.content else {
        return Vec::new();
    };
    let all = characters(bytes, part, encoding, order);
    let rows = to_usize(row_count(leaf));
    match rows {
        0 => Vec::new(),
        1 => vec![all.into_iter().collect()],
        _ => (0..rows)
            .map(|row| all.iter().skip(row).step_by(rows).collect())
            .collect(),
    }
}

/// Number of strings in a text array: its rows, none if it is empty.
pub(crate) fn row_count(leaf: &Leaf) -> u64 {
    if leaf.count() == 0 { 0 } else { leaf.dims[0] }
}

/// The value of an array of one number or of one short string, as text.
pub(crate) fn short_value<E>(
    leaf: &Leaf,
    order: ByteOrder,
    fetch: impl FnOnce(Part) -> Result<Vec<u8>, E>,
) -> Result<Option<String>, E> {
    match leaf.content {
        Content::Real(part) if leaf.count() == 1 => {
            let mut values = Vec::new();
            numbers::decode(part.number, order, &fetch(part)?, &mut values);
            Ok(values.first().map(f64::to_string))
        }
        Content::Text(part, _) if row_count(leaf) == 1 && part.bytes <= SHORT => {
            Ok(rows(leaf, &fetch(part)?, order).pop())
        }
        _ => Ok(None),
    }
}
