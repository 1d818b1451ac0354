//! A finished figure.

use super::canvas::Canvas;

/// A finished figure.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Figure {
    /// Stem of its file name.
    pub name: String,
    /// What it shows, with markup.
    pub title: String,
    /// The drawing.
    pub svg: String,
    /// Width, points.
    pub width: f64,
    /// Height, points.
    pub height: f64,
    /// Its data.
    pub csv: String,
    /// Points with a text that is shown on hovering.
    pub spots: Vec<Spot>,
    /// Texts that reach beyond the drawing's edges.
    pub overfull: Vec<String>,
}

/// A point of a figure with a text.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub(crate) struct Spot {
    /// From the left, points.
    pub x: f64,
    /// From the top, points.
    pub y: f64,
    /// The text; line feeds separate its lines.
    pub text: String,
}

/// Most points with a text in one figure: more would only enlarge the page.
const MOST_SPOTS: usize = 2500;

impl Figure {
    /// A figure from its drawing.
    pub(crate) fn new(name: impl Into<String>, title: &str, canvas: Canvas, csv: String) -> Self {
        let (width, height) = (canvas.width, canvas.height);
        let overfull = canvas.overfull();
        let svg = canvas.into_svg(title);
        let (name, title) = (name.into(), title.to_owned());
        Self {
            name,
            title,
            svg,
            width,
            height,
            csv,
            spots: Vec::new(),
            overfull,
        }
    }

    /// With points that have a text.
    pub(crate) fn with_spots(self, mut spots: Vec<Spot>) -> Self {
        let stride = spots.len().div_ceil(MOST_SPOTS).max(1);
        let mut index = 0;
        spots.retain(|_| {
            index += 1;
            (index - 1) % stride == 0
        });
        // a hundredth of a point is finer than any screen shows
        let coarse = |v: f64| (v * 100.0).round() / 100.0;
        for spot in &mut spots {
            (spot.x, spot.y) = (coarse(spot.x), coarse(spot.y));
        }
        Self { spots, ..self }
    }
}

/// Name of the i-th figure of a kind.
pub(crate) fn numbered(kind: &str, index: usize) -> String {
    format!("{kind}_{}", index + 1)
}
