//! Wrong inputs. Each case changes a good campaign in one way; the message must name the remedy
//! and the exit code must be right.

mod in_campaign_toml;
mod in_outputs;
mod in_records;
mod in_run_table;
mod physical;

use crate::support::Lab;

/// One wrong input.
pub(crate) struct Case {
    /// What is wrong, for the table.
    pub input: &'static str,
    /// How a good campaign is made wrong.
    pub spoil: Box<dyn Fn(&Lab)>,
    /// The command.
    pub run: &'static [&'static str],
    /// What the message must contain.
    pub says: &'static [&'static str],
    /// Exit code.
    pub code: i32,
}

/// The command of most cases.
pub(crate) const CHECK: &[&str] = &["check", "campaign.toml"];

impl Case {
    /// A case of `impactid check`.
    fn checked(
        input: &'static str,
        spoil: impl Fn(&Lab) + 'static,
        says: &'static [&'static str],
        code: i32,
    ) -> Self {
        Self {
            input,
            spoil: Box::new(spoil),
            run: CHECK,
            says,
            code,
        }
    }
}

/// A case of `impactid check` that ends with 2.
pub(crate) fn refused(
    input: &'static str,
    spoil: impl Fn(&Lab) + 'static,
    says: &'static [&'static str],
) -> Case {
    Case::checked(input, spoil, says, 2)
}

/// The same of words of campaign.toml that are replaced.
pub(crate) fn edited(
    input: &'static str,
    from: &'static str,
    to: &'static str,
    says: &'static [&'static str],
) -> Case {
    refused(input, move |lab: &Lab| lab.edit(from, to), says)
}

/// The same of words of the run table.
pub(crate) fn table_edited(
    input: &'static str,
    from: &'static str,
    to: &'static str,
    says: &'static [&'static str],
) -> Case {
    refused(
        input,
        move |lab: &Lab| lab.replace("runs.csv", from, to),
        says,
    )
}

/// A case of `impactid check` that is noted and goes on.
pub(crate) fn noted(
    input: &'static str,
    spoil: impl Fn(&Lab) + 'static,
    says: &'static [&'static str],
) -> Case {
    Case::checked(input, spoil, says, 0)
}

fn groups() -> [(&'static str, Vec<Case>); 5] {
    [
        ("campaign.toml", in_campaign_toml::cases()),
        ("Run table", in_run_table::cases()),
        ("Records", in_records::cases()),
        ("Contradictions", physical::cases()),
        ("Command and output", in_outputs::cases()),
    ]
}

fn test_all(cases: &[Case]) {
    let mut failures = Vec::new();
    for case in cases {
        let lab = Lab::new();
        (case.spoil)(&lab);
        let ran = lab.run(case.run);
        let missing: Vec<_> = case
            .says
            .iter()
            .filter(|s| !ran.said.contains(**s))
            .collect();
        let helps = ran.said.lines().filter_map(|l| l.strip_prefix("  help: "));
        let unlike: Vec<&str> = helps.filter(|help| !is_in_style(help)).collect();
        assert!(unlike.is_empty(), "{}: {unlike:?}", case.input);
        if !missing.is_empty() || ran.code != case.code {
            failures.push(format!(
                "{}: exit {} (expected {}), not said: {missing:?}\n{}",
                case.input, ran.code, case.code, ran.said
            ));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Whether a remedy begins with a small letter (names and symbols aside) and ends without a full stop.
fn is_in_style(help: &str) -> bool {
    let mut letters = help.chars();
    let capital = letters.next().is_some_and(char::is_uppercase);
    let word = letters.next().is_some_and(char::is_lowercase);
    !(help.ends_with('.') || capital && word)
}

#[test]
fn the_good_campaign_has_no_fault() {
    let ran = Lab::new().run(CHECK);
    assert_eq!(ran.code, 0, "{}", ran.said);
    assert!(
        ran.said.contains("3 of 3 records can be used"),
        "{}",
        ran.said
    );
}

#[test]
fn faults_in_campaign_toml() {
    test_all(&in_campaign_toml::cases());
}

/// What a process has taken so far: the most memory it held, KiB, and seconds of processors.
#[cfg(target_os = "linux")]
fn taken(id: u32) -> Option<(u64, f64)> {
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let held = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let stat = std::fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
    let after = stat.rsplit_once(')')?.1;
    let ticks = after.split_whitespace().skip(11).take(2);
    let ticks: u64 = ticks.filter_map(|t| t.parse::<u64>().ok()).sum();
    let held = held.split_whitespace().next()?.parse().ok()?;
    Some((held, ticks as f64 / 100.0))
}

/// Bombs end in an error within a second of a processor's time and under 256 MiB.
#[cfg(target_os = "linux")]
#[test]
fn bombs_end_soon_and_in_little_memory() {
    for case in in_records::bombs() {
        let lab = Lab::new();
        (case.spoil)(&lab);
        // the good records take their time too
        lab.write(
            "runs.csv",
            &lab.read("runs.csv").replace("r3.csv,13,1.0,down\n", ""),
        );
        let mut run = std::process::Command::new(env!("CARGO_BIN_EXE_impactid"))
            .args(["-q", "--threads", "2", "check", "campaign.toml"])
            .current_dir(lab.folder())
            .stderr(std::process::Stdio::null())
            .stdout(std::process::Stdio::null())
            .spawn()
            .expect("the program starts");
        let (mut held_kib, mut seconds) = (0, 0.0);
        let ended = loop {
            if let Some((kib, s)) = taken(run.id()) {
                (held_kib, seconds) = (kib.max(held_kib), s);
            }
            if let Some(ended) = run.try_wait().expect("its state") {
                break ended;
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        };
        println!("{}: {seconds} s, {held_kib} KiB", case.input);
        assert_eq!(ended.code(), Some(2), "{}", case.input);
        assert!(seconds < 1.0, "{}: {seconds} s", case.input);
        assert!(held_kib < 256 * 1024, "{}: {held_kib} KiB", case.input);
    }
}

#[test]
fn faults_in_the_run_table() {
    test_all(&in_run_table::cases());
}

#[test]
fn faults_in_records() {
    test_all(&in_records::cases());
}

#[test]
fn contradictions() {
    test_all(&physical::cases());
}

#[test]
fn faults_of_command_and_output() {
    test_all(&in_outputs::cases());
}

/// docs/robustness.md from the cases.
fn document() -> String {
    let mut text = String::from(
        "# Wrong inputs that are recognised\n\n\
         Each is a case in `tests/robustness`: a good campaign is changed in this one way, and the message states\n\
         the file, the line or channel, and a remedy. It is an error that stops the campaign or leaves a record\n\
         out, with exit code 2; what is only noted says so.\n",
    );
    for (title, cases) in groups() {
        text += &format!("\n## {title}\n\n");
        for case in cases {
            let input = case.input.replace('<', "\\<");
            let how = match case.code {
                0 => " (noted)".to_owned(),
                2 => String::new(),
                code => format!(" (exit code {code})"),
            };
            text += &format!("- {input}{how}\n");
        }
    }
    text
}

#[test]
fn regress_docs_robustness_md_lists_the_cases() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/robustness.md");
    let expected = document();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(path, &expected).expect("docs/ can be written");
    }
    let found = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        found == expected,
        "docs/robustness.md differs from the cases: UPDATE_DOCS=1 cargo test updates it"
    );
    assert!(groups().iter().map(|(_, cases)| cases.len()).sum::<usize>() >= 60);
}
