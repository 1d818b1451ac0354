//! Values of campaign.toml as written.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, de};
use toml::Spanned;

pub use impact_records::event::{FlightKind as Flight, RigKind as Machine};
use impact_records::language::Language;
use impact_records::record::calibrate::ChannelKey;
pub use impact_records::record::{Excitation, Sweep};
pub use impact_report::{Format, Paper};

/// A value with its place in the file.
pub type Placed<T> = Option<Spanned<T>>;

/// The value without its place.
pub(super) fn value<T: Clone>(placed: &Placed<T>) -> Option<T> {
    placed.as_ref().map(|p| p.get_ref().clone())
}

/// Code of the report's language as ISO 639-1 writes it. The program has texts in some languages; in others
/// the report is in English, or in the words of a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LanguageCode(pub String);

impl Default for LanguageCode {
    fn default() -> Self {
        Self(Language::default().code().to_owned())
    }
}

/// One text or a list of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OneOrMany(pub Vec<String>);

/// A channel of a file as written: its name or its index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenKey(pub ChannelKey);

/// A quantity as written: text with number and unit, or a bare number.
#[derive(Debug, Clone, PartialEq)]
pub enum Quantity {
    /// Number and unit, not yet read.
    Text(String),
    /// A number without unit.
    Bare(f64),
}

macro_rules! deserialize_with {
    ($visitor:ident for $target:ty, $what:literal, { $($methods:tt)* }) => {
        struct $visitor;
        impl<'de> de::Visitor<'de> for $visitor {
            type Value = $target;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str($what)
            }
            $($methods)*
        }
        impl<'de> Deserialize<'de> for $target {
            fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
                d.deserialize_any($visitor)
            }
        }
    };
}

deserialize_with!(QuantityVisitor for Quantity, "a text with number and unit", {
    fn visit_str<E: de::Error>(self, v: &str) -> Result<Quantity, E> {
        Ok(Quantity::Text(v.to_owned()))
    }
    fn visit_f64<E: de::Error>(self, v: f64) -> Result<Quantity, E> {
        Ok(Quantity::Bare(v))
    }
    fn visit_i64<E: de::Error>(self, v: i64) -> Result<Quantity, E> {
        Ok(Quantity::Bare(v as f64))
    }
});

deserialize_with!(ChannelVisitor for WrittenKey, "a channel's name, or its index from 0", {
    fn visit_str<E: de::Error>(self, v: &str) -> Result<WrittenKey, E> {
        Ok(WrittenKey(ChannelKey::Name(v.to_owned())))
    }
    fn visit_i64<E: de::Error>(self, v: i64) -> Result<WrittenKey, E> {
        usize::try_from(v)
            .map(|index| WrittenKey(ChannelKey::Index(index)))
            .map_err(|_| E::custom(format!("a channel's index is counted from 0, not {v}")))
    }
});

deserialize_with!(LanguageVisitor for LanguageCode, "a language as ISO 639-1 writes it, such as \"en\"", {
    fn visit_str<E: de::Error>(self, v: &str) -> Result<LanguageCode, E> {
        let two_letters = v.len() == 2 && v.bytes().all(|b| b.is_ascii_lowercase());
        two_letters
            .then(|| LanguageCode(v.to_owned()))
            .ok_or_else(|| E::invalid_value(de::Unexpected::Str(v), &self))
    }
});

deserialize_with!(FilesVisitor for OneOrMany, "a text or a list of texts", {
    fn visit_str<E: de::Error>(self, v: &str) -> Result<OneOrMany, E> {
        Ok(OneOrMany(vec![v.to_owned()]))
    }
    fn visit_seq<A: de::SeqAccess<'de>>(self, mut a: A) -> Result<OneOrMany, A::Error> {
        let mut all = Vec::new();
        while let Some(one) = a.next_element()? {
            all.push(one);
        }
        Ok(OneOrMany(all))
    }
});
