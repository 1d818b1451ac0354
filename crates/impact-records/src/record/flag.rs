//! Problems of a record, each with its place: what was found, and a remedy.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::flag_code::FlagCode;
use super::problem::{Problem, Remedy};
use crate::message::typed;

/// A problem of a record: its kind, its channel, and what was found.
///
/// Its JSON form has `code`, `channel`, `message` and `remedy` in English, `excludes`, and under `problem` what was
/// found with its values.
#[derive(Debug, Clone, PartialEq)]
pub struct Flag {
    /// Its kind.
    pub code: FlagCode,
    /// The channel concerned (name in the file), if there is one.
    pub channel: Option<String>,
    /// What was found and what was expected; its remedy follows from it.
    pub problem: Problem,
    /// Whether it excludes the record from the identification.
    pub excludes: bool,
}

impl Flag {
    /// A problem that excludes the record.
    pub fn new(channel: Option<&str>, problem: Problem) -> Self {
        Self {
            code: problem.code(),
            channel: channel.map(str::to_owned),
            problem,
            excludes: true,
        }
    }

    /// The same problem; it excludes the record if `excludes`.
    #[must_use]
    pub fn excluding(self, excludes: bool) -> Self {
        Self { excludes, ..self }
    }

    /// One sentence in English: what was found and what was expected.
    pub fn message(&self) -> String {
        typed(&self.problem)
    }

    /// One sentence in English: what the user can do.
    pub fn remedy(&self) -> String {
        typed(&Remedy(self.problem.clone()))
    }
}

impl Serialize for Flag {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Stated<'a> {
            code: FlagCode,
            channel: &'a Option<String>,
            message: String,
            remedy: String,
            excludes: bool,
            problem: &'a Problem,
        }
        let stated = Stated {
            code: self.code,
            channel: &self.channel,
            message: self.message(),
            remedy: self.remedy(),
            excludes: self.excludes,
            problem: &self.problem,
        };
        stated.serialize(to)
    }
}

impl<'de> Deserialize<'de> for Flag {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        struct Stored {
            channel: Option<String>,
            excludes: bool,
            problem: Problem,
        }
        let stored = Stored::deserialize(from)?;
        let flag = Self::new(stored.channel.as_deref(), stored.problem);
        Ok(flag.excluding(stored.excludes))
    }
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator;

    use super::*;

    #[test]
    fn every_flag_reads_back_from_its_json() {
        for problem in Problem::iter() {
            let flag = Flag::new(Some("vx"), problem).excluding(false);
            let json = serde_json::to_value(&flag).unwrap();
            assert_eq!(json["message"], flag.message());
            assert_eq!(json["remedy"], flag.remedy());
            assert_eq!(json["code"], flag.code.name());
            assert_eq!(serde_json::from_value::<Flag>(json).unwrap(), flag);
        }
    }
}
