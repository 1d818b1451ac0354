//! What a finding is caused by.

use crate::method::Method;

/// The kinds of causes, each before those that it explains.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// A channel shows something else than the motion at its time: late, filtered, mixed with another signal.
    Channel,
    /// The records are not of one rig in one state.
    Change,
    /// Many records begin before their motions have settled, which takes them for steady ones.
    Unsettled,
    /// The contact has no single coefficient of restitution.
    Contact,
    /// A stated number is wrong, and the fit carries its error.
    Statement,
    /// An effect beyond the model that the fit carries.
    Effect,
    /// A fit is worse than its noise, or methods differ.
    Symptom,
}

impl Cause {
    /// Whether the model has no place for it, so that it bends the fits that it reaches.
    pub fn bends(self) -> bool {
        matches!(self, Self::Channel | Self::Change | Self::Contact)
    }

    /// Whether the data of a method can be bent by it.
    pub fn reaches(self, method: Method) -> bool {
        match self {
            Self::Channel | Self::Change => true,
            Self::Contact => method.observes_impacts(),
            Self::Unsettled => method.observes_settled_motion(),
            Self::Statement | Self::Effect | Self::Symptom => false,
        }
    }
}
