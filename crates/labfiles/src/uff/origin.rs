//! Where a channel's samples come from.

/// What a channel is of its function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// The abscissa.
    Abscissa,
    /// The ordinate.
    Ordinate,
}

/// Where a channel's samples come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Origin {
    /// Index into [`super::sets::Sets::functions`].
    pub function: usize,
    /// Abscissa or ordinate.
    pub side: Side,
}
