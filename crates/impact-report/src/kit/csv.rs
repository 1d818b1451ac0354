//! Tables as CSV: of figures with the digits that one shows, of results with all.

use std::borrow::Cow;

use impact_records::signal::whole;

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

    /// Text fields, in quotes where they need them.
    pub fn texts(&mut self, fields: &[&str]) -> &mut Self {
        for field in fields {
            self.begin_field();
            self.text.push_str(&quoted(field));
        }
        self
    }

    /// Number fields of nine digits; missing ones stay empty.
    pub fn numbers(&mut self, fields: &[Option<f64>]) -> &mut Self {
        for field in fields {
            self.begin_field();
            if let Some(value) = field.filter(|v| v.is_finite()) {
                Decimal::of(value).write(&mut self.text);
            }
        }
        self
    }

    /// Number fields in the shortest form that reads back exactly; missing ones stay empty.
    pub fn exact(&mut self, fields: &[Option<f64>]) -> &mut Self {
        for field in fields {
            self.begin_field();
            if let Some(value) = field.filter(|v| v.is_finite()) {
                self.text.push_str(&value.to_string());
            }
        }
        self
    }

    fn begin_field(&mut self) {
        if self.filled > 0 {
            self.text.push(',');
        }
        self.filled += 1;
    }

    fn end_row(&mut self) {
        while self.filled < self.columns {
            self.begin_field();
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

/// A text as a field of a CSV file.
fn quoted(text: &str) -> Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(text)
    }
}

/// Digits of a number: more than any figure shows.
const DIGITS: usize = 9;

/// Powers of ten that a double holds exactly.
const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// A number rounded to nine significant digits.
struct Decimal {
    negative: bool,
    /// The digits; the first is not 0 unless all are.
    digits: [u8; DIGITS],
    /// Power of ten of the first digit.
    exponent: i32,
}

impl Decimal {
    fn of(value: f64) -> Self {
        Self::quick(value).unwrap_or_else(|| Self::exact(value))
    }

    /// By one multiplication; `None` where its rounding could change the last digit.
    fn quick(value: f64) -> Option<Self> {
        let size = value.abs();
        if !(1e-13..1e22).contains(&size) {
            return None;
        }
        let exponent = whole::integer(size.log10().floor());
        let places = i32::try_from(DIGITS).ok()? - 1 - exponent;
        let power = POWERS_OF_TEN.get(usize::try_from(places.abs()).ok()?)?;
        let scaled = if places < 0 {
            size / power
        } else {
            size * power
        };
        let rounded = scaled.round();
        let sure = (scaled - rounded).abs() < 0.499 && (1e8..1e9).contains(&rounded);
        let mut left = if sure {
            whole::count(rounded)
        } else {
            return None;
        };
        let mut digits = [b'0'; DIGITS];
        for digit in digits.iter_mut().rev() {
            *digit += u8::try_from(left % 10).ok()?;
            left /= 10;
        }
        Some(Self {
            negative: value.is_sign_negative(),
            digits,
            exponent,
        })
    }

    fn exact(value: f64) -> Self {
        let text = format!("{:.1$e}", value.abs(), DIGITS - 1);
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let mut digits = [b'0'; DIGITS];
        for (digit, c) in digits
            .iter_mut()
            .zip(mantissa.bytes().filter(|c| *c != b'.'))
        {
            *digit = c;
        }
        Self {
            negative: value.is_sign_negative(),
            digits,
            exponent: exponent.parse().unwrap_or(0),
        }
    }

    /// Appends the shortest text of the number; one below 1e-5 or from 1e15 on with its exponent.
    fn write(&self, text: &mut String) {
        if self.negative {
            text.push('-');
        }
        let used = self.digits.iter().rposition(|d| *d != b'0').unwrap_or(0) + 1;
        let digits = self.digits[..used].iter().map(|d| char::from(*d));
        let places = usize::try_from(self.exponent.unsigned_abs()).unwrap_or(usize::MAX);
        let zeros = |count: usize| std::iter::repeat_n('0', count);
        match self.exponent {
            -5..0 => {
                text.push_str("0.");
                text.extend(zeros(places - 1).chain(digits));
            }
            0..15 => {
                text.extend(digits.clone().take(places + 1));
                text.extend(zeros((places + 1).saturating_sub(used)));
                if used > places + 1 {
                    text.push('.');
                    text.extend(digits.skip(places + 1));
                }
            }
            exponent => {
                text.extend(digits.clone().take(1));
                if used > 1 {
                    text.push('.');
                    text.extend(digits.skip(1));
                }
                text.push_str(&format!("e{exponent}"));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nine_digits(value: f64) -> String {
        let mut text = String::new();
        Decimal::of(value).write(&mut text);
        text
    }

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
