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

use super::breaks::{self, Layout, SetPage};
use super::placed::{self, Placed};
use crate::kit::{Figure, fonts};

/// The file in which the template finds the layout.
const LAYOUT: &str = "layout.json";
/// How often other breaks are tried.
const MOST_BREAKS: usize = 4;

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

/// A document as set.
struct Attempt {
    document: PagedDocument,
    pages: Vec<SetPage>,
    /// What its pages lack.
    lack: f64,
}

impl Attempt {
    fn of(document: PagedDocument) -> Self {
        let pages = SetPage::all(&document);
        let lack = breaks::lack(&pages);
        Self {
            document,
            pages,
            lack,
        }
    }
}

impl MemoryWorld<'_> {
    /// The template set and exported as PDF, in the layout that is asked for, or in another one if that
    /// fills the pages better. The same world gives the same bytes.
    pub(crate) fn pdf(&self, title: &str, asked_for: Layout) -> Result<Vec<u8>, Unset> {
        let (pages, figures) = rayon::join(
            || self.filled_pages(asked_for),
            || Placed::new(self.figures, self.language),
        );
        let pages = pages?;
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

    /// The pages with stand-ins for the figures, in the layout that leaves them fullest.
    fn filled_pages(&self, asked_for: Layout) -> Result<PagedDocument, Unset> {
        let close = Layout {
            close: true,
            ..asked_for.clone()
        };
        let usual = self.with_breaks(asked_for)?;
        if usual.lack == 0.0 {
            return Ok(usual.document);
        }
        let close = self.with_breaks(close)?;
        let better = if close.lack < usual.lack {
            close
        } else {
            usual
        };
        Ok(better.document)
    }

    /// The pages with the breaks that leave them fullest.
    fn with_breaks(&self, mut layout: Layout) -> Result<Attempt, Unset> {
        let mut best = self.attempt(&layout)?;
        let mut last = best.pages.clone();
        for _ in 0..MOST_BREAKS {
            match breaks::improved(&last, &layout.breaks) {
                Some(next) if best.lack > 0.0 => layout.breaks = next,
                _ => break,
            }
            let next = self.attempt(&layout)?;
            last.clone_from(&next.pages);
            if next.lack < best.lack {
                best = next;
            }
        }
        Ok(best)
    }

    fn attempt(&self, layout: &Layout) -> Result<Attempt, Unset> {
        let document = self.pages(layout)?;
        Ok(Attempt::of(document))
    }

    /// The pages with stand-ins for the figures, in a layout.
    fn pages(&self, layout: &Layout) -> Result<PagedDocument, Unset> {
        let unset = |why: String| Unset::Template(why);
        let bytes = serde_json::to_vec(layout).map_err(|e| unset(e.to_string()))?;
        let file = id(LAYOUT).ok_or_else(|| unset(LAYOUT.into()))?;
        let mut files = self.files.clone();
        files.insert(file, Bytes::new(bytes));
        let world = Self {
            main: self.main.clone(),
            files,
            ..*self
        };
        let pages = typst::compile(&world).output;
        pages.map_err(|e| Unset::Template(self.first(&e)))
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

#[cfg(test)]
mod tests {
    use typst::layout::{Frame, FrameItem};

    use super::*;
    use crate::kit::canvas::{Anchor, Canvas, TextLook};

    /// Texts of a frame with their sizes across the page in points, and the numbers of its pictures and
    /// of its groups that are clipped.
    fn contents(frame: &Frame, scale: f64, found: &mut (Vec<(String, f64)>, usize, usize)) {
        for (_, item) in frame.items() {
            match item {
                FrameItem::Group(group) => {
                    found.2 += usize::from(group.clip.is_some());
                    let scale = scale * group.transform.sx.get();
                    contents(&group.frame, scale, found);
                }
                FrameItem::Text(text) => {
                    let size = scale * text.size.to_pt();
                    found.0.push((text.text.to_string(), size));
                }
                FrameItem::Image(..) => found.1 += 1,
                _ => {}
            }
        }
    }

    #[test]
    fn a_figure_takes_its_place_in_the_size_that_the_template_gives_it() {
        let mut canvas = Canvas::new(200.0, 100.0);
        let look = TextLook::new(8.0, Anchor::Left);
        canvas.text((10.0, 20.0), "label", look);
        let figures = [Figure::new("map", "a map", canvas, String::new())];
        let template = "#image(\"map.svg\")\n#rotate(5deg, image(\"map.svg\", width: 50pt))\n\
                        #hide(image(\"map.svg\"))";
        let world = MemoryWorld::new(template, &figures, "en", []).expect("a world");
        let pages = world.pages(&Layout::default()).ok().expect("pages");
        let pages = Placed::new(&figures, Lang::ENGLISH).in_pages(pages);
        let mut found = (Vec::new(), 0, 0);
        contents(&pages.pages()[0].frame, 1.0, &mut found);
        let (texts, pictures, clipped) = found;
        assert_eq!((pictures, clipped), (0, 2));
        assert_eq!(texts.len(), 2);
        assert!(texts.iter().all(|(text, _)| text == "label"));
        assert!((texts[0].1 - 8.0).abs() < 1e-5, "{texts:?}");
        // a quarter of its width, and turned; sizes of pictures are single precision
        let turned = 2.0 * 5f64.to_radians().cos();
        assert!((texts[1].1 - turned).abs() < 1e-5, "{texts:?}");
    }
}
