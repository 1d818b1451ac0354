//! A finished figure.

use typst::layout::Frame;
use typst::text::Lang;

use super::canvas::{Canvas, Spot};
use super::drawing::Drawing;

/// A finished figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Stem of its file name.
    pub name: String,
    /// What it shows, with markup.
    pub title: String,
    /// The drawing.
    pub(crate) drawing: Drawing,
    /// Its data; empty where another figure has them.
    pub csv: String,
    /// Points with a text that is shown on hovering.
    pub(crate) spots: Vec<Spot>,
    /// Texts that reach beyond the drawing's edges.
    pub overfull: Vec<String>,
}

/// Most points with a text in one figure: more would only enlarge the page.
const MOST_SPOTS: usize = 2500;

impl Figure {
    /// A figure from its drawing.
    pub fn new(name: impl Into<String>, title: &str, mut canvas: Canvas, csv: String) -> Self {
        let overfull = canvas.overfull();
        let spots = fewer(std::mem::take(&mut canvas.spots));
        Self {
            name: name.into(),
            title: title.to_owned(),
            drawing: canvas.finish(),
            csv,
            spots,
            overfull,
        }
    }

    /// The drawing as SVG, for pages and for drawing programs.
    pub fn svg(&self) -> String {
        super::svg::svg(&self.drawing, &self.title)
    }

    /// The drawing as part of a page of typst's, its texts marked as of a language.
    pub(crate) fn frame(&self, lang: Lang) -> Frame {
        super::frame::frame(&self.drawing, lang)
    }
}

/// Points as many and as fine as a page needs.
fn fewer(spots: Vec<Spot>) -> Vec<Spot> {
    let stride = spots.len().div_ceil(MOST_SPOTS).max(1);
    // a hundredth of a point is finer than any screen shows
    let coarse = |v: f64| (v * 100.0).round() / 100.0;
    let of = |spot: Spot| Spot {
        x: coarse(spot.x),
        y: coarse(spot.y),
        text: spot.text,
    };
    spots.into_iter().step_by(stride).map(of).collect()
}

/// Name of the i-th figure of a kind.
pub fn numbered(kind: &str, index: usize) -> String {
    format!("{kind}_{}", index + 1)
}
