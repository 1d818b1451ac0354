//! Each documented key of campaign.toml, a campaign in which it has an effect, and how it is changed.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use crate::support::{Lab, RUNS};

/// The outputs in which an effect is looked for; each level contains those before it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Level {
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

/// How a key is changed.
pub(super) enum Edit {
    /// A line below the head of a table of campaign.toml.
    Add(&'static str, &'static str),
    /// A text of campaign.toml and what it becomes.
    Replace(&'static str, &'static str),
    /// Something else.
    By(fn(&Lab)),
}
use Edit::{Add, By, Replace};

impl Edit {
    /// Change the campaign.
    pub(super) fn make(&self, lab: &Lab) {
        match self {
            Add(table, line) => add(lab, table, line),
            Replace(text, by) => lab.edit(text, by),
            By(edit) => edit(lab),
        }
    }
}

/// One key: a campaign, the same with the key changed, and where the change must be seen.
pub(super) struct Change {
    pub(super) key: &'static str,
    pub(super) level: Level,
    pub(super) before: fn(&Lab),
    pub(super) after: Edit,
}

/// A list of changes, one per line.
macro_rules! changes {
    ($(($key:literal, $level:expr, $before:expr, $after:expr);)*) => {
        /// All keys.
        pub(super) const CHANGES: &[Change] = &[
            $(Change { key: $key, level: $level, before: $before, after: $after }),*
        ];
    };
}

changes! {
    ("campaign.name", Html, one_record, Replace(r#""Test rig""#, r#""Other""#));
    ("campaign.machine", Classify, as_is, Replace(r#""double""#, r#""single""#));
    ("campaign.flight", Classify, as_is, Replace(r#""harmonic""#, r#""constant_force""#));
    ("campaign.synthetic", Html, one_record, Add("campaign", "synthetic = true"));
    ("campaign.laboratory", Html, one_record, Add("campaign", r#"laboratory = "Here""#));
    ("campaign.measured", Html, one_record, Add("campaign", r#"measured = "Today""#));
    ("records.files", Classify, as_is, Replace(r#"run_table = "runs.csv""#, r#"files = "r?.csv""#));
    ("records.run_table", Classify, as_is, By(other_run_table));
    ("records.sample_rate", Classify, sampled_at_2_khz, Replace("2 kHz", "1 kHz"));
    ("records.time_unit", Classify, without_unit_of_time, Add("records", r#"time_unit = "ms""#));
    ("records.time", Classify, with_spare_channels, Add("records", r#"time = "clock""#));
    ("records.clearance", Classify, bare_table, Add("records", r#"clearance = "2 mm""#));
    ("records.whole_gaps", Classify, as_is, Add("records", "whole_gaps = true"));
    ("records.drive_frequency", Classify, bare_table, Add("records", r#"drive_frequency = "11 Hz""#));
    ("records.drive_amplitude", Identify, synthetic, Add("records", "drive_amplitude = 1.002"));
    ("records.sweep", Classify, bare_table, Add("records", r#"sweep = "down""#));
    ("records.excitation", Classify, as_is, Add("records", r#"excitation = "free_decay""#));
    ("records.attributes.clearance", Classify, with_attributes, Add("records.attributes", r#"clearance = "gap_mm""#));
    ("records.attributes.drive_frequency", Classify, with_attributes, Add("records.attributes", r#"drive_frequency = "freq_hz""#));
    ("records.attributes.drive_amplitude", Identify, synthetic_with_level, Add("records.attributes", r#"drive_amplitude = "level""#));
    ("records.attributes.sweep", Classify, with_attributes, Add("records.attributes", r#"sweep = "way""#));
    ("records.attributes.specimen", Classify, with_attributes, Add("records.attributes", r#"specimen = "rig""#));
    ("rig.natural_frequency", Html, one_record, Replace(r#""12.6 Hz""#, r#""13 Hz""#));
    ("rig.damping_ratio", Html, one_record, Replace("= 0.07", "= 0.08"));
    ("rig.static_deflection", Html, one_record, Add("rig", r#"static_deflection = "1 mm""#));
    ("rig.restitution", Html, one_record, Replace("= 0.9", "= 0.8"));
    ("rig.gain_uncertainty", Identify, synthetic, Replace(r#""0.5 %""#, r#""2 %""#));
    ("rig.corner_uncertainty", Identify, synthetic, Replace(r#""2 %""#, r#""8 %""#));
    ("rig.clock_uncertainty", Identify, synthetic, Add("rig", r#"clock_uncertainty = "0.1 %""#));
    ("rig.mass_x", Identify, weighed, Replace(r#"mass_x = "1 kg""#, r#"mass_x = "1.02 kg""#));
    ("rig.mass_y", Identify, weighed, Replace(r#"mass_y = "1 kg""#, r#"mass_y = "1.02 kg""#));
    ("rig.mass_uncertainty", Identify, weighed, Add("rig", r#"mass_uncertainty = "5 %""#));
    ("rig.name", Html, one_record, Add("rig", r#"name = "rig 2""#));
    ("rig.shared", Html, one_record, Add("rig", r#"shared = ["gains"]"#));
    ("rig.effects", Identify, synthetic, Add("rig", r#"effects = ["drift"]"#));
    ("rig.clearance_uncertainty", Identify, synthetic, Add("rig", r#"clearance_uncertainty = "50 um""#));
    ("channels.ROLE.channel", Classify, with_spare_channels, Replace(r#""vx""#, r#""spare""#));
    ("channels.ROLE.unit", Classify, as_is, Replace("\"vx\"\nunit = \"V\"", "\"vx\"\nunit = \"mV\""));
    ("channels.ROLE.scale", Classify, as_is, Replace("\"50 mm/s per V\"\nhigh", "\"40 mm/s per V\"\nhigh"));
    ("channels.ROLE.offset", Classify, as_is, Add("channels.contact", r#"offset = "3 V""#));
    ("channels.ROLE.sign", Identify, as_is, Replace("sign = 1", "sign = -1"));
    ("channels.ROLE.high_pass", Classify, as_is, Replace(r#""0.5 Hz""#, r#""2 Hz""#));
    ("channels.ROLE.low_pass", Classify, as_is, Add("channels.velocity_x", r#"low_pass = "200 Hz""#));
    ("channels.ROLE.low_pass_order", Classify, filtered, Replace("low_pass_order = 1", "low_pass_order = 4"));
    ("channels.ROLE.delay", Identify, synthetic, Add("channels.velocity_x", r#"delay = "0.1 ms""#));
    ("channels.ROLE.delay_uncertainty", Identify, synthetic, Add("channels.velocity_x", r#"delay_uncertainty = "5 us""#));
    ("channels.ROLE.threshold", Classify, as_is, Replace(r#""2.5 V""#, r#""6 V""#));
    ("channels.ROLE.range", Classify, as_is, Add("channels.velocity_x", r#"range = "0.5 V""#));
    ("channels.ROLE.ignore_file_unit", Classify, in_mv, Add("channels.velocity_x", "ignore_file_unit = true"));
    ("channels.ROLE.content", Classify, timed, Replace(r#""times""#, r#""intervals""#));
    ("channels.ROLE.then", Classify, high, Replace(r#"["after"]"#, r#"["later"]"#));
    ("channels.ROLE.height_uncertainty", Identify, high, Replace(r#""1 mm""#, r#""30 mm""#));
    ("channels.ROLE.instrument", Html, one_record, Add("channels.contact", r#"instrument = "a wire""#));
    ("analysis.exclude", Classify, as_is, Add("analysis", r#"exclude = ["r2"]"#));
    ("analysis.skip", Classify, as_is, Add("analysis", r#"skip = "0.3 s""#));
    ("analysis.longest_period_n", Classify, synthetic, Add("analysis", "longest_period_n = 1"));
    ("analysis.most_impacts_p", Classify, synthetic, Add("analysis", "most_impacts_p = 1"));
    ("analysis.seed", Identify, bootstrap, Add("analysis", "seed = 7"));
    ("analysis.uncertainty", Identify, synthetic, Replace(r#""covariance""#, r#""profile""#));
    ("analysis.replicas", Identify, bootstrap, Replace("replicas = 4", "replicas = 6"));
    ("report.title", Html, published, Add("report", r#"title = "Other""#));
    ("report.points", Html, points_of_html, Replace(r#"["r1"]"#, r#"["r2"]"#));
    ("report.formats", Html, published, Replace(r#"["html"]"#, r#"["html", "svg"]"#));
    ("report.paper", Pdf, published_pdf, Add("report", r#"paper = "us-letter""#));
    ("report.decimal_comma", Html, published, Add("report", "decimal_comma = true"));
    ("report.logo", Html, published, By(with_logo));
    ("report.template", Pdf, published_pdf, By(with_template));
    ("report.words", Html, published, By(with_dotted_words));
    ("report.language", Html, published, Add("report", r#"language = "de""#));
    ("published.speeds", Identify, published, By(fewer_speeds));
    ("published.damping_ratio_hypotheses", Identify, published, Replace("[0.02, 0.002]", "[0.02]"));
}

/// The campaign of the tests.
fn as_is(_: &Lab) {}

/// With a low-pass of the first order.
fn filtered(lab: &Lab) {
    let filter = "low_pass = \"200 Hz\"\nlow_pass_order = 1";
    add(lab, "channels.velocity_x", filter);
}

/// Add a line below a table's head; without such a table it is added.
pub(super) fn add(lab: &Lab, table: &str, line: &str) {
    let head = format!("[{table}]\n");
    let text = lab.read("campaign.toml");
    if text.contains(&head) {
        lab.edit(&head, &format!("{head}{line}\n"));
    } else {
        lab.write("campaign.toml", &format!("{text}\n{head}{line}\n"));
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

/// A list of impacts instead of records.
fn timed(lab: &Lab) {
    lab.write("list.txt", "t [s]\n1.0\n1.5\n1.9\n2.22\n2.476\n");
    let campaign = "[campaign]\nname = \"ball\"\nmachine = \"single\"\nflight = \"constant_force\"\n\
                    [records]\nfiles = \"list.txt\"\n\
                    [channels.contact]\nchannel = \"t\"\ncontent = \"times\"\n";
    lab.write("campaign.toml", campaign);
}

/// Heights instead of records.
fn high(lab: &Lab) {
    lab.write(
        "heights.csv",
        "drop [cm],after [cm],later [cm]\n100,64.2,41\n100,63.5,40\n100,64.0,42\n",
    );
    let campaign = "[campaign]\nname = \"ball\"\nmachine = \"single\"\nflight = \"constant_force\"\n\
                    [records]\nfiles = \"heights.csv\"\n\
                    [channels.contact]\nchannel = \"drop\"\ncontent = \"heights\"\n\
                    then = [\"after\"]\nheight_uncertainty = \"1 mm\"\n";
    lab.write("campaign.toml", campaign);
}

/// Files without a time column.
fn untimed(lab: &Lab) {
    for name in ["r1.csv", "r2.csv", "r3.csv"] {
        lab.lines(name, |_, line| Some(line.split_once(',')?.1.to_owned()));
    }
}

/// Files whose time column states no unit.
fn without_unit_of_time(lab: &Lab) {
    for name in ["r1.csv", "r2.csv", "r3.csv"] {
        lab.replace(name, "time [s]", "time");
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

/// The same run table under another name.
fn other_run_table(lab: &Lab) {
    one_record(lab);
    fs::rename(lab.path("runs.csv"), lab.path("other.csv")).expect("another name");
    lab.write("runs.csv", RUNS);
    lab.edit("runs.csv", "other.csv");
}

/// Files without a time column, at a stated sample rate.
fn sampled_at_2_khz(lab: &Lab) {
    untimed(lab);
    add(lab, "records", r#"sample_rate = "2 kHz""#);
}

/// A velocity in mV, against the file's unit.
fn in_mv(lab: &Lab) {
    lab.edit("\"vx\"\nunit = \"V\"", "\"vx\"\nunit = \"mV\"");
}

/// One record, compared in the report.
fn points_of_html(lab: &Lab) {
    add(lab, "analysis", r#"exclude = ["r2", "r3"]"#);
    add(lab, "report", "formats = [\"html\"]\npoints = [\"r1\"]");
}

/// A report with a logo.
fn with_logo(lab: &Lab) {
    let image = "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'/>";
    lab.write("logo.svg", image);
    add(lab, "report", r#"logo = "logo.svg""#);
}

/// A report with a template of its own.
fn with_template(lab: &Lab) {
    lab.write("mine.typ", "#set page(width: 40mm, height: 30mm)\nMine");
    add(lab, "report", r#"template = "mine.typ""#);
}

/// A report with a table of words: each phrase with a dot behind it.
fn with_dotted_words(lab: &Lab) {
    let blank = lab.run(&["report", "--list-words"]).said;
    let words = blank.replace("\"\n", "·\"\n").replace("en·", "en");
    lab.write("words.toml", &words);
    add(lab, "report", r#"words = "words.toml""#);
}

/// Without the last of the published speeds.
fn fewer_speeds(lab: &Lab) {
    let kept: Vec<String> = lab.read("speeds.csv").lines().map(str::to_owned).collect();
    lab.write("fewer.csv", &(kept[..kept.len() - 1].join("\n") + "\n"));
    lab.edit(r#""speeds.csv""#, r#""fewer.csv""#);
}
