//! No documented key of campaign.toml is without effect: each is changed in turn, and the resolved
//! campaign and an output must change with it, or the change must be refused.

mod changes;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::sync::{Arc, Mutex, OnceLock};

use serde_json::Value;

use self::changes::{CHANGES, Change, Level, add};
use crate::support::{Lab, Ran};

/// The first cells of the tables of docs/campaign.md below the headings `## [table]`.
fn documented() -> BTreeSet<String> {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/campaign.md");
    let page = fs::read_to_string(page).expect("docs/campaign.md");
    let mut table = None;
    let mut keys = BTreeSet::new();
    for line in page.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            table = heading.strip_prefix('[').and_then(|h| h.strip_suffix(']'));
        }
        let cell = line.strip_prefix("| `").and_then(|l| l.split(" | ").next());
        if let (Some(table), Some(cell)) = (table, cell) {
            let names = cell.split('`').step_by(2);
            keys.extend(names.map(|name| format!("{table}.{name}")));
        }
    }
    keys
}

/// The keys that the program accepts in a table, from what it says of an unknown one.
fn accepted(table: &str) -> Vec<String> {
    let lab = Lab::new();
    add(&lab, &table.replace("ROLE", "drive"), "unknown_key = 1");
    let said = lab.run(&["check", "campaign.toml"]).said;
    let list = said.split("unknown field `unknown_key`, expected ").nth(1);
    let list = list
        .expect("the keys expected")
        .lines()
        .next()
        .unwrap_or("");
    list.split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

#[test]
fn every_key_that_is_accepted_is_documented() {
    let documented = documented();
    let tables = [
        "campaign",
        "records",
        "records.attributes",
        "rig",
        "channels.ROLE",
        "analysis",
        "report",
        "published",
    ];
    let keys = tables.iter().flat_map(|table| {
        let accepted = accepted(table).into_iter();
        accepted.map(move |key| format!("{table}.{key}"))
    });
    let accepted: BTreeSet<String> = keys.filter(|key| key != "records.attributes").collect();
    assert_eq!(documented, accepted);
}

/// The resolved campaign and the outputs by name.
type Outputs = (Option<String>, BTreeMap<String, Vec<u8>>);

/// What a campaign gives before its key is changed; once for all changes that begin alike.
fn outputs_before(change: &Change, lab: &Lab) -> Outputs {
    type Known = Arc<OnceLock<Outputs>>;
    static KNOWN: Mutex<BTreeMap<(String, Level), Known>> = Mutex::new(BTreeMap::new());
    let files = ["campaign.toml", "runs.csv", "r1.csv"].map(|name| lab.read(name));
    let key = (files.concat(), change.level);
    let known = KNOWN
        .lock()
        .expect("no panic")
        .entry(key)
        .or_default()
        .clone();
    known.get_or_init(|| outputs(lab, change.level)).clone()
}

fn outputs(lab: &Lab, level: Level) -> Outputs {
    let mut commands: Vec<&[&str]> = vec![&["-q", "ingest", "campaign.toml", "--out", "out"]];
    commands.push(&["-q", "classify", "out"]);
    let by_stages = level < Level::Html && !lab.read("campaign.toml").contains("[published]");
    if level == Level::Identify {
        commands.push(&["-q", "identify", "out"]);
    }
    if !by_stages {
        commands = vec![&["-q", "run", "campaign.toml", "--out", "out"]];
    }
    let mut outputs = BTreeMap::new();
    for command in commands {
        let Ran { code, said } = lab.run(&[&["-j", "1"][..], command].concat());
        if code == 2 {
            outputs.insert("refused".to_owned(), said.into_bytes());
            return (None, outputs);
        }
    }
    for path in ["out", "out/figures"]
        .iter()
        .flat_map(|f| fs::read_dir(lab.path(f)).into_iter().flatten())
    {
        let path = path.expect("an entry").path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let inner =
            name.starts_with("ingested") || name.starts_with("campaign") || name.starts_with('.');
        if path.is_file() && !inner {
            let bytes = fs::read(&path).expect("an output");
            outputs.insert(name.clone(), without_settings(&name, &bytes));
        }
    }
    (Some(lab.read("out/campaign.resolved.json")), outputs)
}

/// An output without the settings and hashes that are repeated in it.
fn without_settings(name: &str, bytes: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(bytes);
    match name {
        "identification.json" => {
            let mut json: Value = serde_json::from_str(&text).expect("JSON");
            let object = json.as_object_mut().expect("an object");
            object.retain(|key, _| key != "settings" && key != "inputs_sha256");
            json.to_string().into_bytes()
        }
        "report.html" => {
            let blocks = text
                .split("<pre>")
                .map(|b| b.rsplit("</pre>").next().unwrap_or(b));
            let whole = blocks.collect::<Vec<_>>().concat();
            let words = whole.split(|c: char| !c.is_ascii_hexdigit());
            let hashes: BTreeSet<&str> = words.filter(|w| w.len() == 64).collect();
            let without = |text: String, hash: &&str| text.replace(*hash, "");
            hashes.iter().fold(whole.clone(), without).into_bytes()
        }
        // of the PDF the sizes of its pages: its text repeats the settings
        "report.pdf" => {
            let pages = text
                .split("MediaBox")
                .skip(1)
                .map(|p| p.split(']').next().unwrap_or(p));
            pages.collect::<Vec<_>>().concat().into_bytes()
        }
        "observations.json.gz"
        | "waveforms.json.gz"
        | "residuals.json.gz"
        | "report_data.json.gz" => Vec::new(),
        _ => bytes.to_vec(),
    }
}

/// What is wrong with a key, if anything.
fn fault(change: &Change) -> Option<String> {
    let (before, after) = (Lab::new(), Lab::new());
    (change.before)(&before);
    (change.before)(&after);
    change.after.make(&after);
    if change.level == Level::Html && !after.read("campaign.toml").contains("formats") {
        add(&before, "report", "formats = [\"html\"]");
        add(&after, "report", "formats = [\"html\"]");
    }
    let (resolved_before, before) = outputs_before(change, &before);
    let (resolved_after, after) = outputs(&after, change.level);
    let key = change.key;
    if before.contains_key("refused") && after.contains_key("refused") {
        return Some(format!(
            "{key}: both refused: {}",
            String::from_utf8_lossy(&after["refused"])
        ));
    }
    match (resolved_before != resolved_after, before != after) {
        (true, true) => None,
        (true, false) => Some(format!("{key} changes no output")),
        (false, _) => Some(format!("{key} does not change the resolved campaign")),
    }
}

#[test]
fn every_documented_key_changes_the_campaign_and_an_output_or_is_refused() {
    let named: BTreeSet<String> = CHANGES.iter().map(|c| c.key.to_owned()).collect();
    assert_eq!(documented(), named, "each documented key is changed here");
    let next = std::sync::atomic::AtomicUsize::new(0);
    let faults = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                while let Some(change) =
                    CHANGES.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed))
                {
                    let fault = fault(change);
                    faults.lock().expect("no panic").extend(fault);
                }
            });
        }
    });
    let faults = faults.into_inner().expect("no panic");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
