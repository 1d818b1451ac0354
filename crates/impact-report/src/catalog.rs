//! The report's texts in another language: a table from each English phrase of the report to the
//! reader's, and from each kind of message of the identification to its template.

use std::collections::{BTreeMap, BTreeSet};

use super::phrase::Phrase;
use impact_fit::messages;
use impact_identification::compare;
use impact_records::language::{Language, names};
use impact_records::message::Message;

/// Phrases and messages, and what is printed instead of their English.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Catalog {
    /// The language, as ISO 639-1 writes it.
    pub language: Option<String>,
    /// From the English phrase to the one printed.
    words: BTreeMap<String, String>,
    /// From the key of a message to its template.
    #[serde(default)]
    findings: BTreeMap<String, String>,
}

/// Why a catalog cannot be used.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum CatalogError {
    /// It is no TOML, or has other tables.
    #[error(
        "it is no table of words: {0}; it has language = \"de\", below [words] \"phrase\" = \"its translation\", and below [findings] kind = \"template\""
    )]
    Form(String),
    /// A value that the phrase has would be lost, or one is wanted that it does not have.
    #[error(
        "\"{phrase}\" has {wanted}, its translation has {found}; write the same names in braces"
    )]
    Values {
        /// The English phrase, or the key of the message.
        phrase: String,
        /// The names in braces in it.
        wanted: String,
        /// The names in braces in its translation.
        found: String,
    },
    /// A dollar without a second.
    #[error("the translation of \"{0}\" has a $ without the second that ends the symbol")]
    Symbol(String),
}

impl Catalog {
    /// Reads a catalog.
    ///
    /// # Errors
    /// If it is none, or a translation does not have the values of its phrase.
    pub fn read(text: &str) -> Result<Self, CatalogError> {
        let form = |e: toml::de::Error| CatalogError::Form(e.to_string().trim().replace('\n', " "));
        let catalog: Self = toml::from_str(text).map_err(form)?;
        for (phrase, translation) in &catalog.words {
            check(phrase, phrase, translation)?;
        }
        let messages = messages();
        for (key, translation) in &catalog.findings {
            let english = messages.get(key.as_str());
            check(key, english.copied().unwrap_or(translation), translation)?;
        }
        Ok(catalog)
    }

    /// The catalog of a language of the program: it has no words of its own, as the language has all.
    pub fn of(language: Language) -> Self {
        Self {
            language: Some(language.code().to_owned()),
            ..Self::default()
        }
    }

    /// Every English phrase of a report, in order.
    pub fn phrases() -> BTreeSet<&'static str> {
        let labels = messages::labels().into_iter();
        let labels = labels.map(|label| label.template(Language::default()));
        let phrases = Phrase::ALL.iter().map(|p| p.english());
        phrases.chain(labels).collect()
    }

    /// The language of texts that the catalog does not have.
    fn fallback(&self) -> Language {
        let code = self.language.as_deref();
        code.and_then(Language::of_code).unwrap_or_default()
    }

    /// A catalog to be filled in: every phrase and every message with its English.
    pub fn blank() -> String {
        let quoted = |text: &str| toml::Value::from(text).to_string();
        let line = |phrase: &str| format!("{0} = {0}\n", quoted(phrase));
        let words: String = Self::phrases().into_iter().map(line).collect();
        let messages = messages();
        let message = |(key, english): (&String, &&str)| format!("{key} = {}\n", quoted(english));
        let findings: String = messages.iter().map(message).collect();
        format!("language = \"en\"\n\n[words]\n{words}\n[findings]\n{findings}")
    }

    /// What is printed for a phrase: the catalog's words, else those of the program.
    pub fn get(&self, phrase: Phrase) -> &str {
        let own = self.words.get(phrase.english()).map(String::as_str);
        own.unwrap_or_else(|| phrase.text(self.fallback()))
    }

    /// The template of a message: that of its key in the catalog, else the translation of its English
    /// template, else the program's in the catalog's language, else the English one.
    pub fn template<'a>(&'a self, message: &dyn Message) -> &'a str {
        let keyed = if self.findings.is_empty() {
            None
        } else {
            self.findings.get(&message.key())
        };
        let own = keyed.or_else(|| self.words.get(message.template(Language::default())));
        own.map_or_else(|| message.template(self.fallback()), String::as_str)
    }

    /// What is to be known of a catalog: phrases that it lacks, and entries that no report uses.
    pub fn remarks(&self) -> Vec<String> {
        let phrases = Self::phrases();
        let here: BTreeSet<&str> = self.words.keys().map(String::as_str).collect();
        let messages = messages();
        let lacking = phrases.difference(&here).copied();
        let lacking: Vec<&str> = lacking
            .filter(|_| self.fallback() == Language::default())
            .collect();
        let unknown = self.findings.keys().map(String::as_str);
        let unknown = unknown.filter(|key| !messages.contains_key(*key));
        let templates: BTreeSet<&str> = messages.values().copied().collect();
        let idle = here.difference(&phrases).copied();
        let idle = idle.filter(|phrase| !templates.contains(phrase));
        let idle: Vec<&str> = idle.chain(unknown).collect();
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
                "no report uses {} of the entries of the table of words (impactid report \
                 --list-words prints those it uses): {}",
                idle.len(),
                some(&idle)
            ));
        }
        remarks
    }
}

/// The English template of every message, by its key.
fn messages() -> BTreeMap<String, &'static str> {
    let identified = messages::kinds();
    let each = identified.into_iter().chain(compare::kinds());
    each.map(|m| (m.key(), m.template(Language::default())))
        .collect()
}

/// Checks that a translation has the values of its phrase, and whole symbols.
fn check(name: &str, phrase: &str, translation: &str) -> Result<(), CatalogError> {
    let places = |text| names(text).collect::<BTreeSet<&str>>();
    let (wanted, found) = (places(phrase), places(translation));
    if wanted != found {
        return Err(CatalogError::Values {
            phrase: name.to_owned(),
            wanted: listed(&wanted),
            found: listed(&found),
        });
    }
    match translation.matches('$').count() % 2 {
        0 => Ok(()),
        _ => Err(CatalogError::Symbol(name.to_owned())),
    }
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
    fn every_phrase_has_its_texts_and_blank_lists_phrases_and_all_messages() {
        let german = Catalog::of(Language::of_code("de").expect("German"));
        assert_eq!(german.get(Phrase::Drive), "Erregung");
        let mut own: Vec<&str> = Phrase::ALL.iter().map(|p| p.into()).collect();
        own.sort_unstable();
        for language in Language::all() {
            let mut tables = language.tables();
            let keys = tables.find(|(table, _)| *table == "phrase");
            assert_eq!(keys.expect("phrases").1, own, "{}", language.name());
        }
        let blank = Catalog::read(&Catalog::blank()).expect("a catalog");
        assert!(blank.words.iter().all(|(a, b)| a == b));
        assert!(
            blank
                .words
                .keys()
                .map(String::as_str)
                .eq(Catalog::phrases())
        );
        assert!(blank.findings.contains_key("wrong_clearance"));
        assert!(blank.remarks().is_empty(), "{:?}", blank.remarks());
    }

    #[test]
    fn a_translation_has_the_values_of_its_phrase() {
        let read = |line: &str| Catalog::read(&format!("[words]\n{line}\n"));
        assert!(read("\"{a} of {b}\" = \"{b}: {a}\"").is_ok());
        let lost = read("\"{a} of {b}\" = \"{a}\"").expect_err("b is lost");
        assert!(
            lost.to_string()
                .contains("has {a}, {b}, its translation has {a}"),
            "{lost}"
        );
        assert!(read("\"$x_{st}$ (mm)\" = \"$x_{st}$ in mm\"").is_ok());
        let odd = read("\"a\" = \"$b\"");
        assert!(matches!(odd, Err(CatalogError::Symbol(_))));
        let form = Catalog::read("words = 3");
        assert!(matches!(form, Err(CatalogError::Form(_))));
    }

    #[test]
    fn a_message_is_translated_by_its_kind() {
        let text = "[words]\n[findings]\nwrong_clearance = \"{fitting_mm} statt {stated_mm}\"\n";
        let catalog = Catalog::read(text).expect("a catalog");
        let message = impact_fit::Finding::WrongClearance {
            stated_m: 1e-3,
            fitting_m: 1.1e-3,
            z_score: 9.0,
        };
        assert_eq!(catalog.template(&message), "{fitting_mm} statt {stated_mm}");
        let short = Catalog::read("[words]\n[findings]\nwrong_clearance = \"{stated_mm}\"\n");
        assert!(matches!(short, Err(CatalogError::Values { .. })));
    }

    #[test]
    fn lacking_and_idle_phrases_are_reported_once() {
        let text = "[words]\n\"no such phrase\" = \"x\"\n";
        let catalog = Catalog::read(text).expect("a catalog");
        let remarks = catalog.remarks();
        assert_eq!(remarks.len(), 2);
        assert!(remarks[0].contains("stay English") && remarks[1].contains("no such phrase"));
        assert_eq!(catalog.get(Phrase::Drive), "drive");
    }
}
