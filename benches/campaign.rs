//! What a campaign costs as a whole process: time on the clock, processor time and peak memory of each
//! stage, one processor against all, and what grows with the number of records.
//!
//! `cargo bench --bench campaign` (Linux). `IMPACTID_BASELINE=/path/to/impactid` runs another build in
//! turn on the same campaign and prints ratios; `IMPACTID_LONG=100000` adds a campaign of that many
//! records. Each figure is the median of five runs (of one for the long campaign).
#![allow(
    clippy::expect_used,
    clippy::panic,
    reason = "a benchmark fails by panicking"
)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Records of the campaign.
const RECORDS: usize = 846;
/// Runs of each row.
const RUNS: usize = 5;

/// What one process took.
#[derive(Debug, Clone, Copy)]
struct Cost {
    wall_s: f64,
    processor_s: f64,
    peak_mib: f64,
}

fn main() {
    // `cargo bench` passes --bench; under `cargo test` nothing is measured
    if !std::env::args().any(|a| a == "--bench") {
        return;
    }
    if !Path::new("/proc/self/stat").exists() {
        println!("skipped: processor time and memory are read from /proc");
        return;
    }
    let folder = std::env::temp_dir().join(format!("impactid-bench-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder for the campaign");
    let mut builds = vec![PathBuf::from(env!("CARGO_BIN_EXE_impactid"))];
    builds.extend(std::env::var_os("IMPACTID_BASELINE").map(PathBuf::from));
    // Every build reads what the oldest writes.
    let writer = builds.last().expect("a build").clone();
    let campaign = simulated(&writer, &folder, RECORDS);
    println!(
        "{:44} {:>9} {:>9} {:>9}",
        format!("{RECORDS} records"),
        "wall, s",
        "cpu, s",
        "MiB"
    );
    let run = |threads: &'static [&'static str]| {
        let (campaign, out) = (campaign.clone(), folder.join("out"));
        move |build: &Path| {
            let mut command = Command::new(build);
            let place = ["--out", text(&out), "-q"];
            command.arg("run").arg(&campaign).args(place).args(threads);
            clean(&out);
            command
        }
    };
    let one = row("to the PDF, one thread", &builds, RUNS, run(&["-j", "1"]));
    let all = row("to the PDF, all processors", &builds, RUNS, run(&[]));
    println!("{:44} {:9.2}", "one thread over all, wall", one / all);
    for stage in ["ingest", "classify", "identify", "report"] {
        staged(stage, &builds, &campaign, &folder);
    }
    row("--version", &builds, RUNS, |build| {
        let mut command = Command::new(build);
        command.arg("--version");
        command
    });
    row("boundary", &builds, RUNS, |build| {
        let mut command = Command::new(build);
        command.args(["boundary", "--kind", "s2", "--motion", "1/1"]);
        command.args([
            "--restitution",
            "0.9",
            "--damping-ratio",
            "0.07",
            "--eta",
            "1.3",
        ]);
        command
    });
    if let Some(records) = std::env::var("IMPACTID_LONG")
        .ok()
        .and_then(|n| n.parse().ok())
    {
        let campaign = simulated(&writer, &folder, records);
        row(
            &format!("{records} records to the PDF"),
            &builds,
            1,
            |build| {
                let out = folder.join("out");
                clean(&out);
                let mut command = Command::new(build);
                command
                    .arg("run")
                    .arg(&campaign)
                    .args(["--out", text(&out), "-q"]);
                command
            },
        );
    }
    fs::remove_dir_all(&folder).expect("the folder is removed");
}

/// One stage alone, the stages before it done by the same build.
fn staged(stage: &str, builds: &[PathBuf], campaign: &Path, folder: &Path) {
    row(stage, builds, RUNS, |build| {
        let out = folder.join("stages");
        let of = |stage: &str| {
            let mut command = Command::new(build);
            match stage {
                "ingest" => command.arg(stage).arg(campaign).args(["--out", text(&out)]),
                _ => command.arg(stage).arg(&out),
            };
            command.args(["-q", "-j", "1"]);
            command
        };
        clean(&out);
        let before = ["ingest", "classify", "identify"].into_iter();
        for earlier in before.take_while(|s| *s != stage) {
            let done = of(earlier).stdout(Stdio::null()).status();
            assert!(done.expect("the stage before").success());
        }
        of(stage)
    });
}

/// Print the medians of a command's costs for each build, and the ratios of the first over the others;
/// the time on the clock of the first.
fn row(name: &str, builds: &[PathBuf], runs: usize, command: impl Fn(&Path) -> Command) -> f64 {
    let mut costs: Vec<Vec<Cost>> = vec![Vec::new(); builds.len()];
    for _ in 0..runs {
        for (build, costs) in builds.iter().zip(&mut costs) {
            costs.push(cost(&mut command(build)));
        }
    }
    let medians: Vec<[f64; 3]> = costs
        .iter()
        .map(|c| {
            [
                |c: &Cost| c.wall_s,
                |c: &Cost| c.processor_s,
                |c: &Cost| c.peak_mib,
            ]
            .map(|of| median(c, of))
        })
        .collect();
    let [wall, processor, peak] = medians[0];
    println!("{name:44} {wall:9.3} {processor:9.3} {peak:9.0}");
    for baseline in &medians[1..] {
        let [wall, processor, peak] = [0, 1, 2].map(|i| medians[0][i] / baseline[i]);
        println!(
            "{:44} {wall:9.2} {processor:9.2} {peak:9.2}",
            "  over the baseline"
        );
    }
    wall
}

fn median(costs: &[Cost], of: fn(&Cost) -> f64) -> f64 {
    let mut values: Vec<f64> = costs.iter().map(of).collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Run a command to its end; processor time and memory are what /proc last showed of it.
fn cost(command: &mut Command) -> Cost {
    let start = Instant::now();
    let mut child = command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let (mut processor_s, mut peak_mib) = (0.0f64, 0.0f64);
    loop {
        processor_s = processor_s.max(processor(&child).unwrap_or(0.0));
        peak_mib = peak_mib.max(peak(&child).unwrap_or(0.0));
        if let Some(status) = child.try_wait().expect("its status") {
            assert!(status.success(), "{command:?} failed: {status}");
            break;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    Cost {
        wall_s: start.elapsed().as_secs_f64(),
        processor_s,
        peak_mib,
    }
}

/// Ticks of the processor clock in a second, as Linux has it.
const TICKS_PER_S: f64 = 100.0;

/// User and system time of a child, s: fields 14 and 15 of its stat.
fn processor(child: &Child) -> Option<f64> {
    let stat = fs::read_to_string(format!("/proc/{}/stat", child.id())).ok()?;
    let (_, after_name) = stat.rsplit_once(')')?;
    let mut fields = after_name.split_whitespace().skip(11);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / TICKS_PER_S)
}

/// Peak memory of a child, MiB.
fn peak(child: &Child) -> Option<f64> {
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024.0)
}

/// A campaign of so many records; its description.
fn simulated(build: &Path, folder: &Path, records: usize) -> PathBuf {
    let out = folder.join(format!("campaign_{records}"));
    let records = records.to_string();
    let done = Command::new(build)
        .args(["simulate", "campaign", "--seed", "7", "--records", &records])
        .args(["-q", "--out", text(&out)])
        .status();
    assert!(done.expect("the program starts").success());
    out.join("campaign.toml")
}

fn clean(out: &Path) {
    if out.exists() {
        fs::remove_dir_all(out).expect("the folder of the run before is removed");
    }
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}
