//! How the report speaks: numbers with the reader's decimal sign, phrases in the reader's words.

use super::words::Words;

/// What the reader chose about numbers and words.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Speech<'a> {
    /// Whether numbers have a decimal comma.
    pub decimal_comma: bool,
    /// The reader's words for the English phrases.
    pub words: Option<&'a Words>,
}

impl Speech<'_> {
    /// A phrase in the reader's words.
    pub fn say(self, phrase: &str) -> String {
        let words = self.words.map_or(phrase, |words| words.get(phrase));
        words.to_owned()
    }

    /// A phrase in the reader's words, with values for the names in braces.
    pub fn say_with(self, phrase: &str, values: &[(&str, &str)]) -> String {
        let mut rest = self.say(phrase);
        let mut text = String::new();
        while let Some((before, after)) = rest.split_once('{') {
            let Some((name, after)) = after.split_once('}') else {
                break;
            };
            text.push_str(before);
            match values.iter().find(|v| v.0 == name) {
                Some((_, value)) => text.push_str(value),
                None => text.push_str(&format!("{{{name}}}")),
            }
            rest = after.to_owned();
        }
        text.push_str(&rest);
        text
    }

    /// What another room says, in the reader's words as far as their table knows its sentences.
    pub fn tell(self, text: &str) -> String {
        self.words
            .map_or_else(|| text.to_owned(), |words| words.tell(text))
    }

    /// A range in words.
    pub fn range(self, first: &str, last: &str) -> String {
        self.say_with("{first} to {last}", &[("first", first), ("last", last)])
    }

    /// A title whose end in brackets, a unit or a count, is no part of the phrase.
    pub fn say_title(self, title: &str) -> String {
        let whole = self.say(title);
        match title.rfind('(') {
            Some(at) if title.ends_with(')') && whole == title => {
                let phrase = title[..at].trim_end();
                format!("{}{}", self.say(phrase), &title[phrase.len()..])
            }
            _ => whole,
        }
    }

    /// Words of other rooms, their numbers with the chosen decimal sign.
    pub fn localised(self, text: &str) -> String {
        if !self.decimal_comma {
            return text.to_owned();
        }
        let letters: Vec<char> = text.chars().collect();
        let digit = |i: Option<usize>| {
            let letter = i.and_then(|i| letters.get(i));
            letter.is_some_and(char::is_ascii_digit)
        };
        let each = letters.iter().enumerate().map(|(i, letter)| {
            let decimal = *letter == '.' && digit(i.checked_sub(1)) && digit(Some(i + 1));
            if decimal { ',' } else { *letter }
        });
        each.collect()
    }

    /// A number with a fixed count of decimals, a true minus and the chosen decimal sign.
    pub fn fixed(self, value: f64, decimals: usize) -> String {
        let text = format!("{value:.decimals$}");
        let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
        let text = if is_zero {
            text.replace('-', "")
        } else {
            text.replace('-', "\u{2212}")
        };
        self.with_decimal_sign(&text)
    }

    /// A number with a count of significant digits; powers of ten where it is very large or small.
    pub fn significant(self, value: f64, digits: usize) -> String {
        if value == 0.0 || !value.is_finite() {
            return if value == 0.0 {
                "0".into()
            } else {
                "–".into()
            };
        }
        let exponent = decimal_exponent(value, digits);
        if (-4..6).contains(&exponent) {
            let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
            self.fixed(value, decimals)
        } else {
            let mantissa = self.fixed(value / 10f64.powi(exponent), digits.saturating_sub(1));
            format!("{mantissa}\u{2009}·\u{2009}10{}", superscript(exponent))
        }
    }

    fn with_decimal_sign(self, text: &str) -> String {
        if self.decimal_comma {
            text.replace('.', ",")
        } else {
            text.to_owned()
        }
    }
}

/// Exponent of ten of a number once rounded to some digits (0.99996 to four digits is 1.000).
pub fn decimal_exponent(value: f64, digits: usize) -> i32 {
    let exponent = value.abs().log10().floor() as i32;
    let rounded = (value.abs() / 10f64.powi(exponent - digits as i32 + 1)).round();
    exponent + i32::from(rounded >= 10f64.powi(digits as i32))
}

/// An exponent in raised digits.
fn superscript(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    exponent
        .to_string()
        .chars()
        .map(|c| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize]))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_numbers_are_printed_as_books_do() {
        let point = Speech::default();
        assert_eq!(point.fixed(-0.0004, 2), "0.00");
        assert_eq!(point.fixed(-1.25, 2), "\u{2212}1.25");
        assert_eq!(point.significant(0.999_96, 4), "1.000");
        assert_eq!(point.significant(12.3456, 3), "12.3");
        assert_eq!(point.significant(1.5e-7, 2), "1.5\u{2009}·\u{2009}10⁻⁷");
        assert_eq!(
            Speech {
                decimal_comma: true,
                words: None
            }
            .fixed(1.5, 1),
            "1,5"
        );
    }
    #[test]
    fn valid_words_stand_for_phrases_and_units_stay() {
        let words = "[words]\n\"clearance $r$\" = \"Spiel $r$\"\n\"{a} of {b}\" = \"von {b} {a}\"";
        let words = Words::read(words).expect("a table of words");
        let look = Speech {
            words: Some(&words),
            ..Speech::default()
        };
        assert_eq!(look.say_title("clearance $r$ (mm)"), "Spiel $r$ (mm)");
        assert_eq!(look.say_title("residual\n(mm)"), "residual\n(mm)");
        let values = [("a", "two {b}"), ("b", "three")];
        assert_eq!(look.say_with("{a} of {b}", &values), "von three two {b}");
    }
}
