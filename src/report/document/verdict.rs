//! A verdict as a name and as a headline.

use crate::identify::VerdictKind;

/// Name of a verdict in the document.
pub(super) fn verdict_name(kind: VerdictKind) -> &'static str {
    match kind {
        VerdictKind::Identified => "identified",
        VerdictKind::Weak => "weak",
        VerdictKind::NotIdentifiable => "not_identifiable",
        VerdictKind::DoesNotFit => "does_not_fit",
    }
}

/// A verdict as a headline, a phrase; of a rig where records of one were measured.
pub(super) fn headline(kind: VerdictKind, of_a_rig: bool) -> &'static str {
    match (kind, of_a_rig) {
        (VerdictKind::Identified, true) => "Identified: the model fits the rig",
        (VerdictKind::Identified, false) => "Identified: the model fits",
        (VerdictKind::Weak, _) => "Identified in part",
        (VerdictKind::NotIdentifiable, _) => "Not identifiable from these data",
        (VerdictKind::DoesNotFit, true) => "The model does not fit the rig",
        (VerdictKind::DoesNotFit, false) => "The model does not fit",
    }
}
