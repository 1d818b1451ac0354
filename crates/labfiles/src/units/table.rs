//! Units by their symbols.

/// Standard gravity, m/s² per g (exact by definition, CGPM 1901).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// The physical dimension of a quantity.
#[derive(
    Debug, Default, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize,
)]
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
    #[default]
    Number,
}

impl Dimension {
    /// The dimension's name in messages.
    pub fn name(self) -> &'static str {
        self.texts().0
    }

    /// The name with its article: "an angle", "a length".
    pub fn with_article(self) -> String {
        let name = self.name();
        let article = if name.starts_with('a') { "an" } else { "a" };
        format!("{article} {name}")
    }

    /// The SI unit's symbol.
    pub fn si_symbol(self) -> &'static str {
        self.texts().1
    }

    /// Name and SI symbol.
    fn texts(self) -> (&'static str, &'static str) {
        match self {
            Self::Length => ("length", "m"),
            Self::Velocity => ("velocity", "m/s"),
            Self::Acceleration => ("acceleration", "m/s²"),
            Self::Force => ("force", "N"),
            Self::Voltage => ("voltage", "V"),
            Self::Frequency => ("frequency", "Hz"),
            Self::Time => ("time", "s"),
            Self::Mass => ("mass", "kg"),
            Self::Angle => ("angle", "rad"),
            Self::Number => ("plain number", "1"),
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
    ("mps", Dimension::Velocity, 1.0),
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
    ("MHz", Dimension::Frequency, 1e6),
    ("GHz", Dimension::Frequency, 1e9),
    ("rad/s", Dimension::Frequency, 1.0 / std::f64::consts::TAU),
    ("deg/s", Dimension::Frequency, 1.0 / 360.0),
    ("°/s", Dimension::Frequency, 1.0 / 360.0),
    ("dps", Dimension::Frequency, 1.0 / 360.0),
    ("rpm", Dimension::Frequency, 1.0 / 60.0),
    ("s", Dimension::Time, 1.0),
    ("ms", Dimension::Time, 1e-3),
    ("us", Dimension::Time, 1e-6),
    ("µs", Dimension::Time, 1e-6),
    ("μs", Dimension::Time, 1e-6),
    ("ns", Dimension::Time, 1e-9),
    ("min", Dimension::Time, 60.0),
    ("kg", Dimension::Mass, 1.0),
    ("gram", Dimension::Mass, 1e-3),
    ("rad", Dimension::Angle, 1.0),
    ("deg", Dimension::Angle, std::f64::consts::PI / 180.0),
    ("°", Dimension::Angle, std::f64::consts::PI / 180.0),
    ("1", Dimension::Number, 1.0),
    ("%", Dimension::Number, 1e-2),
    ("ppm", Dimension::Number, 1e-6),
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

/// Split the unit off a column's or attribute's name: `clearance [mm]`, `clearance (mm)`, `clearance in mm`,
/// `clearance / mm`, `v/(m/s)`, `clearance, mm` or `clearance_mm` (after an underscore `m_s` means m/s, `m_s2` m/s²). Gives the bare name and
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
            return (without_slash(bare), Some(symbol.trim()));
        }
    }
    if let Some((bare, symbol)) = split_at_slash(name) {
        return (bare, Some(symbol));
    }
    if let Some((bare, symbol)) = name.rsplit_once(" in ")
        && parse_unit(symbol).is_some()
    {
        return (bare.trim(), Some(symbol.trim()));
    }
    if let Some((bare, symbol)) = split_at_comma(name) {
        return (bare, Some(symbol));
    }
    let suffix = name
        .match_indices('_')
        .find(|(at, _)| *at > 0 && has_dimension(&name[at + 1..]));
    match suffix {
        Some((at, _)) => (&name[..at], Some(&name[at + 1..])),
        None => (name, None),
    }
}

/// Whether a suffix is a unit of more than numbers.
fn has_dimension(suffix: &str) -> bool {
    parse_split_unit(suffix).is_some_and(|unit| unit.dimension != Dimension::Number)
}

/// A quantity and the unit after its first slash, as ISO 80000-1 writes them: `x / mm`, `t/s`, `v/m/s`. What is a unit
/// as a whole has no name.
pub(crate) fn split_at_slash(name: &str) -> Option<(&str, &str)> {
    let (bare, symbol) = name.split_once('/')?;
    let unit = parse_unit(symbol)?;
    let measured = unit.dimension != Dimension::Number && !bare.trim().is_empty();
    (measured && parse_unit(name).is_none()).then_some((bare.trim(), symbol.trim()))
}

/// The name before a bracket, without the slash of `v/(m/s)`.
pub(crate) fn without_slash(name: &str) -> &str {
    name.trim().trim_end_matches('/').trim_end()
}

/// A name and the unit after its last comma: `Displacement, in`. A plain number there counts channels: `Sensor, 1`.
pub(crate) fn split_at_comma(name: &str) -> Option<(&str, &str)> {
    let (bare, symbol) = name.rsplit_once(", ")?;
    let unit = parse_unit(symbol)?;
    let measured = unit.dimension != Dimension::Number && !bare.trim().is_empty();
    measured.then_some((bare.trim(), symbol.trim()))
}

/// The unit of a symbol that [`split_unit`] gives.
pub fn parse_split_unit(symbol: &str) -> Option<Unit> {
    parse_unit(symbol).or_else(|| suffix_unit(symbol))
}

/// The unit of a channel: as stated where that is known, else the one that its name bears.
///
/// ```
/// use labfiles::units::{parse_unit, unit_of};
/// assert_eq!(unit_of(None, "gap_mm"), parse_unit("mm"));
/// assert_eq!(unit_of(Some("m"), "gap_mm"), parse_unit("m"));
/// ```
pub fn unit_of(stated: Option<&str>, name: &str) -> Option<Unit> {
    let of_name = || split_unit(name).1.and_then(parse_split_unit);
    stated.and_then(parse_unit).or_else(of_name)
}

/// The unit after an underscore: letters without case, `m_s` for m/s; none where the case decides, as of `mhz`.
fn suffix_unit(suffix: &str) -> Option<Unit> {
    let slashed = suffix.to_lowercase().replace('_', "/");
    let mut found = UNITS
        .iter()
        .filter(|(_, dimension, _)| *dimension != Dimension::Number)
        .filter(|(symbol, _, _)| symbol.to_lowercase() == slashed)
        .map(|&(_, dimension, to_si)| Unit { dimension, to_si });
    let first = found.next()?;
    found.all(|other| other == first).then_some(first)
}
