//! Units of measurement and their factors to SI, and quantities written as text.
//!
//! ```
//! use labfiles::units::{Dimension, parse_quantity_of};
//! assert_eq!(parse_quantity_of("1.5 mm", Dimension::Length), Ok(1.5e-3));
//! assert!(parse_quantity_of("1.5 mm", Dimension::Time).is_err());
//! ```

/// Standard gravity, m/s² per g (exact by definition, CGPM 1901).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// The physical dimension of a quantity.
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
    /// The dimension's name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::Velocity => "velocity",
            Self::Acceleration => "acceleration",
            Self::Force => "force",
            Self::Voltage => "voltage",
            Self::Frequency => "frequency",
            Self::Time => "time",
            Self::Mass => "mass",
            Self::Angle => "angle",
            Self::Number => "plain number",
        }
    }

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

/// A unit: its dimension and its factor to SI.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Unit {
    /// What the unit measures.
    pub dimension: Dimension,
    /// A value in this unit times this is the value in SI.
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
    ("Newton", Dimension::Force, 1.0),
    ("Newtons", Dimension::Force, 1.0),
    ("lbf", Dimension::Force, 4.448_221_615_260_5),
    ("V", Dimension::Voltage, 1.0),
    ("Volt", Dimension::Voltage, 1.0),
    ("Volts", Dimension::Voltage, 1.0),
    ("mV", Dimension::Voltage, 1e-3),
    ("µV", Dimension::Voltage, 1e-6),
    ("uV", Dimension::Voltage, 1e-6),
    ("Hz", Dimension::Frequency, 1.0),
    ("mHz", Dimension::Frequency, 1e-3),
    ("kHz", Dimension::Frequency, 1e3),
    ("rad/s", Dimension::Frequency, 1.0 / std::f64::consts::TAU),
    ("rpm", Dimension::Frequency, 1.0 / 60.0),
    ("s", Dimension::Time, 1.0),
    ("ms", Dimension::Time, 1e-3),
    ("us", Dimension::Time, 1e-6),
    ("µs", Dimension::Time, 1e-6),
    ("min", Dimension::Time, 60.0),
    ("kg", Dimension::Mass, 1.0),
    ("gram", Dimension::Mass, 1e-3),
    ("rad", Dimension::Angle, 1.0),
    ("deg", Dimension::Angle, std::f64::consts::PI / 180.0),
    ("°", Dimension::Angle, std::f64::consts::PI / 180.0),
    ("1", Dimension::Number, 1.0),
    ("%", Dimension::Number, 1e-2),
];

/// The unit of a symbol; surrounding blanks are ignored, letters keep their case (`mN` is not
/// `MN`). `None`: the unit is not known.
///
/// ```
/// use labfiles::units::{Dimension, parse_unit};
/// let g = parse_unit("g").ok_or("unknown")?;
/// assert_eq!((g.dimension, g.to_si), (Dimension::Acceleration, 9.80665));
/// assert_eq!(parse_unit("furlong"), None);
/// # Ok::<(), &str>(())
/// ```
pub fn parse_unit(symbol: &str) -> Option<Unit> {
    let symbol = symbol.trim();
    UNITS
        .iter()
        .find(|(name, _, _)| *name == symbol)
        .map(|&(_, dimension, to_si)| Unit { dimension, to_si })
}

/// The symbol of a unit, the first if it has several; `None` for a factor that has none.
pub fn symbol_of(unit: Unit) -> Option<&'static str> {
    UNITS
        .iter()
        .find(|(_, dimension, to_si)| *dimension == unit.dimension && *to_si == unit.to_si)
        .map(|(symbol, _, _)| *symbol)
}

/// The symbols of all units of a dimension, for messages that name the remedy.
pub fn symbols_of(dimension: Dimension) -> Vec<&'static str> {
    UNITS
        .iter()
        .filter(|(_, d, _)| *d == dimension)
        .map(|(s, _, _)| *s)
        .collect()
}

/// A number with its unit, in SI.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Quantity {
    /// The value in the SI unit of its dimension.
    pub si: f64,
    /// What it measures.
    pub dimension: Dimension,
}

/// Why a text is not a quantity.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum QuantityError {
    /// It does not begin with a number.
    #[error("'{0}' does not begin with a number")]
    NoNumber(String),
    /// The number is written with a decimal comma.
    #[error("'{0}' is written with a comma")]
    Comma(String),
    /// The number is infinite or not a number.
    #[error("'{0}' is not a finite number")]
    NotFinite(String),
    /// The unit is not known.
    #[error("the unit '{0}' is not known")]
    UnknownUnit(String),
    /// It has another dimension than it must have.
    #[error("'{text}' is a {found}, where a {expected} is expected")]
    Dimension {
        /// The text.
        text: String,
        /// Dimension of the text's unit.
        found: &'static str,
        /// Dimension needed.
        expected: &'static str,
    },
    /// A scale of one unit alone.
    #[error("'{0}' is neither a plain factor nor one unit per another")]
    NoRatio(String),
}

/// Read a text such as `1.0 mm`, `12.6 Hz`, `0.5 %` or `7`; without a unit it is a plain number.
///
/// ```
/// use labfiles::units::{Dimension, parse_quantity};
/// let half = parse_quantity("0.5 %")?;
/// assert_eq!((half.si, half.dimension), (0.005, Dimension::Number));
/// let error = parse_quantity("1,5 mm").unwrap_err();
/// assert_eq!(error.to_string(), "'1,5 mm' is written with a comma");
/// # Ok::<(), labfiles::units::QuantityError>(())
/// ```
///
/// # Errors
/// [`QuantityError`] if the number or the unit cannot be read.
pub fn parse_quantity(text: &str) -> Result<Quantity, QuantityError> {
    let (number, symbol) = split_number(text)?;
    if symbol.is_empty() {
        return Ok(Quantity {
            si: number,
            dimension: Dimension::Number,
        });
    }
    let unit = parse_unit(symbol).ok_or_else(|| QuantityError::UnknownUnit(symbol.to_owned()))?;
    Ok(Quantity {
        si: number * unit.to_si,
        dimension: unit.dimension,
    })
}

/// Read a text as [`parse_quantity`] does and require its dimension; gives the value in SI.
///
/// # Errors
/// [`QuantityError`], among them [`QuantityError::Dimension`] if it measures something else.
pub fn parse_quantity_of(text: &str, dimension: Dimension) -> Result<f64, QuantityError> {
    let quantity = parse_quantity(text)?;
    if quantity.dimension == dimension {
        return Ok(quantity.si);
    }
    Err(QuantityError::Dimension {
        text: text.trim().to_owned(),
        found: quantity.dimension.name(),
        expected: dimension.name(),
    })
}

/// The number at the beginning of a text and what follows it.
fn split_number(text: &str) -> Result<(f64, &str), QuantityError> {
    let text = text.trim();
    let end = number_end(text.as_bytes());
    let (number, rest) = text.split_at(end);
    if rest.starts_with(',') {
        return Err(QuantityError::Comma(text.to_owned()));
    }
    let value: f64 = number
        .parse()
        .map_err(|_| QuantityError::NoNumber(text.to_owned()))?;
    if !value.is_finite() {
        return Err(QuantityError::NotFinite(text.to_owned()));
    }
    Ok((value, rest.trim()))
}

/// Length of the decimal number, with its exponent, at the beginning of a text.
fn number_end(text: &[u8]) -> usize {
    let digits = |from: usize| {
        from + text[from..]
            .iter()
            .take_while(|b| b.is_ascii_digit() || **b == b'.')
            .count()
    };
    let signed = |at: usize| at + usize::from(matches!(text.get(at), Some(b'+' | b'-')));
    let end = digits(signed(0));
    if matches!(text.get(end), Some(b'e' | b'E')) {
        let exponent = signed(end + 1);
        if digits(exponent) > exponent {
            return digits(exponent);
        }
    }
    end
}

/// How the numbers of a channel become a quantity.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// A plain factor: the numbers keep their unit.
    Factor(f64),
    /// A ratio of two units.
    Ratio {
        /// SI value of the numerator: number times unit.
        numerator: Quantity,
        /// The unit below.
        denominator: Unit,
    },
}

/// Read a scale: a plain factor (`0.5`), or one unit per another (`50 mm/s per V`,
/// `0.05 m/s/V`, or a sensor's sensitivity `100 mV/g`).
///
/// ```
/// use labfiles::units::{Dimension, parse_scale, parse_unit};
/// let volts = parse_unit("V").ok_or("unknown")?;
/// let scaled = parse_scale("100 mV/g")?.apply(volts).ok_or("another unit")?;
/// assert_eq!(scaled.dimension, Dimension::Acceleration);
/// assert!((scaled.to_si - 98.0665).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`QuantityError`] if the number or a unit cannot be read, among them
/// [`QuantityError::NoRatio`] if only one unit is given.
pub fn parse_scale(text: &str) -> Result<Scale, QuantityError> {
    let (number, symbols) = split_number(text)?;
    if symbols.is_empty() {
        return Ok(Scale::Factor(number));
    }
    let (above, below) = split_ratio(symbols)?;
    let numerator = Quantity {
        si: number * above.to_si,
        dimension: above.dimension,
    };
    Ok(Scale::Ratio {
        numerator,
        denominator: below,
    })
}

fn split_ratio(symbols: &str) -> Result<(Unit, Unit), QuantityError> {
    let unknown = |s: &str| QuantityError::UnknownUnit(s.trim().to_owned());
    let bare = |s: &str| parse_unit(s.trim().trim_start_matches('(').trim_end_matches(')'));
    if let Some((above, below)) = symbols.split_once(" per ") {
        let above = bare(above).ok_or_else(|| unknown(above))?;
        return Ok((above, bare(below).ok_or_else(|| unknown(below))?));
    }
    if parse_unit(symbols).is_some() {
        return Err(QuantityError::NoRatio(symbols.to_owned()));
    }
    let cuts = symbols.rmatch_indices('/');
    let pairs = cuts.map(|(at, _)| (bare(&symbols[..at]), bare(&symbols[at + 1..])));
    pairs
        .into_iter()
        .find_map(|(above, below)| above.zip(below))
        .ok_or_else(|| unknown(symbols))
}

impl Scale {
    /// Factor to SI and dimension of numbers in the file's `unit` after scaling; `None` if the
    /// scale does not start from that unit.
    pub fn apply(self, unit: Unit) -> Option<Unit> {
        match self {
            Self::Factor(factor) => Some(Unit {
                to_si: unit.to_si * factor,
                ..unit
            }),
            Self::Ratio {
                numerator,
                denominator,
            } => {
                let per_si = numerator.si / denominator.to_si;
                if denominator.dimension == unit.dimension {
                    let to_si = unit.to_si * per_si;
                    Some(Unit {
                        dimension: numerator.dimension,
                        to_si,
                    })
                } else if numerator.dimension == unit.dimension {
                    let to_si = unit.to_si / per_si;
                    Some(Unit {
                        dimension: denominator.dimension,
                        to_si,
                    })
                } else {
                    None
                }
            }
        }
    }
}

/// Split the unit off a column's or attribute's name: `clearance [mm]`, `clearance (mm)` or
/// `clearance_mm` (after an underscore `m_s` means m/s, `m_s2` m/s²). Gives the bare name and
/// the unit's symbol as written; no symbol if the name has none.
///
/// ```
/// use labfiles::units::split_unit;
/// assert_eq!(split_unit("clearance [mm]"), ("clearance", Some("mm")));
/// assert_eq!(split_unit("drive_frequency_hz"), ("drive_frequency", Some("hz")));
/// assert_eq!(split_unit("sweep"), ("sweep", None));
/// ```
pub fn split_unit(name: &str) -> (&str, Option<&str>) {
    let name = name.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((bare, symbol)) = name.strip_suffix(close).and_then(|n| n.rsplit_once(open)) {
            return (bare.trim(), Some(symbol.trim()));
        }
    }
    let suffix = name
        .match_indices('_')
        .find(|(at, _)| *at > 0 && suffix_unit(&name[at + 1..]).is_some());
    match suffix {
        Some((at, _)) => (&name[..at], Some(&name[at + 1..])),
        None => (name, None),
    }
}

/// The unit of a symbol that [`split_unit`] gives.
pub fn parse_split_unit(symbol: &str) -> Option<Unit> {
    parse_unit(symbol).or_else(|| suffix_unit(symbol))
}

/// The unit after an underscore: letters without case, `m_s` for m/s.
fn suffix_unit(suffix: &str) -> Option<Unit> {
    let slashed = suffix.to_lowercase().replace('_', "/");
    UNITS
        .iter()
        .filter(|(_, dimension, _)| *dimension != Dimension::Number)
        .find(|(symbol, _, _)| symbol.to_lowercase() == slashed)
        .map(|&(_, dimension, to_si)| Unit { dimension, to_si })
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

    #[test]
    fn quantities_are_read_in_si() {
        let read = |text| parse_quantity(text).unwrap();
        assert_eq!(
            read("1.5 mm"),
            Quantity {
                si: 1.5e-3,
                dimension: Dimension::Length
            }
        );
        assert_eq!(read("-2e-3m").si, -2e-3);
        assert_eq!(
            read("0.5 %"),
            Quantity {
                si: 0.005,
                dimension: Dimension::Number
            }
        );
        assert_eq!(read("7").dimension, Dimension::Number);
        assert!(matches!(
            parse_quantity("1,5 mm"),
            Err(QuantityError::Comma(_))
        ));
        assert!(matches!(
            parse_quantity("mm"),
            Err(QuantityError::NoNumber(_))
        ));
        assert!(matches!(
            parse_quantity("1 mmm"),
            Err(QuantityError::UnknownUnit(_))
        ));
        assert!(matches!(
            parse_quantity("1e999 m"),
            Err(QuantityError::NotFinite(_))
        ));
        let wrong = parse_quantity_of("3 kg", Dimension::Length);
        assert!(matches!(wrong, Err(QuantityError::Dimension { .. })));
    }

    #[test]
    fn scales_work_both_ways_round() {
        let volt = parse_unit("V").unwrap();
        for text in [
            "50 mm/s per V",
            "0.05 m/s/V",
            "20 V/(m/s)",
            "20 V per m/s",
            "20 V/m/s",
        ] {
            let unit = parse_scale(text).unwrap().apply(volt).unwrap();
            assert_eq!(unit.dimension, Dimension::Velocity, "{text}");
            assert!((unit.to_si - 0.05).abs() < 1e-15, "{text}");
        }
        let g = parse_scale("100 mV/g").unwrap().apply(volt).unwrap();
        assert!((g.to_si - 98.0665).abs() < 1e-12);
        assert_eq!(parse_scale("0.5").unwrap(), Scale::Factor(0.5));
        assert!(matches!(
            parse_scale("5 mm/s"),
            Err(QuantityError::NoRatio(_))
        ));
        assert!(
            parse_scale("5 mm per V")
                .unwrap()
                .apply(parse_unit("N").unwrap())
                .is_none()
        );
    }

    #[test]
    fn units_are_split_off_names() {
        assert_eq!(split_unit("clearance [mm]"), ("clearance", Some("mm")));
        assert_eq!(split_unit("clearance_mm"), ("clearance", Some("mm")));
        assert_eq!(
            split_unit("drive_frequency_hz"),
            ("drive_frequency", Some("hz"))
        );
        assert_eq!(split_unit("speed_m_s"), ("speed", Some("m_s")));
        assert_eq!(split_unit("drive_frequency"), ("drive_frequency", None));
        assert_eq!(
            parse_split_unit("hz").unwrap().dimension,
            Dimension::Frequency
        );
        assert_eq!(
            parse_split_unit("m_s").unwrap().dimension,
            Dimension::Velocity
        );
    }

    proptest::proptest! {
        #[test]
        fn prop_no_text_panics(text in "\\PC{0,30}") {
            let _ = (parse_quantity(&text), parse_scale(&text), split_unit(&text));
        }
    }
}
