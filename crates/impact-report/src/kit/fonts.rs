//! The embedded fonts, one set for figures and document, and the widths of their glyphs.

use std::sync::OnceLock;

use typst::layout::Abs;
use typst::text::{Font, FontInfo, FontInstance, FontStyle, FontVariations, FontWeight};

/// Family of all text in figures and document.
pub(crate) const FAMILY: &str = "Libertinus Serif";

/// A face of the family.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Face {
    /// Upright.
    Regular,
    /// Slanted: symbols of quantities.
    Italic,
    /// Bold.
    Bold,
}

/// All embedded fonts with what is known of them, read once.
pub(crate) fn embedded() -> &'static [(Font, FontInfo)] {
    static FONTS: OnceLock<Vec<(Font, FontInfo)>> = OnceLock::new();
    FONTS.get_or_init(|| typst_kit::fonts::embedded().collect())
}

/// The font file of a face, for pages that carry their own fonts.
pub fn face_bytes(face: Face) -> Option<&'static [u8]> {
    find(face).map(|(font, _)| font.data().as_slice())
}

/// Advance width of a text, in the unit of the size.
pub(crate) fn width(text: &str, face: Face, size: f64) -> f64 {
    text.chars().map(|c| advance_em(c, face)).sum::<f64>() * size
}

/// Advance of a character in its face, in em; half an em where the face lacks it.
fn advance_em(c: char, face: Face) -> f64 {
    /// Advance of a character that the face lacks, em.
    const UNKNOWN: f64 = 0.5;
    let Some(font) = instance(face) else {
        return UNKNOWN;
    };
    let Some(glyph) = font.ttf().glyph_index(c) else {
        return UNKNOWN;
    };
    font.x_advance(glyph.0).map_or(UNKNOWN, |em| em.get())
}

fn instance(face: Face) -> Option<&'static FontInstance> {
    static FACES: OnceLock<[Option<FontInstance>; 3]> = OnceLock::new();
    let faces = FACES.get_or_init(|| [Face::Regular, Face::Italic, Face::Bold].map(instantiate));
    faces[face as usize].as_ref()
}

fn instantiate(face: Face) -> Option<FontInstance> {
    find(face).map(usable)
}

fn usable((font, info): &(Font, FontInfo)) -> FontInstance {
    font.clone()
        .instantiate(info.variant, Abs::pt(10.0), &FontVariations::default())
}

/// A text in pieces, each with a font: that of the face, and for characters that it lacks another
/// of the embedded fonts that has them. Nothing where no font is embedded.
pub(super) fn runs(text: &str, face: Face) -> Vec<(FontInstance, &str)> {
    let Some(own) = instance(face) else {
        return Vec::new();
    };
    let font_of = |c: char| {
        let lacks = own.ttf().glyph_index(c).is_none();
        let has = |(_, info): &&(Font, FontInfo)| info.coverage.contains(c.into());
        lacks
            .then(|| embedded().iter().position(|f| has(&f)))
            .flatten()
    };
    let mut pieces: Vec<(Option<usize>, usize)> = Vec::new();
    for (start, c) in text.char_indices() {
        let font = font_of(c);
        if pieces.last().is_none_or(|(last, _)| *last != font) {
            pieces.push((font, start));
        }
    }
    let ends = pieces.iter().skip(1).map(|(_, start)| *start);
    let ends: Vec<usize> = ends.chain([text.len()]).collect();
    let font = |index: Option<usize>| index.map_or_else(|| own.clone(), |i| usable(&embedded()[i]));
    let each = pieces.into_iter().zip(ends);
    each.map(|((index, start), end)| (font(index), &text[start..end]))
        .collect()
}

fn find(face: Face) -> Option<&'static (Font, FontInfo)> {
    let (style, weight) = match face {
        Face::Regular => (FontStyle::Normal, FontWeight::REGULAR),
        Face::Italic => (FontStyle::Italic, FontWeight::REGULAR),
        Face::Bold => (FontStyle::Normal, FontWeight::BOLD),
    };
    embedded()
        .iter()
        .find(|(_, i)| i.family == FAMILY && i.variant.style == style && i.variant.weight == weight)
}
