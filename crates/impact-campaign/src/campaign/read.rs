//! From the text of campaign.toml to [`WrittenCampaign`], with every fault of its form at once:
//! each offending entry is noted and taken out, and what is left is read again.

use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use toml::de::{DeArray, DeTable, DeValue, Deserializer};

use super::diagnostic::{Code, Diagnostics, FaultCollector};
use super::lines::Text;
use super::nearest::nearest;
use super::resolved::RESOLVED;
use super::run_table;
use super::written::WrittenCampaign;

/// The text of campaign.toml; `None`, and a fault, where it cannot be read.
pub(super) fn text(path: &Path, faults: &mut FaultCollector) -> Option<String> {
    let error = match labfiles::read_text(path) {
        Ok(text) => return Some(text),
        Err(error) => error,
    };
    let unreadable = || format!("campaign.toml cannot be read: {}", labfiles::said(&error));
    let (message, remedy) = match (path.is_dir(), error.kind()) {
        (true, _) if path.join(RESOLVED).exists() => (
            "it is a folder of results".to_owned(),
            "name the campaign.toml that they were computed from: campaign.resolved.json states it as `file`",
        ),
        (true, _) => (
            "it is a folder".to_owned(),
            "name the campaign.toml in it; `impactid init DIR` writes one",
        ),
        (_, std::io::ErrorKind::InvalidData) => match other(path) {
            Some(what) => (what, NAME_CAMPAIGN),
            None => (unreadable(), "save it as UTF-8 in your editor"),
        },
        (_, std::io::ErrorKind::PermissionDenied) => (unreadable(), "allow reading it"),
        _ => (
            unreadable(),
            "name the right file; `impactid init DIR` writes one",
        ),
    };
    faults.fault(Code::UnreadableFile, None, "", message, remedy);
    None
}

/// Why a path cannot be the description of a campaign: it is not there, a folder or a record. Nothing of a file that
/// is one, with whatever faults.
pub fn not_a_description(path: &Path) -> Diagnostics {
    let mut faults = FaultCollector::new(path);
    let may_be = match labfiles::read_text(path) {
        Ok(text) => DeTable::parse(&text).is_ok() || other(path).is_none(),
        Err(_) => path.is_file() && other(path).is_none(),
    };
    if !may_be && let Some(text) = text(path, &mut faults) {
        let _ = read(&text, &mut faults);
    }
    faults.into_diagnostics()
}

/// What to do where a record is named.
const NAME_CAMPAIGN: &str =
    "name the campaign.toml that describes it; `impactid init DIR` writes one";

/// What a file is, in words, that is a document, JSON as the program writes its results, a run table or a record.
fn other(path: &Path) -> Option<String> {
    let kind = if let Some(document) = labfiles::document(path) {
        document.to_owned()
    } else if is_run_table(path) {
        "a run table".to_owned()
    } else {
        let source = labfiles::open(path).ok()?;
        let format = Some(source.format()).filter(|_| !source.datasets().is_empty())?;
        format!("a record ({format})")
    };
    Some(format!("it is {kind}, not the description of a campaign"))
}

fn is_run_table(path: &Path) -> bool {
    let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else {
        return false;
    };
    let text = std::fs::read(path).unwrap_or_default();
    run_table::is_run_table(&text, &run_table::is_file(folder, name))
}

/// Read the text; an entry that cannot be read is noted in `faults` and left at its default. `None`,
/// and the faults, if the text is not TOML or a fault has no entry: nothing can then be said of what is
/// missing.
pub(super) fn read(text: &str, faults: &mut FaultCollector) -> Option<WrittenCampaign> {
    let places = Text::new(text);
    let (mut document, syntax) = DeTable::parse_recoverable(text);
    if !syntax.is_empty() {
        match other(faults.file()) {
            Some(what) => {
                faults.fault(Code::UnreadableFile, None, "", what, NAME_CAMPAIGN);
            }
            None => syntax
                .iter()
                .for_each(|fault| note_syntax(&places, fault, faults)),
        }
        return None;
    }
    loop {
        match WrittenCampaign::deserialize(Deserializer::from(document.clone())) {
            Ok(written) => return Some(written),
            Err(fault) => {
                let path = fault
                    .span()
                    .and_then(|span| take_out(document.get_mut(), &span));
                note_form(&places, &fault, path.as_deref(), faults);
                path?;
            }
        }
    }
}

fn note_syntax(places: &Text<'_>, fault: &toml::de::Error, faults: &mut FaultCollector) {
    let line = fault.span().map(|s| places.line(s.start));
    let what = format!("not valid TOML: {}", one_line(fault.message()));
    let escaped = fault.message().contains("escape");
    let remedy = if escaped {
        "write / between folders, \"sub/*.csv\", on Windows too; \\ within \" quotes begins an escape"
    } else {
        "fix the line; texts are written in quotes, tables in [brackets]"
    };
    faults.fault(Code::Syntax, line, "", what, remedy);
}

fn note_form(
    places: &Text<'_>,
    fault: &toml::de::Error,
    path: Option<&str>,
    faults: &mut FaultCollector,
) {
    let line = fault.span().map(|s| places.line(s.start));
    let message = one_line(fault.message());
    let remedy = match unknown_name(&message) {
        Some((name, expected)) => remedy_for_unknown(name, &expected),
        None => "docs/campaign.md states what the key takes".to_owned(),
    };
    faults.fault(
        Code::UnknownEntry,
        line,
        path.unwrap_or(""),
        message,
        &remedy,
    );
}

fn one_line(message: &str) -> String {
    message.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The unknown name in serde's "unknown field `x`, expected one of `a`, `b`" and the names
/// expected there.
fn unknown_name(message: &str) -> Option<(&str, Vec<&str>)> {
    if !message.starts_with("unknown ") {
        return None;
    }
    let mut quoted = message.split('`').skip(1).step_by(2);
    let name = quoted.next()?;
    Some((name, quoted.collect()))
}

fn remedy_for_unknown(name: &str, expected: &[&str]) -> String {
    match nearest(name, expected) {
        Some(near) => format!("did you mean '{near}'? Otherwise remove it"),
        None => "remove it, or use one of the names listed".to_owned(),
    }
}

/// Remove the innermost entry whose key or value covers `span`; gives its dotted path.
fn take_out(table: &mut DeTable<'_>, span: &Range<usize>) -> Option<String> {
    let entry = table.iter_mut().find_map(|(key, value)| {
        let name = key.get_ref().to_string();
        let on_key = covers(&key.span(), span);
        let inner = if on_key {
            None
        } else {
            take_out_of(value.get_mut(), span)
        };
        (on_key || inner.is_some() || covers(&value.span(), span)).then_some((name, inner))
    });
    match entry? {
        (name, Some(inner)) => Some(format!("{name}.{inner}")),
        (name, None) => {
            table.remove(name.as_str());
            Some(name)
        }
    }
}

fn take_out_of(value: &mut DeValue<'_>, span: &Range<usize>) -> Option<String> {
    match value {
        DeValue::Table(table) => take_out(table, span),
        DeValue::Array(array) => take_out_of_array(array, span),
        _ => None,
    }
}

fn take_out_of_array(array: &mut DeArray<'_>, span: &Range<usize>) -> Option<String> {
    array
        .iter_mut()
        .enumerate()
        .find_map(|(i, v)| take_out_of(v.get_mut(), span).map(|inner| format!("{i}.{inner}")))
}

fn covers(outer: &Range<usize>, inner: &Range<usize>) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::diagnostic::Diagnostic;

    fn faults_of(text: &str) -> (WrittenCampaign, Vec<Diagnostic>) {
        let mut faults = FaultCollector::new(Path::new("campaign.toml"));
        let written = read(text, &mut faults);
        (written.unwrap_or_default(), faults.into_diagnostics().0)
    }

    #[test]
    fn what_is_no_file_a_folder_or_a_record_describes_no_campaign() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("r1.csv"), "t [s],x [mm]\n0,1\n0.5,2\n1,3\n").unwrap();
        std::fs::write(path("report.pdf"), b"%PDF-1.7\n%\xE2\xE3\n").unwrap();
        std::fs::write(path("result.json"), "{\n  \"verdict\": {}\n}\n").unwrap();
        std::fs::write(path("log.csv"), "file,gap [mm]\nr1.csv,2\n").unwrap();
        for (name, says) in [
            ("none.toml", "campaign.toml cannot be read"),
            ("", "it is a folder"),
            ("r1.csv", "it is a record (csv)"),
            (
                "report.pdf",
                "it is a PDF document, not the description of a campaign",
            ),
            (
                "result.json",
                "it is JSON, not the description of a campaign",
            ),
            ("log.csv", "it is a run table, not"),
        ] {
            let found = not_a_description(&path(name)).0;
            assert_eq!(found.len(), 1, "{found:?}");
            assert!(found[0].message.contains(says), "{found:?}");
        }
        for text in [
            "[campaign]\nmachine = \"triple\"\n",
            "[campaign\nname = ",
            "",
        ] {
            std::fs::write(path("campaign.toml"), text).unwrap();
            let found = not_a_description(&path("campaign.toml"));
            assert_eq!(found, Diagnostics::default(), "{text}");
        }
    }

    #[test]
    fn every_fault_of_form_is_reported_at_once_with_its_line() {
        let text = "[campaign]\nname = 3\nmachine = \"triple\"\nflite = \"harmonic\"\n\
                    [channels.velocityx]\nchannel = \"v\"\n\
                    [channels.drive]\nchannel = \"d\"\nuni = \"V\"\n[rig]\nrestitution = [1]\n";
        let (written, faults) = faults_of(text);
        let mut lines: Vec<_> = faults
            .iter()
            .map(|f| (f.place.line.unwrap(), f.place.item.as_str()))
            .collect();
        lines.sort();
        assert_eq!(
            lines,
            [
                (2, "campaign.name"),
                (3, "campaign.machine"),
                (4, "campaign.flite"),
                (5, "channels.velocityx"),
                (9, "channels.drive.uni"),
                (11, "rig.restitution"),
            ]
        );
        let drive = written
            .channels
            .drive
            .expect("the rest is read")
            .into_inner();
        assert!(drive.channel.is_some() && drive.unit.is_none());
    }

    #[test]
    fn the_letter_size_has_two_names() {
        for name in ["letter", "us-letter"] {
            let (written, faults) = faults_of(&format!("[report]\npaper = \"{name}\"\n"));
            assert!(faults.is_empty(), "{faults:?}");
            let paper = written.report.paper.map(toml::Spanned::into_inner);
            assert_eq!(paper, Some(impact_report::Paper::UsLetter));
        }
    }

    #[test]
    fn an_unknown_key_names_the_nearest() {
        let (_, faults) = faults_of("[records]\nclearence = \"1 mm\"\n");
        assert!(faults[0].remedy.contains("'clearance'"), "{faults:?}");
    }

    #[test]
    fn broken_syntax_is_one_fault_with_its_line() {
        let (_, faults) = faults_of("[campaign]\nname = \"x\n");
        assert_eq!(faults[0].place.line, Some(2));
        assert!(faults[0].message.contains("TOML"));
        let mut collector = FaultCollector::new(Path::new("campaign.toml"));
        assert!(read("[campaign]\nname = \"x\n", &mut collector).is_none());
    }

    proptest::proptest! {
        #[test]
        fn prop_reading_never_panics_and_ends(text in "[\\[\\]a-z_.=\" 0-9\n{},-]{0,200}") {
            faults_of(&text);
        }
    }
}
