//! The world in which a document is set: a template, its data, its figures, the embedded fonts; and
//! its pages as PDF.

use std::collections::HashMap;
use std::sync::OnceLock;

use typst::diag::{FileError, FileResult, SourceDiagnostic};
use typst::foundations::{Bytes, Datetime, Duration, Smart};
use typst::syntax::{FileId, RootedPath, Source, VirtualPath, VirtualRoot};
use typst::text::{Font, FontBook, Lang};
use typst::utils::LazyHash;
use typst::{Library, LibraryExt, World, WorldExt};
use typst_layout::PagedDocument;
use typst_pdf::PdfOptions;

use super::placed::{self, Placed};
use crate::report::figures::{Figure, fonts};

/// Files in memory; there is no clock and no access to the disk.
pub(crate) struct MemoryWorld<'a> {
    main: Source,
    files: HashMap<FileId, Bytes>,
    figures: &'a [Figure],
    language: Lang,
}

impl<'a> MemoryWorld<'a> {
    /// A world of a template, of figures that it places as `image("NAME.svg")`, and of further files
    /// by their paths. `language` is that of the figures' texts (ISO 639-1).
    pub(crate) fn new(
        template: &str,
        figures: &'a [Figure],
        language: &str,
        files: impl IntoIterator<Item = (String, Vec<u8>)>,
    ) -> Option<Self> {
        let main = Source::new(id("main.typ")?, template.to_owned());
        let figure = |f: &Figure| (format!("{}.svg", f.name), placed::stand_in(f));
        let files = files.into_iter().map(|(path, b)| (path, Bytes::new(b)));
        let files = files
            .chain(figures.iter().map(figure))
            .map(|(path, bytes)| Some((id(&path)?, bytes)))
            .collect::<Option<_>>()?;
        Some(Self {
            main,
            files,
            figures,
            language: language.parse().unwrap_or(Lang::ENGLISH),
        })
    }
}

/// Why a world gives no pages.
pub(crate) enum Unset {
    /// The template is wrong, or a file that it names is.
    Template(String),
    /// The pages cannot be exported.
    Pages(String),
}

impl MemoryWorld<'_> {
    /// The template set and exported as PDF. The same world gives the same bytes.
    pub(crate) fn pdf(&self, title: &str) -> Result<Vec<u8>, Unset> {
        let (pages, figures) = rayon::join(
            || typst::compile::<PagedDocument>(self),
            || Placed::new(self.figures, self.language),
        );
        let pages = pages.output.map_err(|e| Unset::Template(self.first(&e)))?;
        let options = PdfOptions {
            ident: Smart::Custom(title.to_owned()),
            creator: Smart::Custom(Some("impactid".into())),
            ..PdfOptions::default()
        };
        // what the layout remembered is freed beside the export, which needs none of it
        let (exported, ()) = rayon::join(
            || {
                let pages = figures.in_pages(pages);
                let bytes = typst_pdf::pdf(&pages, &options);
                (bytes, pages)
            },
            || typst::comemo::evict(0),
        );
        let (bytes, pages) = exported;
        // nobody waits for the memory
        rayon::spawn(move || {
            drop(pages);
            typst::comemo::evict(0);
        });
        bytes.map_err(|e| Unset::Pages(self.first(&e)))
    }

    /// The first complaint with its line in the template and its hints.
    fn first(&self, errors: &[SourceDiagnostic]) -> String {
        let Some(error) = errors.first() else {
            return String::new();
        };
        let mut text = error.message.to_string();
        if let Some(range) = self.range(error.span) {
            let before = self.main.text().bytes().take(range.start);
            let line = before.filter(|b| *b == b'\n').count() + 1;
            text.push_str(&format!(", line {line}"));
        }
        for hint in &error.hints {
            text.push_str(&format!("; {}", hint.v));
        }
        text
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

impl World for MemoryWorld<'_> {
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
