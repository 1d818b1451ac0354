//! A figure's data as CSV, so that a reader can draw it again.

/// Rows of text and numbers under a header; short rows are filled with empty fields.
pub(crate) struct Csv {
    text: String,
    columns: usize,
    filled: usize,
}

impl Csv {
    /// A table with these columns.
    pub(crate) fn new(header: &[&str]) -> Self {
        let mut csv = Self {
            text: String::new(),
            columns: header.len(),
            filled: 0,
        };
        csv.texts(header);
        csv
    }

    /// Begins a row.
    pub(crate) fn row(&mut self) -> &mut Self {
        self.end_row();
        self
    }

    /// Text fields.
    pub(crate) fn texts(&mut self, fields: &[&str]) -> &mut Self {
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
    pub(crate) fn numbers(&mut self, fields: &[Option<f64>]) -> &mut Self {
        for field in fields {
            let text = field
                .filter(|v| v.is_finite())
                .map_or(String::new(), nine_digits);
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
    pub(crate) fn finish(mut self) -> String {
        self.end_row();
        self.text
    }
}

/// A number with at most nine significant digits, which is more than any figure shows.
fn nine_digits(value: f64) -> String {
    let rounded = format!("{value:.8e}").parse::<f64>().unwrap_or(value);
    if (1e-5..1e15).contains(&rounded.abs()) || rounded == 0.0 {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_nine_digits_at_most() {
        let cases = [
            (0.008_929_000_000_000_001, "0.008929"),
            (-1.0 / 3.0, "-0.333333333"),
            (3e-9, "3e-9"),
            (0.0, "0"),
        ];
        for (value, text) in cases {
            assert_eq!(nine_digits(value), text);
        }
    }

    #[test]
    fn fields_are_quoted_and_rows_filled() {
        let mut csv = Csv::new(&["a", "b", "c"]);
        csv.row().texts(&["x,y"]).numbers(&[Some(0.5)]);
        assert_eq!(csv.finish(), "a,b,c\n\"x,y\",0.5,\n");
    }
}
