//! Problems of a campaign's description and records: each with its place and its remedy, all of
//! them at once, those that are alike in one group.

use serde::Serialize;
use std::cmp::Reverse;
use std::collections::HashMap;
use std::fmt;
use std::path::{Path, PathBuf};

use super::names::natural_key;
use super::slashes;
use super::statement::{Gathered, Members, Statement};
use impact_records::message::{Print, typed};
use impact_records::record::{Flag, FlagCode, Remedy};

/// What a problem prevents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Worth knowing; nothing is left out.
    Note,
    /// The record is left out; the others are used.
    Record,
    /// Nothing can be computed before it is fixed.
    Campaign,
}

/// What kind of problem it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Code {
    /// A file that is named cannot be found or read.
    UnreadableFile,
    /// The text is not TOML, or a row is not CSV.
    Syntax,
    /// A key or a value that campaign.toml does not have.
    UnknownEntry,
    /// A key, column or cell that is needed is missing.
    Missing,
    /// Not a number, a unit or a word of the kind needed.
    InvalidValue,
    /// A value outside of its range.
    OutOfRange,
    /// Two entries that exclude each other, or the same entry twice.
    Conflict,
    /// No record has this name.
    UnknownRecord,
    /// An attribute of a file is missing or is not what campaign.toml expects.
    Attribute,
    /// Datasets of a file that are no records.
    NoRecord,
    /// The samples of another record.
    DuplicateRecord,
    /// Much shorter than the usual record.
    ShortRecord,
    /// What calibration or detection found in a record.
    Flag(FlagCode),
}

/// Where a problem is.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Place {
    /// The file.
    pub file: PathBuf,
    /// Line in a text file, counted from 1.
    pub line: Option<usize>,
    /// Name of the record.
    pub record: Option<String>,
    /// Key of campaign.toml, column of the run table, attribute or channel of the record; empty
    /// where the file or the record as a whole is meant.
    pub item: String,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        if !self.file.as_os_str().is_empty() {
            let line = self.line.map(|line| format!(":{line}"));
            parts.push(format!(
                "{}{}",
                slashes::shown(&self.file.display().to_string()),
                line.unwrap_or_default()
            ));
        }
        // a record that is a file of its own is named by that file
        let stem = self.file.file_stem().unwrap_or_default();
        parts.extend(self.record.clone().filter(|r| stem != r.as_str()));
        parts.extend(Some(self.item.clone()).filter(|item| !item.is_empty()));
        f.write_str(&parts.join(": "))
    }
}

/// One problem: where, what, and what to do about it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Diagnostic {
    /// What kind of problem it is.
    pub code: Code,
    /// What it prevents.
    pub severity: Severity,
    /// Where it is.
    pub place: Place,
    /// What was found, and what was expected.
    pub message: String,
    /// What the user can do.
    pub remedy: String,
    /// What it states of records; `None` of another problem, whose text is English.
    #[serde(skip)]
    statement: Option<Box<Statement>>,
}

impl Place {
    /// An item of a record: its channel or attribute; empty for the record as a whole.
    pub(super) fn of_record(file: &Path, record: &str, item: &str) -> Self {
        Self {
            file: file.to_path_buf(),
            line: None,
            record: Some(record.to_owned()),
            item: item.to_owned(),
        }
    }
}

impl Diagnostic {
    /// A problem with what it prevents, its place and its remedy.
    pub fn new(
        (code, severity): (Code, Severity),
        place: Place,
        message: impl Into<String>,
        remedy: &str,
    ) -> Self {
        Self {
            code,
            severity,
            place,
            message: message.into(),
            remedy: remedy.to_owned(),
            statement: None,
        }
    }

    /// What is stated of records.
    pub(super) fn stating(kind: (Code, Severity), place: Place, statement: Statement) -> Self {
        let remedy = typed(&Remedy(statement.problem().clone()));
        Self {
            statement: Some(Box::new(statement.clone())),
            ..Self::new(kind, place, typed(&statement), &remedy)
        }
    }

    /// The problem in the words of a language, as far as it has them.
    #[must_use]
    pub fn said(&self, words: &dyn Print) -> Self {
        let Some(statement) = self.statement.as_deref() else {
            return self.clone();
        };
        Self {
            message: words.print(statement),
            remedy: words.print(&Remedy(statement.problem().clone())),
            ..self.clone()
        }
    }

    /// The place, where there is one, and the message.
    pub fn headline(&self) -> String {
        match self.place.to_string() {
            place if place.is_empty() => self.message.clone(),
            place => format!("{place}: {}", self.message),
        }
    }

    /// A flag of a record of the campaign.
    pub fn of_flag(file: &Path, record: &str, flag: &Flag) -> Self {
        let severity = if flag.excludes {
            Severity::Record
        } else {
            Severity::Note
        };
        let place = Place::of_record(file, record, flag.channel.as_deref().unwrap_or(""));
        let kind = (Code::Flag(flag.code), severity);
        Self::stating(kind, place, Statement::OfOne(flag.problem.clone()))
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}. {}", self.headline(), self.remedy)
    }
}

/// All problems found.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Diagnostics(pub Vec<Diagnostic>);

impl Diagnostics {
    /// Number of problems of one severity.
    pub fn count(&self, severity: Severity) -> usize {
        self.0.iter().filter(|d| d.severity == severity).count()
    }

    /// The problems in the words of a language, as far as it has them.
    #[must_use]
    pub fn said(&self, words: &dyn Print) -> Self {
        Self(self.0.iter().map(|one| one.said(words)).collect())
    }

    /// Problems that differ only in the record, the line and the numbers of their message, in the
    /// order of the first of each group.
    pub fn groups(&self) -> Vec<Group<'_>> {
        let mut groups: Vec<Group<'_>> = Vec::new();
        let mut index = HashMap::new();
        for one in &self.0 {
            let key = (
                one.code,
                one.severity,
                one.place.record.is_some(),
                &one.place.item,
                &one.remedy,
                with_numbers(&one.message, |_, _| "#".to_owned()),
            );
            let at = *index.entry(key).or_insert(groups.len());
            match groups.get_mut(at) {
                Some(group) => group.0.push(one),
                None => groups.push(Group(vec![one])),
            }
        }
        groups
    }

    /// Sort by severity (the gravest first), place and message, and drop repetitions.
    pub fn sort(&mut self) {
        self.0.sort_by_cached_key(|one| {
            let file = natural_key(&one.place.file.to_string_lossy());
            let place = (file, one.place.clone(), one.message.clone());
            (Reverse(one.severity), place)
        });
        self.0.dedup();
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|one| writeln!(f, "{one}"))
    }
}

impl std::error::Error for Diagnostics {}

/// Problems that are alike, at least one.
#[derive(Debug, Clone)]
pub struct Group<'a>(pub Vec<&'a Diagnostic>);

/// Places that a summary names.
const NAMED: usize = 6;

/// The first names of a list.
pub(super) fn first_of(names: &[String]) -> String {
    let more = if names.len() > NAMED { ", …" } else { "" };
    names[..names.len().min(NAMED)].join(", ") + more
}

impl Group<'_> {
    /// The group as one problem in the words of a language: ranges for the numbers that differ, the number of records
    /// (or lines) and the first of them. `None` for an empty group.
    pub fn summary(&self, words: &dyn Print) -> Option<Diagnostic> {
        let (first, others) = self.0.split_first()?;
        let mut summary = (*first).clone();
        if others.is_empty() {
            return Some(summary);
        }
        summary.message = words.print(&self.gathered(words));
        summary.place = Place {
            file: self.common_path(),
            item: first.place.item.clone(),
            ..Place::default()
        };
        Some(summary)
    }

    /// The item and the message that all share, and the first of the records, lines or files.
    pub fn headline(&self, words: &dyn Print) -> String {
        let item = self.0.first().map_or("", |first| &first.place.item);
        let item = match item {
            "" => String::new(),
            item => format!("{item}: "),
        };
        let message = self.message(words);
        format!("{item}{message} ({})", first_of(&self.names()))
    }

    /// What distinguishes the members: records, lines or files.
    fn names(&self) -> Vec<String> {
        self.places().1
    }

    /// What all share, and in how many records, lines or files it is.
    fn gathered(&self, words: &dyn Print) -> Gathered {
        let message = self.message(words);
        let (of, names) = self.places();
        of(Members {
            message,
            count: names.len(),
            names: first_of(&names),
        })
    }

    /// What the members are, and their names.
    fn places(&self) -> (fn(Members) -> Gathered, Vec<String>) {
        let places = self.0.iter().map(|d| &d.place);
        let records: Option<Vec<String>> = places.clone().map(|p| p.record.clone()).collect();
        let line = |p: &Place| p.line.map(|l| l.to_string());
        let lines: Option<Vec<String>> = places.clone().map(line).collect();
        match (records, lines) {
            (Some(records), _) => (Gathered::InRecords, records),
            (None, Some(lines)) => (Gathered::InLines, lines),
            (None, None) => (
                Gathered::InFiles,
                places.map(|p| p.file.display().to_string()).collect(),
            ),
        }
    }

    /// The file that all share, else the folder.
    fn common_path(&self) -> PathBuf {
        let mut paths = self.0.iter().map(|d| d.place.file.as_path());
        let first = paths.next().unwrap_or(Path::new(""));
        paths.fold(first.to_path_buf(), |common, path| {
            let same = common.iter().zip(path.iter()).take_while(|(a, b)| a == b);
            same.map(|(part, _)| part).collect()
        })
    }

    /// The message that all share, with the range of each number that differs.
    fn message(&self, words: &dyn Print) -> String {
        let messages = self.0.iter().map(|d| d.message.as_str());
        let first = messages.clone().next().unwrap_or_default();
        with_numbers(first, |i, _| {
            let each = messages.clone().filter_map(|m| m.split(' ').nth(i));
            range(&each.filter_map(number).collect::<Vec<_>>(), words)
        })
    }
}

/// Numbers as one, or from the least to the greatest.
fn range(numbers: &[&str], words: &dyn Print) -> String {
    let value = |text: &&&str| parsed(text).unwrap_or(f64::NAN);
    let by_value = |a: &&&str, b: &&&str| value(a).total_cmp(&value(b));
    let least = numbers.iter().min_by(by_value);
    let greatest = numbers.iter().max_by(by_value);
    match (least, greatest) {
        (Some(least), Some(greatest)) if least != greatest => words.print(&Gathered::Range {
            least: (*least).to_owned(),
            greatest: (*greatest).to_owned(),
        }),
        (Some(one), _) => (*one).to_owned(),
        _ => String::new(),
    }
}

/// A number as a message has it: with a hyphen or a minus, and a decimal point or comma.
fn parsed(digits: &str) -> Option<f64> {
    let digits = digits.replace('\u{2212}', "-").replace(',', ".");
    digits.parse().ok()
}

/// The number in a word of a message; `None` for names that contain digits.
fn number(word: &str) -> Option<&str> {
    let bare = word
        .trim_start_matches('(')
        .trim_end_matches([',', '.', ';', ':', ')']);
    let digit = bare
        .trim_start_matches(['-', '\u{2212}'])
        .starts_with(|c: char| c.is_ascii_digit());
    (digit && parsed(bare).is_some()).then_some(bare)
}

/// A message with `replace(index, number)` for each number in it.
fn with_numbers(message: &str, replace: impl Fn(usize, &str) -> String) -> String {
    let words = message.split(' ').enumerate();
    let words = words.map(|(i, word)| match number(word) {
        Some(number) => word.replacen(number, &replace(i, number), 1),
        None => word.to_owned(),
    });
    words.collect::<Vec<_>>().join(" ")
}

/// Collects the problems of one file while it is read.
#[derive(Debug)]
pub(super) struct FaultCollector {
    file: PathBuf,
    /// The sheet of a workbook.
    sheet: Option<String>,
    found: Vec<Diagnostic>,
}

impl FaultCollector {
    /// An empty one for a file.
    pub(super) fn new(file: &Path) -> Self {
        Self {
            file: file.to_path_buf(),
            sheet: None,
            found: Vec::new(),
        }
    }

    /// The file.
    pub(super) fn file(&self) -> &Path {
        &self.file
    }

    /// What is noted from now on is in a sheet of the file.
    pub(super) fn in_sheet(&mut self, name: &str) {
        self.sheet = Some(format!("sheet {name}"));
    }

    /// A place in the file.
    pub(super) fn place(&self, line: Option<usize>, item: &str) -> Place {
        let parts = [self.sheet.as_deref().unwrap_or(""), item];
        let parts: Vec<&str> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        Place {
            file: self.file.clone(),
            line,
            record: None,
            item: parts.join(": "),
        }
    }

    /// Note a problem that stops the campaign.
    pub(super) fn fault(
        &mut self,
        code: Code,
        line: Option<usize>,
        item: &str,
        message: impl Into<String>,
        remedy: &str,
    ) {
        let what = (code, Severity::Campaign);
        let place = self.place(line, item);
        self.found
            .push(Diagnostic::new(what, place, message, remedy));
    }

    /// Take over problems of another file.
    pub(super) fn extend(&mut self, others: impl IntoIterator<Item = Diagnostic>) {
        self.found.extend(others);
    }

    /// Whether a problem that stops the campaign was noted.
    pub(super) fn blocks(&self) -> bool {
        self.found.iter().any(|d| d.severity == Severity::Campaign)
    }

    /// The problems noted.
    pub(super) fn into_diagnostics(self) -> Diagnostics {
        Diagnostics(self.found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::message::Typed;

    fn of_record(record: &str, item: &str, message: &str) -> Diagnostic {
        let file = format!("day1/{record}.csv");
        let place = Place::of_record(Path::new(&file), record, item);
        let what = (Code::ShortRecord, Severity::Note);
        Diagnostic::new(what, place, message, "copy the file again")
    }

    #[test]
    fn messages_alike_but_for_numbers_become_one_with_ranges() {
        let message = |n| format!("{n} samples, the usual record has 46");
        let all = [34, 31, 33].map(|n| of_record(&format!("r{n}"), "", &message(n)));
        let all = Diagnostics(all.to_vec());
        let groups = all.groups();
        assert_eq!(groups.len(), 1);
        let summary = groups[0].summary(&Typed).unwrap();
        assert_eq!(
            summary.to_string(),
            "day1: 31 to 34 samples, the usual record has 46 (in 3 records: r34, r31, r33). \
             copy the file again"
        );
    }

    #[test]
    fn a_group_names_records_and_its_channel_once() {
        let names: Vec<String> = (0..8).map(|i| format!("r{i}")).collect();
        let all = names
            .iter()
            .flat_map(|r| ["vx", "vy"].map(|c| of_record(r, c, "no unit")));
        let all = Diagnostics(all.collect());
        let summaries: Vec<String> = all
            .groups()
            .iter()
            .map(|g| g.summary(&Typed).unwrap())
            .map(|d| format!("{}: {}", d.place, d.message))
            .collect();
        assert_eq!(
            summaries,
            ["vx", "vy"]
                .map(|c| format!("day1: {c}: no unit (in 8 records: r0, r1, r2, r3, r4, r5, …)"))
        );
    }

    #[test]
    fn names_with_digits_are_not_numbers() {
        let message = "record 'r 12' has 3, of (-1.5e-3) V, run12 and 2kHz";
        let pattern = with_numbers(message, |_, _| "#".to_owned());
        assert_eq!(pattern, "record 'r 12' has #, of (#) V, run12 and 2kHz");
        let other = |name| of_record("a", "", &format!("its samples are those of '{name}'"));
        let all = Diagnostics(vec![other("r1"), other("r2")]);
        assert_eq!(all.groups().len(), 2);
    }

    #[test]
    fn numbers_may_have_a_minus_and_a_decimal_comma() {
        let text = "bei (\u{2212}1,5) V, r1,2";
        let pattern = with_numbers(text, |_, _| "#".to_owned());
        assert_eq!(pattern, "bei (#) V, r1,2");
        let both = range(&["1,5", "\u{2212}2,5"], &Typed);
        assert_eq!(both, "\u{2212}2,5 to 1,5");
    }

    #[test]
    fn lines_of_a_table_are_named_where_there_is_no_record() {
        let mut faults = FaultCollector::new(Path::new("runs.csv"));
        for line in [3, 5] {
            faults.fault(
                Code::InvalidValue,
                Some(line),
                "sweep",
                "'x' is no word",
                "write up",
            );
        }
        let all = faults.into_diagnostics();
        let summary = all.groups()[0].summary(&Typed).unwrap();
        assert_eq!(
            format!("{}: {}", summary.place, summary.message),
            "runs.csv: sweep: 'x' is no word (in 2 lines: 3, 5)"
        );
    }

    proptest::proptest! {
        #[test]
        fn prop_a_message_alone_is_its_own_summary(text in "\\PC{0,20}[a-z0-9 .'e+-]{0,40}") {
            let one = of_record("a", "", &text);
            let all = Diagnostics(vec![one.clone(), one]);
            proptest::prop_assert_eq!(all.groups()[0].message(&Typed), text);
        }
    }
}
