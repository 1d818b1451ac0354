//! Every conversion factor of the program, in one place.
//!
//! Inside the program all quantities are SI; names carry the unit (`clearance_m`,
//! `frequency_hz`). Conversions happen once, where a file is read.

/// Standard gravity, m/s² per g (exact by definition, CGPM 1901).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// The physical dimension of a quantity, as far as the program has to tell one from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Dimension {
    /// Length, SI unit m.
    Length,
    /// Velocity, SI unit m/s.
    Velocity,
    /// Acceleration, SI unit m/s².
    Acceleration,
    /// Force, SI unit N.
    Force,
    /// Electric potential, SI unit V.
    Voltage,
    /// Frequency in cycles, SI unit Hz.
    Frequency,
    /// Time, SI unit s.
    Time,
    /// Mass, SI unit kg.
    Mass,
    /// Angle, SI unit rad.
    Angle,
    /// A plain number.
    Number,
}

impl Dimension {
    /// The SI unit's symbol.
    pub fn si_symbol(self) -> &'static str {
        match self {
            Self::Length => "m",
            Self::Velocity => "m/s",
            Self::Acceleration => "m/s²",
            Self::Force => "N",
            Self::Voltage => "V",
            Self::Frequency => "Hz",
            Self::Time => "s",
            Self::Mass => "kg",
            Self::Angle => "rad",
            Self::Number => "1",
        }
    }
}

/// A unit as a file or campaign.toml spells it: its dimension and the factor to SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// What the unit measures.
    pub dimension: Dimension,
    /// Multiply a value in this unit by this to have it in SI.
    pub to_si: f64,
}

const UNITS: &[(&str, Dimension, f64)] = &[
    ("m", Dimension::Length, 1.0),
    ("cm", Dimension::Length, 1e-2),
    ("mm", Dimension::Length, 1e-3),
    ("um", Dimension::Length, 1e-6),
    ("µm", Dimension::Length, 1e-6),
    ("μm", Dimension::Length, 1e-6),
    ("nm", Dimension::Length, 1e-9),
    ("in", Dimension::Length, 0.0254),
    ("m/s", Dimension::Velocity, 1.0),
    ("cm/s", Dimension::Velocity, 1e-2),
    ("mm/s", Dimension::Velocity, 1e-3),
    ("um/s", Dimension::Velocity, 1e-6),
    ("µm/s", Dimension::Velocity, 1e-6),
    ("in/s", Dimension::Velocity, 0.0254),
    ("m/s2", Dimension::Acceleration, 1.0),
    ("m/s^2", Dimension::Acceleration, 1.0),
    ("m/s²", Dimension::Acceleration, 1.0),
    ("mm/s2", Dimension::Acceleration, 1e-3),
    ("mm/s^2", Dimension::Acceleration, 1e-3),
    ("mm/s²", Dimension::Acceleration, 1e-3),
    ("g", Dimension::Acceleration, STANDARD_GRAVITY_M_S2),
    ("gn", Dimension::Acceleration, STANDARD_GRAVITY_M_S2),
    ("N", Dimension::Force, 1.0),
    ("mN", Dimension::Force, 1e-3),
    ("kN", Dimension::Force, 1e3),
    ("Newtons", Dimension::Force, 1.0),
    ("lbf", Dimension::Force, 4.448_221_615_260_5),
    ("V", Dimension::Voltage, 1.0),
    ("mV", Dimension::Voltage, 1e-3),
    ("µV", Dimension::Voltage, 1e-6),
    ("uV", Dimension::Voltage, 1e-6),
    ("Hz", Dimension::Frequency, 1.0),
    ("kHz", Dimension::Frequency, 1e3),
    ("rad/s", Dimension::Frequency, 1.0 / std::f64::consts::TAU),
    ("rpm", Dimension::Frequency, 1.0 / 60.0),
    ("s", Dimension::Time, 1.0),
    ("ms", Dimension::Time, 1e-3),
    ("us", Dimension::Time, 1e-6),
    ("µs", Dimension::Time, 1e-6),
    ("min", Dimension::Time, 60.0),
    ("kg", Dimension::Mass, 1.0),
    ("rad", Dimension::Angle, 1.0),
    ("deg", Dimension::Angle, std::f64::consts::PI / 180.0),
    ("°", Dimension::Angle, std::f64::consts::PI / 180.0),
    ("1", Dimension::Number, 1.0),
    ("%", Dimension::Number, 1e-2),
];

/// Look a unit up by the symbol that a file or campaign.toml gives; surrounding blanks are
/// ignored, letters keep their case (`mN` is not `MN`). `None`: the unit is not known.
pub fn parse_unit(symbol: &str) -> Option<Unit> {
    let symbol = symbol.trim();
    UNITS
        .iter()
        .find(|(name, _, _)| *name == symbol)
        .map(|&(_, dimension, to_si)| Unit { dimension, to_si })
}

/// The symbols of all units of a dimension, for messages that name the remedy.
pub fn symbols_of(dimension: Dimension) -> Vec<&'static str> {
    UNITS
        .iter()
        .filter(|(_, d, _)| *d == dimension)
        .map(|(s, _, _)| *s)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_units_have_their_si_factors() {
        assert_eq!(parse_unit(" mm ").unwrap().to_si, 1e-3);
        assert_eq!(parse_unit("g").unwrap().to_si, 9.80665);
        let hz = parse_unit("rad/s").unwrap();
        assert!((hz.to_si * std::f64::consts::TAU - 1.0).abs() < 1e-15);
        assert!(parse_unit("furlong").is_none());
    }
}
