//! A verdict as a headline.

use crate::phrase::Phrase;
use impact_fit::VerdictKind;

/// A verdict as a headline, a phrase; of a rig where records of one were measured.
pub(super) fn headline(kind: VerdictKind, of_a_rig: bool) -> Phrase {
    match (kind, of_a_rig) {
        (VerdictKind::Identified, true) => Phrase::IdentifiedRig,
        (VerdictKind::Identified, false) => Phrase::Identified,
        (VerdictKind::Weak, _) => Phrase::IdentifiedInPart,
        (VerdictKind::NotIdentifiable, _) => Phrase::NotIdentifiableTitle,
        (VerdictKind::DoesNotFit, true) => Phrase::RigDoesNotFit,
        (VerdictKind::DoesNotFit, false) => Phrase::DoesNotFit,
    }
}
