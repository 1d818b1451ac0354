//! What commands say of their work, as messages.

use impact_records::message::Value;
use impact_records::message_table;

/// What a command has written.
#[derive(Debug, Clone, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub(super) enum Output {
    /// A file.
    Written(String),
    /// A report: its format and its path.
    Report(&'static str, String),
    /// A file that another program holds, and that beside it which is the new one.
    Beside(String, String),
    /// A record that is left out: of how many, why, and what to do.
    OneLeftOut(LeftOutRecords),
    /// Several records.
    SomeLeftOut(LeftOutRecords),
    /// Records that contradict what is stated of them and are not left out.
    Contradicting(LeftOutRecords),
    /// How many records can be used, and of how many.
    Usable(usize, usize),
    /// What stops the campaign.
    OneError(usize),
    /// Several of these.
    Errors(usize),
    /// What leaves a record out.
    OneWarning(usize),
    /// Several of these.
    Warnings(usize),
    /// What is worth knowing.
    OneNote(usize),
    /// Several of these.
    Notes(usize),
    /// How to see each of the problems that are printed as one.
    SeeEach,
    /// What stands before a remedy.
    Help,
}

/// Records with one kind of fault.
#[derive(Debug, Clone, Default)]
pub(super) struct LeftOutRecords {
    /// How many.
    pub(super) count: usize,
    /// Of how many.
    pub(super) of: usize,
    /// What is wrong with them.
    pub(super) fault: String,
    /// What to do.
    pub(super) remedy: String,
}

message_table! { "output": Output;
    Self::Written(path) => path = Value::Name(path);
    Self::Report(format, path) => format = Value::Name(format), path = Value::Name(path);
    Self::Beside(held, path) => held = Value::Name(held), path = Value::Name(path);
    Self::OneLeftOut(left) | Self::SomeLeftOut(left) | Self::Contradicting(left) =>
        count = Value::Count(left.count),
        of = Value::Count(left.of),
        fault = Value::Name(&left.fault),
        remedy = Value::Name(&left.remedy);
    Self::Usable(usable, records) => usable = Value::Count(*usable), records = Value::Count(*records);
    Self::OneError(count) | Self::Errors(count) | Self::OneWarning(count) | Self::Warnings(count)
    | Self::OneNote(count) | Self::Notes(count) => count = Value::Count(*count);
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::message::{boxed, faults};

    #[test]
    fn every_output_has_its_texts() {
        let all = boxed(<Output as strum::IntoEnumIterator>::iter());
        assert_eq!(faults(&all.collect::<Vec<_>>()), Vec::<String>::new());
    }
}
