//! How the boundaries of motion are named and drawn.

use crate::kit::canvas::Stroke;
use crate::kit::look;
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

/// How a simulated boundary is drawn.
pub(crate) fn stroke(kind: BoundaryKind, width: f64) -> Stroke {
    match kind {
        BoundaryKind::SaddleNode => Stroke::solid(look::INK, width),
        BoundaryKind::PeriodDoubling => Stroke::dashed(look::INK, width, &[5.0, 2.2]),
        BoundaryKind::Grazing => Stroke::dashed(look::INK, width, &[1.3, 1.7]),
        BoundaryKind::Other => Stroke::dashed(look::INK, 0.7 * width, &[6.0, 2.0, 1.3, 2.0]),
    }
}
