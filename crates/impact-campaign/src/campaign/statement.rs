//! What problems state of records, and what those that are alike state together, in the words of a language.

use impact_records::message::Value;
use impact_records::message_table;
use impact_records::record::Problem;

/// What a problem states of records.
#[derive(Debug, Clone, PartialEq, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub(super) enum Statement {
    /// Of one record.
    OfOne(Problem),
    /// Of all records.
    OfAll {
        /// How many there are.
        records: usize,
        /// What all have.
        problem: Problem,
    },
}

impl Statement {
    /// What was found in a record.
    pub(super) fn problem(&self) -> &Problem {
        match self {
            Self::OfOne(problem) | Self::OfAll { problem, .. } => problem,
        }
    }
}

message_table! { "statement": Statement;
    Self::OfOne(problem) => problem = Value::Message(problem);
    Self::OfAll { records, problem } =>
        count = Value::Count(*records),
        problem = Value::Message(problem);
}

/// Problems that are alike.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Members {
    /// What all state.
    pub(super) message: String,
    /// How many there are.
    pub(super) count: usize,
    /// The first of them.
    pub(super) names: String,
}

/// What problems that are alike state together.
#[derive(Debug, Clone, PartialEq, Eq, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub(super) enum Gathered {
    /// In several records.
    InRecords(Members),
    /// In several lines of a file.
    InLines(Members),
    /// In several files.
    InFiles(Members),
    /// A number that differs.
    Range {
        /// The least.
        least: String,
        /// The greatest.
        greatest: String,
    },
}

message_table! { "gathered": Gathered;
    Self::InRecords(all) | Self::InLines(all) | Self::InFiles(all) =>
        message = Value::Name(&all.message),
        count = Value::Count(all.count),
        names = Value::Name(&all.names);
    Self::Range { least, greatest } =>
        least = Value::Name(least),
        greatest = Value::Name(greatest);
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator;

    use super::*;
    use impact_records::message::{boxed, faults};

    #[test]
    fn every_statement_has_its_texts() {
        let all = boxed(Statement::iter()).chain(boxed(Gathered::iter()));
        assert_eq!(faults(&all.collect::<Vec<_>>()), Vec::<String>::new());
    }
}
