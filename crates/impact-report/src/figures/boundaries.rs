//! How the boundaries of motion are named and drawn.

use crate::kit::canvas::Stroke;
use crate::kit::look;
use crate::phrase::{Phrase, Text};
use impact_records::motion::BoundaryKind;

/// The boundaries in the order in which brackets are stacked.
pub(crate) const ALL: [BoundaryKind; 4] = [
    BoundaryKind::PeriodDoubling,
    BoundaryKind::SaddleNode,
    BoundaryKind::Grazing,
    BoundaryKind::Other,
];

/// The name in the figures' data.
pub(crate) fn name(kind: BoundaryKind) -> &'static str {
    match kind {
        BoundaryKind::Other => "edge",
        kind => kind.name(),
    }
}

/// The paper's symbol, with markup.
pub(crate) fn symbol(kind: BoundaryKind) -> Text {
    match kind {
        BoundaryKind::PeriodDoubling => "$s_1$".into(),
        BoundaryKind::SaddleNode => "$s_2$".into(),
        BoundaryKind::Grazing => "$ρ$′".into(),
        BoundaryKind::Other => Phrase::Edge.into(),
    }
}

/// How a simulated boundary is drawn.
pub(crate) fn stroke(kind: BoundaryKind, width: f64) -> Stroke {
    match kind {
        BoundaryKind::SaddleNode => Stroke::solid(look::INK, width),
        BoundaryKind::PeriodDoubling => Stroke::dashed(look::INK, width, &[5.0, 2.2]),
        BoundaryKind::Grazing => Stroke::dashed(look::INK, width, &[1.3, 1.7]),
        BoundaryKind::Other => Stroke::dashed(look::INK, 0.7 * width, &[6.0, 2.0, 1.3, 2.0]),
    }
}
