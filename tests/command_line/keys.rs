//! No documented key of campaign.toml is without effect: each is changed in turn, and the resolved
//! campaign and an output must change with it, or the change must be refused.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock};

use serde_json::Value;

use crate::support::{Lab, RUNS, Ran};

/// The outputs in which an effect is looked for; each level contains those before it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    /// records.parquet, impacts.parquet, boundaries.csv.
    Classify,
    /// identification.json.
    Identify,
    /// The report as HTML, the data of the figures, the names of all files.
    Html,
    /// The report as PDF, without what it prints of the settings.
    Pdf,
}
use Level::{Classify, Html, Identify, Pdf};

/// One key: a campaign, the same with the key changed, and where the change must be seen.
struct Change {
    key: &'static str,
    level: Level,
    before: fn(&Lab),
    after: fn(&Lab),
}

fn change(key: &'static str, level: Level, after: fn(&Lab)) -> Change {
    let before = |_: &Lab| {};
    Change {
        key,
        level,
        before,
        after,
    }
}

fn between(key: &'static str, level: Level, before: fn(&Lab), after: fn(&Lab)) -> Change {
    Change {
        key,
        level,
        before,
        after,
    }
}

/// Add a line below a table's head; without such a table it is added.
fn add(lab: &Lab, table: &str, line: &str) {
    let head = format!("[{table}]\n");
    let text = lab.read("campaign.toml");
    match text.contains(&head) {
        true => lab.edit(&head, &format!("{head}{line}\n")),
        false => lab.write("campaign.toml", &format!("{text}\n{head}{line}\n")),
    }
}

/// Use the first record alone: nothing but R can be fitted, which is soon done.
fn one_record(lab: &Lab) {
    lab.write(
        "runs.csv",
        &RUNS.lines().take(2).collect::<Vec<_>>().join("\n"),
    );
}

/// A run table that states no setting.
fn bare_table(lab: &Lab) {
    lab.write("runs.csv", "file\nr1.csv\nr2.csv\nr3.csv\n");
}

/// Files with attributes that the run table does not state.
fn with_attributes(lab: &Lab) {
    bare_table(lab);
    let attributes = "# gap_mm = 1.5\n# freq_hz = 11.1\n# way = up\n# rig = A\n";
    for name in ["r1.csv", "r2.csv", "r3.csv"] {
        lab.write(name, &format!("{attributes}{}", lab.read(name)));
    }
}

/// Files without a time column.
fn untimed(lab: &Lab) {
    for name in ["r1.csv", "r2.csv", "r3.csv"] {
        lab.lines(name, |_, line| Some(line.split_once(',')?.1.to_owned()));
    }
}

/// Files with a second, slower clock, and the velocity x a second time, halved.
fn with_spare_channels(lab: &Lab) {
    for name in ["r1.csv", "r2.csv", "r3.csv"] {
        lab.lines(name, |i, line| {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |k: usize| cells[k].parse::<f64>().unwrap_or(0.0);
            Some(match i {
                0 => format!("{line},clock [s],spare [V]"),
                _ => format!("{line},{:.6},{:.6}", 2.0 * number(0), 0.5 * number(3)),
            })
        });
    }
}

/// A synthetic campaign with impactless, periodic and period-doubled records.
fn synthetic(lab: &Lab) {
    static SIMULATED: OnceLock<Lab> = OnceLock::new();
    let simulated = SIMULATED.get_or_init(|| {
        let lab = Lab::new();
        run(
            &lab,
            &[
                "simulate",
                "campaign",
                "--seed",
                "4",
                "--records",
                "10",
                "--out",
                "rig",
            ],
        );
        run(
            &lab,
            &[
                "convert",
                "rig/records.h5",
                "--out",
                "rig/level.h5",
                "--set",
                "level=1.002",
            ],
        );
        lab
    });
    for file in fs::read_dir(simulated.path("rig")).expect("a campaign") {
        let file = file.expect("an entry");
        fs::copy(file.path(), lab.folder().join(file.file_name())).expect("a copy");
    }
    add(lab, "analysis", "uncertainty = \"covariance\"");
}

/// The same with an attribute in each record.
fn synthetic_with_level(lab: &Lab) {
    synthetic(lab);
    lab.replace("runs.csv", "records.h5", "level.h5");
}

/// The same with masses that are stated.
fn weighed(lab: &Lab) {
    synthetic(lab);
    add(lab, "rig", "mass_x = \"1 kg\"\nmass_y = \"1 kg\"");
}

fn run(lab: &Lab, arguments: &[&str]) {
    let ran = lab.run(arguments);
    assert_eq!(ran.code, 0, "{}", ran.said);
}

/// A campaign of published speeds, whose report is soon made.
fn published(lab: &Lab) {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("data-samples/published-speeds");
    for name in ["campaign.toml", "speeds.csv"] {
        fs::copy(sample.join(name), lab.path(name)).expect("the sample");
    }
    add(lab, "report", "formats = [\"html\"]");
}

fn published_pdf(lab: &Lab) {
    published(lab);
    lab.edit("[\"html\"]", "[\"pdf\"]");
}

fn bootstrap(lab: &Lab) {
    synthetic(lab);
    lab.edit("\"covariance\"", "\"bootstrap\"\nreplicas = 4");
}

fn of_campaign() -> Vec<Change> {
    vec![
        between("campaign.name", Html, one_record, |lab| {
            lab.edit("\"Test rig\"", "\"Other\"")
        }),
        change("campaign.machine", Classify, |lab| {
            lab.edit("\"double\"", "\"single\"")
        }),
        change("campaign.flight", Classify, |lab| {
            lab.edit("\"harmonic\"", "\"constant_force\"")
        }),
        between("campaign.synthetic", Html, one_record, |lab| {
            add(lab, "campaign", "synthetic = true")
        }),
        between("campaign.laboratory", Html, one_record, |lab| {
            add(lab, "campaign", "laboratory = \"Here\"")
        }),
        between("campaign.measured", Html, one_record, |lab| {
            add(lab, "campaign", "measured = \"Today\"")
        }),
    ]
}

fn of_records() -> Vec<Change> {
    vec![
        change("records.files", Classify, |lab| {
            lab.edit("run_table = \"runs.csv\"", "files = \"r?.csv\"")
        }),
        change("records.run_table", Classify, |lab| {
            one_record(lab);
            fs::rename(lab.path("runs.csv"), lab.path("other.csv")).expect("another name");
            lab.write("runs.csv", RUNS);
            lab.edit("runs.csv", "other.csv");
        }),
        between(
            "records.sample_rate",
            Classify,
            |lab| {
                untimed(lab);
                add(lab, "records", "sample_rate = \"2 kHz\"");
            },
            |lab| lab.edit("2 kHz", "1 kHz"),
        ),
        between("records.time", Classify, with_spare_channels, |lab| {
            add(lab, "records", "time = \"clock\"")
        }),
        between("records.clearance", Classify, bare_table, |lab| {
            add(lab, "records", "clearance = \"2 mm\"")
        }),
        between("records.drive_frequency", Classify, bare_table, |lab| {
            add(lab, "records", "drive_frequency = \"11 Hz\"");
        }),
        between("records.drive_amplitude", Identify, synthetic, |lab| {
            add(lab, "records", "drive_amplitude = 1.002");
        }),
        between("records.sweep", Classify, bare_table, |lab| {
            add(lab, "records", "sweep = \"down\"")
        }),
        change("records.excitation", Classify, |lab| {
            add(lab, "records", "excitation = \"free_decay\"")
        }),
        between(
            "records.attributes.clearance",
            Classify,
            with_attributes,
            |lab| {
                add(lab, "records.attributes", "clearance = \"gap_mm\"");
            },
        ),
        between(
            "records.attributes.drive_frequency",
            Classify,
            with_attributes,
            |lab| {
                add(lab, "records.attributes", "drive_frequency = \"freq_hz\"");
            },
        ),
        between(
            "records.attributes.drive_amplitude",
            Identify,
            synthetic_with_level,
            |lab| {
                add(lab, "records.attributes", "drive_amplitude = \"level\"");
            },
        ),
        between(
            "records.attributes.sweep",
            Classify,
            with_attributes,
            |lab| {
                add(lab, "records.attributes", "sweep = \"way\"");
            },
        ),
        between(
            "records.attributes.specimen",
            Classify,
            with_attributes,
            |lab| {
                add(lab, "records.attributes", "specimen = \"rig\"");
            },
        ),
    ]
}

fn of_rig() -> Vec<Change> {
    vec![
        between("rig.natural_frequency", Html, one_record, |lab| {
            lab.edit("\"12.6 Hz\"", "\"13 Hz\"")
        }),
        between("rig.damping_ratio", Html, one_record, |lab| {
            lab.edit("= 0.07", "= 0.08")
        }),
        between("rig.static_deflection", Html, one_record, |lab| {
            add(lab, "rig", "static_deflection = \"1 mm\"")
        }),
        between("rig.restitution", Html, one_record, |lab| {
            lab.edit("= 0.9", "= 0.8")
        }),
        between("rig.gain_uncertainty", Identify, synthetic, |lab| {
            lab.edit("\"0.5 %\"", "\"2 %\"")
        }),
        between("rig.corner_uncertainty", Identify, synthetic, |lab| {
            lab.edit("\"2 %\"", "\"8 %\"")
        }),
        between("rig.mass_x", Identify, weighed, |lab| {
            lab.edit("mass_x = \"1 kg\"", "mass_x = \"1.02 kg\"");
        }),
        between("rig.mass_y", Identify, weighed, |lab| {
            lab.edit("mass_y = \"1 kg\"", "mass_y = \"1.02 kg\"");
        }),
        between("rig.mass_uncertainty", Identify, weighed, |lab| {
            add(lab, "rig", "mass_uncertainty = \"5 %\"");
        }),
        between("rig.effects", Identify, synthetic, |lab| {
            add(lab, "rig", "effects = [\"drift\"]");
        }),
        between("rig.clearance_uncertainty", Identify, synthetic, |lab| {
            add(lab, "rig", "clearance_uncertainty = \"50 um\"");
        }),
    ]
}

fn of_channels() -> Vec<Change> {
    vec![
        between(
            "channels.ROLE.channel",
            Classify,
            with_spare_channels,
            |lab| lab.edit("\"vx\"", "\"spare\""),
        ),
        change("channels.ROLE.unit", Classify, |lab| {
            lab.edit("\"vx\"\nunit = \"V\"", "\"vx\"\nunit = \"mV\"")
        }),
        change("channels.ROLE.scale", Classify, |lab| {
            lab.edit("\"50 mm/s per V\"\nhigh", "\"40 mm/s per V\"\nhigh")
        }),
        change("channels.ROLE.offset", Classify, |lab| {
            add(lab, "channels.contact", "offset = \"3 V\"")
        }),
        change("channels.ROLE.sign", Classify, |lab| {
            lab.edit("sign = 1", "sign = -1")
        }),
        change("channels.ROLE.high_pass", Classify, |lab| {
            lab.edit("\"0.5 Hz\"", "\"2 Hz\"")
        }),
        between("channels.ROLE.delay", Identify, synthetic, |lab| {
            add(lab, "channels.velocity_x", "delay = \"0.1 ms\"");
        }),
        between(
            "channels.ROLE.delay_uncertainty",
            Identify,
            synthetic,
            |lab| {
                add(lab, "channels.velocity_x", "delay_uncertainty = \"5 us\"");
            },
        ),
        change("channels.ROLE.threshold", Classify, |lab| {
            lab.edit("\"2.5 V\"", "\"6 V\"")
        }),
        change("channels.ROLE.range", Classify, |lab| {
            add(lab, "channels.velocity_x", "range = \"0.5 V\"")
        }),
        between(
            "channels.ROLE.ignore_file_unit",
            Classify,
            |lab| lab.edit("\"vx\"\nunit = \"V\"", "\"vx\"\nunit = \"mV\""),
            |lab| add(lab, "channels.velocity_x", "ignore_file_unit = true"),
        ),
        between("channels.ROLE.instrument", Html, one_record, |lab| {
            add(lab, "channels.contact", "instrument = \"a wire\"");
        }),
    ]
}

fn of_analysis() -> Vec<Change> {
    vec![
        change("analysis.exclude", Classify, |lab| {
            add(lab, "analysis", "exclude = [\"r2\"]")
        }),
        change("analysis.skip", Classify, |lab| {
            add(lab, "analysis", "skip = \"0.3 s\"")
        }),
        between("analysis.longest_period_n", Classify, synthetic, |lab| {
            add(lab, "analysis", "longest_period_n = 1");
        }),
        between("analysis.most_impacts_p", Classify, synthetic, |lab| {
            add(lab, "analysis", "most_impacts_p = 1");
        }),
        between("analysis.seed", Identify, bootstrap, |lab| {
            add(lab, "analysis", "seed = 7")
        }),
        between("analysis.uncertainty", Identify, synthetic, |lab| {
            lab.edit("\"covariance\"", "\"profile\"")
        }),
        between("analysis.replicas", Identify, bootstrap, |lab| {
            lab.edit("replicas = 4", "replicas = 6")
        }),
    ]
}

fn of_report() -> Vec<Change> {
    vec![
        between("report.title", Html, published, |lab| {
            add(lab, "report", "title = \"Other\"")
        }),
        between(
            "report.points",
            Html,
            |lab| {
                add(lab, "analysis", "exclude = [\"r2\", \"r3\"]");
                add(lab, "report", "formats = [\"html\"]\npoints = [\"r1\"]");
            },
            |lab| lab.edit("[\"r1\"]", "[\"r2\"]"),
        ),
        between("report.formats", Html, published, |lab| {
            lab.edit("[\"html\"]", "[\"html\", \"svg\"]")
        }),
        between("report.paper", Pdf, published_pdf, |lab| {
            add(lab, "report", "paper = \"us-letter\"")
        }),
        between("report.decimal_comma", Html, published, |lab| {
            add(lab, "report", "decimal_comma = true")
        }),
        between("report.logo", Html, published, |lab| {
            let image = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'/>";
            lab.write("logo.svg", image);
            add(lab, "report", "logo = \"logo.svg\"");
        }),
        between("report.template", Pdf, published_pdf, |lab| {
            lab.write("mine.typ", "#set page(width: 40mm, height: 30mm)\nMine");
            add(lab, "report", "template = \"mine.typ\"");
        }),
        between("report.words", Html, published, |lab| {
            let blank = lab.run(&["report", "--list-words"]).said;
            // each phrase with a dot behind it
            let words = blank.replace("\"\n", "·\"\n").replace("en·", "en");
            lab.write("words.toml", &words);
            add(lab, "report", "words = \"words.toml\"");
        }),
        between("report.language", Html, published, |lab| {
            add(lab, "report", "language = \"de\"")
        }),
    ]
}

fn of_published() -> Vec<Change> {
    vec![
        between("published.speeds", Identify, published, |lab| {
            let kept: Vec<String> = lab.read("speeds.csv").lines().map(str::to_owned).collect();
            lab.write("fewer.csv", &(kept[..kept.len() - 1].join("\n") + "\n"));
            lab.edit("\"speeds.csv\"", "\"fewer.csv\"");
        }),
        between(
            "published.damping_ratio_hypotheses",
            Identify,
            published,
            |lab| {
                lab.edit("[0.02, 0.002]", "[0.02]");
            },
        ),
    ]
}

fn changes() -> Vec<Change> {
    [
        of_campaign(),
        of_records(),
        of_rig(),
        of_channels(),
        of_analysis(),
        of_report(),
        of_published(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

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
    let by_stages = level < Html && !lab.read("campaign.toml").contains("[published]");
    if level == Identify {
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
        "fit.json" | "observations.json.gz" => Vec::new(),
        _ => bytes.to_vec(),
    }
}

/// What is wrong with a key, if anything.
fn fault(change: &Change) -> Option<String> {
    let (before, after) = (Lab::new(), Lab::new());
    (change.before)(&before);
    (change.before)(&after);
    (change.after)(&after);
    if change.level == Html && !after.read("campaign.toml").contains("formats") {
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
    let changes = changes();
    let named: BTreeSet<String> = changes.iter().map(|c| c.key.to_owned()).collect();
    assert_eq!(documented(), named, "each documented key is changed here");
    let next = std::sync::atomic::AtomicUsize::new(0);
    let faults = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                while let Some(change) =
                    changes.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed))
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
