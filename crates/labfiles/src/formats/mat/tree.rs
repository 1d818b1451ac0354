//! The arrays a MATLAB file holds, as found before any sample is read.

use crate::numbers::{ByteOrder, Number};
use crate::source::StoredType;

/// A zlib stream that holds a variable.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Packed {
    /// Its offset in the file.
    pub at: u64,
    /// Its length, bytes.
    pub packed: u64,
    /// Length it must inflate to, bytes.
    pub inflated: u64,
}

/// A variable at the top of the file.
#[derive(Debug, Clone)]
pub(crate) struct Variable {
    /// Its name.
    pub name: String,
    /// The stream that holds it; offsets count from the start of the inflated bytes. `None`: its
    /// bytes are in the file as they are.
    pub packed: Option<Packed>,
    /// Byte order of its numbers.
    pub order: ByteOrder,
}

/// A run of numbers of one kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Part {
    /// Offset of the first byte (see [`Variable::packed`]).
    pub at: u64,
    /// Length, bytes.
    pub bytes: u64,
    /// How each number is stored.
    pub number: Number,
}

/// How the codes of a text are to be understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// One number per character.
    Codes,
    /// UTF-8.
    Utf8,
    /// UTF-16.
    Utf16,
    /// UTF-32.
    Utf32,
}

/// What an array holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Content {
    /// Real numbers.
    Real(Part),
    /// Complex numbers; each part of that many bits by the array's class.
    Complex(Part, Part, u8),
    /// Text; every row of the array is one string.
    Text(Part, Encoding),
}

/// An array of numbers or of characters, with the path that leads to it.
#[derive(Debug, Clone)]
pub(crate) struct Leaf {
    /// Index of its variable.
    pub variable: usize,
    /// Which element of its variable it belongs to, where the variable has several.
    pub element: Option<u64>,
    /// Its path, e.g. `runs(2).velocity`.
    pub name: String,
    /// Its path inside the element, e.g. `velocity`.
    pub tail: String,
    /// Its dimensions, at least two.
    pub dims: Vec<u64>,
    /// What it holds.
    pub content: Content,
    /// MATLAB class, e.g. `double`.
    pub class: String,
    /// Whether it holds true and false.
    pub logical: bool,
    /// Its value as text if it is one number or one short string.
    pub value: Option<String>,
}

impl Leaf {
    /// Number of elements.
    pub(crate) fn count(&self) -> u64 {
        self.dims.iter().product()
    }

    /// Its numbers or characters (of complex numbers: the real parts).
    pub(crate) fn part(&self) -> Part {
        match self.content {
            Content::Real(part) | Content::Complex(part, ..) | Content::Text(part, _) => part,
        }
    }

    /// How the numbers are stored.
    pub(crate) fn stored(&self) -> StoredType {
        match self.content {
            Content::Real(part) => part.number.stored(),
            Content::Complex(_, _, bits) => StoredType::Complex(bits),
            Content::Text(..) => StoredType::Text,
        }
    }

    /// Whether it holds numbers.
    pub(crate) fn is_numeric(&self) -> bool {
        !matches!(self.content, Content::Text(..))
    }
}

/// All that opening a file finds.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tree {
    /// The variables in file order.
    pub variables: Vec<Variable>,
    /// Their arrays in file order.
    pub leaves: Vec<Leaf>,
    /// What was skipped or assumed.
    pub notes: Vec<String>,
    /// Names of variables that were left out because their kind is not read, with the kind.
    pub refused: Vec<(String, String)>,
}

impl Tree {
    /// What of the file is not read, kind by kind.
    pub(crate) fn left_out(&self) -> impl Iterator<Item = String> {
        let kinds = self.kinds_refused().into_iter();
        kinds.map(|kind| format!("{} not read: {}", self.named(kind), remedy(kind)))
    }

    /// The kinds of variables that are not read, as they come first.
    fn kinds_refused(&self) -> Vec<&str> {
        let mut kinds: Vec<&str> = Vec::new();
        for (_, kind) in &self.refused {
            if !kinds.contains(&kind.as_str()) {
                kinds.push(kind);
            }
        }
        kinds
    }

    /// What a file holds of which nothing is read, and what to save instead; `None` where something is read.
    pub(crate) fn nothing_read(&self) -> Option<(String, String)> {
        if self.refused.is_empty() || !self.leaves.is_empty() {
            return None;
        }
        let mut kinds = self.kinds_refused();
        kinds.sort_by_key(|kind| remedy(kind) == OF_OBJECTS);
        let named: Vec<String> = kinds.iter().map(|kind| self.named(kind)).collect();
        let found = named.join(", ");
        let mut remedies: Vec<&str> = kinds.iter().map(|kind| remedy(kind)).collect();
        remedies.dedup();
        Some((
            format!("{found} and nothing else"),
            format!(
                "save arrays of numbers or structs of them: {}",
                remedies.join("; ")
            ),
        ))
    }

    /// The variables of a kind that is not read, the first by name and the others counted.
    fn named(&self, kind: &str) -> String {
        let of_kind = self.refused.iter().filter(|(_, own)| own == kind);
        let names: Vec<&str> = of_kind.map(|(name, _)| name.as_str()).collect();
        let shown: Vec<String> = names
            .iter()
            .take(NAMED)
            .map(|name| format!("'{name}'"))
            .collect();
        let more = match names.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!("{kind} {}{more}", shown.join(" "))
    }
}

/// Variables of a kind that a message names.
const NAMED: usize = 3;

/// What to save instead of objects that nothing more is known of.
const OF_OBJECTS: &str = "of an object x the fields that are numbers";

/// What to save instead of a variable of a kind.
fn remedy(kind: &str) -> &'static str {
    match kind {
        "sparse" => "of a sparse matrix S full(S)",
        "table" => "of a table T table2struct(T, 'ToScalar', true)",
        "timetable" => "of a timetable T table2struct(timetable2table(T), 'ToScalar', true)",
        "datetime" | "duration" => "of times t seconds(t - t(1))",
        "string" => "of a string s char(s)",
        "timeseries" => "of a timeseries s s.Time and s.Data",
        _ => OF_OBJECTS,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_of_a_kind_that_is_not_read_are_one_note() {
        let kinds = ["sparse", "table", "sparse", "sparse", "sparse"];
        let refused = kinds.iter().enumerate();
        let tree = Tree {
            refused: refused
                .map(|(i, kind)| (format!("v{i}"), (*kind).to_owned()))
                .collect(),
            ..Tree::default()
        };
        let notes: Vec<String> = tree.left_out().collect();
        assert_eq!(
            notes,
            [
                "sparse 'v0' 'v2' 'v3' and 1 more not read: of a sparse matrix S full(S)",
                "table 'v1' not read: of a table T table2struct(T, 'ToScalar', true)",
            ]
        );
    }
}
