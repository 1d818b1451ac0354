//! Runs that are broken off, run twice, or cannot write: nothing half-written under a final
//! name, nothing lost that was there, and the same bytes in the end.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::Lab;

/// Moments at which a run is killed; `IMPACTID_KILLS` sets another number.
const KILLS: u64 = 40;

fn kills() -> u64 {
    std::env::var("IMPACTID_KILLS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(KILLS)
}

/// A synthetic campaign of few records in a folder of its own.
fn small_campaign() -> Lab {
    let lab = Lab::new();
    let made = lab.run(&[
        "-q",
        "simulate",
        "campaign",
        "--seed",
        "7",
        "--records",
        "8",
        "--force",
        "--out",
        ".",
    ]);
    assert_eq!(made.code, 0, "{}", made.said);
    lab
}

fn program(lab: &Lab, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_impactid"));
    command
        .args(args)
        .current_dir(lab.folder())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
}

/// All files of a folder that bear a final name, with their bytes.
fn outputs(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let Ok(entries) = fs::read_dir(folder) else {
        return BTreeMap::new();
    };
    entries
        .map(|e| e.expect("an entry"))
        .map(|e| (e.file_name().to_string_lossy().into_owned(), e.path()))
        .filter(|(name, path)| !name.starts_with('.') && path.is_file())
        .map(|(name, path)| (name, fs::read(path).expect("it can be read")))
        .collect()
}

const RUN: &[&str] = &["-q", "run", "campaign.toml", "--out", "out"];

/// What an undisturbed run leaves, its exit code, and how long it took.
fn reference(lab: &Lab) -> (BTreeMap<String, Vec<u8>>, i32, Duration) {
    let begin = Instant::now();
    let ran = lab.run(RUN);
    assert!(ran.code == 0 || ran.code == 1, "{}", ran.said);
    let files = outputs(&lab.path("out"));
    assert!(files.contains_key("report.pdf") && files.contains_key("identification.json"));
    (files, ran.code, begin.elapsed())
}

fn assert_same(found: &BTreeMap<String, Vec<u8>>, expected: &BTreeMap<String, Vec<u8>>) {
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(found), names(expected));
    for (name, bytes) in found {
        assert!(bytes == &expected[name], "{name} differs");
    }
}

#[test]
fn valid_the_same_input_gives_the_same_bytes_on_any_number_of_threads() {
    let lab = small_campaign();
    let (expected, code, _) = reference(&lab);
    for threads in ["1", "3"] {
        fs::remove_dir_all(lab.path("out")).expect("the outputs");
        let mut args = RUN.to_vec();
        args.extend(["--threads", threads]);
        assert_eq!(lab.run(&args).code, code);
        assert_same(&outputs(&lab.path("out")), &expected);
    }
}

/// Moments of the kills as parts of a run's time: the golden ratio fills the interval evenly.
fn moment(kill: u64) -> f64 {
    (kill as f64 * 0.618_033_988_749_895).fract() * 1.05
}

#[test]
fn valid_a_killed_run_leaves_nothing_half_written_and_resumes_to_the_same_bytes() {
    std::thread::scope(|scope| {
        for part in 0..2 {
            scope.spawn(move || kill_again_and_again(part));
        }
    });
}

fn kill_again_and_again(part: u64) {
    let lab = small_campaign();
    let (expected, code, time) = reference(&lab);
    let out = lab.path("out");
    let mut resume = RUN.to_vec();
    resume.push("--resume");
    for kill in (0..kills()).filter(|k| k % 2 == part) {
        fs::remove_dir_all(&out).expect("the outputs");
        let mut run = program(&lab, RUN).spawn().expect("the program starts");
        std::thread::sleep(time.mul_f64(moment(kill)));
        run.kill().expect("it can be killed");
        run.wait().expect("it ends");
        for (name, bytes) in outputs(&out) {
            let whole = expected.get(&name).is_some_and(|e| *e == bytes);
            assert!(whole, "{name} is half-written after kill {kill}");
        }
        if kill / 2 % 10 == 9 {
            assert_eq!(lab.run(&resume).code, code);
            assert_same(&outputs(&out), &expected);
            let hidden = fs::read_dir(&out).expect("the outputs").count();
            assert_eq!(hidden, expected.len(), "leftovers of the killed run");
        }
        fs::create_dir_all(&out).expect("a folder");
    }
}

#[test]
fn valid_a_second_run_into_the_same_folder_is_refused() {
    let lab = small_campaign();
    let mut first = program(&lab, RUN).spawn().expect("the program starts");
    let lock = lab.path("out/.impactid.lock");
    let begin = Instant::now();
    while !lock.exists() && begin.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(1));
    }
    let second = lab.run(RUN);
    let still_running = first.try_wait().expect("its state").is_none();
    first.wait().expect("it ends");
    if still_running {
        assert_eq!(second.code, 2);
        assert!(
            second
                .said
                .contains("another run of impactid writes into out"),
            "{}",
            second.said
        );
    }
    assert!(!lock.exists(), "the lock is left behind");
}

/// The program under a limit of the shell; writes fail as on a full disk.
#[cfg(unix)]
#[test]
fn valid_a_failed_write_is_told_and_what_was_there_stays() {
    let lab = small_campaign();
    fs::create_dir(lab.path("out")).expect("a folder");
    lab.write("out/report.pdf", "the report of yesterday");
    let script = format!(
        "trap '' XFSZ; ulimit -f 8; exec {} -q run campaign.toml --out out",
        env!("CARGO_BIN_EXE_impactid")
    );
    let output = Command::new("sh")
        .args(["-c", &script])
        .current_dir(lab.folder())
        .output()
        .expect("a shell");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("could not be written") && said.contains("free space"),
        "{said}"
    );
    assert_eq!(lab.read("out/report.pdf"), "the report of yesterday");
    let parts = fs::read_dir(lab.path("out"))
        .expect("the folder")
        .filter(|e| {
            e.as_ref()
                .is_ok_and(|e| e.file_name().to_string_lossy().contains("part"))
        })
        .count();
    assert_eq!(parts, 0, "half-written files are left");
}

#[cfg(unix)]
#[test]
fn valid_ctrl_c_says_so_and_ends_with_130() {
    let lab = small_campaign();
    let mut run = Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(["run", "campaign.toml", "--out", "out"])
        .current_dir(lab.folder())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    while !lab.path("out/.impactid.lock").exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(Duration::from_millis(30));
    let id = run.id().to_string();
    Command::new("kill")
        .args(["-INT", &id])
        .status()
        .expect("kill");
    let mut said = String::new();
    std::io::Read::read_to_string(run.stderr.as_mut().expect("its words"), &mut said)
        .expect("text");
    let code = run.wait().expect("it ends").code();
    assert_eq!(code, Some(130), "{said}");
    assert!(
        said.contains("broken off") && said.contains("--resume"),
        "{said}"
    );
    let files = outputs(&lab.path("out"));
    assert!(!files.contains_key("report.pdf"));
}
