//! `impactid watch` and `explore --watch`: records that arrive one by one, in every way in which they do.

mod library;

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::explore::server::Explorer;
use crate::support::{Lab, files, interrupt, interruptible};

const WATCH: &[&str] = &[
    "watch",
    "campaign.toml",
    "--out",
    "out",
    "--poll",
    "0.05",
    "--settle",
    "0.2",
];

/// The page alone, where a test asks for nothing else of the report.
const PAGE: &[&str] = &["--format", "html"];

/// Records that are waiting to arrive: a campaign of single files, none of which is there yet.
struct Arriving {
    lab: Lab,
    rows: Vec<String>,
}

impl Arriving {
    fn new(records: usize) -> Self {
        let lab = Lab::new();
        for name in ["campaign.toml", "runs.csv", "r1.csv", "r2.csv", "r3.csv"] {
            lab.remove(name);
        }
        let records = records.to_string();
        let seed = ["--seed", "7", "--records", &records, "--out", "rig"];
        let made = lab.run(&[&["-q", "simulate", "campaign"][..], &seed].concat());
        assert_eq!(made.code, 0, "{}", made.said);
        let made = lab.run(&["-q", "convert", "rig/records.h5", "--out", "all.csv"]);
        assert_eq!(made.code, 0, "{}", made.said);
        fs::copy(lab.path("rig/campaign.toml"), lab.path("campaign.toml")).expect("a copy");
        let table = lab.read("rig/runs.csv");
        let rows = table.lines().skip(1);
        // records.h5,r0000,8.82,8.929,up: the record is a file of its own
        let row = |line: &str| {
            let cells: Vec<&str> = line.split(',').skip(1).collect();
            format!("{}.csv,{}", cells[0], cells[1..].join(","))
        };
        let rows = rows.map(row).collect();
        lab.write("runs.csv", "file,drive_frequency_hz,clearance_mm,sweep\n");
        Self { lab, rows }
    }

    fn file(&self, record: usize) -> String {
        self.rows[record]
            .split(',')
            .next()
            .expect("a file")
            .to_owned()
    }

    /// The line of the run table.
    fn list(&self, record: usize) {
        let table = self.lab.read("runs.csv") + &self.rows[record] + "\n";
        self.lab.write("runs.csv", &table);
    }

    /// The line of the run table, and the file.
    fn arrive(&self, record: usize) {
        let file = self.file(record);
        fs::copy(self.lab.path(&format!("all/{file}")), self.lab.path(&file)).expect("a copy");
        self.list(record);
    }

    fn start(&self, options: &[&str]) -> Child {
        watching(&self.lab, options)
    }
}

/// A watch of a folder's campaign.
fn watching(lab: &Lab, options: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_impactid"));
    command.args(WATCH).args(options).current_dir(lab.folder());
    let started = interruptible(&mut command).stderr(Stdio::piped()).spawn();
    started.expect("the program starts")
}

fn wait_until(what: &str, is_so: impl Fn() -> bool) {
    let begin = Instant::now();
    while !is_so() {
        assert!(begin.elapsed() < Duration::from_secs(300), "{what} never");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Ctrl-C; the exit code and what was said.
fn end(mut watch: Child) -> (Option<i32>, String) {
    interrupt(&watch);
    let mut said = String::new();
    let words = watch.stderr.as_mut().expect("its words");
    words.read_to_string(&mut said).expect("text");
    (watch.wait().expect("it ends").code(), said)
}

/// What `run` leaves in the place of the watch's results.
fn run_instead(lab: &Lab, options: &[&str]) -> (i32, BTreeMap<String, Vec<u8>>) {
    fs::remove_dir_all(lab.path("out")).expect("results");
    let ran = lab.run(&[&["-q", "run", "campaign.toml", "--out", "out"], options].concat());
    (ran.code, files(&lab.path("out")))
}

/// End a watch, and compare what it leaves with what a run does; gives what it said.
fn end_as_a_run(lab: &Lab, watch: Child, options: &[&str]) -> String {
    let (code, said) = end(watch);
    let found = files(&lab.path("out"));
    let (expected_code, expected) = run_instead(lab, options);
    assert_eq!(code, Some(expected_code), "{said}");
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&found), names(&expected));
    for (name, bytes) in &found {
        assert!(bytes == &expected[name], "{name} differs");
    }
    said
}

#[test]
fn a_late_channel_is_moved_back_while_records_arrive_as_by_a_run() {
    let arriving = Arriving::new(12);
    let lab = &arriving.lab;
    let text = lab.read("campaign.toml");
    let x = "[channels.velocity_x]\n";
    let late = text.replace(x, &format!("{x}delay = \"-3 ms\"\n"));
    assert_ne!(late, text);
    lab.write("campaign.toml", &late);
    (0..12).for_each(|record| arriving.arrive(record));
    let watch = arriving.start(PAGE);
    let identified = lab.path("out/identification.json");
    wait_until("a fit is written", || identified.exists());
    let live = lab.read("out/identification.json");
    assert!(live.contains("\"late_channel\""), "{live}");
    end_as_a_run(lab, watch, PAGE);
    let completed = lab.read("out/identification.json");
    assert!(completed.contains("\"late_channel\""), "{completed}");
}

#[test]
fn records_one_by_one_end_in_the_bytes_of_a_run() {
    let arriving = Arriving::new(12);
    let lab = &arriving.lab;
    let formats = ["--format", "pdf,html"];
    let watch = arriving.start(&formats);
    (0..9).for_each(|record| arriving.arrive(record));
    wait_until("a page is written", || {
        lab.path("out/report.live.js").exists()
    });
    let page = lab.read("out/report.html");
    assert!(page.contains("report.live.js") && page.contains("Records are still arriving"));
    let state = lab.read("out/report.live.js");
    let version = state.split('"').nth(1).expect("a version");
    assert!(page.contains(version), "{state}");
    assert!(
        lab.read("out/identification.json")
            .contains("inputs_sha256")
    );
    (9..11).for_each(|record| arriving.arrive(record));
    // the last one is named, and only half of it is there
    let last = arriving.file(11);
    let whole = lab.read(&format!("all/{last}"));
    lab.write(&last, &whole[..whole.len() / 2]);
    arriving.list(11);
    std::thread::sleep(Duration::from_millis(500));

    let said = end_as_a_run(lab, watch, &formats);
    assert!(said.contains("most of R's uncertainty: "), "{said}");
    assert!(said.contains("measure next: "), "{said}");
    assert!(
        said.contains("bracket") && said.contains("the fit is of"),
        "{said}"
    );
}

#[test]
fn a_file_that_grows_is_taken_again_and_what_happens_to_files_is_named() {
    let lab = Lab::new();
    // one growing file of all records beside single ones
    let first = lab.run(&["-q", "convert", "r1.csv", "--out", "grows.h5"]);
    assert_eq!(first.code, 0, "{}", first.said);
    lab.write(
        "runs.csv",
        "file,drive_frequency_hz,clearance_mm,sweep\ngrows.h5,11,1.0,up\nr2.csv,12,1.0,up\nr3.csv,13,1.0,down\n",
    );
    let mut watch = watching(&lab, PAGE);
    let written = || fs::read_to_string(lab.path("out/report.live.js")).unwrap_or_default();
    wait_until("a first page", || !written().is_empty());
    let before = written();
    // rewritten, removed, and no longer named
    lab.lines("r2.csv", |line, text| {
        (line < 1900).then(|| text.to_owned())
    });
    lab.remove("grows.h5");
    lab.replace("runs.csv", "r3.csv,13,1.0,down\n", "");
    wait_until("a newer page", || written() != before);
    let is_running = watch.try_wait().expect("its state").is_none();
    assert!(is_running);
    let (_, said) = end(watch);
    for words in [
        "r2.csv is rewritten",
        "grows.h5 is gone",
        "r3.csv is no longer named",
    ] {
        assert!(said.contains(words), "{words} is not in {said}");
    }
    assert!(!lab.path("out/report.live.js").exists());
}

#[test]
fn faults_of_the_description_are_told_and_waited_for() {
    let lab = Lab::new();
    lab.edit("channel = \"vx\"", "channel = \"laser\"");
    let watch = watching(&lab, PAGE);
    std::thread::sleep(Duration::from_millis(1500));
    lab.edit("channel = \"laser\"", "channel = \"vx\"");
    wait_until("a page", || lab.path("out/report.live.js").exists());
    let (code, said) = end(watch);
    assert_eq!(code, Some(run_instead(&lab, PAGE).0), "{said}");
    assert!(
        said.contains("laser") && said.contains("[channels.velocity_x]"),
        "{said}"
    );
}

#[test]
fn a_page_of_the_explorer_follows_the_records() {
    let arriving = Arriving::new(20);
    (0..8).for_each(|record| arriving.arrive(record));
    let options = [
        "--watch",
        "campaign.toml",
        "--poll",
        "0.05",
        "--settle",
        "0.2",
    ];
    let explorer = Explorer::start(&options, arriving.lab.folder());
    let mut page = explorer.page();
    let hello = page.hello().header;
    let records = |campaign: &serde_json::Value| campaign["records"].as_array().map(Vec::len);
    assert_eq!(records(&hello["campaign"]), Some(8));
    (8..20).for_each(|record| arriving.arrive(record));
    loop {
        let frame = page.next().expect("the page is told");
        assert_eq!(
            (frame.kind(), frame.header["id"].as_u64()),
            ("campaign", Some(0))
        );
        assert!(frame.header["state"]["rig"].is_object());
        if records(&frame.header["campaign"]) > Some(8) {
            break;
        }
    }
    assert!(!arriving.lab.path("out").exists());
}
