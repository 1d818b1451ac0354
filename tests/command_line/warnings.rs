//! Problems that are alike are printed once, by every command; `-v` prints each.

use std::fmt::Write;

use crate::support::Lab;

/// A campaign of twelve records; `change` alters the table of the record with this number.
fn twelve(change: impl Fn(usize, &str) -> String) -> Lab {
    let lab = Lab::new();
    let mut runs = String::from("file,drive_frequency_hz,clearance_mm,sweep\n");
    let record = lab.read("r1.csv");
    for i in 1..=12 {
        // a different first sample, so that no record is another's copy
        let text = record.replacen("0.000000,0.9", &format!("0.000000,0.9{i:02}"), 1);
        lab.write(&format!("r{i}.csv"), &change(i, &text));
        let _ = writeln!(runs, "r{i}.csv,11,1.0,up");
    }
    lab.write("runs.csv", &runs);
    lab
}

/// Two channels without a unit in all records but the last.
fn without_units() -> Lab {
    let lab = twelve(|i, text| match i {
        12 => text.to_owned(),
        _ => text.replacen("vx [V],vy [V]", "vx,vy", 1),
    });
    for name in ["vx", "vy"] {
        let channel = format!("channel = \"{name}\"\n");
        lab.edit(&format!("{channel}unit = \"V\"\n"), &channel);
    }
    lab
}

fn count(text: &str, words: &str) -> usize {
    text.matches(words).count()
}

const NO_UNIT: &str = "states no unit for channel";

#[test]
fn every_command_prints_warnings_that_are_alike_once() {
    let lab = without_units();
    let commands: [&[&str]; 3] = [
        &["check", "campaign.toml"],
        &["ingest", "campaign.toml", "--out", "out"],
        &["run", "campaign.toml", "--out", "out", "--format", "csv"],
    ];
    for command in commands {
        let said = lab.run(command).said;
        assert_eq!(count(&said, NO_UNIT), 2, "{command:?}: {said}");
        for channel in ["vx", "vy"] {
            let line = format!("'{channel}' (in 11 records: r1, r2, r3, r4, r5, r6, …)");
            assert!(said.contains(&line), "{command:?}: {said}");
        }
        assert!(said.contains("Add -v to see each of them."), "{said}");
    }
    for command in &commands[..2] {
        let said = lab.run(&[*command, &["-v"]].concat()).said;
        assert_eq!(count(&said, NO_UNIT), 22, "{command:?}: {said}");
    }
    let said = lab
        .run(&["ingest", "campaign.toml", "--out", "out", "-q"])
        .said;
    assert_eq!(said, "");
}

#[test]
fn a_command_that_stops_prints_warnings_that_are_alike_once() {
    let lab = without_units();
    lab.edit("restitution = 0.9", "restitution = 9");
    let commands: [&[&str]; 4] = [
        &["check", "campaign.toml"],
        &["ingest", "campaign.toml", "--out", "out"],
        &["run", "campaign.toml", "--out", "out"],
        &["plan", "campaign.toml", "--out", "out"],
    ];
    for command in commands {
        let ran = lab.run(command);
        assert_eq!(ran.code, 2);
        assert_eq!(count(&ran.said, NO_UNIT), 2, "{command:?}: {}", ran.said);
        assert!(
            ran.said.contains("rig.restitution"),
            "{command:?}: {}",
            ran.said
        );
    }
}

#[test]
fn messages_alike_but_for_a_number_are_one_with_its_range() {
    let lab = twelve(|i, text| {
        let samples = if i % 3 == 0 { 1200 + i } else { 2000 };
        let lines: Vec<&str> = text.lines().take(1 + samples).collect();
        lines.join("\n") + "\n"
    });
    let said = lab.run(&["check", "campaign.toml"]).said;
    let line =
        "it holds 1203 to 1212 samples, the usual record 2000 (in 4 records: r3, r6, r9, r12)";
    assert!(said.contains(line), "{said}");
    let said = lab.run(&["check", "campaign.toml", "-v"]).said;
    for samples in [1203, 1206, 1209, 1212] {
        assert!(
            said.contains(&format!("it holds {samples} samples")),
            "{said}"
        );
    }
}

#[test]
fn run_states_why_no_record_can_be_used_as_check_does() {
    let lab = Lab::new();
    for name in ["r1.csv", "r2.csv", "r3.csv"] {
        lab.column(name, 3, |_, _| "0.1".into());
    }
    let checked = lab.run(&["check", "campaign.toml"]);
    let ran = lab.run(&["run", "campaign.toml", "--out", "out"]);
    assert_eq!((checked.code, ran.code), (2, 2), "{}", ran.said);
    assert!(
        ran.said.contains("none of the 3 records can be used"),
        "{}",
        ran.said
    );
    for said in [&checked.said, &ran.said] {
        assert!(said.contains("channel 'vx' is constant"), "{said}");
        assert!(said.contains("in 3 records: r1, r2, r3"), "{said}");
    }
}

#[test]
fn what_is_left_out_for_a_fault_is_named_before_the_answer() {
    let lab = twelve(|i, text| match i % 2 {
        0 => text.to_owned(),
        _ => without_motion(text),
    });
    lab.edit("seed = 1", "seed = 1\nexclude = [\"r11\"]");
    let line = "5 of 12 records are left out: vx: channel 'vx' is constant";
    let names = "(r1, r3, r5, r7, r9). To do: ";
    let commands: [&[&str]; 4] = [
        &["run", "campaign.toml", "--out", "out", "--format", "html"],
        &["ingest", "campaign.toml", "--out", "stages"],
        &["classify", "stages"],
        &["identify", "stages"],
    ];
    for (i, command) in commands.iter().enumerate() {
        let said = lab.run(command).said;
        let identifies = matches!(i, 0 | 3);
        assert_eq!(count(&said, line) == 1, identifies, "{command:?}: {said}");
        assert_eq!(said.contains(names), identifies, "{command:?}: {said}");
    }
    let said = lab.run(&["identify", "stages", "-v"]).said;
    assert!(
        said.contains("  r3: vx: channel 'vx' is constant"),
        "{said}"
    );
    assert!(!said.contains("r11"), "{said}");
}

/// A record whose third channel shows nothing.
fn without_motion(text: &str) -> String {
    let lines = text.lines().enumerate().map(|(i, line)| {
        let mut cells: Vec<&str> = line.split(',').collect();
        if i > 0 {
            cells[3] = "0.1";
        }
        cells.join(",") + "\n"
    });
    lines.collect()
}

#[test]
fn problems_of_records_are_stated_in_the_language_of_the_report() {
    let lab = without_units();
    let check = |more: &[&str]| lab.run(&[&["check", "campaign.toml"], more].concat());
    let german = |said: &str| {
        for channel in ["vx", "vy"] {
            let found = format!("die Datei gibt für Kanal „{channel}“ keine Einheit an");
            let line = format!("{found} (in 11 Aufzeichnungen: r1, r2, r3, r4, r5, r6, …)");
            assert!(said.contains(&line), "{said}");
            let remedy = format!(
                "unit = \"…\" in [channels.velocity_{}] angeben",
                &channel[1..]
            );
            assert!(said.contains(&remedy), "{said}");
        }
        assert_eq!(count(said, NO_UNIT), 0, "{said}");
    };
    let english = check(&[]);
    assert_eq!(count(&english.said, NO_UNIT), 2, "{}", english.said);
    let asked = check(&["--language", "de"]);
    assert_eq!(asked.code, english.code);
    german(&asked.said);
    lab.edit("paper = \"a4\"", "paper = \"a4\"\nlanguage = \"de\"");
    german(&check(&[]).said);
    let ran = lab.run(&["ingest", "campaign.toml", "--out", "out"]);
    german(&ran.said);
    let back = check(&["--language", "en"]);
    assert_eq!(count(&back.said, NO_UNIT), 2, "{}", back.said);
    // what programs read is English
    assert!(check(&["--json"]).said.contains(NO_UNIT));
}
