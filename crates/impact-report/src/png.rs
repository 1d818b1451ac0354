//! Figures as PNG, for pages that cannot show SVG.

use impact_records::signal::whole;
use std::sync::{Arc, OnceLock};

use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};

use super::error::ReportError;
use super::kit::{Figure, fonts};

/// Dots per inch of the pictures.
const RESOLUTION_DPI: f32 = 200.0;
/// SVG user units in an inch, as the renderer counts points.
const UNITS_PER_INCH: f32 = 96.0;

/// A figure as PNG on white.
pub(super) fn png(figure: &Figure) -> Result<Vec<u8>, ReportError> {
    let failed = |why: String| ReportError::Picture {
        name: figure.name.clone(),
        why,
    };
    let options = Options {
        fontdb: fonts_of_figures(),
        ..Options::default()
    };
    let tree = Tree::from_str(&figure.svg(), &options).map_err(|e| failed(e.to_string()))?;
    let scale = RESOLUTION_DPI / UNITS_PER_INCH;
    let size = tree.size();
    let (width, height) = (
        (size.width() * scale).ceil(),
        (size.height() * scale).ceil(),
    );
    let mut pixels = Pixmap::new(whole::count(width.into()), whole::count(height.into()))
        .ok_or_else(|| failed("the picture has no size".into()))?;
    pixels.fill(Color::WHITE);
    resvg::render(
        &tree,
        Transform::from_scale(scale, scale),
        &mut pixels.as_mut(),
    );
    pixels.encode_png().map_err(|e| failed(e.to_string()))
}

fn fonts_of_figures() -> Arc<Database> {
    static FONTS: OnceLock<Arc<Database>> = OnceLock::new();
    let load = || {
        let mut database = Database::new();
        for face in [fonts::Face::Regular, fonts::Face::Italic, fonts::Face::Bold] {
            if let Some(bytes) = fonts::face_bytes(face) {
                database.load_font_data(bytes.to_vec());
            }
        }
        Arc::new(database)
    };
    FONTS.get_or_init(load).clone()
}
