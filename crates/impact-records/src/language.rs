//! The languages of the program: each is one file in the folder `texts`, embedded in the program.
//!
//! A file contains the templates of all messages and phrases, by table and key, and what else depends
//! on the language: the decimal sign, and the words of run tables. A new language is a new file and its
//! line in `embedded!`; tests compare its tables, keys and names in braces with those of English.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

/// A file of texts, read when its first text is wanted.
struct Embedded {
    /// ISO 639-1.
    code: &'static str,
    /// In English.
    name: &'static str,
    texts: LazyLock<Texts>,
}

/// The static with all files of the folder `texts`, by code and name.
macro_rules! embedded {
    ($($code:literal = $name:literal;)+) => {
        /// All languages; what a file lacks is taken from the first.
        static FILES: [Embedded; [$($code),+].len()] = [$(Embedded {
            code: $code,
            name: $name,
            texts: LazyLock::new(|| read(include_str!(concat!("../texts/", $code, ".toml")))),
        }),+];
    };
}

embedded! {
    "en" = "English";
    "de" = "German";
}

/// What a file contains.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Texts {
    decimal_comma: bool,
    capital_nouns: bool,
    run_table: RunTableWords,
    text: BTreeMap<String, BTreeMap<String, String>>,
}

/// Words of a language in run tables, in small letters.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RunTableWords {
    /// From the name of a column to its other headings.
    pub columns: BTreeMap<String, Vec<String>>,
    /// From a word of a cell to its other forms.
    pub words: BTreeMap<String, Vec<String>>,
    /// Headings of clearances that are whole gaps between two masses.
    pub whole_gaps: Vec<String>,
    /// How the headings of remarks begin.
    pub remarks: Vec<String>,
}

/// An embedded file; a test requires that each can be read.
fn read(text: &str) -> Texts {
    toml::from_str(text).unwrap_or_default()
}

/// A language of the program; English by default.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Language(usize);

impl Language {
    /// All languages, English first.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..FILES.len()).map(Self)
    }

    /// The language of an ISO 639-1 code.
    pub fn of_code(code: &str) -> Option<Self> {
        Self::all().find(|language| language.code() == code)
    }

    /// ISO 639-1 code.
    pub fn code(self) -> &'static str {
        FILES[self.0].code
    }

    /// Name in English.
    pub fn name(self) -> &'static str {
        FILES[self.0].name
    }

    /// Whether numbers have a decimal comma.
    pub fn decimal_comma(self) -> bool {
        self.texts().decimal_comma
    }

    /// Whether a noun inside a sentence keeps its capital.
    pub fn capital_nouns(self) -> bool {
        self.texts().capital_nouns
    }

    /// Words in run tables.
    pub fn run_table(self) -> &'static RunTableWords {
        &self.texts().run_table
    }

    /// The text of a key in a table: the English one where the language has none, else the key.
    pub fn text<'a>(self, table: &str, key: &'a str) -> &'a str {
        let own = self.own_text(table, key);
        own.or_else(|| Self::default().own_text(table, key))
            .unwrap_or(key)
    }

    /// The text of a key in a table, if the language's file has it.
    pub fn own_text(self, table: &str, key: &str) -> Option<&'static str> {
        self.texts().text.get(table)?.get(key).map(String::as_str)
    }

    /// The tables of texts in the language's file, and their keys.
    pub fn tables(self) -> impl Iterator<Item = (&'static str, Vec<&'static str>)> {
        let tables = self.texts().text.iter();
        tables.map(|(name, keys)| (name.as_str(), keys.keys().map(String::as_str).collect()))
    }

    fn texts(self) -> &'static Texts {
        &FILES[self.0].texts
    }
}

/// The names in braces of a template; between dollars braces belong to the symbol.
pub fn names(template: &str) -> impl Iterator<Item = &str> {
    let texts = template.split('$').step_by(2);
    let pieces = texts.flat_map(|text| text.split('{').skip(1));
    pieces.filter_map(|piece| Some(piece.split_once('}')?.0))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// No text is missing in a language and none is superfluous, and all have the values of the English ones
    /// and whole symbols.
    #[test]
    fn every_language_has_the_texts_of_english() {
        let english = Language::default();
        assert_eq!(english.code(), "en");
        let tables: Vec<_> = english.tables().collect();
        assert!(tables.len() > 15);
        for language in Language::all() {
            assert_eq!(Language::of_code(language.code()), Some(language));
            let own: Vec<_> = language.tables().collect();
            assert_eq!(own, tables, "{}", language.name());
            for (table, keys) in &own {
                for key in keys {
                    let place = format!("{}: [text.{table}] {key}", language.name());
                    let text = language.text(table, key);
                    let wanted: BTreeSet<&str> = names(english.text(table, key)).collect();
                    assert_eq!(names(text).collect::<BTreeSet<_>>(), wanted, "{place}");
                    assert_eq!(text.matches('$').count() % 2, 0, "{place}");
                    assert!(!text.is_empty() && text.trim_end() == text, "{place}");
                }
            }
        }
    }

    /// The words of a table of run tables, by language.
    fn of_all(of: Of) -> impl Iterator<Item = (Language, &'static BTreeMap<String, Vec<String>>)> {
        Language::all().map(move |language| (language, of(language.run_table())))
    }

    type Of = fn(&'static RunTableWords) -> &'static BTreeMap<String, Vec<String>>;

    /// Columns, and words of cells.
    const TABLES: [Of; 2] = [|table| &table.columns, |table| &table.words];

    #[test]
    fn every_language_has_words_for_the_same_columns_and_cells() {
        for of in TABLES {
            let english: Vec<&String> = of(Language::default().run_table()).keys().collect();
            assert!(english.len() >= 5);
            for (language, table) in of_all(of) {
                let own: Vec<&String> = table.keys().collect();
                assert_eq!(own, english, "{}", language.name());
                assert!(table.values().all(|words| !words.is_empty()));
            }
        }
    }

    #[test]
    fn no_word_of_run_tables_has_two_meanings() {
        for of in TABLES {
            let mut meanings = BTreeMap::new();
            for (language, table) in of_all(of) {
                let named = table.iter().flat_map(|(name, words)| {
                    let own = words.iter().chain([name]);
                    own.map(move |word| (word, name))
                });
                for (word, name) in named {
                    assert_eq!(*word, word.trim().to_lowercase(), "{}", language.name());
                    let other = *meanings.entry(word).or_insert(name);
                    assert_eq!(other, name, "{word} in {}", language.name());
                }
            }
        }
    }

    #[test]
    fn a_text_without_a_translation_is_english_and_without_a_text_its_key() {
        let german = Language::of_code("de").expect("German");
        assert_eq!(german.text("method", "resonance_curve"), "Resonanzkurve");
        assert_eq!(german.text("method", "guess"), "guess");
        assert!(german.decimal_comma() && german.capital_nouns());
        assert!(Language::of_code("xx").is_none());
    }
}
