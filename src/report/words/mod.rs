//! The report's words in another language: a table from each English phrase, as it stands in the
//! source, to the reader's; and from each sentence of the other rooms, by its template.

mod sentences;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

use sentences::{Part, Sentences};

/// The German words, whose phrases are at the same time all that a report can say of its own.
const GERMAN: &str = include_str!("../words-de.toml");

/// Phrases and what is printed instead of them.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Words {
    /// The language, as ISO 639-1 writes it.
    pub language: Option<String>,
    /// From the English phrase to the one printed.
    words: BTreeMap<String, String>,
    /// From the template of an English sentence of another room to that of the one printed.
    #[serde(default)]
    sentences: Sentences,
}

/// Why a table of words cannot be used.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum WordsError {
    /// It is no TOML, or has other tables.
    #[error(
        "it is no table of words: {0}; it holds language = \"de\" and below [words] \"phrase\" = \"its translation\""
    )]
    Form(String),
    /// A number or name that the phrase carries would be lost, or one is wanted that it has not.
    #[error(
        "\"{phrase}\" carries {wanted}, its translation carries {found}; write the same names in braces"
    )]
    Places {
        /// The English phrase.
        phrase: String,
        /// What stands in braces there.
        wanted: String,
        /// What stands in braces in its translation.
        found: String,
    },
    /// A dollar without its fellow.
    #[error("the translation of \"{0}\" has a $ without the second that ends the symbol")]
    Symbol(String),
}

impl Words {
    /// Reads a table of words.
    ///
    /// # Errors
    /// Where it is no such table, or a translation does not carry what its phrase carries.
    pub fn read(text: &str) -> Result<Self, WordsError> {
        let form = |e: toml::de::Error| WordsError::Form(e.to_string().trim().replace('\n', " "));
        let words: Self = toml::from_str(text).map_err(form)?;
        for (phrase, translation) in words.words.iter().chain(&words.sentences) {
            let (wanted, found) = (places(phrase), places(translation));
            if wanted != found {
                return Err(WordsError::Places {
                    phrase: phrase.clone(),
                    wanted: listed(&wanted),
                    found: listed(&found),
                });
            }
            if translation.matches('$').count() % 2 == 1 {
                return Err(WordsError::Symbol(phrase.clone()));
            }
        }
        Ok(words)
    }

    /// The German words that come with the program.
    pub fn german() -> &'static Self {
        static WORDS: OnceLock<Words> = OnceLock::new();
        WORDS.get_or_init(|| Self::read(GERMAN).unwrap_or_default())
    }

    /// Every English phrase that a report can say of its own, in order.
    pub fn phrases() -> impl Iterator<Item = &'static str> {
        Self::german().words.keys().map(String::as_str)
    }

    /// The template of every English sentence of other rooms that a report can say again, in order.
    pub fn sentences() -> impl Iterator<Item = &'static str> {
        Self::german().sentences.keys().map(String::as_str)
    }

    /// A table to be filled in: every phrase and sentence with the English as its translation.
    pub fn blank() -> String {
        let line = |phrase: &str| {
            let quoted = toml::Value::from(phrase).to_string();
            format!("{quoted} = {quoted}\n")
        };
        let words: String = Self::phrases().map(line).collect();
        let sentences: String = Self::sentences().map(line).collect();
        format!("language = \"en\"\n\n[words]\n{words}\n[sentences]\n{sentences}")
    }

    /// What is printed for a phrase; the phrase itself where the table lacks it.
    pub fn get<'a>(&'a self, phrase: &'a str) -> &'a str {
        self.words.get(phrase).map_or(phrase, String::as_str)
    }

    /// What another room says, sentence by sentence in the reader's words; what no template of the
    /// table knows stays as it is.
    pub fn tell(&self, text: &str) -> String {
        sentences::tell(&self.sentences, text)
    }

    /// What is to be told of a table: phrases that it lacks, and those that no report says.
    pub fn remarks(&self) -> Vec<String> {
        let known: BTreeSet<&str> = Self::phrases().chain(Self::sentences()).collect();
        let here = self.words.keys().chain(self.sentences.keys());
        let here: BTreeSet<&str> = here.map(String::as_str).collect();
        let lacking: Vec<&str> = known.difference(&here).copied().collect();
        let idle: Vec<&str> = here.difference(&known).copied().collect();
        let mut remarks = Vec::new();
        if !lacking.is_empty() {
            remarks.push(format!(
                "the table of words lacks {} of a report's phrases, which stay English: {}",
                lacking.len(),
                some(&lacking)
            ));
        }
        if !idle.is_empty() {
            remarks.push(format!(
                "no report says {} of the phrases in the table of words (impactid report \
                 --list-words prints those it says): {}",
                idle.len(),
                some(&idle)
            ));
        }
        remarks
    }
}

/// The names in braces.
pub(super) fn places(phrase: &str) -> BTreeSet<&str> {
    // between dollars braces belong to the symbol
    let text = phrase.split('$').step_by(2);
    let parts = text.flat_map(parts_of);
    let name = |part| match part {
        Part::Place(name) => Some(name),
        Part::Words(_) => None,
    };
    parts.filter_map(name).collect()
}

/// A text without symbols as words and places, by turns.
fn parts_of(text: &str) -> Vec<Part<'_>> {
    let mut parts = Vec::new();
    let mut left = text;
    while let Some((words, (name, rest))) = left
        .split_once('{')
        .and_then(|(words, rest)| Some((words, rest.split_once('}')?)))
    {
        if !words.is_empty() {
            parts.push(Part::Words(words));
        }
        parts.push(Part::Place(name));
        left = rest;
    }
    if !left.is_empty() {
        parts.push(Part::Words(left));
    }
    parts
}

/// The first few phrases.
fn some(phrases: &[&str]) -> String {
    /// Phrases that are named at most.
    const FEW: usize = 3;
    let first: Vec<String> = phrases
        .iter()
        .take(FEW)
        .map(|p| format!("\"{p}\""))
        .collect();
    let more = if phrases.len() > FEW { " …" } else { "" };
    format!("{}{more}", first.join(", "))
}

fn listed(names: &BTreeSet<&str>) -> String {
    let each: Vec<String> = names.iter().map(|n| format!("{{{n}}}")).collect();
    if each.is_empty() {
        "nothing in braces".into()
    } else {
        each.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_german_is_a_table_and_blank_lists_its_phrases() {
        Words::read(GERMAN).expect("a table of words");
        let blank = Words::read(&Words::blank()).expect("a table of words");
        assert!(blank.words.iter().all(|(a, b)| a == b));
        assert!(blank.words.keys().eq(Words::german().words.keys()));
        assert!(
            blank
                .sentences
                .iter()
                .all(|(a, b)| a == b && !a.contains(". "))
        );
        assert!(blank.sentences.keys().eq(Words::german().sentences.keys()));
        assert!(blank.remarks().is_empty());
    }

    #[test]
    fn valid_a_translation_carries_what_its_phrase_carries() {
        let read = |line: &str| Words::read(&format!("[words]\n{line}\n"));
        assert!(read("\"{a} of {b}\" = \"{b}: {a}\"").is_ok());
        let lost = read("\"{a} of {b}\" = \"{a}\"").expect_err("b is lost");
        assert!(
            lost.to_string()
                .contains("carries {a}, {b}, its translation carries {a}"),
            "{lost}"
        );
        assert!(read("\"$x_{st}$ (mm)\" = \"$x_{st}$ in mm\"").is_ok());
        assert!(matches!(read("\"a\" = \"$b\""), Err(WordsError::Symbol(_))));
        assert!(matches!(Words::read("words = 3"), Err(WordsError::Form(_))));
    }

    #[test]
    fn valid_lacking_and_idle_phrases_are_told_once() {
        let words = Words::read("[words]\n\"no such phrase\" = \"x\"\n").expect("a table");
        let remarks = words.remarks();
        assert_eq!(remarks.len(), 2);
        assert!(remarks[0].contains("stay English") && remarks[1].contains("no such phrase"));
        assert_eq!(words.get("some text"), "some text");
    }
}
