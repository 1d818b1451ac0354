//! Plain texts that people write: descriptions, tables of words, templates.

use std::io;
use std::path::Path;

use encoding_rs::Encoding;

/// The text of a file in UTF-8, with or without a byte-order mark, or in UTF-16 with one, as `PowerShell` writes it.
///
/// # Errors
/// If the file cannot be read, or is in another encoding: [`io::ErrorKind::InvalidData`].
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("words.toml");
/// std::fs::write(&path, b"\xFF\xFEa\x00=\x001\x00")?;
/// assert_eq!(labfiles::read_text(&path)?, "a=1");
/// std::fs::write(&path, b"# f\xFCr")?;
/// let refused = labfiles::read_text(&path).unwrap_err();
/// assert!(refused.to_string().contains("not in UTF-8"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn read_text(path: &Path) -> io::Result<String> {
    let bytes = std::fs::read(path)?;
    let (encoding, mark) = Encoding::for_bom(&bytes).unwrap_or((encoding_rs::UTF_8, 0));
    let text = encoding.decode_without_bom_handling_and_without_replacement(&bytes[mark..]);
    text.map(std::borrow::Cow::into_owned).ok_or_else(|| {
        let what = "the text is not in UTF-8";
        io::Error::new(io::ErrorKind::InvalidData, what)
    })
}
