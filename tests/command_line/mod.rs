//! The commands as a user meets them.

mod json;
mod keys;
mod notes;
mod several;
mod verbosity;
mod warnings;

use std::fs;

use crate::support::Lab;

#[test]
fn help_of_each_command_shows_an_example_and_ends_with_0() {
    let lab = Lab::new();
    for command in [
        "init", "check", "run", "ingest", "classify", "identify", "report", "simulate", "sweep",
        "basins", "atlas", "watch", "merge", "study", "boundary",
    ] {
        let ran = lab.run(&[command, "--help"]);
        assert_eq!(ran.code, 0, "{command}");
        assert!(ran.said.contains("Example:"), "{command}: {}", ran.said);
    }
    assert_eq!(lab.run(&["--version"]).code, 0);
}

/// The example of `simulate` that writes into `chaos/` is chaotic.
#[test]
fn valid_the_example_called_chaos_is_chaotic() {
    let lab = Lab::new();
    let help = lab.run(&["simulate", "--help"]).said;
    let line = help.lines().find(|l| l.ends_with("--out chaos/"));
    let words: Vec<&str> = line.expect("the example").split_whitespace().collect();
    let value = |name: &str| words[1 + words.iter().position(|w| *w == name).expect(name)];
    let (eta, rho) = (value("--eta"), value("--rho"));
    let sweep = [
        "-q", "sweep", "--rho", rho, "--steps", "2", "--out", "sweep", "--eta",
    ];
    let range = format!("{eta}..{eta}1");
    assert_eq!(lab.run(&[&sweep[..], &[&range]].concat()).code, 0);
    let table = lab.read("sweep/sweep.csv");
    assert!(
        table.lines().nth(1).expect("a row").contains(",chaotic,"),
        "{table}"
    );
}

#[test]
fn check_changes_nothing() {
    let lab = Lab::new();
    let list = || {
        let mut names: Vec<_> = fs::read_dir(lab.folder())
            .expect("the folder")
            .map(|e| e.expect("an entry"))
            .map(|e| {
                (
                    e.file_name(),
                    e.metadata().expect("its metadata").modified().ok(),
                )
            })
            .collect();
        names.sort();
        names
    };
    let before = list();
    lab.run(&["check", "campaign.toml"]);
    assert_eq!(before, list());
}

#[test]
fn quiet_prints_nothing_for_a_good_campaign() {
    let ran = Lab::new().run(&["--quiet", "check", "campaign.toml"]);
    assert_eq!((ran.code, ran.said.as_str()), (0, ""));
}

#[test]
fn output_in_a_pipe_has_no_colour_and_no_bar() {
    let lab = Lab::new();
    lab.edit("\"double\"", "\"triple\"");
    let ran = lab.run(&["check", "campaign.toml"]);
    assert!(
        !ran.said.contains('\u{1b}') && !ran.said.contains('\r'),
        "{:?}",
        ran.said
    );
}

#[test]
fn all_problems_are_listed_in_one_run() {
    let lab = Lab::new();
    lab.edit("\"double\"", "\"triple\"");
    lab.edit("restitution = 0.9", "restitution = 9");
    lab.edit("\"50 mm/s per V\"\nhigh", "\"50 mm/s\"\nhigh");
    lab.replace("runs.csv", "clearance_mm", "clearance");
    let said = lab.run(&["check", "campaign.toml"]).said;
    for words in [
        "triple",
        "rig.restitution",
        "channels.velocity_x.scale",
        "clearance without unit",
    ] {
        assert!(said.contains(words), "{words} is not in {said}");
    }
}

#[test]
fn init_writes_a_campaign_that_check_understands() {
    let lab = Lab::new();
    lab.remove("campaign.toml");
    lab.remove("runs.csv");
    let ran = lab.run(&["init", "."]);
    assert_eq!(ran.code, 0, "{}", ran.said);
    let text = lab.read("campaign.toml");
    for words in [
        "files = \"*.csv\"",
        "machine = \"double\"",
        "[channels.drive]",
        "[channels.velocity_x]",
        "[channels.velocity_y]",
        "[channels.contact]\nchannel = \"contact\"",
        "threshold = \"2.5",
    ] {
        assert!(text.contains(words), "{words} is not in {text}");
    }
    // the remaining work is listed: volts are no velocity
    let ran = lab.run(&["check", "campaign.toml"]);
    assert_eq!(ran.code, 2);
    assert!(ran.said.contains("comes out as a voltage"), "{}", ran.said);
    lab.edit("# scale", "scale");
    assert_eq!(lab.run(&["check", "campaign.toml"]).code, 0);
}

#[test]
fn check_of_records_that_cannot_be_used_is_an_error() {
    let lab = Lab::new();
    // each record has a fault of its own
    for (name, rows) in [("r1.csv", 300), ("r2.csv", 301), ("r3.csv", 302)] {
        lab.lines(name, |i, line| (i != rows).then(|| line.to_owned()));
    }
    let ran = lab.run(&["check", "campaign.toml"]);
    assert_eq!(ran.code, 2);
    for words in ["none of the 3 records can be used", "1 error,"] {
        assert!(ran.said.contains(words), "{words} is not in {}", ran.said);
    }
}

#[test]
fn german_tables_and_texts_in_utf16_are_read() {
    let lab = Lab::new();
    let table = "Datei;Frequenz [Hz];Spalt [mm];Richtung;Bemerkung\r\nr1.csv;11,0;1,0;auf;\r\nr2.csv;12,0;1,0;auf;\r\n\
                 r3.csv;13,0;1,0;ab;gut\r\n";
    let unicode = |text: &str| -> Vec<u8> {
        let marked = format!("\u{feff}{text}");
        marked.encode_utf16().flat_map(u16::to_le_bytes).collect()
    };
    lab.write_bytes("runs.csv", &unicode(table));
    let campaign = lab.read("campaign.toml");
    lab.write_bytes("campaign.toml", &unicode(&campaign));
    let ran = lab.run(&["check", "campaign.toml"]);
    assert_eq!(ran.code, 0, "{}", ran.said);
    assert!(
        ran.said.contains("3 of 3 records can be used"),
        "{}",
        ran.said
    );
}

#[test]
fn another_format_after_a_run_needs_no_new_run() {
    let lab = Lab::new();
    let ran = lab.run(&[
        "run",
        "campaign.toml",
        "--out",
        "out",
        "--format",
        "csv,csv",
    ]);
    assert!(ran.code < 2, "{}", ran.said);
    assert_eq!(ran.said.matches("Report (csv)").count(), 1, "{}", ran.said);
    let ran = lab.run(&["report", "out", "--format", "svg"]);
    assert_eq!(ran.code, 0, "{}", ran.said);
    let figures = fs::read_dir(lab.path("out/figures")).expect("figures");
    let svg = figures
        .filter_map(Result::ok)
        .filter(|f| f.path().extension().is_some_and(|e| e == "svg"));
    assert!(svg.count() > 0);
    let beside = lab.run(&["report", "out", "--format", "svg", "--out", "elsewhere"]);
    assert_eq!(beside.code, 2);
    let said = "out has the results, and elsewhere is named beside it with --out";
    assert!(beside.said.contains(said), "{}", beside.said);
}

#[test]
fn init_finds_a_run_table() {
    let lab = Lab::new();
    let ran = lab.run(&["init", ".", "--force"]);
    assert_eq!(ran.code, 0, "{}", ran.said);
    assert!(
        lab.read("campaign.toml")
            .contains("run_table = \"runs.csv\"")
    );
}

#[test]
fn check_works_from_another_folder() {
    let lab = Lab::new();
    fs::create_dir(lab.path("elsewhere")).expect("a folder");
    let path = lab.path("campaign.toml");
    let ran = lab.run(&["check", path.to_str().expect("a name in UTF-8")]);
    assert_eq!(ran.code, 0, "{}", ran.said);
}

#[test]
fn completions_and_man_pages_name_the_commands() {
    let lab = Lab::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let ran = lab.run(&["completions", shell]);
        assert_eq!(ran.code, 0, "{shell}");
        assert!(ran.said.contains("simulate"), "{shell}");
    }
    assert_eq!(lab.run(&["man", "--out", "man1"]).code, 0);
    let page = lab.read("man1/impactid-run.1");
    assert!(
        page.contains("resume") && page.contains("Example"),
        "{page}"
    );
}

#[test]
fn valid_selftest_meets_the_published_numbers() {
    let ran = Lab::new().run(&["selftest"]);
    assert_eq!(ran.code, 0, "{}", ran.said);
    assert!(
        ran.said
            .contains("18 of 18 published numbers are reproduced"),
        "{}",
        ran.said
    );
}
