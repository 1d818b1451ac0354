//! Messages: what a module states, as a kind with values instead of a sentence.
//!
//! A type whose variants are messages implements [`Message`]: a table of texts, a key for each variant,
//! and the values that its text has. The texts are templates in the files of the [`Language`]s, with names
//! in braces for the values and symbols between dollars. The macro
//! [`message_table!`](crate::message_table) lists the values of each variant. The macro
//! [`messages!`](crate::messages) adds `Display` (English) and the JSON form: the variant as
//! `kind`, its numbers in SI, and the English sentence as `text`. [`faults`] lists the messages without a
//! text of the same values, and texts without a message; a test of each crate requires that there are none.

use std::collections::BTreeMap;
use std::fmt::Display;

use crate::language::{Language, names};

/// Something that a module states, to be printed in the language of the reader.
pub trait Message {
    /// Table of its texts in the file of a language.
    fn table(&self) -> &'static str;

    /// Name of the kind, `kind` in JSON.
    fn kind(&self) -> &'static str;

    /// Key in the table of texts: the kind, or another if the kind has several texts.
    fn key(&self) -> String {
        self.kind().to_owned()
    }

    /// The template in a language: names in braces are replaced by the values, symbols are between
    /// dollars.
    fn template(&self, language: Language) -> &'static str {
        let text = |of: Language| of.own_text(self.table(), &self.key());
        let text = text(language).or_else(|| text(Language::default()));
        text.unwrap_or_else(|| self.kind())
    }

    /// The values by the names that the templates use; none by default.
    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        Vec::new()
    }
}

/// A value in a message.
pub enum Value<'a> {
    /// A number and the count of its decimals.
    Number(f64, usize),
    /// A number with as many decimals as it needs.
    Shortest(f64),
    /// A number with digits as Rust writes them.
    Digits(String),
    /// A share as a percentage with a count of decimals (0.01 is 1 %).
    Percent(f64, usize),
    /// A count.
    Count(usize),
    /// A name that is the same in every language and carries no markup.
    Name(&'a str),
    /// Another message.
    Message(&'a dyn Message),
    /// Several values, separated by commas.
    List(Vec<Self>),
    /// Several sentences.
    Sentences(Vec<Self>),
}

impl<'a> Value<'a> {
    /// Messages, separated by commas.
    pub fn list(messages: &'a [impl Message]) -> Self {
        Self::List(messages.iter().map(|m| Self::Message(m)).collect())
    }

    /// Names or groups that a message lists at most.
    pub const NAMED: usize = 6;

    /// The first of some names, separated by commas.
    pub fn some_names(names: &'a [String]) -> Self {
        let first = names.iter().take(Self::NAMED);
        Self::abridged(first.map(|name| Self::Name(name)), names.len())
    }

    /// The first of `count` values, separated by commas, with an ellipsis for the others.
    pub fn abridged(first: impl ExactSizeIterator<Item = Self>, count: usize) -> Self {
        let more = (count > first.len()).then_some(Self::Name("…"));
        Self::List(first.chain(more).collect())
    }
}

/// How the values of a message are printed.
pub trait Print {
    /// The template of a message.
    fn template(&self, message: &dyn Message) -> String;

    /// A number as formatted in English, with the reader's signs.
    fn number(&self, digits: String) -> String;

    /// A name.
    fn name(&self, name: &str) -> String;

    /// A message with its values in their places.
    fn print(&self, message: &dyn Message) -> String {
        let values = message.values();
        filled(&self.template(message), |name| {
            let value = values.iter().find(|v| v.0 == name)?;
            Some(self.value(&value.1))
        })
    }

    /// A value of a message.
    fn value(&self, value: &Value<'_>) -> String {
        match value {
            Value::Number(value, decimals) => self.number(format!("{value:.decimals$}")),
            Value::Percent(share, decimals) => {
                let percent = 100.0 * share;
                format!("{} %", self.number(format!("{percent:.decimals$}")))
            }
            Value::Shortest(value) => self.number(value.to_string()),
            Value::Digits(digits) => self.number(digits.clone()),
            Value::Count(count) => count.to_string(),
            Value::Name(name) => self.name(name),
            Value::Message(message) => self.print(*message),
            Value::List(values) => self.joined(values, ", "),
            Value::Sentences(values) => self.joined(values, " "),
        }
    }

    /// Values with a separator between them.
    fn joined(&self, values: &[Value<'_>], separator: &str) -> String {
        let each: Vec<String> = values.iter().map(|v| self.value(v)).collect();
        each.join(separator)
    }
}

/// A template with a value for each name in braces; a name without a value stays in its braces.
pub fn filled(template: &str, value: impl Fn(&str) -> Option<String>) -> String {
    let mut text = String::with_capacity(template.len() + 16);
    let mut rest = template;
    while let Some((before, after)) = rest.split_once('{') {
        let Some((name, after)) = after.split_once('}') else {
            break;
        };
        text.push_str(before);
        text.push_str(&value(name).unwrap_or_else(|| format!("{{{name}}}")));
        rest = after;
    }
    text.push_str(rest);
    text
}

/// What is wrong with the texts of messages: a message without a text, a text whose names in braces are
/// not its values, or a text in one of their tables that none of them has.
pub fn faults(messages: &[Box<dyn Message>]) -> Vec<String> {
    let mut faults = Vec::new();
    let mut unused: BTreeMap<&str, Vec<&str>> = Language::default().tables().collect();
    let tables: Vec<&str> = messages.iter().map(|m| m.table()).collect();
    unused.retain(|table, _| tables.contains(table));
    for message in messages {
        let (table, key) = (message.table(), message.key());
        for language in Language::all() {
            let place = format!("[text.{table}] {key} in {}", language.name());
            let Some(text) = language.own_text(table, &key) else {
                faults.push(format!("there is no {place}"));
                continue;
            };
            let mut wanted: Vec<&str> = message.values().iter().map(|v| v.0).collect();
            let mut found: Vec<&str> = names(text).collect();
            for list in [&mut wanted, &mut found] {
                list.sort_unstable();
                list.dedup();
            }
            if wanted != found {
                faults.push(format!("{place} has {found:?}, its values are {wanted:?}"));
            }
        }
        if let Some(keys) = unused.get_mut(table) {
            keys.retain(|k| *k != key);
        }
    }
    let each = unused.iter().filter(|(_, keys)| !keys.is_empty());
    faults.extend(each.map(|(table, keys)| format!("no message has [text.{table}] {keys:?}")));
    faults
}

/// Digits as Rust writes them with a true minus, of which a zero has none.
pub fn with_minus(digits: &str) -> String {
    let is_zero = digits.chars().all(|c| matches!(c, '-' | '0' | '.'));
    digits.replace('-', if is_zero { "" } else { "\u{2212}" })
}

/// The English template of a message, without markup.
fn bare(message: &dyn Message) -> String {
    let template = message.template(Language::default());
    template.replace("$f_0$", "f0").replace('$', "")
}

/// English without markup.
struct Plain;

impl Print for Plain {
    fn template(&self, message: &dyn Message) -> String {
        bare(message)
    }

    fn number(&self, digits: String) -> String {
        with_minus(&digits)
    }

    fn name(&self, name: &str) -> String {
        name.to_owned()
    }
}

/// English without markup, its numbers as they are typed.
#[derive(Debug, Clone, Copy)]
pub struct Typed;

impl Print for Typed {
    fn template(&self, message: &dyn Message) -> String {
        bare(message)
    }

    fn number(&self, digits: String) -> String {
        digits
    }

    fn name(&self, name: &str) -> String {
        name.to_owned()
    }
}

/// A message in English without markup, its numbers as they are typed: with a hyphen for minus.
pub fn typed(message: &dyn Message) -> String {
    Typed.print(message)
}

/// A message in English without markup.
pub fn plain(message: &dyn Message) -> String {
    Plain.print(message)
}

/// A number of things with their noun, which is in the plural but for one: `3 records`.
pub fn counted<N: Display + From<u8> + PartialEq>(count: N, noun: &str) -> String {
    let plural = if count == N::from(1) { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

/// A text as a sentence: a capital at its start, a full stop at its end.
pub fn sentence(text: &str) -> String {
    let text = text.trim();
    let mut chars = text.chars();
    // a symbol or a record's name keeps its small letter
    let word = text.split_whitespace().next().unwrap_or("");
    let article = word == "a";
    let plain = article || word.chars().count() > 1 && word.chars().all(char::is_lowercase);
    let start = match chars.next() {
        Some(first) if plain => first.to_uppercase().chain(chars).collect(),
        _ => text.to_owned(),
    };
    if start.ends_with(['.', '!', '?']) || start.is_empty() {
        start
    } else {
        format!("{start}.")
    }
}

/// Messages of one type among those of others.
pub fn boxed<M: Message + 'static>(
    each: impl Iterator<Item = M>,
) -> impl Iterator<Item = Box<dyn Message>> {
    each.map(|message| Box::new(message) as Box<dyn Message>)
}

/// Several messages in English without markup, separated by blanks.
pub fn plain_all(messages: &[impl Display]) -> String {
    let each: Vec<String> = messages.iter().map(ToString::to_string).collect();
    each.join(" ")
}

/// Implements [`Message`](crate::message::Message) for an enum that derives `strum::IntoStaticStr`,
/// whose names are the kinds and the keys of the texts.
///
/// First the table of texts and the type; then each variant whose text has values: its pattern, and the
/// values by the names that the text uses, as in `format!`. `key = function` after the type gives the
/// key where it is not the kind.
///
/// ```
/// use impact_records::message::{Value, plain};
/// use impact_records::message_table;
///
/// #[derive(strum::IntoStaticStr)]
/// #[strum(serialize_all = "snake_case")]
/// enum Doubt {
///     NoDrive,
///     NearlyCloses { periods: usize },
/// }
///
/// message_table! { "undetermined": Doubt;
///     Self::NearlyCloses { periods } => periods = Value::Count(*periods);
/// }
///
/// assert_eq!(plain(&Doubt::NoDrive), "no drive was measured, so no period is known");
/// assert!(plain(&Doubt::NearlyCloses { periods: 3 }).contains("nearly closes after 3 drive periods"));
/// ```
#[macro_export]
macro_rules! message_table {
    ($table:literal: $message:ty $(, key = $key:path)?;
     $($variant:pat => $($name:ident = $value:expr),+;)*) => {
        impl $crate::message::Message for $message {
            fn table(&self) -> &'static str {
                $table
            }

            fn kind(&self) -> &'static str {
                self.into()
            }

            $(fn key(&self) -> String {
                $key(self)
            })?

            #[allow(unreachable_patterns, reason = "there may be no variant without values")]
            fn values(&self) -> Vec<(&'static str, $crate::message::Value<'_>)> {
                match self {
                    $($variant => vec![$((stringify!($name), $value)),+],)*
                    _ => Vec::new(),
                }
            }
        }
    };
}

/// `Display` and the JSON form of types that implement [`Message`] and derive `Serialize` and
/// `Deserialize` with `#[serde(remote = "Self")]`.
#[macro_export]
macro_rules! messages {
    ($($message:ty),+) => {$(
        impl std::fmt::Display for $message {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(&$crate::message::plain(self))
            }
        }

        $crate::serialised_with_text!($message, "text");
    )+};
}

/// The JSON form of a type that implements `Display` and derives `Serialize` and `Deserialize` with
/// `#[serde(remote = "Self")]`: its fields, then its English text under a key.
#[macro_export]
macro_rules! serialised_with_text {
    ($stated:ty, $key:literal) => {
        impl serde::Serialize for $stated {
            fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                struct Fields<'a>(&'a $stated);
                impl serde::Serialize for Fields<'_> {
                    fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                        // the inherent function that `remote` derives
                        <$stated>::serialize(self.0, to)
                    }
                }
                #[derive(serde::Serialize)]
                struct WithText<'a> {
                    #[serde(flatten)]
                    fields: Fields<'a>,
                    #[serde(rename = $key)]
                    text: String,
                }
                let text = self.to_string();
                let fields = Fields(self);
                serde::Serialize::serialize(&WithText { fields, text }, to)
            }
        }

        impl<'de> serde::Deserialize<'de> for $stated {
            fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                <$stated>::deserialize(from)
            }
        }
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_become_sentences() {
        assert_eq!(sentence("the responses follow"), "The responses follow.");
        assert_eq!(sentence("x is clipped."), "x is clipped.");
        assert_eq!(sentence("r0012 was left out"), "r0012 was left out.");
        assert_eq!(sentence("$R$ is constant"), "$R$ is constant.");
        assert_eq!(sentence(""), "");
    }

    #[test]
    fn values_take_the_places_of_their_names() {
        let value = |name: &str| (name == "a").then(|| "1".to_owned());
        assert_eq!(filled("{a} of {b}, {a}", value), "1 of {b}, 1");
        assert_eq!(filled("no { end", value), "no { end");
    }
}
