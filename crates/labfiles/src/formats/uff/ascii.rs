//! Numbers written as text by Fortran programs.

use crate::text::number;

/// Longest word that is accepted, bytes.
const LONGEST: usize = 64;

/// Why a number could not be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NoNumber {
    /// Offset of the offending byte.
    pub at: usize,
}

/// Reads numbers from text, one after the other.
///
/// Numbers are separated by blanks or line ends, or by their sign alone, as where a Fortran field
/// is full (`-1.5E+00-2.5E+00`). Exponents are spelt E, e, D or d, or only by their sign
/// (`1.5-100`).
#[derive(Debug, Clone)]
pub(super) struct Numbers<'a> {
    text: &'a [u8],
    at: usize,
}

impl<'a> Numbers<'a> {
    /// Start at the front of a text.
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { text, at: 0 }
    }

    #[inline]
    fn peek(&self, at: usize) -> u8 {
        self.text.get(at).copied().unwrap_or(b' ')
    }

    #[inline]
    fn skip_blanks(&mut self) {
        while self
            .text
            .get(self.at)
            .is_some_and(|b| matches!(b, b' ' | b'\n' | b'\r' | b'\t'))
        {
            self.at += 1;
        }
    }

    /// The number at the present place, which is no blank.
    #[inline]
    fn number(&mut self) -> Result<f64, NoNumber> {
        let Some((value, end)) = number::parse_at(self.text, self.at, b'.') else {
            return self.word();
        };
        match self.peek(end) {
            b' ' | b'\n' | b'\r' | b'\t' => {}
            b'-' | b'+' => return Ok(self.before_sign(value, end)),
            _ => return Err(NoNumber { at: end }),
        }
        self.at = end;
        Ok(value)
    }

    /// A number that a sign follows: it is an exponent's before three digits (`1.5-100`), else the
    /// next number begins.
    #[cold]
    fn before_sign(&mut self, value: f64, end: usize) -> f64 {
        let field = &self.text[self.at..end];
        let digits = self.text[end + 1..].iter();
        let digits = digits.take_while(|b| b.is_ascii_digit()).count();
        let lettered = field.iter().any(u8::is_ascii_alphabetic);
        if digits != 3 || lettered || self.peek(end + 4) == b'.' {
            self.at = end;
            return value;
        }
        let text = [field, b"e", &self.text[end..end + 4]].concat();
        self.at = end + 4;
        number::parse_prefix(&text, b'.').map_or(value, |(value, _)| value)
    }

    /// Not a number, or infinity, as programs write them.
    #[cold]
    fn word(&mut self) -> Result<f64, NoNumber> {
        let start = self.at;
        let length = self.text[start..]
            .iter()
            .take(LONGEST)
            .take_while(|b| !b.is_ascii_whitespace());
        let word = &self.text[start..start + length.count()];
        let word = String::from_utf8_lossy(word).to_ascii_lowercase();
        let value = match word.trim_start_matches(['+', '-']) {
            "nan" | "nan(ind)" | "1.#ind" | "1.#qnan" => f64::NAN,
            "inf" | "infinity" => f64::INFINITY,
            _ => return Err(NoNumber { at: start }),
        };
        self.at += word.len();
        Ok(if word.starts_with('-') { -value } else { value })
    }

    /// Append up to `most` numbers; fewer where the text ends.
    pub(super) fn take(&mut self, most: usize, out: &mut Vec<f64>) -> Result<(), NoNumber> {
        for _ in 0..most {
            self.skip_blanks();
            if self.at >= self.text.len() {
                break;
            }
            out.push(self.number()?);
        }
        Ok(())
    }

    /// How many numbers are left; stops at what is none.
    pub(super) fn count(mut self) -> Result<u64, NoNumber> {
        let mut count = 0;
        loop {
            self.skip_blanks();
            if self.at >= self.text.len() {
                return Ok(count);
            }
            self.number()?;
            count += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn all(text: &str) -> Result<Vec<f64>, NoNumber> {
        let mut out = Vec::new();
        Numbers::new(text.as_bytes())
            .take(usize::MAX, &mut out)
            .map(|()| out)
    }

    #[test]
    fn fields_as_instruments_write_them() {
        assert_eq!(
            all(" -1.47553E-02 -1.72957e-02\r\n 5.").unwrap(),
            [-0.0147553, -0.0172957, 5.0]
        );
        assert_eq!(
            all("-1.11111E+00-2.5D+01+3.5d0").unwrap(),
            [-1.11111, -25.0, 3.5]
        );
        assert_eq!(all("1.5-100 -2.5+003").unwrap(), [1.5e-100, -2500.0]);
        assert_eq!(
            all("1.00000E-023 9.99999E+299").unwrap(),
            [1e-23, 9.99999e299]
        );
        assert_eq!(
            all("0.123456789012345678D+01").unwrap(),
            [1.2345678901234567]
        );
        assert!(all("NaN -inf").unwrap()[0].is_nan());
        assert!(all("").unwrap().is_empty());
    }

    #[test]
    fn what_is_no_number_is_refused_at_its_byte() {
        assert_eq!(all("1.0 x"), Err(NoNumber { at: 4 }));
        assert_eq!(all("1.0E"), Err(NoNumber { at: 3 }));
        assert_eq!(all("1.00000E+001.5"), Err(NoNumber { at: 12 }));
        assert_eq!(all("1,5"), Err(NoNumber { at: 1 }));
        assert_eq!(all("- 5"), Err(NoNumber { at: 0 }));
    }

    proptest! {
        #[test]
        fn prop_numbers_equal_the_standard_parsers(mantissa in -9_999_999i64..=9_999_999, places in 0u32..7, exponent in -310i32..310) {
            let text = format!("{}.{:0width$}E{exponent:+03}", mantissa / 1000, mantissa.unsigned_abs() % 1000, width = places.max(3) as usize);
            prop_assert_eq!(all(&text).unwrap(), [text.parse::<f64>().unwrap()]);
        }

        #[test]
        fn prop_fortran_fields_equal_the_standard_parsers(bits: u64) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            for text in [format!("{value:.5E}"), format!("{value:.12e}"), format!("{value:.16e}")] {
                prop_assert_eq!(all(&text).unwrap(), [text.parse::<f64>().unwrap()]);
            }
        }

        #[test]
        fn prop_any_text_is_read_or_refused(text: Vec<u8>) {
            let mut out = Vec::new();
            let _ = Numbers::new(&text).take(usize::MAX, &mut out);
            let _ = Numbers::new(&text).count();
        }
    }
}
