//! A figure's data as CSV, so that a reader can draw it again.

/// Rows of text and numbers under a header; short rows are filled with empty fields.
pub struct Csv {
    text: String,
    columns: usize,
    filled: usize,
}

impl Csv {
    /// A table with these columns.
    pub fn new(header: &[&str]) -> Self {
        let mut csv = Self {
            text: String::new(),
            columns: header.len(),
            filled: 0,
        };
        csv.texts(header);
        csv
    }

    /// Begins a row.
    pub fn row(&mut self) -> &mut Self {
        self.end_row();
        self
    }

    /// Text fields.
    pub fn texts(&mut self, fields: &[&str]) -> &mut Self {
        for field in fields {
            let needs_quotes = field.contains([',', '"', '\n']);
            let text = if needs_quotes {
                format!("\"{}\"", field.replace('"', "\"\""))
            } else {
                (*field).to_owned()
            };
            self.field(&text);
        }
        self
    }

    /// Number fields; missing ones stay empty.
    pub fn numbers(&mut self, fields: &[Option<f64>]) -> &mut Self {
        for field in fields {
            let text = field
                .filter(|v| v.is_finite())
                .map_or(String::new(), |v| format!("{v}"));
            self.field(&text);
        }
        self
    }

    fn field(&mut self, text: &str) {
        if self.filled > 0 {
            self.text.push(',');
        }
        self.text.push_str(text);
        self.filled += 1;
    }

    fn end_row(&mut self) {
        while self.filled < self.columns {
            self.field("");
        }
        self.text.push('\n');
        self.filled = 0;
    }

    /// The whole table.
    pub fn finish(mut self) -> String {
        self.end_row();
        self.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_fields_are_quoted_and_rows_filled() {
        let mut csv = Csv::new(&["a", "b", "c"]);
        csv.row().texts(&["x,y"]).numbers(&[Some(0.5)]);
        assert_eq!(csv.finish(), "a,b,c\n\"x,y\",0.5,\n");
    }
}
