//! Names, scales and orientation of a table's channels, from its attributes.

use std::collections::BTreeMap;

use crate::bytes::to_usize;
use crate::formats::hdf5::store::{Array, Attr, Attrs};
use crate::numbers::Spacing;

/// Attributes that name the channels, in order of precedence.
pub(crate) const NAME_KEYS: [&str; 7] = [
    "channels",
    "channel_names",
    "names",
    "columns",
    "column_names",
    "labels",
    "fields",
];
/// Attributes that give the channels' units.
pub(crate) const UNIT_KEYS: [&str; 5] = ["units", "unit", "channel_units", "unit_string", "Unit"];
/// More rows than this are no channels.
const MOST_ROW_CHANNELS: u64 = 64;

/// Which dimension of a table counts the channels.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Orientation {
    /// samples × channels.
    Columns,
    /// channels × samples.
    Rows,
}

impl Orientation {
    /// The names decide; without names a few long rows are channels.
    pub(crate) fn of(table: &Array, inherited: &Attrs) -> Self {
        let [rows, columns] = dimensions(&table.shape);
        let scope = Scope::within(inherited, &table.attributes);
        if names(scope, columns).is_some() {
            Self::Columns
        } else if names(scope, rows).is_some() || (rows <= MOST_ROW_CHANNELS && columns > 4 * rows)
        {
            Self::Rows
        } else {
            Self::Columns
        }
    }

    /// Number of channels; of a table wider than [`MOST_CHANNELS`], an image or a matrix, the
    /// first alone.
    pub(crate) fn channels(self, table: &Array) -> u64 {
        let [rows, columns] = dimensions(&table.shape);
        if self == Self::Columns { columns } else { rows }.min(MOST_CHANNELS)
    }

    /// Number of samples of each channel.
    pub(crate) fn samples(self, table: &Array) -> u64 {
        let [rows, columns] = dimensions(&table.shape);
        if self == Self::Columns { rows } else { columns }
    }

    /// Which of a table's bytes are those of a channel.
    pub(crate) fn spacing(self, table: &Array, channel: u64) -> Spacing {
        let [columns, channel] = [dimensions(&table.shape)[1], channel].map(to_usize);
        let size = table.element.bytes();
        let row = columns.saturating_mul(size);
        let (offset, stride) = match self {
            Self::Columns => (channel.saturating_mul(size), row),
            Self::Rows => (channel.saturating_mul(row), size),
        };
        Spacing {
            offset,
            stride,
            count: to_usize(self.samples(table)),
        }
    }
}

/// The most channels of a table.
pub(crate) const MOST_CHANNELS: u64 = 4096;

/// The two dimensions of a table that may have further ones of one entry.
fn dimensions(shape: &[u64]) -> [u64; 2] {
    match (&squeezed(shape)[..], shape) {
        (&[rows, columns], _) | (_, &[rows, columns]) => [rows, columns],
        _ => [0, 0],
    }
}

/// A shape without its dimensions of one entry.
pub(crate) fn squeezed(shape: &[u64]) -> Vec<u64> {
    shape.iter().copied().filter(|&d| d != 1).collect()
}

/// Attributes of an object and those that it inherits; own ones win.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'a> {
    inherited: &'a Attrs,
    own: &'a Attrs,
}

impl<'a> Scope<'a> {
    /// An object's own attributes and inherited ones.
    pub(crate) fn within(inherited: &'a Attrs, own: &'a Attrs) -> Self {
        Self { inherited, own }
    }

    /// Attributes alone.
    pub(crate) fn of(own: &'a Attrs) -> Self {
        static NONE: Attrs = Attrs::new();
        Self::within(&NONE, own)
    }

    fn get(self, key: &str) -> Option<&'a Attr> {
        self.own.get(key).or_else(|| self.inherited.get(key))
    }

    /// All of them.
    pub(crate) fn merged(self) -> Attrs {
        let mut all = self.inherited.clone();
        all.extend(self.own.clone());
        all
    }

    /// All of them as texts.
    pub(crate) fn texts(self) -> BTreeMap<String, String> {
        let all = self.inherited.iter().chain(self.own);
        all.map(|(key, value)| (key.clone(), value.text()))
            .collect()
    }
}

/// The channels' names, where an attribute lists as many as there are.
pub(crate) fn names(scope: Scope<'_>, channels: u64) -> Option<Vec<String>> {
    lists(scope, &NAME_KEYS).find(|l| l.len() as u64 == channels && l.iter().all(|n| !n.is_empty()))
}

/// The channels' units: a list of as many, or one for all.
pub(crate) fn units(scope: Scope<'_>, channels: usize) -> Vec<Option<String>> {
    let of_length = |length: usize| lists(scope, &UNIT_KEYS).find(|l| l.len() == length);
    let one = || Some(vec![of_length(1)?.remove(0); channels]);
    let all = of_length(channels).or_else(one).unwrap_or_default();
    all.into_iter().map(Some).collect()
}

/// The lists that attributes of some names hold.
fn lists<'a>(scope: Scope<'a>, keys: &'a [&str]) -> impl Iterator<Item = Vec<String>> + 'a {
    let found = keys.iter().filter_map(move |k| scope.get(k));
    found.map(Attr::list)
}

/// Scale and offset of each channel: `scale_factor` and `add_offset` of any array, `scale` and
/// `offset` of an array of integers.
pub(crate) fn scaling(array: &Array, channels: usize) -> Vec<(f64, f64)> {
    let of_integers = |key: &str| {
        array
            .attributes
            .get(key)
            .filter(|_| array.element.is_integer())
    };
    let of = |of_integer: &str, of_any: &str, neutral: f64| -> Vec<f64> {
        let found = of_integers(of_integer).or_else(|| array.attributes.get(of_any));
        match found.and_then(Attr::numbers) {
            Some([one]) => vec![*one; channels],
            Some(all) if all.len() == channels => all.to_vec(),
            _ => vec![neutral; channels],
        }
    };
    let scales = of("scale", "scale_factor", 1.0).into_iter();
    scales.zip(of("offset", "add_offset", 0.0)).collect()
}

/// Order of names in which `run10` follows `run9`.
pub(crate) fn natural(a: &str, b: &str) -> std::cmp::Ordering {
    let (mut x, mut y) = (a.as_bytes(), b.as_bytes());
    loop {
        match (x.first(), y.first()) {
            (Some(p), Some(q)) if p.is_ascii_digit() && q.is_ascii_digit() => {
                let (m, n) = (number_of(x), number_of(y));
                let order = (m.0, m.1.len())
                    .cmp(&(n.0, n.1.len()))
                    .then_with(|| m.1.cmp(n.1));
                if order != std::cmp::Ordering::Equal {
                    return order;
                }
                (x, y) = (&x[m.2..], &y[n.2..]);
            }
            (p, q) if p == q && p.is_some() => (x, y) = (&x[1..], &y[1..]),
            (p, q) => return p.cmp(&q),
        }
    }
}

/// Leading digits: their count without zeros in front, the digits, the length with the zeros.
fn number_of(bytes: &[u8]) -> (usize, &[u8], usize) {
    let length = bytes.iter().take_while(|b| b.is_ascii_digit()).count();
    let zeros = bytes[..length].iter().take_while(|&&b| b == b'0').count();
    (length - zeros, &bytes[zeros..length], length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn natural_order() {
        let mut names = ["run10", "run9", "a", "run010", "run", "run9b"];
        names.sort_by(|a, b| natural(a, b));
        assert_eq!(names[..4], ["a", "run", "run9", "run9b"]);
    }
}
