//! The world in which the document is set: a template, its data, its figures, the embedded fonts.

use std::collections::HashMap;
use std::sync::OnceLock;

use typst::diag::{FileError, FileResult};
use typst::foundations::{Bytes, Datetime, Duration};
use typst::syntax::{FileId, RootedPath, Source, VirtualPath, VirtualRoot};
use typst::text::{Font, FontBook};
use typst::utils::LazyHash;
use typst::{Library, LibraryExt, World};

use crate::report::figures::fonts;

/// Files in memory; there is no clock and no access to the disk.
pub struct MemoryWorld {
    main: Source,
    files: HashMap<FileId, Bytes>,
}

impl MemoryWorld {
    /// A world of a template and further files by their paths.
    pub fn new(template: &str, files: impl IntoIterator<Item = (String, Vec<u8>)>) -> Option<Self> {
        let main = Source::new(id("main.typ")?, template.to_owned());
        let files = files
            .into_iter()
            .map(|(path, bytes)| Some((id(&path)?, Bytes::new(bytes))))
            .collect::<Option<_>>()?;
        Some(Self { main, files })
    }
}

impl MemoryWorld {
    /// Number of line feeds in the template before a byte.
    pub fn lines_before(&self, byte: usize) -> usize {
        self.main
            .text()
            .bytes()
            .take(byte)
            .filter(|b| *b == b'\n')
            .count()
    }
}

fn id(path: &str) -> Option<FileId> {
    let path = VirtualPath::new(path).ok()?;
    Some(FileId::new(RootedPath::new(VirtualRoot::Project, path)))
}

fn book() -> &'static LazyHash<FontBook> {
    static BOOK: OnceLock<LazyHash<FontBook>> = OnceLock::new();
    BOOK.get_or_init(|| {
        LazyHash::new(FontBook::from_infos(
            fonts::embedded().iter().map(|(_, info)| info.clone()),
        ))
    })
}

fn library() -> &'static LazyHash<Library> {
    static LIBRARY: OnceLock<LazyHash<Library>> = OnceLock::new();
    LIBRARY.get_or_init(|| LazyHash::new(Library::default()))
}

impl World for MemoryWorld {
    fn library(&self) -> &LazyHash<Library> {
        library()
    }

    fn book(&self) -> &LazyHash<FontBook> {
        book()
    }

    fn main(&self) -> FileId {
        self.main.id()
    }

    fn source(&self, id: FileId) -> FileResult<Source> {
        if id == self.main.id() {
            Ok(self.main.clone())
        } else {
            Err(FileError::NotSource)
        }
    }

    fn file(&self, id: FileId) -> FileResult<Bytes> {
        let missing = || FileError::NotFound(id.vpath().get_with_slash().into());
        self.files.get(&id).cloned().ok_or_else(missing)
    }

    fn font(&self, index: usize) -> Option<Font> {
        fonts::embedded().get(index).map(|(font, _)| font.clone())
    }

    fn today(&self, _: Option<Duration>) -> Option<Datetime> {
        None
    }
}
