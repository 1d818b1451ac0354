//! The unit in which a figure prints a quantity: SI, with the prefix that suits its size.

use labfiles::units::Dimension;

/// A unit for printing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PrintUnit {
    /// Multiply an SI value by this.
    pub factor: f64,
    /// The symbol.
    pub symbol: &'static str,
}

const fn unit(factor: f64, symbol: &'static str) -> PrintUnit {
    PrintUnit { factor, symbol }
}

/// The unit for a quantity whose greatest magnitude is known (SI).
pub(crate) fn print_unit(dimension: Dimension, peak: f64) -> PrintUnit {
    match dimension {
        _ if peak == 0.0 => unit(1.0, dimension.si_symbol()),
        Dimension::Length if peak < 2e-4 => unit(1e6, "µm"),
        Dimension::Length if peak < 1.0 => unit(1e3, "mm"),
        Dimension::Velocity if peak < 0.5 => unit(1e3, "mm/s"),
        Dimension::Voltage if peak < 0.5 => unit(1e3, "mV"),
        Dimension::Force if peak < 0.5 => unit(1e3, "mN"),
        Dimension::Time if peak < 0.5 => unit(1e3, "ms"),
        other => unit(1.0, other.si_symbol()),
    }
}
