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
    let (font, info) = find(face)?;
    Some(
        font.clone()
            .instantiate(info.variant, Abs::pt(10.0), &FontVariations::default()),
    )
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
