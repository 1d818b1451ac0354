//! Where pages begin, so that none is more than half empty: the document is set, what its pages hold is
//! read from them, and where one is short it is set again with breaks in other places.

use std::collections::BTreeSet;

use serde::Serialize;
use typst::foundations::{Label, Packed, Value};
use typst::introspection::{MetadataElem, Tag};
use typst::layout::{Abs, Frame, FrameItem, Point};
use typst_layout::PagedDocument;

use super::model::Section;

/// A part of the document before which a page can begin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub(crate) struct Part {
    /// The section's place.
    pub section: usize,
    /// The block's place in it; 0 with the section's heading.
    pub block: usize,
    /// The row's place in the block: of a table, or of figures.
    pub row: usize,
}

impl Part {
    /// How much of a unit a break before it cuts: nothing before a section, most before a row.
    fn cuts(self) -> u8 {
        match self {
            Self { row: 1.., .. } => 2,
            Self { block: 1.., .. } => 1,
            Self { .. } => 0,
        }
    }
}

/// The parts that begin a page.
pub(crate) type Breaks = BTreeSet<Part>;

/// How the pages are set, beside what is on them.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub(crate) struct Layout {
    /// The parts that begin a page.
    pub breaks: Breaks,
    /// Whether lines and rows are closer to each other than usual.
    pub close: bool,
}

impl Layout {
    /// With the breaks that the sections ask for.
    pub(crate) fn of(sections: &[Section]) -> Self {
        let sections = sections.iter().enumerate().filter(|(_, s)| s.new_page);
        let part = |(section, _)| Part {
            section,
            block: 0,
            row: 0,
        };
        Self {
            breaks: sections.map(part).collect(),
            close: false,
        }
    }
}

/// What the template calls the mark of a part.
const MARK: &str = "part";
/// Height of a page's header with the margin beside it, as the template has them, millimetres.
const TOP_MM: f64 = 20.0;
/// The same of its footer.
const BOTTOM_MM: f64 = 19.0;
/// The share of a page that is to be filled: half, and room for errors of this account.
const ENOUGH: f64 = 0.53;
/// Of a page, where the first part of it begins at the latest.
const AT_THE_TOP: f64 = 0.03;

/// What a page holds, in shares of the room between header and footer.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SetPage {
    /// Down to where.
    filled: f64,
    /// The parts that begin on it, and where.
    parts: Vec<(Part, f64)>,
}

impl SetPage {
    /// The pages of a document.
    pub(super) fn all(document: &PagedDocument) -> Vec<Self> {
        let pages = document.pages().iter().map(|p| Self::of(&p.frame));
        pages.collect()
    }

    fn of(frame: &Frame) -> Self {
        let (top, end) = (Abs::mm(TOP_MM), frame.height() - Abs::mm(BOTTOM_MM));
        let share = |y: Abs| (y - top) / (end - top);
        let (mut lowest, mut parts) = (Abs::zero(), Vec::new());
        each_item(frame, Point::zero(), &mut |at, item| {
            if let Some(part) = part(item) {
                parts.push((part, share(at.y)));
            }
            let bottom = at.y + reach(item);
            if bottom <= end + Abs::pt(1.0) {
                lowest.set_max(bottom);
            }
        });
        let filled = share(lowest).max(0.0);
        Self { filled, parts }
    }

    /// What it lacks of the share that is to be filled.
    fn lacks(&self) -> f64 {
        (ENOUGH - self.filled).max(0.0)
    }
}

fn each_item(frame: &Frame, origin: Point, see: &mut impl FnMut(Point, &FrameItem)) {
    for (at, item) in frame.items() {
        let at = origin + *at;
        match item {
            FrameItem::Group(group) => {
                let moved = Point::new(group.transform.tx, group.transform.ty);
                each_item(&group.frame, at + moved, see);
            }
            item => see(at, item),
        }
    }
}

/// How far an item reaches below where it is.
fn reach(item: &FrameItem) -> Abs {
    match item {
        FrameItem::Shape(shape, _) => shape.bbox(false).max.y,
        FrameItem::Image(_, size, _) => size.y,
        _ => Abs::zero(),
    }
}

/// The part whose mark an item is.
fn part(item: &FrameItem) -> Option<Part> {
    let FrameItem::Tag(Tag::Start(content, _)) = item else {
        return None;
    };
    let mark: &Packed<MetadataElem> = content.to_packed()?;
    let Value::Dict(value) = &mark.value else {
        return None;
    };
    let place = |key: &str| match value.get(key) {
        Ok(Value::Int(i)) => usize::try_from(*i).ok(),
        _ => None,
    };
    let is_mark = |label: Label| label.resolve().as_str() == MARK;
    content.label().filter(|label| is_mark(*label))?;
    Some(Part {
        section: place("section")?,
        block: place("block")?,
        row: place("row")?,
    })
}

/// What all pages lack; the page of a document that has only one lacks nothing.
pub(super) fn lack(pages: &[SetPage]) -> f64 {
    match pages {
        [_] => 0.0,
        pages => pages.iter().map(SetPage::lacks).sum(),
    }
}

/// Breaks that may leave less, where the last page that is short can be filled: by what follows, if it only
/// begins a page because it was asked to, else by what ends the page before.
pub(super) fn improved(pages: &[SetPage], breaks: &Breaks) -> Option<Breaks> {
    let short = pages.iter().rposition(|page| page.lacks() > 0.0)?;
    let mut breaks = breaks.clone();
    let first = |page: &SetPage| page.parts.first().map(|(part, _)| *part);
    if let Some(next) = pages.get(short + 1).and_then(first)
        && breaks.remove(&next)
    {
        return Some(breaks);
    }
    let before = short.checked_sub(1)?;
    let part = taken_from(&pages[before], &pages[short], before > 0)?;
    breaks.insert(part).then_some(breaks)
}

/// The part from which on the end of a page is better on the next one, which is short.
fn taken_from(before: &SetPage, short: &SetPage, has_one_before: bool) -> Option<Part> {
    // what a page gives it may get from the one before it
    let weight = if has_one_before { 0.5 } else { 1.0 };
    let left = |at: f64| {
        let filled = short.filled + before.filled - at;
        let of_before = weight * (ENOUGH - at).max(0.0);
        (filled <= 1.0).then(|| of_before.max((ENOUGH - filled).max(0.0)))
    };
    let parts = before.parts.iter().filter(|(_, at)| *at > AT_THE_TOP);
    let choices = parts.filter_map(|(part, at)| Some((*part, *at, left(*at)?)));
    let better = choices.filter(|(_, _, left)| *left < short.lacks());
    let best = better.min_by(|a, b| {
        let whole_first = || a.0.cuts().cmp(&b.0.cuts());
        let later_first = || b.1.total_cmp(&a.1);
        a.2.total_cmp(&b.2)
            .then_with(whole_first)
            .then_with(later_first)
    });
    best.map(|(part, _, _)| part)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(section: usize, block: usize) -> Part {
        let row = 0;
        Part {
            section,
            block,
            row,
        }
    }

    fn page(filled: f64, parts: &[(Part, f64)]) -> SetPage {
        let parts = parts.to_vec();
        SetPage { filled, parts }
    }

    #[test]
    fn a_short_last_page_takes_from_the_one_before() {
        let first = [(part(0, 0), 0.3), (part(1, 0), 0.6), (part(1, 1), 0.7)];
        let pages = [page(0.95, &first), page(0.3, &[])];
        let found = improved(&pages, &Breaks::new());
        assert_eq!(found, Some([part(1, 0)].into()));
    }

    #[test]
    fn a_page_that_gives_too_much_is_filled_from_the_one_before_it() {
        let pages = [
            page(0.95, &[(part(0, 0), 0.6)]),
            page(0.95, &[(part(1, 0), 0.4)]),
            page(0.1, &[]),
        ];
        let found = improved(&pages, &Breaks::new());
        assert_eq!(found, Some([part(1, 0)].into()));
        let found = improved(&pages[..2], &Breaks::new());
        assert_eq!(found, None);
    }

    #[test]
    fn a_break_that_leaves_a_page_short_is_taken_back() {
        let begin = part(2, 0);
        let pages = [page(0.9, &[]), page(0.3, &[]), page(0.9, &[(begin, 0.0)])];
        assert_eq!(improved(&pages, &[begin].into()), Some(Breaks::new()));
    }

    #[test]
    fn one_page_may_be_short() {
        assert_eq!(lack(&[page(0.2, &[])]), 0.0);
        assert_eq!(improved(&[page(0.2, &[])], &Breaks::new()), None);
    }
}
