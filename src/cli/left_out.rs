//! Which records are left out for a fault, as the commands that identify print it.

use std::path::Path;

use super::Verbosity;
use super::outputs::{LeftOutRecords, Output};
use super::speech::Speech;
use impact_campaign::campaign::check::LISTED;
use impact_campaign::campaign::diagnostic::{Diagnostic, Diagnostics, Group, Severity};
use impact_records::message::Print;
use impact_records::motion::Observation;
use impact_records::record::{Flag, FlagCode};

/// Print one line for each kind of fault that leaves records out; with `-v` each record too.
pub(super) fn print_left_out(observations: &[Observation], speech: &Speech, verbosity: Verbosity) {
    let words = speech.words();
    let faults = faults(observations).said(words.as_ref());
    for group in faults.groups() {
        verbosity.info(&line(&group, observations.len(), words.as_ref()));
        for one in &group.0 {
            verbosity.detail(&format!("  {}", one.headline()));
        }
    }
}

/// The first fault of each record that leaves it out: others may only follow from it; of a record that is used, that
/// it contradicts what is stated of it. None are those of records that campaign.toml excludes, and none that were
/// reported when the campaign was read.
fn faults(observations: &[Observation]) -> Diagnostics {
    let wanted = |o: &&Observation| !o.has_flag(FlagCode::Excluded);
    let each = observations.iter().filter(wanted).filter_map(|o| {
        let contradicts = |f: &&Flag| {
            let codes = [FlagCode::BeyondStop, FlagCode::DriveAmplitudeContradicts];
            codes.contains(&f.code)
        };
        let mut flags = o.flags.iter();
        let excluding = flags.clone().find(|f| f.excludes);
        let first = excluding.or_else(|| flags.find(contradicts))?;
        let is_new = !LISTED.contains(&first.code);
        is_new.then(|| Diagnostic::of_flag(Path::new(""), &o.record, first))
    });
    Diagnostics(each.collect())
}

/// One kind of fault: in how many records, which one, the first of them, and what to do.
fn line(group: &Group<'_>, records: usize, words: &dyn Print) -> String {
    let count = group.0.len();
    let left = LeftOutRecords {
        count,
        of: records,
        fault: group.headline(words),
        remedy: group.0.first().map_or(String::new(), |d| d.remedy.clone()),
    };
    let used = group.0.iter().all(|d| d.severity == Severity::Note);
    let output = match count {
        _ if used => Output::Contradicting(left),
        1 => Output::OneLeftOut(left),
        _ => Output::SomeLeftOut(left),
    };
    words.print(&output)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::message::Typed;
    use impact_records::motion::Motion;
    use impact_records::record::Problem;

    #[test]
    fn a_displacement_beyond_the_stop_is_named_though_its_record_is_used() {
        let problem = Problem::PathBeyondStop {
            reached_m: 0.03,
            clearance_m: 0.02,
        };
        let mut of = Observation::of("r1", 12.0, Motion::Impactless);
        of.flags = vec![Flag::new(Some("laser_x"), problem).excluding(false)];
        let named = faults(&[of]);
        let lines: Vec<String> = named.groups().iter().map(|g| line(g, 9, &Typed)).collect();
        assert!(
            lines.len() == 1
                && lines[0]
                    .starts_with("1 of 9 records: laser_x: the displacement goes 30.0000 mm"),
            "{lines:?}"
        );
    }

    #[test]
    fn a_line_counts_the_records_of_one_fault_and_names_the_first() {
        let of = |record: &str, jumps: usize| {
            let flag = Flag::new(Some("laser_x"), Problem::UpwardJumps { up: jumps, down: 0 });
            Diagnostic::of_flag(Path::new(""), record, &flag)
        };
        let lines = |all: Vec<Diagnostic>| -> Vec<String> {
            let all = Diagnostics(all);
            all.groups().iter().map(|g| line(g, 9, &Typed)).collect()
        };
        assert_eq!(
            lines(vec![of("r1", 5), of("r2", 7)]),
            [
                "2 of 9 records are left out: laser_x: 5 to 7 jumps of the approach velocity go up, 0 down; an impact \
                 jumps down (r1, r2). To do: turn the `sign` of the velocity or displacement channels: positive is \
                 toward the other mass"
            ]
        );
        assert_eq!(
            lines(vec![of("r3", 5)]),
            [
                "1 of 9 records is left out: laser_x: 5 jumps of the approach velocity go up, 0 down; an impact jumps \
                 down (r3). To do: turn the `sign` of the velocity or displacement channels: positive is toward the \
                 other mass"
            ]
        );
    }
}
