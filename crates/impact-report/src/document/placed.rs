//! Figures on the pages. While a document is set, an SVG without a drawing stands for each figure; in
//! the finished pages the figure's own frame takes its place, at the size that the template gave it.

use std::collections::HashMap;

use rayon::prelude::*;
use typst::foundations::Bytes;
use typst::layout::{Abs, Axes, Frame, FrameItem, GroupItem, Ratio, Size, Transform};
use typst::text::Lang;
use typst::visualize::{Curve, ImageKind};
use typst_layout::{Page, PagedDocument};

use crate::kit::{Figure, escape};

/// The frames of figures by what stands for them.
pub(super) struct Placed(HashMap<Bytes, Frame>);

impl Placed {
    /// The figures of a document, whose texts are in a language.
    pub(super) fn new(figures: &[Figure], lang: Lang) -> Self {
        let frame = |figure: &Figure| (stand_in(figure), figure.frame(lang));
        Self(figures.par_iter().map(frame).collect())
    }

    /// The pages with the figures in place.
    pub(super) fn in_pages(&self, mut document: PagedDocument) -> PagedDocument {
        let pages = document.pages().iter().map(|page| Page {
            frame: self.filled(page.frame.clone()),
            ..page.clone()
        });
        let pages = pages.collect();
        PagedDocument::new(pages, std::mem::take(document.info_mut()))
    }

    fn filled(&self, mut frame: Frame) -> Frame {
        if self.waits(&frame) {
            frame.retain(|item| {
                self.fill(item);
                true
            });
        }
        frame
    }

    /// Whether a figure belongs into a frame: only then is the frame copied.
    fn waits(&self, frame: &Frame) -> bool {
        frame.items().any(|(_, item)| match item {
            FrameItem::Group(group) => self.waits(&group.frame),
            item => self.of(item).is_some(),
        })
    }

    fn fill(&self, item: &mut FrameItem) {
        if let FrameItem::Group(group) = item {
            group.frame = self.filled(std::mem::take(&mut group.frame));
        } else if let Some((frame, size)) = self.of(item) {
            let mut group = GroupItem::new(frame.clone());
            group.transform = scaled(frame.size(), size);
            // as a picture ends at its edges
            group.clip = Some(Curve::rect(frame.size()));
            *item = FrameItem::Group(group);
        }
    }

    /// The figure for which an item stands, and its size on the page.
    fn of(&self, item: &FrameItem) -> Option<(&Frame, Size)> {
        let FrameItem::Image(image, size, _) = item else {
            return None;
        };
        let ImageKind::Svg(svg) = image.kind() else {
            return None;
        };
        Some((self.0.get(svg.data())?, *size))
    }
}

fn scaled(from: Size, to: Size) -> Transform {
    let ratio = |to: Abs, from: Abs| Ratio::new(to / from);
    let Axes { x, y } = to.zip_map(from, ratio);
    Transform::scale(x, y)
}

/// The SVG that stands for a figure: of its size, with its name and nothing drawn.
pub(super) fn stand_in(figure: &Figure) -> Bytes {
    let (width, height) = (figure.drawing.width, figure.drawing.height);
    let name = escape(&figure.name);
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}pt\" height=\"{height}pt\"><title>{name}</title></svg>"
    );
    Bytes::from_string(svg)
}
