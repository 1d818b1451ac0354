//! No key of campaign.toml is without effect: each is changed in turn, and the resolved
//! campaign and an output must change with it, or the change must be refused.

mod changes;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::sync::{Arc, Mutex, OnceLock};

use serde_json::Value;

use self::changes::{CHANGES, Change, Level, add};
use crate::support::{Lab, Ran};
use impact_campaign::campaign::keys::markdown;
use impact_campaign::campaign::sections::SECTIONS;

/// Each key with its table; a key that is a table itself has its own.
fn all_keys() -> BTreeSet<String> {
    let tables = SECTIONS.iter().map(|(table, ..)| *table);
    let tables: BTreeSet<&str> = tables.collect();
    let keys = SECTIONS.iter().flat_map(|(table, keys, _)| {
        let names = keys.iter().map(|key| key.name);
        names.map(move |name| format!("{table}.{name}"))
    });
    keys.filter(|key| !tables.contains(key.as_str())).collect()
}

/// A page with the first table below a heading replaced.
fn with_table(page: &str, heading: &str, table: &str) -> String {
    let (before, after) = page.split_once(heading).expect(heading);
    let start = after.find("\n| ").expect("a table") + 1;
    let end = after[start..].find("\n\n").expect("an end") + start + 1;
    format!(
        "{before}{heading}{}{table}{}",
        &after[..start],
        &after[end..]
    )
}

#[test]
fn the_tables_of_campaign_md_are_those_of_the_keys() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/campaign.md");
    let page = fs::read_to_string(path).expect("docs/campaign.md");
    let wanted = SECTIONS
        .iter()
        .fold(page.clone(), |page, (name, keys, heading)| {
            with_table(&page, &format!("## [{name}]\n"), &markdown(keys, heading))
        });
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(path, &wanted).expect("docs/campaign.md is written");
    }
    assert!(
        page == wanted || std::env::var_os("UPDATE_DOCS").is_some(),
        "docs/campaign.md differs from the keys: UPDATE_DOCS=1 cargo test updates it"
    );
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
fn every_key_changes_the_campaign_and_an_output_or_is_refused() {
    let named: BTreeSet<String> = CHANGES.iter().map(|c| c.key.to_owned()).collect();
    assert_eq!(all_keys(), named, "each key is changed here");
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
