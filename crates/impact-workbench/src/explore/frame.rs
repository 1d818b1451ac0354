//! What the server sends: JSON, or a header in JSON before columns of 32-bit numbers and cells.
//!
//! A frame is the header's length in bytes (32 bits, little endian), the header, padded with spaces
//! so that the numbers begin at a multiple of four, the columns (32-bit floats, little endian), and the
//! cells (16-bit numbers, little endian). The header's `columns` lists names and lengths, its `cells` their number.

use serde_json::{Map, Value, json};

/// A message to the page.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Frame {
    header: Map<String, Value>,
    columns: Vec<(String, Vec<f32>)>,
    cells: Vec<u16>,
}

impl Frame {
    /// A frame of a kind, in answer to a request.
    pub(super) fn new(kind: &str, id: u32) -> Self {
        let mut header = Map::new();
        header.insert("kind".into(), kind.into());
        header.insert("id".into(), id.into());
        Self {
            header,
            columns: Vec::new(),
            cells: Vec::new(),
        }
    }

    /// With a value in its header; one that JSON cannot hold is left out.
    pub(super) fn with(mut self, key: &str, value: impl serde::Serialize) -> Self {
        if let Ok(value) = serde_json::to_value(value) {
            self.header.insert(key.into(), value);
        }
        self
    }

    /// With a column of numbers.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "pictures need no more digits"
    )]
    pub(super) fn column(mut self, name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let narrow = values.into_iter().map(|v| v as f32).collect();
        self.columns.push((name.to_owned(), narrow));
        self
    }

    /// With cells.
    pub(super) fn cells(mut self, cells: Vec<u16>) -> Self {
        self.cells = cells;
        self
    }

    /// The bytes that are sent.
    pub(super) fn bytes(mut self) -> Vec<u8> {
        let lengths = self.columns.iter().map(|(n, v)| json!([n, v.len()]));
        let lengths: Vec<Value> = lengths.collect();
        self.header.insert("columns".into(), lengths.into());
        self.header.insert("cells".into(), self.cells.len().into());
        let mut header = Value::Object(self.header).to_string().into_bytes();
        header.resize(header.len().next_multiple_of(4), b' ');
        let mut bytes = Vec::with_capacity(4 + header.len());
        let length = u32::try_from(header.len()).unwrap_or(u32::MAX);
        bytes.extend(length.to_le_bytes());
        bytes.append(&mut header);
        for (_, values) in &self.columns {
            bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
        }
        bytes.extend(self.cells.iter().flat_map(|c| c.to_le_bytes()));
        bytes
    }
}
