//! The report's type, colours and marks, for pages that look like it.

use super::kit::canvas::Colour;
pub use super::kit::fonts::{Face as FontFace, face_bytes as font};
use super::kit::marks;
use impact_records::motion::Motion;
use serde::Serialize;

/// How a motion is shown.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct MotionStyle {
    /// Its label.
    pub label: String,
    /// Shape of its marks, by name.
    pub shape: String,
    /// Colour of its marks, `#rrggbb`.
    pub colour: String,
    /// Tint of its region, `#rrggbb`.
    pub tint: String,
    /// Its place in legends.
    pub order: (u32, u32, u32, bool),
}

impl MotionStyle {
    /// Of a motion.
    pub fn of(motion: &Motion) -> Self {
        let look = marks::of(motion);
        Self {
            label: motion.label(),
            shape: format!("{:?}", look.shape).to_lowercase(),
            colour: hexadecimal(look.colour),
            tint: hexadecimal(look.tint),
            order: marks::order(motion),
        }
    }
}

fn hexadecimal(c: Colour) -> String {
    format!("#{:02x}{:02x}{:02x}", c.0, c.1, c.2)
}
