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
    let text = format!("{value:.8e}");
    let parts = text.split_once('e').and_then(|(mantissa, exponent)| {
        let (first, others) = mantissa.split_once('.')?;
        let (sign, first) = first.split_at(first.len() - 1);
        Some((sign, first, others, exponent.parse::<i32>().ok()?))
    });
    let Some((sign, first, others, exponent)) = parts else {
        return text;
    };
    let others = others.trim_end_matches('0');
    let point = if others.is_empty() { "" } else { "." };
    let length = i32::try_from(others.len()).unwrap_or(i32::MAX);
    match usize::try_from(exponent.abs()) {
        Ok(places) if (-5..0).contains(&exponent) => {
            format!("{sign}0.{first:0>places$}{others}")
        }
        Ok(places) if (0..15).contains(&exponent) && exponent >= length => {
            format!("{sign}{first}{others:0<places$}")
        }
        Ok(places) if (0..15).contains(&exponent) => {
            let (whole, part) = others.split_at(places);
            format!("{sign}{first}{whole}.{part}")
        }
        _ => format!("{sign}{first}{point}{others}e{exponent}"),
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
            (-0.0, "-0"),
            (12.0, "12"),
            (1200.0, "1200"),
            (-12.5, "-12.5"),
            (0.012_5, "0.0125"),
            (1e-5, "0.00001"),
            (9.999_999_999e-6, "0.00001"),
            (-2.5e-6, "-2.5e-6"),
            (123_456_789_012.0, "123456789000"),
            (1e14, "100000000000000"),
            (1e15, "1e15"),
            (1.5e300, "1.5e300"),
        ];
        for (value, text) in cases {
            assert_eq!(nine_digits(value), text);
        }
    }

    #[test]
    fn prop_the_text_is_the_shortest_of_the_rounded_number() {
        let mut state = 7_u64;
        for _ in 0..5000 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let value = f64::from_bits(state);
            if !value.is_finite() {
                continue;
            }
            for value in [value, value.clamp(-9.9, 9.9), (value % 1e9).trunc()] {
                let rounded: f64 = format!("{value:.8e}").parse().unwrap();
                let exponent = rounded == 0.0 || (1e-5..1e15).contains(&rounded.abs());
                let shortest = if exponent {
                    format!("{rounded}")
                } else {
                    format!("{rounded:e}")
                };
                assert_eq!(nine_digits(value), shortest);
            }
        }
    }

    #[test]
    fn fields_are_quoted_and_rows_filled() {
        let mut csv = Csv::new(&["a", "b", "c"]);
        csv.row().texts(&["x,y"]).numbers(&[Some(0.5)]);
        assert_eq!(csv.finish(), "a,b,c\n\"x,y\",0.5,\n");
    }
}
