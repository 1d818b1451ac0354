//! How a report is printed: numbers with the reader's decimal sign, phrases and messages in the
//! reader's language.

use super::catalog::Catalog;
use super::phrase::{Phrase, Text, motion_text};
use impact_records::language::Language;
use impact_records::message::{Message, Print, filled, sentence, with_minus};
use impact_records::motion::Motion;
use impact_records::record::Role;
use impact_records::signal::digits::decimal_exponent;

/// What the reader chose about numbers and language.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Locale<'a> {
    /// Whether numbers have a decimal comma.
    pub decimal_comma: bool,
    /// Phrases and messages in the reader's language; `None`: English.
    pub catalog: Option<&'a Catalog>,
}

impl Locale<'_> {
    /// A phrase of the report in the reader's language.
    pub(crate) fn translate(self, phrase: Phrase) -> String {
        let text = match self.catalog {
            Some(catalog) => catalog.get(phrase),
            None => phrase.english(),
        };
        text.to_owned()
    }

    /// A phrase in the reader's language, with values for the names in braces.
    pub(crate) fn translate_with(self, phrase: Phrase, values: &[(&str, &str)]) -> String {
        filled(&self.translate(phrase), |name| {
            let value = values.iter().find(|v| v.0 == name)?;
            Some(value.1.to_owned())
        })
    }

    /// A text of a figure or a table.
    pub(crate) fn text(self, text: &Text) -> String {
        match text {
            Text::Phrase(phrase) => self.translate(*phrase),
            Text::Followed(phrase, rest) => self.translate(*phrase) + rest,
            Text::Role(role) => self.role(*role),
            Text::Boundary(kind) => self.message(kind),
            Text::Plain(text) => text.clone(),
        }
    }

    /// The label of a motion.
    pub(crate) fn motion(self, motion: &Motion) -> String {
        self.text(&motion_text(motion))
    }

    /// The name of what a channel measures.
    pub(crate) fn role(self, role: Role) -> String {
        self.message(&role)
    }

    /// A message in the reader's language, its symbols between dollars.
    pub fn message(self, message: &dyn Message) -> String {
        self.print(message)
    }

    /// A message as a sentence: a capital at its start, a full stop at its end.
    pub(crate) fn sentence(self, message: &dyn Message) -> String {
        sentence(&self.print(message))
    }

    /// Messages as sentences.
    pub(crate) fn sentences<'m, M: Message + 'm>(
        self,
        messages: impl IntoIterator<Item = &'m M>,
    ) -> String {
        let each = messages.into_iter().map(|m| self.sentence(m));
        each.collect::<Vec<_>>().join(" ")
    }

    /// The language of the texts, if it is one of the program's.
    pub(crate) fn language(self) -> Option<Language> {
        match self.catalog.and_then(|c| c.language.as_deref()) {
            Some(code) => Language::of_code(code),
            None => Some(Language::default()),
        }
    }

    /// A range in words.
    pub(crate) fn range(self, first: &str, last: &str) -> String {
        self.translate_with(Phrase::Range, &[("first", first), ("last", last)])
    }

    /// A number with a fixed count of decimals, a true minus and the chosen decimal sign.
    pub fn fixed(self, value: f64, decimals: usize) -> String {
        self.digits(&format!("{value:.decimals$}"))
    }

    /// Digits as Rust writes them, with a true minus and the chosen decimal sign.
    pub fn digits(self, text: &str) -> String {
        let text = with_minus(text);
        if self.decimal_comma {
            text.replace('.', ",")
        } else {
            text
        }
    }

    /// A clearance in mm, to the micrometre, without its unit.
    pub(crate) fn clearance(self, clearance_m: f64) -> String {
        self.fixed(1e3 * clearance_m, 3)
    }

    /// A number with a count of significant digits; powers of ten where it is very large or small.
    pub(crate) fn significant(self, value: f64, digits: usize) -> String {
        if value == 0.0 || !value.is_finite() {
            return if value == 0.0 {
                "0".into()
            } else {
                "–".into()
            };
        }
        let exponent = decimal_exponent(value, whole_digits(digits));
        if (-4..6).contains(&exponent) {
            let decimals = usize::try_from(whole_digits(digits) - 1 - exponent).unwrap_or(0);
            self.fixed(value, decimals)
        } else {
            let mantissa = self.fixed(value / 10f64.powi(exponent), digits.saturating_sub(1));
            format!("{mantissa}\u{2009}·\u{2009}10{}", superscript(exponent))
        }
    }
}

impl Print for Locale<'_> {
    fn template(&self, message: &dyn Message) -> String {
        let template = match self.catalog {
            Some(catalog) => catalog.template(message),
            None => message.template(Language::default()),
        };
        template.to_owned()
    }

    fn number(&self, digits: String) -> String {
        self.digits(&digits)
    }

    fn name(&self, name: &str) -> String {
        // a dollar would begin a symbol
        name.replace('$', "\u{ff04}")
    }
}

/// A count of digits, of which a number has few.
fn whole_digits(digits: usize) -> i32 {
    i32::try_from(digits).unwrap_or(i32::MAX)
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
    use impact_fit::{Item, Remark};

    #[test]
    fn numbers_are_printed_as_books_do() {
        let point = Locale::default();
        assert_eq!(point.fixed(-0.0004, 2), "0.00");
        assert_eq!(point.fixed(-1.25, 2), "\u{2212}1.25");
        assert_eq!(point.significant(0.999_96, 4), "1.000");
        assert_eq!(point.significant(12.3456, 3), "12.3");
        assert_eq!(point.significant(1.5e-7, 2), "1.5\u{2009}·\u{2009}10⁻⁷");
        let comma = Locale {
            decimal_comma: true,
            catalog: None,
        };
        assert_eq!(comma.fixed(1.5, 1), "1,5");
    }

    #[test]
    fn phrases_are_translated_and_units_stay() {
        let text = "[words]\n\"clearance $r$\" = \"Weite $r$\"\n\"{first} to {last}\" = \"bis {last} ab {first}\"";
        let catalog = Catalog::read(text).expect("a catalog");
        let locale = Locale {
            catalog: Some(&catalog),
            ..Locale::default()
        };
        let title = locale.text(&(Phrase::Clearance, "mm").into());
        assert_eq!(title, "Weite $r$ (mm)");
        assert_eq!(
            locale.range("two {last}", "three"),
            "bis three ab two {last}"
        );
        assert_eq!(locale.translate(Phrase::Drive), "drive");
    }

    #[test]
    fn messages_are_printed_in_the_reader_s_language_and_decimal_sign() {
        let catalog = Catalog::of(Language::of_code("de").expect("German"));
        let german = Locale {
            decimal_comma: true,
            catalog: Some(&catalog),
        };
        let remark = Remark::WaveformsUnexplained { share: 0.0123 };
        assert_eq!(
            german.sentence(&remark),
            "Die simulierten Verläufe lassen 1,23 % der gemessenen unerklärt."
        );
        assert_eq!(
            Locale::default().sentence(&remark),
            "The simulated waveforms leave 1.23 % of the measured ones unexplained."
        );
        let item = Item::Record {
            index: 0,
            record: "a$b".into(),
        };
        assert!(!Locale::default().message(&item).contains('$'));
    }
}
