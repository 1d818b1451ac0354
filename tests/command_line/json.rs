//! `--json`: results for programs, on the standard output.

use serde_json::Value;

use crate::support::Lab;

fn printed(lab: &Lab, arguments: &[&str]) -> Value {
    let quiet = [&["-q"], arguments].concat();
    let said = lab.run(&quiet).said;
    // beside it, faults on the other stream
    let begin = said
        .find(['{', '['])
        .unwrap_or_else(|| panic!("{arguments:?}: {said}"));
    let mut values = serde_json::Deserializer::from_str(&said[begin..]).into_iter();
    let first = values.next().expect("a value");
    first.unwrap_or_else(|e| panic!("{arguments:?}: {e}: {said}"))
}

#[test]
fn run_identify_check_and_selftest_print_json() {
    let lab = Lab::new();
    let checked = printed(&lab, &["check", "campaign.toml", "--json"]);
    assert_eq!(
        (&checked["records"], &checked["usable_records"]),
        (&3.into(), &3.into())
    );
    lab.edit("\"double\"", "\"triple\"");
    let faults = printed(&lab, &["check", "campaign.toml", "--json"]);
    let fault = &faults["problems"][0];
    assert_eq!(fault["severity"], "campaign");
    assert!(fault["message"].to_string().contains("triple"), "{fault}");
    lab.edit("\"triple\"", "\"double\"");

    let file = |folder: &str| -> Value {
        let text = lab.read(&format!("{folder}/identification.json"));
        serde_json::from_str(&text).expect("JSON")
    };
    let ran = printed(
        &lab,
        &[
            "run",
            "campaign.toml",
            "--out",
            "out",
            "--format",
            "csv",
            "--json",
        ],
    );
    assert_eq!(ran, file("out"));
    assert!(ran["verdict"].is_object());
    lab.run(&["-q", "ingest", "campaign.toml", "--out", "staged"]);
    lab.run(&["-q", "classify", "staged"]);
    let identified = printed(&lab, &["identify", "staged", "--json"]);
    assert_eq!(identified, file("staged"));

    let numbers = printed(&lab, &["selftest", "--json"]);
    let all = numbers.as_array().expect("a list");
    assert!(
        all.len() > 10
            && all
                .iter()
                .all(|n| n["published"].is_f64() && n["computed"].is_f64())
    );
}
