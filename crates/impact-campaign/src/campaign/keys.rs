//! The keys of campaign.toml: each is a row of its section's table.
//!
//! From a row come the field that is read, the row of docs/campaign.md and the line that `impactid init`
//! writes.

use std::fmt::Write;

use impact_records::language::Language;

/// What stands in a row for the codes of the languages with texts.
const LANGUAGES: &str = "{languages}";

/// The codes of the languages with texts, each as `printed` gives it.
fn languages(printed: impl Fn(&str) -> String) -> String {
    let codes = Language::all().map(|language| printed(language.code()));
    codes.collect::<Vec<_>>().join(" or ")
}

/// What is known of a key apart from its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeyRow {
    /// Name.
    pub name: &'static str,
    /// What it states, in Markdown.
    pub meaning: &'static [&'static str],
    /// What holds without it, in Markdown; `None` where its meaning states that.
    pub default: Option<&'static str>,
    /// The line that `impactid init` writes, if it does; `{}` is the value that it infers.
    pub init: Option<&'static str>,
}

/// Defines a section of campaign.toml as a struct and lists its keys.
///
/// A row is the meaning of a key as its doc comment, which is also the cell of docs/campaign.md, the
/// key's name and type, then its default in words and what `impactid init` writes, if any.
macro_rules! keys {
    (
        $(#[$attribute:meta])*
        pub struct $section:ident {
            $(
                $(#[doc = $meaning:literal])+
                $(#[serde($($serde:tt)*)])?
                $key:ident: $value:ty $(, default $default:literal)? $(, init $init:literal)?;
            )+
        }
    ) => {
        #[derive(Debug, Clone, Default, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        $(#[$attribute])*
        #[allow(clippy::doc_markdown, reason = "the comments are cells of docs/campaign.md")]
        pub struct $section {
            $(
                $(#[doc = $meaning])+
                $(#[serde($($serde)*)])?
                pub $key: $value,
            )+
        }

        impl $section {
            /// Its keys.
            pub const KEYS: &'static [$crate::campaign::keys::KeyRow] = &[
                $(
                    $crate::campaign::keys::KeyRow {
                        name: stringify!($key),
                        meaning: &[$($meaning),+],
                        default: $crate::campaign::keys::optional!($($default)?),
                        init: $crate::campaign::keys::optional!($($init)?),
                    },
                )+
            ];
        }
    };
}

/// `Some` of what is there.
macro_rules! optional {
    () => {
        None
    };
    ($text:literal) => {
        Some($text)
    };
}

pub(super) use {keys, optional};

/// What `impactid init` found for a key.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inferred<'a> {
    /// The key's name.
    pub name: &'a str,
    /// Its value.
    pub value: &'a str,
    /// Why the user has to state it, if the files do not tell: a value that nobody has stated must not count.
    pub asked: Option<&'a str>,
}

impl<'a> Inferred<'a> {
    /// A value that the files tell.
    pub(super) const fn known(name: &'a str, value: &'a str) -> Self {
        let asked = None;
        Self { name, value, asked }
    }

    /// The same value, to be filled in if there is a reason.
    pub(super) const fn asked_if(self, asked: Option<&'a str>) -> Self {
        Self { asked, ..self }
    }
}

/// The lines of `impactid init` for the keys of a section, with what it found of them.
pub(super) fn init_lines(keys: &[KeyRow], inferred: &[Inferred<'_>]) -> String {
    let mut text = String::new();
    for key in keys {
        let Some(line) = key.init else { continue };
        let found = inferred.iter().find(|found| found.name == key.name);
        let line = line.replacen("{}", found.map_or("", |found| found.value), 1);
        let line = line.replace(LANGUAGES, &languages(str::to_owned));
        if let Some(why) = found.and_then(|found| found.asked) {
            // writing to a String cannot fail
            let _ = write!(text, "# FILL IN, {why}: ");
        }
        // writing to a String cannot fail
        let _ = writeln!(text, "{line}");
    }
    text
}

/// The table of docs/campaign.md for the keys of a section; `heading` is that of the second column.
pub fn markdown(keys: &[KeyRow], heading: &str) -> String {
    let defaults = keys.iter().any(|key| key.default.is_some());
    let row = |cells: &[&str]| format!("| {} |\n", cells.join(" | "));
    let width = if defaults { 3 } else { 2 };
    let mut text = row(&["key", heading, "default"][..width]);
    text += &row(&["---"; 3][..width]);
    for key in keys {
        let name = format!("`{}`", key.name);
        let meaning: Vec<&str> = key.meaning.iter().map(|line| line.trim()).collect();
        let codes = languages(|code| format!("`\"{code}\"`"));
        let meaning = meaning.join(" ").replace(LANGUAGES, &codes);
        text += &row(&[&name, &meaning, key.default.unwrap_or("none")][..width]);
    }
    text
}
