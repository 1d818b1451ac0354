//! The header of a function (set 58) and the sets that name and measure the whole file (151, 164).

use std::collections::BTreeMap;

use chrono::NaiveDateTime;

use crate::bytes::{decode_text, to_usize};
use crate::units::{Dimension, parse_unit};

/// One axis of a function: records 8 to 11.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Axis {
    /// Specific data type: 17 time, 18 frequency, 12 acceleration and so on.
    pub kind: i64,
    /// Its label, if it is not blank or NONE.
    pub label: Option<String>,
    /// Its unit, if it is not blank or NONE.
    pub unit: Option<String>,
}

/// A degree of freedom: where and in which direction something was measured or excited.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash)]
pub(super) struct Freedom {
    /// Name, if it is not blank or NONE.
    pub name: Option<String>,
    /// Number of the node.
    pub node: i64,
    /// Direction: 1 to 3 for x, y, z, negative for the opposite, 0 for a scalar.
    pub direction: i64,
}

impl Freedom {
    /// `12:+Z`, where a node is given.
    pub(super) fn place(&self) -> Option<String> {
        const AXES: [&str; 7] = ["S", "X", "Y", "Z", "RX", "RY", "RZ"];
        let axis = AXES.get(to_usize(self.direction.unsigned_abs()))?;
        let sign = if self.direction < 0 { "-" } else { "+" };
        (self.node != 0).then(|| format!("{}:{sign}{axis}", self.node))
    }
}

/// The header of a function.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Header {
    /// The five lines of identification.
    pub lines: [String; 5],
    /// Function type: 1 time response, 4 frequency response, 9 spectral density and so on.
    pub function: i64,
    /// Load case.
    pub load_case: i64,
    /// Where the response was measured.
    pub response: Freedom,
    /// Where the reference was.
    pub reference: Freedom,
    /// Type of the ordinate's numbers: 2, 4 real, 5, 6 complex; 4, 6 in double precision.
    pub ordinate_type: i64,
    /// Number of points.
    pub points: u64,
    /// Whether the abscissa is evenly spaced.
    pub even: bool,
    /// First abscissa of an even one.
    pub start: f64,
    /// Step of an even one.
    pub increment: f64,
    /// Abscissa, ordinate numerator, ordinate denominator, z axis.
    pub axes: [Axis; 4],
}

/// A header's line that could not be understood.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fault {
    /// Which line of the set, from 0.
    pub line: usize,
    /// What was needed there.
    pub expected: &'static str,
    /// What was found there.
    pub found: String,
}

/// Text of a field without its blanks; `None` if it is blank or NONE.
fn field(line: &[u8], from: usize, to: usize) -> Option<String> {
    let bytes = line.get(from.min(line.len())..to.min(line.len()))?;
    let text = decode_text(bytes).trim().to_owned();
    (!text.is_empty() && text != "NONE").then_some(text)
}

fn integer(line: &[u8], from: usize, to: usize) -> i64 {
    field(line, from, to)
        .and_then(|text| text.parse().ok())
        .unwrap_or(0)
}

/// A number in text, also with Fortran's D exponent.
fn number(text: &str) -> Option<f64> {
    text.replace(['D', 'd'], "E").parse().ok()
}

impl Header {
    /// From the eleven lines of a function's header.
    pub(super) fn read(lines: &[&[u8]; 11]) -> Result<Self, Fault> {
        let mut header = Self {
            lines: identification(lines),
            ..Self::default()
        };
        let freedoms = lines[5];
        header.function = integer(freedoms, 0, 5);
        header.load_case = integer(freedoms, 20, 30);
        header.response = freedom(freedoms, 31);
        header.reference = freedom(freedoms, 56);
        header.form(lines[6])?;
        for (axis, line) in header.axes.iter_mut().zip(&lines[7..]) {
            *axis = Axis {
                kind: integer(line, 0, 10),
                label: field(line, 26, 46),
                unit: field(line, 47, 67),
            };
        }
        Ok(header)
    }

    /// Record 7: numbers in columns, or separated by blanks.
    fn form(&mut self, line: &[u8]) -> Result<(), Fault> {
        let fault = |expected| Fault {
            line: 6,
            expected,
            found: format!("{:?}", decode_text(line).trim_end()),
        };
        let text = decode_text(line);
        let words: Vec<&str> = text.split_whitespace().collect();
        let column = |i: usize| field(line, 10 * i, 10 * i + 10)?.parse::<i64>().ok();
        let word = |i: usize| words.get(i)?.parse::<i64>().ok();
        let three = |of: &dyn Fn(usize) -> Option<i64>| Some([of(0)?, of(1)?, of(2)?]);
        let found = three(&column).or_else(|| three(&word));
        let [kind, points, spacing] =
            found.ok_or_else(|| fault("type, number of points and spacing of a function"))?;
        if !matches!(kind, 2 | 4 | 5 | 6) {
            return Err(fault("ordinate type 2, 4, 5 or 6"));
        }
        if !matches!(spacing, 0 | 1) {
            return Err(fault("spacing 0 (uneven) or 1 (even)"));
        }
        (self.ordinate_type, self.even) = (kind, spacing == 1);
        self.points = u64::try_from(points).map_err(|_| fault("a number of points"))?;
        let mut reals = Vec::new();
        let rest = line.get(30.min(line.len())..).unwrap_or(&[]);
        if super::ascii::Numbers::new(rest)
            .take(2, &mut reals)
            .is_err()
            || reals.len() < 2
        {
            reals = words
                .iter()
                .skip(3)
                .take(2)
                .filter_map(|word| number(word))
                .collect();
        }
        match (reals.as_slice(), self.even) {
            (&[start, increment, ..], true) if start.is_finite() && increment.is_finite() => {
                (self.start, self.increment) = (start, increment);
                Ok(())
            }
            (_, false) => Ok(()),
            _ => Err(fault("start and increment of the abscissa")),
        }
    }

    /// Whether the ordinate is complex.
    pub(super) fn complex(&self) -> bool {
        self.ordinate_type >= 5
    }

    /// Whether the ordinate is in double precision.
    pub(super) fn double(&self) -> bool {
        matches!(self.ordinate_type, 4 | 6)
    }

    /// Numbers per point, the abscissa of an uneven one included.
    pub(super) fn per_point(&self) -> u64 {
        1 + u64::from(self.complex()) + u64::from(!self.even)
    }

    /// Whether the abscissa is time.
    pub(super) fn over_time(&self) -> bool {
        let axis = &self.axes[0];
        axis.kind == 17 || (axis.kind == 0 && axis.unit.as_deref() == Some("s"))
    }

    /// Samples per second, Hz, of an even abscissa of time; in s if it states no other unit.
    pub(super) fn sample_rate_hz(&self) -> f64 {
        (self.increment * self.abscissa_s()).recip()
    }

    /// The first abscissa, s, of an even one of time.
    pub(super) fn start_s(&self) -> f64 {
        self.start * self.abscissa_s()
    }

    /// Seconds in the unit of an abscissa of time.
    pub(super) fn abscissa_s(&self) -> f64 {
        let unit = self.axes[0].unit.as_deref().and_then(parse_unit);
        let unit = unit.filter(|u| u.dimension == Dimension::Time);
        unit.map_or(1.0, |u| u.to_si)
    }

    /// The third line as ISO 8601, if it is a date such as `18-Apr-16 13:49:58`.
    pub(super) fn start_time(&self) -> Option<String> {
        iso8601(&self.lines[2])
    }

    /// The lines of identification that are not blank, under their names.
    pub(super) fn named_lines(&self) -> impl Iterator<Item = (String, String)> {
        let lines = self.lines.iter().enumerate();
        lines
            .filter(|(_, line)| !line.is_empty())
            .map(|(index, line)| (format!("id{}", index + 1), line.clone()))
    }

    /// The header's fields as text, under the names of the format's description.
    pub(super) fn properties(&self) -> BTreeMap<String, String> {
        let (response, reference) = (&self.response, &self.reference);
        let integer = |value: i64| Some(value.to_string());
        let of_even = |value: f64| self.even.then(|| value.to_string());
        let fields = [
            ("func_type", integer(self.function)),
            ("load_case_id", integer(self.load_case)),
            ("rsp_ent_name", response.name.clone()),
            ("rsp_node", integer(response.node)),
            ("rsp_dir", integer(response.direction)),
            ("ref_ent_name", reference.name.clone()),
            ("ref_node", integer(reference.node)),
            ("ref_dir", integer(reference.direction)),
            ("ord_data_type", integer(self.ordinate_type)),
            ("abscissa_min", of_even(self.start)),
            ("abscissa_inc", of_even(self.increment)),
        ];
        let fields = fields.into_iter().map(|(name, v)| (name.to_owned(), v));
        let names = ["abscissa", "ordinate", "denominator", "z_axis"];
        let axes = names.into_iter().zip(&self.axes).flat_map(|(name, axis)| {
            let kind = Some(axis.kind).filter(|kind| *kind != 0);
            [
                (format!("{name}_label"), axis.label.clone()),
                (format!("{name}_unit"), axis.unit.clone()),
                (format!("{name}_type"), kind.and_then(integer)),
            ]
        });
        let stated = fields.chain(axes).filter_map(|(name, v)| Some((name, v?)));
        self.named_lines().chain(stated).collect()
    }
}

fn identification(lines: &[&[u8]; 11]) -> [String; 5] {
    let mut all = [const { String::new() }; 5];
    for (text, line) in all.iter_mut().zip(lines) {
        *text = field(line, 0, line.len()).unwrap_or_default();
    }
    all
}

fn freedom(line: &[u8], at: usize) -> Freedom {
    Freedom {
        name: field(line, at, at + 10),
        node: integer(line, at + 10, at + 20),
        direction: integer(line, at + 20, at + 24),
    }
}

/// `18-Apr-16 13:49:58` as `2016-04-18T13:49:58`; years below 70 are of this century.
fn iso8601(text: &str) -> Option<String> {
    let forms = ["%d-%b-%y %H:%M:%S", "%d-%b-%Y %H:%M:%S"];
    let read = |form| NaiveDateTime::parse_from_str(text.trim(), form).ok();
    let time = forms.into_iter().find_map(read)?;
    Some(time.format("%Y-%m-%dT%H:%M:%S").to_string())
}

/// The unit system of a file (set 164).
#[derive(Debug, Clone, PartialEq)]
pub(super) struct System {
    /// 1 SI, 5 mm and mN, 9 user defined and so on.
    pub code: i64,
    /// Its description.
    pub description: Option<String>,
    /// What to divide lengths, forces and temperatures by to have SI.
    pub factors: Vec<f64>,
}

impl System {
    /// From the lines of a set 164.
    pub(super) fn read(lines: &[&[u8]]) -> Option<Self> {
        let (first, rest) = lines.split_first()?;
        let text: Vec<u8> = rest.join(&b' ');
        let words = decode_text(&text);
        let factors = words.split_whitespace().map_while(number).take(3).collect();
        Some(Self {
            code: integer(first, 0, 10),
            description: field(first, 10, 30),
            factors,
        })
    }

    /// The unit that an ordinate's specific data type has in this system.
    pub(super) fn unit(&self, kind: i64) -> Option<String> {
        let (length, force) = match self.code {
            1 => ("m", "N"),
            2 => ("ft", "lbf"),
            5 => ("mm", "mN"),
            7 => ("in", "lbf"),
            10 => ("mm", "N"),
            _ => return None,
        };
        match kind {
            8 => Some(length.to_owned()),
            11 => Some(format!("{length}/s")),
            12 => Some(format!("{length}/s2")),
            9 | 13 => Some(force.to_owned()),
            17 => Some("s".to_owned()),
            18 => Some("Hz".to_owned()),
            _ => None,
        }
    }

    /// As attributes of a dataset.
    pub(super) fn attributes(&self) -> Vec<(String, String)> {
        let mut all = vec![("units_code".to_owned(), self.code.to_string())];
        all.extend(
            self.description
                .iter()
                .map(|d| ("units_description".to_owned(), d.clone())),
        );
        let names = ["length_factor", "force_factor", "temperature_factor"];
        let factors = names.into_iter().zip(&self.factors);
        all.extend(factors.map(|(name, factor)| (name.to_owned(), factor.to_string())));
        all
    }
}

/// Names from a set 151: model, description, program, dates.
pub(super) fn model(lines: &[&[u8]]) -> Vec<(String, String)> {
    let names = [
        "model_name",
        "description",
        "database_program",
        "created",
        "modified",
        "program",
    ];
    let texts = names.into_iter().zip(lines);
    texts
        .filter_map(|(name, line)| Some((name.to_owned(), field(line, 0, line.len())?)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates() {
        assert_eq!(
            iso8601("18-Apr-16 13:49:58").as_deref(),
            Some("2016-04-18T13:49:58")
        );
        assert_eq!(
            iso8601("05-MAY-1998 18:05:29").as_deref(),
            Some("1998-05-05T18:05:29")
        );
        assert_eq!(iso8601("NONE"), None);
        assert_eq!(iso8601("18-Apr-16 25:00:00"), None);
    }

    #[test]
    fn unit_systems() {
        let lines: [&[u8]; 3] = [
            b"         5mm (milli-newton)            2",
            b"  1.00000000000000000D+03  1.00000000000000000D+03  1.00000000000000000D+00",
            b"  2.73149999999999977D+02",
        ];
        let system = System::read(&lines).unwrap();
        assert_eq!(system.unit(12).as_deref(), Some("mm/s2"));
        assert_eq!(system.factors, [1000.0, 1000.0, 1.0]);
        assert_eq!(system.description.as_deref(), Some("mm (milli-newton)"));
    }
}
